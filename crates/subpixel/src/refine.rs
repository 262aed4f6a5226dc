//! The last stage: a snake that moves along its normals only.

use field::Pixels;
use glam::DVec2;
use search::along::Polygon;

use crate::blocks::Blocks;
use crate::coarse::nearer;
use crate::patch::Patch;
use crate::profile::{Beside, Profiles};
use crate::reading::{BLURS, Edge, PLATEAU, Reading};
use crate::stiffness::{Places, Rest, rest_shape};

/// Rounds of reading the profiles and coming to rest; the first have no doubt.
const ROUNDS: usize = 5;
const SURE_ROUNDS: usize = 2;

/// An edge is not followed where a step explains less than the first of its profile, and fully from the second on.
const DOUBT: f64 = 0.92;
const TRUST: f64 = 0.97;

/// Share of an outline that must be followed, and in blocks of several pixels: what is not sharp is followed only where
/// it is clear.
const HALF: f64 = 0.5;
const MOST: f64 = 0.8;

/// A coarse search comes first where the edge may be farther than this. Pixels.
const NEAR: f64 = 1.5;

/// The most that one round may move a node by its own reading. Pixels.
const FARTHEST: f64 = 4.0;

/// A node must know its edge to thirty pixels or so for the edge to be one. L⁻².
const LEAST_INFORMATION: f64 = 1e-3;

/// The blur to begin with, by its number.
const FIRST_BLUR: usize = 4;

/// Sides of the blocks that an edge is read in, in pixels; the least blur of one that is read in blocks of several, in
/// blocks; the most, in radii of a disk of the same area and length; how much farther than its blur an outline may be
/// moved, in blocks; the least distance of nodes, in blocks.
const SIDES: [usize; 4] = [1, 2, 4, 8];
const LEAST_IN_BLOCKS: f64 = 1.0;
const WIDEST: f64 = 0.35;
const NEARER: f64 = 0.5;
const FINEST: f64 = 0.25;

/// Nodes at least and at most.
const NODES: [f64; 2] = [24.0, 6000.0];

/// How the last stage goes. L is a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// How far from the outline the edge may lie. L.
    pub reach: f64,
    /// Distance of nodes. L.
    pub spacing: f64,
    /// Over how long a way the outline is rough by the search it came from. L.
    pub rough: f64,
}

/// An outline on its edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Precise {
    /// Its nodes, at about equal distances, clockwise on the screen.
    pub points: Vec<DVec2>,
    /// Unit normals, outwards.
    pub normals: Vec<DVec2>,
    /// Standard error of each node along its normal; None where the edge is none that could be measured. L.
    pub errors: Vec<Option<f64>>,
    /// Level inside less level outside; of a color picture along the direction between the two colors.
    pub heights: Vec<f64>,
    /// What was measured of the edge; None where most of it is none that could be measured: then the outline is left
    /// as it was found.
    pub edge: Option<Blurred>,
}

/// An edge as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blurred {
    /// σ of its blur. L.
    pub blur: f64,
    /// Standard deviation of a pixel's noise, in levels.
    pub noise: f64,
    /// ℓ of the stiffness: waves shorter than 2π ℓ were smoothed. L.
    pub length: f64,
}

/// Move an outline onto the edge that it lies beside; None for one without length.
#[must_use]
pub fn refine(pixels: &dyn Pixels, outline: &Polygon, rules: Rules) -> Option<Precise> {
    let outline = outline.clone().outwards();
    if outline.length() <= 0.0 || !outline.length().is_finite() {
        return None;
    }
    for side in SIDES {
        let blocks = Blocks::of(pixels, side);
        let size = side as f64;
        let rules = if side == 1 {
            rules
        } else {
            Rules {
                reach: (rules.reach / size).max(NEAR),
                spacing: (rules.spacing / size).max(FINEST),
                rough: (rules.rough / size).max(NEAR),
            }
        };
        let begun = Polygon {
            points: outline
                .points
                .iter()
                .map(|p| blocks.to_blocks(*p))
                .collect(),
            closed: outline.closed,
        };
        let found = read(blocks, &begun, rules);
        // an edge that is sharp in blocks was not left before for its blur, and none is as wide as its object
        let most = if outline.closed {
            WIDEST * 2.0 * outline.area() / outline.length()
        } else {
            f64::INFINITY
        };
        let wide = |edge: Blurred| edge.blur > LEAST_IN_BLOCKS && size * edge.blur < most;
        let blurred = |found: &Precise| {
            let stayed = |edge: Blurred| moved(&begun, found, rules) < edge.blur + NEARER;
            side == 1 || found.edge.is_some_and(|edge| wide(edge) && stayed(edge))
        };
        if let Some(found) = found.filter(blurred) {
            return Some(found.in_picture(blocks, size));
        }
    }
    Some(as_found(&outline, rules))
}

