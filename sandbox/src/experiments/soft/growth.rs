//! A rest shape that grows into its object, and carries its form to where no edge is seen.

use super::course::{advance, crowd_of, gap, keep_shots, picture, shots, times};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel, Picture};
use crate::experiments::motion::changed_scene;
use crate::experiments::pixels::grey;
use crate::{Artefact, Claim, Experiment, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;

const ID: &str = "soft-growth";
/// The ellipse of the scene growing-cell, and where the bright thing that hides its end begins.
const ELLIPSE: (DVec2, DVec2) = (DVec2::new(64.0, 48.0), DVec2::new(44.0, 18.0));
const HIDDEN: f64 = 96.0;
const RATE: f64 = 0.005;
/// Its name, its table, and what is changed in the scene.
type Run = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

/// Growth, none, and a balloon instead of a memory.
const RUNS: [Run; 3] = [
    ("grows", "grows", &[]),
    (
        "does not grow",
        "still",
        &[("growth = 0.005", "growth = 0.0")],
    ),
    (
        "balloon",
        "balloon",
        &[
            ("growth = 0.005", "growth = 0.0"),
            ("tether = 2.0", "tether = 0.0"),
            (
                "[snake]",
                "[[force]]\nkind = \"pressure\"\npressure = 3.0\n\n[snake]",
            ),
        ],
    ),
];

/// Growth of the rest shape.
pub(crate) const GROWTH: Experiment = Experiment {
    id: ID,
    title: "A rest shape that grows",
    place: "beyond",
    question: "A cell of known form grows at a known rate; one end of it lies hidden under something as bright. A snake of that form starts at half the size. \
               Does its rest shape grow at the rate it is told, does it find the border, and does it know where the hidden end is?",
    claims: &[
        Claim {
            says: "the rest shape grows as e to the rate times the time",
            source: "Upkeep::growth",
            judge: |r| judged(r, &[below("rest shape against the exponential", 1e-12)]),
        },
        Claim {
            says: "the border is found, and the hidden end is where its form says",
            source: "memory of shape",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("grows: mean distance where it is seen", 0.5),
                        below("grows: farthest where it is hidden", 3.5),
                    ],
                )
            },
        },
        Claim {
            says: "without growth the memory of its size keeps it from the border; a balloon without memory leaks through the hidden end and floods the picture: no border holds it",
            source: "the same run without",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("does not grow: mean distance where it is seen", 5.0),
                        above("balloon: mean distance where it is seen", 5.0),
                        above("balloon: farthest where it is hidden", 30.0),
                    ],
                )
            },
        },
        Claim {
            says: "the account closes, what growth puts in counted in",
            source: "the ledger of a crowd",
            judge: |r| judged(r, &[below("grows: gap of the account", 1e-9)]),
        },
    ],
    run,
    draw,
};

