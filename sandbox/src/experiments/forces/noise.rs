//! Noise against place: how exactly an edge can be found, and what a picture tells of its own noise.

use super::synthetic::{AROUND, OBJECT, blurred, covered, noisy, rounded};
use crate::prelude::*;
use field::{
    Canny, EdgeForce, ForceField, Grid, REPORT_PASSES, Smoothing, edge_force, edge_points,
    image_scale,
};
use std::f64::consts::PI;

const SIZE: usize = 80;
const MIDDLE: DVec2 = DVec2::new(39.5, 39.5);
/// The edge's normal, degrees.
const ANGLE: f64 = 30.0;
/// Half the length of edge that is looked at.
const HALF: usize = 18;
/// Pictures for each point of a curve.
const PICTURES: u64 = 12;
const CONTRAST: f64 = OBJECT - AROUND;
/// Contrast over noise.
const RATIOS: [f64; 6] = [2.0, 3.0, 5.0, 10.0, 20.0, 50.0];
/// The Gaussians that edge points are found with, in pixels.
const SIGMAS: [(f64, &str); 3] = [(1.0, "σ = 1"), (2.3, "σ = 2.3"), (5.0, "σ = 5")];
/// Those of the second panel, and its contrast over noise.
const WIDTHS: [f64; 9] = [0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0];
const RATIO: f64 = 10.0;
const RADIUS: f64 = 25.0;
/// Noise put into the pictures that are asked for it, grey levels.
const NOISES: [f64; 7] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0];

/// Noise against localisation.
pub(crate) const NOISE: Experiment = Experiment {
    id: "sec-4-2-noise",
    title: "Noise and the place of an edge",
    place: "§4.2",
    question: "A straight edge at 30°, blurred by one pixel, under white noise: how far off are edge points and the \
               zero of the edge force, against the least that any method can be off? What does smoothing buy, and \
               what does it cost on a curve? And does a picture tell its own noise, contrast and blur?",
    claims: &[
        claim("edge points are as exact as theory has it, for σ = 2.3 px and contrast of 5 noises or \
               more [[canny86]]")
            .judged(|r| {
                let worst = apart(r, "σ = 2.3", 2.3)?;
                Ok(Finding::new(worst < 0.15, format!("{:.0} % apart at most", 100.0 * worst)))
            }),
        claim("that is within 1.4 times the Cramér–Rao bound of the length of edge a point looks at [theory]")
            .judged(|r| {
                let points = r.points("ratios", "ratio", "σ = 2.3")?;
                let clear = points.into_iter().filter(|p| p.0 >= 5.0);
                let worst = most(clear.map(|(ratio, found)| found / bound(ratio, seen(2.3))));
                Ok(Finding::new(worst < 1.4, format!("{worst:.2} times at most")))
            }),
        claim("narrow smoothing wastes what the picture knows: σ = 1 px is 1.5 times as far off [theory]")
            .when(&[more("σ = 1: error at ratio 10", 1.5, "σ = 2.3: error at ratio 10")]),
        claim("and below a contrast of ten noises it takes noise for edges [[canny86]]").judged(|r| {
            let points = r.points("ratios", "ratio", "σ = 1")?;
            let over = |row: usize| points[row].1 / point_error(1.0, points[row].0);
            let (low, high) = (over(0), over(3));
            Ok(Finding::new(
                low > 2.0 && high < 1.25,
                format!(
                    "off by {low:.1} times what theory has for a point of the edge at contrast 2, \
                     {high:.2} times at 10"
                ),
            ))
        }),
        claim("the zero of the edge force is as exact as an edge point at the same width [theory]")
            .judged(|r| {
                let worst = apart(r, "zero of the force", force_sigma())?;
                let (percent, sigma) = (100.0 * worst, force_sigma());
                let words = format!("{percent:.0} % from the theory of σ = {sigma:.2} px at most");
                Ok(Finding::new(worst < 0.25, words))
            }),
        claim("on a straight edge wider is better, on a curve it is not: the bias σ²/2R takes over \
               [theory §11.3]")
            .judged(|r| {
                let straight = r.column("widths", "straight")?;
                let disc = r.column("widths", "disc")?;
                let least = least(disc.iter().copied());
                let best = disc.iter().position(|&v| v <= least).unwrap_or(0);
                let (last, wide) = (straight[straight.len() - 1], disc[disc.len() - 1]);
                let words = format!(
                    "disc of radius 25 px: {least:.3} px at σ = {}, {wide:.3} px at σ = 6; \
                     straight {last:.3} px",
                    WIDTHS[best]
                );
                Ok(Finding::new(last < 1.1 * straight[best] && wide > 2.0 * least, words))
            }),
        claim("a picture tells its noise within 6 %, contrast and blur within 4 % up to a noise of 20 \
               grey levels; at 40, where 8 bits clip, within 8 % [[immerkaer96]]")
            .judged(|r| {
                let mut worst = [[0.0_f64; 3]; 2];
                let noises = r.points("estimates", "noise", "noise found")?;
                let contrasts = r.column("estimates", "contrast found")?;
                let others = contrasts.iter().zip(r.column("estimates", "blur found")?);
                for ((truth, found), (contrast, blur)) in noises.into_iter().zip(others) {
                    let off = [found / truth, contrast / CONTRAST, blur / blur_of_all()];
                    let of = &mut worst[usize::from(truth > 20.0)];
                    for (worst, off) in of.iter_mut().zip(off) {
                        *worst = worst.max(100.0 * (off - 1.0).abs());
                    }
                }
                let [[noise, contrast, blur], clipped] = worst;
                let fine = noise < 6.0 && contrast < 4.0 && blur < 4.0;
                Ok(Finding::new(
                    fine && clipped.iter().all(|&off| off < 8.0),
                    format!(
                        "{noise:.1} %, {contrast:.1} %, {blur:.1} % off at most; at 40: {clipped:.1?} %"
                    ),
                ))
            }),
    ],
    run,
    draw,
};

