//! The five balls of §2.5 beside each other.

use super::course;
use crate::prelude::*;

/// Scene, short name and figure of each ball.
const BALLS: [(&str, &str, &str); 5] = [
    ("very-soft-ball", "very soft", "2.2"),
    ("soft-ball", "soft", "2.3"),
    ("rigid-ball", "rigid", "2.4"),
    ("hard-ball", "hard", "2.5"),
    ("very-hard-ball", "very hard", "2.6"),
];

/// Five balls, one row.
pub(crate) const OVERVIEW: Experiment = Experiment {
    id: "sec-2-5-balls",
    title: "Five balls",
    place: "§2.5",
    question: "From very soft to very hard: how far is each ball squeezed, how long does it stay, how fast does it \
               leave, and when is it in shape again?",
    claims: &[
        claim("the harder the ball, the less its area falls [report §2.5]")
            .when(&[rising("least area @ balls")]),
        claim("the harder the ball, the shorter it stays at the wall [errata §6]").judged(|r| {
            let first = r.column("balls", "first contact")?;
            let last = r.column("balls", "last contact")?;
            let stays: Vec<f64> = last.iter().zip(first).map(|(l, f)| l - f).collect();
            let falling = stays.windows(2).all(|pair| pair[1] < pair[0]);
            Ok(Finding::new(falling, format!("{stays:.2?} s")))
        }),
        claim("the harder the ball, the more of its speed it keeps [errata §6]").judged(|r| {
            let away = r.column("balls", "speed away from it")?;
            let towards = r.column("balls", "speed towards the wall")?;
            let kept: Vec<f64> = away.iter().zip(towards).map(|(a, t)| a / t).collect();
            let rising = kept.windows(2).all(|pair| pair[1] > pair[0]);
            Ok(Finding::new(rising, format!("{kept:.2?} of it")))
        }),
    ],
    run,
    draw: drawn,
};

fn run() -> Result {
    let mut record = Record::default();
    let (mut notes, mut courses) = (Vec::new(), Vec::new());
    for (scene, name, _) in BALLS {
        let (course, run) = course::follow(scene, &[])?;
        let mut one = Record::default();
        course::sum_up(&mut one, "", &course);
        notes.push(one);
        record.keep_run(name, &run);
        courses.push(course);
    }
    let mut table = Table::new("balls");
    for number in notes[0]
        .numbers
        .iter()
        .filter(|n| !n.name.starts_with("ringing"))
    {
        let values = notes.iter().map(|one| one.number(&number.name));
        let values = values.collect::<Result<Vec<f64>>>()?;
        let name = format!("{} [{}]", number.name, number.unit);
        table = table.with(name, number.tolerance, values);
    }
    record.keep(table);
    let rows = || (0..courses[0].t.len()).step_by(20);
    let mut fine = Table::raw("fine").exact("t [s]", rows().map(|i| courses[0].t[i]));
    for ((_, name, _), course) in BALLS.into_iter().zip(&courses) {
        fine = fine
            .exact(format!("deformation {name}"), rows().map(|i| course.rms[i]))
            .exact(
                format!("area {name}"),
                rows().map(|i| course.area[i] / course.area[0]),
            )
            .exact(format!("x {name}"), rows().map(|i| course.center[i].x))
            .exact(format!("y {name}"), rows().map(|i| course.center[i].y));
    }
    record.keep(fine);
    Ok(record)
}

fn drawn(record: &Record) -> Drawn {
    let mut strip = Vec::new();
    for (_, name, figure) in BALLS {
        let frames = record.run(name)?;
        let right = if name == "very hard" { 13.0 } else { 8.2 };
        let title = format!("{figure}  {name}");
        let mut panel = plot(title, ("", -0.3, right), ("", -1.9, 9.4))
            .equal()
            .bare();
        panel = panel.with(line([(0.0, -1.9), (0.0, 9.4)], Color::INK).weighing(1.6));
        panel.share = right + 0.6;
        let way = record.points("fine", &format!("x {name}"), &format!("y {name}"))?;
        let way = line(way, Color::INK).dashed().weighing(0.6);
        strip.push(snapshots(panel, frames, &frames.each(0.5), 0.55).with(way));
    }
    let time = ("t / s", 0.0, 7.0);
    let mut shape = plot(
        "deformation from its shape",
        time,
        Axis::log("rms of e", 1e-5, 3.0),
    );
    let mut area = plot("area", time, ("of the start", 0.0, 1.25));
    for ((_, name, _), color) in BALLS.into_iter().zip(Color::SERIES) {
        let over_time = |what: &str| record.points("fine", "t", &format!("{what} {name}"));
        shape = shape.with(
            line(over_time("deformation")?, color)
                .weighing(0.8)
                .named(name),
        );
        area = area.with(line(over_time("area")?, color).weighing(0.8).named(name));
    }
    let below = [shape, area].map(|panel| panel.legend_at(Corner::BottomRight));
    Artefact::only(
        "Each ball as the report draws it, a snapshot every 0.5 s, at one scale. Below: how far each is from its shape, \
         and its area.",
        Figure::new(
            "Figures 2.2 to 2.6  Five balls against the wall x = 0",
            1000.0,
        )
        .with(265.0, strip)
        .with(270.0, below.to_vec()),
    )
}
