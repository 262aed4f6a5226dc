//! A hand that takes a snake off a false edge, and lets go.

use super::story::{Story, Truth};
use crate::demand::{above, at_most, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel, Picture};
use crate::experiments::motion::Frames;
use crate::experiments::motion::{keep_energies, keep_frames, pair};
use crate::experiments::over_time::over_time;
use crate::experiments::pixels::grey;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use ndarray::s;

const ID: &str = "the-hand";
/// What is seen: left, top, right, bottom.
const WINDOW: [usize; 4] = [140, 0, 300, 110];
/// When the hand comes and goes.
const COMES: f64 = 200.0;
const GOES: f64 = 320.0;
/// A weaker edge than it sits on moves a node by some hundredths on another machine.
const PLACE: Tolerance = Tolerance::Absolute(0.05);

const PULL: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce = { kind = \"spring\", name = \"pull\", from = [204.0, 7.0], path = \
                    [[200.0, 204.0, 7.0], [260.0, 212.0, 66.0]], stiffness = 120.0 }\n";
const VOLCANO: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce = { kind = \"repulsor\", name = \"volcano\", path = \
                       [[200.0, 207.0, -40.0], [280.0, 207.0, 15.0]], reach = 50.0, push = 25.0 }\n";
const HELD: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nhold = [0, 30]\n\n[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce";

/// Its name, what is changed in the scene, and the names of its tables.
type Run = (
    &'static str,
    &'static [(&'static str, &'static str)],
    &'static str,
    &'static str,
);

/// The same start four times; what a hand does to it; names of the tables.
const RUNS: [Run; 4] = [
    ("alone", &[(PULL, "")], "alone", "alone-energy"),
    ("pulled", &[], "pulled", "pulled-energy"),
    ("pushed", &[(PULL, VOLCANO)], "pushed", "pushed-energy"),
    (
        "held and pulled",
        &[("[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce", HELD)],
        "held",
        "held-energy",
    ),
];

/// A spring, a push and a hold that come and go.
pub(crate) const HAND: Experiment = Experiment {
    id: ID,
    title: "A hand that comes and goes",
    place: "beyond",
    question: "Nothing tells this snake that the apple has a stem, and left alone it ends over its tip. A hand comes, pulls one point of it down with \
               a spring, or pushes from above, and goes. Does the snake stay where it was brought?",
    claims: &[
        Claim {
            says: "left alone it ends on the false edge",
            source: "the same run without",
            judge: |r| {
                judged(
                    r,
                    &[above("alone: farthest from the contour at the stem", 50.0)],
                )
            },
        },
        Claim {
            says: "a spring at one point, or a push from above, brings it to the true edge, and there it stays when the hand has gone",
            source: "kass88",
            judge: |r| {
                let far =
                    |n: &str| r.number(&format!("{n}: farthest from the contour at the stem"));
                let mean = |n: &str| r.number(&format!("{n}: mean distance at the end"));
                let good = far("pulled")? < 7.0
                    && far("pushed")? < 7.0
                    && mean("pulled")?.max(mean("pushed")?) < 1.5;
                Ok(Finding::new(
                    good,
                    format!(
                        "{:.1} and {:.1} px off the contour at most, at the foot of the stem; in the mean, outside the boxes of what disturbs, {:.2} and {:.2} px; \
                         alone {:.2}",
                        far("pulled")?,
                        far("pushed")?,
                        mean("pulled")?,
                        mean("pushed")?,
                        r.told("alone: mean distance at the end")?
                    ),
                ))
            },
        },
        Claim {
            says: "a stretch that is held meanwhile does not move at all, and goes on when it is let go",
            source: "Snake::hold",
            judge: |r| {
                judged(
                    r,
                    &[
                        at_most("way of the held stretch while held", 0.0),
                        above("way of the held stretch after", 0.01),
                    ],
                )
            },
        },
        Claim {
            says: "the account closes while hands come and go",
            source: "theory.md, section 15",
            judge: |r| {
                let mut most = 0.0_f64;
                for (name, ..) in RUNS {
                    most = most.max(r.number(&format!("{name}: gap of the account"))?);
                }
                Ok(Finding::new(
                    most < 1e-9,
                    format!("off by {most:.0e} of its largest term at most"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// Whether a place is at the stem.
fn at_the_stem(p: DVec2) -> bool {
    p.x > 170.0 && p.x < 250.0 && p.y < 80.0
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, changes, table, energy) in RUNS {
        let story = Story::of(ID, "apple-hand", changes, Truth::apple(ID)?)?;
        let end = story.last();
        let stem = end.iter().filter(|&&p| at_the_stem(p));
        let far = stem.fold(0.0_f64, |most, &p| most.max(story.truth.distance(p)));
        record.note(
            format!("{name}: farthest from the contour at the stem"),
            far,
            "px",
            Tolerance::Absolute(0.5),
        );
        record.note(
            format!("{name}: mean distance at the end"),
            story.truth.mean_distance(end).0,
            "px",
            PLACE,
        );
        let gone = story.at(GOES);
        let totals = story.run.frames.iter().filter_map(|f| f.energies.as_ref());
        let (mut first, mut off, mut largest) = (f64::NAN, 0.0_f64, 0.0_f64);
        for energies in totals {
            let total = energies.total();
            if first.is_nan() {
                first = total;
            }
            off = off.max((total - first).abs());
            for value in energies.values() {
                largest = largest.max(value.abs());
            }
        }
        record.note(
            format!("{name}: gap of the account"),
            off / largest,
            "of the largest term",
            Tolerance::Absolute(1e-10),
        );
        if name == "held and pulled" {
            let way = |from: &[DVec2], to: &[DVec2]| {
                let pairs = from.iter().zip(to).take(31);
                pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
            };
            record.note(
                "way of the held stretch while held",
                way(story.at(COMES), gone),
                "px",
                Tolerance::EXACT,
            );
            record.note(
                "way of the held stretch after",
                way(gone, end),
                "px",
                Tolerance::Absolute(0.2),
            );
        }
        keep_frames(&mut record, table, &story.run);
        keep_energies(&mut record, energy, &story.run);
        if name == "alone" {
            if let Some(picture) = &story.scene.picture {
                let [left, top, right, bottom] = WINDOW;
                let cut = picture
                    .levels()
                    .slice(s![top..bottom, left..right])
                    .to_owned();
                record.keep_grid("stem", cut);
            }
            let near = |p: &&DVec2| p.x > 130.0 && p.x < 310.0 && p.y < 130.0;
            let contour: Vec<DVec2> = story.truth.contour.iter().filter(near).copied().collect();
            record.keep(
                Table::raw("contour")
                    .with(
                        "x",
                        "px",
                        Tolerance::EXACT,
                        contour.iter().map(|p| p.x).collect(),
                    )
                    .with(
                        "y",
                        "px",
                        Tolerance::EXACT,
                        contour.iter().map(|p| p.y).collect(),
                    ),
            );
        }
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let [left, top, right, bottom] = WINDOW.map(real);
    let ground = grey(record.grid("stem")?);
    let contour = record.points("contour", "x", "y")?;
    let mut row = Vec::new();
    for (table, title, hand) in [
        ("alone", "left alone", None),
        (
            "pulled",
            "one point is pulled",
            Some((DVec2::new(204.0, 7.0), DVec2::new(212.0, 66.0))),
        ),
        (
            "pushed",
            "a push from above",
            Some((DVec2::new(207.0, 0.0), DVec2::new(207.0, 15.0))),
        ),
    ] {
        let frames = Frames::of(record, table)?;
        let mut panel = Panel::new(
            title,
            Axis::new("", left - 0.5, right - 0.5),
            Axis::new("", bottom - 0.5, top - 0.5),
        )
        .equal()
        .bare()
        .with(Picture::new(ground.clone()).over([left - 0.5, top - 0.5, right - 0.5, bottom - 0.5]))
        .with(Line::new(contour.clone(), Color::GREEN).weighing(0.8));
        let moments: &[f64] = if hand.is_some() {
            &[0.0, 200.0, 230.0, 245.0, 260.0, 275.0, 420.0]
        } else {
            &[0.0, 200.0, 420.0]
        };
        for (k, &t) in moments.iter().enumerate() {
            let (color, weight) = match k {
                0 => (Color::YELLOW, 0.7),
                _ if k + 1 == moments.len() => (Color::SKY, 1.8),
                _ => (Color::RED, 0.7),
            };
            let line = Line::new(frames.curve(frames.nearest(t)), color);
            panel = panel.with(line.weighing(weight));
        }
        if let Some((from, to)) = hand {
            panel = panel
                .with(
                    Line::new(vec![pair(from), pair(to)], Color::WHITE)
                        .weighing(0.8)
                        .dashed(),
                )
                .with(Layer::Dots {
                    points: vec![pair(to)],
                    radius: 3.0,
                    color: Color::WHITE,
                    label: String::new(),
                });
        }
        row.push(panel);
    }
    let mut height = Panel::new(
        "highest node",
        Axis::new("t / s", 0.0, 420.0),
        Axis::new("y / px", 70.0, 0.0),
    )
    .legend_at(Corner::BottomLeft);
    for (table, color) in [
        ("alone", Color::RED),
        ("pulled", Color::BLUE),
        ("pushed", Color::GREEN),
    ] {
        let frames = Frames::of(record, table)?;
        let tops = (0..frames.len()).map(|k| {
            let near = frames.nodes(k).into_iter().filter(|&p| at_the_stem(p));
            (frames.t(k), near.map(|p| p.y).fold(f64::INFINITY, f64::min))
        });
        let tops: Vec<(f64, f64)> = tops.filter(|p| p.1.is_finite()).collect();
        height = height.with(Line::new(tops, color).named(table));
    }
    for t in [COMES, GOES] {
        height = height.with(
            Line::new(vec![(t, 0.0), (t, 70.0)], Color::GREY)
                .dashed()
                .weighing(0.6),
        );
    }
    let energy = over_time(
        record,
        "pushed-energy",
        &[
            ("volcano", "minus the work of the push", Color::GREEN),
            ("elastic", "elastic", Color::RED),
        ],
        "energies, pushed",
        "energy",
    )?
    .legend_at(Corner::BottomLeft);
    Ok(vec![Artefact::figure(
        "Yellow: the start; red: on the way; blue: the end, a hundred units of time after the hand has gone; green: the contour by hand; white: the way of the hand. \
         Below: the highest node at the stem, the hand's time between the dashed lines.",
        Figure::new("A hand that comes and goes", 1000.0)
            .with(250.0, row)
            .with(230.0, vec![height, energy]),
    )])
}