/// Distance from the ellipse.
fn off(p: DVec2) -> f64 {
    let around = (0..1440).map(|k| DVec2::from_angle(std::f64::consts::TAU * real(k) / 1440.0));
    let each = around.map(|u| p.distance(ELLIPSE.0 + ELLIPSE.1 * u));
    each.fold(f64::INFINITY, f64::min)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, table, changes) in RUNS {
        let scene = changed_scene(ID, "growing-cell", changes)?;
        if let (true, Some(picture)) = (name == "grows", &scene.picture) {
            record.keep_grid("cell", picture.levels().clone());
        }
        let mut crowd = crowd_of(ID, &scene)?;
        let size = |crowd: &snake::Simulation| crowd.members()[0].snake().body().rest[0].length();
        let first = size(&crowd);
        let (mut kept, mut rows, mut t, mut grown) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for step in 0..=scene.plan.until.steps {
            if step > 0 {
                advance(ID, &mut crowd)?;
            }
            if step.is_multiple_of(50) {
                let e = crowd.energies();
                let named = [e.kinetic, e.elastic(), e.forces[0], e.damping, e.parameters];
                let rest = e.total() - named.iter().sum::<f64>();
                rows.push([named[0], named[1], named[2], named[3], named[4], rest]);
                t.push(crowd.t());
                grown.push(size(&crowd) / first);
            }
            let early = name == "balloon" && [60, 120, 200, 300].contains(&step);
            if early || step.is_multiple_of(460) || step == scene.plan.until.steps {
                kept.push((crowd.t(), 0, true, crowd.members()[0].state().x.clone()));
            }
        }
        let end = &crowd.members()[0].state().x;
        let (mut sum, mut count, mut hidden) = (0.0, 0.0, 0.0_f64);
        for &p in end {
            if p.x < HIDDEN - 4.0 {
                sum += off(p);
                count += 1.0;
            } else {
                hidden = hidden.max(off(p));
            }
        }
        let close = Tolerance::Absolute(0.05);
        record.note(
            format!("{name}: mean distance where it is seen"),
            sum / count,
            "px",
            close,
        );
        // a snake that keeps its size has no node there
        if name != "does not grow" {
            record.note(
                format!("{name}: farthest where it is hidden"),
                hidden,
                "px",
                Tolerance::Absolute(0.3),
            );
        }
        record.note(
            format!("{name}: gap of the account"),
            gap(&rows),
            "of the largest term",
            Tolerance::Absolute(1e-9),
        );
        if name == "grows" {
            let pairs = t.iter().zip(&grown);
            let worst = pairs.map(|(t, g)| (g / (RATE * t).exp() - 1.0).abs());
            record.note(
                "rest shape against the exponential",
                worst.fold(0.0, f64::max),
                "",
                Tolerance::Absolute(1e-12),
            );
            record.note(
                "growth at the end",
                *grown.last().unwrap_or(&0.0),
                "",
                Tolerance::Relative(1e-9),
            );
            record.keep(
                Table::raw("growth")
                    .with("t", "s", Tolerance::EXACT, t)
                    .with("growth", "", Tolerance::EXACT, grown),
            );
        }
        keep_shots(&mut record, table, &kept);
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let ground = grey(record.grid("cell")?);
    let truth: Vec<(f64, f64)> = (0..=180)
        .map(|k| ELLIPSE.0 + ELLIPSE.1 * DVec2::from_angle(std::f64::consts::TAU * real(k) / 180.0))
        .map(|p| (p.x, p.y))
        .collect();
    let mut row = Vec::new();
    for ((_, table, _), title) in RUNS.iter().zip([
        "its rest shape grows",
        "it does not grow",
        "a balloon without memory",
    ]) {
        let all = shots(record, table)?;
        let mut panel = Panel::pixels(title, 144, 96)
            .bare()
            .with(Picture::new(ground.clone()))
            .with(
                Line::new(truth.clone(), Color::GREEN)
                    .dashed()
                    .weighing(0.9),
            );
        let count = times(&all).len();
        for (k, shot) in all.iter().enumerate() {
            let (color, weight) = match k {
                0 => (Color::YELLOW, 1.0),
                _ if k + 1 == count => (Color::SKY, 2.0),
                _ => (Color::RED, 0.6),
            };
            panel = panel.with(Line::new(shot.points.clone(), color).weighing(weight));
        }
        row.push(panel);
    }
    let exact = (0..=70).map(|k| (2.0 * real(k), (RATE * 2.0 * real(k)).exp()));
    let sizes = Panel::new(
        "size of the rest shape over that at the start",
        Axis::new("t / s", 0.0, 140.0),
        Axis::new("", 0.9, 2.1),
    )
    .legend_at(Corner::TopLeft)
    .with(Line::new(exact.collect(), Color::GREEN).named("e to the 0.005 t"))
    .with(Layer::Dots {
        points: record
            .points("growth", "t", "growth")?
            .into_iter()
            .step_by(4)
            .collect(),
        radius: 2.0,
        color: Color::INK,
        label: "of the snake".to_owned(),
    });
    let last = shots(record, "grows")?;
    let end = times(&last).last().copied().unwrap_or(0.0);
    let close = picture(
        "the hidden end",
        &last,
        end,
        [84.0, 70.0, 116.0, 26.0],
        &|_| Color::BLUE,
    )
    .with(Line::new(truth, Color::GREEN).dashed())
    .with(Line::new(vec![(HIDDEN, 26.0), (HIDDEN, 70.0)], Color::GREY));
    Ok(vec![Artefact::figure(
        "Above: the start (yellow), on the way (red), the end (blue) and the cell (green, dashed), whose right end is hidden. Below: the size of the rest shape, \
         and the hidden end close by; grey: from where on it is hidden.",
        Figure::new("A rest shape that grows", 1000.0)
            .with(240.0, row)
            .with(240.0, vec![sizes, close]),
    )])
}