/// How far the nodes of an outline were moved, in the mean.
fn moved(outline: &Polygon, found: &Precise, rules: Rules) -> f64 {
    let before = nodes(outline, rules).points;
    let ways = before
        .iter()
        .zip(&found.points)
        .map(|(a, b)| a.distance(*b));
    ways.sum::<f64>() / before.len() as f64
}

/// Read an edge, and come to rest on it; None where there is none that could be read.
fn read(pixels: Blocks<'_>, outline: &Polygon, rules: Rules) -> Option<Precise> {
    let (length, closed) = (outline.length(), outline.closed);
    let found = nodes(outline, rules);
    let count = found.points.len();
    let spacing = length / count as f64;
    let patch = Patch::around(pixels, &found.points, 2.0 * rules.reach + PLATEAU + 6.0);
    let mut points = if rules.reach > NEAR {
        nearer(pixels, &patch, &found, rules.reach, spacing).unwrap_or_else(|| found.points.clone())
    } else {
        found.points.clone()
    };
    points = rest_shape(&points, rules.rough / spacing, closed);
    let start = points.clone();
    let mut blur = FIRST_BLUR;
    let mut stage = None;
    for round in 0..ROUNDS {
        let normals = Polygon {
            points: points.clone(),
            closed,
        }
        .normals(1.5 / spacing);
        let window = 2.0 * BLURS[blur] + PLATEAU + 2.0;
        let beside = Beside {
            near: 2.0 * BLURS[blur],
            far: 2.0 * BLURS[blur] + PLATEAU,
            along: 10.0 / spacing,
            closed,
        };
        let profiles = Profiles::of(pixels, &patch, &points, &normals, window, &beside);
        let edge = Edge {
            profiles: &profiles,
            spacing,
            closed,
        };
        if round == 1 || round == SURE_ROUNDS {
            blur = edge.best_blur(blur);
        }
        let reading = edge.read(BLURS[blur]);
        let trust = if round < SURE_ROUNDS {
            vec![1.0; count]
        } else {
            let explained = edge.explained(BLURS[blur], reading.noise);
            explained
                .iter()
                .map(|one| ((one - DOUBT) / (TRUST - DOUBT)).clamp(0.0, 1.0))
                .collect()
        };
        let trusted = trust.iter().sum::<f64>() / count as f64;
        let needed = if pixels.side() == 1 { HALF } else { MOST };
        if trusted < needed || (round >= SURE_ROUNDS && blur + 1 == BLURS.len()) {
            return None;
        }
        let length = stage
            .as_ref()
            .filter(|_| round > SURE_ROUNDS)
            .map(|stage: &Stage| stage.rest.length);
        let rest = rest(
            &reading,
            &trust,
            &Beginning {
                points: &points,
                start: &start,
                normals: &normals,
            },
            spacing,
            closed,
            length,
        );
        let rest = rest?;
        points.clone_from(&rest.points);
        stage = Some(Stage {
            reading,
            rest,
            normals,
            trust,
        });
    }
    Some(stage?.finished(BLURS[blur], spacing, closed))
}

impl Precise {
    /// What was found in blocks of that size, in the picture.
    fn in_picture(mut self, blocks: Blocks<'_>, size: f64) -> Self {
        self.points
            .iter_mut()
            .for_each(|p| *p = blocks.to_picture(*p));
        self.errors
            .iter_mut()
            .flatten()
            .for_each(|error| *error *= size);
        if let Some(edge) = &mut self.edge {
            edge.blur = blocks.blur(edge.blur);
            // blocks hold the mean of noise that is independent from pixel to pixel
            edge.noise *= size;
            edge.length *= size;
        }
        self
    }
}

