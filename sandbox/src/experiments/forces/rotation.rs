//! One edge, turned: does the force turn with it?

use super::synthetic::{AROUND, OBJECT, covered};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use field::{
    EdgeForce, ForceField, Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{Body, Sampling, Simulation, Snake, Stepping, Until, World};
use std::ops::ControlFlow;
use std::sync::Arc;

const ID: &str = "sec-4-2-rotation";
const SIZE: usize = 128;
const MIDDLE: DVec2 = DVec2::splat(63.5);
const RADIUS: f64 = 40.0;
/// Half the length of edge that is looked at, and how far to both sides, in pixels.
const ALONG: usize = 16;
const ACROSS: usize = 12;
const NAMES: [&str; 2] = ["report", "corrected"];

/// The report's force and the corrected one, on a turned edge and on a disc.
pub(crate) const ROTATION: Experiment = Experiment {
    id: ID,
    title: "A turned edge",
    place: "§4.2.2",
    question: "The same straight edge at angles from 0° to 90°, and a circle fitted to a disc: does the force stay as \
               strong, does it point across the edge, and does the circle stay round?",
    claims: &[
        Claim {
            says: "turned by 45°, the report's force has another strength; the corrected one keeps its own",
            source: "D38, D39",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("report: strength; largest over least", 1.2),
                        below("corrected: strength; largest over least", 1.06),
                    ],
                )
            },
        },
        Claim {
            says: "the report's force pulls askew; the corrected one across the edge",
            source: "D39",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("report: direction; largest error", 10.0),
                        below("corrected: direction; largest error", 2.0),
                    ],
                )
            },
        },
        Claim {
            says: "at 0° and 90° both are the same force",
            source: "theory §11.2",
            judge: |r| {
                let worst = ["0°", "90°"]
                    .into_iter()
                    .map(|angle| {
                        let a = r.number(&format!("report: strength at {angle}"))?;
                        let b = r.number(&format!("corrected: strength at {angle}"))?;
                        Ok((a / b - 1.0).abs())
                    })
                    .collect::<Result<Vec<f64>, SandboxError>>()?
                    .into_iter()
                    .fold(0.0, f64::max);
                Ok(Finding::new(
                    worst < 0.01,
                    format!("{:.2} % apart", 100.0 * worst),
                ))
            },
        },
        Claim {
            says: "a circle in the corrected field comes to rest as a circle, too small by σ²/2R as theory has it",
            source: "theory §11.3",
            judge: |r| {
                let (mean, spread) = (
                    r.number("corrected: circle; mean of radius − R")?,
                    r.number("corrected: circle; largest less least radius")?,
                );
                let theory = r.number("theory: −σ²/2R")?;
                Ok(Finding::new(
                    (mean - theory).abs() < 0.02 && spread < 0.03,
                    format!("{mean:.3} px against {theory:.3} px, round to {spread:.3} px"),
                ))
            },
        },
        Claim {
            says: "in the report's field it does not stay round, and its nodes bunch",
            source: "D38, D39",
            judge: |r| {
                let (report, corrected) = (
                    r.number("report: circle; largest less least radius")?,
                    r.number("corrected: circle; largest less least radius")?,
                );
                let (bunched, even) = (
                    r.number("report: circle; widest over narrowest gap")?,
                    r.number("corrected: circle; widest over narrowest gap")?,
                );
                Ok(Finding::new(
                    report > 5.0 * corrected && bunched > 1.2 && even < 1.05,
                    format!(
                        "radius varies by {report:.3} px against {corrected:.3} px; gaps by {bunched:.2} against {even:.3}"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

fn fields(image: &Grid) -> Result<[ForceField; 2], SandboxError> {
    Ok([
        report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)
            .map_err(SandboxError::refused(ID))?,
        edge_force(image, &EdgeForce::as_strong_as_the_report())
            .map_err(SandboxError::refused(ID))?,
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
    let strength = peaks.iter().sum::<f64>() / real(peaks.len());
    let askew = seen
        .iter()
        .filter(|(size, _)| *size >= 0.5 * strength)
        .map(|(_, to)| to.angle_to(normal).abs().to_degrees())
        .fold(0.0, f64::max);
    Looked { strength, askew }
}

/// Where a circle of 120 nodes, 3 px too large, ends on the disc. Its tension keeps nodes apart, and is too weak to
/// make it smaller by more than 0.002 px.
fn settle(field: ForceField) -> Result<Vec<DVec2>, SandboxError> {
    let start = elastic::circle(MIDDLE, RADIUS + 3.0, 120);
    let body = Body::of(&start, elastic::Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
        .with_damping(1.0)
        .with_material(elastic::Material::uniform(0.0, 10.0, 0.0));
    let world = World::default().with_image(Arc::new(field), Sampling::Bilinear);
    let snake = Snake::new(body, world).map_err(SandboxError::refused(ID))?;
    let stepping = Stepping::of(Scheme::GradientFlow, 0.04);
    let begun = Simulation::of(snake, State::at_rest(start), stepping);
    let mut simulation = begun.map_err(SandboxError::refused(ID))?;
    let end = simulation.run(&Until::steps(4000), &mut |_| ControlFlow::Continue(()));
    end.map_err(SandboxError::refused(ID))?;
    Ok(simulation.members()[0].state().x.clone())
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=90).step_by(3).map(real).collect();
    let mut looked: [Vec<Looked>; 2] = [Vec::new(), Vec::new()];
    for &degree in &degrees {
        let normal = DVec2::from_angle(degree.to_radians());
        for (field, into) in fields(&edge(normal))?.iter().zip(&mut looked) {
            into.push(look(field, normal));
        }
    }
    let mut table = Table::new("turned").with("angle", "°", Tolerance::EXACT, degrees);
    for (name, seen) in NAMES.into_iter().zip(&looked) {
        let strength: Vec<f64> = seen.iter().map(|one| one.strength).collect();
        let askew: Vec<f64> = seen.iter().map(|one| one.askew).collect();
        let least = strength.iter().copied().fold(f64::INFINITY, f64::min);
        let most = strength.iter().copied().fold(0.0, f64::max);
        let close = Tolerance::Absolute(1e-6);
        for (angle, value) in [("0°", strength[0]), ("90°", strength[strength.len() - 1])] {
            record.note(
                format!("{name}: strength at {angle}"),
                value,
                "M px/T²",
                close,
            );
        }
        record.note(
            format!("{name}: strength; largest over least"),
            most / least,
            "",
            close,
        );
        record.note(
            format!("{name}: direction; largest error"),
            askew.iter().copied().fold(0.0, f64::max),
            "°",
            close,
        );
        table = table
            .with(format!("{name}: strength"), "M px/T²", close, strength)
            .with(format!("{name}: askew"), "°", close, askew);
    }
    record.keep(table);

    let disc = covered((SIZE, SIZE), |p| p.distance(MIDDLE) < RADIUS);
    let place = Tolerance::Absolute(1e-4);
    for (name, field) in NAMES.into_iter().zip(fields(&disc)?) {
        let nodes = settle(field)?;
        let polar: Vec<(f64, f64)> = nodes
            .iter()
            .map(|&p| p - MIDDLE)
            .map(|p| {
                (
                    p.to_angle().to_degrees().rem_euclid(360.0),
                    p.length() - RADIUS,
                )
            })
            .collect();
        let gaps: Vec<f64> = (0..nodes.len())
            .map(|i| nodes[i].distance(nodes[(i + 1) % nodes.len()]))
            .collect();
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
        let radius = || polar.iter().map(|p| p.1);
        record.note(
            format!("{name}: circle; mean of radius − R"),
            radius().sum::<f64>() / real(polar.len()),
            "px",
            place,
        );
        record.note(
            format!("{name}: circle; largest less least radius"),
            most(&mut radius()) - least(&mut radius()),
            "px",
            place,
        );
        record.note(
            format!("{name}: circle; widest over narrowest gap"),
            most(&mut gaps.iter().copied()) / least(&mut gaps.iter().copied()),
            "",
            Tolerance::Absolute(1e-3),
        );
        record.keep(
            Table::raw(if name == "report" {
                "report-circle"
            } else {
                "corrected-circle"
            })
            .with("angle", "°", place, polar.iter().map(|p| p.0).collect())
            .with(
                "radius − R",
                "px",
                place,
                polar.iter().map(|p| p.1).collect(),
            ),
        );
    }
    // the binomial passes, and the two derivatives that average over two pixels each
    let sigma_squared = f64::from(REPORT_PASSES) / 2.0 + 2.0 / 3.0;
    record.note(
        "theory: −σ²/2R",
        -sigma_squared / (2.0 * RADIUS),
        "px",
        Tolerance::ROUNDING,
    );
    record.note("contrast", OBJECT - AROUND, "grey levels", Tolerance::EXACT);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let angle = || Axis::new("angle of the edge's normal / °", 0.0, 90.0).with_ticks(7);
    let colors = [Color::RED, Color::BLUE];
    let mut strength = Panel::new(
        "how strong: largest force beside the edge",
        angle(),
        Axis::new("force / (M px/T²)", 0.0, 30.0),
    )
    .legend_at(Corner::BottomLeft);
    let mut askew = Panel::new(
        "how askew: largest angle between force and normal",
        angle(),
        Axis::new("angle / °", 0.0, 40.0),
    )
    .legend_at(Corner::TopLeft);
    for (name, color) in NAMES.into_iter().zip(colors) {
        let line = |column: &str| -> Result<Line, SandboxError> {
            let points = record.points("turned", "angle", &format!("{name}: {column}"))?;
            Ok(Line::new(points, color).named(name))
        };
        strength = strength.with(line("strength")?);
        askew = askew.with(line("askew")?);
    }
    let theory = record.number("theory: −σ²/2R")?;
    let mut circle = Panel::new(
        "where a circle ends on a disc of R = 40 px, by the direction from its middle",
        Axis::new("direction from the middle / °", 0.0, 360.0).with_ticks(9),
        Axis::new("radius − R / px", -0.25, 0.1).with_ticks(8),
    )
    .with(
        Line::new(vec![(0.0, theory), (360.0, theory)], Color::GREEN)
            .dashed()
            .named("theory: −σ²/2R"),
    );
    for (name, color) in NAMES.into_iter().zip(colors) {
        let points = record.points(&format!("{name}-circle"), "angle", "radius − R")?;
        circle = circle.with(Layer::Dots {
            points,
            radius: 1.3,
            color,
            label: name.to_owned(),
        });
    }
    let figure = Figure::new(
        "§4.2.2  One edge at many angles, 20 passes, contrast 140",
        860.0,
    )
    .with(290.0, vec![strength, askew])
    .with(300.0, vec![circle]);
    Ok(vec![Artefact::figure(
        "Above: the strength of the force at a straight edge, and how far it points from the normal. Below: where the \
         nodes of a circle come to rest on a disc; the nodes of the report's force slide along the edge and bunch.",
        figure,
    )])
}
