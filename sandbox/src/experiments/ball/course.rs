//! One ball followed step by step: its center, shape and contact, and what sums them up.

use crate::experiments::motion::{keep_energies, keep_frames};
use crate::{Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use integrator::System;
use scene::Scene;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

/// A shape closer than this to its own, root mean square, counts as recovered (errata §6).
pub(crate) const RECOVERED: f64 = 0.04;
/// Rounding of a few thousand steps, and the last bits of a foreign `sin` in the start.
pub(crate) const STEPS: Tolerance = Tolerance::Absolute(1e-6);

/// One ball, a value a step, the start included.
#[derive(Debug, Default)]
pub(crate) struct Course {
    pub(crate) t: Vec<f64>,
    pub(crate) center: Vec<DVec2>,
    pub(crate) speed: Vec<DVec2>,
    pub(crate) rms: Vec<f64>,
    pub(crate) area: Vec<f64>,
    pub(crate) least_x: Vec<f64>,
    /// Share of the mode that goes once round, in x.
    pub(crate) mode: Vec<f64>,
    /// Largest deformation in y of any node at any time.
    pub(crate) across: f64,
    /// Eigenvalue of K for that mode, by mass.
    pub(crate) mode_stiffness: f64,
    /// γ / (2 μ).
    pub(crate) decay: f64,
    /// How near the wall is contact: 0, but the way of a step when the wall throws nodes off it.
    pub(crate) reach: f64,
}

impl Course {
    fn see(&mut self, snake: &snake::Snake, t: f64, x: &[DVec2], v: &[DVec2]) {
        let n = real(x.len());
        let mut e = vec![DVec2::ZERO; x.len()];
        snake.deformation_into(x, &mut e);
        self.t.push(t);
        self.center.push(snake.center(x));
        self.speed.push(v.iter().sum::<DVec2>() / n);
        self.rms.push(elastic::rms(&e));
        self.area.push(elastic::signed_area(x));
        self.least_x
            .push(x.iter().fold(f64::INFINITY, |a, p| a.min(p.x)));
        let once = e.iter().enumerate();
        let sum: f64 = once.map(|(i, e)| e.x * (TAU * real(i) / n).cos()).sum();
        self.mode.push(2.0 * sum / n);
        self.across = e.iter().fold(self.across, |a, e| a.max(e.y.abs()));
    }

    /// Steps of the first and last contact with the wall x = 0.
    pub(crate) fn contact(&self) -> (usize, usize) {
        let touches = |x: &f64| *x <= self.reach;
        (
            self.least_x.iter().position(touches).unwrap_or(0),
            self.least_x.iter().rposition(touches).unwrap_or(0),
        )
    }

    /// The last time the shape was further than [`RECOVERED`] from its own.
    pub(crate) fn recovered(&self) -> f64 {
        let last = self.rms.iter().rposition(|rms| *rms > RECOVERED);
        self.t[last.unwrap_or(0)]
    }

    /// Extremes of a quantity from a step on.
    pub(crate) fn extremes(values: &[f64], from: usize) -> Vec<usize> {
        (from.max(1)..values.len() - 1)
            .filter(|&i| (values[i] - values[i - 1]) * (values[i + 1] - values[i]) < 0.0)
            .collect()
    }

    /// Circular frequency of the mode after the ball has left the wall, by its zero crossings.
    pub(crate) fn frequency(&self) -> Option<f64> {
        let from = self.contact().1 + 1;
        let zero = |i: usize| {
            let (a, b) = (self.mode[i], self.mode[i + 1]);
            self.t[i] + (self.t[i + 1] - self.t[i]) * a / (a - b)
        };
        let crossings: Vec<f64> = (from..self.mode.len() - 1)
            .filter(|&i| (self.mode[i] < 0.0) != (self.mode[i + 1] < 0.0))
            .map(zero)
            .collect();
        let (first, last) = (crossings.first()?, crossings.last()?);
        (crossings.len() > 2).then(|| PI * real(crossings.len() - 1) / (last - first))
    }

    /// Rate at which that mode dies away after the ball has left the wall, by its extremes.
    pub(crate) fn decay_rate(&self) -> Option<f64> {
        let peaks = Self::extremes(&self.mode, self.contact().1 + 2);
        let (first, last) = (*peaks.first()?, *peaks.last()?);
        let fallen = (self.mode[first] / self.mode[last]).abs().ln();
        (peaks.len() > 2).then(|| fallen / (self.t[last] - self.t[first]))
    }

    /// The frequency the mode must have, its damping included.
    pub(crate) fn predicted(&self) -> f64 {
        (self.mode_stiffness - self.decay * self.decay).sqrt()
    }
}

/// Runs a ball and follows it; the frames come with it.
pub(crate) fn follow(
    id: &'static str,
    scene: &mut Scene,
) -> Result<(Course, scene::Record), SandboxError> {
    scene.plan.recording.every = Some(20);
    scene.plan.recording.energies = true;
    let snake = scene.snake.clone();
    let mut course = Course::default();
    if snake
        .world()
        .walls
        .iter()
        .any(|wall| matches!(wall.law(), snake::WallLaw::Impact { .. }))
    {
        course.reach = scene.plan.dt * scene.start.v[0].length();
    }
    if let Some([diagonal, first, second]) = snake.stiffness().band().circulant().as_deref() {
        let angle = TAU / real(snake.body().len());
        let mass = snake.mass()[0];
        course.mode_stiffness =
            (diagonal + 2.0 * first * angle.cos() + 2.0 * second * (2.0 * angle).cos()) / mass;
        course.decay = snake.damping()[0] / (2.0 * mass);
    }
    let start = scene.start.clone();
    course.see(&snake, start.t, &start.x, &start.v);
    let run = scene
        .run(&mut |state| {
            course.see(&snake, state.t, &state.x, &state.v);
            ControlFlow::Continue(())
        })
        .map_err(SandboxError::refused(id))?;
    Ok((course, run))
}

/// The numbers that sum a course up, each name after `prefix`.
pub(crate) fn sum_up(record: &mut Record, prefix: &str, course: &Course) {
    let (first, last) = course.contact();
    let end = course.t.len() - 1;
    let start_area = course.area[0];
    let least = (0..=end)
        .min_by(|&a, &b| course.area[a].total_cmp(&course.area[b]))
        .unwrap_or(0);
    let after = course.area[least..]
        .iter()
        .fold(f64::NEG_INFINITY, |a, &b| a.max(b));
    let largest = course.rms.iter().fold(0.0_f64, |a, &b| a.max(b));
    let moment = Tolerance::Absolute(0.0015);
    let mut note = |name: &str, value: f64, unit: &'static str, tolerance: Tolerance| {
        record.note(format!("{prefix}{name}"), value, unit, tolerance);
    };
    note(
        "least area",
        course.area[least] / start_area,
        "of the start",
        STEPS,
    );
    note("time of the least area", course.t[least], "s", moment);
    note(
        "largest area afterwards",
        after / start_area,
        "of the start",
        STEPS,
    );
    note(
        "area at the end",
        course.area[end] / start_area,
        "of the start",
        STEPS,
    );
    note("largest deformation (rms)", largest, "", STEPS);
    note("deformation at the end (rms)", course.rms[end], "", STEPS);
    note("first contact", course.t[first], "s", moment);
    note("last contact", course.t[last], "s", moment);
    let before = first.saturating_sub(1);
    note(
        "speed towards the wall",
        -course.speed[before].x,
        "/s",
        STEPS,
    );
    note(
        "speed away from it",
        course.speed[(last + 1).min(end)].x,
        "/s",
        STEPS,
    );
    note("out of shape until", course.recovered(), "s", moment);
    note("center at the end: x", course.center[end].x, "", STEPS);
    note("center at the end: y", course.center[end].y, "", STEPS);
    note("largest deformation in y", course.across, "", STEPS);
    let extremes = Course::extremes(&course.area, first + 1).len();
    note(
        "extremes of the area after the contact",
        real(extremes),
        "",
        Tolerance::EXACT,
    );
    if let (Some(found), Some(rate)) = (course.frequency(), course.decay_rate()) {
        note(
            "ringing: predicted",
            course.predicted(),
            "rad/s",
            Tolerance::ROUNDING,
        );
        note("ringing: measured", found, "rad/s", STEPS);
        note(
            "ringing dies away: predicted",
            course.decay,
            "/s",
            Tolerance::ROUNDING,
        );
        note("ringing dies away: measured", rate, "/s", STEPS);
    }
}

/// Keeps a course as two tables: tenths of a second to compare, and all frames to draw.
pub(crate) fn keep(record: &mut Record, course: &Course, run: &scene::Record) {
    let end = course.t.len() - 1;
    for (table, step) in [(Table::new("course"), 100), (Table::raw("fine"), 20)] {
        let rows: Vec<usize> = (0..=end).step_by(step).collect();
        let pick = |values: &dyn Fn(usize) -> f64| rows.iter().map(|&i| values(i)).collect();
        record.keep(
            table
                .with("t", "s", Tolerance::ROUNDING, pick(&|i| course.t[i]))
                .with("center x", "", STEPS, pick(&|i| course.center[i].x))
                .with("center y", "", STEPS, pick(&|i| course.center[i].y))
                .with("deformation", "", STEPS, pick(&|i| course.rms[i]))
                .with(
                    "area",
                    "",
                    STEPS,
                    pick(&|i| course.area[i] / course.area[0]),
                )
                .with("mode", "", STEPS, pick(&|i| course.mode[i])),
        );
    }
    keep_frames(record, "curves", run);
    keep_energies(record, "energy", run);
}