/// Where a round begins.
struct Beginning<'a> {
    points: &'a [DVec2],
    /// Where the outline was found.
    start: &'a [DVec2],
    normals: &'a [DVec2],
}

/// The rest of a round, of a stiffness that is known or chosen.
fn rest(
    reading: &Reading,
    trust: &[f64],
    from: &Beginning<'_>,
    spacing: f64,
    closed: bool,
    length: Option<f64>,
) -> Option<Rest> {
    let n = trust.len();
    let mean = reading.information.iter().sum::<f64>() / n as f64;
    if mean.partial_cmp(&LEAST_INFORMATION) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    let information: Vec<f64> = reading
        .information
        .iter()
        .map(|f| f.max(1e-6 * mean))
        .collect();
    let alone = (0..n).map(|i| {
        let way = (reading.gradient[i] / information[i]).clamp(-FARTHEST, FARTHEST);
        // where no step explains the profile, the outline stays where it was found
        let back = (from.start[i] - from.points[i]).dot(from.normals[i]);
        from.points[i] + (trust[i] * way + (1.0 - trust[i]) * back) * from.normals[i]
    });
    let alone = alone.collect();
    let places = Places {
        alone,
        normals: from.normals,
        information,
        spacing,
        closed,
    };
    match length {
        Some(length) => places.rest_of(length),
        None => places.rest(),
    }
}

/// A round that has come to rest.
struct Stage {
    reading: Reading,
    rest: Rest,
    normals: Vec<DVec2>,
    trust: Vec<f64>,
}

impl Stage {
    fn finished(self, blur: f64, spacing: f64, closed: bool) -> Precise {
        let Self {
            reading,
            rest,
            normals,
            trust,
        } = self;
        let mut points = rest.points;
        let curvature = curvature(&points, closed, 3.0 / spacing);
        for (i, p) in points.iter_mut().enumerate() {
            // what the blur of a curved edge moves inwards; less round than the blur it has no such edge
            let bend = curvature[i].clamp(-0.5 / blur, 0.5 / blur);
            *p += trust[i] * 0.5 * bend * blur * blur * normals[i];
        }
        let error = |i: usize| {
            let error = (rest.variance[i] + reading.level[i]).sqrt();
            (trust[i] >= 0.5 && error.is_finite()).then_some(error)
        };
        Precise {
            errors: (0..trust.len()).map(error).collect(),
            points,
            normals,
            heights: reading.heights,
            edge: Some(Blurred {
                blur,
                noise: reading.noise,
                length: rest.length,
            }),
        }
    }
}

/// An outline as it was found, with nodes as [`refine`] has them and no edge.
#[must_use]
pub fn as_found(outline: &Polygon, rules: Rules) -> Precise {
    let found = nodes(&outline.clone().outwards(), rules);
    let count = found.points.len();
    Precise {
        normals: found.normals(1.0),
        points: found.points,
        errors: vec![None; count],
        heights: vec![0.0; count],
        edge: None,
    }
}

/// The nodes of an outline.
fn nodes(outline: &Polygon, rules: Rules) -> Polygon {
    let [least, most] = NODES;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped first"
    )]
    let count = (outline.length() / rules.spacing)
        .round()
        .clamp(least, most) as usize;
    outline.evenly(count)
}

/// Curvature by three neighbours of the curve smoothed by so many nodes: above 0 where it is convex.
fn curvature(points: &[DVec2], closed: bool, sigma: f64) -> Vec<f64> {
    let points = rest_shape(points, sigma, closed);
    let n = points.len();
    let bend = |i: usize| {
        if !closed && (i == 0 || i + 1 == n) {
            return 0.0;
        }
        let (a, b, c) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let (d, e) = (b - a, c - b);
        let lengths = d.length() * e.length() * (c - a).length();
        if lengths > 0.0 {
            2.0 * d.perp_dot(e) / lengths
        } else {
            0.0
        }
    };
    (0..n).map(bend).collect()
}
