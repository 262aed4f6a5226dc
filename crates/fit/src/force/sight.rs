//! An image as the kinds of force look at it: its levels, its contrast, and what has been made of
//! it.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use field::{EdgeForce, FieldError, ForceField, Grid, MaskedImage, Region, Smoothing};
use snake::{Acting, ImageForce, RegionForce, Sampling};

use super::edge_field::{Computing, Part, edge_field};
use super::{ForceError, ForceKey, ImageForceKind, Made, above_nothing, all, by, checked};
use crate::limits::MOST_FIELDS;
use crate::{Image, Problem};
use field::level_spread;

/// An image as the kinds of force look at it. What has been made of it is kept, and shared by all
/// curves and threads.
#[derive(Debug)]
pub struct Sight {
    pub(super) image: Image,
    grey: OnceLock<MaskedImage>,
    contrast: f64,
    range: f64,
    computing: Computing,
    whole_up_to: u64,
    /// Fields and regions that have been made, by what they were asked for.
    made: Mutex<Vec<(ImageForceKind, Seen)>>,
    /// Pixels of all fields so far.
    spent: AtomicU64,
}

/// What a kind makes of an image, whatever the curve.
#[derive(Debug, Clone)]
enum Seen {
    Field(Arc<ForceField>),
    Region(Arc<dyn Region>),
}

impl Seen {
    fn acting(self) -> Acting {
        match self {
            Self::Region(region) => Acting::new(RegionForce::new(region)),
            Self::Field(field) => Acting::new(ImageForce::new(field, Sampling::Bilinear)),
        }
    }
}

impl Sight {
    /// Look at an image. Edge forces are computed as a whole up to `whole_up_to` pixels where
    /// `computing` leaves that open.
    ///
    /// # Errors
    ///
    /// Levels that are not finite, or too large.
    pub fn of(image: Image, computing: Computing, whole_up_to: u64) -> Result<Self, Problem> {
        let limits = image.pixels().limits();
        let sight = Self {
            image,
            grey: OnceLock::new(),
            contrast: level_spread(limits),
            range: limits[3] - limits[0],
            computing,
            whole_up_to,
            made: Mutex::default(),
            spent: AtomicU64::new(0),
        };
        if !sight.image.pixels().is_checked() {
            sight.masked_grey()?;
        }
        Ok(sight)
    }

    /// The image.
    #[must_use]
    pub const fn image(&self) -> &Image {
        &self.image
    }

    /// Spread of the levels that count, from the 2nd to the 98th percentile, for a gain; 1 for a
    /// constant, which exerts no force whatever its gain.
    #[must_use]
    pub fn contrast(&self) -> f64 {
        above_nothing(self.contrast)
    }

    /// The largest level less the least.
    #[must_use]
    pub const fn range(&self) -> f64 {
        self.range
    }

    /// The same as [`Sight::contrast`], 0 for a constant.
    #[must_use]
    pub const fn true_contrast(&self) -> f64 {
        self.contrast
    }

    /// Count fields that are about to be made; more than there may be in all are refused.
    ///
    /// # Errors
    ///
    /// More fields than there is room for.
    pub fn spend(&self, fields: usize) -> Result<(), Problem> {
        let (width, height) = self.image.size();
        let pixels = (width * height) as u64;
        let before = self.spent.load(Ordering::Relaxed);
        let all = before.saturating_add(pixels.saturating_mul(fields as u64));
        if before > 0 && all > MOST_FIELDS {
            let most = MOST_FIELDS / pixels.max(1);
            return Err(Problem::Other(format!(
                "makes more force fields than there is room for on {width}×{height} pixels: there must be at most {most}"
            )));
        }
        self.spent.store(all, Ordering::Relaxed);
        Ok(())
    }

