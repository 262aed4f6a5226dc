//! A window with all that the searches look at: distances to the start, edges, classes of pixels.

use std::f64::consts::{PI, TAU};

use field::{Grid, Pixels, squared_distance};
use glam::DVec2;
use ndarray::Array2;

use crate::along::{Polygon, sample};
use crate::codebook::{Codebook, MOST, Ratios, unit};
use crate::edges::{Across, Edges, dot, percentile, size};
use crate::frame::Frame;
use crate::rules::{Rules, Sign};

/// How far outside the start pixels still count: as surroundings of an edge, for its polarity, for the region models.
/// In radii of the start.
const EDGE_REACH: f64 = 0.1;
const POLARITY_REACH: f64 = 0.3;
const MODEL_REACH: f64 = 0.4;

/// A pixel of the inside counts only so far outside the start.
const INSIDE_REACH: f64 = 0.06;

/// The core of the start: pixels as deep as these shares of the deepest.
const FIRST_CORE: f64 = 0.25;
const POLARITY_CORE: f64 = 0.5;

/// Margin around the start's bounding box, in radii of the start.
const MARGIN: f64 = 0.45;

/// Pixels are far from the start at this share of the reach of a search around it.
const FAR: f64 = 0.8;

/// What was measured about a start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Difference of the median colors in the middle of the start and around it, in percent of the range of grey or in
    /// units of CIE L\*a\*b\*.
    pub contrast: f64,
    /// Whether that is brighter inside; None where there is no difference, or it is not one of lightness mostly.
    pub brighter: Option<bool>,
    /// Standard deviation of the noise in the window, in the same units.
    pub noise: f64,
    /// Standard deviation of all that the window shows, in the same units.
    pub spread: f64,
    /// Slope that counts as half an edge, in these units a pixel of the window.
    pub half: f64,
    /// Radius of a disk of the start's area in the window, in its pixels.
    pub radius: f64,
}

/// A window as the searches see it.
#[derive(Debug)]
pub(crate) struct View {
    pub frame: Frame,
    /// The start in the window.
    pub start: Polygon,
    /// Radius of a disk of the start's area in the window.
    pub radius: f64,
    pub edges: Edges,
    /// Color of the object less that of its ground.
    difference: [f64; 3],
    /// The direction of color that is looked for from the ground to the object; None for any edge.
    sign: Option<[f64; 3]>,
    /// Whether that was asked for: then no other edge counts.
    forced: bool,
    /// Distance to the start, positive inside, in radii of the start.
    depth: Vec<f64>,
    deepest: f64,
    codebook: Codebook,
    /// How much likelier each pixel is inside than outside by what is known before, as a logarithm.
    prior: Option<Grid>,
}

/// Which pixels a view learns from, by their depth in the start.
struct Reach {
    edges: f64,
    model: f64,
    object: f64,
    ground: std::ops::Range<f64>,
}

