//! Texture as channels: how much of each scale and direction there is around a pixel.

use crate::error::FieldError;
use crate::grid::{Grid, admit};
use crate::smooth::Smoothing;

/// Directions of the bank: every 45 degrees.
const DIRECTIONS: usize = 4;

/// Texture energies of a picture: one channel for each scale and each of four directions, finest scale first.
///
/// ```text
/// T = √(G_2σ ∗ (σ² ∂²(G_σ ∗ I) / ∂n²)²)        n at 0°, 45°, 90°, 135°
/// ```
///
/// The second derivative of a Gaussian across n answers to stripes some 4.4 σ wide from one to the next; it is blind to even and to sloping light. The energies are
/// in grey levels: of their stripes' own amplitude times 2/e/√2 = 0.52 where they answer most. Give the channels to [`Classes::clusters`](super::Classes::clusters), or
/// to one [`TwoRegions`](super::TwoRegions) each. Borders between textures are found to about 2 σ. Two or three scales, each twice the one before, are plenty.
/// O(pixels · scales · σ).
///
/// After \[jain91\], with derivatives of Gaussians for Gabor's filters.
///
/// # Errors
/// A σ that is not above 0 or too large; an image without pixels, or with one that is not finite or too large.
pub fn texture_channels(image: &Grid, sigmas: &[f64]) -> Result<Vec<Grid>, FieldError> {
    let image = admit(image, 1.0)?;
    let mut channels = Vec::with_capacity(DIRECTIONS * sigmas.len());
    for &sigma in sigmas {
        let (smoothing, window) = (Smoothing::Gaussian(sigma), Smoothing::Gaussian(2.0 * sigma));
        smoothing.validate()?;
        window.validate()?;
        let smooth = smoothing.apply(&image);
        let square = sigma * sigma;
        let (xx, yy, xy) = second(&smooth);
        let answers = [
            &xx * square,
            (&xx + &yy + &xy * 2.0) * (0.5 * square),
            &yy * square,
            (&xx + &yy - &xy * 2.0) * (0.5 * square),
        ];
        for answer in answers {
            let energy = window.apply(&answer.mapv(|a| a * a));
            channels.push(energy.mapv(|e| e.max(0.0).sqrt()));
        }
    }
    Ok(channels)
}

