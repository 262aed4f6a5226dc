//! Kinds that carry edges far: to the nearest one, or by flow and convolution.

use field::{Falloff, FlowRule, ForceField, Grid, Smoothing, VectorFlow};

use super::{At, Made, NORMAL_AT_0, number};
use crate::SceneError;
use crate::file::{DistanceText, GvfText, VfcText};
use crate::limits::MOST_CONVOLUTION;

/// Where the pull of a flow levels off, as a share of its largest.
const USUAL_KNEE: f64 = 0.1;

/// How steep an edge is at least, as a share of the steepest of one as high as the contrast.
const USUAL_THRESHOLD: f64 = 0.25;

impl At<'_> {
    pub(super) fn distance(&self, text: &DistanceText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, 2.0)?;
        let threshold = self.threshold(text.threshold, sigma)?;
        let gain = self.pull(text.strength)?;
        let (width, height) = self.sight.picture.size();
        let far = (width + height) as f64;
        let reach = self.above_zero("reach", text.reach, far)?;
        let smoothed = self.smoothed(sigma)?;
        let edges = field::edge_pixels(&smoothed, Smoothing::Binomial(0), threshold);
        let mut edges = edges.map_err(self.refuse())?;
        if let Some(valid) = self.sight.picture.valid() {
            edges.zip_mut_with(valid, |edge, &counts| *edge &= counts);
        }
        let field = field::distance_force(&edges, gain, reach).map_err(self.refuse())?;
        let distance = field::squared_distance(&edges);
        Ok(Made {
            field: self
                .sight
                .grey(self.key)?
                .cut(&field)
                .map_err(self.refuse())?,
            energy: Some(distance.mapv(|d| gain * d.sqrt().min(reach.min(far)))),
        })
    }

    /// A slope as a share of the steepest of an edge as high as the contrast.
    fn threshold(&self, given: Option<f64>, sigma: f64) -> Result<f64, SceneError> {
        let share = self.above_zero("threshold", given, USUAL_THRESHOLD)?;
        Ok(share * NORMAL_AT_0 * self.sight.contrast() / sigma)
    }

    /// Edges from 0 to 1: `P² / (P² + T²)`, half at the threshold T, so that a weak edge is not outdone by a
    /// strong one far off, and noise stays next to nothing.
    fn edge_map(&self, given: Option<f64>, sigma: f64) -> Result<Grid, SceneError> {
        let threshold = self.threshold(given, sigma)?;
        let strength = self.edge_strength(sigma)?;
        Ok(strength.mapv(|p| {
            let square = (p / threshold) * (p / threshold);
            // an infinite square is 1
            if square > 1e15 {
                1.0
            } else {
                square / (square + 1.0)
            }
        }))
    }

    pub(super) fn gvf(&self, text: &GvfText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, 2.0)?;
        let rule = match (text.smoothness, text.spread) {
            (Some(_), Some(_)) => {
                let message = "give smoothness, or spread for the generalised flow, not both";
                return Err(SceneError::key(&self.key("spread"), message));
            }
            (_, Some(spread)) => FlowRule::Generalised {
                spread: number::above_zero(&self.key("spread"), spread)?,
            },
            (smoothness, None) => FlowRule::Plain {
                smoothness: self.above_zero("smoothness", smoothness, 0.2)?,
            },
        };
        let flow = VectorFlow {
            rule,
            residual: 1e-6,
        };
        let flow = field::vector_flow(&self.edge_map(text.threshold, sigma)?, &flow)
            .map_err(self.refuse())?;
        self.leveled(&flow.field, text.strength, text.knee)
    }

    pub(super) fn vfc(&self, text: &VfcText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, 2.0)?;
        let falloff = match (text.exponent, text.width) {
            (Some(_), Some(_)) => {
                let message = "give exponent, or width for a Gaussian falloff, not both";
                return Err(SceneError::key(&self.key("width"), message));
            }
            (_, Some(width)) => Falloff::Gaussian {
                width: number::above_zero(&self.key("width"), width)?,
            },
            (exponent, None) => Falloff::Power {
                exponent: self.above_zero("exponent", exponent, 3.0)?,
            },
        };
        let (width, height) = self.sight.picture.size();
        let far = width.max(height) as f64;
        let reach = self.above_zero("reach", text.reach, far)?.min(far);
        let side = |length: usize| 2.0_f64.powf((length as f64 + reach).log2().ceil());
        if side(width) * side(height) > MOST_CONVOLUTION {
            let message = format!(
                "{reach} pixels on a picture of {width}×{height} take too much memory; a shorter one would do"
            );
            return Err(SceneError::key(&self.key("reach"), message));
        }
        let map = self.edge_map(text.threshold, sigma)?;
        let field = field::vector_convolution(&map, falloff, reach).map_err(self.refuse())?;
        self.leveled(&field, text.strength, text.knee)
    }

    /// A field whose pulls, weak or strong, become alike: `V / √(|V|² + (knee · largest)²)`, of length 1 at most.
    ///
    /// Flows fall off so fast that far from an edge nothing would move; which way they point is what counts there.
    fn leveled(
        &self,
        field: &ForceField,
        strength: Option<f64>,
        knee: Option<f64>,
    ) -> Result<Made, SceneError> {
        let pull = self.pull(strength)?;
        let knee = self.above_zero("knee", knee, USUAL_KNEE)?;
        let largest = field.largest();
        let (mut x, mut y) = field.components();
        if largest > 0.0 {
            let at = pull * 1.0_f64.hypot(knee);
            ndarray::Zip::from(&mut x).and(&mut y).for_each(|x, y| {
                let (a, b) = (*x / largest, *y / largest);
                let factor = at / a.hypot(b).hypot(knee);
                (*x, *y) = (a * factor, b * factor);
            });
        }
        let field = ForceField::from_components(&x, &y).map_err(self.refuse())?;
        Ok(Made {
            field: self
                .sight
                .grey(self.key)?
                .cut(&field)
                .map_err(self.refuse())?,
            energy: None,
        })
    }
}
