//! One edge, turned: does the force turn with it?

use super::synthetic::{AROUND, OBJECT, covered};
use crate::prelude::*;
use field::{
    EdgeForce, ForceField, Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};
use integrator::{Scheme, State};
use snake::{Body, Sampling, Snake, Until, World};
use std::ops::ControlFlow;
use std::sync::Arc;

const SIZE: usize = 128;
const MIDDLE: DVec2 = DVec2::splat(63.5);
const RADIUS: f64 = 40.0;
/// Half the length of edge that is looked at, and how far to both sides, in pixels.
const ALONG: usize = 16;
const ACROSS: usize = 12;
const NAMES: [&str; 2] = ["report", "corrected"];

/// The report's force and the corrected one, on a turned edge and on a disc.
pub(crate) const ROTATION: Experiment = Experiment {
    id: "sec-4-2-rotation",
    title: "A turned edge",
    place: "§4.2.2",
    question: "The same straight edge at angles from 0° to 90°, and a circle fitted to a disc: does the force stay as \
               strong, does it point across the edge, and does the circle stay round?",
    claims: &[
        claim("turned by 45°, the report's force has another strength; the corrected one keeps its own \
               [D38, D39]")
            .when(&[
                above("report: strength; largest over least", 1.2),
                below("corrected: strength; largest over least", 1.06),
            ]),
        claim("the report's force pulls askew; the corrected one across the edge [D39]").when(&[
            above("report: direction; largest error", 10.0),
            below("corrected: direction; largest error", 2.0),
        ]),
        claim("at 0° and 90° both are the same force [theory §11.2]")
            .when(&[like("report: strength at *", "corrected: strength at *", 0.01)]),
        claim("a circle in the corrected field comes to rest as a circle, too small by σ²/2R as theory \
               has it [theory §11.3]")
            .when(&[
                close("corrected: circle; mean of radius − R", "theory: −σ²/2R", 0.02),
                below("corrected: circle; largest less least radius", 0.03),
            ]),
        claim("in the report's field it does not stay round, and its nodes bunch [D38, D39]").when(&[
            more(
                "report: circle; largest less least radius",
                5.0,
                "corrected: circle; largest less least radius",
            ),
            above("report: circle; widest over narrowest gap", 1.2),
            below("corrected: circle; widest over narrowest gap", 1.05),
        ]),
    ],
    run,
    draw,
};

fn fields(image: &Grid) -> Result<[ForceField; 2]> {
    let report = report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)?;
    Ok([
        report,
        edge_force(image, &EdgeForce::as_strong_as_the_report())?,
    ])
}

/// Bright on the side that `normal` points away from.
fn edge(normal: DVec2) -> Grid {
    covered((SIZE, SIZE), |p| (p - MIDDLE).dot(normal) < 0.0)
}

/// What a force is like about a straight edge.
struct Looked {
    /// Largest force, of each line across the edge the largest, averaged along it.
    strength: f64,
    /// Largest angle between force and normal, degrees, where the force is at least half its largest.
    askew: f64,
}

fn look(field: &ForceField, normal: DVec2) -> Looked {
    let mut peaks = Vec::new();
    let mut seen = Vec::new();
    for along in 0..=2 * ALONG {
        let foot = MIDDLE + normal.perp() * (real(along) - real(ALONG));
        let mut peak = 0.0_f64;
        for step in 0..=8 * ACROSS {
            let distance = 0.25 * real(step) - real(ACROSS);
            let force = field.at(foot + normal * distance);
            // to the edge from either side
            let to = force * -distance.signum();
            peak = peak.max(force.length());
            seen.push((force.length(), to));
        }
        peaks.push(peak);
    }
    let strength = mean(peaks);
    let strong = seen.iter().filter(|(size, _)| *size >= 0.5 * strength);
    let askew = most(strong.map(|(_, to)| to.angle_to(normal).abs().to_degrees()));
    Looked { strength, askew }
}

/// Where a circle of 120 nodes, 3 px too large, ends on the disc. Its tension keeps nodes apart, and is too weak to
/// make it smaller by more than 0.002 px.
fn settle(field: ForceField) -> Result<Vec<DVec2>> {
    let start = elastic::circle(MIDDLE, RADIUS + 3.0, 120);
    let body = Body::of(&start, elastic::Topology::Closed, 1.0)?
        .with_damping(1.0)
        .with_material(elastic::Material::uniform(0.0, 10.0, 0.0));
    let world = World::default().with_image(Arc::new(field), Sampling::Bilinear);
    let mut snake = Snake::new(body, world)?;
    let mut state = State::at_rest(start);
    let watch = &mut |_: &State| ControlFlow::Continue(());
    let until = Until::steps(4000);
    moved(
        &mut snake,
        &mut state,
        (Scheme::GradientFlow, 0.04),
        &until,
        watch,
    )?;
    Ok(state.x)
}

