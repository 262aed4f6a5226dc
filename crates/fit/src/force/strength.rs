//! Kinds that climb a strength P: `F = gain · ∇P`, the gradient of the energy `−gain · P`.

use std::sync::Arc;

use field::{EdgeForce, ForceField, Grid, Line as Shade, Polarity, SignedEdge, Smoothing};
use snake::{Acting, ImageForce, Sampling, Schedule, SignedEdgeForce};

use super::{
    CoarseToFine, ColorEdge, Edge, ForceError, ForceKey, Line, Made, NORMAL_AT_0, NORMAL_AT_1,
    Scales, Sight, Termination, above_nothing, above_zero, by, checked, pull,
};
use crate::Problem;

/// What is smoothed already.
const AS_IT_IS: Smoothing = Smoothing::Binomial(0);

/// The most scales of one force: as many smoothings of the picture.
const MOST_SCALES: usize = 32;

impl Sight {
    pub(super) fn edge(&self, edge: &Edge) -> Result<Made, ForceError> {
        let sigma = self.sigma(edge.sigma)?;
        let gain = edge_gain(edge.strength, sigma, self.contrast())?;
        self.climbing(&self.edge_strength(sigma)?, gain)
    }

    /// The same field for a curve to feel, without its energy and so without all of it.
    pub(super) fn felt_edge(&self, edge: &Edge) -> Result<ForceField, ForceError> {
        let sigma = edge.sigma;
        let smoothing = Smoothing::Gaussian(sigma);
        smoothing.validate().map_err(by(ForceKey::Sigma))?;
        let gain = edge_gain(edge.strength, sigma, self.contrast())?;
        let rule = EdgeForce { smoothing, gain };
        self.edge_field_by(rule, ForceKey::Sigma)
    }

    /// Edges of one polarity, by the curve's own normal.
    pub(super) fn signed_edge(&self, edge: &Edge) -> Result<SignedEdgeForce, ForceError> {
        let sigma = self.sigma(edge.sigma)?;
        let gain = edge_gain(edge.strength, sigma, self.contrast())?;
        let polarity = edge.polarity.unwrap_or(Polarity::Either);
        let smoothed = self.smoothed(sigma)?;
        let edge =
            SignedEdge::new(&smoothed, AS_IT_IS, polarity, gain).map_err(by(ForceKey::All))?;
        Ok(SignedEdgeForce::new(Arc::new(edge)))
    }

    /// |∇(G ∗ I)| over what counts.
    pub(super) fn edge_strength(&self, sigma: f64) -> Result<Grid, ForceError> {
        let rule = EdgeForce {
            smoothing: AS_IT_IS,
            gain: 1.0,
        };
        let stages = field::edge_stages(&self.smoothed(sigma)?, &rule);
        Ok(stages.map_err(by(ForceKey::All))?.strength)
    }

    pub(super) fn color_edge(&self, edge: &ColorEdge) -> Result<Made, ForceError> {
        let sigma = self.sigma(edge.sigma)?;
        let image = &self.image;
        let (mut smoothed, mut squares) = (Vec::new(), 0.0);
        for channel in image.pixels().channels() {
            let contrast = image.spread(&channel);
            squares += contrast * contrast;
            let masked = image.masked(&channel).map_err(by(ForceKey::All))?;
            let smooth = masked.smoothed(Smoothing::Gaussian(sigma));
            smoothed.push(smooth.map_err(by(ForceKey::All))?);
        }
        let gain = edge_gain(edge.strength, sigma, above_nothing(squares.sqrt()))?;
        let strength =
            field::color_edge_strength(&smoothed, AS_IT_IS).map_err(by(ForceKey::All))?;
        self.climbing(&strength, gain)
    }

