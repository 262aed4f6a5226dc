//! Report chapter 1: an object followed through frames, by a body that flies where it is not seen.

use fit::{Contour, Image};
use score::sequences::{Sequence, sequences};
use track::{Options, Start, Tracked, Tracker};

use crate::prelude::*;

/// Drawn sequences in which one frame is predicted from the one before.
const PREDICTED: [&str; 6] = [
    "move_const",
    "move_fall",
    "kick",
    "turn",
    "breathe",
    "camera",
];

/// The frame of the kick.
const KICK: usize = 20;

/// Rules of prediction, and how they are drawn.
const RULES: [(&str, Color); 3] = [
    ("still", Color::GREY),
    ("velocity", Color::RED),
    ("flow", Color::BLUE),
];

/// Predicted, hidden, kicked.
pub(crate) const FOLLOWED: Experiment = Experiment {
    id: "ch-1-followed",
    title: "Followed through frames",
    place: "chapter 1",
    question: "\"The snake could track this object through time because the snake is a dynamic model with a mass.\" What does mass give, and what must be \
               measured? Drawn sequences whose true outlines are formulas, followed from the exact outline of the first frame.",
    claims: &[
        claim("a body at a constant velocity is where its inertia says [report chapter 1]")
            .when(&[above("move_const: worst step by velocity", 0.98)]),
        claim("a kick is none of inertia's: the flow of the picture sees it").when(&[
            below("kick: worst step by velocity", 0.2),
            above("kick: worst step by flow", 0.85),
        ]),
        claim("what jerks with the camera goes where flow says, and not where it went before")
            .when(&[
                below("camera: worst step by velocity", 0.7),
                above("camera: worst step by flow", 0.9),
            ]),
        claim("while nothing is seen, a body with motion flies on: overlap with where it is").when(
            &[
                above("vanish: least overlap in the gap", 0.8),
                below("vanish: least overlap in the gap without motion", 0.6),
            ],
        ),
        claim("it is found again: the frames after the gap")
            .when(&[above("vanish: mean overlap after the gap", 0.95)]),
        claim("behind a bar the shape is remembered, and found again beyond it").when(&[
            above("occluded: mean overlap", 0.9),
            above("occluded: last overlap", 0.95),
        ]),
        claim("the kicked ball is held in every frame").when(&[above("kick: least overlap", 0.9)]),
    ],
    run,
    draw,
};

fn named(name: &str) -> Result<Sequence> {
    let mut all = sequences().into_iter();
    all.find(|sequence| sequence.name == name)
        .ok_or_else(|| refused(format!("no drawn sequence {name}")))
}

/// The true outline of a frame, as far as it is seen; empty where nothing of it is.
fn truth(sequence: &Sequence, frame: usize) -> Vec<DVec2> {
    sequence
        .truth(frame)
        .into_iter()
        .next()
        .map(|(_, points)| points)
        .unwrap_or_default()
}

/// The whole body, seen or not.
fn body(sequence: &Sequence, frame: usize) -> Vec<DVec2> {
    sequence
        .bodies(frame)
        .into_iter()
        .next()
        .map(|(_, points)| points)
        .unwrap_or_default()
}

fn overlap(sequence: &Sequence, a: &[DVec2], b: &[DVec2]) -> f64 {
    let [width, height] = sequence.size;
    let mask = |points: &[DVec2]| score::filled(&[points], (height, width));
    score::iou(&mask(a), &mask(b)).unwrap_or(0.0)
}

fn middle(points: &[DVec2]) -> DVec2 {
    elastic::centroid(points).unwrap_or_default()
}

/// The true outline of the frame before, moved by a rule: its overlap with the truth.
fn predicted(sequence: &Sequence, rule: &str, frame: usize) -> f64 {
    let before = body(sequence, frame - 1);
    let moved: Vec<DVec2> = match rule {
        "velocity" if frame > 1 => {
            let way = middle(&before) - middle(&body(sequence, frame - 2));
            before.iter().map(|p| *p + way).collect()
        }
        "flow" => {
            let pyramid = |frame| flow::Pyramid::of(sequence.frame(frame).mapv(narrow), 5);
            let inside: Vec<DVec2> = before
                .iter()
                .step_by(40)
                .map(|p| p.lerp(middle(&before), 0.1))
                .collect();
            let rules = flow::Rules::default();
            let moved = flow::carry(&pyramid(frame - 1), &pyramid(frame), &inside, &rules);
            let pairs = inside
                .iter()
                .zip(&moved)
                .filter_map(|(p, moved)| moved.map(|moved| (*p, moved.to)));
            let (from, to): (Vec<DVec2>, Vec<DVec2>) = pairs.unzip();
            let motion = flow::similarity(&from, &to, &vec![1.0; from.len()]);
            let motion = motion.unwrap_or(flow::Similarity::STILL);
            before.iter().map(|p| motion.at(*p)).collect()
        }
        _ => before,
    };
    overlap(sequence, &moved, &body(sequence, frame))
}

#[allow(clippy::cast_possible_truncation, reason = "grey levels")]
fn narrow(level: f64) -> f32 {
    level as f32
}

/// What the tracker says of each frame from the second on.
fn followed(sequence: &Sequence) -> Result<Vec<Tracked>> {
    let image = |frame| Image::grey(sequence.frame(frame));
    let start = Contour::closed(truth(sequence, 0));
    let options = Options {
        start: Start::Exact,
        ..Options::default()
    };
    let tracker = Tracker::new(&image(0), &[start], &options);
    let mut tracker = tracker.map_err(|error| refused(error.to_string()))?;
    let next = |frame| {
        tracker
            .next(&image(frame))
            .map_err(|error| refused(error.to_string()))
    };
    (1..sequence.frames()).map(next).collect()
}

