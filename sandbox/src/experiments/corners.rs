//! Report §3.4.1: a corner where ω₂ = 0, a break where ω₁ = ω₂ = 0.

use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::experiments::motion::{changed_scene, pair, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;

const ID: &str = "sec-3-4-1-corners";
/// Scene and name of each strip.
const STRIPS: [(&str, &str); 3] = [
    ("whole-strip", "whole"),
    ("hinged-strip", "corner"),
    ("parted-strip", "break"),
];
/// The node of the corner; the break is between it and the next.
const PLACE: usize = 12;

/// Corners and breaks.
pub(crate) const CORNERS: Experiment = Experiment {
    id: ID,
    title: "Corners and breaks",
    place: "§3.4.1",
    question: "A strip sags between two pinned ends. ω₂ = 0 at one node should let the tangent jump there, and \
               ω₁ = ω₂ = 0 the position: do they jump there, there only, and however fine the nodes are?",
    claims: &[
        Claim {
            says: "without either the strip is smooth: the finer the nodes, the less it turns and steps at each",
            source: "report §3.4.1",
            judge: |r| {
                let turn = ratio(r, "whole", "largest turn")?;
                let step = ratio(r, "whole", "largest step")?;
                Ok(Finding::new(
                    (turn - 0.5).abs() < 0.05 && (step - 0.5).abs() < 0.05,
                    format!("with twice the nodes {turn:.2} of the turn and {step:.2} of the step"),
                ))
            },
        },
        Claim {
            says: "ω₂(s₀) = 0 permits a tangent discontinuity at s₀",
            source: "report §3.4.1",
            judge: |r| {
                let stays = ratio(r, "corner", "turn at the place")?;
                let coarse = r.number("corner: turn at the place; 41 nodes")?;
                let elsewhere = r.number("corner: largest turn elsewhere; 81 nodes")?;
                Ok(Finding::new(
                    (stays - 1.0).abs() < 0.05 && elsewhere < 0.1 * coarse,
                    format!(
                        "{coarse:.1}° there, {:.0} % of it with twice the nodes; at most {elsewhere:.2}° anywhere else",
                        100.0 * stays
                    ),
                ))
            },
        },
        Claim {
            says: "and no more: the position does not jump at a corner",
            source: "report §3.4.1",
            judge: |r| {
                let step = ratio(r, "corner", "step at the place")?;
                Ok(Finding::new(
                    (step - 0.5).abs() < 0.05,
                    format!("with twice the nodes {step:.2} of the step there"),
                ))
            },
        },
        Claim {
            says: "ω₁(s₀) = ω₂(s₀) = 0 permits a position discontinuity: the snake can (almost) break",
            source: "report §3.4.1",
            judge: |r| {
                let gap = r.number("break: step at the place; 41 nodes")?;
                let fine = r.number("break: step at the place; 81 nodes")?;
                let elsewhere = ratio(r, "break", "largest step elsewhere")?;
                Ok(Finding::new(
                    gap > 1.5 && fine > 0.75 * gap && (elsewhere - 0.5).abs() < 0.1,
                    format!(
                        "a gap of {gap:.2}, {fine:.2} with twice the nodes; all other steps shrink to {elsewhere:.2}"
                    ),
                ))
            },
        },
        Claim {
            says: "almost: the tether holds its two parts to one body",
            source: "report §3.4.1, D10",
            judge: |r| judged(r, &[below("break: step at the place; 41 nodes", 4.0)]),
        },
    ],
    run,
    draw,
};

/// A quantity with 81 nodes by that with 41.
fn ratio(r: &Record, strip: &str, what: &str) -> Result<f64, SandboxError> {
    let value = |nodes: usize| r.number(&format!("{strip}: {what}; {nodes} nodes"));
    Ok(value(81)? / value(41)?)
}

/// The strip at rest with `factor` times as many edges.
fn settled(scene: &str, factor: usize) -> Result<Vec<DVec2>, SandboxError> {
    let nodes = format!("nodes = {}", 40 * factor + 1);
    let place = format!("= [{}]", PLACE * factor);
    let dt = format!("dt = {}", 0.02 / real(factor * factor));
    let record = format!("every = {}", 3000 * factor * factor);
    let mut changes: Vec<(&str, &str)> = vec![
        ("nodes = 41", &nodes),
        ("dt = 0.02", &dt),
        ("every = 50", &record),
    ];
    if scene != "whole-strip" {
        changes.push(("= [12]", &place));
    }
    let run = to_the_end(ID, &mut changed_scene(ID, scene, &changes)?)?;
    Ok(run
        .last()
        .map(|frame| frame.nodes().to_vec())
        .unwrap_or_default())
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let close = Tolerance::Absolute(1e-6);
    for (scene, name) in STRIPS {
        for factor in [1, 2] {
            let nodes = settled(scene, factor)?;
            let place = PLACE * factor;
            let edges: Vec<DVec2> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let steps: Vec<f64> = edges.iter().map(|edge| edge.length()).collect();
            let mut turns: Vec<f64> = edges
                .windows(2)
                .map(|pair| elastic::turning_angle(pair[0], pair[1]).to_degrees().abs())
                .collect();
            turns.insert(0, 0.0); // so that turns[i] is at node i
            let largest = |values: &[f64], out: &[usize]| {
                let kept = values.iter().enumerate().filter(|(i, _)| !out.contains(i));
                kept.fold(0.0_f64, |a, (_, &b)| a.max(b))
            };
            let count = nodes.len();
            let mut note = |what: &str, value: f64, unit: &'static str| {
                record.note(format!("{name}: {what}; {count} nodes"), value, unit, close);
            };
            note("largest turn", largest(&turns, &[]), "°");
            note("largest step", largest(&steps, &[]), "px");
            note("turn at the place", turns[place], "°");
            note("step at the place", steps[place], "px");
            note(
                "largest turn elsewhere",
                largest(&turns, &[place, place + 1]),
                "°",
            );
            note("largest step elsewhere", largest(&steps, &[place]), "px");
            if factor == 1 {
                turns.push(0.0);
                record.keep(
                    Table::new(name)
                        .with("x", "px", close, nodes.iter().map(|p| p.x).collect())
                        .with("y", "px", close, nodes.iter().map(|p| p.y).collect())
                        .with("turn", "°", close, turns)
                        .with("step to the next", "px", close, steps),
                );
            }
        }
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut strip = Panel::new(
        "at rest under gravity",
        Axis::new("x / px", -1.0, 41.0),
        Axis::new("y / px", -10.5, 1.0),
    )
    .equal();
    let nodes_axis = || Axis::new("node", 0.0, 40.0);
    let mut turns = Panel::new(
        "turn of the tangent at a node",
        nodes_axis(),
        Axis::new("degrees", 0.0, 32.0),
    );
    let mut steps = Panel::new(
        "distance from a node to the next",
        nodes_axis(),
        Axis::new("px", 0.8, 2.4),
    );
    for ((_, name), color) in STRIPS
        .into_iter()
        .zip([Color::GREY, Color::BLUE, Color::RED])
    {
        let points = record.points(name, "x", "y")?;
        let parts: Vec<Vec<(f64, f64)>> = if name == "break" {
            vec![points[..=PLACE].to_vec(), points[PLACE + 1..].to_vec()]
        } else {
            vec![points.clone()]
        };
        for (index, part) in parts.into_iter().enumerate() {
            let line = Line::new(part, color);
            strip = strip.with(if index == 0 { line.named(name) } else { line });
        }
        strip = strip.with(Layer::Dots {
            points,
            radius: 0.9,
            color,
            label: String::new(),
        });
        let over_nodes = |column: &str| -> Result<Vec<(f64, f64)>, SandboxError> {
            let values = record.column(name, column)?;
            Ok(values
                .iter()
                .enumerate()
                .map(|(i, &v)| (real(i), v))
                .collect())
        };
        let mut turn = over_nodes("turn")?;
        if name == "break" {
            for at in [PLACE, PLACE + 1] {
                turn[at].1 = f64::NAN; // across a gap there is no tangent
            }
        }
        turns = turns.with(Line::new(turn, color).named(name));
        steps = steps.with(Line::new(over_nodes("step to the next")?, color).named(name));
    }
    let mark = pair(DVec2::new(12.0, -9.7));
    strip = strip.with(Layer::Text {
        at: mark,
        words: "s₀".to_owned(),
        color: Color::INK,
        centered: true,
    });
    let figure = Figure::new(
        "§3.4.1  A corner (ω₂ = 0 at node 12) and a break (ω₁ = ω₂ = 0 after it)",
        900.0,
    )
    .with(310.0, vec![strip.legend_at(Corner::BottomRight)])
    .with(240.0, vec![turns, steps]);
    Ok(vec![Artefact::figure(
        "One strip three times, pinned at both ends, with tether. Below: the tangent jumps at the corner, the position \
         at the break; the turns next to the break are left out, since there is no tangent across a gap.",
        figure,
    )])
}
