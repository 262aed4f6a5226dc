//! Figure 2.1: a snake's shape is decomposed into reference and deformation, from a real state.

use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::experiments::motion::{changed_scene, pair, range, to_the_end};
use crate::{Artefact, Claim, Experiment, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use std::f64::consts::TAU;

const ID: &str = "fig-2-1";
/// The node whose vectors are drawn.
const NODE: usize = 4;
/// The moment: the soft ball about to be squeezed most.
const STEP: u64 = 2450;
/// Half axes of the ellipse in the scene's text.
const AXES: DVec2 = DVec2::new(1.5, 1.0);

/// Figure 2.1: v = c + r + e.
pub(crate) const DECOMPOSITION: Experiment = Experiment {
    id: ID,
    title: "Reference and deformation",
    place: "Figure 2.1",
    question: "The soft ball of Figure 2.3 at the wall: is every node where its center of mass, its reference shape \
               and its deformation together say?",
    claims: &[
        Claim {
            says: "q = r + e, and v = c + q",
            source: "report Eq. 2.2",
            judge: |r| {
                judged(
                    r,
                    &[below(
                        "largest difference of e from what the formulas leave of v",
                        1e-12,
                    )],
                )
            },
        },
        Claim {
            says: "c is the center of mass: Σ μ q = 0, and so Σ μ e = 0 when Σ μ r = 0",
            source: "report §2.2, D9",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("|Σ μ q| by Σ μ", 1e-14),
                        below("|Σ μ r| by Σ μ", 1e-14),
                        below("|Σ μ e| by Σ μ", 1e-14),
                    ],
                )
            },
        },
        Claim {
            says: "the frame only translates: the reference shape is the one at the start, moved by c",
            source: "report §2.2",
            judge: |r| {
                judged(
                    r,
                    &[below(
                        "largest difference of r from the shape at the start",
                        1e-14,
                    )],
                )
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let mut scene = changed_scene(ID, "soft-ball", &[("steps = 7000", "steps = 2450")])?;
    let run = to_the_end(ID, &mut scene)?;
    let mut record = Record::default();
    let Some(frame) = run.frames.iter().find(|frame| frame.step == STEP) else {
        return Err(SandboxError::refused(ID)(
            "the run did not reach the moment",
        ));
    };
    let snake = &scene.snake;
    let n = frame.nodes().len();
    let center = snake.center(frame.nodes());
    let mut e = vec![DVec2::ZERO; n];
    snake.deformation_into(frame.nodes(), &mut e);
    let rest = &snake.body().rest;
    let mass = snake.body().mass.to_vec(n);
    let total: f64 = mass.iter().sum();
    let begun = &scene.start.x;
    let origin = snake.center(begun);
    // what the picture of Figure 2.1 says, from the scene's text alone: equal masses, an ellipse
    let mean = frame.nodes().iter().sum::<DVec2>() / real(n);
    let ellipse = |i: usize| AXES * DVec2::from_angle(TAU * real(i) / real(n));
    let (mut off, mut moved) = (0.0_f64, 0.0_f64);
    let mut sums = [DVec2::ZERO; 3];
    for i in 0..n {
        off = off.max((frame.nodes()[i] - mean - ellipse(i) - e[i]).length());
        moved = moved.max((begun[i] - origin - rest[i]).length());
        let q = frame.nodes()[i] - center;
        for (sum, part) in sums.iter_mut().zip([q, rest[i], e[i]]) {
            *sum += part * mass[i];
        }
    }
    let tiny = Tolerance::Absolute(1e-14);
    record.note("time", frame.t, "s", Tolerance::ROUNDING);
    record.note(
        "largest difference of e from what the formulas leave of v",
        off,
        "",
        Tolerance::Absolute(1e-12),
    );
    for (name, sum) in ["q", "r", "e"].into_iter().zip(sums) {
        record.note(
            format!("|Σ μ {name}| by Σ μ"),
            sum.length() / total,
            "",
            tiny,
        );
    }
    record.note(
        "largest difference of r from the shape at the start",
        moved,
        "",
        tiny,
    );
    let columns: [(&str, &[DVec2]); 3] = [("v", frame.nodes()), ("r", rest), ("e", &e)];
    let mut table = Table::new("state");
    let close = Tolerance::Absolute(1e-6);
    for (name, vectors) in columns {
        table = table
            .with(
                format!("{name} x"),
                "",
                close,
                vectors.iter().map(|p| p.x).collect(),
            )
            .with(
                format!("{name} y"),
                "",
                close,
                vectors.iter().map(|p| p.y).collect(),
            );
    }
    record.keep(table);
    record.note("center x", center.x, "", close);
    record.note("center y", center.y, "", close);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let vectors = |name: &str| -> Result<Vec<DVec2>, SandboxError> {
        let points = record.points("state", &format!("{name} x"), &format!("{name} y"))?;
        Ok(points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect())
    };
    let (v, r) = (vectors("v")?, vectors("r")?);
    let c = DVec2::new(record.number("center x")?, record.number("center y")?);
    let reference: Vec<(f64, f64)> = r.iter().map(|&r| pair(c + r)).collect();
    let deformed: Vec<(f64, f64)> = v.iter().map(|&v| pair(v)).collect();
    let base = DVec2::new(-1.35, c.y - 2.1); // where the inertial frame is drawn; its true origin is off the page
    let arrow = |from: DVec2, to: DVec2, color: Color| Layer::Arrows {
        arrows: vec![(pair(from), pair(to - from))],
        color,
    };
    let words = |at: DVec2, words: &str, color: Color| Layer::Text {
        at: pair(at),
        words: words.to_owned(),
        color,
        centered: true,
    };
    let (low, high) = (c.y - 2.35, c.y + 1.55);
    let (left, right) = range(reference.iter().map(|p| p.0), 0.0);
    let (rest_end, node) = (c + r[NODE], v[NODE]);
    let mut panel = Panel::new(
        "",
        Axis::new("", left.min(base.x) - 0.25, right + 0.5),
        Axis::new("", low, high),
    )
    .equal()
    .bare()
    .with(Line::new(vec![(0.0, low + 0.5), (0.0, high)], Color::LIGHT).weighing(3.0))
    .with(
        Line::new(reference, Color::GREY)
            .closed()
            .dashed()
            .weighing(0.8),
    )
    .with(Line::new(deformed, Color::BLUE).closed())
    .with(Layer::Dots {
        points: v.iter().map(|&v| pair(v)).collect(),
        radius: 1.0,
        color: Color::BLUE,
        label: String::new(),
    });
    // the two frames
    for (origin, size, name, color) in [(base, 0.8, "Φ", Color::INK), (c, 0.55, "φ", Color::INK)]
    {
        panel = panel
            .with(arrow(origin, origin + DVec2::X * size, color))
            .with(arrow(origin, origin + DVec2::Y * size, color))
            .with(words(origin + DVec2::new(0.12, -0.12), name, color))
            .with(words(origin + DVec2::X * (size + 0.09), "x", color))
            .with(words(origin + DVec2::Y * (size + 0.1), "y", color));
    }
    let middle = |a: DVec2, b: DVec2, aside: DVec2| a.lerp(b, 0.5) + aside;
    panel = panel
        .with(arrow(base, c, Color::GREEN))
        .with(words(
            middle(base, c, DVec2::new(-0.1, 0.1)),
            "c",
            Color::GREEN,
        ))
        .with(arrow(c, rest_end, Color::ORANGE))
        .with(words(
            middle(c, rest_end, DVec2::new(0.12, -0.1)),
            "r",
            Color::ORANGE,
        ))
        .with(arrow(rest_end, node, Color::RED))
        .with(words(
            middle(rest_end, node, DVec2::new(0.0, 0.13)),
            "e",
            Color::RED,
        ))
        .with(arrow(c, node, Color::PURPLE))
        .with(words(
            middle(c, node, DVec2::new(-0.1, 0.1)),
            "q",
            Color::PURPLE,
        ))
        .with(arrow(base, node, Color::SKY))
        .with(words(
            base.lerp(node, 0.3) + DVec2::new(0.12, -0.08),
            "v",
            Color::SKY,
        ))
        .with(words(
            c + r[NODE * 2 + 26] + DVec2::new(0.15, -0.17),
            "reference shape",
            Color::GREY,
        ))
        .with(words(v[8] + DVec2::new(0.3, 0.14), "deformed", Color::BLUE))
        .with(words(DVec2::new(0.0, low + 0.4), "wall", Color::GREY));
    let figure = Figure::new(
        "Figure 2.1  A snake's shape is decomposed into reference and deformation",
        760.0,
    )
    .with(520.0, vec![panel]);
    Ok(vec![Artefact::figure(
        "The soft ball at the wall after 2.45 s, its node 4: v = c + r + e. The inertial frame Φ is drawn nearer than \
         it is, so c and v are shortened.",
        figure,
    )])
}
