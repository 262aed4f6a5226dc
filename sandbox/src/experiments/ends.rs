//! Report §3.2, what happens at the ends (D3, D4): a bent strip in empty space.

use crate::prelude::*;

/// Scene, name, table of its center.
const ENDS: [(&str, &str, &str); 2] = [
    ("bent-strip-free", "free ends", "center-free"),
    ("bent-strip-anchored", "anchored ends", "center-anchored"),
];

/// Free and anchored ends.
pub(crate) const ENDS_OF_A_STRIP: Experiment = Experiment {
    id: "sec-3-2-ends",
    title: "A bent strip in empty space",
    place: "§3.2",
    question: "Nothing acts on a bent strip but its own elasticity. Where does its center go with natural ends, where \
               with the ends of the report's program?",
    claims: &[
        claim("with free ends the center stays where it is [D3, D5]")
            .when(&[below("free ends: center moved at most", 1e-12)]),
        claim("with the report's ends the snake pushes itself along, with nothing to push against [D4]")
            .when(&[above("anchored ends: center moved at most", 0.5)]),
        claim("both straighten out towards the straight rest shape [report §2.4]")
            .when(&[less("*: bend at the end", 0.5, "*: bend at the start")]),
    ],
    run,
    draw,
};

/// Largest distance of a node from the chord.
fn bend(nodes: &[DVec2]) -> f64 {
    let (Some(&a), Some(&b)) = (nodes.first(), nodes.last()) else {
        return 0.0;
    };
    let across = (b - a).normalize().perp();
    most(nodes.iter().map(|&p| (p - a).dot(across).abs()))
}

fn run() -> Result {
    let mut record = Record::default();
    for (scene, name, table) in ENDS {
        let (_, run) = ran(scene, &[])?;
        let centers = run
            .frames
            .iter()
            .map(|frame| elastic::center(frame.nodes(), None));
        let centers: Vec<DVec2> = centers.collect();
        let way = most(centers.iter().map(|c| c.distance(centers[0])));
        let mut own = record.under(name);
        own.note("center moved at most [px]", way, ROUNDING);
        let start = bend(run.frames[0].nodes());
        own.note("bend at the start [px]", start, ROUNDING);
        own.note("bend at the end [px]", bend(last(&run)), ROUNDING);
        let times = Table::new(table).with("t [s]", ROUNDING, run.frames.iter().map(|f| f.t));
        record.keep(times.xy("px", ROUNDING, &centers));
        record.keep_run(name, &run);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    let mut moved = plot(
        "how far the center has gone",
        ("t / s", 0.0, 20.0),
        ("px", -0.1, 2.4),
    )
    .legend_at(Corner::TopLeft);
    let (x, y) = (("x / px", 18.9, 20.9), ("y / px", 2.6, 5.3));
    let mut near = plot("the way of the center", x, y)
        .equal()
        .legend_at(Corner::TopLeft);
    for ((_, name, table), color) in ENDS.into_iter().zip([Color::GREEN, Color::RED]) {
        let frames = record.run(name)?;
        let all = (0..frames.len()).flat_map(|i| frames.nodes(i));
        let (low, high) = range(all.map(|p| p.y), 0.08);
        let y = ("y / px", low.min(-7.0), high.max(13.0));
        let mut panel = plot(name, ("x / px", -2.0, 41.0), y).equal();
        for (index, t) in [0.0, 1.0, 2.0, 4.0, 8.0, 20.0].into_iter().enumerate() {
            let color = Color::BLUE.mix(Color::RED, real(index) / 5.0);
            panel = panel.with(line(frames.pairs(frames.nearest(t)), color).weighing(0.7));
        }
        let way = record.xy(table)?;
        let (begin, end) = (way[0], way[way.len() - 1]);
        let start = dots([begin], 2.0, Color::INK).named("center at the start");
        panels.push(
            panel
                .with(line(way.clone(), Color::INK).weighing(1.2))
                .with(start),
        );
        near = near
            .with(line(way.clone(), color).named(name))
            .with(dots([begin, end], 2.0, color));
        let gone = record.column(table, "t")?.iter().zip(&way);
        let gone = gone.map(|(&t, p)| (t, (p.0 - begin.0).hypot(p.1 - begin.1)));
        moved = moved.with(line(gone, color).named(name));
    }
    Artefact::only(
        "Above: after 0, 1, 2, 4, 8, 20 s, from blue to orange. Free ends: the forces sum to zero. The report's ends act as if \
         an undeformed node were held beyond each, so they do not.",
        Figure::new("§3.2  A bent strip in empty space", 900.0)
            .with(260.0, panels)
            .with(270.0, vec![near, moved]),
    )
}
