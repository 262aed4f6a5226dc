//! Objects of which nothing is known: outlines about blobs of all sizes, and which of them the picture supports.

use field::{Grid, Pixels};
use glam::DVec2;
use search::along::Polygon;
use search::whole::{Whole, quantile};

use crate::blobs::{Blob, GROWTH, blobs};
use crate::model::{Model, Seed};
use crate::rays::{COARSE, promise, rays};
use crate::rules::Rules;
use crate::seeded::{learnt, mask, scale_for};
use crate::seeds::Circle;
use crate::select::{Choice, select};
use crate::spans::Spans;
use crate::support::{Support, support};

/// Radii of blobs at the scale of each octave, in its pixels.
const SMALLEST: f64 = 8.0;

/// The largest blob, as a share of the picture's shorter side.
const LARGEST: f64 = 0.35;

/// A picture may be enlarged once if it has no more pixels than this then.
const MOST_PIXELS: usize = 6_000_000;

/// Mean edge from which on an outline is worth something, and what the region adds to it.
const WORTH: f64 = 0.5;
const REGION: f64 = 1.0;

/// An outline that fills so much of its hull is as good as convex, and one that fills so little is worth nothing.
const CONVEX: f64 = 0.98;
const HOLLOW: f64 = 0.88;

/// Height from which on a blob of the likelihood counts.
const LIKELY: f64 = 0.15;

/// Price of an outline, in lengths of a large one of those chosen first.
const COST: f64 = 0.12;

/// Blobs are the same whose middles and radii differ by less than this share of a radius.
const SAME: f64 = 0.12;

/// An outline may be divided at so many blobs in it, smaller than it by a factor and apart by this share of their
/// radii's sum.
const FEW: usize = 8;
const SMALLER: f64 = 0.9;
const APART: f64 = 0.6;

/// Outlines are neighbours whose middles are nearer than so many times the sum of their inner radii.
const BESIDE: f64 = 2.8;

/// An outline to choose from, in the picture.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    pub curve: Vec<DVec2>,
    pub value: f64,
}

/// What an outline of some length is worth.
fn value(support: &Support, length: f64) -> f64 {
    let shape = ((support.solidity - HOLLOW) / (CONVEX - HOLLOW)).clamp(0.0, 1.0);
    let edge = f64::midpoint(support.edge, support.closed) + REGION * support.region;
    let own = edge - WORTH;
    length * if own > 0.0 { own * shape } else { own }
}

/// A circle in each object, and the outlines by which they were found; in rows from the top.
pub(crate) fn auto(pixels: &dyn Pixels, rules: &Rules) -> Vec<Candidate> {
    let levels = octaves(pixels);
    let mut best: (f64, Vec<Candidate>, Vec<Candidate>) = (0.0, Vec::new(), Vec::new());
    for sign in [1.0, -1.0] {
        let mut all = Vec::new();
        for (at, whole) in levels.iter().enumerate() {
            let direction = main_color(whole);
            let grid = along(whole, direction);
            let radii = sizes(whole, at);
            let model = Model {
                whole,
                likelihood: None,
                polarity: Some(direction.map(|v| sign * v)),
            };
            let found = blobs(&grid, &radii, whole.noise());
            all.extend(outlines(
                &model,
                found.iter().filter(|blob| blob.height * sign > 0.0),
                rules,
            ));
        }
        let chosen = choose(pixels, &all);
        let sum: f64 = chosen.iter().map(|one| one.value).sum();
        if sum > best.0 {
            best = (sum, chosen, all);
        }
    }
    let (_, chosen, all) = best;
    if chosen.is_empty() {
        return chosen;
    }
    again(pixels, &chosen, &all, rules)
}

