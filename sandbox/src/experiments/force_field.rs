//! Figure 4.5: the force field of a photograph, as arrows and as colors (report §4.2.2).

use crate::prelude::*;
use elastic::normals;
use field::{
    EdgeForce, ForceField, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};

/// The part of the picture that is looked at closely: left, top, columns, rows.
const CLOSE: [usize; 4] = [330, 35, 110, 110];

/// Figure 4.5: the input image and its force field.
pub(crate) const FIELD: Experiment = Experiment {
    id: "fig-4-5",
    title: "The force field of the apple",
    place: "Figure 4.5",
    question: "Does the force made from a photograph point to the contour of the apple from both sides, and leave \
               alone what is far from any edge? (The report's own picture is not to be had; another apple stands \
               in. Its contour was drawn by hand.)",
    claims: &[
        claim("the forces point to the contour from inside and from outside [report §4.2.2]").when(&[
            above("report: pulled outward 4 px inside", 0.7),
            above("report: pulled inward 4 px outside", 0.7),
        ]),
        claim("the force vanishes on the contour, within the care it was drawn with [report §4.2.2]")
            .when(&[below("corrected: median distance of the zero from the contour", 2.0)]),
        claim("far from it the force is weak; not nothing, as cloth and skin have edges [report §4.2.1]")
            .when(&[below(
                "report: median far from the contour; share of that at 4 px",
                1.0 / 3.0,
            )]),
        claim("the corrected field does the same [D38, D39]").when(&[
            above("corrected: pulled outward 4 px inside", 0.7),
            above("corrected: pulled inward 4 px outside", 0.7),
        ]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let picture = scene::picture("apple")?;
    let contour = scene::contour("apple-truth")?.first().to_vec();
    let image = picture.levels();
    let report = report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)?;
    let corrected = edge_force(image, &EdgeForce::as_strong_as_the_report())?;
    // the hand contour may run either way; outward is what makes the area positive
    let sign = elastic::signed_area(&contour).signum();
    let outward: Vec<DVec2> = normals(&contour, true)
        .into_iter()
        .map(|n| n * sign)
        .collect();
    let mut record = Record::default();
    for (name, field) in [("report", &report), ("corrected", &corrected)] {
        measure(&mut record, name, field, &contour, &outward);
        let (fx, fy) = field.components();
        record.keep_grid(format!("{name} x"), fx);
        record.keep_grid(format!("{name} y"), fy);
    }
    record.keep_grid("image", image.clone());
    record.keep_points("contour", &contour);
    Ok(record)
}

fn measure(
    record: &mut Record,
    name: &str,
    field: &ForceField,
    contour: &[DVec2],
    outward: &[DVec2],
) {
    let all = 0..contour.len();
    let along = |i: usize, distance: f64| {
        let at = contour[i] + outward[i] * distance;
        field.at(at).dot(outward[i])
    };
    // one point of 400 may go over to the other side
    let few = 0.003;
    let inside = mean(all.clone().map(|i| flag(along(i, -4.0) > 0.0)));
    let mut own = record.under(name);
    own.note("pulled outward 4 px inside", inside, few);
    let outside = mean(all.clone().map(|i| flag(along(i, 4.0) < 0.0)));
    own.note("pulled inward 4 px outside", outside, few);
    // the nearest place where the pull turns from outward to inward
    let zero = |i: usize| {
        let places = (0..160).map(|step| -8.0 + 0.1 * real(step));
        let turns = places.filter(|&d| along(i, d) > 0.0 && along(i, d + 0.1) <= 0.0);
        turns.map(|d| (d + 0.05).abs()).fold(8.0, f64::min)
    };
    let zero = median(all.clone().map(zero));
    own.note(
        "median distance of the zero from the contour [px]",
        zero,
        0.11,
    );
    let near = median(all.map(|i| along(i, -4.0).abs()));
    let rows = (0..field.height()).step_by(4);
    let places = rows.flat_map(|row| {
        (0..field.width())
            .step_by(4)
            .map(move |c| (real(c), real(row)))
    });
    let far = places
        .map(DVec2::from)
        .filter(|at| contour.iter().all(|p| p.distance(*at) > 25.0));
    let weak = median(far.map(|at| field.at(at).length())) / near;
    own.note(
        "median far from the contour; share of that at 4 px",
        weak,
        1e-6,
    );
    own.note("largest force [M px/T²]", field.largest(), share(1e-9));
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn draw(record: &Record) -> Drawn {
    let image = record.grid("image")?;
    let (rows, columns) = image.dim();
    let below = |rows: usize, columns: usize| [-0.5, -0.5, real(columns) - 0.5, real(rows) - 0.5];
    let (whole, thirds) = (below(rows, columns), below(rows / 3 * 3, columns / 3 * 3));
    let small = grey(&shrunk(image, 2));
    let contour = line(record.xy("contour")?, Color::GREEN)
        .closed()
        .weighing(0.8);
    let panel = |title: &str| Panel::pixels(title, columns, rows);
    let (fx, fy) = (record.grid("report x")?, record.grid("report y")?);
    let [left, top, width, height] = CLOSE;
    let window = ndarray::s![top..top + height, left..left + width];
    let cut = grey(&image.slice(window).to_owned());
    let close = |title: &str, name: &str| -> Result<Panel> {
        let extent = [left, top, left + width, top + height].map(|edge| real(edge) - 0.5);
        let (x, y) = (
            ("x / px", extent[0], extent[2]),
            ("y / px", extent[3], extent[1]),
        );
        let mut panel = plot(title, x, y).equal();
        panel.grid = false;
        let fx = record.grid(&format!("{name} x"))?;
        let fy = record.grid(&format!("{name} y"))?;
        Ok(panel
            .with(Picture::new(cut.clone()).over(extent).faded(0.45))
            .with(contour.clone())
            .with(arrows(fx, fy, 5, 0.02, CLOSE)))
    };
    let above = vec![
        panel("a) the input image").with(Picture::new(small.clone()).over(whole)),
        panel("b) the force field as arrows")
            .with(Picture::new(small).over(whole).faded(0.35))
            .with(strongest_arrows(fx, fy, 16, 0.18)),
    ];
    let component = |title: &str, grid| {
        panel(title).with(Picture::new(signed(&shrunk(grid, 3), 0.995)).over(thirds))
    };
    let below = vec![
        component("x-force: blue to the left, orange to the right", fx),
        component("y-force: blue up, orange down", fy),
    ];
    let figure = Figure::new("Figure 4.5  a) The input image; b) the force field", 860.0)
        .with(410.0, above)
        .with(410.0, below);
    let both = vec![
        close("the report's field, axis by axis", "report")?,
        close("corrected: the gradient of one scalar", "corrected")?,
    ];
    let nearer = Figure::new("Figure 4.5  A closer look at the upper right flank", 860.0);
    Ok(vec![
        Artefact::figure(
            "a) The input image. b) The force field as arrows, as long as the root of the force, one where it is strongest in each 16 px. Below: its two \
             components as colors.",
            figure,
        ),
        Artefact::further(
            "close",
            "Arrows every 5 px with the contour drawn by hand: the report's field, and the corrected one.",
            nearer.with(430.0, both),
        ),
    ])
}
