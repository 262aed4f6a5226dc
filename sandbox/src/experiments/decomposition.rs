//! Figure 2.1: a snake's shape is decomposed into reference and deformation, from a real state.

use crate::prelude::*;
use std::f64::consts::TAU;

/// The node whose vectors are drawn.
const NODE: usize = 4;
/// The moment: the soft ball about to be squeezed most.
const STEP: u64 = 2450;
/// Half axes of the ellipse in the scene's text.
const AXES: DVec2 = DVec2::new(1.5, 1.0);

/// Figure 2.1: v = c + r + e.
pub(crate) const DECOMPOSITION: Experiment = Experiment {
    id: "fig-2-1",
    title: "Reference and deformation",
    place: "Figure 2.1",
    question: "The soft ball of Figure 2.3 at the wall: is every node where its center of mass, its reference shape \
               and its deformation together say?",
    claims: &[
        claim("q = r + e, and v = c + q [report Eq. 2.2]").when(&[below(
            "largest difference of e from what the formulas leave of v",
            1e-12,
        )]),
        claim(
            "c is the center of mass: Σ μ q = 0, and so Σ μ e = 0 when Σ μ r = 0 [report §2.2, D9]",
        )
        .when(&[below("|Σ μ * by Σ μ", 1e-14)]),
        claim("the frame only translates: the reference shape is that of the start [report §2.2]")
            .when(&[below(
                "largest difference of r from the shape at the start",
                1e-14,
            )]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let (scene, run) = ran("soft-ball", &[("steps = 7000", "steps = 2450")])?;
    let mut record = Record::default();
    let frame = run.frames.iter().find(|frame| frame.step == STEP);
    let frame = frame.ok_or_else(|| refused("the run did not reach the moment"))?;
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
    let middle = frame.nodes().iter().sum::<DVec2>() / real(n);
    let ellipse = |i: usize| AXES * DVec2::from_angle(TAU * real(i) / real(n));
    let off = (0..n).map(|i| (frame.nodes()[i] - middle - ellipse(i) - e[i]).length());
    let moved = (0..n).map(|i| (begun[i] - origin - rest[i]).length());
    let sum = |vector: &dyn Fn(usize) -> DVec2| (0..n).map(|i| vector(i) * mass[i]).sum::<DVec2>();
    let sums = [
        ("q", sum(&|i| frame.nodes()[i] - center)),
        ("r", sum(&|i| rest[i])),
        ("e", sum(&|i| e[i])),
    ];
    record.note("time [s]", frame.t, ROUNDING);
    record.note(
        "largest difference of e from what the formulas leave of v",
        most(off),
        1e-12,
    );
    for (name, sum) in sums {
        record.note(format!("|Σ μ {name}| by Σ μ"), sum.length() / total, 1e-14);
    }
    record.note(
        "largest difference of r from the shape at the start",
        most(moved),
        1e-14,
    );
    let columns: [(&str, &[DVec2]); 3] = [("v", frame.nodes()), ("r", rest), ("e", &e)];
    let mut table = Table::new("state");
    for (name, vectors) in columns {
        table = table
            .with(format!("{name} x"), 1e-6, vectors.iter().map(|p| p.x))
            .with(format!("{name} y"), 1e-6, vectors.iter().map(|p| p.y));
    }
    record.keep(table);
    record.note("center x", center.x, 1e-6);
    record.note("center y", center.y, 1e-6);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let vectors = |name: &str| -> Result<Vec<DVec2>> {
        let points = record.points("state", &format!("{name} x"), &format!("{name} y"))?;
        Ok(points.into_iter().map(DVec2::from).collect())
    };
    let (v, r) = (vectors("v")?, vectors("r")?);
    let c = DVec2::new(record.told("center x")?, record.told("center y")?);
    let reference: Vec<DVec2> = r.iter().map(|&r| c + r).collect();
    // where the inertial frame is drawn; its true origin is off the page
    let base = DVec2::new(-1.35, c.y - 2.1);
    let (low, high) = (c.y - 2.35, c.y + 1.55);
    let (left, right) = range(reference.iter().map(|p| p.x), 0.0);
    let mut panel = plot(
        "",
        ("", left.min(base.x) - 0.25, right + 0.5),
        ("", low, high),
    )
    .equal()
    .bare()
    .with(line([(0.0, low + 0.5), (0.0, high)], Color::LIGHT).weighing(3.0))
    .with(
        line(pairs(&reference), Color::GREY)
            .closed()
            .dashed()
            .weighing(0.8),
    )
    .with(line(pairs(&v), Color::BLUE).closed())
    .with(dots(pairs(&v), 1.0, Color::BLUE));
    let (x, y, ink) = (DVec2::X, DVec2::Y, Color::INK);
    for (origin, size, name) in [(base, 0.8, "Φ"), (c, 0.55, "φ")] {
        panel = panel
            .with(arrow(origin, x * size, ink))
            .with(arrow(origin, y * size, ink))
            .with(text(origin + DVec2::new(0.12, -0.12), name, ink))
            .with(text(origin + x * (size + 0.09), "x", ink))
            .with(text(origin + y * (size + 0.1), "y", ink));
    }
    let (rest, node) = (c + r[NODE], v[NODE]);
    for (from, to, share, aside, name, color) in [
        (base, c, 0.5, (-0.1, 0.1), "c", Color::GREEN),
        (c, rest, 0.5, (0.12, -0.1), "r", Color::ORANGE),
        (rest, node, 0.5, (0.0, 0.13), "e", Color::RED),
        (c, node, 0.5, (-0.1, 0.1), "q", Color::PURPLE),
        (base, node, 0.3, (0.12, -0.08), "v", Color::SKY),
    ] {
        let at = from.lerp(to, share) + DVec2::from(aside);
        panel = panel
            .with(arrow(from, to - from, color))
            .with(text(at, name, color));
    }
    let beside = reference[NODE * 2 + 26] + DVec2::new(0.15, -0.17);
    panel = panel
        .with(text(beside, "reference shape", Color::GREY))
        .with(text(v[8] + DVec2::new(0.3, 0.14), "deformed", Color::BLUE))
        .with(text((0.0, low + 0.4), "wall", Color::GREY));
    let title = "Figure 2.1  A snake's shape is decomposed into reference and deformation";
    Artefact::only(
        "The soft ball at the wall after 2.45 s, its node 4: v = c + r + e. The inertial frame Φ is drawn nearer than \
         it is, so c and v are shortened.",
        Figure::new(title, 760.0).with(520.0, vec![panel]),
    )
}
