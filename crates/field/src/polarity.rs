//! Edges of one kind only: dark to bright, or bright to dark, seen along a curve's normal.

use crate::edge::gradient;
use crate::error::FieldError;
use crate::force_field::ForceField;
use crate::grid::{Grid, admit};
use crate::sample::Interpolation;
use crate::smooth::Smoothing;
use glam::{DMat2, DVec2};

/// Which edges attract, going outwards along the normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polarity {
    /// Dark inside, bright outside.
    DarkToBright,
    /// Bright inside, dark outside.
    BrightToDark,
    /// Both.
    Either,
}

/// The gradient of a smoothed picture, kept so that a curve can ask for the edges of its own orientation.
///
/// ```text
/// E(x, n) = −gain · s(∇(G ∗ I)(x) · n)        s(d) = max(d, 0), max(−d, 0) or |d|
/// F = −∂E/∂x, at fixed n
/// ```
///
/// n is the curve's outward unit normal. The energy depends on the direction of the curve, so this is no
/// [`ForceField`]: it needs the normal at each node.
#[derive(Debug, Clone, PartialEq)]
pub struct SignedEdge {
    gradient: ForceField,
    polarity: Polarity,
    gain: f64,
}

impl SignedEdge {
    /// Prepares a picture. `gain` is a force per grey level per pixel and pixel.
    ///
    /// # Errors
    /// What [`edge_force`](crate::edge_force) refuses.
    pub fn new(
        image: &Grid,
        smoothing: Smoothing,
        polarity: Polarity,
        gain: f64,
    ) -> Result<Self, FieldError> {
        crate::error::positive("gain", gain)?;
        smoothing.validate()?;
        let (x, y) = gradient(&smoothing.apply(&admit(image, 1.0)?));
        Ok(Self {
            gradient: ForceField::from_components(&x, &y)?,
            polarity,
            gain,
        })
    }

    /// The gradient of the smoothed picture.
    #[must_use]
    pub const fn gradient(&self) -> &ForceField {
        &self.gradient
    }

    /// The gain.
    #[must_use]
    pub const fn gain(&self) -> f64 {
        self.gain
    }

    /// The energy of a point whose outward normal is `normal`.
    #[must_use]
    pub fn energy(&self, p: DVec2, normal: DVec2) -> f64 {
        let along = self.gradient.sample(p, Interpolation::Bicubic).dot(normal);
        -self.gain
            * match self.polarity {
                Polarity::DarkToBright => along.max(0.0),
                Polarity::BrightToDark => (-along).max(0.0),
                Polarity::Either => along.abs(),
            }
    }

    /// The force on a point whose outward normal is `normal`: minus the gradient of [`SignedEdge::energy`].
    ///
    /// Bicubic, so it is continuous but for the kink where the edge's contrast changes sign.
    #[must_use]
    pub fn at(&self, p: DVec2, normal: DVec2) -> DVec2 {
        let (gradient, slope): (DVec2, DMat2) =
            self.gradient.sample_with_slope(p, Interpolation::Bicubic);
        let along = gradient.dot(normal);
        let sign = match self.polarity {
            Polarity::DarkToBright if along > 0.0 => 1.0,
            Polarity::BrightToDark if along < 0.0 => -1.0,
            Polarity::Either if along > 0.0 => 1.0,
            Polarity::Either if along < 0.0 => -1.0,
            _ => 0.0,
        };
        self.gain * sign * (slope.transpose() * normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bright from x = 10 to x = 20.
    fn bar() -> Grid {
        Grid::from_shape_fn(
            (30, 31),
            |(_, x)| if (10..=20).contains(&x) { 100.0 } else { 20.0 },
        )
    }

    fn signed(polarity: Polarity) -> SignedEdge {
        SignedEdge::new(&bar(), Smoothing::Binomial(4), polarity, 1.0).unwrap()
    }

    #[test]
    fn each_polarity_sees_its_own_edge_only() {
        // going right: dark to bright at 9.5, bright to dark at 20.5
        let (left, right) = (DVec2::new(8.0, 15.0), DVec2::new(22.0, 15.0));
        let up = signed(Polarity::DarkToBright);
        assert!(up.at(left, DVec2::X).x > 1.0 && up.at(right, DVec2::X) == DVec2::ZERO);
        let down = signed(Polarity::BrightToDark);
        assert!(down.at(right, DVec2::X).x < -1.0 && down.at(left, DVec2::X) == DVec2::ZERO);
        let either = signed(Polarity::Either);
        assert_eq!(either.at(left, DVec2::X), up.at(left, DVec2::X));
        assert_eq!(either.at(right, DVec2::X), down.at(right, DVec2::X));
        // turning the normal turns the polarity
        assert_eq!(up.at(right, DVec2::NEG_X), down.at(right, DVec2::X));
        // an edge seen from its end is none
        assert!(either.at(left, DVec2::Y).length() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_force_is_minus_the_gradient_of_the_energy(
            (x, y) in (0.1..29.9_f64, 0.1..28.9_f64), angle in 0.0..6.3_f64,
        ) {
            let image = Grid::from_shape_fn((30, 31), |(y, x)| ((x * 37 + y * 101 + x * y) % 97) as f64);
            let normal = DVec2::from_angle(angle);
            let p = DVec2::new(x, y);
            for polarity in [Polarity::DarkToBright, Polarity::BrightToDark, Polarity::Either] {
                let edge = SignedEdge::new(&image, Smoothing::Gaussian(1.0), polarity, 2.0).unwrap();
                let step = 1e-6;
                let slope = |axis: DVec2| {
                    (edge.energy(p + step * axis, normal) - edge.energy(p - step * axis, normal)) / (2.0 * step)
                };
                // not across the kink of s(d)
                prop_assume!(edge.gradient.sample(p, Interpolation::Bicubic).dot(normal).abs() > 1e-3);
                let expected = -DVec2::new(slope(DVec2::X), slope(DVec2::Y));
                // forces of order 50; slopes have kinks at pixels, which the quotient smears over 1e-6
                prop_assert!((edge.at(p, normal) - expected).length() < 1e-3, "{}", expected);
            }
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        let new = |smoothing, gain| SignedEdge::new(&bar(), smoothing, Polarity::Either, gain);
        assert!(
            new(Smoothing::Gaussian(0.0), 1.0).is_err()
                && new(Smoothing::Binomial(1), 0.0).is_err()
        );
    }
}
