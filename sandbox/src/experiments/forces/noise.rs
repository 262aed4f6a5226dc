//! Noise against place: how exactly an edge can be found, and what a picture tells of its own noise.

use super::synthetic::{AROUND, OBJECT, blurred, covered, noisy, rounded};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use field::{
    Canny, EdgeForce, ForceField, Grid, REPORT_PASSES, Smoothing, edge_force, edge_points,
    image_scale,
};
use glam::DVec2;
use std::f64::consts::PI;

const ID: &str = "sec-4-2-noise";
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
    id: ID,
    title: "Noise and the place of an edge",
    place: "§4.2",
    question: "A straight edge at 30°, blurred by one pixel, under white noise: how far off are edge points and the \
               zero of the edge force, against the least that any method can be off? What does smoothing buy, and \
               what does it cost on a curve? And does a picture tell its own noise, contrast and blur?",
    claims: &[
        Claim {
            says: "edge points are as exact as theory has it, for σ = 2.3 px and contrast of 5 noises or more",
            source: "[canny86]",
            judge: |r| {
                let mut worst = 0.0_f64;
                for (ratio, found) in r.points("ratios", "ratio", "σ = 2.3")? {
                    if ratio >= 5.0 {
                        worst = worst.max((found / point_error(2.3, ratio) - 1.0).abs());
                    }
                }
                Ok(Finding::new(
                    worst < 0.15,
                    format!("{:.0} % apart at most", 100.0 * worst),
                ))
            },
        },
        Claim {
            says: "that is within 1.4 times the Cramér–Rao bound of the length of edge a point looks at",
            source: "theory",
            judge: |r| {
                let mut worst = 0.0_f64;
                for (ratio, found) in r.points("ratios", "ratio", "σ = 2.3")? {
                    if ratio >= 5.0 {
                        worst = worst.max(found / bound(ratio, seen(2.3)));
                    }
                }
                Ok(Finding::new(
                    worst < 1.4,
                    format!("{worst:.2} times at most"),
                ))
            },
        },
        Claim {
            says: "narrow smoothing wastes what the picture knows: σ = 1 px is more than 1.5 times as far off",
            source: "theory",
            judge: |r| {
                let narrow = r.number("σ = 1: error at ratio 10")?;
                let best = r.number("σ = 2.3: error at ratio 10")?;
                Ok(Finding::new(
                    narrow > 1.5 * best,
                    format!("{narrow:.3} px against {best:.3} px"),
                ))
            },
        },
        Claim {
            says: "and below a contrast of ten noises it takes noise for edges",
            source: "[canny86]",
            judge: |r| {
                let points = r.points("ratios", "ratio", "σ = 1")?;
                let over: Vec<f64> = points
                    .iter()
                    .map(|(ratio, found)| found / point_error(1.0, *ratio))
                    .collect();
                Ok(Finding::new(
                    over[0] > 2.0 && over[3] < 1.25,
                    format!(
                        "off by {:.1} times what theory has for a point of the edge at contrast 2, {:.2} times at 10",
                        over[0], over[3]
                    ),
                ))
            },
        },
        Claim {
            says: "the zero of the edge force is as exact as an edge point at the same width",
            source: "theory",
            judge: |r| {
                let mut worst = 0.0_f64;
                for (ratio, found) in r.points("ratios", "ratio", "zero of the force")? {
                    if ratio >= 5.0 {
                        worst = worst.max((found / point_error(force_sigma(), ratio) - 1.0).abs());
                    }
                }
                Ok(Finding::new(
                    worst < 0.25,
                    format!(
                        "{:.0} % from the theory of σ = {:.2} px at most",
                        100.0 * worst,
                        force_sigma()
                    ),
                ))
            },
        },
        Claim {
            says: "on a straight edge wider is better, on a curve it is not: the bias σ²/2R takes over",
            source: "theory §11.3",
            judge: |r| {
                let straight = r.column("widths", "straight")?;
                let disc = r.column("widths", "disc")?;
                let least = disc.iter().copied().fold(f64::INFINITY, f64::min);
                let best = disc.iter().position(|&v| v <= least).unwrap_or(0);
                let (last, wide) = (straight[straight.len() - 1], disc[disc.len() - 1]);
                Ok(Finding::new(
                    last < 1.1 * straight[best] && wide > 2.0 * least,
                    format!(
                        "disc of radius 25 px: {least:.3} px at σ = {}, {wide:.3} px at σ = 6; straight {last:.3} px",
                        WIDTHS[best]
                    ),
                ))
            },
        },
        Claim {
            says: "a picture tells its noise within 6 %, contrast and blur within 4 % up to a noise of 20 grey levels; at 40, where 8 bits \
                   clip, within 8 %",
            source: "[immerkaer96]",
            judge: |r| {
                let mut worst = [[0.0_f64; 3]; 2];
                let noises = r.points("estimates", "noise", "noise found")?;
                let others = r
                    .column("estimates", "contrast found")?
                    .iter()
                    .zip(r.column("estimates", "blur found")?);
                for ((truth, found), (contrast, blur)) in noises.into_iter().zip(others) {
                    let off = [found / truth, contrast / CONTRAST, blur / blur_of_all()];
                    let of = &mut worst[usize::from(truth > 20.0)];
                    for (worst, off) in of.iter_mut().zip(off) {
                        *worst = worst.max(100.0 * (off - 1.0).abs());
                    }
                }
                let [[noise, contrast, blur], clipped] = worst;
                Ok(Finding::new(
                    noise < 6.0
                        && contrast < 4.0
                        && blur < 4.0
                        && clipped.iter().all(|&off| off < 8.0),
                    format!(
                        "{noise:.1} %, {contrast:.1} %, {blur:.1} % off at most; at 40: {:.1} %, {:.1} %, {:.1} %",
                        clipped[0], clipped[1], clipped[2]
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

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
) -> Result<(f64, usize), SandboxError> {
    // a third of what the edge is in theory
    let total = sigma * sigma + blur_of_all() * blur_of_all();
    let strength = CONTRAST / (2.0 * PI * total).sqrt();
    let rule = Canny {
        sigma,
        high: 0.5 * strength,
        low: 0.3 * strength,
    };
    let found = edge_points(image, &rule).map_err(SandboxError::refused(ID))?;
    let errors: Vec<f64> = found
        .iter()
        .filter_map(|point| off(point.position))
        .map(f64::abs)
        .filter(|&error| error < 4.0)
        .collect();
    Ok((errors.iter().sum(), errors.len()))
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

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let edge = covered((SIZE, SIZE), |p| (p - MIDDLE).dot(normal()) < 0.0);
    let edge = blurred(ID, &edge, 1.0)?;
    let disc = blurred(
        ID,
        &covered((SIZE, SIZE), |p| p.distance(MIDDLE) < RADIUS),
        1.0,
    )?;
    // sums of a thousand errors
    let close = Tolerance::Relative(1e-6);

    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); SIGMAS.len() + 1];
    for ratio in RATIOS {
        let mut sums = vec![(0.0, 0); SIGMAS.len() + 1];
        for seed in 0..PICTURES {
            let image = noisy(&edge, CONTRAST / ratio, seed);
            for ((sigma, _), sum) in SIGMAS.into_iter().zip(&mut sums) {
                let (error, count) = points_off(&image, sigma, &straight_off)?;
                *sum = (sum.0 + error, sum.1 + count);
            }
            let rule = EdgeForce {
                smoothing: Smoothing::Binomial(REPORT_PASSES),
                gain: 1.0,
            };
            let field = edge_force(&image, &rule).map_err(SandboxError::refused(ID))?;
            let (error, count) = zeros_off(&field);
            let last = SIGMAS.len();
            sums[last] = (sums[last].0 + error, sums[last].1 + count);
        }
        for (column, (error, count)) in columns.iter_mut().zip(sums) {
            column.push(error / real(count));
        }
    }
    for ((_, name), column) in SIGMAS.into_iter().zip(&columns) {
        record.note(format!("{name}: error at ratio 10"), column[3], "px", close);
    }
    record.note(
        "zero of the force: error at ratio 10",
        columns[SIGMAS.len()][3],
        "px",
        close,
    );
    record.note(
        "bound of one row of pixels at ratio 10",
        bound(10.0, 1.0),
        "px",
        Tolerance::ROUNDING,
    );
    record.note(
        "bound of the edge a point of σ = 2.3 sees; at ratio 10",
        bound(10.0, seen(2.3)),
        "px",
        Tolerance::ROUNDING,
    );
    let mut table = Table::new("ratios").with("ratio", "", Tolerance::EXACT, RATIOS.to_vec());
    let names = SIGMAS
        .into_iter()
        .map(|one| one.1)
        .chain(["zero of the force"]);
    for (name, column) in names.zip(columns) {
        table = table.with(name, "px", close, column);
    }
    record.keep(table);

    let mut wide = [Vec::new(), Vec::new()];
    for sigma in WIDTHS {
        let mut sums = [(0.0, 0); 2];
        for seed in 0..PICTURES {
            let pictures = [
                (&edge, &straight_off as &dyn Fn(DVec2) -> Option<f64>),
                (&disc, &disc_off),
            ];
            for ((picture, off), sum) in pictures.into_iter().zip(&mut sums) {
                let image = noisy(picture, CONTRAST / RATIO, 100 + seed);
                let (error, count) = points_off(&image, sigma, off)?;
                *sum = (sum.0 + error, sum.1 + count);
            }
        }
        for (column, (error, count)) in wide.iter_mut().zip(sums) {
            column.push(error / real(count));
        }
    }
    let [straight, disc_errors] = wide;
    record.keep(
        Table::new("widths")
            .with("sigma", "px", Tolerance::EXACT, WIDTHS.to_vec())
            .with("straight", "px", close, straight)
            .with("disc", "px", close, disc_errors),
    );

    let mut found = [Vec::new(), Vec::new(), Vec::new()];
    for (seed, noise) in (200..).zip(NOISES) {
        let image = rounded(&noisy(&disc, noise, seed));
        let scale = image_scale(&image).map_err(SandboxError::refused(ID))?;
        for (column, value) in found
            .iter_mut()
            .zip([scale.noise, scale.contrast, scale.blur])
        {
            column.push(value);
        }
    }
    let [noise, contrast, blur] = found;
    record.keep(
        Table::new("estimates")
            .with("noise", "grey levels", Tolerance::EXACT, NOISES.to_vec())
            .with("noise found", "grey levels", close, noise)
            .with("contrast found", "grey levels", close, contrast)
            .with("blur found", "px", close, blur),
    );
    record.keep_grid("clean", edge.clone());
    record.keep_grid("noisy", rounded(&noisy(&edge, CONTRAST / 5.0, 0)));
    record.keep_grid("noisier", rounded(&noisy(&edge, CONTRAST / 2.0, 0)));
    Ok(record)
}

fn dots(points: Vec<(f64, f64)>, color: Color, label: &str) -> Layer {
    Layer::Dots {
        points,
        radius: 2.2,
        color,
        label: label.to_owned(),
    }
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let curve = |of: &dyn Fn(f64) -> f64, from: f64, to: f64| -> Vec<(f64, f64)> {
        (0..=60)
            .map(|i| from * (to / from).powf(real(i) / 60.0))
            .map(|x| (x, of(x)))
            .collect()
    };
    let mut ratios = Panel::new(
        "error of one point against contrast over noise",
        Axis::log("contrast / noise", 1.5, 60.0),
        Axis::log("mean error / px", 0.005, 20.0),
    );
    let colors = [Color::RED, Color::BLUE, Color::PURPLE];
    for ((sigma, name), color) in SIGMAS.into_iter().zip(colors) {
        let theory = Line::new(curve(&|ratio| point_error(sigma, ratio), 1.7, 55.0), color);
        ratios = ratios
            .with(
                theory
                    .weighing(0.7)
                    .named(format!("theory of a point, {name} px")),
            )
            .with(dots(
                record.points("ratios", "ratio", name)?,
                color,
                &format!("edge points, {name} px"),
            ));
    }
    ratios = ratios
        .with(dots(
            record.points("ratios", "ratio", "zero of the force")?,
            Color::ORANGE,
            "zero of the force, 20 passes",
        ))
        .with(
            Line::new(curve(&|ratio| bound(ratio, 1.0), 1.7, 55.0), Color::GREEN)
                .dashed()
                .named("bound, one row of pixels"),
        )
        .with(
            Line::new(
                curve(&|ratio| bound(ratio, seen(2.3)), 1.7, 55.0),
                Color::INK,
            )
            .dashed()
            .named("bound, the edge seen at σ = 2.3"),
        );
    let widths = Panel::new(
        "error against smoothing, contrast over noise 10",
        Axis::new("σ / px", 0.0, 6.5).with_ticks(7),
        Axis::new("mean error / px", 0.0, 1.1).with_ticks(6),
    )
    .with(
        Line::new(
            curve(&|sigma| point_error(sigma, RATIO), 0.6, 6.3),
            Color::BLUE,
        )
        .weighing(0.7)
        .named("theory, straight"),
    )
    .with(
        Line::new(
            curve(&|sigma| sigma * sigma / (2.0 * RADIUS), 0.6, 6.3),
            Color::RED,
        )
        .dashed()
        .named("bias σ²/2R"),
    )
    .with(
        Line::new(
            curve(&|sigma| bound(RATIO, seen(sigma)), 0.6, 6.3),
            Color::INK,
        )
        .dashed()
        .named("bound, the edge seen"),
    )
    .with(dots(
        record.points("widths", "sigma", "straight")?,
        Color::BLUE,
        "straight edge",
    ))
    .with(dots(
        record.points("widths", "sigma", "disc")?,
        Color::RED,
        "disc of radius 25 px",
    ));
    let share = |name: &str, truth: &dyn Fn(f64) -> f64| -> Result<Vec<(f64, f64)>, SandboxError> {
        let points = record.points("estimates", "noise", name)?;
        Ok(points
            .into_iter()
            .map(|(noise, found)| (noise, found / truth(noise)))
            .collect())
    };
    let estimates = Panel::new(
        "what the picture tells of itself, over the truth",
        Axis::log("noise / grey levels", 0.4, 50.0),
        Axis::new("found / true", 0.8, 1.2).with_ticks(5),
    )
    .legend_at(Corner::TopLeft)
    .with(Line::new(vec![(0.4, 1.0), (50.0, 1.0)], Color::GREY).dashed())
    .with(dots(
        share("noise found", &|noise| noise)?,
        Color::BLUE,
        "noise",
    ))
    .with(dots(
        share("contrast found", &|_| CONTRAST)?,
        Color::GREEN,
        "contrast 140",
    ))
    .with(dots(
        share("blur found", &|_| blur_of_all())?,
        Color::RED,
        "blur 1.04 px",
    ));
    let picture = |title: &str, name: &str| -> Result<Panel, SandboxError> {
        let pixels = super::super::pixels::grey(record.grid(name)?);
        Ok(Panel::pixels(title, SIZE, SIZE)
            .bare()
            .with(crate::draw::Picture::new(pixels)))
    };
    let mut panels = vec![
        picture("contrast / noise = 5", "noisy")?,
        picture("contrast / noise = 2", "noisier")?,
    ];
    panels.push(estimates);
    panels[2].share = 1.7;
    let figure = Figure::new("§4.2  Noise and the place of an edge", 940.0)
        .with(380.0, vec![ratios, widths])
        .with(260.0, panels);
    Ok(vec![Artefact::figure(
        "Above: dots, measured over twelve pictures each; thin lines, theory; dashed, the least any method can be off. \
         Below: two of the pictures, and what pictures of a disc in 8 bits tell of their own noise, contrast and blur.",
        figure,
    )])
}
