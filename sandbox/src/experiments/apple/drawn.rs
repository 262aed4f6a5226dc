//! The story of §4.3 on a drawn picture, by the report's own rules from end to end.

use super::draw::{animation, frame_panel, height_and_stuck, marked};
use super::story::{Story, Truth, share, top};
use crate::demand::{above, below, judged};
use crate::draw::{Color, Figure};
use crate::experiments::over_time::over_time;
use crate::{Artefact, Body, Claim, Experiment, Finding, Record, SandboxError, Tolerance, real};
use glam::DVec2;

const ID: &str = "sec-4-3-drawn";
/// Six moments.
const MOMENTS: [f64; 6] = [0.0, 10.0, 30.0, 34.0, 37.0, 60.0];
/// Center and half axes of the bright ellipse, and the row of the false edge.
const ELLIPSE: (DVec2, DVec2) = (DVec2::new(55.4, 61.25), DVec2::new(34.0, 26.0));
const FALSE_EDGE: f64 = 15.5;
/// Positions under the report's sampling, which jumps (D51).
const PLACE: Tolerance = Tolerance::Absolute(0.01);

/// A false edge above an ellipse.
pub(crate) const DRAWN: Experiment = Experiment {
    id: ID,
    title: "A drawn false edge, the report's rules",
    place: "§4.3",
    question: "With the report's field, sampling, ends, frame and scheme, and nothing of ours: does a snake on a drawn \
               picture do what §4.3 tells?",
    claims: &[
        Claim {
            says: "the top of the snake is attracted by a disturbing edge at the top of the image",
            source: "report §4.3, D50",
            judge: |r| {
                let (start, held) = (r.number("top at the start")?, r.number("top at t = 10")?);
                Ok(Finding::new(
                    held < start - 3.0 && (held - FALSE_EDGE).abs() < 1.0,
                    format!(
                        "it rises from y = {start:.2} to {held:.2} px; the false edge is at 15.5"
                    ),
                ))
            },
        },
        Claim {
            says: "the ends stick first, and the stuck part grows",
            source: "report §4.3",
            judge: |r| {
                let at = |t: &str| r.number(&format!("stuck at t = {t}"));
                let shares = [at("0")?, at("10")?, at("20")?, at("30")?, at("60")?];
                let middle = r.number("middle node stuck at t = 30")?;
                Ok(Finding::new(
                    shares.windows(2).all(|pair| pair[1] > pair[0]) && middle < 0.5,
                    format!(
                        "{:.0} %, {:.0} %, {:.0} %, {:.0} % at t = 0, 10, 20, 30, the middle still free; {:.0} % at 60",
                        100.0 * shares[0],
                        100.0 * shares[1],
                        100.0 * shares[2],
                        100.0 * shares[3],
                        100.0 * shares[4]
                    ),
                ))
            },
        },
        Claim {
            says: "the middle is suddenly extracted from the neighborhood of the disturbing edge",
            source: "report §4.3, errata §5",
            judge: |r| {
                judged(
                    r,
                    &[below("top at t = 30", 18.5), above("top at t = 40", 34.0)],
                )
            },
        },
        Claim {
            says: "and the snake reaches the contour, which is its equilibrium",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("mean distance to the ellipse at the end", 1.5),
                        above("stuck at t = 60", 0.9),
                        below("nodes moved in the last 5 units of time", 0.1),
                    ],
                )
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let truth = Truth::ellipse(ELLIPSE.0, ELLIPSE.1);
    let story = Story::of(
        ID,
        "disturbing-edge",
        &[("every = 100", "every = 50")],
        truth,
    )?;
    let mut record = Record::default();
    record.note("top at the start", top(story.at(0.0)).y, "px", PLACE);
    for t in [10.0, 30.0, 40.0] {
        record.note(format!("top at t = {t}"), top(story.at(t)).y, "px", PLACE);
    }
    for t in [0.0, 10.0, 20.0, 30.0, 60.0] {
        let stuck = story.truth.stuck(story.at(t));
        record.note(
            format!("stuck at t = {t}"),
            share(&stuck),
            "of the nodes",
            Tolerance::Absolute(0.019),
        );
    }
    let middle = story.truth.stuck(story.at(30.0));
    record.note(
        "middle node stuck at t = 30",
        f64::from(u8::from(middle[25])),
        "",
        Tolerance::EXACT,
    );
    let nodes = story.last();
    record.note(
        "mean distance to the ellipse at the end",
        story.truth.mean_distance(nodes).0,
        "px",
        PLACE,
    );
    let moved = nodes
        .iter()
        .zip(story.at(55.0))
        .fold(0.0_f64, |a, (p, q)| a.max(p.distance(*q)));
    record.note(
        "nodes moved in the last 5 units of time",
        moved,
        "px",
        PLACE,
    );
    record.note("nodes", real(nodes.len()), "", Tolerance::EXACT);
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let panels = MOMENTS
        .iter()
        .zip("abcdef".chars())
        .map(|(&t, letter)| frame_panel(record, &letter.to_string(), t, false))
        .collect::<Result<Vec<_>, SandboxError>>()?;
    let (height, stuck) = height_and_stuck(record)?;
    let energy = over_time(
        record,
        "energy",
        &[
            ("elastic", "elastic", Color::RED),
            ("kinetic", "kinetic", Color::BLUE),
        ],
        "energy of deformation and motion",
        "energy",
    )?;
    let mark = |panel| marked(panel, &MOMENTS[1..5], "bcde");
    let figure = Figure::new("§4.3  A drawn false edge, by the report's rules", 900.0)
        .with(270.0, panels[..3].to_vec())
        .with(270.0, panels[3..].to_vec())
        .with(220.0, vec![mark(height), mark(stuck), energy]);
    let frames: Vec<usize> = (0..120).collect();
    Ok(vec![
        Artefact::figure(
            "An ellipse, and a bar above it. Yellow: the snake; blue: its part within 2 px of the ellipse. The top is \
             caught by the bar, the ends stick, the middle snaps down.",
            figure,
        ),
        Artefact::further(
            "moving",
            "The same in motion.",
            Body::Animation(animation(record, false, &frames, 336)?),
        ),
    ])
}
