//! One fit and its scores.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use io::Picture;
use ndarray::Array2;
use scene::fit::{Contour, Fit, Image, Options, Prepared};
use scene::snake::Outcome;
use score::{Agreement, along_normal, border, filled, iou};

use super::change::Change;
use super::clock::Clock;
use super::set::Case;
use crate::stop::Stop;

/// What lies so near is the same boundary. Pixels.
pub(super) const TOLERANCE: f64 = 2.0;

/// Standard errors that hold 95 % of a normal error.
const BAND: f64 = 1.96;

/// How far along its normal a node's truth is looked for. Pixels.
const REACH: f64 = 20.0;

/// How a fit is done.
#[derive(Debug)]
pub(super) struct Way<'a> {
    pub(super) options: Options,
    pub(super) change: Option<Change>,
    /// Whether no other thread works at the same time.
    pub(super) alone: bool,
    pub(super) stop: &'a Stop,
}

/// What is true of a picture.
#[derive(Debug)]
pub(super) struct Truth {
    pub(super) mask: Array2<bool>,
    pub(super) rings: Vec<Vec<DVec2>>,
}

/// A fit and its scores; lengths in pixels of the picture as it is.
#[derive(Debug)]
pub(super) struct Row {
    pub(super) stem: String,
    pub(super) quality: String,
    pub(super) start: Vec<DVec2>,
    pub(super) start_iou: f64,
    /// The outline found and how it agrees with the truth; None if it blew up or was refused.
    pub(super) found: Option<(Vec<DVec2>, Scores)>,
    pub(super) ending: Ending,
    /// `IoU` with the outline found on the picture as it is, where it was changed.
    pub(super) same: Option<f64>,
    /// Nodes whose band holds the truth, and nodes with a band.
    pub(super) band: [usize; 2],
    pub(super) seconds: f64,
}

/// How an outline agrees with the truth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scores {
    pub(super) iou: f64,
    pub(super) agreement: Agreement,
}

/// What the command would say of a fit.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Ending {
    /// It found an outline: exit code 0.
    Found,
    /// It is unsure, and why: exit code 1.
    Unsure(String),
    /// It refused, and why: exit code 2.
    Refused(String),
}

impl Ending {
    /// One word for it, and why.
    pub(super) fn told(&self) -> (&'static str, &str) {
        match self {
            Self::Found => ("found", ""),
            Self::Unsure(why) => ("unsure", why),
            Self::Refused(why) => ("refused", why),
        }
    }
}

impl Row {
    /// `IoU` of what was found; 0 if that is nothing.
    pub(super) fn iou(&self) -> f64 {
        self.found.as_ref().map_or(0.0, |(_, scores)| scores.iou)
    }

    /// Boundary F of what was found; 0 if that is nothing.
    pub(super) fn f(&self) -> f64 {
        self.found
            .as_ref()
            .map_or(0.0, |(_, scores)| scores.agreement.f())
    }
}

impl Truth {
    /// The truth of a mask.
    pub(super) fn of(mask: Array2<bool>) -> Self {
        let rings = border(&mask);
        Self { mask, rings }
    }

    /// Read a mask that belongs to a picture of that size.
    pub(super) fn load(path: &Path, size: (usize, usize)) -> Result<Self, String> {
        let mask = Picture::load(path).map_err(|error| error.to_string())?;
        if mask.size() != size {
            let ((a, b), (width, height)) = (mask.size(), size);
            let path = path.display();
            return Err(format!(
                "{path}: must have {width} × {height} pixels as its picture, got {a} × {b}"
            ));
        }
        let truth = Self::of(mask.levels().mapv(|level| level > 127.5));
        if truth.rings.is_empty() {
            return Err(format!(
                "{}: shows no object; needed: white pixels",
                path.display()
            ));
        }
        Ok(truth)
    }

    /// `IoU` of a closed polygon with the truth.
    pub(super) fn iou(&self, curve: &[DVec2]) -> f64 {
        let mask = filled(&[curve], self.mask.dim());
        iou(&mask, &self.mask).unwrap_or(0.0) // of one size
    }

    /// How a closed polygon agrees with it; None if the polygon has no places.
    pub(super) fn scores(&self, curve: &[DVec2]) -> Option<Scores> {
        let agreement = Agreement::of(&[curve], &self.rings, TOLERANCE).ok()?;
        let iou = self.iou(curve);
        Some(Scores { iou, agreement })
    }
}