fn run() -> Result {
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=90).step_by(3).map(real).collect();
    let mut looked: [Vec<Looked>; 2] = [Vec::new(), Vec::new()];
    for &degree in &degrees {
        let normal = DVec2::from_angle(degree.to_radians());
        for (field, into) in fields(&edge(normal))?.iter().zip(&mut looked) {
            into.push(look(field, normal));
        }
    }
    let close = 1e-6;
    let mut table = Table::new("turned").exact("angle [°]", degrees);
    for (name, seen) in NAMES.into_iter().zip(&looked) {
        let strength: Vec<f64> = seen.iter().map(|one| one.strength).collect();
        let all = || strength.iter().copied();
        let askew = || seen.iter().map(|one| one.askew);
        for (angle, value) in [("0°", strength[0]), ("90°", strength[strength.len() - 1])] {
            record.note(
                format!("{name}: strength at {angle} [M px/T²]"),
                value,
                close,
            );
        }
        let uneven = most(all()) / least(all());
        let mut own = record.under(name);
        own.note("strength; largest over least", uneven, close);
        own.note("direction; largest error [°]", most(askew()), close);
        table = table
            .with(format!("{name}: strength [M px/T²]"), close, all())
            .with(format!("{name}: askew [°]"), close, askew());
    }
    record.keep(table);

    let disc = covered((SIZE, SIZE), |p| p.distance(MIDDLE) < RADIUS);
    for (name, field) in NAMES.into_iter().zip(fields(&disc)?) {
        let nodes = settle(field)?;
        let angles = nodes
            .iter()
            .map(|&p| (p - MIDDLE).to_angle().to_degrees().rem_euclid(360.0));
        let radii = || nodes.iter().map(|&p| p.distance(MIDDLE) - RADIUS);
        let gaps = || (0..nodes.len()).map(|i| nodes[i].distance(nodes[(i + 1) % nodes.len()]));
        let mut own = record.under(name);
        own.note("circle; mean of radius − R [px]", mean(radii()), 1e-4);
        let round = most(radii()) - least(radii());
        own.note("circle; largest less least radius [px]", round, 1e-4);
        let even = most(gaps()) / least(gaps());
        own.note("circle; widest over narrowest gap", even, 1e-3);
        let table = Table::raw(name).exact("angle [°]", angles);
        record.keep(table.exact("radius − R [px]", radii()));
    }
    // the binomial passes, and the two derivatives that average over two pixels each
    let square = f64::from(REPORT_PASSES) / 2.0 + 2.0 / 3.0;
    record.note("theory: −σ²/2R [px]", -square / (2.0 * RADIUS), ROUNDING);
    record.note("contrast [grey levels]", OBJECT - AROUND, EXACT);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let angle = || Axis::new("angle of the edge's normal / °", 0.0, 90.0).with_ticks(7);
    let force = ("force / (M px/T²)", 0.0, 30.0);
    let mut strength = plot("how strong: largest force beside the edge", angle(), force)
        .legend_at(Corner::BottomLeft);
    let title = "how askew: largest angle between force and normal";
    let mut askew = plot(title, angle(), ("angle / °", 0.0, 40.0)).legend_at(Corner::TopLeft);
    let theory = record.told("theory: −σ²/2R")?;
    let theory = line([(0.0, theory), (360.0, theory)], Color::GREEN).dashed();
    let mut circle = plot(
        "where a circle ends on a disc of R = 40 px, by the direction from its middle",
        Axis::new("direction from the middle / °", 0.0, 360.0).with_ticks(9),
        Axis::new("radius − R / px", -0.25, 0.1).with_ticks(8),
    )
    .with(theory.named("theory: −σ²/2R"));
    for (name, color) in NAMES.into_iter().zip([Color::RED, Color::BLUE]) {
        let turned = |column: &str| -> Result<Line> {
            let points = record.points("turned", "angle", &format!("{name}: {column}"))?;
            Ok(line(points, color).named(name))
        };
        strength = strength.with(turned("strength")?);
        askew = askew.with(turned("askew")?);
        let ends = record.points(name, "angle", "radius − R")?;
        circle = circle.with(dots(ends, 1.3, color).named(name));
    }
    Artefact::only(
        "Above: the strength of the force at a straight edge, and how far it points from the normal. Below: where the \
         nodes of a circle come to rest on a disc; the nodes of the report's force slide along the edge and bunch.",
        Figure::new(
            "§4.2.2  One edge at many angles, 20 passes, contrast 140",
            860.0,
        )
        .with(290.0, vec![strength, askew])
        .with(300.0, vec![circle]),
    )
}
