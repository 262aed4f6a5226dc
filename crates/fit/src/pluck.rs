//! How firmly an image holds an outline: parts of it are moved aside, and what comes back is measured.
//!
//! A stretch of the outline is moved along its normals by a smooth bump and let go as a snake whose rest shape is the
//! moved curve: left alone it would stay where it was put. Each node is tied to its place there by a spring, a
//! twentieth as stiff as an edge as high as the image's contrast, so that such an edge brings back 94 % of the bump,
//! one of a twentieth of it about 40 %, and no edge nothing. Both ways are tried; the rest of the unmoved outline, tied
//! to itself, is where both count from.

use std::f64::consts::PI;
use std::fmt;
use std::ops::{ControlFlow, Range};

use elastic::{End, Material, Topology};
use glam::DVec2;
use integrator::State;
use snake::{Body, Freeze, Outcome, Rest, Simulation, Snake, Until};

use crate::evidence::normals;
use crate::force::{NORMAL_AT_0, NORMAL_AT_1, PULL};
use crate::setup::{bordered, place, stepping, unfit, unmoved};
use crate::{Contour, FitError, Nodes, OptionKey, Prepared, Problem};

/// Distance of the nodes that are plucked. Pixels.
const SPACING: f64 = 4.0;

/// Length of a stretch, in kicks, and how many there are at least (of a closed outline) and at most.
const STRETCH: f64 = 8.0;
const LEAST: f64 = 4.0;
const MOST: f64 = 64.0;

/// Stiffness of the springs of the plucked curve against the stiffness of an edge as high as the image's contrast.
const SOFT: f64 = 0.05;

/// Steps to rest at most; what then, or to and fro, moves less than this share of the kick rests, the former in so many
/// more steps.
const STEPS: u64 = 2000;
const STILL: f64 = 0.02;
const MORE: u64 = 200;

/// A stretch is firm of which so much comes back.
const FIRM: f64 = 0.5;

/// The edge force does not reach beyond so many σ.
const REACH: f64 = 3.0;

/// How an outline is plucked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pluck {
    /// How far the middle of a stretch is moved along its normal, outwards and inwards; above 0, and at most three σ
    /// of the edge force. Pixels.
    pub kick: f64,
}

impl Default for Pluck {
    fn default() -> Self {
        Self { kick: 2.0 }
    }
}

/// A plucked outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Plucked {
    /// How far it was moved. Pixels.
    pub kick: f64,
    /// Its stretches in their order; together they are the whole outline.
    pub stretches: Vec<Stretch>,
}

/// What came back of a stretch: 1 where all of it did, 0 where it stayed where it was put, below 0 where it went on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Stretch {
    /// Its points of the outline.
    pub points: Range<usize>,
    /// Its middle. Pixels.
    pub at: DVec2,
    /// Of the way outwards (of an open curve, to its right as it runs on the screen); None if that way leads out of the
    /// image, or it did not come to rest.
    pub outward: Option<f64>,
    /// Of the way inwards.
    pub inward: Option<f64>,
}

impl Stretch {
    /// The mean of both ways, or the one there is.
    #[must_use]
    pub fn firmness(&self) -> Option<f64> {
        match (self.outward, self.inward) {
            (Some(outward), Some(inward)) => Some(0.5 * (outward + inward)),
            (one, other) => one.or(other),
        }
    }

    /// Whether at least half comes back.
    #[must_use]
    pub fn is_firm(&self) -> bool {
        self.firmness().is_some_and(|firmness| firmness >= FIRM)
    }
}

impl Plucked {
    /// The share of the outline that is firm.
    #[must_use]
    pub fn firm(&self) -> f64 {
        let firm = self.stretches.iter().filter(|stretch| stretch.is_firm());
        firm.count() as f64 / self.stretches.len().max(1) as f64
    }

    /// The stretch of least firmness; one that did not come to rest is taken for less than any.
    #[must_use]
    pub fn loosest(&self) -> Option<&Stretch> {
        let firmness = |stretch: &Stretch| stretch.firmness().unwrap_or(f64::NEG_INFINITY);
        let mut list = self.stretches.iter();
        list.by_ref()
            .min_by(|a, b| firmness(a).total_cmp(&firmness(b)))
    }
}