/// How many nodes of a fit have the truth within the band that they state, and how many have a band.
pub(super) fn band<R: AsRef<[DVec2]>>(fit: &Fit, truth: &[R]) -> [usize; 2] {
    let mut counts = [0, 0];
    for (at, node) in fit.contour.points.iter().zip(&fit.nodes) {
        let Some(error) = node.error else { continue };
        let far = along_normal(*at, node.normal, truth, REACH);
        counts[0] += usize::from(far.is_some_and(|far| far.abs() <= BAND * error));
        counts[1] += 1;
    }
    counts
}

/// Fit every start of a case; one picture made ready serves them all.
///
/// # Errors
///
/// A picture or mask that cannot be read or does not fit.
pub(super) fn rows(case: &Case, way: &Way<'_>) -> Result<Vec<Row>, String> {
    let picture = Picture::load(&case.picture).map_err(|error| error.to_string())?;
    let picture = Arc::new(picture);
    let truth = Truth::load(&case.mask, picture.size())?;
    let plain = Fits::new(&Image::of(picture.clone()), way);
    let changed = match way.change {
        Some(change) => Some((change, Fits::new(&change.image(&picture)?, way))),
        None => None,
    };
    let size = picture.size();
    let mut rows = Vec::new();
    for start in &case.starts {
        if way.stop.asked() {
            break;
        }
        let mut row = Row {
            stem: case.stem.clone(),
            quality: start.quality.clone(),
            start: start.points.clone(),
            start_iou: truth.iou(&start.points),
            found: None,
            ending: Ending::Found,
            same: None,
            band: [0, 0],
            seconds: 0.0,
        };
        let mut found = plain.fit(&start.points);
        if let Some((change, fits)) = &changed {
            let on_plain = found.contour().map(|fit| fit.contour.points.clone());
            found = fits.fit(&change.there(&start.points, size));
            if let Ok(fit) = &mut found.fit {
                fit.contour.points = change.back(&fit.contour.points, size);
            }
            let here = found.contour().map(|fit| fit.contour.points.as_slice());
            row.same = match (on_plain, here) {
                // of the curves themselves: a pixel is much of a small object
                (Some(a), Some(b)) => Some(::track::overlap(&a, b)),
                (None, None) => Some(1.0),
                _ => Some(0.0),
            };
        }
        row.seconds = found.seconds;
        row.ending = found.ending();
        if let Some(fit) = found.contour() {
            let curve = fit.contour.points.clone();
            row.found = truth.scores(&curve).map(|scores| (curve, scores));
            if way.change.is_none() {
                row.band = band(fit, &truth.rings);
            }
        }
        rows.push(row);
    }
    Ok(rows)
}

/// A picture made ready, and what that took.
pub(super) struct Fits {
    prepared: Result<Prepared, String>,
    alone: bool,
    pub(super) seconds: f64,
}

/// What came of a start.
pub(super) struct Found {
    pub(super) fit: Result<Fit, String>,
    pub(super) seconds: f64,
}

impl Fits {
    pub(super) fn new(image: &Image, way: &Way<'_>) -> Self {
        let alone = way.alone;
        let clock = Clock::start(alone);
        let prepared = Prepared::of(image, &way.options);
        Self {
            prepared: prepared.map_err(|error| error.to_string()),
            alone,
            seconds: clock.seconds(),
        }
    }

    /// Fit a closed polygon.
    pub(super) fn fit(&self, start: &[DVec2]) -> Found {
        let clock = Clock::start(self.alone);
        let start = Contour::closed(start.to_vec());
        let fit = match &self.prepared {
            Ok(prepared) => prepared.fit(&start).map_err(|error| error.to_string()),
            Err(refused) => Err(refused.clone()),
        };
        let seconds = self.seconds + clock.seconds();
        Found { fit, seconds }
    }
}

impl Found {
    /// The fit, if it has an outline.
    pub(super) fn contour(&self) -> Option<&Fit> {
        let fit = self.fit.as_ref().ok()?;
        (!matches!(fit.outcome, Outcome::Diverged { .. })).then_some(fit)
    }

    /// What the command would say of it.
    pub(super) fn ending(&self) -> Ending {
        let fit = match &self.fit {
            Ok(fit) => fit,
            Err(refused) => return Ending::Refused(refused.clone()),
        };
        if fit.is_outline() {
            return Ending::Found;
        }
        let objection = fit.quality.as_ref().and_then(|quality| quality.objection());
        Ending::Unsure(objection.unwrap_or_else(|| fit.outcome.to_string()))
    }
}