/// How far errors are from theory at most, from a contrast of five noises on.
fn apart(r: &Record, column: &str, sigma: f64) -> Result<f64> {
    let points = r.points("ratios", "ratio", column)?;
    let clear = points.into_iter().filter(|p| p.0 >= 5.0);
    Ok(most(clear.map(|(ratio, found)| {
        (found / point_error(sigma, ratio) - 1.0).abs()
    })))
}

/// Blur of one pixel, and the pixel's own: a square of variance 1/12.
fn blur_of_all() -> f64 {
    (1.0 + 1.0 / 12.0_f64).sqrt()
}

/// The mean of |x| for a normal x of standard deviation 1.
fn mean_size() -> f64 {
    (2.0 / PI).sqrt()
}

/// The length of edge that a Gaussian averages white noise over.
fn seen(sigma: f64) -> f64 {
    2.0 * PI.sqrt() * sigma
}

/// Cramér and Rao's bound of the mean error of an edge's place, found from a length of it.
fn bound(ratio: f64, length: f64) -> f64 {
    mean_size() * (2.0 * PI.sqrt() * blur_of_all() / length).sqrt() / ratio
}

/// Mean error of one edge point in theory: variance `(3 √π/4) σ_t⁶/σ⁵ / L` over the length it sees.
fn point_error(sigma: f64, ratio: f64) -> f64 {
    let total = sigma * sigma + blur_of_all() * blur_of_all();
    let variance = 0.75 * PI.sqrt() * total.powi(3) / sigma.powi(5) / seen(sigma);
    mean_size() * variance.sqrt() / ratio
}

/// The passes, and the two derivatives that average over two pixels each.
fn force_sigma() -> f64 {
    (f64::from(REPORT_PASSES) / 2.0 + 2.0 / 3.0).sqrt()
}

fn normal() -> DVec2 {
    DVec2::from_angle(ANGLE.to_radians())
}

/// Mean distance of edge points from a line or circle, those of the looked-at part that are nearer than 4 px.
fn points_off(
    image: &Grid,
    sigma: f64,
    off: &dyn Fn(DVec2) -> Option<f64>,
) -> Result<(f64, usize)> {
    // a third of what the edge is in theory
    let total = sigma * sigma + blur_of_all() * blur_of_all();
    let strength = CONTRAST / (2.0 * PI * total).sqrt();
    let (high, low) = (0.5 * strength, 0.3 * strength);
    let found = edge_points(image, &Canny { sigma, high, low })?;
    let errors = found.iter().filter_map(|point| off(point.position));
    let errors: Vec<f64> = errors.map(f64::abs).filter(|&error| error < 4.0).collect();
    Ok((errors.iter().sum(), errors.len()))
}

/// The mean of errors over pictures, of each that gives a sum of errors and how many they are.
fn over_pictures(one: impl Fn(u64) -> Result<(f64, usize)>) -> Result<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for seed in 0..PICTURES {
        let (errors, own) = one(seed)?;
        (sum, count) = (sum + errors, count + own);
    }
    Ok(sum / real(count))
}

