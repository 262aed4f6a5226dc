//! Two become one, one becomes two, one becomes none.

use super::course::{advance, crowd_of, gap, keep_shots, shots};
use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel, Picture};
use crate::experiments::motion::changed_scene;
use crate::experiments::pixels::grey;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::signed_area;
use glam::DVec2;
use snake::{EventKind, Upkeep};

const ID: &str = "soft-fates";
/// Every so many steps the outlines are judged.
const EVERY: u64 = 25;
/// Moments that are drawn.
const MOMENTS: [u64; 5] = [0, 300, 600, 2400, 4500];
/// Center and radius of the three discs.
const DISCS: [(DVec2, f64); 3] = [
    (DVec2::new(44.0, 60.0), 30.0),
    (DVec2::new(112.0, 36.0), 15.0),
    (DVec2::new(148.0, 76.0), 18.0),
];

/// The scene balloons, looked after and left alone.
pub(crate) const FATES: Experiment = Experiment {
    id: ID,
    title: "Merge, split, vanish",
    place: "beyond",
    question: "Two balloons grow in one disc, a ring closes on two discs, another where there is nothing. Are they one, two and none in the end, with outlines that are \
               outlines all the while? And the same four curves when nobody looks after them?",
    claims: &[
        Claim {
            says: "one merges, one falls in two, one vanishes: as many curves as there are objects, each on its own",
            source: "the scene",
            judge: |r| {
                let of = |n: &str| r.number(n);
                let (merges, splits, gone) = (of("merged")?, of("split")?, of("vanished")?);
                let most = of("farthest from its disc")?;
                let counts = [merges, splits, gone, of("curves at the end")?];
                let mut counts = counts.iter().zip([1.0, 2.0, 2.0, 3.0]);
                let as_many = counts.all(|(found, expected)| (found - expected).abs() < 0.5);
                Ok(Finding::new(
                    as_many && most < 2.0,
                    format!(
                        "two merged at t = {:.1}; the waist parted at its ends from {:.1} on, and the scrap between vanished; the fourth had at {:.1}; no node of the three left is farther than {most:.1} px from its disc's border",
                        r.told("time of merged")?,
                        r.told("time of split")?,
                        r.told("time of vanished")?
                    ),
                ))
            },
        },
        Claim {
            says: "every outline crosses itself nowhere and keeps its sign, at every look",
            source: "outline::crossings, exact",
            judge: |r| {
                let (crossings, least) =
                    (r.number("kept: crossings")?, r.number("kept: least area")?);
                let (alone, flipped) =
                    (r.number("alone: crossings")?, r.told("alone: least area")?);
                Ok(Finding::new(
                    crossings < 0.5 && least > 0.0 && alone > 0.0,
                    format!(
                        "{crossings} crossings in {:.0} outlines, least area {least:.1} px²; left alone up to {alone:.0} at once and {flipped:.1} px²",
                        r.told("outlines looked at")?
                    ),
                ))
            },
        },
        Claim {
            says: "the account closes over all of it",
            source: "the ledger of a crowd",
            judge: |r| judged(r, &[below("gap of the account", 1e-9)]),
        },
    ],
    run,
    draw,
};

