//! The account of energies closes on every shipped scene, at every step and from start to end, to what the algebra of its
//! scheme leaves over (theory.md, section 15).
#![allow(
    clippy::unwrap_used,
    reason = "a test: a scene that cannot run should stop it"
)]

use std::ops::ControlFlow;

use scene::integrator::Scheme;
use scene::snake::Outcome;
use scene::{Frame, Recording, SCENES, Scene};

/// What rounding may add in one step, some operations deep, as a share of the largest that all terms ever are together: places
/// are rounded to their own size, however little energy there is at the moment.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What the algebra leaves over in one step.
struct Allowed<'a> {
    scene: &'a Scene,
    dt: f64,
}

impl Allowed<'_> {
    /// The report's scheme forms places from terms as large as `2 μ x / dt²` (D21): some roundings of x a step, and so
    /// of x / dt in the velocity.
    fn cancellation(&self, after: &Frame) -> f64 {
        let body = self.scene.snake.body();
        if self.scene.plan.scheme != Scheme::Report {
            return 0.0;
        }
        let velocities = after.velocities().unwrap();
        let nodes = after.nodes().iter().zip(velocities).enumerate();
        let each = nodes.map(|(i, (x, v))| body.mass.at(i) * v.length() * x.length() / self.dt);
        8.0 * f64::EPSILON * body.spacing * each.sum::<f64>()
    }
}

/// The total of a moment, and the sum of the sizes of its terms.
fn total(frame: &Frame) -> (f64, f64) {
    let energies = frame.energies.as_ref().unwrap();
    let size = energies.values().iter().map(|value| value.abs()).sum();
    (energies.total(), size)
}

#[test]
fn the_account_of_energies_closes_on_every_scene_at_every_step_and_in_all() {
    for (name, _) in SCENES {
        let mut scene = Scene::named(name).unwrap();
        scene.plan.recording = Recording {
            every: Some(1),
            velocities: true,
            energies: true,
            ..Recording::default()
        };
        let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
        // what is shipped ends as it says: at rest, or when its time is over
        let over = matches!(record.outcome, Outcome::Finished { .. });
        assert!(
            record.outcome.is_good() && !(over && scene.plan.until.rest.is_some()),
            "{name}: {}",
            record.outcome
        );
        let allowed = Allowed {
            scene: &scene,
            dt: scene.plan.dt,
        };
        let first = total(&record.frames[0]).0;
        let each = record.frames.iter().map(|frame| total(frame).1);
        let rounding = ROUNDING * each.fold(0.0, f64::max);
        let (mut sum, mut worst, mut most) = (0.0, 0.0_f64, 0.0_f64);
        for pair in record.frames.windows(2) {
            let [before, after] = pair else { continue };
            let ((was, _), (now, _)) = (total(before), total(after));
            let step = rounding + allowed.cancellation(after);
            sum += step;
            let gap = (now - was).abs();
            worst = worst.max(gap / step);
            most = most.max((now - first).abs() / sum);
        }
        assert!(
            worst <= 1.0,
            "{name}: a step strays by {worst} of what its scheme leaves over"
        );
        assert!(
            most <= 1.0,
            "{name}: in all it strays by {most} of what its scheme leaves over"
        );
    }
}

#[test]
fn in_a_frame_with_an_equation_of_its_own_the_account_closes_by_the_order_of_its_steps() {
    // the steps are made in the frame, so the algebra of the scheme is not that of the nodes
    let gap = |dt: f64| {
        let mut scene = Scene::named("spinning-oval").unwrap();
        scene.plan.scheme = Scheme::Leapfrog;
        scene.plan.dt = dt;
        scene.plan.until.time = Some(1.6);
        scene.plan.recording = Recording {
            every: Some(1),
            energies: true,
            ..Recording::default()
        };
        let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
        let (first, size) = total(&record.frames[0]);
        let gaps = record.frames.iter().map(|f| (total(f).0 - first).abs());
        gaps.fold(0.0, f64::max) / size
    };
    let (coarse, fine) = (gap(0.004), gap(0.002));
    let order = (coarse / fine).log2();
    // inertial forces ask for the velocity, which makes the leapfrog first order
    assert!((order - 1.0).abs() < 0.1, "order {order}: {coarse} {fine}");
}