impl View {
    /// A window about a start.
    pub(crate) fn new(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Self {
        let frame = Frame::around(pixels, start, MARGIN, 1.0);
        let start = start.map(|p| frame.to_window(p));
        let radius = (start.area() / PI).sqrt();
        let depth = depth(&frame, &start, radius);
        let deepest = depth.iter().copied().fold(0.0, f64::max);
        let reach = Reach {
            edges: -EDGE_REACH,
            model: -MODEL_REACH,
            object: POLARITY_CORE * deepest,
            ground: -POLARITY_REACH..0.0,
        };
        Self::with(frame, start, depth, &reach, rules).expecting(pixels)
    }

    /// A window for an outline that lies around the start.
    pub(crate) fn beyond(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Self {
        let frame = Frame::around(
            pixels,
            start,
            MARGIN + rules.around - 1.0,
            0.5 * rules.around,
        );
        let start = start.map(|p| frame.to_window(p));
        let radius = (start.area() / PI).sqrt();
        let depth = depth(&frame, &start, radius);
        let far = FAR * (1.0 - rules.around);
        let reach = Reach {
            edges: 1.0 - rules.around,
            model: f64::NEG_INFINITY,
            object: 0.0,
            ground: f64::NEG_INFINITY..far,
        };
        Self::with(frame, start, depth, &reach, rules).expecting(pixels)
    }

    /// With what is known of the pixels of the picture before, cut as far as what the window says.
    fn expecting(mut self, pixels: &dyn Pixels) -> Self {
        self.prior = pixels.prior().map(|prior| {
            Grid::from_shape_fn(self.frame.dim(), |(y, x)| {
                let p = self.frame.to_picture(DVec2::new(x as f64, y as f64));
                sample(prior, p).clamp(-MOST, MOST)
            })
        });
        self
    }

    /// That and what the window says, together.
    fn together(&self, ratios: &Ratios) -> Grid {
        let seen = self.codebook.map(ratios, self.frame.dim());
        match &self.prior {
            Some(prior) => seen + prior,
            None => seen,
        }
    }

    /// A window about an open curve, whose depth is the distance to it with its sign turned; None for one without
    /// length.
    pub(crate) fn along(pixels: &dyn Pixels, start: &Polygon, width: f64) -> Option<Self> {
        let length = start.length();
        if length.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        let frame = Frame::around(pixels, start, 2.0 * width, 1.0);
        let start = start.map(|p| frame.to_window(p));
        let radius = start.length() / TAU;
        let line = start.dense();
        let dim = frame.dim();
        let mut cells = Array2::from_elem(dim, false);
        for p in &line {
            let (x, y) = (clamped(p.x, dim.1), clamped(p.y, dim.0));
            cells[[y, x]] = true;
        }
        let depth = squared_distance(&cells)
            .iter()
            .map(|d| -d.sqrt() / radius)
            .collect();
        let any = Rules {
            sign: Sign::Either,
            ..Rules::default()
        };
        let reach = Reach {
            edges: -width,
            model: -width,
            object: 0.0,
            ground: 0.0..0.0,
        };
        Some(Self::with(frame, start, depth, &reach, &any))
    }

    fn with(frame: Frame, start: Polygon, depth: Vec<f64>, reach: &Reach, rules: &Rules) -> Self {
        let radius = if start.closed {
            (start.area() / PI).sqrt()
        } else {
            start.length() / TAU
        };
        let deepest = depth.iter().copied().fold(0.0, f64::max);
        let known: Vec<bool> = frame.known.iter().map(|&known| known > 0.0).collect();
        let edges = Edges::of(&frame, |at| known[at] && depth[at] > reach.edges);
        let codebook = Codebook::of(&frame, |at| known[at] && depth[at] > reach.model);
        let difference = difference(&frame, |at| {
            let depth = depth[at];
            let object = depth > reach.object;
            (known[at] && (object || (reach.ground.start < depth && depth < reach.ground.end)))
                .then_some(object)
        });
        let sign = match rules.sign {
            Sign::Learnt => unit(difference),
            Sign::Brighter => Some([1.0, 0.0, 0.0]),
            Sign::Darker => Some([-1.0, 0.0, 0.0]),
            Sign::Either => None,
        };
        Self {
            frame,
            start,
            radius,
            edges,
            difference,
            sign,
            forced: matches!(rules.sign, Sign::Brighter | Sign::Darker),
            depth,
            deepest,
            codebook,
            prior: None,
        }
    }

    /// What was measured.
    pub(crate) fn seen(&self) -> Seen {
        let contrast = size(self.difference);
        let [light, ..] = self.difference;
        Seen {
            contrast,
            brighter: (light.abs() > 0.5 * contrast).then_some(light > 0.0),
            noise: self.edges.noise(),
            spread: spread(&self.frame),
            half: self.edges.half(),
            radius: self.radius,
        }
    }

    /// Whether only edges of one sign are looked for.
    pub(crate) const fn has_sign(&self) -> bool {
        self.sign.is_some()
    }

    /// Whether a place of the window shows the picture.
    pub(crate) fn is_known(&self, p: DVec2) -> bool {
        let (height, width) = self.frame.dim();
        let within = p.cmpge(DVec2::ZERO).all() && p.x < width as f64 && p.y < height as f64;
        within && self.frame.known[[clamped(p.y, height), clamped(p.x, width)]] > 0.0
    }

    /// Whether a pixel is one that the models are learnt from.
    pub(crate) fn is_near(&self, at: usize) -> bool {
        let known = self
            .frame
            .known
            .as_slice()
            .is_some_and(|known| known[at] > 0.0);
        known && self.depth[at] > -MODEL_REACH
    }

    /// A likelihood that knows nothing.
    pub(crate) fn none(&self) -> Grid {
        Grid::zeros(self.frame.dim())
    }

    /// How much likelier each pixel is inside than outside, if the start is inside and what is far from it outside.
    pub(crate) fn first_likelihood(&self, around: f64) -> Grid {
        let known = self.frame.known.as_slice().unwrap_or(&[]);
        let far = FAR * (1.0 - around);
        let ratios = self.codebook.ratios(|at| {
            let depth = self.depth[at];
            (known[at] > 0.0 && (depth > 0.0 || depth < far)).then_some(depth > 0.0)
        });
        self.together(&ratios)
    }

    /// What is surely inside before anything is found.
    pub(crate) fn core(&self) -> Vec<bool> {
        let least = FIRST_CORE * self.deepest;
        self.depth.iter().map(|&depth| depth > least).collect()
    }

    /// How much likelier each pixel is inside than outside, by what is inside now.
    pub(crate) fn likelihood(&self, inside: &[bool]) -> Grid {
        self.together(&self.ratios(inside))
    }

    fn ratios(&self, inside: &[bool]) -> Ratios {
        let known = self.frame.known.as_slice().unwrap_or(&[]);
        let reach = [-MODEL_REACH, -INSIDE_REACH];
        self.codebook.ratios(|at| {
            let inside = inside[at];
            (known[at] > 0.0 && self.depth[at] > reach[usize::from(inside)]).then_some(inside)
        })
    }

    /// The slope along a normal against the polarity: above 0 from the color of the object to that of its ground.
    pub(crate) fn signed(&self, across: Across) -> f64 {
        match self.sign {
            Some(direction) => -dot(across, direction),
            None => size(across),
        }
    }

    /// Whether edges of the other sign count as none.
    pub(crate) const fn is_forced(&self) -> bool {
        self.forced
    }

    /// Inside by a curve.
    pub(crate) fn inside(&self, curve: &[DVec2]) -> Vec<bool> {
        let closed = true;
        Polygon {
            points: curve.to_vec(),
            closed,
        }
        .inside(self.frame.dim())
    }
}

/// Distance to the start by pixels, positive inside, in its radii; the border of the picture is no edge of it.
fn depth(frame: &Frame, start: &Polygon, radius: f64) -> Vec<f64> {
    let dim = frame.dim();
    let inside = start.inside(dim);
    let known = frame.known.as_slice().unwrap_or(&[]);
    let to = |side: bool| -> Grid {
        let cells = (0..inside.len()).map(|at| inside[at] == side && known[at] > 0.0);
        let cells = Array2::from_shape_vec(dim, cells.collect());
        cells.map_or_else(|_| Grid::zeros(dim), |cells| squared_distance(&cells))
    };
    let (to_object, to_ground) = (to(true), to(false));
    let most = (dim.0 + dim.1) as f64;
    let both = to_ground.iter().zip(&to_object);
    both.map(|(ground, object)| (ground.sqrt().min(most) - object.sqrt().min(most)) / radius)
        .collect()
}

/// Standard deviation of the known pixels over all channels.
fn spread(frame: &Frame) -> f64 {
    let variance = |channel: &Grid| {
        let known = || {
            channel
                .iter()
                .zip(&frame.known)
                .filter(|(_, k)| **k > 0.0)
                .map(|(v, _)| *v)
        };
        let count = known().count().max(1) as f64;
        let mean = known().sum::<f64>() / count;
        known().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count
    };
    frame.channels.iter().map(variance).sum::<f64>().sqrt()
}

/// The median color of the object less that of the ground.
fn difference(frame: &Frame, is_object: impl Fn(usize) -> Option<bool>) -> [f64; 3] {
    let mut difference = [0.0; 3];
    for (difference, channel) in difference.iter_mut().zip(&frame.channels) {
        let (mut object, mut ground) = (Vec::new(), Vec::new());
        for (at, value) in channel.iter().enumerate() {
            match is_object(at) {
                Some(true) => object.push(*value),
                Some(false) => ground.push(*value),
                None => {}
            }
        }
        *difference = percentile(&mut object, 0.5) - percentile(&mut ground, 0.5);
    }
    difference
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the window first"
)]
fn clamped(at: f64, count: usize) -> usize {
    at.round().clamp(0.0, (count - 1) as f64) as usize
}
