//! Maps: factors that the picture, or another of its size, sets the parameters by.

use std::sync::Arc;

use field::{FieldError, Grid, Map, Smoothing};
use snake::Maps;

use super::files::Files;
use super::{number, smoothing};
use crate::file::{AwayText, DampingText, MapText, ParameterText, SceneText, SourceText};
use crate::{Picture, SceneError};

/// σ of edges where none is given: that of the report. L.
const SIGMA: f64 = 3.162_277_660_168_379_5;
/// σ of the window that contrast is seen through. L.
const WINDOW: f64 = 4.0;
/// How strong an edge is from which distances count, as a share of the strongest.
const LEAST: f64 = 0.2;
/// The distance at which the share is 1. L.
const REACH: f64 = 10.0;

/// The maps of the scene's parameters.
pub(super) fn maps(
    text: &SceneText,
    picture: Option<&Picture>,
    files: &Files<'_>,
) -> Result<Maps, SceneError> {
    let mut made = Made {
        picture,
        files,
        known: Vec::new(),
    };
    let (material, densities) = (&text.material, &text.densities);
    let damping = match &densities.damping {
        DampingText::Given(given) => made.map("densities.damping", given)?,
        DampingText::Rule(_) => None,
    };
    let maps = Maps {
        tether: made.map("material.tether", &material.tether)?,
        tension: made.map("material.tension", &material.tension)?,
        rigidity: made.map("material.rigidity", &material.rigidity)?,
        mass: made.map("densities.mass", &densities.mass)?,
        damping,
        every: text.maps.every,
    };
    if !(maps.every.is_finite() && maps.every >= 0.0) {
        let message = format!("must be finite and at least 0, got {}", maps.every);
        return Err(SceneError::key("maps.every", message));
    }
    if let Some(least) = maps.mass.as_ref().map(|map| map.least())
        && least <= 0.0
    {
        let message = format!("factors of the mass must be above 0, and one is {least}");
        return Err(SceneError::key("densities.mass", message));
    }
    let divides = |upkeep: &crate::file::UpkeepText| {
        upkeep.stretch.is_some() || upkeep.least_area.is_some() || upkeep.merge.is_some()
    };
    if maps.mass.is_some() && text.upkeep.as_ref().is_some_and(divides) {
        let message = "new nodes are handed the mass of their stretch of curve, and a map gives each place its own; \
                       needed: no stretch, least-area and merge in [upkeep]";
        return Err(SceneError::key("densities.mass.map", message));
    }
    Ok(maps)
}

/// What is made, and what has been made already.
struct Made<'a> {
    picture: Option<&'a Picture>,
    files: &'a Files<'a>,
    known: Vec<(&'a MapText, Arc<Map>)>,
}

impl<'a> Made<'a> {
    fn map(&mut self, key: &str, text: &'a ParameterText) -> Result<Option<Arc<Map>>, SceneError> {
        let Some(text) = &text.map else {
            return Ok(None);
        };
        if let Some((_, map)) = self.known.iter().find(|(known, _)| *known == text) {
            return Ok(Some(Arc::clone(map)));
        }
        let whole = matches!(text.map, SourceText::File(_));
        let end = |name: &str, given: Option<f64>, usual: f64| -> Result<f64, SceneError> {
            let key = format!("{key}.{name}");
            match given {
                None if whole => Ok(usual),
                None => Err(SceneError::key(
                    &key,
                    format!("is the factor where the share is {usual}; needed: a number"),
                )),
                Some(value) if value.is_finite() && value >= 0.0 => Ok(value),
                Some(value) => {
                    let message = format!("must be finite and at least 0, got {value}");
                    Err(SceneError::key(&key, message))
                }
            }
        };
        let ends = [end("low", text.low, 0.0)?, end("high", text.high, 1.0)?];
        if let Some([from, to]) = text.range
            && !(from >= 0.0 && to > from && to.is_finite())
        {
            let message = format!("needed: two shares from 0 on that ascend, got [{from}, {to}]");
            return Err(SceneError::key(&format!("{key}.range"), message));
        }
        let source = format!("{key}.map");
        let shares = self.shares(&source, &text.map)?;
        let refuse = |error: FieldError| SceneError::key(&source, error);
        let map = match text.range {
            // a file may say more than a share
            None if whole => {
                let [low, high] = ends;
                Map::new(&shares.mapv(|share| low + share * (high - low)))
            }
            range => Map::of_shares(&shares, range.unwrap_or([0.0, 1.0]), ends),
        };
        let map = Arc::new(map.map_err(refuse)?);
        if map.least() < 0.0 {
            let message = format!("has factors down to {}; needed: at least 0", map.least());
            return Err(SceneError::key(&source, message));
        }
        self.known.push((text, Arc::clone(&map)));
        Ok(Some(map))
    }

    /// The shares of a source, one a pixel.
    fn shares(&self, key: &str, source: &SourceText) -> Result<Grid, SceneError> {
        let refuse = |error: FieldError| SceneError::key(key, error);
        if let SourceText::File(file) = source {
            return self.file(&format!("{key}.file"), file);
        }
        let Some(picture) = self.picture else {
            let message =
                "is made from the picture, and there is none; needed: [picture] or { file = … }";
            return Err(SceneError::key(key, message));
        };
        if picture.valid().is_some() {
            let message = "knows nothing of pixels that do not count; needed: { file = … }";
            return Err(SceneError::key(key, message));
        }
        let gaussian = |name: &str, given: Option<f64>, usual: f64| {
            let key = format!("{key}.{name}.sigma");
            let sigma = Smoothing::Gaussian(given.unwrap_or(usual));
            smoothing(&key, sigma, picture.size())
        };
        match source {
            SourceText::Grey => field::grey_share(picture.levels()).map_err(refuse),
            SourceText::Edge(text) => {
                let sigma = gaussian("edge", text.sigma, SIGMA)?;
                field::edge_share(picture.levels(), sigma).map_err(refuse)
            }
            SourceText::Contrast(text) => {
                let window = gaussian("contrast", text.sigma, WINDOW)?;
                field::contrast_share(picture.levels(), window).map_err(refuse)
            }
            SourceText::Distance(AwayText {
                sigma,
                least,
                reach,
            }) => {
                let sigma = gaussian("distance", *sigma, SIGMA)?;
                let within = |name: &str| format!("{key}.distance.{name}");
                let least = number::above_zero(&within("least"), least.unwrap_or(LEAST))?;
                let reach = number::above_zero(&within("reach"), reach.unwrap_or(REACH))?;
                field::distance_share(picture.levels(), sigma, least, reach).map_err(refuse)
            }
            SourceText::File(_) => Ok(Grid::zeros((0, 0))),
        }
    }

    /// A picture file of the same size: black is 0, white is 1, floats are what they are.
    fn file(&self, key: &str, file: &str) -> Result<Grid, SceneError> {
        let map = self.files.picture(file)?;
        if let Some(picture) = self.picture
            && picture.size() != map.size()
        {
            let ((a, b), (width, height)) = (map.size(), picture.size());
            let message =
                format!("has {a}×{b} pixels and the picture {width}×{height}; needed: as many");
            return Err(SceneError::key(key, message));
        }
        Ok(map.levels().mapv(|level| level / 255.0))
    }
}
