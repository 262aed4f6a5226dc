//! A hand that takes a snake off a false edge, and lets go.

use super::story::{Story, Truth};
use crate::prelude::*;
use ndarray::s;

/// What is seen: left, top, right, bottom.
const WINDOW: [usize; 4] = [140, 0, 300, 110];
/// When the hand comes and goes.
const COMES: f64 = 200.0;
const GOES: f64 = 320.0;
/// A weaker edge than it sits on moves a node by some hundredths on another machine.
const PLACE: f64 = 0.05;

const PULL: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce = { kind = \"spring\", name = \"pull\", from = [204.0, 7.0], path = \
                    [[200.0, 204.0, 7.0], [260.0, 212.0, 66.0]], stiffness = 120.0 }\n";
const VOLCANO: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce = { kind = \"repulsor\", name = \"volcano\", path = \
                       [[200.0, 207.0, -40.0], [280.0, 207.0, 15.0]], reach = 50.0, push = 25.0 }\n";
const HELD: &str = "[[hand]]\nfrom = 200.0\nuntil = 320.0\nhold = [0, 30]\n\n[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce";

/// The same start four times, and what is changed in the scene.
const RUNS: [(&str, Changes); 4] = [
    ("alone", &[(PULL, "")]),
    ("pulled", &[]),
    ("pushed", &[(PULL, VOLCANO)]),
    (
        "held and pulled",
        &[("[[hand]]\nfrom = 200.0\nuntil = 320.0\nforce", HELD)],
    ),
];

/// A spring, a push and a hold that come and go.
pub(crate) const HAND: Experiment = Experiment {
    id: "the-hand",
    title: "A hand that comes and goes",
    place: "beyond",
    question: "Nothing tells this snake that the apple has a stem, and left alone it ends over its tip. A hand comes, pulls one point of it down with \
               a spring, or pushes from above, and goes. Does the snake stay where it was brought?",
    claims: &[
        claim("left alone it ends on the false edge [the same run without]")
            .when(&[above("alone: farthest from the contour at the stem", 50.0)]),
        claim("a spring at one point, or a push from above, brings it to the true edge, and there it \
               stays when the hand has gone [[kass88]]")
            .when(&[
                below("pulled: farthest from the contour at the stem", 7.0),
                below("pushed: farthest from the contour at the stem", 7.0),
                below("pulled: mean distance at the end", 1.5),
                below("pushed: mean distance at the end", 1.5),
            ]),
        claim("a stretch that is held meanwhile does not move, and goes on when it is let go [Snake::hold]")
            .when(&[
                at_most("way of the held stretch while held", 0.0),
                above("way of the held stretch after", 0.01),
            ]),
        claim("the account closes while hands come and go [theory §15]")
            .when(&[below("*: gap of the account", 1e-9)]),
    ],
    run,
    draw,
};

/// Whether a place is at the stem.
fn at_the_stem(p: DVec2) -> bool {
    p.x > 170.0 && p.x < 250.0 && p.y < 80.0
}

fn run() -> Result {
    let mut record = Record::default();
    for (name, changes) in RUNS {
        let story = Story::of("apple-hand", changes, Truth::apple()?)?;
        let (gone, end) = (story.at(GOES), story.last());
        let stem = end.iter().filter(|&&p| at_the_stem(p));
        let far = most(stem.map(|&p| story.truth.distance(p)));
        let mut own = record.under(name);
        own.note("farthest from the contour at the stem [px]", far, 0.5);
        let off = story.truth.mean_distance(end).0;
        own.note("mean distance at the end [px]", off, PLACE);
        let rows = story.run.frames.iter();
        let rows = rows.filter_map(|frame| Some((frame.t, frame.energies.as_ref()?.values())));
        let rows: Vec<(f64, Vec<f64>)> = rows.collect();
        let largest = most(rows.iter().flat_map(|row| &row.1).map(|value| value.abs()));
        let gap = stray(&rows) / largest;
        own.note("gap of the account [of the largest term]", gap, 1e-10);
        if name == "held and pulled" {
            let way = |from: &[DVec2], to: &[DVec2]| {
                most(from.iter().zip(to).take(31).map(|(a, b)| a.distance(*b)))
            };
            let held = way(story.at(COMES), gone);
            record.note("way of the held stretch while held [px]", held, EXACT);
            record.note("way of the held stretch after [px]", way(gone, end), 0.2);
        }
        record.keep_run(name, &story.run);
        if name == "alone" {
            if let Some(picture) = &story.scene.picture {
                let [left, top, right, bottom] = WINDOW;
                let cut = picture
                    .levels()
                    .slice(s![top..bottom, left..right])
                    .to_owned();
                record.keep_grid("stem", cut);
            }
            let mut contour = story.truth.contour.clone();
            contour.retain(|p| p.x > 130.0 && p.x < 310.0 && p.y < 130.0);
            record.keep_points("contour", &contour);
        }
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let extent = WINDOW.map(|edge| real(edge) - 0.5);
    let [left, top, right, bottom] = extent;
    let ground = grey(record.grid("stem")?);
    let contour = line(record.xy("contour")?, Color::GREEN).weighing(0.8);
    let (time, place) = (("t / s", 0.0, 420.0), ("y / px", 70.0, 0.0));
    let mut height = plot("highest node", time, place).legend_at(Corner::BottomLeft);
    let mut row = Vec::new();
    for (name, title, color, way) in [
        ("alone", "left alone", Color::RED, None),
        (
            "pulled",
            "one point is pulled",
            Color::BLUE,
            Some([(204.0, 7.0), (212.0, 66.0)]),
        ),
        (
            "pushed",
            "a push from above",
            Color::GREEN,
            Some([(207.0, 0.0), (207.0, 15.0)]),
        ),
    ] {
        let frames = record.run(name)?;
        let mut panel = plot(title, ("", left, right), ("", bottom, top))
            .equal()
            .bare()
            .with(Picture::new(ground.clone()).over(extent))
            .with(contour.clone());
        let moments: &[f64] = match way {
            Some(_) => &[0.0, 200.0, 230.0, 245.0, 260.0, 275.0, 420.0],
            None => &[0.0, 200.0, 420.0],
        };
        for (k, &t) in moments.iter().enumerate() {
            let (color, weight) = match k {
                0 => (Color::YELLOW, 0.7),
                _ if k + 1 == moments.len() => (Color::SKY, 1.8),
                _ => (Color::RED, 0.7),
            };
            panel = panel.with(line(frames.pairs(frames.nearest(t)), color).weighing(weight));
        }
        if let Some(way) = way {
            panel = panel
                .with(line(way, Color::WHITE).weighing(0.8).dashed())
                .with(dots([way[1]], 3.0, Color::WHITE));
        }
        row.push(panel);
        let top = |k| {
            least(
                frames
                    .nodes(k)
                    .iter()
                    .filter(|p| at_the_stem(**p))
                    .map(|p| p.y),
            )
        };
        let tops = (0..frames.len()).map(|k| (frames.t(k), top(k)));
        height = height.with(line(tops.filter(|p| p.1.is_finite()), color).named(name));
    }
    for t in [COMES, GOES] {
        height = height.with(
            line([(t, 0.0), (t, 70.0)], Color::GREY)
                .dashed()
                .weighing(0.6),
        );
    }
    let terms = [
        ("volcano", "minus the work of the push", Color::GREEN),
        ("elastic", "elastic", Color::RED),
    ];
    let energy = energies(record, "pushed", &terms, "energies, pushed")?;
    Artefact::only(
        "Yellow: the start; red: on the way; blue: the end, a hundred units of time after the hand has gone; green: the contour by hand; white: the way of the hand. \
         Below: the highest node at the stem, the hand's time between the dashed lines.",
        Figure::new("A hand that comes and goes", 1000.0)
            .with(250.0, row)
            .with(230.0, vec![height, energy.legend_at(Corner::BottomLeft)]),
    )
}
