//! Kinds that climb a strength P: `F = gain · ∇P`, the gradient of the energy `−gain · P`.

use std::sync::Arc;

use field::{CoarseToFine, EdgeForce, ForceField, Line, Polarity, SignedEdge, Smoothing};
use snake::{Acting, ImageForce, Sampling, Schedule, SignedEdgeForce};

use super::{At, Made, NORMAL_AT_0, NORMAL_AT_1, above_nothing};
use crate::SceneError;
use crate::file::{
    CoarseToFineText, EdgeText, LineText, PolarityText, ScalesText, ShadeText, StrengthText,
    TerminationText,
};
use crate::meaning::smoothing;

/// What is smoothed already.
const AS_IT_IS: Smoothing = Smoothing::Binomial(0);

/// σ of an edge force unless given: that of the report's twenty passes.
pub(super) const USUAL_SIGMA: f64 = 3.162_277_660_168_379_5;

/// The most scales of one force: as many smoothings of the picture.
const MOST_SCALES: usize = 32;

impl At<'_> {
    pub(super) fn edge(&self, text: &EdgeText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, USUAL_SIGMA)?;
        let gain = self.edge_gain(text.strength, sigma, self.sight.contrast())?;
        self.climbing(&self.edge_strength(sigma)?, gain)
    }

    /// The same field for a curve to feel, without its energy and so without all of it.
    pub(super) fn felt_edge(&self, text: &EdgeText) -> Result<ForceField, SceneError> {
        let sigma = text.sigma.unwrap_or(USUAL_SIGMA);
        let (key, smoothing) = (self.key("sigma"), Smoothing::Gaussian(sigma));
        smoothing.validate().map_err(|e| SceneError::key(&key, e))?;
        let gain = self.edge_gain(text.strength, sigma, self.sight.contrast())?;
        let rule = EdgeForce { smoothing, gain };
        self.sight.edge_field(rule, [&key, self.key])
    }

    /// Edges of one polarity, by the curve's own normal.
    pub(super) fn signed_edge(&self, text: &EdgeText) -> Result<SignedEdgeForce, SceneError> {
        let sigma = self.sigma(text.sigma, USUAL_SIGMA)?;
        let gain = self.edge_gain(text.strength, sigma, self.sight.contrast())?;
        let polarity = match text.polarity {
            Some(PolarityText::DarkToBright) => Polarity::DarkToBright,
            Some(PolarityText::BrightToDark) => Polarity::BrightToDark,
            Some(PolarityText::Either) | None => Polarity::Either,
        };
        let smoothed = self.smoothed(sigma)?;
        let edge = SignedEdge::new(&smoothed, AS_IT_IS, polarity, gain).map_err(self.refuse())?;
        Ok(SignedEdgeForce::new(Arc::new(edge)))
    }

    /// |∇(G ∗ I)| over what counts.
    pub(super) fn edge_strength(&self, sigma: f64) -> Result<field::Grid, SceneError> {
        let rule = EdgeForce {
            smoothing: AS_IT_IS,
            gain: 1.0,
        };
        let stages = field::edge_stages(&self.smoothed(sigma)?, &rule);
        Ok(stages.map_err(self.refuse())?.strength)
    }

    /// The gain at which an edge as high as `contrast` pulls with the strength asked for: its force is at its
    /// strongest `gain · contrast · φ(1)/σ²`.
    fn edge_gain(
        &self,
        strength: Option<f64>,
        sigma: f64,
        contrast: f64,
    ) -> Result<f64, SceneError> {
        Ok(self.pull(strength)? * sigma * sigma / (NORMAL_AT_1 * contrast))
    }

    pub(super) fn color_edge(&self, text: &StrengthText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, USUAL_SIGMA)?;
        let picture = self.sight.picture;
        let (mut smoothed, mut squares) = (Vec::new(), 0.0);
        for channel in picture.channels() {
            let contrast = picture.contrast(&channel);
            squares += contrast * contrast;
            let masked = picture.masked(&channel).map_err(self.refuse())?;
            let smooth = masked.smoothed(Smoothing::Gaussian(sigma));
            smoothed.push(smooth.map_err(self.refuse())?);
        }
        let gain = self.edge_gain(text.strength, sigma, above_nothing(squares.sqrt()))?;
        let strength = field::color_edge_strength(&smoothed, AS_IT_IS).map_err(self.refuse())?;
        self.climbing(&strength, gain)
    }

    /// Several σ, each checked against the size of the picture.
    pub(super) fn sigmas<'a>(&self, sigmas: &'a [f64]) -> Result<&'a [f64], SceneError> {
        let key = self.key("sigmas");
        if sigmas.is_empty() || sigmas.len() > MOST_SCALES {
            let message = format!("1 to {MOST_SCALES} numbers would do, got {}", sigmas.len());
            return Err(SceneError::key(&key, message));
        }
        for &sigma in sigmas {
            smoothing(&key, Smoothing::Gaussian(sigma), self.sight.picture.size())?;
        }
        Ok(sigmas)
    }

    pub(super) fn scales(&self, text: &ScalesText) -> Result<Made, SceneError> {
        let usual = vec![8.0, 4.0, 2.0];
        let sigmas = self.sigmas(text.sigmas.as_ref().unwrap_or(&usual))?;
        let finest = sigmas.iter().copied().fold(f64::INFINITY, f64::min);
        // the strength of a scale counts √σ times
        let gain = self.edge_gain(text.strength, finest, self.sight.contrast())? / finest.sqrt();
        let mut strength = field::Grid::zeros(self.sight.picture.levels().dim());
        for &sigma in sigmas {
            let factor = sigma.sqrt();
            strength.zip_mut_with(&self.edge_strength(sigma)?, |most, &p| {
                *most = most.max(factor * p);
            });
        }
        self.climbing(&strength, gain)
    }

    /// A force for each scale, coarse first; each is held, then fades over half that time while the next comes in.
    pub(super) fn coarse_to_fine(
        &self,
        text: &CoarseToFineText,
    ) -> Result<Vec<Acting>, SceneError> {
        let usual = vec![16.0, 8.0, 4.0, 2.0];
        let sigmas = text.sigmas.as_ref().unwrap_or(&usual);
        let key = self.key("sigmas");
        if sigmas.is_empty() || sigmas.len() > MOST_SCALES {
            let message = format!("1 to {MOST_SCALES} numbers would do, got {}", sigmas.len());
            return Err(SceneError::key(&key, message));
        }
        let falls = |pair: &[f64]| pair[0] > pair[1];
        if !sigmas.windows(2).all(falls) {
            let message = "must fall from each to the next; [16.0, 8.0, 4.0, 2.0] would do";
            return Err(SceneError::key(&key, message));
        }
        let hold = self.above_zero("hold", text.hold, 10.0)?;
        let blur = match text.blur {
            Some(blur) if !(blur.is_finite() && blur >= 0.0) => {
                let message = format!("must be finite and at least 0, got {blur}");
                return Err(SceneError::key(&self.key("blur"), message));
            }
            blur => blur.unwrap_or(1.0),
        };
        let finest = sigmas.last().copied().unwrap_or(1.0);
        let width = (finest * finest + blur * blur + 2.0 / 3.0).sqrt();
        let rule = CoarseToFine {
            sigmas: sigmas.clone(),
            gain: self.edge_gain(text.strength, width, self.sight.contrast())?,
            blur,
        };
        let rules = rule.rules().map_err(|e| SceneError::key(&key, e))?;
        let last = rules.len() - 1;
        let mut list = Vec::new();
        for (i, rule) in rules.into_iter().enumerate() {
            let field = Arc::new(self.sight.edge_field(rule, [&key, self.key])?);
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
                acting.scheduled(schedule.map_err(|e| SceneError::key(&self.key("hold"), e))?)
            });
        }
        Ok(list)
    }

    pub(super) fn line(&self, text: &LineText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, 2.0)?;
        let line = match text.shade {
            Some(ShadeText::Dark) => Line::Dark,
            Some(ShadeText::Bright) | None => Line::Bright,
        };
        let smoothed = self.smoothed(sigma)?;
        let strength = field::line_strength(&smoothed, AS_IT_IS, line).map_err(self.refuse())?;
        // the steepest slope of a step of that height
        let slope = NORMAL_AT_0 * self.sight.contrast() / sigma;
        self.climbing(&strength, self.pull(text.strength)? / slope)
    }

    pub(super) fn termination(&self, text: &TerminationText) -> Result<Made, SceneError> {
        let sigma = self.sigma(text.sigma, 2.0)?;
        let share = self.above_zero("floor", text.floor, 0.1)?;
        // a share of the steepest slope of an edge as high as the contrast
        let floor = share * NORMAL_AT_0 * self.sight.contrast() / sigma;
        let smoothed = self.smoothed(sigma)?;
        let strength = field::termination_strength(&smoothed, AS_IT_IS, floor);
        let strength = strength.map_err(self.refuse())?;
        // level lines turn within about σ, and that turn is σ wide
        self.climbing(&strength, self.pull(text.strength)? * sigma * sigma)
    }
}
