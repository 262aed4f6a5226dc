//! Kinds that carry edges far: to the nearest one, or by flow and convolution.

use field::{Canny, Falloff, FlowRule, ForceField, Grid, Smoothing, VectorFlow};
use glam::DVec2;

use super::{
    Distance, ForceError, ForceKey, Gvf, Made, NORMAL_AT_0, Sight, Vfc, above_zero, all, by, pull,
};
use crate::Problem;
use crate::limits::{MOST_CONVOLUTION, check_work};

/// An edge goes on while it is this share of what it must be to begin: Canny has thresholds in a
/// ratio of two or three to one.
const LOW: f64 = 0.5;

impl Sight {
    pub(super) fn distance(&self, given: &Distance) -> Result<Made, ForceError> {
        let sigma = self.sigma(given.sigma)?;
        let threshold = self.slope(given.threshold, sigma)?;
        let gain = pull(given.strength)?;
        let (width, height) = self.image.size();
        let far = (width + height) as f64;
        let reach = above_zero(ForceKey::Reach, given.reach.unwrap_or(far))?;
        let most = reach.min(far);
        let energy = |distance: Grid| Some(distance.mapv(|d| gain * d.min(most)));
        if let Some(valid) = self.image.pixels().valid() {
            // Canny's derivatives know no mask: edges to the pixel, where pixels count
            let smoothed = self.smoothed(sigma)?;
            let edges = field::edge_pixels(&smoothed, Smoothing::Binomial(0), threshold);
            let mut edges = edges.map_err(by(ForceKey::All))?;
            edges.zip_mut_with(valid, |edge, &counts| *edge &= counts);
            let field = field::distance_force(&edges, gain, reach).map_err(by(ForceKey::All))?;
            return Ok(Made {
                field: self.grey()?.cut(&field).map_err(by(ForceKey::All))?,
                energy: energy(field::squared_distance(&edges).mapv(f64::sqrt)),
            });
        }
        let rule = Canny {
            sigma,
            high: threshold,
            low: LOW * threshold,
        };
        let levels = self.image.pixels().levels();
        let edges = field::edge_points(levels, &rule).map_err(by(ForceKey::All))?;
        let points: Vec<DVec2> = edges.iter().map(|edge| edge.position).collect();
        let field = field::point_distance_force(&points, levels.dim(), gain, reach);
        Ok(Made {
            field: field.map_err(by(ForceKey::All))?,
            energy: energy(field::distance_to_points(&points, levels.dim())),
        })
    }

    /// A slope as a share of the steepest of an edge as high as the contrast.
    fn slope(&self, threshold: f64, sigma: f64) -> Result<f64, ForceError> {
        let share = above_zero(ForceKey::Threshold, threshold)?;
        Ok(share * NORMAL_AT_0 * self.contrast() / sigma)
    }

    /// Edges from 0 to 1: `P² / (P² + T²)`, half at the threshold T, so that a weak edge is not
    /// outdone by a strong one far off, and noise stays next to nothing. It is 1 − g, with g the
    /// edge-stopping function of geodesic contours and of anisotropic diffusion.
    ///
    /// \[caselles97\], \[perona90\]
    fn edge_map(&self, threshold: f64, sigma: f64) -> Result<Grid, ForceError> {
        let threshold = self.slope(threshold, sigma)?;
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

    pub(super) fn gvf(&self, given: &Gvf) -> Result<Made, ForceError> {
        // three iterates of two numbers, their coefficients and the edges beside the stages of
        // those
        check_work(self.image.size(), 165).map_err(all)?;
        let sigma = self.sigma(given.sigma)?;
        let rule = given.rule;
        match rule {
            FlowRule::Plain { smoothness } => above_zero(ForceKey::Smoothness, smoothness)?,
            FlowRule::Generalised { spread } => above_zero(ForceKey::Spread, spread)?,
        };
        let flow = VectorFlow {
            rule,
            residual: 1e-6,
        };
        let flow = field::vector_flow(&self.edge_map(given.threshold, sigma)?, &flow)
            .map_err(by(ForceKey::All))?;
        self.leveled(&flow.field, given.strength, given.knee)
    }

    pub(super) fn vfc(&self, given: &Vfc) -> Result<Made, ForceError> {
        let sigma = self.sigma(given.sigma)?;
        let falloff = given.falloff;
        match falloff {
            Falloff::Power { exponent } => above_zero(ForceKey::Exponent, exponent)?,
            Falloff::Gaussian { width } => above_zero(ForceKey::Width, width)?,
        };
        let (width, height) = self.image.size();
        let far = width.max(height) as f64;
        let mut reach = above_zero(ForceKey::Reach, given.reach.unwrap_or(far))?.min(far);
        let too_large = |reach: f64| {
            let side = |length: usize| 2.0_f64.powf((length as f64 + reach).log2().ceil());
            side(width) * side(height) > MOST_CONVOLUTION
        };
        // unless it is asked for, as far as memory allows: long and narrow pictures would take that
        // of a square
        while given.reach.is_none() && reach > 1.0 && too_large(reach) {
            reach *= 0.5;
        }
        if too_large(reach) {
            let message = format!(
                "{reach} pixels on a picture of {width}×{height} take too much memory; a shorter one is needed"
            );
            return Err(ForceError::new(ForceKey::Reach, Problem::Other(message)));
        }
        let map = self.edge_map(given.threshold, sigma)?;
        let field = field::vector_convolution(&map, falloff, reach).map_err(by(ForceKey::All))?;
        self.leveled(&field, given.strength, given.knee)
    }

    /// A field whose pulls, weak or strong, become alike: `V / √(|V|² + (knee · largest)²)`, of
    /// length 1 at most.
    ///
    /// Flows fall off so fast that far from an edge nothing would move; which way they point is
    /// what counts there.
    fn leveled(&self, field: &ForceField, strength: f64, knee: f64) -> Result<Made, ForceError> {
        let pull = pull(strength)?;
        let knee = above_zero(ForceKey::Knee, knee)?;
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
        let field = ForceField::from_components(&x, &y).map_err(by(ForceKey::All))?;
        Ok(Made {
            field: self.grey()?.cut(&field).map_err(by(ForceKey::All))?,
            energy: None,
        })
    }
}
