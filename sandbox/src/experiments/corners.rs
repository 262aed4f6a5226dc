//! Report §3.4.1: a corner where ω₂ = 0, a break where ω₁ = ω₂ = 0.

use crate::prelude::*;

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
    id: "sec-3-4-1-corners",
    title: "Corners and breaks",
    place: "§3.4.1",
    question: "A strip sags between two pinned ends. ω₂ = 0 at one node should let the tangent jump there, and \
               ω₁ = ω₂ = 0 the position: do they jump there, there only, and however fine the nodes are?",
    claims: &[
        claim(
            "without either the strip is smooth: with twice the nodes it turns and steps half as \
               much at each [report §3.4.1]",
        )
        .when(&[
            halved(
                "whole: largest turn; 81 nodes",
                "whole: largest turn; 41 nodes",
                0.05,
            ),
            halved(
                "whole: largest step; 81 nodes",
                "whole: largest step; 41 nodes",
                0.05,
            ),
        ]),
        claim("ω₂(s₀) = 0 permits a tangent discontinuity at s₀ [report §3.4.1]").when(&[
            like("corner: turn at the place; 81 nodes", TURN, 0.05),
            less("corner: largest turn elsewhere; 81 nodes", 0.1, TURN),
        ]),
        claim("and no more: the position does not jump at a corner [report §3.4.1]").when(&[
            halved(
                "corner: step at the place; 81 nodes",
                "corner: step at the place; 41 nodes",
                0.05,
            ),
        ]),
        claim("ω₁(s₀) = ω₂(s₀) = 0 permits the snake to (almost) break [report §3.4.1]").when(&[
            above(GAP, 1.5),
            more("break: step at the place; 81 nodes", 0.75, GAP),
            halved(
                "break: largest step elsewhere; 81 nodes",
                "break: largest step elsewhere; 41 nodes",
                0.1,
            ),
        ]),
        claim("almost: the tether holds its two parts to one body [report §3.4.1, D10]")
            .when(&[below(GAP, 4.0)]),
    ],
    run,
    draw,
};

const TURN: &str = "corner: turn at the place; 41 nodes";
const GAP: &str = "break: step at the place; 41 nodes";

/// Half of another number.
const fn halved(fine: &'static str, coarse: &'static str, within: f64) -> Demand {
    ratio(fine, coarse, 0.5, within)
}

/// The strip at rest with `factor` times as many edges.
fn settled(scene: &str, factor: usize) -> Result<Vec<DVec2>> {
    let square = factor * factor;
    let nodes = format!("nodes = {}", 40 * factor + 1);
    let place = format!("= [{}]", PLACE * factor);
    let dt = format!("dt = {}", 0.02 / real(square));
    let record = format!("every = {}", 3000 * square);
    let mut changes: Vec<(&str, &str)> = vec![
        ("nodes = 41", &nodes),
        ("dt = 0.02", &dt),
        ("every = 50", &record),
    ];
    if scene != "whole-strip" {
        changes.push(("= [12]", &place));
    }
    Ok(last(&ran(scene, &changes)?.1).to_vec())
}

fn run() -> Result {
    let mut record = Record::default();
    let close = 1e-6;
    for (scene, name) in STRIPS {
        for factor in [1, 2] {
            let nodes = settled(scene, factor)?;
            let (place, count) = (PLACE * factor, nodes.len());
            let edges: Vec<DVec2> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let steps: Vec<f64> = edges.iter().map(|edge| edge.length()).collect();
            let turn = |pair: &[DVec2]| elastic::turning_angle(pair[0], pair[1]).to_degrees().abs();
            // so that turns[i] is at node i
            let turns = std::iter::once(0.0).chain(edges.windows(2).map(turn));
            let mut turns: Vec<f64> = turns.collect();
            let largest = |values: &[f64], out: &[usize]| {
                let kept = values.iter().enumerate().filter(|(i, _)| !out.contains(i));
                most(kept.map(|(_, &value)| value))
            };
            for (what, unit, value) in [
                ("largest turn", "°", largest(&turns, &[])),
                ("largest step", "px", largest(&steps, &[])),
                ("turn at the place", "°", turns[place]),
                ("step at the place", "px", steps[place]),
                (
                    "largest turn elsewhere",
                    "°",
                    largest(&turns, &[place, place + 1]),
                ),
                ("largest step elsewhere", "px", largest(&steps, &[place])),
            ] {
                record.note(
                    format!("{name}: {what}; {count} nodes [{unit}]"),
                    value,
                    close,
                );
            }
            if factor == 1 {
                turns.push(0.0);
                let table = Table::new(name).xy("px", close, &nodes);
                let table = table.with("turn [°]", close, turns);
                record.keep(table.with("step to the next [px]", close, steps));
            }
        }
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let (x, y) = (("x / px", -1.0, 41.0), ("y / px", -10.5, 1.0));
    let mut strip = plot("at rest under gravity", x, y).equal();
    let nodes = ("node", 0.0, 40.0);
    let mut turns = plot(
        "turn of the tangent at a node",
        nodes,
        ("degrees", 0.0, 32.0),
    );
    let mut steps = plot("distance from a node to the next", nodes, ("px", 0.8, 2.4));
    let colors = [Color::GREY, Color::BLUE, Color::RED];
    for ((_, name), color) in STRIPS.into_iter().zip(colors) {
        let points = record.xy(name)?;
        let (whole, rest) = points.split_at(if name == "break" {
            PLACE + 1
        } else {
            points.len()
        });
        strip = strip.with(line(whole.to_vec(), color).named(name));
        if !rest.is_empty() {
            strip = strip.with(line(rest.to_vec(), color));
        }
        strip = strip.with(dots(points, 0.9, color));
        let over_nodes = |column: &str| -> Result<Vec<(f64, f64)>> {
            let values = record.column(name, column)?.iter().enumerate();
            Ok(values.map(|(i, &value)| (real(i), value)).collect())
        };
        let mut turn = over_nodes("turn")?;
        if name == "break" {
            // across a gap there is no tangent
            (turn[PLACE].1, turn[PLACE + 1].1) = (f64::NAN, f64::NAN);
        }
        turns = turns.with(line(turn, color).named(name));
        steps = steps.with(line(over_nodes("step to the next")?, color).named(name));
    }
    strip = strip.with(text((12.0, -9.7), "s₀", Color::INK));
    let title = "§3.4.1  A corner (ω₂ = 0 at node 12) and a break (ω₁ = ω₂ = 0 after it)";
    Artefact::only(
        "One strip three times, pinned at both ends, with tether. Below: the tangent jumps at the corner, the position \
         at the break; the turns next to the break are left out, since there is no tangent across a gap.",
        Figure::new(title, 900.0)
            .with(310.0, vec![strip.legend_at(Corner::BottomRight)])
            .with(240.0, vec![turns, steps]),
    )
}
