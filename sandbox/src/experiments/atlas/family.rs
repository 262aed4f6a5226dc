//! One motion, many bodies: a spring, a mode of a snake, and a snake in a picture.

use crate::demand::{above, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{Material, Topology};
use field::{ForceField, Grid, Interpolation};
use glam::DVec2;
use integrator::problems::{damped_spring, spring_motion};
use integrator::{Scheme, Start, State, System};
use snake::{Body, Sampling, Snake, World};
use std::f64::consts::TAU;
use std::sync::Arc;

const ID: &str = "atlas-family";
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
    id: ID,
    title: "One damped motion, three bodies",
    place: "§3.4.2",
    question: "The report shows a damped spring to explain a snake. Is a mode of a snake such a spring? Is a snake \
               held by an edge?",
    claims: &[
        Claim {
            says: "in units of its own frequency and critical damping every body moves alike",
            source: "report §3.4.2, theory",
            judge: |r| {
                let worst = BODIES.map(|(who, _)| r.number(&format!("{who}: off the curve by")));
                let [spring, mode, picture] = worst;
                let (spring, mode, picture) = (spring?, mode?, picture?);
                Ok(Finding::new(
                    spring < 1e-4 && mode < 1e-4 && picture < 0.02,
                    format!("off by {spring:.1e}, {mode:.1e} and {picture:.1e} of the start"),
                ))
            },
        },
        Claim {
            says: "each is first at rest without overshoot at ζ = 1",
            source: "D22, D23",
            judge: |r| {
                let best =
                    BODIES.map(|(who, _)| r.number(&format!("{who}: least ζ without overshoot")));
                let [spring, mode, picture] = best;
                let (spring, mode, picture) = (spring?, mode?, picture?);
                Ok(Finding::new(
                    [spring, mode, picture]
                        .iter()
                        .all(|z| (z - 1.0).abs() < 0.03),
                    format!("ζ = {spring:.3}, {mode:.3}, {picture:.3}"),
                ))
            },
        },
        Claim {
            says: "a snake in a picture swings though nothing elastic pulls it back",
            source: "errata §7, \"image\"",
            judge: |r| judged(r, &[above("a snake in a picture: slope of the edge", 0.0)]),
        },
    ],
    run,
    draw,
};

/// Something that swings in one way: where it is, how far out that way it is, and its frequency.
struct Swing {
    system: Box<dyn System>,
    state: State,
    way: Vec<DVec2>,
    frequency: f64,
}

impl Swing {
    /// How far along its way, the start being 1.
    fn amplitude(&self, rest: &[DVec2]) -> f64 {
        let norm: f64 = self.way.iter().map(|w| w.length_squared()).sum();
        let parts = self.state.x.iter().zip(rest).zip(&self.way);
        parts.map(|((x, r), w)| (*x - *r).dot(*w)).sum::<f64>() / norm
    }
}

fn refused<E: std::fmt::Display>(reason: E) -> SandboxError {
    SandboxError::refused(ID)(reason)
}

/// A body with `ratio` times its critical damping, let go.
fn swing(body: usize, ratio: f64) -> Result<(Swing, Vec<DVec2>), SandboxError> {
    match body {
        0 => {
            let problem = damped_spring(1.0, 2.0 * ratio, 1.0).map_err(refused)?;
            let mut state = problem.state;
            state.v.fill(DVec2::ZERO);
            let rest = problem.system.rest.clone();
            let way = state.x.clone();
            Ok((
                Swing {
                    system: Box::new(problem.system),
                    state,
                    way,
                    frequency: 1.0,
                },
                rest,
            ))
        }
        1 => {
            let n = 40;
            let circle = elastic::circle(DVec2::ZERO, 10.0, n);
            let plain = Body::of(&circle, Topology::Closed, 2.0).map_err(refused)?;
            let h = plain.spacing;
            let s = (std::f64::consts::PI * 3.0 / real(n)).sin().powi(2);
            let stiffness = 0.1 + 4.0 * 5.0 * s / (h * h) + 16.0 * 3.0 * s * s / h.powi(4);
            let body = plain
                .with_material(Material::uniform(0.1, 5.0, 3.0))
                .with_damping(2.0 * ratio * (2.0 * stiffness).sqrt());
            let rest = body.rest.clone();
            let wave = |i: usize| (TAU * 3.0 * real(i) / real(n)).cos();
            let way: Vec<DVec2> = (0..n).map(|i| DVec2::from_angle(0.4) * wave(i)).collect();
            let state = State::at_rest(rest.iter().zip(&way).map(|(r, w)| *r + *w).collect());
            let system = Box::new(Snake::new(body, World::default()).map_err(refused)?);
            Ok((
                Swing {
                    system,
                    state,
                    way,
                    frequency: (stiffness / 2.0).sqrt(),
                },
                rest,
            ))
        }
        _ => in_a_picture(ratio),
    }
}

