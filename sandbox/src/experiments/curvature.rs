//! Report §5.3: four estimates of curvature, and elastic forces that know the spacing of their nodes.

use crate::draw::{Axis, Color, Corner, Figure, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::spacing_study;

const ID: &str = "sec-5-3-curvature";
const NODES: [&str; 4] = ["even", "smooth", "rough", "noisy"];
const ESTIMATES: [&str; 4] = ["difference", "formula", "turn", "direction"];
const FORCES: [&str; 4] = [
    "tension, one spacing",
    "tension, its own",
    "rigidity, one spacing",
    "rigidity, its own",
];
const CURVES: [&str; 3] = ["circle", "ellipse", "spiral"];

/// Errors and orders of everything that estimates bending.
pub(crate) const CURVATURE: Experiment = Experiment {
    id: ID,
    title: "Curvature, and nodes that are not even",
    place: "§5.3",
    question: "How well do the four estimates of curvature do on a circle, an ellipse and a spiral, with nodes that are even, \
               uneven, rough or noisy? And what does the elastic force gain by knowing its spacing?",
    claims: &[
        Claim {
            says: "on even nodes all four estimates are of second order, on every curve",
            source: "report §5.3",
            judge: |r| all(r, &ESTIMATES, "even", |order| (order - 2.0).abs() < 0.1),
        },
        Claim {
            says: "on nodes whose spacing changes slowly the plain difference never converges, the other three do",
            source: "report §5.3",
            judge: |r| {
                let plain = range(r, &["difference"], "smooth")?.1;
                let others = range(r, &ESTIMATES[1..], "smooth")?.0;
                Ok(Finding::new(
                    plain < 0.1 && others > 1.9,
                    format!(
                        "order {plain:.2} at best of the difference, {others:.2} or better of the others"
                    ),
                ))
            },
        },
        Claim {
            says: "on rough nodes the difference gets worse with more of them, the others stay of first order at least",
            source: "report §5.3",
            judge: |r| {
                let plain = range(r, &["difference"], "rough")?.1;
                let others = range(r, &ESTIMATES[1..], "rough")?.0;
                Ok(Finding::new(
                    plain < -0.8 && others > 0.85,
                    format!("orders {plain:.2}, and {others:.2} or better"),
                ))
            },
        },
        Claim {
            says: "noise spoils all of them alike: more nodes make it worse by the square",
            source: "the second difference",
            judge: |r| all(r, &ESTIMATES, "noisy", |order| (order + 2.0).abs() < 0.4),
        },
        Claim {
            says: "a force that knows its spacing converges where one with a single spacing does not",
            source: "report §5.3, D77",
            judge: |r| {
                let one = range(r, &[FORCES[0], FORCES[2]], "smooth")?.1;
                let own = range(r, &[FORCES[1], FORCES[3]], "smooth")?.0;
                Ok(Finding::new(
                    one < 0.1 && own > 1.9,
                    format!("order {one:.2} with one spacing, {own:.2} or better with their own"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn column(quantity: &str, nodes: &str, curve: &str) -> String {
    format!("{} on {nodes} {curve}", quantity.replace(", ", " with "))
}

/// The order of each at 128 nodes, over the curves; None where it is exact to rounding and has none.
fn orders(r: &Record, what: &[&str], nodes: &str) -> Result<Vec<Option<f64>>, SandboxError> {
    let mut out = Vec::new();
    for quantity in what {
        for curve in CURVES {
            let name = column(quantity, nodes, curve);
            let error = format!("error: {name}");
            out.push(if r.told(&error)? > 1e-11 {
                Some(r.number(&format!("order: {name}"))?)
            } else {
                r.number(&error)?;
                None
            });
        }
    }
    Ok(out)
}

/// The lowest and the highest order.
fn range(r: &Record, what: &[&str], nodes: &str) -> Result<(f64, f64), SandboxError> {
    let found = orders(r, what, nodes)?;
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    Ok(found
        .into_iter()
        .flatten()
        .fold(ends, |(low, high), order| (low.min(order), high.max(order))))
}

fn all(
    r: &Record,
    what: &[&str],
    nodes: &str,
    fits: fn(f64) -> bool,
) -> Result<Finding, SandboxError> {
    let (low, high) = range(r, what, nodes)?;
    Ok(Finding::new(
        orders(r, what, nodes)?.into_iter().flatten().all(fits),
        format!("orders from {low:.2} to {high:.2}; on the even circle two are exact"),
    ))
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let counts = [16, 32, 64, 128, 256, 512];
    let studies: Vec<_> = counts.iter().map(|&n| spacing_study(n)).collect();
    let of = |study: usize, quantity: &str, nodes: &str, curve: &str| {
        let found = studies[study].iter();
        let mut found =
            found.filter(|f| f.quantity == quantity && f.nodes == nodes && f.curve == curve);
        found.next().copied()
    };
    for quantity in ESTIMATES.iter().chain(&FORCES) {
        for nodes in NODES {
            for curve in CURVES {
                let Some(found) = of(3, quantity, nodes, curve) else {
                    continue;
                };
                let name = column(quantity, nodes, curve);
                let exact = found.error < 1e-11;
                let order = if exact { 0.0 } else { found.order };
                record.note(
                    format!("order: {name}"),
                    order,
                    "",
                    Tolerance::Absolute(2e-4),
                );
                let close = if exact {
                    Tolerance::ROUNDING
                } else {
                    Tolerance::Relative(1e-4)
                };
                record.note(format!("error: {name}"), found.error, "of the exact", close);
            }
        }
    }
    // what each costs at a node, counted in its formula: square roots and arc tangents
    for (name, roots, arcs) in [
        ("difference", 1.0, 0.0),
        ("formula", 3.0, 0.0),
        ("turn", 2.0, 1.0),
        ("direction", 2.0, 0.0),
    ] {
        record.note(
            format!("square roots a node: {name}"),
            roots,
            "",
            Tolerance::EXACT,
        );
        record.note(
            format!("arc tangents a node: {name}"),
            arcs,
            "",
            Tolerance::EXACT,
        );
    }
    let n = counts.iter().map(|&n| real(n)).collect();
    let mut table = Table::raw("errors").with("n", "", Tolerance::EXACT, n);
    for quantity in ESTIMATES.iter().chain(&FORCES) {
        for nodes in NODES {
            let values = (0..counts.len())
                .map(|k| of(k, quantity, nodes, "ellipse").map_or(f64::NAN, |f| f.error))
                .collect();
            table = table.with(
                column(quantity, nodes, "ellipse"),
                "",
                Tolerance::EXACT,
                values,
            );
        }
    }
    record.keep(table);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new(
        "§5.3  Errors on an ellipse of axes 3 : 2, over the number of nodes",
        1100.0,
    );
    let rows: [(&[&str], f64, &str); 2] = [
        (&ESTIMATES, 1e-6, "error of the curvature"),
        (&FORCES, 1e-5, "error of the force"),
    ];
    for (what, least, label) in rows {
        let mut panels = Vec::new();
        for (k, nodes) in NODES.into_iter().enumerate() {
            let mut panel = Panel::new(
                format!("{nodes} nodes"),
                Axis::log("n", 14.0, 600.0),
                Axis::log(
                    if k == 0 { label } else { "" },
                    least,
                    if least > 5e-6 { 1e5 } else { 1e2 },
                ),
            )
            .legend_at(Corner::TopLeft);
            for (quantity, color) in what.iter().zip(Color::SERIES) {
                let points = record.points("errors", "n", &column(quantity, nodes, "ellipse"))?;
                let mut line = Line::new(points, color).weighing(1.1);
                if quantity.ends_with("its own") {
                    line = line.dashed();
                }
                panel = panel.with(if k == 0 { line.named(*quantity) } else { line });
            }
            panels.push(panel);
        }
        figure = figure.with(300.0, panels);
    }
    Ok(vec![Artefact::figure(
        "Relative errors, root mean square. Smooth: edges that differ by up to 3 and change slowly. Rough: 0.7 and 1.3 of the mean by \
         turns. Noisy: displaced at random by up to 1e-5 of a radius. One spacing for all converges on even nodes alone.",
        figure,
    )])
}
