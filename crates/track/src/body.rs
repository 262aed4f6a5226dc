//! One object: its outline, what it looks like, how it moves; and one frame of following it.

use field::Pixels;
use flow::Pyramid;
use glam::DVec2;

use crate::State;
use crate::correct::{Band, MODES, Pass, moved, offsets, simple};
use crate::evidence::{Evidence, Look};
use crate::palette::{Feature, Palette, SAMPLE};
use crate::predict::{Flowed, Motion, Prediction, flowed};
use crate::profile::Profiles;
use crate::ring;
use crate::tables::{Strips, Tables, depth};
use crate::window::{Lightness, Window, cells, to_cells, to_pixels};

/// An object's radius in cells is at most this: larger ones are seen in blocks.
const RADIUS: f64 = 50.0;

/// Distance of nodes and their number. Cells.
const SPACING: f64 = 2.0;
const NODES: [f64; 2] = [60.0, 320.0];

/// What is remembered of the first frame; how fast tables and profiles follow.
const FIRST: f32 = 0.3;
const LEARN: f64 = 0.1;
const LEARN_PROFILE: f64 = 0.15;

/// How fast the reference of evidence follows, and falls while nothing is seen.
const REFERENCE: f64 = 0.2;
const FORGET: f64 = 0.97;

/// A candidate pays for its distance from the nearer prediction.
const PRICE: f64 = 0.2;
const GATE: f64 = 1.25;
const MOST_PRICE: f64 = 1.5;

/// Evidence against the reference below which an object is not seen, unless this share of its nodes is.
const UNSEEN: f64 = 0.35;
const NODES_SEEN: f64 = 0.35;
const SIZES: [f64; 2] = [0.4, 2.5];

/// A node is as good as its evidence against this share of its reference, and of a least reference.
const GOOD: f64 = 0.6;
const LEAST_REFERENCE: f64 = 0.15;

/// Pull towards the rest shape: of good nodes, and of bad ones more.
const PULL: f64 = 0.05;
const PULL_BAD: f64 = 0.5;

/// Margin of the tables: in the first frame and later. Cells.
const MARGIN: f64 = 1.0;

/// How much worse the curve may become by a pass.
const LOST_POSE: f64 = 0.01;
const LOST_LOW: f64 = 0.02;

/// A frame: its pixels and the sizes in which flow sees it and the one before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub pixels: &'a dyn Pixels,
    pub pyramid: &'a Pyramid,
    pub before: Option<&'a Pyramid>,
}

/// An object that is followed.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    block: usize,
    light: Lightness,
    palette: Palette,
    /// Nodes, in cells, and for each where on the first outline it was, 0 … 1.
    curve: Vec<DVec2>,
    material: Vec<f64>,
    /// Standard error of each node along its normal. Cells.
    errors: Vec<f64>,
    first: Tables,
    running: Tables,
    profiles: Profiles,
    reference: f64,
    node_reference: Vec<f64>,
    rest: Vec<DVec2>,
    deviation: f64,
    motion: Motion,
    innovation: f64,
    coasting: u32,
    plain: Vec<DVec2>,
}

/// What a frame has said of an object.
#[derive(Debug, Clone)]
pub(crate) struct Step {
    pub prediction: Prediction,
    /// Evidence against the reference.
    pub confidence: f64,
    /// Of each node, 0 … 1.
    pub quality: Vec<f64>,
    pub seen: bool,
}

/// Nodes worse than half, from this share on, make an object partly seen.
const PARTLY: f64 = 0.25;

impl Step {
    pub(crate) fn state(&self) -> State {
        if !self.seen {
            return State::Coasting;
        }
        let bad = self.quality.iter().filter(|q| **q < 0.5).count();
        if bad as f64 > PARTLY * self.quality.len() as f64 {
            State::Partly
        } else {
            State::Seen
        }
    }
}

struct Candidate {
    prediction: Prediction,
    curve: Vec<DVec2>,
}