    /// Several σ, each checked against the size of the image.
    pub(super) fn sigmas<'a>(&self, sigmas: &'a [f64]) -> Result<&'a [f64], ForceError> {
        how_many(sigmas)?;
        for &sigma in sigmas {
            checked(ForceKey::Sigmas, sigma, self.image.size())?;
        }
        Ok(sigmas)
    }

    pub(super) fn scales(&self, scales: &Scales) -> Result<Made, ForceError> {
        let sigmas = self.sigmas(&scales.sigmas)?;
        let finest = sigmas.iter().copied().fold(f64::INFINITY, f64::min);
        // the strength of a scale counts √σ times
        let gain = edge_gain(scales.strength, finest, self.contrast())? / finest.sqrt();
        let (width, height) = self.image.size();
        let mut strength = Grid::zeros((height, width));
        for &sigma in sigmas {
            let factor = sigma.sqrt();
            strength.zip_mut_with(&self.edge_strength(sigma)?, |most, &p| {
                *most = most.max(factor * p);
            });
        }
        self.climbing(&strength, gain)
    }

    /// A force for each scale, coarse first; each is held, then fades over half that time while the
    /// next comes in.
    pub(super) fn coarse_to_fine(&self, scales: &CoarseToFine) -> Result<Vec<Acting>, ForceError> {
        let sigmas = &scales.sigmas;
        how_many(sigmas)?;
        let falls = |pair: &[f64]| pair[0] > pair[1];
        if !sigmas.windows(2).all(falls) {
            let message = "must fall from each to the next, as [16.0, 8.0, 4.0, 2.0] do";
            let problem = Problem::Other(message.to_owned());
            return Err(ForceError::new(ForceKey::Sigmas, problem));
        }
        let hold = above_zero(ForceKey::Hold, scales.hold)?;
        let blur = Problem::at_least_zero(scales.blur)
            .map_err(|problem| ForceError::new(ForceKey::Blur, problem))?;
        let finest = sigmas.last().copied().unwrap_or(1.0);
        let width = (finest * finest + blur * blur + 2.0 / 3.0).sqrt();
        let rule = field::CoarseToFine {
            sigmas: sigmas.clone(),
            gain: edge_gain(scales.strength, width, self.contrast())?,
            blur,
        };
        let rules = rule.rules().map_err(by(ForceKey::Sigmas))?;
        let last = rules.len() - 1;
        let mut list = Vec::new();
        for (i, rule) in rules.into_iter().enumerate() {
            let field = Arc::new(self.edge_field_by(rule, ForceKey::Sigmas)?);
            let acting = Acting::new(ImageForce::new(field, Sampling::Bilinear));
            #[expect(clippy::cast_precision_loss, reason = "at most 32 scales")]
            let begin = i as f64 * hold;
            let mut points = Vec::new();
            if i > 0 {
                points.extend([(begin - 0.5 * hold, 0.0), (begin, 1.0)]);
            }
            if i < last {
                points.extend([(begin + 0.5 * hold, 1.0), (begin + hold, 0.0)]);
            }
            list.push(if points.is_empty() {
                acting // one scale: always
            } else {
                let schedule = Schedule::new(points);
                acting.scheduled(schedule.map_err(|e| ForceError::new(ForceKey::Hold, e))?)
            });
        }
        Ok(list)
    }

    pub(super) fn line(&self, line: &Line) -> Result<Made, ForceError> {
        let sigma = self.sigma(line.sigma)?;
        let smoothed = self.smoothed(sigma)?;
        let shade: Shade = line.shade;
        let strength =
            field::line_strength(&smoothed, AS_IT_IS, shade).map_err(by(ForceKey::All))?;
        // the steepest slope of a step of that height
        let slope = NORMAL_AT_0 * self.contrast() / sigma;
        self.climbing(&strength, pull(line.strength)? / slope)
    }

    pub(super) fn termination(&self, termination: &Termination) -> Result<Made, ForceError> {
        let sigma = self.sigma(termination.sigma)?;
        let share = above_zero(ForceKey::Floor, termination.floor)?;
        // a share of the steepest slope of an edge as high as the contrast
        let floor = share * NORMAL_AT_0 * self.contrast() / sigma;
        let smoothed = self.smoothed(sigma)?;
        let strength = field::termination_strength(&smoothed, AS_IT_IS, floor);
        let strength = strength.map_err(by(ForceKey::All))?;
        // level lines turn within about σ, and that turn is σ wide
        self.climbing(&strength, pull(termination.strength)? * sigma * sigma)
    }
}

/// The gain at which an edge as high as `contrast` pulls with the strength asked for: its force is
/// at its strongest `gain · contrast · φ(1)/σ²`.
fn edge_gain(strength: f64, sigma: f64, contrast: f64) -> Result<f64, ForceError> {
    Ok(pull(strength)? * sigma * sigma / (NORMAL_AT_1 * contrast))
}

/// Refuse no scale at all, and more than there is time for.
fn how_many(sigmas: &[f64]) -> Result<(), ForceError> {
    if sigmas.is_empty() || sigmas.len() > MOST_SCALES {
        let problem = Problem::Count {
            least: 1,
            most: MOST_SCALES as u64,
            got: sigmas.len() as u64,
        };
        return Err(ForceError::new(ForceKey::Sigmas, problem));
    }
    Ok(())
}
