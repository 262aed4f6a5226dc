//! How far each force reaches: from where a small circle gets to the object.

use super::super::pixels::grey;
use super::reach::{mean_distance, settle, worlds};
use super::synthetic::{SIZE, u_corners, u_outline, u_shape};
use crate::draw::{Color, Figure, Layer, Line, Panel, Picture};
use crate::{
    Artefact, Body, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real,
};
use glam::DVec2;

const ID: &str = "sec-4-2-capture";
/// Starts stand on a grid of so many pixels.
const EVERY: usize = 16;
const RADIUS: f64 = 10.0;
const NODES: usize = 100;
/// The circle around the object.
const AROUND_IT: f64 = 115.0;
/// On the object: nearer than this on average.
const NEAR: f64 = 2.0;
/// The start whose end is drawn in every panel.
const EXAMPLE: [usize; 2] = [7, 10];

const KINDS: [&str; 14] = [
    "report",
    "corrected",
    "one polarity",
    "several scales",
    "coarse to fine",
    "distance",
    "GVF",
    "generalised GVF",
    "VFC",
    "line",
    "termination",
    "two regions",
    "local regions",
    "likelihood",
];
/// Those that compare the inside with the outside come last.
const REGIONS: usize = 3;
/// Panels in a row.
const ROW: usize = 5;

