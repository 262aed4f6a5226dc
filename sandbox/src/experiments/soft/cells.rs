//! Two cells that share a border, against Young's equation.

use crate::prelude::*;

const ADHESION: [f64; 6] = [0.0, 0.4, 0.8, 1.2, 1.6, 2.0];

/// The scene two-cells at several adhesions.
pub(crate) const CELLS: Experiment = Experiment {
    id: "soft-cells",
    title: "Two cells share a border",
    place: "beyond",
    question: "Two filled skins of tension T gain W per length of border that they share. Do they part at the angle of Young's \
               equation, cos θ = 1 − W/2T, with no overlap?",
    claims: &[
        claim("they part at the angle of Young's equation, up to W = T [Young's equation]").judged(|r| {
            let found = r.column("angles", "cosine")?;
            let exact = r.column("angles", "exact")?;
            let off = found.iter().zip(exact).skip(1).map(|(a, b)| (a - b).abs());
            let off: Vec<f64> = off.collect();
            let holds = off.iter().all(|&off| off < 0.02);
            Ok(Finding::new(holds, format!("cos θ off by {off:.3?}")))
        }),
        claim("if their skins bend over some nodes: a corner sharper than a right angle holds on to its \
               node [the same run without rigidity]")
            .judged(|r| {
                let sharp = r.number("cosine without rigidity, less the exact one")?;
                let round = r.number("cosine, less the exact one")?;
                Ok(Finding::new(
                    sharp > 5.0 * round.abs(),
                    format!(
                        "at W = T off by {sharp:.3} without rigidity, {round:.3} with the width of \
                         three edges"
                    ),
                ))
            }),
        claim("they lie a gap apart and nowhere in each other [the contact law]").when(&[
            at_most("deepest overlap", 0.0),
            near("width of the layer between", 0.1, 0.01),
        ]),
        claim("without adhesion they touch and no more [the same run without]")
            .when(&[above("centers without adhesion", 6.0)]),
    ],
    run,
    draw,
};

/// The circle through points: least squares of `|p|² − 2 c·p − d`.
fn circle_through(points: &[DVec2]) -> (DVec2, f64) {
    let n = real(points.len());
    let mean = points.iter().sum::<DVec2>() / n;
    let spread = points.iter().map(|p| p.distance_squared(mean)).sum::<f64>() / n;
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for p in points.iter().map(|p| *p - mean) {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
        right += 0.5 * (p.length_squared() - spread) * p;
    }
    let det = xx * yy - xy * xy;
    let at = DVec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / det;
    (mean + at, (spread + at.length_squared()).sqrt())
}

/// cos θ as the free arcs say it, and the tension of the skin.
fn measure(group: &Group, gap: f64, range: f64) -> (f64, f64, f64) {
    let (mut centers, mut radius, mut tension) = (Vec::new(), 0.0, 0.0);
    for member in group.members() {
        let (x, body) = (&member.state().x, member.snake().body());
        tension =
            body.material.tension.at(0) * elastic::length(x, true) / (body.spacing * real(x.len()));
        let free = x.iter().copied().filter(|p| p.x.abs() > gap + 2.0 * range);
        let (center, r) = circle_through(&free.collect::<Vec<_>>());
        centers.push(center);
        radius = r;
    }
    let apart = centers[0].distance(centers[1]);
    (0.5 * (apart - gap) / radius, tension, apart)
}

/// The two cells at rest.
fn adhering(adhesion: f64, rigidity: &str) -> Result<Group> {
    let changes = [
        ("adhesion = 1.2", &*format!("adhesion = {adhesion:.1}")),
        ("rigidity = 1e-7", &*format!("rigidity = {rigidity}")),
    ];
    let scene = scene_with("two-cells", &changes)?;
    let mut group = group(&scene)?;
    while group.steps() < scene.plan.until.steps {
        advance(&mut group)?;
    }
    Ok(group)
}

fn run() -> Result {
    let mut record = Record::default();
    let (mut found, mut exact, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let mut frames = Vec::new();
    let (cosine, tension, _) = measure(&adhering(2.0, "0.0")?, 0.1, 0.4);
    let off = cosine - 1.0 + 1.0 / tension;
    record.note("cosine without rigidity, less the exact one", off, 5e-3);
    record.note("W/T without rigidity", 2.0 / tension, 5e-3);
    record.note("cosine without rigidity", cosine, 5e-3);
    for adhesion in ADHESION {
        let group = adhering(adhesion, "1e-7")?;
        let (cosine, tension, apart) = measure(&group, 0.1, 0.4);
        found.push(cosine);
        exact.push(1.0 - 0.5 * adhesion / tension);
        ratios.push(adhesion / tension);
        // a picture for each adhesion, not for each time
        frames.push(Frame {
            t: adhesion,
            ..frame(&group)
        });
        if adhesion <= 0.0 {
            record.note("centers without adhesion [px]", apart, 1e-3);
        } else if adhesion >= 2.0 {
            let off = cosine - 1.0 + 0.5 * adhesion / tension;
            record.note("cosine, less the exact one", off, 1e-3);
            record.note("deepest overlap [px]", group.deepest(), 1e-3);
            let inner = |k: usize| {
                let x = &group.members()[k].state().x;
                let side = x.iter().filter(|p| p.y.abs() < 0.5 && p.x.abs() < 1.0);
                mean(side.map(|p| p.x))
            };
            record.note("width of the layer between [px]", inner(1) - inner(0), 1e-3);
        }
    }
    record.keep_run("cells", frames);
    record.keep(
        Table::new("angles")
            .exact("adhesion", ADHESION)
            .with("W/T", 1e-3, ratios)
            .with("cosine", 5e-3, found)
            .with("exact", 1e-3, exact),
    );
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let run = record.run("cells")?;
    let color = |snake: usize| [Color::BLUE, Color::ORANGE][snake % 2];
    let whole = [-6.4, -4.0, 6.4, 4.0];
    let row = run.frames.iter();
    let row = row.map(|frame| picture(format!("W = {:.1}", frame.t), &frame.curves, whole, &color));
    let ideal = (0..=20)
        .map(|k| 0.055 * f64::from(k))
        .map(|w| (w, 1.0 - 0.5 * w));
    let mut points = record.points("angles", "W/T", "cosine")?;
    points.retain(|p| p.0 > 0.0);
    let sharp = (
        record.told("W/T without rigidity")?,
        record.told("cosine without rigidity")?,
    );
    let angle = plot("where they part", ("W / T", 0.0, 1.1), ("cos θ", 0.4, 1.1))
        .with(line(ideal, Color::GREEN).named("Young: 1 − W / 2T"))
        .with(dots(points, 3.0, Color::INK).named("of the arcs"))
        .with(dots([sharp], 3.0, Color::ORANGE).named("without rigidity"));
    let end = &run.frames[run.nearest(1.2)].curves;
    let title = "the end of the border at W = 1.2";
    let close = picture(title, end, [-1.6, 0.6, 1.6, 2.6], &color);
    Artefact::only(
        "Above: two cells without adhesion, and with more and more. Below: the angle against Young's equation, and a closer look.",
        Figure::new("Two cells share a border", 1100.0)
            .with(170.0, row.collect())
            .with(290.0, vec![angle, close]),
    )
}