struct Judged {
    prediction: Prediction,
    curve: Vec<DVec2>,
    places: Option<Vec<f64>>,
    evidence: Evidence,
    price: f64,
    moved: f64,
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
        let low = curve.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = curve.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        if high.x < 0.0 || high.y < 0.0 || low.x > columns as f64 || low.y > rows as f64 {
            return None;
        }
        let light = lightness(frame.pixels, block, low, high);
        let around = DVec2::splat(depth(radius).max(20.0_f64.max(1.5 * radius)) + 8.0);
        let window = Window::of(frame.pixels, block, light, low - around, high + around);
        let palette = Palette::of(&sample(&window, &curve, radius), light.color);
        let strips = Strips::of(&curve, radius);
        let tables = Tables::learnt(&window, &palette, &strips, MARGIN);
        let profiles = Profiles::learnt(&window, &strips);
        let ratios = tables.ratios();
        let look = Look {
            window: &window,
            palette: &palette,
            ratios: &ratios,
            profiles: Some(&profiles),
        };
        let evidence = Evidence::of(look, &strips);
        let mean = evidence.mean.max(0.05);
        let node_reference = evidence.nodes.iter().map(|m| m.unwrap_or(mean)).collect();
        Some(Self {
            block,
            light,
            palette,
            rest: curve.clone(),
            plain: curve.clone(),
            motion: Motion::still(count),
            material: (0..count).map(|i| i as f64 / count as f64).collect(),
            errors: vec![0.5; count],
            curve,
            first: tables.clone(),
            running: tables,
            profiles,
            reference: mean,
            node_reference,
            deviation: 0.06,
            innovation: 2.0,
            coasting: 0,
        })
    }

    /// The outline, in pixels.
    pub(crate) fn outline(&self) -> Vec<DVec2> {
        self.curve
            .iter()
            .map(|p| to_pixels(*p, self.block as f64))
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

    /// Go on without a frame.
    pub(crate) fn skip(&mut self) -> Step {
        self.coast(Prediction::Flown, 0.0, vec![0.0; self.curve.len()])
    }

    /// Follow it into the next frame.
    pub(crate) fn next(&mut self, frame: Frame<'_>) -> Step {
        let block = self.block as f64;
        let flow = frame
            .before
            .and_then(|before| flowed(before, frame.pyramid, &self.curve, block));
        let plain = frame
            .before
            .and_then(|before| flowed(before, frame.pyramid, &self.plain, block));
        if let Some(plain) = plain {
            self.plain = plain.bent;
        }
        let candidates = self.candidates(flow.as_ref());
        let radius = ring::radius(&self.curve);
        let window = self.window(frame.pixels, &candidates, radius);
        let ratios = self.first.mixed(&self.running, 1.0 - FIRST).ratios();
        let look = Look {
            window: &window,
            palette: &self.palette,
            ratios: &ratios,
            profiles: Some(&self.profiles),
        };
        let Some(best) = self.best(look, candidates, flow.as_ref(), radius) else {
            return self.coast(Prediction::Flown, 0.0, vec![0.0; self.curve.len()]);
        };
        let confidence = best.evidence.mean / self.reference;
        let quality = self.quality(&best.evidence);
        let seen = quality.iter().filter(|q| **q > 0.5).count() as f64 / quality.len() as f64;
        let size = (ring::radius(&best.curve) / radius).powi(2);
        if (confidence < UNSEEN && seen < NODES_SEEN) || size < SIZES[0] || size > SIZES[1] {
            return self.coast(best.prediction, confidence, quality);
        }
        self.learn(&window, best, confidence, quality)
    }

    /// Where it may be.
    fn candidates(&self, flow: Option<&Flowed>) -> Vec<Candidate> {
        let one = |prediction, curve| Candidate { prediction, curve };
        let mut candidates = vec![
            one(Prediction::Flown, self.motion.flown(&self.curve)),
            one(Prediction::Still, self.curve.clone()),
        ];
        if let Some(flow) = flow {
            candidates.push(one(Prediction::Carried, flow.carried.clone()));
            candidates.push(one(Prediction::Bent, flow.bent.clone()));
        }
        candidates
    }

    /// The window that holds all candidates.
    fn window(&self, pixels: &dyn Pixels, candidates: &[Candidate], radius: f64) -> Window {
        let points = || {
            candidates
                .iter()
                .flat_map(|candidate| &candidate.curve)
                .copied()
        };
        let low = points().fold(DVec2::INFINITY, DVec2::min);
        let high = points().fold(DVec2::NEG_INFINITY, DVec2::max);
        let margin = DVec2::splat(depth(radius) + 24.0);
        Window::of(pixels, self.block, self.light, low - margin, high + margin)
    }

    /// The best candidate, corrected.
    fn best(
        &self,
        look: Look<'_>,
        candidates: Vec<Candidate>,
        flow: Option<&Flowed>,
        radius: f64,
    ) -> Option<Judged> {
        let waits = 1.0 + 0.5 * f64::from(self.coasting);
        let gate = GATE * radius * waits;
        let mut centers = vec![ring::middle(&candidates.first()?.curve)];
        if let Some(flow) = flow {
            centers.push(ring::middle(&flow.carried));
        }
        let price = |curve: &[DVec2]| {
            let center = ring::middle(curve);
            let far = centers
                .iter()
                .map(|c| c.distance_squared(center))
                .fold(f64::INFINITY, f64::min);
            PRICE * (far / (gate * gate)).min(MOST_PRICE)
        };
        let mut judged: Vec<Judged> = candidates
            .into_iter()
            .map(|Candidate { prediction, curve }| {
                let evidence = Evidence::of(look, &Strips::of(&curve, radius));
                let price = price(&curve);
                Judged {
                    prediction,
                    curve,
                    places: None,
                    evidence,
                    price,
                    moved: 0.0,
                }
            })
            .collect();
        let score = |judged: &Judged| judged.evidence.mean / self.reference - judged.price;
        judged.sort_by(|a, b| score(b).total_cmp(&score(a)));
        let top = score(&judged[0]);
        let first = ring::middle(&judged[0].curve);
        let second = judged.iter().skip(1).find(|other| {
            score(other) > top - 0.3 && ring::middle(&other.curve).distance(first) > 2.0
        });
        let mut tried = vec![self.corrected(look, &judged[0], radius, waits)];
        tried.extend(second.map(|second| self.corrected(look, second, radius, waits)));
        let value = |judged: &Judged| {
            let off = self.off_rest(&judged.curve) / self.deviation;
            score(judged) - 0.05 * off.min(3.0)
        };
        tried
            .into_iter()
            .max_by(|a, b| value(a).total_cmp(&value(b)))
    }

    /// How far a shape is from the rest shape, in radii.
    fn off_rest(&self, curve: &[DVec2]) -> f64 {
        let even = vec![1.0; curve.len()];
        let motion = ring::laid(&self.rest, curve, &even);
        let squares = self
            .rest
            .iter()
            .zip(curve)
            .map(|(a, b)| motion.at(*a).distance_squared(*b));
        (squares.sum::<f64>() / curve.len() as f64).sqrt() / ring::radius(curve).max(1.0)
    }

    /// A candidate brought onto its evidence.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a band of a few cells"
    )]
    fn corrected(&self, look: Look<'_>, from: &Judged, radius: f64, waits: f64) -> Judged {
        let tether = (1.5 * self.innovation).clamp(2.0, (0.5 * radius).max(2.0)) * waits;
        let half = (2.2 * tether).ceil().clamp(3.0, 12.0);
        let wide = half.max(0.15 * radius).clamp(4.0, 16.0);
        let mut curve = from.curve.clone();
        let mut evidence = from.evidence.clone();
        for (pass, half, lost) in [
            (Pass::Pose, wide, LOST_POSE),
            (Pass::Pose, wide, LOST_POSE),
            (Pass::Low, half, LOST_LOW),
        ] {
            let strips = Strips::of(&curve, radius);
            let band = Band {
                tether,
                half: half as usize,
            };
            let Some(found) = offsets(look, &strips, band) else {
                continue;
            };
            let next = moved(&strips, &found, pass);
            let after = Evidence::of(look, &Strips::of(&next, radius));
            if after.mean > evidence.mean - lost {
                (curve, evidence) = (next, after);
            }
        }
        let strips = Strips::of(&curve, radius);
        let band = Band {
            tether,
            half: half as usize,
        };
        let mut normal = 0.0;
        let mut places = None;
        if let Some(found) = offsets(look, &strips, band) {
            let next = moved(&strips, &found, Pass::Full);
            normal =
                found.offsets.iter().map(|d| d.abs()).sum::<f64>() / found.offsets.len() as f64;
            let after = Evidence::of(look, &Strips::of(&next, radius));
            let quality = self.quality(&after);
            let next = self.remembered(&next, &quality);
            if let Some((next, at)) = simple(&next, curve.len()) {
                evidence = Evidence::of(look, &Strips::of(&next, radius));
                (curve, places) = (next, at);
            }
        }
        Judged {
            prediction: from.prediction,
            curve,
            places,
            evidence,
            price: from.price,
            moved: normal,
        }
    }

    /// A curve pulled towards the rest shape laid on it.
    fn remembered(&self, curve: &[DVec2], quality: &[f64]) -> Vec<DVec2> {
        let weights: Vec<f64> = quality.iter().map(|q| q + 0.02).collect();
        let laid = ring::laid(&self.rest, curve, &weights);
        let pulled = curve.iter().zip(&self.rest).zip(quality);
        pulled
            .map(|((p, rest), q)| p.lerp(laid.at(*rest), PULL + PULL_BAD * (1.0 - q)))
            .collect()
    }

    /// How good each node is, by its evidence against its reference.
    fn quality(&self, evidence: &Evidence) -> Vec<f64> {
        let one = |(m, reference): (&Option<f64>, &f64)| {
            let needed = GOOD * reference.max(LEAST_REFERENCE);
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

    /// It was not seen: it goes on as it was going.
    fn coast(&mut self, prediction: Prediction, confidence: f64, quality: Vec<f64>) -> Step {
        let from = self.curve.clone();
        self.curve = self.motion.flown(&from);
        self.plain.clone_from(&self.curve);
        self.coasting += 1;
        self.reference *= FORGET;
        self.node_reference.iter_mut().for_each(|m| *m *= FORGET);
        let fade = if self.coasting > 10 { 0.8 } else { 1.0 };
        self.motion.shift *= fade;
        self.motion.turn = DVec2::X.lerp(self.motion.turn, fade);
        self.motion.waves.iter_mut().for_each(|wave| *wave *= 0.5);
        Step {
            prediction,
            confidence,
            quality,
            seen: false,
        }
    }

    /// It was seen: motion, rest shape and appearance follow.
    fn learn(&mut self, window: &Window, best: Judged, confidence: f64, quality: Vec<f64>) -> Step {
        let radius = ring::radius(&best.curve);
        let before = std::mem::replace(&mut self.curve, best.curve);
        let n = self.curve.len();
        let before = match &best.places {
            Some(places) => ring::between(&before, places),
            None => before,
        };
        let even = vec![1.0; n];
        let motion = ring::laid(&before, &self.curve, &even).about(ring::middle(&before));
        if self.coasting == 0 {
            self.motion.shift = 0.95 * (0.3 * self.motion.shift + 0.7 * motion.shift);
            let turn = 0.3 * self.motion.turn + 0.7 * motion.turn;
            self.motion.turn = DVec2::X.lerp(turn, 0.8);
            let waves: Vec<DVec2> = before
                .iter()
                .zip(&self.curve)
                .map(|(a, b)| *b - motion.at(*a))
                .collect();
            let slow = ring::lowpass(&waves, MODES);
            let waves = self.motion.waves.iter_mut().zip(slow);
            waves.for_each(|(wave, slow)| *wave = 0.5 * *wave + 0.25 * slow);
        }
        self.innovation = 0.8 * self.innovation + 0.2 * best.moved;
        let weights: Vec<f64> = quality.iter().map(|q| q + 0.02).collect();
        let laid = ring::laid(&self.rest, &self.curve, &weights);
        let off = self.off_rest(&self.curve);
        self.deviation = (0.95 * self.deviation + 0.05 * off).max(0.02);
        for ((rest, p), q) in self.rest.iter_mut().zip(&self.curve).zip(&quality) {
            let on = laid.at(*rest);
            *rest = on.lerp(*p, 0.2 * q);
        }
        let strips = Strips::of(&self.curve, radius);
        let tables = Tables::learnt(window, &self.palette, &strips, MARGIN);
        let sure = confidence.clamp(0.0, 1.0);
        let shares =
            |rate: f64| -> Vec<f32> { quality.iter().map(|q| (rate * sure * q) as f32).collect() };
        self.running
            .learn(&tables, &shares(LEARN), (LEARN * sure) as f32);
        self.profiles
            .learn(&Profiles::learnt(window, &strips), &shares(LEARN_PROFILE));
        self.reference += REFERENCE * sure * (best.evidence.mean - self.reference);
        self.reference = self.reference.max(0.05);
        for ((reference, m), q) in self
            .node_reference
            .iter_mut()
            .zip(&best.evidence.nodes)
            .zip(&quality)
        {
            if let Some(m) = m {
                *reference += REFERENCE * q * (m - *reference);
            }
        }
        self.coasting = 0;
        Step {
            prediction: best.prediction,
            confidence,
            quality,
            seen: true,
        }
    }
}

/// How levels near an object become lightness.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the frame"
)]
fn lightness(pixels: &dyn Pixels, block: usize, low: DVec2, high: DVec2) -> Lightness {
    let size = block as f64;
    let (width, height) = pixels.size();
    let clamped = |v: f64, most: usize| v.clamp(0.0, (most - 1) as f64) as usize;
    let (low, high) = (to_pixels(low - 15.0, size), to_pixels(high + 15.0, size));
    let (left, right) = (clamped(low.x, width), clamped(high.x, width));
    let (top, bottom) = (clamped(low.y, height), clamped(high.y, height));
    let mut levels = Vec::new();
    for y in (top..=bottom).step_by(block) {
        levels.extend(
            (left..=right)
                .step_by(block)
                .map(|x| pixels.level(x, y))
                .filter(|v| v.is_finite()),
        );
    }
    levels.sort_by(f64::total_cmp);
    let at = |share: f64| {
        levels
            .get(((levels.len().max(1) - 1) as f64 * share) as usize)
            .copied()
            .unwrap_or(0.0)
    };
    let (low, high) = (at(0.01), at(0.99));
    let span = high - low;
    let factor = if span > 1e-9 { 100.0 / span } else { 0.0 };
    Lightness {
        low,
        factor,
        color: pixels.is_color(),
    }
}

/// Features of the object and of its surroundings, at most so many of each.
fn sample(window: &Window, curve: &[DVec2], radius: f64) -> Vec<Feature> {
    let inside = window.inside(curve);
    let reach = 20.0_f64.max(1.5 * radius);
    let low = curve.iter().copied().fold(DVec2::INFINITY, DVec2::min) - reach;
    let high = curve.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max) + reach;
    let near = |at: usize| {
        let p = DVec2::new(
            (window.left + at % window.width) as f64,
            (window.top + at / window.width) as f64,
        );
        p.cmpge(low).all() && p.cmple(high).all()
    };
    let mut features = Vec::new();
    for side in [true, false] {
        let list: Vec<usize> = (0..inside.len())
            .filter(|&at| inside[at] == side && near(at))
            .collect();
        features.extend(
            list.iter()
                .step_by(list.len().div_ceil(SAMPLE).max(1))
                .map(|&at| window.features[at]),
        );
    }
    features
}
