//! What an experiment is written with.

pub(crate) use crate::course::{
    Changes, frame, group_of, last, moved, ran, real_steps, steps_in, to_the_end, watch, watched,
};
pub use crate::course::{Group, advance, group, scene_with};
pub use crate::demand::{
    Demand, above, at_least, at_most, below, close, falling, less, like, more, near, never, ratio,
    rising,
};
pub use crate::draw::{
    Animation, Axis, Color, Corner, Dots, Figure, Layer, Line, Panel, Picture, Shot, Stroke, area,
    arrow, arrows, circle, diverging, dots, grey, line, plot, sequential, shrunk, signed,
    strongest_arrows, text,
};
pub use crate::error::{Result, refused};
pub use crate::experiment::{Drawn, claim};
pub use crate::numbers::{flag, least, mean, most, range};
pub use crate::run::{Curve, Frame, Run};
pub(crate) use crate::run::{change, gap_of, pair, pairs, stray};
pub(crate) use crate::shown::{account, energies, over_time, snapshots};
pub use crate::shown::{picture, wall};
pub use crate::tolerance::{EXACT, ROUNDING, share};
pub use crate::{Artefact, Claim, Experiment, Finding, Record, Table, Tolerance, real};
pub use glam::DVec2;
