//! Two become one, one becomes two, one becomes none.

use crate::prelude::*;
use elastic::signed_area;
use snake::{EventKind, Upkeep};

/// Looked after or not, and the table of areas.
const TRIED: [(&str, &str); 2] = [("kept", "kept-areas"), ("alone", "alone-areas")];
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
    id: "soft-fates",
    title: "Merge, split, vanish",
    place: "beyond",
    question: "Two balloons grow in one disc, a ring closes on two discs, another where there is nothing. Are they one, two and none in the end, with outlines that are \
               outlines all the while? And the same four curves when nobody looks after them?",
    claims: &[
        claim("one merges, one falls in two, one vanishes: as many curves as there are objects, each on \
               its own [the scene]")
            .when(&[
                near("merged", 1.0, 0.5),
                near("split", 2.0, 0.5),
                near("vanished", 2.0, 0.5),
                near("curves at the end", 3.0, 0.5),
                below("farthest from its disc", 2.0),
            ]),
        claim("every outline crosses itself nowhere and keeps its sign, at every look; left alone they do \
               not [outline::crossings, exact]")
            .when(&[
                below("kept: crossings", 0.5),
                above("kept: least area", 0.0),
                above("alone: crossings", 0.0),
            ]),
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

fn run() -> Result {
    let mut record = Record::default();
    for (name, areas) in TRIED {
        let mut scene = scene_with("balloons", &[])?;
        let kept = name == "kept";
        if let (true, Some(picture)) = (kept, &scene.picture) {
            record.keep_grid("discs", picture.levels().clone());
        }
        if let (false, Some(company)) = (kept, &mut scene.company) {
            company.upkeep = Upkeep::default();
        }
        let mut group = group(&scene)?;
        let (mut frames, mut rows, mut sizes, mut crossings) = (vec![], vec![], vec![], 0);
        for step in 0..=scene.plan.until.steps {
            if step > 0 {
                advance(&mut group)?;
            }
            if MOMENTS.contains(&step) {
                frames.push(frame(&group));
            }
            if step.is_multiple_of(EVERY) {
                rows.push((group.t(), account_of(&mut group)));
                for member in group.members() {
                    let x = &member.state().x;
                    crossings = outline::crossings(x, true)?.len().max(crossings);
                    sizes.push((group.t(), member.id(), signed_area(x)));
                }
            }
        }
        let loose = if kept { 0.0 } else { 4.0 };
        record.note(format!("{name}: crossings"), real(crossings), loose);
        let smallest = least(sizes.iter().map(|size| size.2));
        record.note(format!("{name}: least area [px²]"), smallest, 1.0);
        if kept {
            record.note("outlines looked at", real(sizes.len()), 10.0);
            record.note(
                "gap of the account [of the largest term]",
                gap_of(&rows),
                1e-9,
            );
            for kind in ["merged", "split", "vanished"] {
                let all = || group.events().iter().filter(|e| word(e.kind) == Some(kind));
                let when = all().next().map_or(f64::NAN, |e| e.t);
                record.note(kind, real(all().count()), EXACT);
                record.note(format!("time of {kind} [s]"), when, 1.5);
            }
            record.note("curves at the end", real(group.members().len()), EXACT);
            let off = |p: &DVec2| least(DISCS.iter().map(|(c, r)| (p.distance(*c) - r).abs()));
            let far = most(group.members().iter().flat_map(|m| &m.state().x).map(off));
            record.note("farthest from its disc [px]", far, 0.3);
        }
        record.keep_run(name, frames);
        record.keep(
            Table::raw(areas)
                .exact("t [s]", sizes.iter().map(|size| size.0))
                .exact("snake", sizes.iter().map(|size| real(size.1)))
                .exact("area [px²]", sizes.iter().map(|size| size.2)),
        );
    }
    Ok(record)
}

/// The account of this scene: what there is none of is left to the rest.
fn account_of(group: &mut Group) -> Vec<f64> {
    let e = group.energies();
    let mut row = vec![e.kinetic, e.elastic(), e.forces[0], e.wall];
    row.extend([e.damping, e.contact, e.parameters]);
    row.push(e.total() - row.iter().sum::<f64>());
    row
}

fn draw(record: &Record) -> Drawn {
    let ground = grey(&record.grid("discs")?.mapv(|v| 0.6 * v + 70.0));
    let mut figure = Figure::new("Merge, split, vanish", 1200.0);
    let mut charts = Vec::new();
    for ((name, areas), words) in TRIED.into_iter().zip(["looked after", "left alone"]) {
        let row = record.run(name)?.frames.iter().map(|frame| {
            let title = format!("{words}, t = {:.0}", frame.t);
            let panel = Panel::pixels(title, 200, 120)
                .bare()
                .with(Picture::new(ground.clone()));
            frame.curves.iter().fold(panel, |panel, curve| {
                panel.with(line(curve.points(), Color::SERIES[curve.id % 6]).weighing(1.2))
            })
        });
        figure = figure.with(160.0, row.collect());
        let (time, size) = (("t / s", 0.0, 90.0), ("area / px²", -400.0, 7000.0));
        let mut chart = plot(format!("areas, {words}"), time, size);
        let ids = record.column(areas, "snake")?;
        let points = record.points(areas, "t", "area")?;
        for (k, color) in Color::SERIES.into_iter().enumerate() {
            let own = ids
                .iter()
                .zip(&points)
                .filter(|(id, _)| (**id - real(k)).abs() < 0.5);
            let own: Vec<(f64, f64)> = own.map(|(_, p)| *p).collect();
            if !own.is_empty() {
                chart = chart.with(line(own, color).named(format!("snake {k}")));
            }
        }
        if name == "kept" {
            for kind in ["merged", "split", "vanished"] {
                let t = record.told(&format!("time of {kind}"))?;
                let upright = line([(t, -400.0), (t, 7000.0)], Color::GREY);
                chart = chart.with(upright.dashed().weighing(0.6));
            }
        }
        charts.push(chart);
    }
    Artefact::only(
        "Blue and red merge, green falls in two, purple vanishes; each change is an event, dashed in the chart of areas. Left alone, blue and red lie across each other, \
         and the waist of green passes through itself and turns over.",
        figure.with(240.0, charts),
    )
}