/// Choose again among outlines that know what objects look like.
fn again(
    pixels: &dyn Pixels,
    chosen: &[Candidate],
    all: &[Candidate],
    rules: &Rules,
) -> Vec<Candidate> {
    let circles: Vec<Circle> = chosen.iter().map(|one| circle(&one.curve)).collect();
    let whole = Whole::new(pixels, scale_for(pixels, &circles));
    let own: Vec<Vec<DVec2>> = chosen
        .iter()
        .map(|one| one.curve.iter().map(|p| whole.inward(*p)).collect())
        .collect();
    let model = learnt(&whole, &mask(whole.dim(), own.iter().map(Vec::as_slice)));
    let mut sizes: Vec<f64> = circles
        .iter()
        .map(|one| 2.0 * one.radius * whole.scale())
        .collect();
    let (low, high) = (quantile(&mut sizes, 0.1), quantile(&mut sizes, 0.9));
    let mut places = Vec::new();
    if let Some(likelihood) = &model.likelihood {
        let radii = radii(0.6 * low, 1.5 * high, LARGEST * shorter(&whole));
        places = blobs(likelihood, &radii, 0.0);
        places.retain(|blob| blob.height > LIKELY);
    }
    places.extend(all.iter().filter(|one| one.value > 0.0).map(|one| {
        let circle = circle(&one.curve);
        Blob {
            center: whole.inward(circle.center),
            radius: 2.0 * circle.radius * whole.scale(),
            height: one.value,
        }
    }));
    let places = apart(places);
    let mut all = outlines(&model, places.iter(), rules);
    let mut lengths: Vec<f64> = chosen
        .iter()
        .map(|one| elastic::length(&one.curve, true))
        .collect();
    let cost = COST * quantile(&mut lengths, 0.75);
    all.iter_mut().for_each(|one| one.value -= cost);
    let mut chosen = choose(pixels, &all);
    for _ in 0..2 {
        let mut more: Vec<Candidate> = chosen
            .iter()
            .flat_map(|one| divided(&model, one, &places, rules))
            .collect();
        more.extend(united(&model, &chosen, rules));
        more.iter_mut().for_each(|one| one.value -= cost);
        all.extend(more);
        chosen = choose(pixels, &all);
    }
    chosen
}

/// Blobs that are not all but the same: of such the highest.
fn apart(mut places: Vec<Blob>) -> Vec<Blob> {
    places.sort_by(|a, b| b.height.total_cmp(&a.height));
    let mut kept: Vec<Blob> = Vec::new();
    for blob in places {
        let alike = kept.iter().any(|one| {
            let ratio = blob.radius / one.radius;
            one.center.distance(blob.center) < SAME * one.radius
                && ratio < 1.0 + SAME
                && ratio > 1.0 - SAME
        });
        if !alike {
            kept.push(blob);
        }
    }
    kept
}

/// The picture at all scales that are looked at.
pub(crate) fn octaves(pixels: &dyn Pixels) -> Vec<Whole> {
    let (width, height) = pixels.size();
    let mut scale = if 4 * width * height <= MOST_PIXELS {
        2.0
    } else {
        1.0
    };
    let mut out = Vec::new();
    while out.is_empty() || scale * width.min(height) as f64 * LARGEST >= SMALLEST {
        out.push(Whole::new(pixels, scale));
        scale *= 0.5;
    }
    out
}

/// The radii of blobs that are looked for in an octave, by its number.
pub(crate) fn sizes(whole: &Whole, octave: usize) -> Vec<f64> {
    let from = if octave == 0 {
        0.5 * SMALLEST
    } else {
        SMALLEST
    };
    radii(from, 2.0 * SMALLEST, LARGEST * shorter(whole))
}

fn shorter(whole: &Whole) -> f64 {
    let (height, width) = whole.dim();
    width.min(height) as f64
}

/// Radii from one to another, the last not included, and at most so large.
fn radii(from: f64, to: f64, most: f64) -> Vec<f64> {
    let all = std::iter::successors(Some(from), |radius| Some(radius * GROWTH));
    all.take_while(|radius| *radius < 0.999 * to && *radius <= most)
        .collect()
}

/// The direction of color in which a picture differs most: the first axis of its covariance, towards the lighter.
pub(crate) fn main_color(whole: &Whole) -> [f64; 3] {
    let channels = whole.channels();
    if channels.len() < 3 {
        return [1.0, 0.0, 0.0];
    }
    let count = channels[0].len() as f64;
    let means: Vec<f64> = channels
        .iter()
        .map(|channel| channel.sum() / count)
        .collect();
    let covariance = |i: usize, j: usize| {
        let both = channels[i].iter().zip(&channels[j]);
        both.map(|(a, b)| (a - means[i]) * (b - means[j]))
            .sum::<f64>()
            / count
    };
    let matrix: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| covariance(i, j)));
    let mut axis = [1.0, 0.1, 0.1];
    for _ in 0..64 {
        let next: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * axis[j]).sum());
        let length = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length <= 0.0 {
            break;
        }
        axis = next.map(|v| v / length);
    }
    if axis[0] < 0.0 {
        axis.map(|v| -v)
    } else {
        axis
    }
}

fn along(whole: &Whole, direction: [f64; 3]) -> Grid {
    let mut out = Grid::zeros(whole.dim());
    for (channel, share) in whole.channels().iter().zip(direction) {
        out.scaled_add(share, channel);
    }
    out
}

/// The outline about each blob, with its worth.
fn outlines<'a>(
    model: &Model<'_>,
    blobs: impl Iterator<Item = &'a Blob>,
    rules: &Rules,
) -> Vec<Candidate> {
    blobs
        .map(|blob| Seed {
            center: blob.center,
            inner: 0.5 * blob.radius,
            rivals: Vec::new(),
        })
        .filter(|seed| promise(model, seed) >= WORTH)
        .filter_map(|seed| outline(model, &seed, rules))
        .collect()
}