/// Second derivatives ∂xx, ∂yy, ∂xy by differences on the mirrored picture.
fn second(image: &Grid) -> (Grid, Grid, Grid) {
    let (height, width) = image.dim();
    let at = |y: usize, x: usize| image[[y, x]];
    let around = |i: usize, n: usize| (i.saturating_sub(1), (i + 1).min(n - 1));
    let grid = |f: &dyn Fn((usize, usize)) -> f64| Grid::from_shape_fn((height, width), f);
    let xx = grid(&|(y, x)| {
        let (left, right) = around(x, width);
        at(y, left) - 2.0 * at(y, x) + at(y, right)
    });
    let yy = grid(&|(y, x)| {
        let (up, down) = around(y, height);
        at(up, x) - 2.0 * at(y, x) + at(down, x)
    });
    let xy = grid(&|(y, x)| {
        let ((left, right), (up, down)) = (around(x, width), around(y, height));
        0.25 * (at(down, right) - at(down, left) - at(up, right) + at(up, left))
    });
    (xx, yy, xy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::gauss;
    use crate::region::tests::{circle, pushes};
    use crate::{Classes, Density, LikelihoodRegions, MaskedImage, Region, TwoRegions};
    use glam::DVec2;
    use std::f64::consts::{PI, TAU};

    /// Stripes of amplitude 40 with this wave along this direction, in degrees.
    fn stripes(p: DVec2, wave: f64, degrees: f64) -> f64 {
        100.0 + 40.0 * (TAU / wave * p.dot(DVec2::from_angle(degrees.to_radians()))).sin()
    }

    fn picture(f: impl Fn(DVec2) -> f64) -> Grid {
        Grid::from_shape_fn((100, 100), |(y, x)| f(DVec2::new(x as f64, y as f64)))
    }

    #[test]
    fn stripes_answer_in_their_own_direction_with_the_energy_derived() {
        let sigma = 3.0;
        // σ² k² e^(−σ² k² / 2) is largest, 2/e, at σ k = √2
        let wave = TAU * sigma / 2.0_f64.sqrt();
        for (k, degrees) in [0.0, 45.0, 90.0, 135.0].into_iter().enumerate() {
            let image = picture(|p| stripes(p, wave, degrees));
            let channels = texture_channels(&image, &[sigma]).unwrap();
            let own = channels[k][[50, 50]];
            let expected = 40.0 * 2.0 / 1.0_f64.exp() / 2.0_f64.sqrt();
            // differences answer 2 % less than derivatives here, and the window holds few waves
            assert!(
                (own / expected - 1.0).abs() < 0.05,
                "{degrees}: {own} {expected}"
            );
            // across, the second derivative is nothing; at 45° it is half
            assert!(channels[(k + 2) % 4][[50, 50]] < 0.02 * own);
            assert!((channels[(k + 1) % 4][[50, 50]] / own - 0.5).abs() < 0.02);
        }
    }

    #[test]
    fn even_and_sloping_light_have_no_texture() {
        for image in [picture(|_| 0.1), picture(|p| 3.0 * p.x - p.y)] {
            for channel in texture_channels(&image, &[1.5, 3.0]).unwrap() {
                // the mirrored slope turns at the border: σ² times its bend, squared, is 50 there, and e^(−25) of it comes this far
                assert!(channel[[50, 50]] < 1e-4);
            }
        }
        for shape in [(1, 1), (1, 40), (40, 1), (3, 3), (3, 20_000)] {
            for channel in texture_channels(&Grid::from_elem(shape, 0.1), &[1.5]).unwrap() {
                assert!(channel.iter().all(|t| *t < 1e-12));
            }
        }
        assert!(texture_channels(&Grid::zeros((3, 3)), &[0.0]).is_err());
        assert!(texture_channels(&Grid::zeros((0, 3)), &[1.0]).is_err());
    }

    #[test]
    fn a_disk_of_stripes_among_stripes_across_is_found() {
        let center = DVec2::splat(50.0);
        let noise = |p: DVec2| 8.0 * gauss((100.0 * p.y + p.x).abs().to_bits() >> 8);
        let image = picture(|p| {
            let degrees = if p.distance(center) < 25.0 { 0.0 } else { 90.0 };
            stripes(p, 2.0 * PI, degrees) + noise(p)
        });
        let channels = texture_channels(&image, &[1.5, 3.0]).unwrap();
        let masked: Vec<MaskedImage> = channels
            .iter()
            .map(|c| MaskedImage::whole(c).unwrap())
            .collect();
        let classes = Classes::clusters(&masked, 16).unwrap();
        let parzen = Density::Parzen { bandwidth: 3.0 };
        let likely = LikelihoodRegions::new(&classes, parzen, 1.0).unwrap();
        let two: Vec<TwoRegions> = channels
            .iter()
            .map(|c| TwoRegions::new(c, 1.0).unwrap())
            .collect();
        for (radius, way) in [(8.0, 1.0), (20.0, 1.0), (30.0, -1.0), (42.0, -1.0)] {
            let polygon = circle(center, radius, 60);
            let right = |push: &[f64]| push.iter().filter(|f| way * **f > 0.0).count();
            let found = right(&pushes(&likely, &polygon));
            assert!(found >= 56, "{radius}: {found} of 60");
            let mut sum = vec![0.0; 60];
            for channel in &two {
                let push = pushes(channel as &dyn Region, &polygon);
                sum.iter_mut().zip(push).for_each(|(s, f)| *s += f);
            }
            assert!(right(&sum) >= 56, "{radius}: {} of 60", right(&sum));
        }
    }
}
