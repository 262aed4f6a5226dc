//! `[[hand]]`: a force or a hold that comes and goes during a run.

use serde::{Deserialize, Serialize};

use super::{ForceText, usual};

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct HandText {
    /// Whose curve, counted from 0: the scene's own snake first, then those of `[[also]]`.
    #[serde(default)]
    pub snake: usize,
    /// When it takes hold; from the start when not given.
    #[serde(default, skip_serializing_if = "usual")]
    pub from: f64,
    /// When it lets go; never when not given.
    pub until: Option<f64>,
    /// The first and last node of a stretch that stands.
    pub hold: Option<[usize; 2]>,
    /// A force, found anew from the curve as it is when the hand takes hold.
    pub force: Option<ForceText>,
}
