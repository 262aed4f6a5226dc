//! What a frame has said.

use glam::DVec2;

use crate::predict::Prediction;
use crate::step::State;

/// An object in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Its number, from 1, the same in all frames.
    pub id: u32,
    /// The object it came from by division.
    pub parent: Option<u32>,
    /// Its nodes, clockwise on the screen. They may lie outside the frame where the object does.
    pub points: Vec<DVec2>,
    /// For each node the place on the first outline that it has come from, as a share of its length, 0 … 1.
    pub material: Vec<f64>,
    /// Standard error of each node along its normal, as estimated. Pixels.
    pub errors: Vec<f64>,
    /// How it is known.
    pub state: State,
    /// What was seen against what was learnt: 1 at best, 0 for nothing.
    pub confidence: f64,
    /// The motion of its middle. Pixels a frame.
    pub velocity: DVec2,
    /// Its rotation. Radians a frame.
    pub rotation: f64,
    /// Which prediction it comes from.
    pub prediction: Prediction,
}

/// What can happen to an object.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Happening {
    /// It is followed from here on. The confidence says how much of an object the start is.
    Begun,
    /// It is not seen from here on.
    Hidden,
    /// It is seen again.
    Found,
    /// It has left the frame.
    Left,
    /// It was not seen for too long and is given up.
    Lost,
    /// It has become two, of these numbers.
    Divided([u32; 2]),
    /// It was not there before.
    Born,
    /// It cannot be told from that other any more.
    Merged(u32),
    /// It and that other, which looks like it, have covered each other and have parted: from here on their numbers may
    /// be exchanged. The confidence says how much alike they are.
    Uncertain(u32),
    /// The frame could not be read.
    Skipped,
    /// The number of its nodes has changed.
    Remeshed,
    /// Its outline was set from outside.
    Mended,
}

/// Something that happened to an object.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// In which frame, from 0.
    pub frame: usize,
    /// To which object.
    pub id: u32,
    /// What.
    pub what: Happening,
    /// How sure that is, 0 … 1.
    pub confidence: f64,
}

/// All objects in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracked {
    /// Its number, from 0.
    pub frame: usize,
    /// The objects that are followed, by their numbers.
    pub outlines: Vec<Outline>,
    /// What happened.
    pub events: Vec<Event>,
}
