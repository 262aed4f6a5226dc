//! One frame of following an object: predicted, looked for where that is not enough, corrected, judged.

use glam::DVec2;

use crate::body::{Body, Seen};
use crate::candidates::Predicted;
use crate::correct::{ALL, Band, EDGES, Offsets, Pass, moved, offsets, simple};
use crate::edges::half;
use crate::evidence::{Evidence, Look};
use crate::predict::Prediction;
use crate::ring;
use crate::seek::sought;
use crate::step::{Frame, Step};
use crate::tables::{Strips, depth};
use crate::window::Window;

/// A candidate pays for its distance from the nearer prediction.
const PRICE: f64 = 0.2;
const GATE: f64 = 1.25;
const MOST_PRICE: f64 = 1.5;

/// A second candidate is corrected too if it is nearly as good and so far away. Cells.
const NEARLY: f64 = 0.3;
const ELSEWHERE: f64 = 2.0;

/// What an unusual shape costs a candidate, a usual deviation, and at most.
const UNUSUAL: f64 = 0.05;
const MOST_UNUSUAL: f64 = 3.0;

/// Evidence against the reference below which an object is not seen, unless this share of its nodes is.
const UNSEEN: f64 = 0.35;
const NODES_SEEN: f64 = 0.5;
const SIZES: [f64; 2] = [0.4, 2.5];

/// An object is looked for elsewhere below this evidence, within so many radii, and is found from that evidence on.
const LOOK: f64 = 0.5;
const REACH: f64 = 4.0;
const FOUND: f64 = 0.5;

/// The last tether and half width of the band of correction.
const TETHER: f64 = 1.5;
const LEAST_TETHER: f64 = 2.0;
const HALF: f64 = 2.2;
const HALVES: [f64; 2] = [3.0, 12.0];
const POSE: f64 = 0.15;
const POSES: [f64; 2] = [4.0, 16.0];

/// How much worse the curve may become by a pass.
const LOST_POSE: f64 = 0.01;
const LOST_LOW: f64 = 0.02;

/// A node that is not held has this weight in the pose.
const LOOSE: f64 = 0.05;

/// Standard error of a node whose edge is as steep as three quarters of the window are not, the least, and σ of the
/// smoothing along the curve in nodes.
const ERROR: f64 = 0.5;
/// … and what the smoothing of shapes leaves of a deformation.
const LAG: f64 = 0.15;
const LEAST_ERROR: f64 = 0.03;
const ERRORS_ALONG: f64 = 2.0;

/// Beyond the candidates a window shows so much more. Cells.
pub(crate) const MARGIN: f64 = 24.0;

impl Body {
    /// Follow it into the next frame; `others` are where other objects are expected, in pixels.
    pub(crate) fn follow(
        &mut self,
        frame: Frame<'_>,
        predicted: &Predicted,
        others: &[Vec<DVec2>],
    ) -> Step {
        let radius = ring::radius(&self.curve);
        self.plain.clone_from(&predicted.plain);
        let mut window = self.window(frame, &predicted.candidates, 0.0);
        self.mark(&mut window, predicted.expected(), others);
        let mut best = self.best(&window, predicted, radius);
        let confidence = |seen: &Option<Seen>| {
            seen.as_ref()
                .map_or(0.0, |seen| seen.evidence.mean / self.reference)
        };
        if confidence(&best) < LOOK || self.coasting > 0 {
            let reach = REACH * radius * self.waits();
            let mut wide = self.window(frame, &predicted.candidates[..1], reach);
            self.mark(&mut wide, predicted.expected(), others);
            let found = self.elsewhere(&wide, predicted, radius, reach);
            let there = found
                .as_ref()
                .is_some_and(|found| self.was_there(found, radius));
            if !there && confidence(&found) > FOUND.max(confidence(&best)) {
                (best, window) = (found, wide);
            }
        }
        let sure = confidence(&best);
        let Some(best) = best else {
            return self.coast(Some(frame.pixels), Prediction::Flown, 0.0);
        };
        let seen =
            best.quality.iter().filter(|q| **q > 0.5).count() as f64 / best.quality.len() as f64;
        let size = (ring::radius(&best.curve) / radius).powi(2);
        let lost = (sure < UNSEEN && seen < NODES_SEEN) || !(SIZES[0]..=SIZES[1]).contains(&size);
        if lost || (self.left && sure < FOUND) {
            return self.coast(Some(frame.pixels), best.prediction, sure);
        }
        self.learn(&window, best, sure)
    }

    /// How much farther it may be for every frame in which it was not seen.
    fn waits(&self) -> f64 {
        1.0 + 0.5 * f64::from(self.coasting.min(10))
    }

