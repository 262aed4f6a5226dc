//! Report §3.2, what happens at the ends (D3, D4): a bent strip in empty space.

use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel};
use crate::experiments::motion::{Frames, changed_scene, keep_frames, range, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};

const ID: &str = "sec-3-2-ends";
/// Scene, name, table of its frames, table of its center.
const ENDS: [(&str, &str, &str, &str); 2] = [
    ("bent-strip-free", "free ends", "curves-free", "center-free"),
    (
        "bent-strip-anchored",
        "anchored ends",
        "curves-anchored",
        "center-anchored",
    ),
];

/// Free and anchored ends.
pub(crate) const ENDS_OF_A_STRIP: Experiment = Experiment {
    id: ID,
    title: "A bent strip in empty space",
    place: "§3.2",
    question: "Nothing acts on a bent strip but its own elasticity. Where does its center go with natural ends, where \
               with the ends of the report's program?",
    claims: &[
        Claim {
            says: "with free ends the center stays where it is",
            source: "D3, D5",
            judge: |r| judged(r, &[below("free ends: center moved at most", 1e-12)]),
        },
        Claim {
            says: "with the report's ends the snake pushes itself along, though nothing is there to push against",
            source: "D4",
            judge: |r| judged(r, &[above("anchored ends: center moved at most", 0.5)]),
        },
        Claim {
            says: "both straighten out towards the straight rest shape",
            source: "report §2.4",
            judge: |r| {
                let part = |name: &str| -> Result<f64, SandboxError> {
                    Ok(r.number(&format!("{name}: bend at the end"))?
                        / r.number(&format!("{name}: bend at the start"))?)
                };
                let (free, anchored) = (part("free ends")?, part("anchored ends")?);
                Ok(Finding::new(
                    free < 0.5 && anchored < 0.5,
                    format!(
                        "after 20 s {:.0} % and {:.0} % of the bend are left",
                        100.0 * free,
                        100.0 * anchored
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// Largest distance of a node from the chord.
fn bend(nodes: &[glam::DVec2]) -> f64 {
    let (Some(&a), Some(&b)) = (nodes.first(), nodes.last()) else {
        return 0.0;
    };
    let across = (b - a).normalize().perp();
    nodes
        .iter()
        .fold(0.0_f64, |most, &p| most.max((p - a).dot(across).abs()))
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (scene, name, curves, center) in ENDS {
        let mut scene = changed_scene(ID, scene, &[])?;
        let run = to_the_end(ID, &mut scene)?;
        let centers: Vec<glam::DVec2> = run
            .frames
            .iter()
            .map(|frame| elastic::center(frame.nodes(), None))
            .collect();
        let most = centers
            .iter()
            .fold(0.0_f64, |a, c| a.max(c.distance(centers[0])));
        let close = Tolerance::Absolute(1e-9);
        record.note(format!("{name}: center moved at most"), most, "px", close);
        for (when, frame) in [("start", run.frames.first()), ("end", run.frames.last())] {
            if let Some(frame) = frame {
                record.note(
                    format!("{name}: bend at the {when}"),
                    bend(frame.nodes()),
                    "px",
                    close,
                );
            }
        }
        keep_frames(&mut record, curves, &run);
        record.keep(
            Table::new(center)
                .with(
                    "t",
                    "s",
                    close,
                    run.frames.iter().map(|frame| frame.t).collect(),
                )
                .with("x", "px", close, centers.iter().map(|c| c.x).collect())
                .with("y", "px", close, centers.iter().map(|c| c.y).collect()),
        );
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    let mut moved = Panel::new(
        "how far the center has gone",
        Axis::new("t / s", 0.0, 20.0),
        Axis::new("px", -0.1, 2.4),
    )
    .legend_at(Corner::TopLeft);
    let mut near = Panel::new(
        "the way of the center",
        Axis::new("x / px", 18.9, 20.9),
        Axis::new("y / px", 2.6, 5.3),
    )
    .equal()
    .legend_at(Corner::TopLeft);
    for ((_, name, curves, center), color) in ENDS.into_iter().zip([Color::GREEN, Color::RED]) {
        let frames = Frames::of(record, curves)?;
        let all = || (0..frames.len()).flat_map(|i| frames.curve(i));
        let (low, high) = range(all().map(|p| p.1), 0.08);
        let mut panel = Panel::new(
            name,
            Axis::new("x / px", -2.0, 41.0),
            Axis::new("y / px", low.min(-7.0), high.max(13.0)),
        )
        .equal();
        let chosen = [0.0, 1.0, 2.0, 4.0, 8.0, 20.0].map(|t| frames.nearest(t));
        for (index, &frame) in chosen.iter().enumerate() {
            let share = crate::real(index) / crate::real(chosen.len() - 1);
            panel = panel.with(
                Line::new(frames.curve(frame), Color::BLUE.mix(Color::RED, share)).weighing(0.7),
            );
        }
        let way = record.points(center, "x", "y")?;
        panel = panel
            .with(Line::new(way.clone(), Color::INK).weighing(1.2))
            .with(crate::draw::Layer::Dots {
                points: vec![way[0]],
                radius: 2.0,
                color: Color::INK,
                label: "center at the start".to_owned(),
            });
        panels.push(panel);
        let begin = way[0];
        near =
            near.with(Line::new(way.clone(), color).named(name))
                .with(crate::draw::Layer::Dots {
                    points: vec![begin, way[way.len() - 1]],
                    radius: 2.0,
                    color,
                    label: String::new(),
                });
        let gone = record.column(center, "t")?.iter().zip(&way);
        let gone = gone
            .map(|(&t, p)| (t, (p.0 - begin.0).hypot(p.1 - begin.1)))
            .collect();
        moved = moved.with(Line::new(gone, color).named(name));
    }
    let figure = Figure::new("§3.2  A bent strip in empty space", 900.0)
        .with(260.0, panels)
        .with(270.0, vec![near, moved]);
    Ok(vec![Artefact::figure(
        "Above: after 0, 1, 2, 4, 8, 20 s, from blue to orange. Free ends: the forces sum to zero. The report's ends act as if \
         an undeformed node were held beyond each, so they do not.",
        figure,
    )])
}
