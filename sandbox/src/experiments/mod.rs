//! The experiments, one file a family.

pub(crate) mod angle;
pub(crate) mod apple;
pub(crate) mod atlas;
pub(crate) mod ball;
pub(crate) mod corners;
pub(crate) mod curvature;
pub(crate) mod damping;
pub(crate) mod damping_rules;
pub(crate) mod decomposition;
pub(crate) mod disc;
pub(crate) mod ends;
pub(crate) mod energy;
pub(crate) mod force_field;
pub(crate) mod forces;
pub(crate) mod integrators;
pub(crate) mod matrix;
mod motion;
mod over_time;
mod pixels;
pub(crate) mod profiles;
pub(crate) mod rest_traps;
pub(crate) mod signal;
pub(crate) mod smoothing;
pub(crate) mod soft;
pub(crate) mod time_step;
pub(crate) mod turned_picture;
pub(crate) mod turning;
