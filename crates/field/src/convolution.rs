//! Vector field convolution: every edge pixel pulls on every other, weaker with distance.

use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::{Grid, admit};
use glam::DVec2;

mod fourier;

/// How the pull of an edge pixel falls with the distance r.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Falloff {
    /// `(r + ε)^(−γ)`, ε = 1e-8 px; γ in 1.5 … 3.
    Power {
        /// γ.
        exponent: f64,
    },
    /// `e^(−r²/ζ²)`.
    Gaussian {
        /// ζ, in pixels.
        width: f64,
    },
}

impl Falloff {
    /// The vector a pixel at `offset` from here pulls with: towards it.
    fn pull(self, offset: DVec2) -> DVec2 {
        let r = offset.length();
        if r <= 0.0 {
            return DVec2::ZERO;
        }
        let strength = match self {
            Self::Power { exponent } => (r + 1e-8).powf(-exponent),
            Self::Gaussian { width } => (-(r / width) * (r / width)).exp(),
        };
        offset / r * strength
    }
}

/// The vector field convolution of an edge map, by Fourier transform.
///
/// ```text
/// F(x) = Σ_y map(y) · m(|y − x|) · (y − x)/|y − x|        over all y within `reach`
/// ```
///
/// Each pixel of the map pulls as strongly as it is large; nothing lies beyond the border. A radial kernel in the plane
/// is the gradient of a potential, so this force is that of an energy, but for the pixel grid. Reaches `reach`
/// pixels and is robust to single bright pixels. O(P log P) for P = (width + reach)(height + reach) pixels, whatever
/// the reach; agrees with the direct sum to 1e-12 of Σ|map|.
///
/// \[li07\]
///
/// # Errors
/// No pixels, a value that is not finite; a falloff or reach that is not above 0.
pub fn vector_convolution(
    map: &Grid,
    falloff: Falloff,
    reach: f64,
) -> Result<ForceField, FieldError> {
    match falloff {
        Falloff::Power { exponent } => positive("exponent", exponent)?,
        Falloff::Gaussian { width } => positive("width", width)?,
    }
    positive("reach", reach)?;
    let map = admit(map, 1.0)?;
    let (height, width) = map.dim();
    // farther than the picture is wide there is nothing to pull
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 < reach, capped by a length"
    )]
    let radius = |n: usize| (reach.min(n as f64).floor() as usize).min(n - 1);
    let (rx, ry) = (radius(width), radius(height));
    let dim = (
        (height + ry).next_power_of_two(),
        (width + rx).next_power_of_two(),
    );
    // x and y components are the real and imaginary part of one complex kernel, wrapped round
    let mut kernel = fourier::Plane::zeros(dim);
    for dy in -ry.cast_signed()..=ry.cast_signed() {
        for dx in -rx.cast_signed()..=rx.cast_signed() {
            let offset = DVec2::new(dx as f64, dy as f64);
            if offset.length() <= reach {
                // a pixel at +offset pulls here: the kernel is turned round
                let row = (-dy).rem_euclid(dim.0.cast_signed()).unsigned_abs();
                let column = (-dx).rem_euclid(dim.1.cast_signed()).unsigned_abs();
                kernel.set(row, column, falloff.pull(offset));
            }
        }
    }
    let mut plane = fourier::Plane::zeros(dim);
    for ((y, x), &value) in map.indexed_iter() {
        plane.set(y, x, DVec2::new(value, 0.0));
    }
    plane.transform(false);
    kernel.transform(false);
    plane.multiply(&kernel);
    plane.transform(true);
    let part = |part: fn(DVec2) -> f64| {
        Grid::from_shape_fn((height, width), |(y, x)| part(plane.get(y, x)))
    };
    ForceField::from_components(&part(|f| f.x), &part(|f| f.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn slow(map: &Grid, falloff: Falloff, reach: f64) -> ForceField {
        let force = |x: usize, y: usize| -> DVec2 {
            let here = DVec2::new(x as f64, y as f64);
            map.indexed_iter()
                .map(|((v, u), &value)| {
                    let offset = DVec2::new(u as f64, v as f64) - here;
                    if offset.length() <= reach {
                        value * falloff.pull(offset)
                    } else {
                        DVec2::ZERO
                    }
                })
                .sum()
        };
        ForceField::new(ndarray::Array2::from_shape_fn(map.dim(), |(y, x)| {
            force(x, y)
        }))
        .unwrap()
    }

    proptest! {
        #[test]
        fn the_transform_is_the_direct_sum(
            (height, width) in (1_usize..14, 1_usize..14), seed in 0_usize..1000, reach in 0.5..30.0_f64,
        ) {
            let map = Grid::from_shape_fn((height, width), |(y, x)| {
                ((seed + (x * 31 + y * 17) * 7919) % 11) as f64
            });
            for falloff in [Falloff::Power { exponent: 2.0 }, Falloff::Gaussian { width: 4.0 }] {
                let (fast, slow) = (vector_convolution(&map, falloff, reach).unwrap(), slow(&map, falloff, reach));
                for y in 0..height {
                    for x in 0..width {
                        let difference = fast.pixel(x, y).unwrap() - slow.pixel(x, y).unwrap();
                        prop_assert!(difference.length() < 1e-12 * (1.0 + map.sum()), "{}", difference);
                    }
                }
            }
        }
    }

    #[test]
    fn one_bright_pixel_pulls_from_all_sides() {
        let mut map = Grid::zeros((21, 41));
        map[[10, 20]] = 5.0;
        let field = vector_convolution(&map, Falloff::Power { exponent: 2.0 }, 30.0).unwrap();
        for (x, y) in [(2, 10), (38, 10), (20, 1), (30, 19)] {
            let p = DVec2::new(f64::from(x), f64::from(y));
            let to = DVec2::new(20.0, 10.0) - p;
            let expected = 5.0 * to / to.length().powi(3);
            assert!((field.at(p) - expected).length() < 1e-7 * expected.length());
        }
        assert!(field.at(DVec2::new(20.0, 10.0)).length() < 1e-12);
    }

    #[test]
    fn bad_numbers_are_refused() {
        let map = Grid::zeros((4, 4));
        assert!(vector_convolution(&map, Falloff::Power { exponent: 0.0 }, 3.0).is_err());
        assert!(vector_convolution(&map, Falloff::Gaussian { width: f64::NAN }, 3.0).is_err());
        assert!(vector_convolution(&map, Falloff::Gaussian { width: 1.0 }, -3.0).is_err());
        assert!(
            vector_convolution(&Grid::zeros((0, 2)), Falloff::Gaussian { width: 1.0 }, 3.0)
                .is_err()
        );
        assert!(
            vector_convolution(&map, Falloff::Gaussian { width: 1.0 }, 3.0)
                .unwrap()
                .largest()
                <= 0.0
        );
    }
}