/// A row for each stretch.
impl fmt::Display for Plucked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: Option<f64>| {
            // no zero has a sign
            let rounded = |value: f64| (100.0 * value).round() / 100.0 + 0.0;
            value.map_or_else(
                || "nothing known".to_owned(),
                |value| format!("{:.2}", rounded(value)),
            )
        };
        write!(
            f,
            "plucked by {} pixels: share that comes back, outwards and inwards",
            self.kick
        )?;
        for (index, stretch) in self.stretches.iter().enumerate() {
            write!(
                f,
                "\nstretch {} at {:.0},{:.0}: {} and {}, {}",
                index + 1,
                stretch.at.x,
                stretch.at.y,
                number(stretch.outward),
                number(stretch.inward),
                if stretch.is_firm() { "firm" } else { "loose" }
            )?;
        }
        Ok(())
    }
}

/// A curve ready to be plucked.
struct Curve<'a> {
    prepared: &'a Prepared,
    nodes: Vec<DVec2>,
    outwards: Vec<DVec2>,
    closed: bool,
    kick: f64,
    tether: f64,
}

impl Prepared {
    /// Pluck an outline: how firmly the image's forces hold each stretch of it. With the forces of the options, which
    /// by default are the edge force, whatever the method.
    ///
    /// ```
    /// use fit::{Contour, Image, Options, Pluck, Prepared};
    /// use glam::DVec2;
    ///
    /// let bright = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
    /// let level = |(y, x)| if bright(x, y) { 200.0 } else { 50.0 };
    /// let levels = field::Grid::from_shape_fn((61, 61), level);
    /// let prepared = Prepared::of(&Image::grey(levels), &Options::default())?;
    /// let outline = Contour::circle(DVec2::new(30.0, 30.0), 15.0);
    /// assert_eq!(prepared.pluck(&outline, &Pluck::default())?.firm(), 1.0);
    /// # Ok::<(), fit::FitError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// By its key: a kick out of its range, and as [`Prepared::session`].
    pub fn pluck(&self, outline: &Contour, pluck: &Pluck) -> Result<Plucked, FitError> {
        let sigma = self.options().sigma;
        let kick = Problem::above_zero(pluck.kick)
            .map_err(|problem| FitError::new(OptionKey::Kick, problem))?;
        if kick > REACH * sigma {
            let (needed, got) = ("at most three sigma, the reach of the edge force", kick);
            return Err(FitError::new(
                OptionKey::Kick,
                Problem::Number { needed, got },
            ));
        }
        let closed = outline.closed;
        let length = elastic::length(&outline.clicks(), closed);
        let count = Nodes::Every(SPACING).along(length);
        let nodes = place(self, outline, count)?;
        let mut outwards = normals(&nodes, closed);
        if closed && elastic::signed_area(&nodes) > 0.0 {
            outwards.iter_mut().for_each(|normal| *normal = -*normal);
        }
        let curve = Curve {
            prepared: self,
            closed,
            kick,
            tether: SOFT * stiffness(self),
            nodes,
            outwards,
        };
        let rest = curve.rest(&curve.nodes)?;
        let least = if closed { LEAST } else { 1.0 };
        let stretches = (length / (STRETCH * kick)).round().clamp(least, MOST);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 1 to 64"
        )]
        let stretches = stretches as usize;
        let along = along(&outline.clicks());
        let border = |k: usize| match k {
            k if k == stretches => along.len(),
            k => along.partition_point(|way| *way < length * k as f64 / stretches as f64),
        };
        let of = |k: usize| {
            let both = curve.back(k, stretches, rest.as_deref())?;
            Ok(Stretch {
                points: border(k)..border(k + 1),
                at: curve.middle(k, stretches),
                outward: both[0],
                inward: both[1],
            })
        };
        Ok(Plucked {
            kick,
            stretches: (0..stretches).map(of).collect::<Result<_, FitError>>()?,
        })
    }
}

/// How far along a curve each of its points is. Pixels.
fn along(points: &[DVec2]) -> Vec<f64> {
    let mut way = 0.0;
    let far = points.iter().enumerate().map(|(i, p)| {
        way += p.distance(points[i.saturating_sub(1)]);
        way
    });
    far.collect()
}

/// The stiffness with which the forces hold a node to an edge as high as the image's contrast. M T⁻².
fn stiffness(prepared: &Prepared) -> f64 {
    let options = prepared.options();
    // the usual edge force pulls with another strength at another σ
    let pull = if options.forces.is_empty() {
        PULL * options.strength * 10.0 / (options.sigma * options.sigma)
    } else {
        PULL
    };
    pull * NORMAL_AT_0 / (NORMAL_AT_1 * options.sigma)
}

