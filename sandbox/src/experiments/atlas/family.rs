//! One motion, many bodies: a spring, a mode of a snake, and a snake in a picture.

use crate::prelude::*;
use elastic::{Material, Topology};
use field::{ForceField, Grid, Interpolation};
use integrator::problems::{damped_spring, spring_motion};
use integrator::{Scheme, Start, State, System};
use snake::{Body, Sampling, Snake, World};
use std::f64::consts::TAU;
use std::sync::Arc;

/// γ over critical damping: the report's three figures, with its c = 4 as the one that creeps.
const RATIOS: [f64; 3] = [0.15, 1.0, 2.0];
const TITLES: [&str; 3] = [
    "rings: ζ = 0.15",
    "first at rest: ζ = 1",
    "creeps: ζ = 2 (the report's c = 4)",
];
/// Until ω t is this, in so many steps.
const UNTIL: f64 = 25.0;
const STEPS: usize = 5000;
/// One in so many steps is kept.
const KEEP: usize = 100;

/// Who swings, and how the dots look.
const BODIES: [(&str, Color); 3] = [
    ("a spring", Color::BLUE),
    ("a mode of a snake", Color::GREEN),
    ("a snake in a picture", Color::RED),
];

/// The damping figures of §3.4.2 as one member of a family.
pub(crate) const FAMILY: Experiment = Experiment {
    id: "atlas-family",
    title: "One damped motion, three bodies",
    place: "§3.4.2",
    question: "The report shows a damped spring to explain a snake. Is a mode of a snake such a spring? Is a snake \
               held by an edge?",
    claims: &[
        claim("in units of its own frequency and critical damping every body moves alike \
               [report §3.4.2, theory]")
            .when(&[
                below("a spring: off the curve by", 1e-4),
                below("a mode of a snake: off the curve by", 1e-4),
                below("a snake in a picture: off the curve by", 0.02),
            ]),
        claim("each is first at rest without overshoot at ζ = 1 [D22, D23]")
            .when(&[near("*: least ζ without overshoot", 1.0, 0.03)]),
        claim("a snake in a picture swings though nothing elastic pulls it back [errata §7, \"image\"]")
            .when(&[above("a snake in a picture: slope of the edge", 0.0)]),
    ],
    run,
    draw,
};

/// Something that swings in one way: where it rests, how far out that way it is, and its frequency.
struct Swing {
    system: Box<dyn System>,
    state: State,
    rest: Vec<DVec2>,
    way: Vec<DVec2>,
    frequency: f64,
}

impl Swing {
    /// A system at rest moved along its way.
    fn of(
        system: impl System + 'static,
        rest: Vec<DVec2>,
        way: Vec<DVec2>,
        frequency: f64,
    ) -> Self {
        let moved = rest.iter().zip(&way).map(|(r, w)| *r + *w);
        let state = State::at_rest(moved.collect());
        let system = Box::new(system);
        Self {
            system,
            state,
            rest,
            way,
            frequency,
        }
    }

    /// How far along its way, the start being 1.
    fn amplitude(&self) -> f64 {
        let norm: f64 = self.way.iter().map(|w| w.length_squared()).sum();
        let parts = self.state.x.iter().zip(&self.rest).zip(&self.way);
        parts.map(|((x, r), w)| (*x - *r).dot(*w)).sum::<f64>() / norm
    }
}

/// A body with `ratio` times its critical damping, let go.
fn swing(body: usize, ratio: f64) -> Result<Swing> {
    match body {
        0 => {
            let problem = damped_spring(1.0, 2.0 * ratio, 1.0)?;
            let (rest, way) = (problem.system.rest.clone(), problem.state.x);
            Ok(Swing::of(problem.system, rest, way, 1.0))
        }
        1 => {
            let n = 40;
            let circle = elastic::circle(DVec2::ZERO, 10.0, n);
            let plain = Body::of(&circle, Topology::Closed, 2.0)?;
            let h = plain.spacing;
            let s = (std::f64::consts::PI * 3.0 / real(n)).sin().powi(2);
            let stiffness = 0.1 + 4.0 * 5.0 * s / (h * h) + 16.0 * 3.0 * s * s / h.powi(4);
            let body = plain
                .with_material(Material::uniform(0.1, 5.0, 3.0))
                .with_damping(2.0 * ratio * (2.0 * stiffness).sqrt());
            let rest = body.rest.clone();
            let wave = |i: usize| (TAU * 3.0 * real(i) / real(n)).cos();
            let way = (0..n).map(|i| DVec2::from_angle(0.4) * wave(i)).collect();
            let snake = Snake::new(body, World::default())?;
            Ok(Swing::of(snake, rest, way, (stiffness / 2.0).sqrt()))
        }
        _ => in_a_picture(ratio),
    }
}

