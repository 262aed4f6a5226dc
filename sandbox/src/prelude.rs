//! What an experiment is written with.

pub(crate) use crate::course::{
    Curve, Frame, Group, Run, change, frame, gap_of, group, group_of, last, moved, pair, pairs,
    ran, real_steps, scene_with, steps_in, stray, to_the_end, watch, watched,
};
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
pub(crate) use crate::shown::{account, energies, over_time, picture, snapshots, wall};
pub use crate::tolerance::{EXACT, ROUNDING, share};
pub use crate::{Artefact, Claim, Experiment, Finding, Record, Table, Tolerance, real};
pub use glam::DVec2;