/// From where on a grid of starts a circle reaches the object, a map for each force.
pub(crate) const CAPTURE: Experiment = Experiment {
    id: ID,
    title: "How far each force reaches",
    place: "§4.2",
    question: "A circle of radius 10 px starts at each of 256 places in the picture of a U and is moved by one force \
               alone until it rests, at a pixel a step where the force is not weak, its nodes kept evenly spaced. From where \
               does it come to lie on the object's outline, on average nearer than 2 px? And from where does it find the \
               outline as a whole?",
    claims: &[
        Claim {
            says: "the edge force reaches some ten pixels: from farther than 30 px no circle feels it",
            source: "theory §10.2",
            judge: |r| {
                let (report, corrected) = (afar(r, "report")?, afar(r, "corrected")?);
                Ok(Finding::new(
                    report < 0.01 && corrected < 0.01,
                    format!(
                        "{} and {} of the starts farther away arrive",
                        percent(report),
                        percent(corrected)
                    ),
                ))
            },
        },
        Claim {
            says: "the same force from coarse to fine reaches farther",
            source: "[lindeberg98]",
            judge: |r| {
                let coarse = afar(r, "coarse to fine")?;
                let fine = afar(r, "corrected")?;
                let several =
                    r.told("several scales: lies on the outline from farther than 30 px")?;
                Ok(Finding::new(
                    coarse > 0.5 + fine,
                    format!(
                        "{} of them; all scales at once {}",
                        percent(coarse),
                        percent(several)
                    ),
                ))
            },
        },
        Claim {
            says: "distance, GVF and VFC reach across the whole picture",
            source: "[cohen93], [xu98], [li07]",
            judge: |r| {
                let shares = ["distance", "GVF", "generalised GVF", "VFC"]
                    .into_iter()
                    .map(|kind| afar(r, kind))
                    .collect::<Result<Vec<f64>, SandboxError>>()?;
                let words: Vec<String> = shares.iter().map(|&share| percent(share)).collect();
                Ok(Finding::new(
                    shares.iter().all(|&share| share > 0.8),
                    format!("{} of them", words.join(", ")),
                ))
            },
        },
        Claim {
            says: "but inside the arms a circle may be torn: one side goes to one edge, one to the other",
            source: "theory",
            judge: |r| {
                let (distance, corrected) = (reach(r, "distance")?, reach(r, "corrected")?);
                let far = afar(r, "distance")?;
                Ok(Finding::new(
                    distance < far && corrected < 0.7,
                    format!(
                        "the distance force brings {} of all starts to the outline",
                        percent(distance)
                    ),
                ))
            },
        },
        Claim {
            says: "but a small circle that arrives there lies folded on a piece of the outline: none of these forces makes it grow round the U",
            source: "theory",
            judge: |r| {
                let most = KINDS[..KINDS.len() - REGIONS]
                    .iter()
                    .map(|kind| whole(r, kind))
                    .collect::<Result<Vec<f64>, SandboxError>>()?
                    .into_iter()
                    .fold(0.0, f64::max);
                Ok(Finding::new(
                    most < 0.05,
                    format!(
                        "the whole outline from {} of the starts at most",
                        percent(most)
                    ),
                ))
            },
        },
        Claim {
            says: "a circle around the U is led into its slot by GVF, generalised GVF and VFC, not by distance or the edge force",
            source: "[xu98], [li07]",
            judge: |r| {
                let off = |kinds: &[&str]| {
                    let one = |kind: &&str| {
                        r.number(&format!(
                            "{kind}: from around; mean distance of the outline"
                        ))
                    };
                    kinds
                        .iter()
                        .map(one)
                        .collect::<Result<Vec<f64>, SandboxError>>()
                };
                let led = off(&["GVF", "generalised GVF", "VFC"])?;
                let not = off(&["report", "corrected", "distance"])?;
                let words = |of: &[f64]| {
                    of.iter()
                        .map(|d| format!("{d:.1}"))
                        .collect::<Vec<_>>()
                        .join(", ")
                };
                Ok(Finding::new(
                    led.iter().all(|&d| d < NEAR) && not.iter().all(|&d| d > NEAR),
                    format!(
                        "outline {} px from the curve on average, against {} px",
                        words(&led),
                        words(&not)
                    ),
                ))
            },
        },
        Claim {
            says: "lines and terminations are no outlines: a circle near them goes into the object, or to its corners, and does not lie on its edge",
            source: "[kass88]",
            judge: |r| {
                let (line, corner) = (reach(r, "line")?, reach(r, "termination")?);
                let caught = r.number("line: ends inside the object, of starts within 15 px")?;
                let cornered = r.number(
                    "termination: a node within 3 px of a corner, of starts within 15 px of one",
                )?;
                Ok(Finding::new(
                    line < 0.05 && corner < 0.05 && caught > 0.5 && cornered > 0.5,
                    format!(
                        "{} and {} of the starts arrive; {} end inside, {} at a corner",
                        percent(line),
                        percent(corner),
                        percent(caught),
                        percent(cornered)
                    ),
                ))
            },
        },
        Claim {
            says: "an edge force of one polarity finds as many circles from inside, and few of those that stand outside: they see the edge from its other side",
            source: "theory",
            judge: |r| {
                let inside = r.number("one polarity: lies on the outline, of starts inside")?;
                let outside = r.number("one polarity: lies on the outline, of starts outside")?;
                let both = r.number("corrected: lies on the outline, of starts outside")?;
                let within = r.number("corrected: lies on the outline, of starts inside")?;
                Ok(Finding::new(
                    outside < 0.5 * both && (inside - within).abs() < 0.05,
                    format!(
                        "{} of the starts inside, with both polarities {}; {} of those outside, with both {}",
                        percent(inside),
                        percent(within),
                        percent(outside),
                        percent(both)
                    ),
                ))
            },
        },
        Claim {
            says: "two regions find the whole outline from wherever the circle starts on the object",
            source: "[chanvese01]",
            judge: |r| {
                let share = r.number(
                    "two regions: whole outline from starts whose circle is on the object",
                )?;
                let away = r.told(
                    "two regions: whole outline from starts whose circle does not touch it",
                )?;
                Ok(Finding::new(
                    share > 0.95,
                    format!(
                        "{} of them; {} of those off it",
                        percent(share),
                        percent(away)
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn afar(record: &Record, kind: &str) -> Result<f64, SandboxError> {
    record.number(&format!(
        "{kind}: lies on the outline from farther than 30 px"
    ))
}

fn reach(record: &Record, kind: &str) -> Result<f64, SandboxError> {
    record.number(&format!("{kind}: lies on the outline"))
}

fn whole(record: &Record, kind: &str) -> Result<f64, SandboxError> {
    record.number(&format!("{kind}: is the whole outline"))
}

fn starts() -> Vec<DVec2> {
    let places = || (0..SIZE / EVERY).map(|i| real(EVERY * i) + 0.5 * real(EVERY) - 0.5);
    places()
        .flat_map(|y| places().map(move |x| DVec2::new(x, y)))
        .collect()
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let image = u_shape(ID)?;
    let truth = u_corners();
    let starts = starts();
    let on = |p: &DVec2| {
        let far = outline::distance(&truth, true, *p) > RADIUS;
        (outline::winding(&truth, *p) != Some(0), far)
    };
    let example = EXAMPLE[1] * (SIZE / EVERY) + EXAMPLE[0];
    let mut table = Table::new("starts")
        .with(
            "x",
            "px",
            Tolerance::EXACT,
            starts.iter().map(|p| p.x).collect(),
        )
        .with(
            "y",
            "px",
            Tolerance::EXACT,
            starts.iter().map(|p| p.y).collect(),
        );
    let mut ends = Table::raw("example");
    let mut circles = Table::raw("around");
    for kind in KINDS {
        let worlds = worlds(ID, kind, &image)?;
        let (mut found, mut within, mut cornered) = (Vec::new(), Vec::new(), Vec::new());
        for (index, &at) in starts.iter().enumerate() {
            let (x, rests) = settle(ID, &worlds, elastic::circle(at, RADIUS, NODES))?;
            let arrived = rests && mean_distance(&x, &truth) < NEAR;
            let all = arrived && mean_distance(&truth, &x) < NEAR;
            found.push(f64::from(u8::from(arrived)) + f64::from(u8::from(all)));
            let middle = x.iter().sum::<DVec2>() / real(x.len());
            within.push(outline::winding(&truth, middle) != Some(0));
            cornered.push(
                truth
                    .iter()
                    .any(|corner| x.iter().any(|p| p.distance(*corner) < 3.0)),
            );
            if index == example {
                ends = ends
                    .with(
                        format!("{kind} x"),
                        "px",
                        Tolerance::EXACT,
                        x.iter().map(|p| p.x).collect(),
                    )
                    .with(
                        format!("{kind} y"),
                        "px",
                        Tolerance::EXACT,
                        x.iter().map(|p| p.y).collect(),
                    );
            }
        }
        let share = |test: &dyn Fn(usize) -> bool, of: &dyn Fn(usize) -> bool| {
            let counted: Vec<usize> = (0..starts.len()).filter(|&i| of(i)).collect();
            real(counted.iter().filter(|&&i| test(i)).count()) / real(counted.len())
        };
        let (arrived, all) = (|i: usize| found[i] > 0.5, |i: usize| found[i] > 1.5);
        // a few starts on a watershed may go either way on another machine
        let few = Tolerance::Absolute(0.02);
        record.note(
            format!("{kind}: lies on the outline"),
            share(&arrived, &|_| true),
            "of the starts",
            few,
        );
        record.note(
            format!("{kind}: is the whole outline"),
            share(&all, &|_| true),
            "of the starts",
            few,
        );
        let far = |i: usize| outline::distance(&truth, true, starts[i]) > 30.0;
        record.note(
            format!("{kind}: lies on the outline from farther than 30 px"),
            share(&arrived, &far),
            "of these starts",
            few,
        );
        // and what the literature shows: a circle around the whole object
        let around = elastic::circle(DVec2::splat(128.0), AROUND_IT, 3 * NODES);
        let (x, _) = settle(ID, &worlds, around)?;
        record.note(
            format!("{kind}: from around; mean distance of the outline"),
            mean_distance(&truth, &x),
            "px",
            Tolerance::Relative(0.2),
        );
        let column = |part: fn(&DVec2) -> f64| x.iter().map(part).collect();
        circles = circles
            .with(format!("{kind} x"), "px", Tolerance::EXACT, column(|p| p.x))
            .with(format!("{kind} y"), "px", Tolerance::EXACT, column(|p| p.y));
        let inside = |i: usize| outline::winding(&truth, starts[i]) != Some(0);
        if kind == "line" {
            let near = |i: usize| outline::distance(&truth, true, starts[i]) < 15.0;
            record.note(
                "line: ends inside the object, of starts within 15 px",
                share(&|i| within[i], &near),
                "of them",
                few,
            );
        }
        if kind == "termination" {
            let near = |i: usize| truth.iter().any(|corner| corner.distance(starts[i]) < 15.0);
            record.note(
                "termination: a node within 3 px of a corner, of starts within 15 px of one",
                share(&|i| cornered[i], &near),
                "of them",
                few,
            );
        }
        if kind == "one polarity" || kind == "corrected" {
            let sides: [(&str, &dyn Fn(usize) -> bool); 2] =
                [("inside", &inside), ("outside", &|i| !inside(i))];
            for (side, of) in sides {
                record.note(
                    format!("{kind}: lies on the outline, of starts {side}"),
                    share(&arrived, of),
                    "of them",
                    few,
                );
            }
        }
        if kind == "two regions" {
            record.note(
                "two regions: whole outline from starts whose circle is on the object",
                share(&all, &|i| on(&starts[i]) == (true, true)),
                "of them",
                few,
            );
            record.note(
                "two regions: whole outline from starts whose circle does not touch it",
                share(&all, &|i| on(&starts[i]) == (false, true)),
                "of them",
                few,
            );
        }
        table = table.with(
            kind,
            "0 no; 1 on it; 2 all of it",
            Tolerance::Absolute(2.0),
            found,
        );
    }
    table.compared = false;
    record.keep(table);
    record.keep(ends);
    record.keep(circles);
    record.keep_grid("image", image);
    let (x, y): (Vec<f64>, Vec<f64>) = u_outline().iter().map(|p| (p.x, p.y)).unzip();
    record.keep(
        Table::raw("truth")
            .with("x", "px", Tolerance::EXACT, x)
            .with("y", "px", Tolerance::EXACT, y),
    );
    Ok(record)
}

/// A row as wide as the others.
fn filled(row: &[Panel]) -> Vec<Panel> {
    let empty = || Panel::pixels(String::new(), SIZE, SIZE).bare();
    let missing = ROW - row.len();
    row.iter()
        .cloned()
        .chain(std::iter::repeat_with(empty).take(missing))
        .collect()
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let ground = grey(record.grid("image")?);
    let truth = record.points("truth", "x", "y")?;
    let places = record.points("starts", "x", "y")?;
    let example = places[EXAMPLE[1] * (SIZE / EVERY) + EXAMPLE[0]];
    let mut panels = Vec::new();
    for kind in KINDS {
        let found = record.column("starts", kind)?;
        let dots = |level: f64, radius, color| Layer::Dots {
            points: places
                .iter()
                .zip(found)
                .filter(|(_, f)| (*f - level).abs() < 0.5)
                .map(|(p, _)| *p)
                .collect(),
            radius,
            color,
            label: String::new(),
        };
        let end = record.points("example", &format!("{kind} x"), &format!("{kind} y"))?;
        let title = format!(
            "{kind}: {}, all {}",
            percent(reach(record, kind)?),
            percent(whole(record, kind)?)
        );
        let round = (0..=48)
            .map(|i| DVec2::from_angle(real(i) * std::f64::consts::TAU / 48.0) * RADIUS)
            .map(|p| (example.0 + p.x, example.1 + p.y))
            .collect();
        panels.push(
            Panel::pixels(title, SIZE, SIZE)
                .bare()
                .with(Picture::new(ground.clone()).faded(0.35))
                .with(Line::new(truth.clone(), Color::GREY).closed().weighing(0.6))
                .with(dots(0.0, 1.0, Color::GREY))
                .with(dots(1.0, 2.4, Color::SKY))
                .with(dots(2.0, 2.4, Color::GREEN))
                .with(Line::new(round, Color::INK).dashed().weighing(0.8))
                .with(Line::new(end, Color::RED).closed().weighing(1.1)),
        );
    }
    let mut figure = Figure::new(
        "§4.2  Starts from which a circle of radius 10 px reaches the U: blue, it lies on the outline; green, it is the outline",
        940.0,
    );
    for row in panels.chunks(ROW) {
        figure = figure.with(212.0, filled(row));
    }
    let mut around = Vec::new();
    for kind in KINDS {
        let end = record.points("around", &format!("{kind} x"), &format!("{kind} y"))?;
        let off = record.number(&format!(
            "{kind}: from around; mean distance of the outline"
        ))?;
        let round = (0..=96)
            .map(|i| DVec2::from_angle(real(i) * std::f64::consts::TAU / 96.0) * AROUND_IT)
            .map(|p| (128.0 + p.x, 128.0 + p.y))
            .collect();
        around.push(
            Panel::pixels(format!("{kind}: {off:.1} px"), SIZE, SIZE)
                .bare()
                .with(Picture::new(ground.clone()).faded(0.35))
                .with(Line::new(round, Color::INK).dashed().weighing(0.8))
                .with(Line::new(end, Color::RED).closed().weighing(1.3)),
        );
    }
    let mut second = Figure::new(
        "§4.2  A circle of radius 115 px around the U: where each force leaves it, and how far the outline is from it",
        940.0,
    );
    for row in around.chunks(ROW) {
        second = second.with(212.0, filled(row));
    }
    Ok(vec![
        Artefact::figure(
            "One panel for each force, one dot for each start. Small grey: it does not arrive. Blue: it comes to rest on \
         the outline, nearer than 2 px on average. Green: and all of the outline is found. Dashed and red: one start \
         and its end.",
            figure,
        ),
        Artefact::further(
            "around",
            "The same forces on a circle around the whole object. The number is the mean distance of the true outline from where it ends.",
            Body::Figure(second),
        ),
    ])
}
