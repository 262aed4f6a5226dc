//! The numbers behind a fast field: one short filter for twenty passes and a derivative.

use crate::edge::EdgeForce;
use crate::error::{FieldError, positive};
use crate::grid::reasonable_passes;
use crate::smooth::{Smoothing, gaussian_weights};

/// What the fast pipeline computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recipe {
    /// [`report_force`](crate::report_force) with these numbers.
    Report {
        /// Binomial passes along each component's own axis.
        passes: u32,
        /// Factor on the image; the report's display has 0.15.
        scale: f64,
        /// Factor at the end; the report has 10.
        gain: f64,
    },
    /// [`edge_force`](crate::edge_force) with this rule.
    Edge(EdgeForce),
}

impl Recipe {
    /// Refuses what [`report_force`](crate::report_force) and [`edge_force`](crate::edge_force) refuse.
    ///
    /// # Errors
    /// A scale or gain that is not above 0, an absurd smoothing.
    pub fn validate(&self) -> Result<(), FieldError> {
        match *self {
            Self::Report {
                passes,
                scale,
                gain,
            } => {
                positive("scale", scale)?;
                positive("gain", gain)?;
                reasonable_passes(passes)
            }
            Self::Edge(EdgeForce { smoothing, gain }) => {
                positive("gain", gain)?;
                smoothing.validate()
            }
        }
    }
}

/// The widest filter the tiles hold: σ ≈ 18 px. Beyond it the `f64` pipeline does the work.
pub(super) const LARGEST_RADIUS: usize = 96;

/// Weights may be dropped from a filter's ends while they sum to less than this share of all.
///
/// About two roundings of an `f32`.
const DROPPED: f64 = 1.5e-7;

/// The filters of a recipe, in `f32`, every constant factor folded in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    pub(super) kind: Kind,
    /// Reach of the filter, on either side.
    pub(super) radius: usize,
    /// No pixel may be larger: squares of what follows would overflow.
    pub(super) largest_pixel: f32,
}

/// Which tile kernel, with its weights.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// Odd weights for distances 1, 2, …: smoothing and first difference in one.
    Report { odd: Vec<f32> },
    /// Even weights for distances 0, 1, …: along x, and along y with all the factors.
    Edge { even_x: Vec<f32>, even_y: Vec<f32> },
}

impl Plan {
    /// The filters of a valid recipe, or `None` if they are too wide for a tile.
    pub(super) fn new(recipe: &Recipe) -> Option<Self> {
        let (kind, factor) = match *recipe {
            Recipe::Report {
                passes,
                scale,
                gain,
            } => {
                let even = shortened(binomial_weights(passes), 1);
                // (I(x+1) − I(x−1)) of the smoothed line, in one sum over pairs
                let weight = |k: usize| even.get(k).copied().unwrap_or(0.0);
                let odd: Vec<f64> = (1..=even.len())
                    .map(|k| weight(k - 1) - weight(k + 1))
                    .collect();
                // ¼ ¼ from the two averages across
                let factor = scale * gain / 16.0;
                (
                    Kind::Report {
                        odd: single(&shortened(odd, 0), factor),
                    },
                    factor * 16.0,
                )
            }
            Recipe::Edge(EdgeForce { smoothing, gain }) => {
                let weights = match smoothing {
                    Smoothing::Binomial(passes) => binomial_weights(passes),
                    Smoothing::Gaussian(sigma) => gaussian_weights(sigma),
                };
                let even = normalised(shortened(weights, 1));
                // two halved masks with their averages across: (½ · ¼)²
                let kind = Kind::Edge {
                    even_x: single(&even, 1.0),
                    even_y: single(&even, gain / 64.0),
                };
                (kind, gain)
            }
        };
        let radius = match &kind {
            Kind::Report { odd } => odd.len(),
            Kind::Edge { even_x, .. } => even_x.len() - 1,
        };
        #[expect(clippy::cast_possible_truncation, reason = "between 0 and 1e17")]
        let largest_pixel = (1e17 / factor.max(1.0)) as f32;
        (radius <= LARGEST_RADIUS).then_some(Self {
            kind,
            radius,
            largest_pixel,
        })
    }
}

/// Weights of `passes` times [¼ ½ ¼], center first: C(2p, p + k) / 4^p.
///
/// By the ratio of neighbours, so for any number of passes; relative error a few roundings a step.
fn binomial_weights(passes: u32) -> Vec<f64> {
    let p = f64::from(passes);
    let mut weight: f64 = (1..=passes).map(|i| 1.0 - 0.5 / f64::from(i)).product();
    let mut weights = vec![weight];
    for k in 1..=passes {
        weight *= (p - f64::from(k) + 1.0) / (p + f64::from(k));
        if weight < f64::MIN_POSITIVE {
            break;
        }
        weights.push(weight);
    }
    weights
}

/// Drops weights from the far end while all dropped stay below [`DROPPED`] of the sum of magnitudes.
///
/// `singles` weights at the front stand for one sample, the others for two.
fn shortened(mut weights: Vec<f64>, singles: usize) -> Vec<f64> {
    let sum: f64 = weights
        .iter()
        .enumerate()
        .map(|(k, w)| w * if k < singles { 1.0 } else { 2.0 })
        .sum();
    let mut dropped = 0.0;
    while weights.len() > 1 {
        dropped += 2.0 * weights[weights.len() - 1];
        if dropped > DROPPED * sum {
            break;
        }
        weights.pop();
    }
    weights
}

/// Weights of a smoothing filter, center first, summing to 1 over both sides.
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    for w in &mut weights {
        *w /= sum;
    }
    weights
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
fn single(weights: &[f64], factor: f64) -> Vec<f32> {
    weights.iter().map(|w| (w * factor) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twenty_passes_and_a_derivative_are_a_filter_of_33_or_35_taps() {
        let plan = Plan::new(&Recipe::Report {
            passes: 20,
            scale: 0.15,
            gain: 10.0,
        })
        .unwrap();
        assert!((16..=17).contains(&plan.radius), "{}", plan.radius);
    }

    #[test]
    fn the_odd_weights_measure_twice_the_slope() {
        for passes in [0, 1, 5, 20, 200] {
            let Kind::Report { odd } = Plan::new(&Recipe::Report {
                passes,
                scale: 16.0,
                gain: 1.0,
            })
            .unwrap()
            .kind
            else {
                panic!("not the report's")
            };
            // over the ramp I(x) = x: Σ w_k · 2k = 2; what is dropped and rounded is 1e-6 of it
            let slope: f64 = (1..)
                .zip(&odd)
                .map(|(k, &w)| f64::from(w) * 2.0 * f64::from(k))
                .sum();
            assert!((slope - 2.0).abs() < 2e-5, "{passes}: {slope}");
        }
    }

    #[test]
    fn binomial_weights_are_pascals() {
        assert_eq!(binomial_weights(0), [1.0]);
        assert_eq!(binomial_weights(1), [0.5, 0.25]);
        assert_eq!(binomial_weights(2), [6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0]);
        let many = binomial_weights(5000);
        assert!((many[0] + 2.0 * many[1..].iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_filter_too_wide_for_a_tile_has_no_plan() {
        let rule = |sigma| EdgeForce {
            smoothing: Smoothing::Gaussian(sigma),
            gain: 1.0,
        };
        assert!(Plan::new(&Recipe::Edge(rule(17.0))).is_some());
        assert!(Plan::new(&Recipe::Edge(rule(30.0))).is_none());
    }
}
