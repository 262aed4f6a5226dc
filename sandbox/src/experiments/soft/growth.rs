//! A rest shape that grows into its object, and carries its form to where no edge is seen.

use crate::prelude::*;

/// The ellipse of the scene growing-cell, and where the bright thing that hides its end begins.
const ELLIPSE: (DVec2, DVec2) = (DVec2::new(64.0, 48.0), DVec2::new(44.0, 18.0));
const HIDDEN: f64 = 96.0;
const RATE: f64 = 0.005;
/// Growth, none, and a balloon instead of a memory: what is changed in the scene.
const RUNS: [(&str, Changes); 3] = [
    ("grows", &[]),
    ("does not grow", &[NO_GROWTH]),
    (
        "balloon",
        &[
            NO_GROWTH,
            ("tether = 2.0", "tether = 0.0"),
            (
                "[snake]",
                "[[force]]\nkind = \"pressure\"\npressure = 3.0\n\n[snake]",
            ),
        ],
    ),
];
const NO_GROWTH: (&str, &str) = ("growth = 0.005", "growth = 0.0");

/// Growth of the rest shape.
pub(crate) const GROWTH: Experiment = Experiment {
    id: "soft-growth",
    title: "A rest shape that grows",
    place: "beyond",
    question: "A cell of known form grows at a known rate; one end of it lies hidden under something as bright. A snake of that form starts at half the size. \
               Does its rest shape grow at the rate it is told, does it find the border, and does it know where the hidden end is?",
    claims: &[
        claim("the rest shape grows as e to the rate times the time [Upkeep::growth]")
            .when(&[below("rest shape against the exponential", 1e-12)]),
        claim("the border is found, and the hidden end is where its form says [memory of shape]").when(&[
            below("grows: mean distance where it is seen", 0.5),
            below("grows: farthest where it is hidden", 3.5),
        ]),
        claim("without growth the memory of its size keeps it from the border; a balloon without memory \
               leaks through the hidden end and floods the picture: no border holds it \
               [the same run without]")
            .when(&[
                above("does not grow: mean distance where it is seen", 5.0),
                above("balloon: mean distance where it is seen", 5.0),
                above("balloon: farthest where it is hidden", 30.0),
            ]),
    ],
    run,
    draw,
};

/// Distance from the ellipse.
fn off(p: DVec2) -> f64 {
    let around = (0..1440).map(|k| DVec2::from_angle(std::f64::consts::TAU * real(k) / 1440.0));
    least(around.map(|u| p.distance(ELLIPSE.0 + ELLIPSE.1 * u)))
}

fn run() -> Result {
    let mut record = Record::default();
    for (name, changes) in RUNS {
        let scene = scene_with("growing-cell", changes)?;
        let mut group = group(&scene)?;
        let size = |group: &Group| group.members()[0].snake().body().rest[0].length();
        let (first, end) = (size(&group), scene.plan.until.steps);
        let (mut frames, mut rows, mut grown) = (Vec::new(), Vec::new(), Vec::new());
        for step in 0..=end {
            if step > 0 {
                advance(&mut group)?;
            }
            if step.is_multiple_of(50) {
                let e = group.energies();
                let mut row = vec![e.kinetic, e.elastic(), e.forces[0], e.damping, e.parameters];
                row.push(e.total() - row.iter().sum::<f64>());
                rows.push((group.t(), row));
                grown.push((group.t(), size(&group) / first));
            }
            let early = name == "balloon" && [60, 120, 200, 300].contains(&step);
            if early || step.is_multiple_of(460) || step == end {
                frames.push(frame(&group));
            }
        }
        let (hidden, seen): (Vec<DVec2>, Vec<DVec2>) = group.members()[0]
            .state()
            .x
            .iter()
            .partition(|p| p.x >= HIDDEN - 4.0);
        let seen = mean(seen.into_iter().map(off));
        let mut own = record.under(name);
        own.note("mean distance where it is seen [px]", seen, 0.05);
        // a snake that keeps its size has no node there
        if name != "does not grow" {
            let hidden = most(hidden.into_iter().map(off));
            own.note("farthest where it is hidden [px]", hidden, 0.3);
        }
        let gap = format!("{name}: gap of the account [of the largest term]");
        record.note(gap, gap_of(&rows), 1e-9);
        if name == "grows" {
            let off = |(t, size): &(f64, f64)| (size / (RATE * t).exp() - 1.0).abs();
            record.note(
                "rest shape against the exponential",
                most(grown.iter().map(off)),
                1e-12,
            );
            record.note("growth at the end", grown[grown.len() - 1].1, share(1e-9));
            record.keep(Table::raw("growth").pairs("t [s]", "growth", &grown));
            if let Some(picture) = &scene.picture {
                record.keep_grid("cell", picture.levels().clone());
            }
        }
        record.keep_run(name, frames);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let ground = grey(record.grid("cell")?);
    let truth = (0..=180).map(|k| DVec2::from_angle(std::f64::consts::TAU * real(k) / 180.0));
    let truth = truth.map(|u| pair(ELLIPSE.0 + ELLIPSE.1 * u));
    let truth = line(truth, Color::GREEN).dashed();
    let mut row = Vec::new();
    let titles = [
        "its rest shape grows",
        "it does not grow",
        "a balloon without memory",
    ];
    for ((name, _), title) in RUNS.iter().zip(titles) {
        let run = record.run(name)?;
        let mut panel = Panel::pixels(title, 144, 96)
            .bare()
            .with(Picture::new(ground.clone()))
            .with(truth.clone().weighing(0.9));
        for k in 0..run.len() {
            let (color, weight) = match k {
                0 => (Color::YELLOW, 1.0),
                _ if k + 1 == run.len() => (Color::SKY, 2.0),
                _ => (Color::RED, 0.6),
            };
            panel = panel.with(run.ring(k, color).weighing(weight));
        }
        row.push(panel);
    }
    let exact = (0..=70).map(|k| (2.0 * real(k), (RATE * 2.0 * real(k)).exp()));
    let found = record
        .points("growth", "t", "growth")?
        .into_iter()
        .step_by(4);
    let title = "size of the rest shape over that at the start";
    let sizes = plot(title, ("t / s", 0.0, 140.0), ("", 0.9, 2.1))
        .legend_at(Corner::TopLeft)
        .with(line(exact, Color::GREEN).named("e to the 0.005 t"))
        .with(dots(found, 2.0, Color::INK).named("of the snake"));
    let grown = record.run("grows")?;
    let end = &grown.frames[grown.len() - 1].curves;
    let window = [84.0, 70.0, 116.0, 26.0];
    let close = picture("the hidden end", end, window, &|_| Color::BLUE)
        .with(truth)
        .with(line([(HIDDEN, 26.0), (HIDDEN, 70.0)], Color::GREY));
    Artefact::only(
        "Above: the start (yellow), on the way (red), the end (blue) and the cell (green, dashed), whose right end is hidden. Below: the size of the rest shape, \
         and the hidden end close by; grey: from where on it is hidden.",
        Figure::new("A rest shape that grows", 1000.0)
            .with(240.0, row)
            .with(240.0, vec![sizes, close]),
    )
}
