//! A picture as the kinds of force look at it, and refusals by the keys of the text.

use std::cell::OnceCell;
use std::sync::Arc;

use field::{EdgeForce, ForceField, Region};
use fit::force::{Computing, ForceError, ForceKey, ImageForceKind, Made};
use fit::{Image, Problem};
use snake::Acting;

use super::kind::of_picture;
use super::looks;
use crate::file::{ForceText, KindText};
use crate::limits::USUALLY_WHOLE;
use crate::{Picture, SceneError};

/// A picture as the kinds of force look at it.
pub(crate) struct Sight<'a> {
    pub picture: &'a Picture,
    seen: fit::force::Sight,
    /// The field of `[field]`, once it has been made.
    usual: OnceCell<Arc<ForceField>>,
}

impl<'a> Sight<'a> {
    pub(crate) fn of(picture: &'a Arc<Picture>) -> Result<Self, SceneError> {
        let seen = fit::force::Sight::of(
            Image::of(Arc::<Picture>::clone(picture)),
            Computing::Auto,
            USUALLY_WHOLE,
        )
        .map_err(|problem| SceneError::key("picture", problem))?;
        Ok(Self {
            picture,
            seen,
            usual: OnceCell::new(),
        })
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
        let spent = self.seen.spend(fields);
        spent.map_err(|problem| SceneError::key(key, problem))
    }

    /// [`Sight::spend`] what a list of forces makes, before any of it is made.
    pub(super) fn foresee(&self, keyed: &[(String, ForceText)]) -> Result<(), SceneError> {
        let mut kinds = Vec::new();
        for (key, text) in keyed.iter().filter(|(_, text)| looks(&text.kind)) {
            kinds.extend(of_picture(key, &text.kind)?.map(|kind| (key, kind)));
        }
        let foreseen = self.seen.foresee(kinds.iter().map(|(_, kind)| kind));
        foreseen.map_err(|(index, problem)| {
            let key = kinds.get(index).map_or("force", |(key, _)| key.as_str());
            SceneError::key(&format!("{key}: kind"), problem)
        })
    }

    /// The corrected edge force of the grey levels; refused by the keys of the smoothing and of the
    /// choice.
    pub(crate) fn edge_field(
        &self,
        rule: EdgeForce,
        computing: Computing,
        keys: [&str; 2],
    ) -> Result<ForceField, SceneError> {
        let field = self.seen.edge_field_as(rule, computing);
        field.map_err(|error| {
            let at = usize::from(error.key != ForceKey::Sigma);
            SceneError::key(keys[at], error.problem)
        })
    }

    /// What to say of a picture without any contrast.
    pub(crate) fn note(&self) -> Option<String> {
        self.seen.note()
    }

    /// The regions of a kind; None for a kind that has none.
    pub(crate) fn region(
        &self,
        key: &str,
        kind: &KindText,
    ) -> Result<Option<Arc<dyn Region>>, SceneError> {
        self.asked(key, kind, |kind| self.seen.region(kind))
    }

    /// The field of a kind; None if the kind has no field: its force depends on the curve, or on no
    /// picture.
    pub(crate) fn field(&self, key: &str, kind: &KindText) -> Result<Option<Made>, SceneError> {
        self.asked(key, kind, |kind| self.seen.field(kind))
    }

    fn asked<T>(
        &self,
        key: &str,
        kind: &KindText,
        make: impl FnOnce(&ImageForceKind) -> Result<Option<T>, ForceError>,
    ) -> Result<Option<T>, SceneError> {
        match of_picture(key, kind)? {
            Some(kind) => make(&kind).map_err(|error| refused(key, &error)),
            None => Ok(None),
        }
    }

    /// The same picture as the finder sees it.
    pub(super) const fn seen(&self) -> &fit::force::Sight {
        &self.seen
    }
}

/// The forces that a kind exerts on a curve: one, or one a scale of a schedule; none of a kind that
/// looks at no picture.
pub(super) fn forces(
    seen: &fit::force::Sight,
    key: &str,
    kind: &KindText,
) -> Result<Vec<Acting>, SceneError> {
    match of_picture(key, kind)? {
        Some(kind) => seen.forces(&kind).map_err(|error| refused(key, &error)),
        None => Ok(Vec::new()),
    }
}

/// What is wrong with a force, under its key in the text.
fn refused(key: &str, error: &ForceError) -> SceneError {
    let message: &Problem = &error.problem;
    match error.key {
        ForceKey::All => SceneError::key(key, message),
        part => SceneError::key(&format!("{key}: {}", part.word()), message),
    }
}