fn points(tracked: &Tracked) -> Vec<DVec2> {
    tracked
        .outlines
        .first()
        .map(|outline| outline.points.clone())
        .unwrap_or_default()
}

fn run() -> Result {
    let mut record = Record::default();
    for name in PREDICTED {
        let sequence = named(name)?;
        let frames = || (2..sequence.frames()).map(real);
        let mut table = Table::raw(name).exact("frame", frames());
        for (rule, _) in RULES {
            let all: Vec<f64> = (2..sequence.frames())
                .map(|frame| predicted(&sequence, rule, frame))
                .collect();
            record.under(name).note(
                &format!("worst step by {rule}"),
                least(all.iter().copied()),
                0.01,
            );
            table = table.exact(rule, all);
        }
        record.keep(table);
    }
    for (name, table) in [
        ("vanish", "over-vanish"),
        ("occluded", "over-occluded"),
        ("kick", "over-kick"),
    ] {
        let sequence = named(name)?;
        let followed = followed(&sequence)?;
        let frames = || followed.iter().map(|tracked| tracked.frame);
        let own = |tracked: &Tracked| {
            overlap(&sequence, &points(tracked), &body(&sequence, tracked.frame))
        };
        let all: Vec<f64> = followed.iter().map(own).collect();
        // left where it was before the gap
        let stays = |frame: usize| {
            overlap(
                &sequence,
                &body(&sequence, frame.min(14)),
                &body(&sequence, frame),
            )
        };
        let still: Vec<f64> = frames().map(stays).collect();
        let seen = |tracked: &Tracked| {
            flag(
                tracked
                    .outlines
                    .first()
                    .is_some_and(|outline| outline.state.is_seen()),
            )
        };
        let mut notes = record.under(name);
        if name == "vanish" {
            let gap = |values: &[f64]| least(values[14..19].iter().copied());
            notes.note("least overlap in the gap", gap(&all), 0.01);
            notes.note("least overlap in the gap without motion", gap(&still), 0.01);
            notes.note(
                "mean overlap after the gap",
                mean(all[19..].iter().copied()),
                0.01,
            );
        } else {
            notes.note("mean overlap", mean(all.iter().copied()), 0.01);
            notes.note("least overlap", least(all.iter().copied()), 0.02);
            notes.note("last overlap", all.last().copied().unwrap_or(0.0), 0.01);
        }
        record.keep(
            Table::raw(table)
                .exact("frame", frames().map(real))
                .exact("overlap", all)
                .exact("without motion", still)
                .exact("seen", followed.iter().map(seen)),
        );
        if name == "kick" {
            for tracked in followed
                .iter()
                .filter(|tracked| tracked.frame.abs_diff(KICK) < 3)
            {
                let ring = points(tracked);
                record.keep(Table::raw(shot(tracked.frame)).xy("px", EXACT, &ring));
                record.grids.push((
                    shot(tracked.frame).to_owned(),
                    sequence.frame(tracked.frame),
                ));
            }
        }
    }
    Ok(record)
}

/// The name of a frame about the kick.
const fn shot(frame: usize) -> &'static str {
    match frame {
        18 => "frame 18",
        19 => "frame 19",
        20 => "frame 20",
        21 => "frame 21",
        _ => "frame 22",
    }
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("Chapter 1  Followed through frames", 1000.0);
    let mut shots = Vec::new();
    for frame in [19, 20, 21, 22] {
        let name = shot(frame);
        let grid = record.grid(name)?;
        let panel = Panel::pixels(format!("kicked, frame {frame}"), 192, 192)
            .with(Picture::new(grey(grid)))
            .with(line(record.xy(name)?, Color::RED).closed())
            .bare();
        shots.push(panel);
    }
    figure = figure.with(255.0, shots);
    let mut panels = Vec::new();
    for (table, title) in [
        ("over-vanish", "absent in frames 15 to 19"),
        ("over-occluded", "behind a bar"),
    ] {
        let mut panel = plot(title, ("frame", 0.0, 40.0), ("overlap", 0.0, 1.05));
        panel = panel
            .with(line(record.points(table, "frame", "overlap")?, Color::GREEN).named("followed"));
        if table == "over-vanish" {
            let still = record.points(table, "frame", "without motion")?;
            panel = panel.with(line(still[..19].to_vec(), Color::GREY).named("left where it was"));
        }
        let hidden: Vec<(f64, f64)> = record
            .points(table, "frame", "seen")?
            .into_iter()
            .filter(|p| p.1 < 0.5)
            .map(|p| (p.0, 0.03))
            .collect();
        panels.push(
            panel
                .with(dots(hidden, 3.0, Color::INK))
                .legend_at(Corner::BottomRight),
        );
    }
    figure = figure.with(230.0, panels);
    let mut rows = [Vec::new(), Vec::new()];
    for (index, name) in PREDICTED.into_iter().enumerate() {
        let mut panel = plot(
            format!("{name}: one step predicted"),
            ("frame", 0.0, 40.0),
            ("overlap", 0.0, 1.05),
        );
        for (rule, color) in RULES {
            panel = panel.with(line(record.points(name, "frame", rule)?, color).named(rule));
        }
        rows[index / 3].push(panel.legend_at(Corner::BottomRight));
    }
    for row in rows {
        figure = figure.with(210.0, row);
    }
    Artefact::only(
        "Above, a ball that falls and is kicked in frame 20, over a distractor of its own level. In the middle the overlap with the whole body, seen or not; \
         dots are frames in which the tracker says that it does not see it. Below, the true outline of each frame moved into the next: left where it is, at \
         its velocity, by the flow of the picture.",
        figure,
    )
}
