//! A picture as the kinds of force look at it: its levels, its contrast, and what has been made of it already.

use std::cell::{Cell, OnceCell, RefCell};
use std::sync::Arc;

use field::{EdgeForce, FieldError, ForceField, MaskedImage, Region};

use super::super::edge_field::{Computing, Wanted, edge_field};
use super::{At, Made, above_nothing, either, grids, is_field, is_region, looks};
use crate::file::{ForceText, KindText};
use crate::limits::{MOST_FIELDS, USUALLY_WHOLE};
use crate::{Picture, SceneError};

/// A picture as the kinds of force look at it.
pub(crate) struct Sight<'a> {
    pub picture: &'a Picture,
    grey: OnceCell<MaskedImage>,
    contrast: f64,
    range: f64,
    computing: Computing,
    whole_up_to: u64,
    /// The field of `[field]`, once it has been made.
    usual: OnceCell<Arc<ForceField>>,
    /// Fields and regions that have been made, by what they were asked for.
    made: RefCell<Vec<(KindText, Seen)>>,
    /// Pixels of all fields so far.
    spent: Cell<u64>,
}

/// What a kind makes of a picture, whatever the curve.
#[derive(Clone)]
pub(super) enum Seen {
    Field(Arc<ForceField>),
    Region(Arc<dyn Region>),
}

impl<'a> Sight<'a> {
    pub(crate) fn of(picture: &'a Picture) -> Result<Self, SceneError> {
        let limits = picture.grey_limits();
        let sight = Self {
            picture,
            grey: OnceCell::new(),
            contrast: picture.spread(),
            range: limits[3] - limits[0],
            computing: Computing::Auto,
            whole_up_to: USUALLY_WHOLE,
            usual: OnceCell::new(),
            made: RefCell::default(),
            spent: Cell::new(0),
        };
        if !picture.is_tame() {
            sight.grey("picture")?; // pixels that will not do are found first
        }
        Ok(sight)
    }

    /// The same for a single fit.
    pub(crate) const fn for_fit(mut self, computing: Computing) -> Self {
        self.computing = computing;
        self.whole_up_to = 0;
        self
    }

    /// The field of `[field]`, made at the first call.
    pub(crate) fn usual(
        &self,
        make: impl FnOnce() -> Result<ForceField, SceneError>,
    ) -> Result<Arc<ForceField>, SceneError> {
        if let Some(field) = self.usual.get() {
            return Ok(Arc::clone(field));
        }
        let field = Arc::new(make()?);
        Ok(Arc::clone(self.usual.get_or_init(|| field)))
    }

    /// Count fields that are about to be made; more than there may be in all are refused.
    pub(crate) fn spend(&self, key: &str, fields: usize) -> Result<(), SceneError> {
        let (width, height) = self.picture.size();
        let (pixels, before) = ((width * height) as u64, self.spent.get());
        let all = before.saturating_add(pixels.saturating_mul(fields as u64));
        if before > 0 && all > MOST_FIELDS {
            let most = MOST_FIELDS / pixels.max(1);
            let message = format!(
                "makes more force fields than there is room for on {width}×{height} pixels: there must be at most {most}"
            );
            return Err(SceneError::key(key, message));
        }
        self.spent.set(all);
        Ok(())
    }

    /// [`Sight::spend`] what a list of forces makes, before any of it is made.
    pub(super) fn foresee(&self, keyed: &[(String, ForceText)]) -> Result<(), SceneError> {
        let mut new: Vec<&KindText> = Vec::new();
        let made = self.made.borrow();
        for (key, ForceText { kind, .. }) in keyed.iter().filter(|(_, text)| looks(&text.kind)) {
            let kept = is_field(kind) || is_region(kind);
            if kept && (new.contains(&kind) || made.iter().any(|(known, _)| known == kind)) {
                continue;
            }
            self.spend(&format!("{key}: kind"), grids(kind))?;
            new.push(kind);
        }
        Ok(())
    }

    /// What a kind makes of the picture, made once for each way of asking.
    pub(super) fn seen(
        &self,
        kind: &KindText,
        make: impl FnOnce() -> Result<Option<Seen>, SceneError>,
    ) -> Result<Option<Seen>, SceneError> {
        let known = self.made.borrow();
        if let Some((_, seen)) = known.iter().find(|(known, _)| known == kind) {
            return Ok(Some(seen.clone()));
        }
        drop(known);
        let seen = make()?;
        let kept = seen.clone().map(|seen| (kind.clone(), seen));
        self.made.borrow_mut().extend(kept);
        Ok(seen)
    }

    /// Spread of the levels that count, for a gain: a constant exerts no force whatever its gain.
    pub(crate) fn contrast(&self) -> f64 {
        above_nothing(self.contrast)
    }

    /// The largest level less the least.
    pub(crate) const fn range(&self) -> f64 {
        self.range
    }

    /// The same as [`Sight::contrast`], 0 for a constant.
    pub(crate) const fn true_contrast(&self) -> f64 {
        self.contrast
    }

    /// The grey levels with the word on which of them count.
    pub(super) fn grey(&self, key: &str) -> Result<&MaskedImage, SceneError> {
        if let Some(grey) = self.grey.get() {
            return Ok(grey);
        }
        let refuse = |e: FieldError| SceneError::key(key, e);
        let grey = self.picture.masked(self.picture.levels()).map_err(refuse)?;
        Ok(self.grey.get_or_init(|| grey))
    }

    /// The corrected edge force of the grey levels; refused by the keys of the smoothing and of the choice.
    pub(crate) fn edge_field(
        &self,
        rule: EdgeForce,
        keys: [&str; 2],
    ) -> Result<ForceField, SceneError> {
        let wanted = Wanted {
            computing: self.computing,
            whole_up_to: self.whole_up_to,
            keys,
        };
        edge_field(self.picture, self.contrast, rule, &wanted)
    }

    /// What to say of a picture without any contrast.
    pub(crate) fn note(&self) -> Option<String> {
        let picture = self.picture;
        if self.contrast > 0.0 {
            None
        } else if picture.is_color() && !picture.is_constant() {
            Some(
                "the picture has one grey everywhere: only forces in color see anything".to_owned(),
            )
        } else {
            Some("the picture is the same everywhere: it exerts no force".to_owned())
        }
    }

    /// The regions of a kind; None for a kind that has none.
    pub(crate) fn region(
        &self,
        key: &str,
        kind: &KindText,
    ) -> Result<Option<Arc<dyn Region>>, SceneError> {
        let at = At { key, sight: self };
        let region = match kind {
            KindText::Regions(text) => at.regions(text),
            KindText::LocalRegions(text) => at.local_regions(text),
            KindText::Likelihood(text) => at.likelihood(text),
            KindText::Texture(text) => at.texture(text),
            _ => return Ok(None),
        };
        region.map(Some)
    }

    /// The field of a kind; None if the kind has no field: its force depends on the curve, or on no picture.
    pub(crate) fn field(&self, key: &str, kind: &KindText) -> Result<Option<Made>, SceneError> {
        let at = At { key, sight: self };
        let made = match kind {
            KindText::Edge(text) if either(text) => at.edge(text),
            KindText::ColorEdge(text) => at.color_edge(text),
            KindText::Scales(text) => at.scales(text),
            KindText::Line(text) => at.line(text),
            KindText::Termination(text) => at.termination(text),
            KindText::Distance(text) => at.distance(text),
            KindText::Gvf(text) => at.gvf(text),
            KindText::Vfc(text) => at.vfc(text),
            _ => return Ok(None),
        };
        made.map(Some)
    }
}
