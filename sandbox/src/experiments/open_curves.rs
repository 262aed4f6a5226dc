//! Open curves: tips that grow along a road, ends that slide on the border.

use super::motion::{changed_scene, to_the_end};
use super::pixels::grey;
use super::soft::{keep_shots, shots, times};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel, Picture};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;

const ID: &str = "open-curves";
/// The middle of the road in the scene of that name.
const ROAD: [(f64, f64); 14] = [
    (-10.0, 96.0),
    (10.0, 96.0),
    (30.0, 95.1),
    (46.0, 92.6),
    (58.0, 88.5),
    (68.0, 82.8),
    (78.0, 74.0),
    (88.0, 63.0),
    (98.0, 51.7),
    (110.0, 41.4),
    (124.0, 33.9),
    (138.0, 29.9),
    (150.0, 28.4),
    (160.0, 28.0),
];
const ENDS: [(&str, &str, &str); 4] = [
    ("border", "strip-border", "\"border\", tail = \"border\""),
    ("free", "strip-free", "\"free\", tail = \"free\""),
    ("pinned", "strip-pinned", "\"pinned\", tail = \"pinned\""),
    (
        "clamped",
        "strip-clamped",
        "\"clamped\", tail = \"clamped\"",
    ),
];

/// A road and a strip.
pub(crate) const OPEN_CURVES: Experiment = Experiment {
    id: ID,
    title: "Ends that grow, slide and hold",
    place: "beyond",
    question: "An open snake lies on a short stretch of a noisy road: do tips that grow along the ridge find the rest of it, and stop where it ends? \
               And a strip askew of an edge from side to side: what do its ends do under each rule?",
    claims: &[
        Claim {
            says: "from 20 px of it the tips find the whole road, within a pixel of its middle",
            source: "tips",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("growing: share of the road found", 0.95),
                        below("growing: rms distance from its middle", 1.0),
                    ],
                )
            },
        },
        Claim {
            says: "the tip inside the picture stops where the road ends, the other at the border",
            source: "tips",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("growing: tail from the end of the road", 5.0),
                        below("growing: head from the border", 5.0),
                    ],
                )
            },
        },
        Claim {
            says: "without growth the same snake stays on its stretch",
            source: "tips",
            judge: |r| judged(r, &[below("not growing: share of the road found", 0.2)]),
        },
        Claim {
            says: "ends that slide on the border carry the whole strip to the edge; free ones leave the border, pinned and clamped ones hold theirs off the edge",
            source: "elastic::Hold",
            judge: |r| {
                let (border, pinned) = (
                    r.number("border: largest distance from the edge")?,
                    r.number("pinned: largest distance from the edge")?,
                );
                let off = r.number("border: ends off the border")?;
                Ok(Finding::new(
                    border < 0.1
                        && pinned > 5.0
                        && off < 1e-9
                        && r.number("free: ends off the border")? > 5.0,
                    format!(
                        "{border:.3} px at most, on the border to {off:.0e}; pinned {pinned:.1} px"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// Distance from the middle of the road, and how far along it.
fn from_road(p: DVec2) -> (f64, f64) {
    let (mut best, mut arc) = ((f64::INFINITY, 0.0), 0.0);
    for pair in ROAD.windows(2) {
        let (a, b) = (DVec2::from(pair[0]), DVec2::from(pair[1]));
        let along = b - a;
        let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let off = p.distance(a + share * along);
        if off < best.0 {
            best = (off, arc + share * along.length());
        }
        arc += along.length();
    }
    best
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let close = Tolerance::Absolute(0.02);
    // what of the road is in the picture
    let (from, to) = (10.0, from_road(DVec2::new(160.0, 28.0)).1);
    for (name, table) in [("growing", "road-growing"), ("not growing", "road-still")] {
        let mut scene = changed_scene(ID, "road", &[])?;
        if name != "growing" {
            scene.tips = None;
        } else if let Some(picture) = &scene.picture {
            record.keep_grid("road", picture.levels().clone());
        }
        let done = to_the_end(ID, &mut scene)?;
        let Some(last) = done.frames.last() else {
            continue;
        };
        let nodes = last.nodes();
        let places: Vec<(f64, f64)> = nodes.iter().map(|&p| from_road(p)).collect();
        let arcs = places.iter().map(|p| p.1);
        let (low, high) = arcs.fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
        let found = (high.min(to) - low.max(from)) / (to - from);
        let rms = (places.iter().map(|p| p.0 * p.0).sum::<f64>() / real(places.len())).sqrt();
        record.note(
            format!("{name}: share of the road found"),
            found,
            "",
            Tolerance::Absolute(1e-3),
        );
        record.note(
            format!("{name}: rms distance from its middle"),
            rms,
            "px",
            close,
        );
        record.note(
            format!("{name}: nodes"),
            real(nodes.len()),
            "",
            Tolerance::EXACT,
        );
        let (head, tail) = (nodes[0], nodes[nodes.len() - 1]);
        record.note(
            format!("{name}: tail from the end of the road"),
            tail.distance(DVec2::new(160.0, 28.0)),
            "px",
            close,
        );
        record.note(format!("{name}: head from the border"), head.x, "px", close);
        let mut kept = Vec::new();
        for frame in &done.frames {
            kept.push((frame.t, 0, false, frame.nodes().to_vec()));
        }
        keep_shots(&mut record, table, &kept);
        record.keep(
            Table::raw(if name == "growing" {
                "off-growing"
            } else {
                "off-still"
            })
            .with(
                "arc",
                "px",
                Tolerance::EXACT,
                places.iter().map(|p| p.1).collect(),
            )
            .with(
                "off",
                "px",
                Tolerance::EXACT,
                places.iter().map(|p| p.0).collect(),
            ),
        );
    }
    for (name, table, words) in ENDS {
        let mut scene = changed_scene(
            ID,
            "sliding-strip",
            &[("\"border\", tail = \"border\"", words)],
        )?;
        if name == "border"
            && let Some(picture) = &scene.picture
        {
            record.keep_grid("edge", picture.levels().clone());
        }
        let done = to_the_end(ID, &mut scene)?;
        let Some(last) = done.frames.last() else {
            continue;
        };
        let off = last
            .nodes()
            .iter()
            .map(|p| (p.y - 40.0).abs())
            .fold(0.0, f64::max);
        record.note(
            format!("{name}: largest distance from the edge"),
            off,
            "px",
            Tolerance::Relative(0.3),
        );
        let n = last.nodes().len();
        let ends = last.nodes()[0]
            .x
            .abs()
            .max((last.nodes()[n - 1].x - 95.0).abs());
        let loose = if name == "free" {
            close
        } else {
            Tolerance::ROUNDING
        };
        record.note(format!("{name}: ends off the border"), ends, "px", loose);
        let kept: Vec<_> = done
            .frames
            .iter()
            .step_by(3)
            .chain(done.frames.last())
            .map(|f| (f.t, 0, false, f.nodes().to_vec()))
            .collect();
        keep_shots(&mut record, table, &kept);
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut row = Vec::new();
    for (table, title) in [
        ("road-growing", "tips that grow"),
        ("road-still", "the same without"),
    ] {
        let mut panel = Panel::pixels(title, 192, 128)
            .bare()
            .with(Picture::new(grey(record.grid("road")?)));
        let all = shots(record, table)?;
        let count = all.len();
        for (k, shot) in all.iter().enumerate() {
            let last = k + 1 == count;
            let (color, weight) = if last {
                (Color::SKY, 1.4)
            } else {
                (Color::YELLOW.mix(Color::RED, real(k) / real(count)), 0.7)
            };
            if last || k == 0 {
                panel = panel.with(Line::new(shot.points.clone(), color).weighing(weight));
            }
            if let (false, Some(&a), Some(&b)) = (last, shot.points.first(), shot.points.last()) {
                panel = panel.with(Layer::Dots {
                    points: vec![a, b],
                    radius: 2.0,
                    color,
                    label: String::new(),
                });
            }
        }
        row.push(panel);
    }
    let mut strips = Vec::new();
    for (name, table, _) in ENDS {
        let mut panel = Panel::pixels(format!("ends: {name}"), 96, 80)
            .bare()
            .with(Picture::new(grey(
                &record.grid("edge")?.mapv(|v| 0.6 * v + 60.0),
            )));
        let all = shots(record, table)?;
        for t in times(&all) {
            for shot in all.iter().filter(|shot| shot.t.to_bits() == t.to_bits()) {
                panel = panel.with(Line::new(shot.points.clone(), Color::RED).weighing(0.35));
            }
        }
        if let (Some(first), Some(last)) = (all.first(), all.last()) {
            panel = panel
                .with(Line::new(first.points.clone(), Color::YELLOW).weighing(1.0))
                .with(Line::new(last.points.clone(), Color::BLUE).weighing(1.6));
        }
        strips.push(panel);
    }
    let mut off = Panel::new(
        "distance of the nodes from the middle of the road",
        Axis::new("along the road / px", 0.0, 215.0),
        Axis::new("px", 0.0, 3.0),
    )
    .legend_at(Corner::TopRight);
    for (table, name, color) in [
        ("off-growing", "grown", Color::SKY),
        ("off-still", "not grown", Color::RED),
    ] {
        let points = record.points(table, "arc", "off")?;
        off = off.with(Line::new(points, color).named(name));
    }
    Ok(vec![Artefact::figure(
        "Above: the start (yellow), where the tips were every 400 steps (dots) and the end (blue). Below: the strip from its start (yellow) to its end (blue) under four rules for its ends.",
        Figure::new("Open curves", 1000.0)
            .with(310.0, row)
            .with(180.0, vec![off])
            .with(210.0, strips),
    )])
}