fn word(kind: EventKind) -> Option<&'static str> {
    match kind {
        EventKind::Merged { .. } => Some("merged"),
        EventKind::Split { .. } => Some("split"),
        EventKind::Vanished => Some("vanished"),
        _ => None,
    }
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, table, areas) in [
        ("kept", "kept", "kept-areas"),
        ("alone", "alone", "alone-areas"),
    ] {
        let mut scene = changed_scene(ID, "balloons", &[])?;
        if let (true, Some(picture)) = (name == "kept", &scene.picture) {
            record.keep_grid("discs", picture.levels().clone());
        }
        if let (true, Some(company)) = (name == "alone", &mut scene.company) {
            company.upkeep = Upkeep::default();
        }
        let mut crowd = crowd_of(ID, &scene)?;
        let (mut kept, mut rows, mut area) = (Vec::new(), Vec::new(), Vec::new());
        let (mut most, mut least, mut outlines) = (0, f64::INFINITY, 0);
        for step in 0..=scene.plan.until.steps {
            if step > 0 {
                advance(ID, &mut crowd)?;
            }
            if MOMENTS.contains(&step) {
                for member in crowd.members() {
                    kept.push((crowd.t(), member.id(), true, member.state().x.clone()));
                }
            }
            if step.is_multiple_of(EVERY) {
                let e = crowd.energies();
                let named = [
                    e.kinetic,
                    e.elastic(),
                    e.forces[0],
                    e.wall,
                    e.damping,
                    e.contact,
                    e.parameters,
                ];
                let rest = e.total() - named.iter().sum::<f64>();
                rows.push([
                    named[0], named[1], named[2], named[3], named[4], named[5], named[6], rest,
                ]);
                for member in crowd.members() {
                    let x = &member.state().x;
                    let found = outline::crossings(x, true).map_err(SandboxError::refused(ID))?;
                    most = most.max(found.len());
                    let a = signed_area(x);
                    least = least.min(a);
                    outlines += 1;
                    area.push((crowd.t(), member.id(), a));
                }
            }
        }
        record.note(
            format!("{name}: crossings"),
            real(most),
            "",
            Tolerance::Absolute(if name == "kept" { 0.0 } else { 4.0 }),
        );
        record.note(
            format!("{name}: least area"),
            least,
            "px²",
            Tolerance::Absolute(1.0),
        );
        if name == "kept" {
            record.note(
                "outlines looked at",
                real(outlines),
                "",
                Tolerance::Absolute(10.0),
            );
            record.note(
                "gap of the account",
                gap(&rows),
                "of the largest term",
                Tolerance::Absolute(1e-9),
            );
            for kind in ["merged", "split", "vanished"] {
                let mut all = crowd.events().iter().filter(|e| word(e.kind) == Some(kind));
                let when = all.clone().next().map_or(f64::NAN, |e| e.t);
                record.note(kind, real(all.by_ref().count()), "", Tolerance::EXACT);
                record.note(
                    format!("time of {kind}"),
                    when,
                    "s",
                    Tolerance::Absolute(1.5),
                );
            }
            record.note(
                "curves at the end",
                real(crowd.members().len()),
                "",
                Tolerance::EXACT,
            );
            let nodes = crowd.members().iter().flat_map(|m| &m.state().x);
            let far = nodes.map(|p| {
                let each = DISCS.iter().map(|(c, r)| (p.distance(*c) - r).abs());
                each.fold(f64::INFINITY, f64::min)
            });
            record.note(
                "farthest from its disc",
                far.fold(0.0, f64::max),
                "px",
                Tolerance::Absolute(0.3),
            );
        }
        keep_shots(&mut record, table, &kept);
        record.keep(
            Table::raw(areas)
                .with(
                    "t",
                    "s",
                    Tolerance::EXACT,
                    area.iter().map(|a| a.0).collect(),
                )
                .with(
                    "snake",
                    "",
                    Tolerance::EXACT,
                    area.iter().map(|a| real(a.1)).collect(),
                )
                .with(
                    "area",
                    "px²",
                    Tolerance::EXACT,
                    area.iter().map(|a| a.2).collect(),
                ),
        );
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let ground = grey(&record.grid("discs")?.mapv(|v| 0.6 * v + 70.0));
    let mut figure = Figure::new("Merge, split, vanish", 1200.0);
    for (table, words) in [("kept", "looked after"), ("alone", "left alone")] {
        let all = shots(record, table)?;
        let mut row = Vec::new();
        for step in MOMENTS {
            let t = 0.02 * real(usize::try_from(step).unwrap_or(0));
            let mut panel = Panel::pixels(format!("{words}, t = {t:.0}"), 200, 120)
                .bare()
                .with(Picture::new(ground.clone()));
            for shot in all.iter().filter(|shot| (shot.t - t).abs() < 0.01) {
                let color = Color::SERIES[shot.snake % 6];
                panel = panel.with(Line::new(shot.points.clone(), color).weighing(1.2));
            }
            row.push(panel);
        }
        figure = figure.with(160.0, row);
    }
    let mut charts = Vec::new();
    for (table, words) in [
        ("kept-areas", "areas, looked after"),
        ("alone-areas", "areas, left alone"),
    ] {
        let mut chart = Panel::new(
            words,
            Axis::new("t / s", 0.0, 90.0),
            Axis::new("area / px²", -400.0, 7000.0),
        )
        .legend_at(Corner::TopRight);
        let ids = record.column(table, "snake")?;
        let points = record.points(table, "t", "area")?;
        for k in 0..6 {
            let own: Vec<(f64, f64)> = ids
                .iter()
                .zip(&points)
                .filter(|(id, _)| (**id - real(k)).abs() < 0.5)
                .map(|(_, p)| *p)
                .collect();
            if !own.is_empty() {
                let line = Line::new(own, Color::SERIES[k]);
                chart = chart.with(line.named(format!("snake {k}")));
            }
        }
        if table == "kept-areas" {
            for kind in ["merged", "split", "vanished"] {
                let t = record.number(&format!("time of {kind}"))?;
                chart = chart.with(
                    Line::new(vec![(t, -400.0), (t, 7000.0)], Color::GREY)
                        .dashed()
                        .weighing(0.6),
                );
            }
        }
        charts.push(chart);
    }
    Ok(vec![Artefact::figure(
        "Blue and red merge, green falls in two, purple vanishes; each change is an event, dashed in the chart of areas. Left alone, blue and red lie across each other, \
         and the waist of green passes through itself and turns over.",
        figure.with(240.0, charts),
    )])
}
