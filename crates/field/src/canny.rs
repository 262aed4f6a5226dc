//! Edges between pixels: where a step is, which way it faces, how strong it is.
//!
//! Not here yet: chains of edge points, corners, several scales at once.

use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::{Grid, admit, mirrored};
use crate::sample::Interpolation;
use crate::smooth::{Smoothing, gaussian_weights};
use glam::DVec2;
use ndarray::Array2;

/// What edge points are found with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Canny {
    /// σ of the Gaussian whose derivatives are taken, in pixels. About twice the blur of the edges is best.
    pub sigma: f64,
    /// An edge begins where |∇(G ∗ I)| is at least this, in grey levels per pixel, …
    pub high: f64,
    /// … and goes on to its neighbours while it is at least this.
    pub low: f64,
}

/// A point of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Where, in pixels.
    pub position: DVec2,
    /// The unit vector across the edge, from dark to bright.
    pub normal: DVec2,
    /// |∇(G ∗ I)| there, grey levels per pixel: `contrast / (√(2π) σ_t)` at a straight step, with `σ_t² = σ² + blur²`.
    pub strength: f64,
}

/// Edges to a fraction of a pixel: maxima of |∇(G ∗ I)| across the edge that hang together.
///
/// Derivatives of a Gaussian; a pixel is kept if it is stronger than the points where the line along its gradient meets the next row or column; then the place is
/// the vertex of the parabola through the logarithm of the strength at three points a pixel apart along the gradient, taken
/// twice. The logarithm since a blurred step has a Gaussian for a gradient, whose logarithm *is* a parabola. One point a
/// pixel, in reading order of the pixels; O(pixels · σ).
///
/// **How good.** A straight step of contrast A, blur b (its Gaussian σ) and white noise of standard deviation s, averaged over a length L of edge:
///
/// ```text
/// variance          = (3 √π / 4) σ_t⁶ / σ⁵ · s² / (A² L)
/// Cramér–Rao bound  =        2 √π · b      · s² / (A² L)
/// ratio             = (3/8) (1 + q²)³ / q⁵        q = σ / b: 3 at q = 1, 1.45 (the least) at q = √5
/// ```
///
/// Measured at 0°, 11°, 30° and 45°, with b = 1.04 px, σ = 2.3 px, L = 40 px, 60 pictures each: the error of the mean place is 1.07 to
/// 1.27 times the bound for A / s = 5, 10 and 20 (0.069, 0.035, 0.018 px at 30°; √1.45 = 1.20 expected). A single point is 0.16, 0.080, 0.040 px
/// off. Without noise, 0.007 px at most: that of the bicubic rule between pixels; 0.021 at σ = 1.
///
/// \[canny86\], \[devernay95\]
///
/// # Errors
/// A `sigma`, `high` or `low` that is not above 0, a `low` beyond `high`, what [`edge_force`](crate::edge_force) refuses.
pub fn edge_points(image: &Grid, rule: &Canny) -> Result<Vec<EdgePoint>, FieldError> {
    positive("high", rule.high)?;
    positive("low", rule.low)?;
    if rule.low > rule.high {
        return Err(FieldError::TooMuch {
            name: "low",
            value: rule.low,
            most: rule.high,
        });
    }
    let slopes = Slopes::new(image, rule.sigma)?;
    let kept = hang_together(&slopes, rule.low, rule.high);
    Ok(kept.iter().filter_map(|&at| slopes.refined(at)).collect())
}

/// ∇(G ∗ I) at pixel centers and between them.
pub(crate) struct Slopes {
    field: ForceField,
    strength: Grid,
}