/// The outline about a seed, with its worth.
pub(crate) fn outline(model: &Model<'_>, seed: &Seed, rules: &Rules) -> Option<Candidate> {
    let whole = model.whole;
    let (curve, half) = rays(model, seed, COARSE, rules)?;
    let support = support(model, seed, &curve, half);
    let curve: Vec<DVec2> = curve.iter().map(|p| whole.outward(*p)).collect();
    let length = elastic::length(&curve, true);
    Some(Candidate {
        value: value(&support, length),
        curve,
    })
}

/// Outlines that divide one: about two blobs in it that know of each other, or about all.
fn divided(model: &Model<'_>, one: &Candidate, places: &[Blob], rules: &Rules) -> Vec<Candidate> {
    let curve: Vec<DVec2> = one.curve.iter().map(|p| model.whole.inward(*p)).collect();
    let area = elastic::signed_area(&curve).abs();
    let most = (area / std::f64::consts::PI).sqrt();
    let within = |blob: &&Blob| {
        blob.radius < SMALLER * most && outline::winding(&curve, blob.center) != Some(0)
    };
    let mut few: Vec<&Blob> = Vec::new();
    for blob in places.iter().filter(within) {
        let near =
            |one: &&Blob| one.center.distance(blob.center) < 0.5 * one.radius.min(blob.radius);
        if few.len() < FEW && !few.iter().any(near) {
            few.push(blob);
        }
    }
    let mut out = Vec::new();
    let mut about = |own: &Blob, others: &[&Blob]| {
        let rival = |other: &&Blob| (other.center, other.radius / own.radius);
        let seed = Seed {
            center: own.center,
            inner: 0.5 * own.radius,
            rivals: others.iter().map(rival).collect(),
        };
        out.extend(outline(model, &seed, rules));
    };
    for (at, &a) in few.iter().enumerate() {
        for &b in &few[at + 1..] {
            if a.center.distance(b.center) >= APART * (a.radius + b.radius) {
                about(a, &[b]);
                about(b, &[a]);
            }
        }
        let others = few.iter().filter(|b| b.center != a.center);
        let far = others.filter(|b| a.center.distance(b.center) >= APART * (a.radius + b.radius));
        let far: Vec<&Blob> = far.copied().collect();
        if far.len() > 1 {
            about(a, &far);
        }
    }
    out
}

/// Outlines about the common middle of neighbours: one where two were chosen.
fn united(model: &Model<'_>, chosen: &[Candidate], rules: &Rules) -> Vec<Candidate> {
    let circles: Vec<Circle> = chosen.iter().map(|one| circle(&one.curve)).collect();
    let mut order: Vec<usize> = (0..circles.len()).collect();
    order.sort_by(|&a, &b| {
        circles[a]
            .center
            .x
            .total_cmp(&circles[b].center.x)
            .then(a.cmp(&b))
    });
    let largest = circles
        .iter()
        .fold(0.0, |most: f64, one| most.max(one.radius));
    let mut out = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let own = circles[i];
        let reach = BESIDE * (own.radius + largest);
        let near = |j: &&usize| circles[**j].center.x - own.center.x < reach;
        for &j in order[place + 1..].iter().take_while(near) {
            let other = circles[j];
            if own.center.distance(other.center) > BESIDE * (own.radius + other.radius) {
                continue;
            }
            let (a, b) = (own.radius * own.radius, other.radius * other.radius);
            let seed = Seed {
                center: model
                    .whole
                    .inward(own.center.lerp(other.center, b / (a + b))),
                inner: model.whole.scale() * (a + b).sqrt(),
                rivals: Vec::new(),
            };
            out.extend(outline(model, &seed, rules));
        }
    }
    out
}

/// Those without overlap that are worth most.
fn choose(pixels: &dyn Pixels, all: &[Candidate]) -> Vec<Candidate> {
    let (width, height) = pixels.size();
    let choices: Vec<Choice> = all
        .iter()
        .map(|one| Choice {
            spans: Spans::of(&one.curve, (height, width)),
            value: one.value,
        })
        .collect();
    select(&choices)
        .into_iter()
        .map(|at| all[at].clone())
        .collect()
}

/// The circle of a seed in an outline.
pub(crate) fn circle(curve: &[DVec2]) -> Circle {
    let polygon = Polygon {
        points: curve.to_vec(),
        closed: true,
    };
    let count = curve.len().max(1) as f64;
    Circle {
        center: elastic::centroid(curve).unwrap_or_else(|| curve.iter().sum::<DVec2>() / count),
        radius: 0.5 * (polygon.area() / std::f64::consts::PI).sqrt().max(0.5),
    }
}
