//! Report §5.3: four estimates of curvature, and elastic forces that know the spacing of their nodes.

use crate::prelude::*;
use elastic::spacing_study;

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
    id: "sec-5-3-curvature",
    title: "Curvature, and nodes that are not even",
    place: "§5.3",
    question: "How well do the four estimates of curvature do on a circle, an ellipse and a spiral, with nodes that are even, \
               uneven, rough or noisy? And what does the elastic force gain by knowing its spacing?",
    claims: &[
        claim("on even nodes all four estimates are of second order, on every curve [report §5.3]")
            .judged(|r| all(r, &ESTIMATES, "even", |order| (order - 2.0).abs() < 0.1)),
        claim("on nodes whose spacing changes slowly the plain difference never converges, the other \
               three do [report §5.3]")
            .judged(|r| {
                let plain = orders_of(r, &["difference"], "smooth")?.1;
                let others = orders_of(r, &ESTIMATES[1..], "smooth")?.0;
                let words = format!("order {plain:.2} at best of the difference, {others:.2} or better of the others");
                Ok(Finding::new(plain < 0.1 && others > 1.9, words))
            }),
        claim("on rough nodes the difference gets worse with more of them, the others stay of first \
               order at least [report §5.3]")
            .judged(|r| {
                let plain = orders_of(r, &["difference"], "rough")?.1;
                let others = orders_of(r, &ESTIMATES[1..], "rough")?.0;
                let words = format!("orders {plain:.2}, and {others:.2} or better");
                Ok(Finding::new(plain < -0.8 && others > 0.85, words))
            }),
        claim("noise spoils all of them alike: more nodes make it worse by the square [the second difference]")
            .judged(|r| all(r, &ESTIMATES, "noisy", |order| (order + 2.0).abs() < 0.4)),
        claim("a force that knows its spacing converges where one with a single spacing does not \
               [report §5.3, D77]")
            .judged(|r| {
                let one = orders_of(r, &[FORCES[0], FORCES[2]], "smooth")?.1;
                let own = orders_of(r, &[FORCES[1], FORCES[3]], "smooth")?.0;
                let words = format!("order {one:.2} with one spacing, {own:.2} or better with their own");
                Ok(Finding::new(one < 0.1 && own > 1.9, words))
            }),
    ],
    run,
    draw,
};

fn column(quantity: &str, nodes: &str, curve: &str) -> String {
    format!("{} on {nodes} {curve}", quantity.replace(", ", " with "))
}

/// The order of each at 128 nodes, over the curves, but where it is exact to rounding and has none.
fn orders(r: &Record, what: &[&str], nodes: &str) -> Result<Vec<f64>> {
    let mut out = Vec::new();
    for name in what
        .iter()
        .flat_map(|what| CURVES.map(|curve| column(what, nodes, curve)))
    {
        let error = format!("error: {name}");
        if r.told(&error)? > 1e-11 {
            out.push(r.number(&format!("order: {name}"))?);
        } else {
            r.number(&error)?;
        }
    }
    Ok(out)
}

/// The lowest and the highest order.
fn orders_of(r: &Record, what: &[&str], nodes: &str) -> Result<(f64, f64)> {
    let found = orders(r, what, nodes)?;
    Ok((least(found.iter().copied()), most(found)))
}

fn all(r: &Record, what: &[&str], nodes: &str, fits: fn(f64) -> bool) -> Result<Finding> {
    let (low, high) = orders_of(r, what, nodes)?;
    let words = format!("orders from {low:.2} to {high:.2}; on the even circle two are exact");
    Ok(Finding::new(
        orders(r, what, nodes)?.into_iter().all(fits),
        words,
    ))
}

fn run() -> Result {
    let mut record = Record::default();
    let counts = [16, 32, 64, 128, 256, 512];
    let studies = counts.map(spacing_study);
    let of = |study: usize, quantity: &str, nodes: &str, curve: &str| {
        let mut found = studies[study].iter();
        found.find(|f| f.quantity == quantity && f.nodes == nodes && f.curve == curve)
    };
    let mut table = Table::raw("errors").exact("n", counts.map(real));
    for quantity in ESTIMATES.iter().chain(&FORCES) {
        for nodes in NODES {
            for curve in CURVES {
                let Some(found) = of(3, quantity, nodes, curve) else {
                    continue;
                };
                let name = column(quantity, nodes, curve);
                let exact = found.error < 1e-11;
                let order = if exact { 0.0 } else { found.order };
                record.note(format!("order: {name}"), order, 2e-4);
                let close = if exact { ROUNDING.into() } else { share(1e-4) };
                record.note(format!("error: {name} [of the exact]"), found.error, close);
            }
            let error = |k| of(k, quantity, nodes, "ellipse").map_or(f64::NAN, |f| f.error);
            let name = column(quantity, nodes, "ellipse");
            table = table.exact(name, (0..counts.len()).map(error));
        }
    }
    // what each costs at a node, counted in its formula: square roots and arc tangents
    for (name, roots, arcs) in [
        ("difference", 1.0, 0.0),
        ("formula", 3.0, 0.0),
        ("turn", 2.0, 1.0),
        ("direction", 2.0, 0.0),
    ] {
        record.note(format!("square roots a node: {name}"), roots, EXACT);
        record.note(format!("arc tangents a node: {name}"), arcs, EXACT);
    }
    record.keep(table);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let title = "§5.3  Errors on an ellipse of axes 3 : 2, over the number of nodes";
    let mut figure = Figure::new(title, 1100.0);
    for (what, lowest, highest, label) in [
        (ESTIMATES, 1e-6, 1e2, "error of the curvature"),
        (FORCES, 1e-5, 1e5, "error of the force"),
    ] {
        let mut panels = Vec::new();
        for (k, nodes) in NODES.into_iter().enumerate() {
            // the first panel of a row tells for all
            let told = |words: &'static str| if k == 0 { words } else { "" };
            let error = Axis::log(told(label), lowest, highest);
            let mut panel = plot(format!("{nodes} nodes"), Axis::log("n", 14.0, 600.0), error)
                .legend_at(Corner::TopLeft);
            for (quantity, color) in what.into_iter().zip(Color::SERIES) {
                let points = record.points("errors", "n", &column(quantity, nodes, "ellipse"))?;
                let errors = line(points, color).weighing(1.1).named(told(quantity));
                let own = quantity.ends_with("its own");
                panel = panel.with(if own { errors.dashed() } else { errors });
            }
            panels.push(panel);
        }
        figure = figure.with(300.0, panels);
    }
    Artefact::only(
        "Relative errors, root mean square. Smooth: edges that differ by up to 3 and change slowly. Rough: 0.7 and 1.3 of the mean by \
         turns. Noisy: displaced at random by up to 1e-5 of a radius. One spacing for all converges on even nodes alone.",
        figure,
    )
}