impl Slopes {
    pub(crate) fn new(image: &Grid, sigma: f64) -> Result<Self, FieldError> {
        Smoothing::Gaussian(sigma).validate()?;
        let image = admit(image, 1.0)?;
        let smooth = gaussian_weights(sigma);
        let mut slope: Vec<f64> = (0..smooth.len()).map(|k| k as f64 * smooth[k]).collect();
        // a ramp of slope 1 has derivative 1: Σ k w(k) over both sides
        let ramp = 2.0
            * slope
                .iter()
                .enumerate()
                .map(|(k, w)| k as f64 * w)
                .sum::<f64>();
        slope.iter_mut().for_each(|w| *w /= ramp);
        let even = |grid: &Grid| lines(grid, &smooth, 1.0);
        let odd = |grid: &Grid| lines(grid, &slope, -1.0);
        let x = even(&odd(&image).t().to_owned()).t().to_owned();
        let y = odd(&even(&image).t().to_owned()).t().to_owned();
        let strength = Grid::from_shape_fn(x.dim(), |at| x[at].hypot(y[at]));
        let field = ForceField::from_components(&x, &y)?;
        Ok(Self { field, strength })
    }

    /// ∇(G ∗ I) at any point of the picture; beyond, that of the nearest one.
    pub(crate) fn at(&self, p: DVec2) -> DVec2 {
        self.field.sample(p, Interpolation::Bicubic)
    }

    /// Whether a pixel is at least as strong as the points on either side where its gradient meets the next row or column.
    fn is_ridge(&self, (y, x): (usize, usize)) -> bool {
        let (height, width) = self.strength.dim();
        let here = self.strength[[y, x]];
        let Some(gradient) = self.field.pixel(x, y) else {
            return false;
        };
        let p = DVec2::new(x as f64, y as f64);
        let n = gradient / here;
        let next = n / n.abs().max_element();
        let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
        let inside = |p: DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(last).all();
        let side = |p: DVec2| if inside(p) { self.at(p).dot(n) } else { 0.0 };
        // of two equals the first counts, whatever rounding says
        here >= side(p - next) * (1.0 + 1e-9) && here >= side(p + next) * (1.0 - 1e-9)
    }

    /// The place of the maximum near a pixel; `None` if it is more than a pixel away, which another pixel's may be nearer to.
    pub(crate) fn refined(&self, (y, x): (usize, usize)) -> Option<EdgePoint> {
        let pixel = DVec2::new(x as f64, y as f64);
        let mut p = pixel;
        let mut normal = self.at(p).normalize_or_zero();
        for _ in 0..2 {
            let log = |t: f64| {
                self.at(p + t * normal)
                    .dot(normal)
                    .max(f64::MIN_POSITIVE)
                    .ln()
            };
            let (before, here, after) = (log(-1.0), log(0.0), log(1.0));
            let bend = before - 2.0 * here + after;
            if bend >= 0.0 {
                return None;
            }
            p += 0.5 * (before - after) / bend * normal;
            normal = self.at(p).normalize_or_zero();
        }
        let position = p;
        let strength = self.at(p).length();
        (p.distance_squared(pixel) <= 1.0 && strength > 0.0).then_some(EdgePoint {
            position,
            normal,
            strength,
        })
    }
}

/// Pixels on ridges of at least `low`, reached over such from one of at least `high`; in reading order.
pub(crate) fn hang_together(slopes: &Slopes, low: f64, high: f64) -> Vec<(usize, usize)> {
    let (height, width) = slopes.strength.dim();
    let ridge = Array2::from_shape_fn((height, width), |at| {
        slopes.strength[at] >= low && slopes.is_ridge(at)
    });
    let mut kept = Array2::from_elem((height, width), false);
    let mut open: Vec<(usize, usize)> = ridge
        .indexed_iter()
        .filter(|(at, ridge)| **ridge && slopes.strength[*at] >= high)
        .map(|(at, _)| at)
        .collect();
    while let Some((y, x)) = open.pop() {
        if std::mem::replace(&mut kept[[y, x]], true) {
            continue;
        }
        for v in y.saturating_sub(1)..(y + 2).min(height) {
            for u in x.saturating_sub(1)..(x + 2).min(width) {
                if ridge[[v, u]] && !kept[[v, u]] {
                    open.push((v, u));
                }
            }
        }
    }
    let found = kept.indexed_iter().filter(|(_, kept)| **kept);
    found.map(|(at, _)| at).collect()
}