    /// The window that holds all candidates and what lies within `reach`.
    fn window(
        &self,
        frame: Frame<'_>,
        candidates: &[(Prediction, Vec<DVec2>)],
        reach: f64,
    ) -> Window {
        let points: Vec<DVec2> = candidates
            .iter()
            .flat_map(|(_, curve)| curve)
            .copied()
            .collect();
        let (low, high) = ring::bounds(&points);
        let margin = DVec2::splat(depth(ring::radius(&self.curve)) + MARGIN + reach);
        Window::of(
            frame.pixels,
            self.block,
            self.light,
            low - margin,
            high + margin,
        )
    }

    fn mark(&self, window: &mut Window, expected: &[DVec2], others: &[Vec<DVec2>]) {
        for other in others {
            window.own(expected, &self.to_cells(other));
        }
    }

    /// The best candidate, corrected.
    fn best(&self, window: &Window, predicted: &Predicted, radius: f64) -> Option<Seen> {
        let ratios = self.remembered().ratios();
        let look = Look {
            window,
            palette: &self.palette,
            ratios: &ratios,
            profiles: Some(&self.profiles),
            edges: Some((&self.edges, half(window))),
        };
        let mut judged: Vec<(Prediction, &[DVec2], Evidence, f64)> = predicted
            .candidates
            .iter()
            .map(|(prediction, curve)| {
                let evidence = Evidence::of(look, &Strips::of(curve, radius));
                let price = self.price(predicted, curve, radius);
                (*prediction, curve.as_slice(), evidence, price)
            })
            .collect();
        let score = |evidence: &Evidence, price: f64| evidence.mean / self.reference - price;
        judged.sort_by(|a, b| score(&b.2, b.3).total_cmp(&score(&a.2, a.3)));
        let top = score(&judged[0].2, judged[0].3);
        let first = ring::middle(judged[0].1);
        let second = judged.iter().skip(1).find(|other| {
            score(&other.2, other.3) > top - NEARLY
                && ring::middle(other.1).distance(first) > ELSEWHERE
        });
        let tried = judged.first().into_iter().chain(second);
        tried
            .map(|(prediction, curve, evidence, price)| {
                self.corrected(look, *prediction, curve, evidence, *price, radius)
            })
            .max_by(|a, b| self.value(a).total_cmp(&self.value(b)))
    }

    /// The best of the places where it looks as it does, corrected.
    fn elsewhere(
        &self,
        window: &Window,
        predicted: &Predicted,
        radius: f64,
        reach: f64,
    ) -> Option<Seen> {
        let tables = self.remembered();
        let ratios = tables.ratios();
        let look = Look {
            window,
            palette: &self.palette,
            ratios: &ratios,
            profiles: Some(&self.profiles),
            edges: Some((&self.edges, half(window))),
        };
        let pooled = tables.pooled_ratios();
        let curve = &predicted.candidates[0].1;
        let places = sought(
            window,
            &self.palette,
            &|class| pooled[usize::from(class)],
            curve,
            reach,
        );
        places
            .into_iter()
            .map(|curve| {
                let evidence = Evidence::of(look, &Strips::of(&curve, radius));
                let price = self.price(predicted, &curve, radius);
                self.corrected(look, Prediction::Searched, &curve, &evidence, price, radius)
            })
            .max_by(|a, b| self.value(a).total_cmp(&self.value(b)))
    }

    /// What a curve's distance from the nearer prediction costs.
    fn price(&self, predicted: &Predicted, curve: &[DVec2], radius: f64) -> f64 {
        let gate = GATE * radius * self.waits();
        let center = ring::middle(curve);
        let flown = ring::middle(&predicted.candidates[0].1).distance(center);
        let carried = predicted
            .flow
            .as_ref()
            .map(|flow| ring::middle(&flow.carried).distance(center));
        let far = carried.map_or(flown, |carried| carried.min(flown)) / gate;
        PRICE * (far * far).min(MOST_PRICE)
    }

    fn value(&self, seen: &Seen) -> f64 {
        let unusual = UNUSUAL * self.shape.distance(&seen.curve).min(MOST_UNUSUAL);
        seen.evidence.mean / self.reference - seen.price - unusual
    }

