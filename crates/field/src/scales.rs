//! From coarse to fine: one field a scale, with forces that can be compared.

use crate::edge::{EdgeForce, edge_force};
use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::Grid;
use crate::smooth::Smoothing;

/// One scale of a schedule from coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// σ of the Gaussian, in pixels. The field reaches about three times as far.
    pub sigma: f64,
    /// The gain its edge force was made with.
    pub gain: f64,
    /// The corrected edge force at this scale.
    pub field: ForceField,
}

/// What a schedule of edge forces from coarse to fine is made with.
#[derive(Debug, Clone, PartialEq)]
pub struct CoarseToFine {
    /// σ of each scale in pixels, falling; halving from one to the next loses no edge.
    pub sigmas: Vec<f64>,
    /// Gain of the last, finest one.
    pub gain: f64,
    /// Blur of the picture's edges in pixels, 0 for sharp ones; [`image_scale`](crate::image_scale) tells.
    pub blur: f64,
}

impl CoarseToFine {
    /// The edge force of each scale, coarse first: for who makes the fields some other way, as by
    /// [`lazy_force`](crate::lazy_force).
    ///
    /// ```text
    /// gain_k = gain · w_k / w_last        w = σ² + blur² + 2/3
    /// ```
    ///
    /// # Errors
    /// No scales; one that is not smaller than the one before, not above 0 or absurd; a `blur` below 0; a gain that is not above 0.
    pub fn rules(&self) -> Result<Vec<EdgeForce>, FieldError> {
        let Some(&last) = self.sigmas.last() else {
            return Err(FieldError::NotPositive {
                name: "number of scales",
                value: 0.0,
            });
        };
        if self.blur < 0.0 || !self.blur.is_finite() {
            return Err(FieldError::NotPositive {
                name: "blur",
                value: self.blur,
            });
        }
        positive("gain", self.gain)?;
        for pair in self.sigmas.windows(2) {
            positive("sigma less the next one", pair[0] - pair[1])?;
        }
        let width = |sigma: f64| sigma * sigma + self.blur * self.blur + 2.0 / 3.0;
        let rule = |&sigma: &f64| {
            let smoothing = Smoothing::Gaussian(sigma);
            smoothing.validate()?;
            let gain = self.gain * width(sigma) / width(last);
            Ok(EdgeForce { smoothing, gain })
        };
        self.sigmas.iter().map(rule).collect()
    }
}

/// The corrected edge force at each scale, coarse first, as strong at a straight step at each.
///
/// ```text
/// F_k = gain_k · ∇|∇(G_k ∗ I)|        gain_k = gain · w_k / w_last        w = σ² + blur² + 2/3
/// ```
///
/// A step of contrast A pulls with at most `gain · A / (√(2πe) w)`, where w is the variance of all that widens it: the Gaussian, its own
/// blur, and a third for each of the two differences. The gains take w out. So
/// the largest force is the same at every scale, and what changes is how far it reaches and how steeply it turns round at the edge. Which scale is
/// used when is for whoever moves through them. Each field is the gradient of its own energy; to go from one to the
/// next changes the energy. O(pixels · Σ σ).
///
/// # Errors
/// What [`CoarseToFine::rules`] refuses, and [`edge_force`].
pub fn coarse_to_fine(image: &Grid, rule: &CoarseToFine) -> Result<Vec<Scale>, FieldError> {
    let scale = |(rule, &sigma): (EdgeForce, &f64)| {
        let field = edge_force(image, &rule)?;
        let gain = rule.gain;
        Ok(Scale { sigma, gain, field })
    };
    rule.rules()?
        .into_iter()
        .zip(&rule.sigmas)
        .map(scale)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::drawn;
    use glam::DVec2;

    fn rule(sigmas: &[f64], blur: f64) -> CoarseToFine {
        let (sigmas, gain) = (sigmas.to_vec(), 2.0);
        CoarseToFine { sigmas, gain, blur }
    }

    #[test]
    fn a_step_pulls_as_strongly_at_every_scale_and_farther_at_the_coarse_ones() {
        // what it is drawn with, and the pixel's own share
        let blur = (1.0_f64 + 1.0 / 12.0).sqrt();
        let step = drawn((9, 160), |p| p.x > 80.3, (140.0, 20.0), 1.0);
        let scales = coarse_to_fine(&step, &rule(&[12.0, 6.0, 3.0, 1.5], blur)).unwrap();
        let root = (std::f64::consts::TAU * 1.0_f64.exp()).sqrt();
        let expected = 2.0 * 120.0 / (root * (1.5 * 1.5 + blur * blur + 2.0 / 3.0));
        for scale in &scales {
            // the largest of all pixels, which at the finest scale stand apart by half a width
            let largest = scale.field.largest();
            assert!(
                (largest / expected - 1.0).abs() < 0.05,
                "{}: {largest} {expected}",
                scale.sigma
            );
            // a tenth of the largest force is still felt 2.5 widths away
            let far = scale.field.at(DVec2::new(80.3 - 2.5 * scale.sigma, 4.0)).x;
            assert!(far > 0.1 * largest, "{}: {far}", scale.sigma);
        }
        assert!(scales[3].field.at(DVec2::new(60.0, 4.0)).length() < 1e-9);
    }

    #[test]
    fn schedules_that_do_not_fall_are_refused() {
        let image = Grid::from_elem((5, 5), 0.1);
        for sigmas in [&[][..], &[1.0, 1.0], &[1.0, 2.0], &[2.0, 0.0], &[f64::NAN]] {
            assert!(
                coarse_to_fine(&image, &rule(sigmas, 0.0)).is_err(),
                "{sigmas:?}"
            );
        }
        assert!(coarse_to_fine(&image, &rule(&[2.0], -1.0)).is_err());
        for (height, width) in [(1, 1), (1, 40), (3, 3), (3, 100_000)] {
            let flat = Grid::from_elem((height, width), 0.1);
            for scale in coarse_to_fine(&flat, &rule(&[2.0, 1.0], 0.0)).unwrap() {
                assert!(scale.field.largest() <= 0.0);
            }
        }
    }
}