/// Every row with weights that are even (`sign` 1) or odd (−1, the right side positive), center first, mirrored.
fn lines(grid: &Grid, weights: &[f64], sign: f64) -> Grid {
    let (height, width) = grid.dim();
    let mut out = Grid::zeros((height, width));
    let reach = weights.len() - 1;
    let mut line = vec![0.0; width + 2 * reach];
    for (row, mut out) in grid.rows().into_iter().zip(out.rows_mut()) {
        for (k, v) in line.iter_mut().enumerate() {
            *v = row[mirrored(k.cast_signed() - reach.cast_signed(), width)];
        }
        for (x, out) in out.iter_mut().enumerate() {
            let c = x + reach;
            let pair = |(k, w): (usize, &f64)| w * (line[c + k] + sign * line[c - k]);
            let sides: f64 = weights.iter().enumerate().skip(1).rev().map(pair).sum();
            *out = sides + weights[0] * line[c];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::gauss;

    /// A step through `at` whose normal has this angle: exactly A · Φ(d / blur), with noise.
    fn step(side: usize, at: DVec2, angle: f64, blur: f64, noise: f64, seed: u64) -> Grid {
        let normal = DVec2::from_angle(angle);
        Grid::from_shape_fn((side, side), |(y, x)| {
            let d = (DVec2::new(x as f64, y as f64) - at).dot(normal) / blur;
            100.0 * phi(d) + noise * gauss((seed << 31) + (y * side + x) as u64)
        })
    }

    /// The normal distribution function, by Simpson's rule.
    fn phi(z: f64) -> f64 {
        let (n, z) = (64, z.clamp(-8.0, 8.0));
        let h = z / f64::from(n);
        let f = |k: i32| (-0.5 * (f64::from(k) * h).powi(2)).exp();
        let inner: f64 = (1..n).map(|k| f64::from(2 + 2 * (k % 2)) * f(k)).sum();
        0.5 + h / 3.0 * (f(0) + inner + f(n)) / std::f64::consts::TAU.sqrt()
    }

    const ANGLES: [f64; 4] = [0.0, 11.0, 30.0, 45.0];

    const RULE: Canny = Canny {
        sigma: 2.3,
        high: 5.0,
        low: 2.0,
    };

    /// Signed distances of the edge points from the true step, along 40 pixels of it.
    fn errors(at: DVec2, angle: f64, image: &Grid, rule: &Canny) -> Vec<f64> {
        let normal = DVec2::from_angle(angle);
        edge_points(image, rule)
            .unwrap()
            .iter()
            .map(|p| (p.position - at, p.normal))
            .filter(|(d, _)| d.dot(normal.perp()).abs() < 20.0 && d.dot(normal).abs() < 3.0)
            .map(|(d, n)| {
                // the direction is right too, to what noise of a fifth of the contrast does to it
                assert!(n.dot(normal) > 0.8, "{n} {normal}");
                d.dot(normal)
            })
            .collect()
    }

    #[test]
    fn without_noise_a_step_is_found_to_a_hundredth_of_a_pixel() {
        for angle in ANGLES.map(f64::to_radians) {
            for k in 0..5 {
                let at = DVec2::new(31.0 + 0.23 * f64::from(k), 30.7);
                let image = step(64, at, angle, 1.04, 0.0, 0);
                let found = errors(at, angle, &image, &RULE);
                let worst = found.iter().fold(0.0_f64, |w, e| w.max(e.abs()));
                assert!(
                    found.len() >= 36 && worst < 0.008,
                    "{} {worst}",
                    found.len()
                );
            }
        }
    }

    #[test]
    fn with_noise_the_error_is_the_one_derived_and_near_the_bound() {
        for snr in [20.0, 5.0] {
            let (mut squares, mut runs) = (0.0, 0.0);
            for angle in ANGLES.map(f64::to_radians) {
                for seed in 0..24_u32 {
                    let at = DVec2::new(31.0 + (0.37 * f64::from(seed)) % 1.0, 30.7);
                    let image = step(64, at, angle, 1.04, 100.0 / snr, u64::from(seed) + 1);
                    let found = errors(at, angle, &image, &RULE);
                    let mean = found.iter().sum::<f64>() / found.len() as f64;
                    (squares, runs) = (squares + mean * mean, runs + 1.0);
                }
            }
            let bound = (2.0 * std::f64::consts::PI.sqrt() * 1.04 / 40.0).sqrt() / snr;
            let ratio = (squares / runs).sqrt() / bound;
            // √1.45 = 1.20; 96 runs tell a root mean square to 7 %, and no estimate beats the bound by more
            assert!((0.9..1.4).contains(&ratio), "{snr}: {ratio}");
        }
    }

    #[test]
    fn strength_and_direction_are_those_of_the_blurred_step() {
        let at = DVec2::new(31.3, 30.7);
        let image = step(64, at, 0.4, 1.5, 0.0, 0);
        let expected = 100.0 / (std::f64::consts::TAU * (2.3 * 2.3 + 1.5 * 1.5)).sqrt();
        for point in edge_points(&image, &RULE).unwrap() {
            if point.position.distance(at) < 15.0 {
                assert!((point.strength / expected - 1.0).abs() < 1e-3);
                assert!(point.normal.distance(DVec2::from_angle(0.4)) < 2e-3);
            }
        }
    }

    #[test]
    fn an_edge_goes_on_while_it_is_weak_but_does_not_begin_so() {
        // contrast falls from 100 to 20 down the edge, and an edge of 20 stands alone
        let image = Grid::from_shape_fn((60, 60), |(y, x)| {
            let long = if x > 15 {
                100.0 - 80.0 * y as f64 / 59.0
            } else {
                0.0
            };
            long + if x > 45 { 20.0 } else { 0.0 }
        });
        let found = |low, high| {
            let rule = Canny {
                sigma: 1.5,
                low,
                high,
            };
            let points = edge_points(&image, &rule).unwrap();
            let near = |x: f64| {
                points
                    .iter()
                    .filter(|p| (p.position.x - x).abs() < 1.0)
                    .count()
            };
            (near(15.5), near(45.5))
        };
        let (long, alone) = found(2.0, 15.0);
        assert!(long >= 58 && alone == 0, "{long} {alone}");
        let (long, alone) = found(15.0, 15.0);
        assert!(long < 40 && alone == 0, "{long} {alone}");
        let alone = found(2.0, 2.0).1;
        // the picture's own border bends the edge's ends
        assert!(alone >= 50, "{alone}");
    }

    #[test]
    fn odd_pictures_have_edges_or_none_but_no_trouble() {
        for (height, width) in [(1, 1), (1, 40), (40, 1), (3, 3), (3, 100_000)] {
            let flat = Grid::from_elem((height, width), 0.1);
            let rule = Canny {
                sigma: 1.0,
                low: 1e-9,
                high: 1e-9,
            };
            assert!(edge_points(&flat, &rule).unwrap().is_empty());
            let wild =
                Grid::from_shape_fn((height, width), |(y, x)| ((x * 37 + y * 91) % 101) as f64);
            for p in edge_points(&wild, &rule).unwrap() {
                assert!(p.position.is_finite() && p.normal.is_normalized() && p.strength > 0.0);
            }
        }
        let image = Grid::zeros((3, 3));
        for (sigma, low, high) in [
            (0.0, 1.0, 1.0),
            (1.0, 0.0, 1.0),
            (1.0, 2.0, 1.0),
            (1.0, 1.0, f64::NAN),
        ] {
            assert!(edge_points(&image, &Canny { sigma, low, high }).is_err());
        }
        assert!(edge_points(&Grid::zeros((0, 3)), &RULE).is_err());
    }
}