    /// A candidate brought onto its evidence.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a band of a few cells"
    )]
    fn corrected(
        &self,
        look: Look<'_>,
        prediction: Prediction,
        from: &[DVec2],
        evidence: &Evidence,
        price: f64,
        radius: f64,
    ) -> Seen {
        let most = (0.5 * radius).max(LEAST_TETHER);
        let tether = (TETHER * self.innovation).clamp(LEAST_TETHER, most) * self.waits();
        let half = (HALF * tether).ceil().clamp(HALVES[0], HALVES[1]);
        let wide = half.max(POSE * radius).clamp(POSES[0], POSES[1]);
        let mut curve = from.to_vec();
        let mut evidence = evidence.clone();
        let passes = [
            (Pass::Pose, wide, LOST_POSE),
            (Pass::Pose, wide, LOST_POSE),
            (Pass::Low, half, LOST_LOW),
        ];
        for (pass, half, lost) in passes {
            let strips = Strips::of(&curve, radius);
            let Some(found) = self.offsets(
                look,
                &strips,
                Band {
                    tether,
                    half: half as usize,
                },
            ) else {
                continue;
            };
            let next = moved(&strips, &found, pass);
            let after = Evidence::of(look, &Strips::of(&next, radius));
            if after.mean > evidence.mean - lost {
                (curve, evidence) = (next, after);
            }
        }
        let n = curve.len();
        let mut seen = Seen {
            prediction,
            curve,
            places: None,
            quality: vec![0.0; n],
            evidence,
            strays: vec![false; n],
            moved: 0.0,
            off: self.shape.deviation,
            price,
            errors: vec![tether; n],
        };
        let strips = Strips::of(&seen.curve, radius);
        let Some(found) = self.offsets(
            look,
            &strips,
            Band {
                tether,
                half: half as usize,
            },
        ) else {
            return seen;
        };
        let next = moved(&strips, &found, Pass::Full);
        let next = fine(look, &next, radius);
        seen.moved = found.offsets.iter().map(|d| d.abs()).sum::<f64>() / n as f64;
        let after = Evidence::of(look, &Strips::of(&next, radius));
        let mut quality = self.quality_of(&after);
        let kept = self.shape.kept(&next, &mut quality, &self.quality);
        (seen.strays, seen.off) = (kept.strays, kept.off);
        if let Some((next, places)) = simple(
            &kept.curve,
            n,
            self.shape.slid(&kept.curve, &quality).unwrap_or(0.0),
        ) {
            seen.evidence = Evidence::of(look, &Strips::of(&next, radius));
            (seen.curve, seen.places) = (next, places);
        }
        seen.quality = self.quality_of(&seen.evidence);
        for (quality, stray) in seen.quality.iter_mut().zip(&seen.strays) {
            if *stray {
                *quality = 0.0;
            }
        }
        if let Some(curve) = placed(look, &seen, radius) {
            seen.curve = curve;
        }
        seen.errors = self.errors_of(look, &seen, radius, tether);
        seen
    }

    /// Standard errors of nodes: by how much steeper their edge is than what else the window shows, by how far from it
    /// they were left, all along a stretch; where they were not seen, by how far nodes of this object go.
    fn errors_of(&self, look: Look<'_>, seen: &Seen, radius: f64, most: f64) -> Vec<f64> {
        let strips = Strips::of(&seen.curve, radius);
        let unseen = (self.shape.deviation * radius).max(1.0);

        let beyond = look
            .edges
            .map(|(edges, half)| edges.beyond(look.window, &strips, half));
        let own = |i: usize| {
            let Some((edges, half)) = look.edges else {
                return most;
            };
            let slope = f64::from(edges.slope(look.window, &strips, i, edges.offsets[i]));
            let error = (ERROR * f64::from(half) / slope.max(1e-9))
                .hypot(LAG * self.shape.deviation * radius)
                .hypot(beyond.as_ref().map_or(0.0, |beyond| beyond[i][0]));
            let quality = seen.quality[i];
            quality * error.clamp(LEAST_ERROR, most) + (1.0 - quality) * unseen
        };
        let own: Vec<f64> = (0..seen.curve.len()).map(own).collect();
        ring::along(&own, ERRORS_ALONG)
    }

    /// Offsets, those of nodes that were not seen with little weight.
    fn offsets(&self, look: Look<'_>, strips: &Strips<'_>, band: Band) -> Option<Offsets> {
        let mut found = offsets(look, strips, band, ALL)?;
        found
            .held
            .iter_mut()
            .zip(&self.quality)
            .for_each(|(held, q)| *held *= LOOSE + q);
        Some(found)
    }
}

/// A stretch of a curve is led to the edge beside it from less than so many cells, and this share of the way.
const ASIDE: f64 = 0.75;
const THERE: f64 = 0.7;

/// The band in which a curve that was found is placed on its edge.
const FINE: Band = Band {
    tether: 1.5,
    half: 2,
};

/// A curve that lies beside its edge all along a stretch, as the memory of its shape leaves it: most of the way there.
fn placed(look: Look<'_>, seen: &Seen, radius: f64) -> Option<Vec<DVec2>> {
    let (edges, half) = look.edges?;
    let strips = Strips::of(&seen.curve, radius);
    let beyond = edges.beyond(look.window, &strips, half);
    let one = |(i, [off, firm]): (usize, &[f64; 2])| {
        let way = if off.abs() < ASIDE { *off } else { 0.0 };
        seen.curve[i] + THERE * seen.quality[i] * firm.min(1.0) * way * strips.normals[i]
    };
    Some(beyond.iter().enumerate().map(one).collect())
}

/// A curve placed on its edge, where it has one.
fn fine(look: Look<'_>, curve: &[DVec2], radius: f64) -> Vec<DVec2> {
    let strips = Strips::of(curve, radius);
    let found = offsets(look, &strips, FINE, EDGES);
    found.map_or_else(
        || curve.to_vec(),
        |found| moved(&strips, &found, Pass::Full),
    )
}