/// A stiff ring about a bright disc, moved aside by a twentieth of a pixel.
fn in_a_picture(ratio: f64) -> Result<Swing> {
    let middle = DVec2::splat(32.0);
    let ring = elastic::circle(middle, 20.0, 60);
    let field = Arc::new(disc(middle, 20.0)?);
    let slope = |p: &DVec2| {
        -field
            .sample_with_slope(*p, Interpolation::Bilinear)
            .1
            .x_axis
            .x
    };
    let slope = mean(ring.iter().map(slope));
    let body = Body::of(&ring, Topology::Closed, 1.0)?
        .with_material(Material::uniform(400.0, 100.0, 0.0))
        .with_damping(2.0 * ratio * slope.sqrt());
    let snake = Snake::new(body, World::default().with_image(field, Sampling::Bilinear))?;
    let way = vec![DVec2::new(0.05, 0.0); ring.len()];
    Ok(Swing::of(snake, ring, way, slope.sqrt()))
}

/// The pull of a soft round edge: back to the border, the more the further away.
fn disc(middle: DVec2, radius: f64) -> Result<ForceField> {
    let force = |(row, column): (usize, usize)| {
        let out = DVec2::new(real(column), real(row)) - middle;
        let away = out.length() - radius;
        let pull = away * (-away.powi(2) / 18.0).exp();
        -pull * out.normalize_or_zero()
    };
    let x = Grid::from_shape_fn((65, 65), |at| force(at).x);
    let y = Grid::from_shape_fn((65, 65), |at| force(at).y);
    Ok(ForceField::from_components(&x, &y)?)
}

/// Amplitudes at every step.
fn motion(body: usize, ratio: f64) -> Result<Vec<f64>> {
    let mut swing = swing(body, ratio)?;
    let dt = UNTIL / swing.frequency / real(STEPS);
    // implicit in what is elastic: the ring in the picture is too stiff for these steps otherwise
    let start = Start::SecondOrder;
    let mut stepper = Scheme::Newmark.start(&mut *swing.system, &swing.state, dt, start)?;
    let mut out = vec![swing.amplitude()];
    for _ in 0..STEPS {
        stepper.step(&mut *swing.system, &mut swing.state)?;
        out.push(swing.amplitude());
    }
    Ok(out)
}

/// The motion all of them should have.
fn expected(ratio: f64, time: f64) -> f64 {
    spring_motion(1.0, 2.0 * ratio, 1.0, time)[0].0
}

fn time(step: usize) -> f64 {
    UNTIL * real(step) / real(STEPS)
}

fn run() -> Result {
    let mut record = Record::default();
    let kept = (0..=STEPS).step_by(KEEP).map(time);
    let mut table = Table::new("motion").with("ωt", ROUNDING, kept);
    for (body, (who, _)) in BODIES.into_iter().enumerate() {
        let mut worst = 0.0_f64;
        for ratio in RATIOS {
            let seen = motion(body, ratio)?;
            let off = seen
                .iter()
                .enumerate()
                .map(|(step, u)| (u - expected(ratio, time(step))).abs());
            worst = worst.max(most(off));
            let column = seen.into_iter().step_by(KEEP);
            table = table.with(format!("{who} at {ratio}"), 1e-6, column);
        }
        let mut own = record.under(who);
        own.note("off the curve by", worst, 1e-5);
        let (mut low, mut high) = (0.7, 1.3);
        while high - low > 1e-3 {
            let middle = f64::midpoint(low, high);
            // a round-off below zero is no overshoot
            if motion(body, middle)?.iter().any(|&u| u < -1e-7) {
                low = middle;
            } else {
                high = middle;
            }
        }
        own.note("least ζ without overshoot", high, 2e-3);
    }
    record.keep(table);
    let slope = in_a_picture(1.0)?.frequency.powi(2);
    record.note(
        "a snake in a picture: slope of the edge [M/T²]",
        slope,
        share(1e-9),
    );
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    for (ratio, title) in RATIOS.into_iter().zip(TITLES) {
        let curve = (0..=1000).map(|i| UNTIL * real(i) / 1000.0);
        let exact = line(curve.map(|t| (t, expected(ratio, t))), Color::INK).weighing(0.8);
        let mut panel = plot(title, ("ω t", 0.0, UNTIL), ("u / u₀", -0.8, 1.1))
            .with(line([(0.0, 0.0), (UNTIL, 0.0)], Color::GREY).weighing(0.5))
            .with(exact.named("a damped spring, exact"));
        for (body, (who, color)) in BODIES.into_iter().enumerate() {
            let points = record.points("motion", "ωt", &format!("{who} at {ratio}"))?;
            // each third dot is another body's, so that none hides the others
            let points = points.into_iter().skip(body).step_by(BODIES.len());
            panel = panel.with(dots(points, 2.0, color).named(who));
        }
        panels.push(panel);
    }
    Artefact::only(
        "Time in units of each body's own frequency, damping in units of its own critical damping. The spring is the \
         report's; the mode is the third of a ring of 40 nodes; the ring in the picture is held by its edge alone.",
        Figure::new("One damped motion, three bodies", 980.0).with(300.0, panels),
    )
}