impl Curve<'_> {
    /// What comes back of a stretch that is moved outwards, and inwards; `still` is where the unmoved curve rests.
    fn back(
        &self,
        stretch: usize,
        stretches: usize,
        still: Option<&[DVec2]>,
    ) -> Result<[Option<f64>; 2], FitError> {
        let bump = self.bump(stretch, stretches);
        let size: f64 = bump.iter().map(|part| part * part).sum();
        let mut back = [None; 2];
        for (back, side) in back.iter_mut().zip([1.0, -1.0]) {
            let moved = self.nodes.iter().zip(&self.outwards).zip(&bump);
            let moved: Vec<DVec2> = moved
                .map(|((x, normal), part)| *x + side * self.kick * *part * *normal)
                .collect();
            // the border would hold what the image does not
            let (width, height) = self.prepared.image().size();
            let last = DVec2::new(width as f64, height as f64) - 1.0;
            let out = |p: &DVec2| p.cmplt(DVec2::ZERO).any() || p.cmpgt(last).any();
            if moved
                .iter()
                .zip(&bump)
                .any(|(p, part)| *part > 0.5 && out(p))
            {
                continue;
            }
            let (Some(still), Some(rest)) = (still, self.rest(&moved)?) else {
                continue;
            };
            let away = |i: usize| (rest[i] - still[i]).dot(self.outwards[i]);
            let away: f64 = bump
                .iter()
                .enumerate()
                .map(|(i, part)| part * away(i))
                .sum();
            *back = Some(1.0 - side * away / (self.kick * size)).filter(|back| back.is_finite());
        }
        Ok(back)
    }

    /// How much of the kick each node takes part in: cos² about the middle of a stretch, so that all stretches
    /// together would move the whole outline alike.
    fn bump(&self, stretch: usize, stretches: usize) -> Vec<f64> {
        let n = self.nodes.len() as f64;
        let wide = n / stretches as f64;
        let middle = (stretch as f64 + 0.5) * wide;
        let part = |i: usize| {
            let off = (i as f64 - middle).abs();
            let off = if self.closed { off.min(n - off) } else { off };
            if off < wide {
                (0.5 * PI * off / wide).cos().powi(2)
            } else {
                0.0
            }
        };
        (0..self.nodes.len()).map(part).collect()
    }

    /// The middle of a stretch.
    fn middle(&self, stretch: usize, stretches: usize) -> DVec2 {
        let n = self.nodes.len();
        let (before, part) = ((2 * stretch + 1) * n, 2 * stretches);
        let share = (before % part) as f64 / part as f64;
        let after = (before / part + 1) % n;
        self.nodes[before / part].lerp(self.nodes[after], share)
    }

    /// Where a curve of that shape comes to rest; None if it does not.
    fn rest(&self, shape: &[DVec2]) -> Result<Option<Vec<DVec2>>, FitError> {
        let prepared = self.prepared;
        let topology = if self.closed {
            Topology::Closed
        } else {
            Topology::open(End::Free)
        };
        // neighbours hold together over the σ that the image is seen with
        let sigma = prepared.options().sigma;
        let material = Material::uniform(0.0, self.tether * sigma * sigma, 0.0);
        let body = Body::of(shape, topology, 1.0)
            .map_err(unfit)?
            .with_material(material)
            .with_damping(prepared.options().damping);
        // a spring from each node to its place: the tether of a body would let it drift away as a whole
        let places = Freeze::new(shape, 0..shape.len(), self.tether).map_err(unfit)?;
        let world = prepared.world(shape, self.closed)?.with(places);
        let world = bordered(world, prepared)?;
        let snake = Snake::new(body, world).map_err(unfit)?;
        let (stepping, _) = stepping(prepared, &snake)?;
        let begun = Simulation::of(snake, State::at_rest(shape.to_vec()), stepping);
        let mut simulation = begun.map_err(unmoved)?;
        let still = Rest {
            shape: true,
            ..Rest::default()
        };
        let mut go = |steps: u64| {
            let until = Until::at_rest(still, steps.min(prepared.options().steps));
            let watch = &mut |_: &mut Simulation| ControlFlow::Continue(());
            let outcome = simulation.run(&until, watch).map_err(unmoved)?;
            Ok((outcome, simulation.members()[0].state().x.clone()))
        };
        let (outcome, rest) = go(STEPS)?;
        let near = STILL * self.kick;
        let rests = match outcome {
            Outcome::Settled { .. } => true,
            // nodes at a corner of an edge never get quite still
            Outcome::Cycles { reach, .. } => reach < near,
            Outcome::Finished { .. } => {
                let (_, later) = go(MORE)?;
                rest.iter().zip(&later).all(|(a, b)| a.distance(*b) < near)
            }
            _ => false,
        };
        Ok(rests.then_some(rest))
    }
}
