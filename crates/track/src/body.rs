//! One object: its outline, what it looks like, how it moves, and what a frame has taught of it.

use field::Pixels;
use fit::Image;
use glam::DVec2;

use crate::edges::Edges;
use crate::evidence::{Evidence, Look};
use crate::palette::Palette;
use crate::predict::{Motion, Prediction};
use crate::profile::Profiles;
use crate::ring;
use crate::shape::Shape;
use crate::sight::{lightness, sample};
use crate::step::{Frame, State, Step};
use crate::tables::{Strips, Tables, depth};
use crate::window::{Lightness, Window, cells, to_cells, to_pixels};

/// An object's radius in cells is at most this: larger ones are seen in blocks.
const RADIUS: f64 = 50.0;

/// Distance of nodes and their number. Cells.
pub(crate) const SPACING: f64 = 2.0;
pub(crate) const NODES: [f64; 2] = [60.0, 320.0];

/// What is remembered of the first frame; how fast tables, profiles and edges follow.
const FIRST: f32 = 0.3;
const LEARN: f64 = 0.1;
const LEARN_PROFILE: f64 = 0.15;
const LEARN_EDGES: f64 = 0.1;

/// How fast the reference of evidence follows, falls while nothing is seen, and its least.
const REFERENCE: f64 = 0.2;
const FORGET: f64 = 0.97;
const LEAST_REFERENCE: f64 = 0.05;

/// First outlines have more evidence than this, if they are of anything.
const CLEAR: f64 = 0.2;

/// A node is as good as its evidence against this share of its reference, and of a least reference.
const GOOD: f64 = 0.6;
const LEAST_NODE: f64 = 0.15;

/// How far from the curve tables begin. Cells.
const MARGIN: f64 = 1.0;

/// Nodes worse than half, from this share on, make an object partly seen.
const PARTLY: f64 = 0.25;

/// After so many frames without being seen an object slows down, by this a frame.
const TIRED: u32 = 10;
const SLOWER: f64 = 0.8;

/// An object of which less than this share lies in the frame has left it.
const LEFT: f64 = 0.03;

/// An object that is followed. Lengths are cells.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub block: usize,
    pub light: Lightness,
    pub palette: Palette,
    pub curve: Vec<DVec2>,
    /// For each node where on the first outline it was, 0 … 1.
    material: Vec<f64>,
    /// Standard error of each node along its normal.
    errors: Vec<f64>,
    first: Tables,
    running: Tables,
    pub profiles: Profiles,
    pub edges: Edges,
    /// Evidence that is usual, of all and of each node.
    pub reference: f64,
    node_reference: Vec<f64>,
    pub shape: Shape,
    pub motion: Motion,
    /// How far nodes are from where they were predicted, usually.
    pub innovation: f64,
    /// How well each node was seen last, 0 … 1.
    pub quality: Vec<f64>,
    /// How clearly its first outline parts what lies on both sides, 0 … 1.
    pub clear: f64,
    /// For how many frames it was not seen, and whether it has left the frame.
    pub coasting: u32,
    pub left: bool,
    /// Where plain flow has carried its outline since it began, or was found again; None while it is not seen.
    pub plain: Option<Vec<DVec2>>,
    /// The frame in which it was seen last, and where its middle was.
    pub seen_in: Option<(Image, DVec2)>,
}

/// A curve that a frame speaks for.
#[derive(Debug)]
pub(crate) struct Seen {
    pub prediction: Prediction,
    pub curve: Vec<DVec2>,
    /// Where between the nodes of the frame before each lies; None if that is lost.
    pub places: Option<Vec<f64>>,
    pub evidence: Evidence,
    pub quality: Vec<f64>,
    pub strays: Vec<bool>,
    /// Mean way along the normals from the prediction; distance from the shape, in radii; what its distance costs.
    pub moved: f64,
    pub off: f64,
    pub price: f64,
    /// Standard error of each node.
    pub errors: Vec<f64>,
}

