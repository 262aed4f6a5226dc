//! One ball followed step by step: its center, shape and contact, and what sums them up.

use crate::prelude::*;
use integrator::System;
use std::f64::consts::{PI, TAU};

/// A shape closer than this to its own, root mean square, counts as recovered (errata §6).
pub(crate) const RECOVERED: f64 = 0.04;
/// Rounding of a few thousand steps, and the last bits of a foreign `sin` in the start.
pub(crate) const STEPS: f64 = 1e-6;

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
        let turns = |i: usize| (values[i] - values[i - 1]) * (values[i + 1] - values[i]) < 0.0;
        (from.max(1)..values.len() - 1)
            .filter(|&i| turns(i))
            .collect()
    }

    /// Circular frequency of the mode after the ball has left the wall, by its zero crossings.
    pub(crate) fn frequency(&self) -> Option<f64> {
        let from = self.contact().1;
        frequency(&self.t, &self.mode, (self.t[from], f64::INFINITY), 3)
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

/// Circular frequency between two times by zero crossings, if there are so many of them.
pub(crate) fn frequency(
    t: &[f64],
    value: &[f64],
    (from, to): (f64, f64),
    count: usize,
) -> Option<f64> {
    let turns = |i: &usize| (value[*i] < 0.0) != (value[i + 1] < 0.0);
    let inside = |i: &usize| t[*i] > from && t[i + 1] < to;
    let zero = |i: usize| t[i] + (t[i + 1] - t[i]) * value[i] / (value[i] - value[i + 1]);
    let all = (0..t.len() - 1).filter(|i| inside(i) && turns(i));
    let zeros: Vec<f64> = all.map(zero).collect();
    let (first, last) = (zeros.first()?, zeros.last()?);
    (zeros.len() >= count).then(|| PI * real(zeros.len() - 1) / (last - first))
}

/// Runs a ball and follows it; the frames come with it.
pub(crate) fn follow(name: &str, changes: &[(&str, &str)]) -> Result<(Course, scene::Record)> {
    let mut scene = scene_with(name, changes)?;
    scene.plan.recording.every = Some(20);
    scene.plan.recording.energies = true;
    let snake = scene.snake.clone();
    let mut course = Course::default();
    let throws = |wall: &snake::Wall| matches!(wall.law(), snake::WallLaw::Impact { .. });
    if snake.world().walls.iter().any(throws) {
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
    let run = watched(&scene, &mut |state| {
        course.see(&snake, state.t, &state.x, &state.v);
    })?;
    Ok((course, run))
}

/// The numbers that sum a course up, each name after `prefix`.
pub(crate) fn sum_up(record: &mut Record, prefix: &str, course: &Course) {
    let (first, last) = course.contact();
    let (start, area) = (course.area[0], &course.area);
    let end = course.t.len() - 1;
    let low = (0..=end).min_by(|&a, &b| area[a].total_cmp(&area[b]));
    let low = low.unwrap_or(0);
    let towards = -course.speed[first.saturating_sub(1)].x;
    let away = course.speed[(last + 1).min(end)].x;
    let after = most(area[low..].iter().copied());
    let extremes = real(Course::extremes(area, first + 1).len());
    let moment = 0.0015;
    for (name, value, tolerance) in [
        ("least area [of the start]", area[low] / start, STEPS),
        ("time of the least area [s]", course.t[low], moment),
        (
            "largest area afterwards [of the start]",
            after / start,
            STEPS,
        ),
        ("area at the end [of the start]", area[end] / start, STEPS),
        (
            "largest deformation (rms)",
            most(course.rms.iter().copied()),
            STEPS,
        ),
        ("deformation at the end (rms)", course.rms[end], STEPS),
        ("first contact [s]", course.t[first], moment),
        ("last contact [s]", course.t[last], moment),
        ("speed towards the wall [/s]", towards, STEPS),
        ("speed away from it [/s]", away, STEPS),
        ("out of shape until [s]", course.recovered(), moment),
        ("center at the end: x", course.center[end].x, STEPS),
        ("center at the end: y", course.center[end].y, STEPS),
        ("largest deformation in y", course.across, STEPS),
        ("extremes of the area after the contact", extremes, EXACT),
    ] {
        record.note(format!("{prefix}{name}"), value, tolerance);
    }
    let (Some(found), Some(rate)) = (course.frequency(), course.decay_rate()) else {
        return;
    };
    for (name, value, tolerance) in [
        ("ringing: predicted [rad/s]", course.predicted(), ROUNDING),
        ("ringing: measured [rad/s]", found, STEPS),
        ("ringing dies away: predicted [/s]", course.decay, ROUNDING),
        ("ringing dies away: measured [/s]", rate, STEPS),
    ] {
        record.note(format!("{prefix}{name}"), value, tolerance);
    }
}

/// Keeps a course as two tables: tenths of a second to compare, and all frames to draw.
pub(crate) fn keep(record: &mut Record, course: &Course, run: &scene::Record) {
    for (table, step) in [(Table::new("course"), 100), (Table::raw("fine"), 20)] {
        let rows = || (0..course.t.len()).step_by(step);
        record.keep(
            table
                .with("t [s]", ROUNDING, rows().map(|i| course.t[i]))
                .with("center x", STEPS, rows().map(|i| course.center[i].x))
                .with("center y", STEPS, rows().map(|i| course.center[i].y))
                .with("deformation", STEPS, rows().map(|i| course.rms[i]))
                .with(
                    "area",
                    STEPS,
                    rows().map(|i| course.area[i] / course.area[0]),
                )
                .with("mode", STEPS, rows().map(|i| course.mode[i])),
        );
    }
    record.keep_run("curves", run);
}
