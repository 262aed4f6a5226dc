//! Open curves: tips that grow along a road, ends that slide on the border.

use crate::prelude::*;

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
const ENDS: [&str; 4] = ["border", "free", "pinned", "clamped"];

/// A road and a strip.
pub(crate) const OPEN_CURVES: Experiment = Experiment {
    id: "open-curves",
    title: "Ends that grow, slide and hold",
    place: "beyond",
    question: "An open snake lies on a short stretch of a noisy road: do tips that grow along the ridge find the rest of it, and stop where it ends? \
               And a strip askew of an edge from side to side: what do its ends do under each rule?",
    claims: &[
        claim("from 20 px of it the tips find the whole road, within a pixel of its middle [tips]")
            .when(&[
                above("growing: share of the road found", 0.95),
                below("growing: rms distance from its middle", 1.0),
            ]),
        claim(
            "the tip inside the picture stops where the road ends, the other at the border [tips]",
        )
        .when(&[
            below("growing: tail from the end of the road", 5.0),
            below("growing: head from the border", 5.0),
        ]),
        claim("without growth the same snake stays on its stretch [tips]")
            .when(&[below("not growing: share of the road found", 0.2)]),
        claim(
            "ends that slide on the border carry the whole strip to the edge; free ones leave the \
               border, pinned and clamped ones hold theirs off the edge [elastic::Hold]",
        )
        .when(&[
            below("border: largest distance from the edge", 0.1),
            below("border: ends off the border", 1e-9),
            above("free: ends off the border", 5.0),
            above("pinned: largest distance from the edge", 5.0),
            above("clamped: largest distance from the edge", 5.0),
        ]),
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

fn run() -> Result {
    let mut record = Record::default();
    let close = 0.02;
    let end = DVec2::new(160.0, 28.0);
    // what of the road is in the picture
    let (from, to) = (10.0, from_road(end).1);
    for name in ["growing", "not growing"] {
        let mut scene = scene_with("road", &[])?;
        if name != "growing" {
            scene.tips = None;
        } else if let Some(picture) = &scene.picture {
            record.keep_grid("road", picture.levels().clone());
        }
        let run = to_the_end(&scene)?;
        let nodes = last(&run);
        let places: Vec<(f64, f64)> = nodes.iter().map(|&p| from_road(p)).collect();
        let arcs = || places.iter().map(|p| p.1);
        let found = (most(arcs()).min(to) - least(arcs()).max(from)) / (to - from);
        let rms = mean(places.iter().map(|p| p.0 * p.0)).sqrt();
        let (head, tail) = (nodes[0], nodes[nodes.len() - 1]);
        let mut own = record.under(name);
        own.note("share of the road found", found, 1e-3);
        own.note("rms distance from its middle [px]", rms, close);
        own.note("nodes", real(nodes.len()), EXACT);
        let short = tail.distance(end);
        own.note("tail from the end of the road [px]", short, close);
        own.note("head from the border [px]", head.x, close);
        let off = Table::raw(name).exact("arc [px]", arcs());
        record.keep(off.exact("off [px]", places.iter().map(|p| p.0)));
        record.keep_run(name, &run);
    }
    for name in ENDS {
        let words = format!("\"{name}\", tail = \"{name}\"");
        let (scene, run) = ran(
            "sliding-strip",
            &[("\"border\", tail = \"border\"", &words)],
        )?;
        if let ("border", Some(picture)) = (name, &scene.picture) {
            record.keep_grid("edge", picture.levels().clone());
        }
        let nodes = last(&run);
        let off = most(nodes.iter().map(|p| (p.y - 40.0).abs()));
        let mut own = record.under(name);
        own.note("largest distance from the edge [px]", off, share(0.3));
        let ends = nodes[0]
            .x
            .abs()
            .max((nodes[nodes.len() - 1].x - 95.0).abs());
        let loose = if name == "free" { close } else { ROUNDING };
        own.note("ends off the border [px]", ends, loose);
        record.keep_run(name, &run);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut row = Vec::new();
    let (along, off) = (("along the road / px", 0.0, 215.0), ("px", 0.0, 3.0));
    let title = "distance of the nodes from the middle of the road";
    let mut distance = plot(title, along, off);
    for (name, title, words, color) in [
        ("growing", "tips that grow", "grown", Color::SKY),
        ("not growing", "the same without", "not grown", Color::RED),
    ] {
        let run = record.run(name)?;
        let ground = Picture::new(grey(record.grid("road")?));
        let mut panel = Panel::pixels(title, 192, 128).bare().with(ground);
        let end = run.len() - 1;
        for k in 0..end {
            let color = Color::YELLOW.mix(Color::RED, real(k) / real(run.len()));
            let curve = run.pairs(k);
            let tips = [curve[0], curve[curve.len() - 1]];
            if k == 0 {
                panel = panel.with(line(curve, color).weighing(0.7));
            }
            panel = panel.with(dots(tips, 2.0, color));
        }
        row.push(panel.with(line(run.pairs(end), Color::SKY).weighing(1.4)));
        distance = distance.with(line(record.points(name, "arc", "off")?, color).named(words));
    }
    let mut strips = Vec::new();
    for name in ENDS {
        let run = record.run(name)?;
        let ground = grey(&record.grid("edge")?.mapv(|v| 0.6 * v + 60.0));
        let mut panel = Panel::pixels(format!("ends: {name}"), 96, 80)
            .bare()
            .with(Picture::new(ground));
        let end = run.len() - 1;
        for k in (0..end).step_by(3).chain([end]) {
            panel = panel.with(line(run.pairs(k), Color::RED).weighing(0.35));
        }
        strips.push(
            panel
                .with(line(run.pairs(0), Color::YELLOW))
                .with(line(run.pairs(end), Color::BLUE).weighing(1.6)),
        );
    }
    Artefact::only(
        "Above: the start (yellow), where the tips were every 400 steps (dots) and the end (blue). Below: the strip from its start (yellow) to its end (blue) under four rules for its ends.",
        Figure::new("Open curves", 1000.0)
            .with(310.0, row)
            .with(180.0, vec![distance])
            .with(210.0, strips),
    )
}
