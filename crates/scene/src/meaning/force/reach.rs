//! Kinds that carry edges far: to the nearest one, or by flow and convolution.

use field::{Canny, Falloff, FlowRule, ForceField, Grid, Smoothing, VectorFlow};
use glam::DVec2;

use super::super::world::work;
use super::{At, Made, NORMAL_AT_0, number};
use crate::SceneError;
use crate::file::{DistanceText, GvfText, VfcText};
use crate::limits::MOST_CONVOLUTION;

/// An edge goes on while it is this share of what it must be to begin: Canny has thresholds in a ratio of two or three to one.
const LOW: f64 = 0.5;

/// How the pull of an edge pixel falls with distance: the inverse square, which Li and Acton begin with; a whole straight edge
/// then pulls by the inverse of its distance. At 1 a ring would pull nothing inside it, so it must be above that.
const USUAL_EXPONENT: f64 = 2.0;

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
        let most = reach.min(far);
        let energy = |distance: Grid| Some(distance.mapv(|d| gain * d.min(most)));
        if let Some(valid) = self.sight.picture.valid() {
            // Canny's derivatives know no mask: edges to the pixel, where pixels count
            let smoothed = self.smoothed(sigma)?;
            let edges = field::edge_pixels(&smoothed, Smoothing::Binomial(0), threshold);
            let mut edges = edges.map_err(self.refuse())?;
            edges.zip_mut_with(valid, |edge, &counts| *edge &= counts);
            let field = field::distance_force(&edges, gain, reach).map_err(self.refuse())?;
            return Ok(Made {
                field: self
                    .sight
                    .grey(self.key)?
                    .cut(&field)
                    .map_err(self.refuse())?,
                energy: energy(field::squared_distance(&edges).mapv(f64::sqrt)),
            });
        }
        let rule = Canny {
            sigma,
            high: threshold,
            low: LOW * threshold,
        };
        let levels = self.sight.picture.levels();
        let edges = field::edge_points(levels, &rule).map_err(self.refuse())?;
        let points: Vec<DVec2> = edges.iter().map(|edge| edge.position).collect();
        let field = field::point_distance_force(&points, levels.dim(), gain, reach);
        Ok(Made {
            field: field.map_err(self.refuse())?,
            energy: energy(field::distance_to_points(&points, levels.dim())),
        })
    }

    /// A slope as a share of the steepest of an edge as high as the contrast.
    fn threshold(&self, given: Option<f64>, sigma: f64) -> Result<f64, SceneError> {
        let share = self.above_zero("threshold", given, USUAL_THRESHOLD)?;
        Ok(share * NORMAL_AT_0 * self.sight.contrast() / sigma)
    }

    /// Edges from 0 to 1: `P² / (P² + T²)`, half at the threshold T, so that a weak edge is not outdone by a
    /// strong one far off, and noise stays next to nothing. It is 1 − g, with g the edge-stopping function of geodesic
    /// contours and of anisotropic diffusion.
    ///
    /// \[caselles97\], \[perona90\]
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
        // three iterates of two numbers, their coefficients and the edges beside the stages of those
        work(self.key, self.sight.picture.size(), 165)?;
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
                exponent: self.above_zero("exponent", exponent, USUAL_EXPONENT)?,
            },
        };
        let (width, height) = self.sight.picture.size();
        let far = width.max(height) as f64;
        let mut reach = self.above_zero("reach", text.reach, far)?.min(far);
        let too_large = |reach: f64| {
            let side = |length: usize| 2.0_f64.powf((length as f64 + reach).log2().ceil());
            side(width) * side(height) > MOST_CONVOLUTION
        };
        // unless it is asked for, as far as memory allows: long and narrow pictures would take that of a square
        while text.reach.is_none() && reach > 1.0 && too_large(reach) {
            reach *= 0.5;
        }
        if too_large(reach) {
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