impl Body {
    /// An object as it is outlined in a frame; None for an outline without area in the frame.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped counts"
    )]
    pub(crate) fn new(frame: Frame<'_>, outline: &[DVec2]) -> Option<Self> {
        let outline = ring::polygon(outline).outwards();
        let radius = ring::radius(&outline.points);
        let block = (radius / RADIUS).ceil().max(1.0) as usize;
        let (columns, rows) = cells(frame.pixels.size(), block);
        let curve: Vec<DVec2> = outline
            .points
            .iter()
            .map(|p| to_cells(*p, block as f64))
            .collect();
        let radius = ring::radius(&curve);
        if radius.partial_cmp(&0.5) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        let length = elastic::length(&curve, true);
        let count = (length / SPACING).round().clamp(NODES[0], NODES[1]) as usize;
        let (curve, _) = ring::evenly(&curve, count);
        let (low, high) = ring::bounds(&curve);
        if high.x < 0.0 || high.y < 0.0 || low.x > columns as f64 || low.y > rows as f64 {
            return None;
        }
        let light = lightness(frame.pixels, block, low, high);
        let around = DVec2::splat(depth(radius).max(20.0_f64.max(1.5 * radius)) + 8.0);
        let window = Window::of(frame.pixels, block, light, low - around, high + around);
        let palette = Palette::of(&sample(&window, &curve, radius), light.color);
        let strips = Strips::of(&curve, radius);
        let tables = Tables::learnt(&window, &palette, &strips, &vec![1.0; count], MARGIN);
        let profiles = Profiles::learnt(&window, &strips);
        let edges = Edges::learnt(&window, &strips);
        let ratios = tables.ratios();
        let look = Look {
            window: &window,
            palette: &palette,
            ratios: &ratios,
            profiles: Some(&profiles),
            edges: None,
        };
        let evidence = Evidence::of(look, &strips);
        let mean = evidence.mean.max(LEAST_REFERENCE);
        let node_reference = evidence.nodes.iter().map(|m| m.unwrap_or(mean)).collect();
        Some(Self {
            block,
            light,
            palette,
            shape: Shape::new(&curve),
            motion: Motion::still(count),
            material: (0..count).map(|i| i as f64 / count as f64).collect(),
            errors: vec![0.5; count],
            plain: Some(curve.clone()),
            curve,
            first: tables.clone(),
            running: tables,
            profiles,
            edges,
            reference: mean,
            clear: (evidence.mean / CLEAR).clamp(0.0, 1.0),
            node_reference,
            innovation: 2.0,
            quality: vec![1.0; count],
            coasting: 0,
            left: false,
            seen_in: None,
        })
    }

    /// The outline, in pixels.
    pub(crate) fn outline(&self) -> Vec<DVec2> {
        self.to_pixels(&self.curve)
    }

    pub(crate) fn to_pixels(&self, curve: &[DVec2]) -> Vec<DVec2> {
        curve
            .iter()
            .map(|p| to_pixels(*p, self.block as f64))
            .collect()
    }

    pub(crate) fn to_cells(&self, curve: &[DVec2]) -> Vec<DVec2> {
        curve
            .iter()
            .map(|p| to_cells(*p, self.block as f64))
            .collect()
    }

    /// For each node the place on the first outline it has come from, as a share of its length.
    pub(crate) fn material(&self) -> &[f64] {
        &self.material
    }

    /// Standard error of each node. Pixels.
    pub(crate) fn errors(&self) -> Vec<f64> {
        self.errors
            .iter()
            .map(|error| error * self.block as f64)
            .collect()
    }

    /// The motion of its middle in pixels, and its rotation in radians, a frame.
    pub(crate) fn velocity(&self) -> (DVec2, f64) {
        (
            self.motion.shift * self.block as f64,
            self.motion.turn.to_angle(),
        )
    }

    /// The appearance that is remembered.
    pub(crate) fn remembered(&self) -> Tables {
        self.first.mixed(&self.running, 1.0 - FIRST)
    }

    /// How good each node is, by its evidence against its reference.
    pub(crate) fn quality_of(&self, evidence: &Evidence) -> Vec<f64> {
        let one = |(m, reference): (&Option<f64>, &f64)| {
            let needed = GOOD * reference.max(LEAST_NODE);
            m.map_or(0.0, |m| (m / needed).clamp(0.0, 1.0))
        };
        let own: Vec<f64> = evidence
            .nodes
            .iter()
            .zip(&self.node_reference)
            .map(one)
            .collect();
        ring::along(&own, 1.5)
    }

    /// Share of the object that lies in the frame.
    pub(crate) fn share_in(&self, pixels: &dyn Pixels, curve: &[DVec2]) -> f64 {
        let (columns, rows) = cells(pixels.size(), self.block);
        let last = DVec2::new(columns as f64, rows as f64) - 0.5;
        ring::share_within(curve, DVec2::splat(-0.5), last)
    }

    /// All that nodes have learnt, for other nodes at places between them.
    pub(crate) fn respaced(&mut self, places: &[f64]) {
        self.material = ring::turned(&self.material, places);
        self.errors = ring::between(&self.errors, places);
        self.first = self.first.respaced(places);
        self.running = self.running.respaced(places);
        self.profiles = self.profiles.respaced(places);
        self.edges = self.edges.respaced(places);
        self.node_reference = ring::between(&self.node_reference, places);
        self.shape = self.shape.respaced(places);
        self.motion.waves = ring::between(&self.motion.waves, places);
        self.quality = ring::between(&self.quality, places);
        self.plain = self
            .plain
            .as_ref()
            .map(|plain| ring::between(plain, places));
    }

    /// It was not seen: it goes on as it was going, or waits where it left the frame.
    pub(crate) fn coast(
        &mut self,
        pixels: Option<&dyn Pixels>,
        prediction: Prediction,
        confidence: f64,
    ) -> Step {
        self.coasting += 1;
        self.plain = None;
        self.reference = (self.reference * FORGET).max(LEAST_REFERENCE);
        self.node_reference.iter_mut().for_each(|m| *m *= FORGET);
        if !self.left {
            self.curve = self.motion.flown(&self.curve);
            self.left = pixels.is_some_and(|pixels| self.share_in(pixels, &self.curve) < LEFT);
        }
        if self.left {
            self.motion = Motion::still(self.curve.len());
        }
        let fade = if self.coasting > TIRED { SLOWER } else { 1.0 };
        self.motion.coast(fade);
        let wider = (0.1 * self.innovation + 0.02 * ring::radius(&self.curve)).max(0.1);
        self.errors.iter_mut().for_each(|error| *error += wider);
        let state = if self.left {
            State::Left
        } else {
            State::Coasting
        };
        Step {
            prediction,
            confidence,
            state,
            remeshed: false,
        }
    }

    /// It was seen: motion, rest shape and appearance follow.
    #[allow(clippy::cast_possible_truncation, reason = "shares of one")]
    pub(crate) fn learn(&mut self, window: &Window, seen: Seen, confidence: f64) -> Step {
        let Seen {
            prediction,
            curve,
            places,
            evidence,
            quality,
            strays,
            moved,
            off,
            errors,
            ..
        } = seen;
        let before = std::mem::replace(&mut self.curve, curve);
        self.plain = self.plain.take().or_else(|| Some(self.curve.clone()));
        let before = match &places {
            Some(places) => {
                self.material = ring::turned(&self.material, places);
                let plain = self.plain.as_ref();
                self.plain = plain.map(|plain| ring::between(plain, places));
                ring::between(&before, places)
            }
            None => before,
        };
        if self.coasting == 0 {
            self.motion.learn(&before, &self.curve, &quality);
        }
        self.innovation += 0.2 * (moved - self.innovation);
        self.shape.follow(&self.curve, &quality, &strays, off);
        let strips = Strips::of(&self.curve, ring::radius(&self.curve));
        let sure = confidence.clamp(0.0, 1.0);
        let shares =
            |rate: f64| -> Vec<f32> { quality.iter().map(|q| (rate * sure * q) as f32).collect() };
        let tables = Tables::learnt(window, &self.palette, &strips, &quality, MARGIN);
        self.running
            .learn(&tables, &shares(LEARN), (LEARN * sure) as f32);
        self.profiles
            .learn(&Profiles::learnt(window, &strips), &shares(LEARN_PROFILE));
        self.edges.learn(window, &strips, &shares(LEARN_EDGES));
        self.reference += REFERENCE * sure * (evidence.mean - self.reference);
        self.reference = self.reference.max(LEAST_REFERENCE);
        for ((reference, m), q) in self
            .node_reference
            .iter_mut()
            .zip(&evidence.nodes)
            .zip(&quality)
        {
            if let Some(m) = m {
                *reference += REFERENCE * q * (m - *reference);
            }
        }
        let bad = quality.iter().filter(|q| **q < 0.5).count();
        let state = if bad as f64 > PARTLY * quality.len() as f64 {
            State::Partly
        } else {
            State::Seen
        };
        self.errors = errors;
        self.quality = quality;
        (self.coasting, self.left) = (0, false);
        let remeshed = self.remesh();
        Step {
            prediction,
            confidence,
            state,
            remeshed,
        }
    }
}