    /// [`Sight::spend`] what a list of kinds makes, before any of it is made.
    ///
    /// # Errors
    ///
    /// The index of the first kind that there is no room for.
    pub fn foresee<'a>(
        &self,
        kinds: impl IntoIterator<Item = &'a ImageForceKind>,
    ) -> Result<(), (usize, Problem)> {
        let mut new: Vec<&ImageForceKind> = Vec::new();
        for (index, kind) in kinds.into_iter().enumerate() {
            let kept = kind.is_field() || kind.is_region();
            if kept && (new.contains(&kind) || self.known(kind).is_some()) {
                continue;
            }
            self.spend(kind.fields())
                .map_err(|problem| (index, problem))?;
            new.push(kind);
        }
        Ok(())
    }

    fn known(&self, kind: &ImageForceKind) -> Option<Seen> {
        let made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let found = made.iter().find(|(known, _)| known == kind);
        found.map(|(_, seen)| seen.clone())
    }

    /// What a kind makes of the image, made once for each way of asking.
    fn seen(
        &self,
        kind: &ImageForceKind,
        make: impl FnOnce() -> Result<Seen, ForceError>,
    ) -> Result<Seen, ForceError> {
        if let Some(seen) = self.known(kind) {
            return Ok(seen);
        }
        let seen = make()?;
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        // another thread may have been faster; what it made has the same numbers
        if let Some((_, known)) = made.iter().find(|(known, _)| known == kind) {
            return Ok(known.clone());
        }
        made.push((kind.clone(), seen.clone()));
        Ok(seen)
    }

    fn masked_grey(&self) -> Result<&MaskedImage, FieldError> {
        if let Some(grey) = self.grey.get() {
            return Ok(grey);
        }
        let grey = self.image.masked(self.image.pixels().levels())?;
        Ok(self.grey.get_or_init(|| grey))
    }

    /// The grey levels with the word on which of them count.
    pub(super) fn grey(&self) -> Result<&MaskedImage, ForceError> {
        self.masked_grey().map_err(by(ForceKey::All))
    }

    /// σ, checked against the size of the image.
    pub(super) fn sigma(&self, sigma: f64) -> Result<f64, ForceError> {
        checked(ForceKey::Sigma, sigma, self.image.size())
    }

    /// The grey image smoothed, over what counts.
    pub(super) fn smoothed(&self, sigma: f64) -> Result<Grid, ForceError> {
        let smoothed = self.grey()?.smoothed(Smoothing::Gaussian(sigma));
        smoothed.map_err(by(ForceKey::All))
    }

    /// `gain · ∇P` where pixels count, and its energy `−gain · P`.
    pub(super) fn climbing(&self, strength: &Grid, gain: f64) -> Result<Made, ForceError> {
        let field = self.grey()?.force(strength, gain);
        Ok(Made {
            field: field.map_err(by(ForceKey::All))?,
            energy: Some(strength.mapv(|p| -gain * p)),
        })
    }

    /// The edge force of the grey levels by a rule of one's own, computed as this sight is told to.
    ///
    /// # Errors
    ///
    /// [`ForceKey::Sigma`]: a smoothing that makes no sense or takes too long. [`ForceKey::All`]: a
    /// lazy field where there can be none.
    pub fn edge_field(&self, rule: EdgeForce) -> Result<ForceField, ForceError> {
        self.edge_field_by(rule, ForceKey::Sigma)
    }

    /// [`Sight::edge_field`] computed as `computing` says.
    ///
    /// # Errors
    ///
    /// As [`Sight::edge_field`].
    pub fn edge_field_as(
        &self,
        rule: EdgeForce,
        computing: Computing,
    ) -> Result<ForceField, ForceError> {
        let how = (computing, self.whole_up_to);
        edge_field(&self.image, self.contrast, rule, how).map_err(|(part, problem)| {
            let key = match part {
                Part::Smoothing => ForceKey::Sigma,
                Part::Computing => ForceKey::All,
            };
            ForceError::new(key, problem)
        })
    }

    /// [`Sight::edge_field`] with the smoothing under another key.
    pub(super) fn edge_field_by(
        &self,
        rule: EdgeForce,
        key: ForceKey,
    ) -> Result<ForceField, ForceError> {
        self.edge_field_as(rule, self.computing)
            .map_err(|error| match error.key {
                ForceKey::Sigma => ForceError::new(key, error.problem),
                _ => error,
            })
    }

    /// What to say of an image without any contrast.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let pixels = self.image.pixels();
        let constant = || {
            let flat = |channel: &Grid| self.image.spread(channel) <= 0.0;
            pixels.channels().iter().all(flat)
        };
        if self.contrast > 0.0 {
            None
        } else if pixels.is_color() && !constant() {
            Some(
                "the picture has one grey everywhere: only forces in color see anything".to_owned(),
            )
        } else {
            Some("the picture is the same everywhere: it exerts no force".to_owned())
        }
    }

    /// The regions of a kind; None for a kind that has none.
    ///
    /// # Errors
    ///
    /// A value of the kind that is out of its range, or asks for too much.
    pub fn region(&self, kind: &ImageForceKind) -> Result<Option<Arc<dyn Region>>, ForceError> {
        let region = match kind {
            ImageForceKind::Regions(regions) => self.regions(regions),
            ImageForceKind::LocalRegions(local) => self.local_regions(local),
            ImageForceKind::Likelihood(likelihood) => self.likelihood(likelihood),
            ImageForceKind::Texture(texture) => self.texture(texture),
            _ => return Ok(None),
        };
        region.map(Some)
    }

    /// The field of a kind with its energy; None for a kind that is no field of the image alone.
    ///
    /// # Errors
    ///
    /// As [`Sight::region`].
    pub fn field(&self, kind: &ImageForceKind) -> Result<Option<Made>, ForceError> {
        let made = match kind {
            ImageForceKind::Edge(edge) if kind.is_field() => self.edge(edge),
            ImageForceKind::ColorEdge(edge) => self.color_edge(edge),
            ImageForceKind::Scales(scales) => self.scales(scales),
            ImageForceKind::Line(line) => self.line(line),
            ImageForceKind::Termination(termination) => self.termination(termination),
            ImageForceKind::Distance(distance) => self.distance(distance),
            ImageForceKind::Gvf(gvf) => self.gvf(gvf),
            ImageForceKind::Vfc(vfc) => self.vfc(vfc),
            _ => return Ok(None),
        };
        made.map(Some)
    }

    /// The forces that a kind exerts on a curve: one, or one a scale of a schedule.
    ///
    /// # Errors
    ///
    /// As [`Sight::region`].
    pub fn forces(&self, kind: &ImageForceKind) -> Result<Vec<Acting>, ForceError> {
        match kind {
            ImageForceKind::CoarseToFine(scales) => return self.coarse_to_fine(scales),
            ImageForceKind::Edge(edge) if !kind.is_field() => {
                return Ok(vec![Acting::new(self.signed_edge(edge)?)]);
            }
            _ => {}
        }
        let make = || {
            if let ImageForceKind::Edge(edge) = kind {
                return Ok(Seen::Field(Arc::new(self.felt_edge(edge)?)));
            }
            if let Some(region) = self.region(kind)? {
                return Ok(Seen::Region(region));
            }
            let made = self.field(kind)?;
            let none = || all(Problem::Other(format!("{} is no field", kind.name())));
            made.map(|made| Seen::Field(Arc::new(made.field)))
                .ok_or_else(none)
        };
        Ok(vec![self.seen(kind, make)?.acting()])
    }
}