/// Mean distance of the places where a node coming from 3 px outside first meets no force.
fn zeros_off(field: &ForceField) -> (f64, usize) {
    let (across, along) = (normal(), normal().perp());
    let (mut sum, mut count) = (0.0, 0);
    for step in (0..=2 * HALF).step_by(3) {
        let foot = MIDDLE + along * (real(step) - real(HALF));
        let pull = |way: f64| field.at(foot + across * way).dot(across);
        let (mut way, fine) = (3.0, 0.05);
        while way > -4.0 && pull(way) < 0.0 {
            way -= fine;
        }
        let (inner, outer) = (pull(way), pull(way + fine));
        let zero = if inner > outer {
            way + fine * inner / (inner - outer)
        } else {
            way
        };
        sum += zero.abs();
        count += 1;
    }
    (sum, count)
}

fn straight_off(p: DVec2) -> Option<f64> {
    let away = p - MIDDLE;
    (away.dot(normal().perp()).abs() <= real(HALF)).then(|| away.dot(normal()))
}

fn disc_off(p: DVec2) -> Option<f64> {
    Some(p.distance(MIDDLE) - RADIUS)
}

fn run() -> Result {
    let mut record = Record::default();
    let edge = covered((SIZE, SIZE), |p| (p - MIDDLE).dot(normal()) < 0.0);
    let edge = blurred(&edge, 1.0)?;
    let disc = covered((SIZE, SIZE), |p| p.distance(MIDDLE) < RADIUS);
    let disc = blurred(&disc, 1.0)?;
    // sums of a thousand errors
    let close = share(1e-6);
    let rule = EdgeForce {
        smoothing: Smoothing::Binomial(REPORT_PASSES),
        gain: 1.0,
    };
    let over_ratios = |error: &dyn Fn(&Grid) -> Result<(f64, usize)>| -> Result<Vec<f64>> {
        let mean = |ratio| over_pictures(|seed| error(&noisy(&edge, CONTRAST / ratio, seed)));
        RATIOS.into_iter().map(mean).collect()
    };
    let mut columns = Vec::new();
    for (sigma, name) in SIGMAS {
        columns.push((
            name,
            over_ratios(&|image| points_off(image, sigma, &straight_off))?,
        ));
    }
    let zeros = over_ratios(&|image| Ok(zeros_off(&edge_force(image, &rule)?)))?;
    columns.push(("zero of the force", zeros));
    let mut table = Table::new("ratios").exact("ratio", RATIOS);
    for (name, column) in columns {
        record.note(format!("{name}: error at ratio 10 [px]"), column[3], close);
        table = table.with(format!("{name} [px]"), close, column);
    }
    record.note(
        "bound of one row of pixels at ratio 10 [px]",
        bound(10.0, 1.0),
        ROUNDING,
    );
    let name = "bound of the edge a point of σ = 2.3 sees; at ratio 10 [px]";
    record.note(name, bound(10.0, seen(2.3)), ROUNDING);
    record.keep(table);

    let mut table = Table::new("widths").exact("sigma [px]", WIDTHS);
    type Off = fn(DVec2) -> Option<f64>;
    let pictures: [(&str, &Grid, Off); 2] = [
        ("straight [px]", &edge, straight_off),
        ("disc [px]", &disc, disc_off),
    ];
    for (name, picture, off) in pictures {
        let image = |seed| noisy(picture, CONTRAST / RATIO, 100 + seed);
        let mean = |sigma| over_pictures(|seed| points_off(&image(seed), sigma, &off));
        let column = WIDTHS.into_iter().map(mean).collect::<Result<Vec<f64>>>()?;
        table = table.with(name, close, column);
    }
    record.keep(table);

    let scales = (200..)
        .zip(NOISES)
        .map(|(seed, noise)| image_scale(&rounded(&noisy(&disc, noise, seed))));
    let scales = scales.collect::<std::result::Result<Vec<_>, _>>()?;
    record.keep(
        Table::new("estimates")
            .exact("noise [grey levels]", NOISES)
            .with(
                "noise found [grey levels]",
                close,
                scales.iter().map(|scale| scale.noise),
            )
            .with(
                "contrast found [grey levels]",
                close,
                scales.iter().map(|scale| scale.contrast),
            )
            .with(
                "blur found [px]",
                close,
                scales.iter().map(|scale| scale.blur),
            ),
    );
    record.keep_grid("noisy", rounded(&noisy(&edge, CONTRAST / 5.0, 0)));
    record.keep_grid("noisier", rounded(&noisy(&edge, CONTRAST / 2.0, 0)));
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let theory = |of: &dyn Fn(f64) -> f64, from: f64, to: f64, color| -> Line {
        let x = (0..=60).map(|i| from * (to / from).powf(real(i) / 60.0));
        line(x.map(|x| (x, of(x))), color)
    };
    let over_ratio = |of: &dyn Fn(f64) -> f64, color| theory(of, 1.7, 55.0, color);
    let over_width = |of: &dyn Fn(f64) -> f64, color| theory(of, 0.6, 6.3, color);
    let found = |table: &str, x: &str, column: &str, color| -> Result<Dots> {
        Ok(dots(record.points(table, x, column)?, 2.2, color))
    };
    let (x, y) = (
        Axis::log("contrast / noise", 1.5, 60.0),
        Axis::log("mean error / px", 0.005, 20.0),
    );
    let mut ratios = plot("error of one point against contrast over noise", x, y);
    for ((sigma, name), color) in SIGMAS
        .into_iter()
        .zip([Color::RED, Color::BLUE, Color::PURPLE])
    {
        let theory = over_ratio(&|ratio| point_error(sigma, ratio), color).weighing(0.7);
        let points = found("ratios", "ratio", name, color)?;
        ratios = ratios
            .with(theory.named(format!("theory of a point, {name} px")))
            .with(points.named(format!("edge points, {name} px")));
    }
    let zeros = found("ratios", "ratio", "zero of the force", Color::ORANGE)?;
    let row = over_ratio(&|ratio| bound(ratio, 1.0), Color::GREEN).dashed();
    let whole = over_ratio(&|ratio| bound(ratio, seen(2.3)), Color::INK).dashed();
    ratios = ratios
        .with(zeros.named("zero of the force, 20 passes"))
        .with(row.named("bound, one row of pixels"))
        .with(whole.named("bound, the edge seen at σ = 2.3"));
    let straight = over_width(&|sigma| point_error(sigma, RATIO), Color::BLUE).weighing(0.7);
    let bias = over_width(&|sigma| sigma * sigma / (2.0 * RADIUS), Color::RED).dashed();
    let limit = over_width(&|sigma| bound(RATIO, seen(sigma)), Color::INK).dashed();
    let x = Axis::new("σ / px", 0.0, 6.5).with_ticks(7);
    let y = Axis::new("mean error / px", 0.0, 1.1).with_ticks(6);
    let widths = plot("error against smoothing, contrast over noise 10", x, y)
        .with(straight.named("theory, straight"))
        .with(bias.named("bias σ²/2R"))
        .with(limit.named("bound, the edge seen"))
        .with(found("widths", "sigma", "straight", Color::BLUE)?.named("straight edge"))
        .with(found("widths", "sigma", "disc", Color::RED)?.named("disc of radius 25 px"));
    let share = |name: &str, truth: &dyn Fn(f64) -> f64, color| -> Result<Dots> {
        let points = record.points("estimates", "noise", name)?.into_iter();
        Ok(dots(
            points.map(|(noise, found)| (noise, found / truth(noise))),
            2.2,
            color,
        ))
    };
    let noise = share("noise found", &|noise| noise, Color::BLUE)?;
    let contrast = share("contrast found", &|_| CONTRAST, Color::GREEN)?;
    let blur = share("blur found", &|_| blur_of_all(), Color::RED)?;
    let x = Axis::log("noise / grey levels", 0.4, 50.0);
    let y = Axis::new("found / true", 0.8, 1.2).with_ticks(5);
    let mut estimates = plot("what the picture tells of itself, over the truth", x, y)
        .legend_at(Corner::TopLeft)
        .with(line([(0.4, 1.0), (50.0, 1.0)], Color::GREY).dashed())
        .with(noise.named("noise"))
        .with(contrast.named("contrast 140"))
        .with(blur.named("blur 1.04 px"));
    estimates.share = 1.7;
    let picture = |title: &str, name: &str| -> Result<Panel> {
        let pixels = grey(record.grid(name)?);
        Ok(Panel::pixels(title, SIZE, SIZE)
            .bare()
            .with(Picture::new(pixels)))
    };
    let below = vec![
        picture("contrast / noise = 5", "noisy")?,
        picture("contrast / noise = 2", "noisier")?,
        estimates,
    ];
    Artefact::only(
        "Above: dots, measured over twelve pictures each; thin lines, theory; dashed, the least any method can be off. \
         Below: two of the pictures, and what pictures of a disc in 8 bits tell of their own noise, contrast and blur.",
        Figure::new("§4.2  Noise and the place of an edge", 940.0)
            .with(380.0, vec![ratios, widths])
            .with(260.0, below),
    )
}