/// A stiff ring about a bright disc, moved aside by a twentieth of a pixel.
fn in_a_picture(ratio: f64) -> Result<(Swing, Vec<DVec2>), SandboxError> {
    let n = 60;
    let middle = DVec2::splat(32.0);
    let circle = elastic::circle(middle, 20.0, n);
    let field = Arc::new(disc(middle, 20.0)?);
    let slopes = circle.iter().map(|&p| {
        let (_, slope) = field.sample_with_slope(p, Interpolation::Bilinear);
        -slope.x_axis.x
    });
    let slope = slopes.sum::<f64>() / real(n);
    let body = Body::of(&circle, Topology::Closed, 1.0)
        .map_err(refused)?
        .with_material(Material::uniform(400.0, 100.0, 0.0))
        .with_damping(2.0 * ratio * slope.sqrt());
    let world = World::default().with_image(field, Sampling::Bilinear);
    let system = Box::new(Snake::new(body, world).map_err(refused)?);
    let way = vec![DVec2::new(0.05, 0.0); n];
    let state = State::at_rest(circle.iter().map(|p| *p + way[0]).collect());
    Ok((
        Swing {
            system,
            state,
            way,
            frequency: slope.sqrt(),
        },
        circle,
    ))
}

/// The pull of a soft round edge: back to the border, the more the further away.
fn disc(middle: DVec2, radius: f64) -> Result<ForceField, SandboxError> {
    let force = |row: usize, column: usize| {
        let out = DVec2::new(real(column), real(row)) - middle;
        let distance = out.length();
        let pull = (distance - radius) * (-(distance - radius).powi(2) / 18.0).exp();
        if distance > 0.0 {
            -pull / distance * out
        } else {
            DVec2::ZERO
        }
    };
    let x = Grid::from_shape_fn((65, 65), |(row, column)| force(row, column).x);
    let y = Grid::from_shape_fn((65, 65), |(row, column)| force(row, column).y);
    ForceField::from_components(&x, &y).map_err(refused)
}

/// Amplitudes at every step.
fn motion(body: usize, ratio: f64) -> Result<Vec<f64>, SandboxError> {
    let (mut swing, rest) = swing(body, ratio)?;
    let dt = UNTIL / swing.frequency / real(STEPS);
    // implicit in what is elastic: the ring in the picture is too stiff for these steps otherwise
    let mut stepper = Scheme::Newmark
        .start(&mut *swing.system, &swing.state, dt, Start::SecondOrder)
        .map_err(refused)?;
    let mut out = vec![swing.amplitude(&rest)];
    for _ in 0..STEPS {
        stepper
            .step(&mut *swing.system, &mut swing.state)
            .map_err(refused)?;
        out.push(swing.amplitude(&rest));
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

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let kept: Vec<f64> = (0..=STEPS).step_by(KEEP).map(time).collect();
    let mut table = Table::new("motion").with("ωt", "", Tolerance::ROUNDING, kept);
    for (body, (who, _)) in BODIES.into_iter().enumerate() {
        let mut worst = 0.0_f64;
        for ratio in RATIOS {
            let seen = motion(body, ratio)?;
            for (step, seen) in seen.iter().enumerate() {
                worst = worst.max((seen - expected(ratio, time(step))).abs());
            }
            let column = seen.into_iter().step_by(KEEP).collect();
            table = table.with(
                format!("{who} at {ratio}"),
                "",
                Tolerance::Absolute(1e-6),
                column,
            );
        }
        record.note(
            format!("{who}: off the curve by"),
            worst,
            "",
            Tolerance::Absolute(1e-5),
        );
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
        record.note(
            format!("{who}: least ζ without overshoot"),
            high,
            "",
            Tolerance::Absolute(2e-3),
        );
    }
    record.keep(table);
    let (picture, _) = in_a_picture(1.0)?;
    let slope = picture.frequency * picture.frequency;
    record.note(
        "a snake in a picture: slope of the edge",
        slope,
        "M/T²",
        Tolerance::Relative(1e-9),
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    for (ratio, title) in RATIOS.into_iter().zip(TITLES) {
        let curve = (0..=1000)
            .map(|i| UNTIL * real(i) / 1000.0)
            .map(|t| (t, expected(ratio, t)));
        let mut panel = Panel::new(
            title,
            Axis::new("ω t", 0.0, UNTIL),
            Axis::new("u / u₀", -0.8, 1.1),
        )
        .legend_at(Corner::TopRight)
        .with(Line::new(vec![(0.0, 0.0), (UNTIL, 0.0)], Color::GREY).weighing(0.5))
        .with(
            Line::new(curve.collect(), Color::INK)
                .weighing(0.8)
                .named("a damped spring, exact"),
        );
        for (body, (who, color)) in BODIES.into_iter().enumerate() {
            let points = record.points("motion", "ωt", &format!("{who} at {ratio}"))?;
            // each third dot is another body's, so that none hides the others
            let points = points
                .into_iter()
                .skip(body)
                .step_by(BODIES.len())
                .collect();
            panel = panel.with(Layer::Dots {
                points,
                radius: 2.0,
                color,
                label: who.to_owned(),
            });
        }
        panels.push(panel);
    }
    let figure = Figure::new("One damped motion, three bodies", 980.0).with(300.0, panels);
    Ok(vec![Artefact::figure(
        "Time in units of each body's own frequency, damping in units of its own critical damping. The spring is the \
         report's; the mode is the third of a ring of 40 nodes; the ring in the picture is held by its edge alone.",
        figure,
    )])
}
