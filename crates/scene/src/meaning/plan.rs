//! The plan: scheme, step, when to stop, what to keep.

use integrator::{Scheme, Start};
use snake::{Rest, Until};

use super::{Rules, number};
use crate::SceneError;
use crate::file::{OutputText, RecordText, RestText, Rule, RunText, SceneText, StepText};
use crate::limits::MOST_STEPS;
use crate::scene::{Plan, Recording};

pub(super) fn plan(text: &SceneText, rules: Rules) -> Result<Plan, SceneError> {
    let run = &text.run;
    let scheme = match &run.scheme {
        Some(name) => name
            .parse::<Scheme>()
            .map_err(|e| SceneError::key("run.scheme", e))?,
        None if rules.scheme == Rule::Report => Scheme::Report,
        None => Scheme::Leapfrog,
    };
    let (dt, tolerance) = step(run)?;
    let each = run.output == Some(OutputText::Every);
    let until = Until {
        steps: if each {
            at_most(run.steps.unwrap_or(MOST_STEPS))?
        } else {
            steps(run, dt, rules)?
        },
        time: if each { run.time } else { None },
        rest: run.rest.as_ref().map(rest).transpose()?,
    };
    let start_rule = match rules.start {
        Rule::Report => Start::FirstOrder,
        Rule::Corrected => Start::SecondOrder,
    };
    Ok(Plan {
        scheme,
        dt,
        tolerance,
        each,
        until,
        start_rule,
        force: run.force,
        recording: recording(&text.record)?,
    })
}

/// Largest error of a sub-step in pixels, unless given.
pub(crate) const USUAL_TOLERANCE: f64 = 1e-3;

/// The step, and the tolerance of its sub-steps if they are to be chosen.
fn step(run: &RunText) -> Result<(f64, Option<f64>), SceneError> {
    match run.dt {
        StepText::Fixed(dt) => {
            for (key, given) in [
                ("run.tolerance", run.tolerance.is_some()),
                ("run.output", run.output.is_some()),
            ] {
                if given {
                    let message = "is for chosen steps; needed: dt = \"auto\" with it";
                    return Err(SceneError::key(key, message));
                }
            }
            Ok((number::above_zero("run.dt", dt)?, None))
        }
        StepText::Auto => {
            let tolerance = run.tolerance.unwrap_or(USUAL_TOLERANCE);
            let tolerance = number::above_zero("run.tolerance", tolerance)?;
            let output = match (run.output, run.time) {
                (Some(OutputText::Time(output)), _) => output,
                (Some(OutputText::Every), Some(time)) => {
                    return Ok((number::above_zero("run.time", time)?, Some(tolerance)));
                }
                (Some(OutputText::Every), None) => {
                    let message = "is missing; needed: the time at which the run ends";
                    return Err(SceneError::key("run.time", message));
                }
                (None, Some(time)) => time / 1000.0,
                (None, None) => {
                    let message = "is missing; needed: the time between two steps";
                    return Err(SceneError::key("run.output", message));
                }
            };
            Ok((number::above_zero("run.output", output)?, Some(tolerance)))
        }
    }
}

fn steps(run: &RunText, dt: f64, rules: Rules) -> Result<u64, SceneError> {
    let most = MOST_STEPS as f64;
    match (run.steps, run.time) {
        (Some(steps), None) => at_most(steps),
        (None, Some(time)) if time.is_finite() && time >= 0.0 && time / dt < most => {
            match rules.clock {
                Rule::Report => integrator::report_steps(time, dt).ok_or_else(|| {
                    SceneError::key("run.time", "takes more steps than can be counted")
                }),
                Rule::Corrected => Ok(steps_in(time, dt)),
            }
        }
        (None, Some(time)) => {
            let message =
                format!("must be finite, at least 0 and less than {MOST_STEPS} steps, got {time}");
            Err(SceneError::key("run.time", message))
        }
        (None, None) => Err(SceneError::key(
            "run",
            "never ends; needed: one of the keys steps and time",
        )),
        (Some(_), Some(_)) => Err(SceneError::key(
            "run",
            "has both steps and time; needed: one of them",
        )),
    }
}

/// A number of steps that can be meant.
fn at_most(steps: u64) -> Result<u64, SceneError> {
    if steps <= MOST_STEPS {
        return Ok(steps);
    }
    let message = format!("must be at most {MOST_STEPS}, got {steps}");
    Err(SceneError::key("run.steps", message))
}

fn rest(text: &RestText) -> Result<Rest, SceneError> {
    let usual = Rest::default();
    let (balance, travel) = (text.balance, text.travel);
    Ok(Rest {
        balance: number::above_zero("run.rest.balance", balance.unwrap_or(usual.balance))?,
        travel: number::above_zero("run.rest.travel", travel.unwrap_or(usual.travel))?,
        shape: text.shape,
    })
}

fn recording(text: &RecordText) -> Result<Recording, SceneError> {
    if text.every == Some(0) {
        return Err(SceneError::key("record.every", "must be at least 1, got 0"));
    }
    Ok(Recording {
        every: text.every,
        steps: text.steps.clone().unwrap_or_default(),
        velocities: text.velocities,
        energies: text.energies,
    })
}

/// Steps that fill `time`: the nearest whole number, not an accumulated one (D20).
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the caller has checked that the quotient is from 0 to 1e9"
)]
fn steps_in(time: f64, dt: f64) -> u64 {
    (time / dt).round() as u64
}
