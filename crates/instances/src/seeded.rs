//! One search a seed against a model that all seeds share and that is learnt again from what they find.

use field::Pixels;
use glam::DVec2;
use ndarray::Array2;
use search::whole::{Whole, quantile};

use crate::jobs;
use crate::model::{Model, Seed};
use crate::rays::{FINE, rays};
use crate::ribbon::ribbon;
use crate::rules::Rules;
use crate::seeds::Circle;
use crate::spans::Spans;
use crate::support::{Support, support};

/// Radius of an object at the scale of the model, in its pixels; the most that a picture is enlarged, and the most
/// pixels it may get by that.
const RADIUS: f64 = 24.0;
const MOST_ENLARGED: f64 = 2.0;
const MOST_PIXELS: f64 = 6e6;

/// What is farther than so many inner radii from all seeds is ground at first; of a crowded picture, the share that
/// looks least like the seeds.
const FAR: f64 = 2.8;
const LEAST: f64 = 0.15;

/// Rounds of learning what objects look like.
const ROUNDS: usize = 2;

/// An outline about a seed, in the picture.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub curve: Vec<DVec2>,
    pub support: Support,
}

/// The scale at which objects of some inner radii are looked at.
fn scale_for(pixels: &dyn Pixels, circles: &[Circle]) -> f64 {
    let mut radii: Vec<f64> = circles.iter().map(|circle| 2.0 * circle.radius).collect();
    let (width, height) = pixels.size();
    let most = (MOST_PIXELS / (width as f64 * height as f64))
        .sqrt()
        .max(1.0);
    (RADIUS / quantile(&mut radii, 0.5).max(1.0)).min(MOST_ENLARGED.min(most))
}

/// Seeds at the scale of a model, with those near each.
fn seeds(whole: &Whole, circles: &[Circle]) -> Vec<Seed> {
    let scale = whole.scale();
    let largest = circles
        .iter()
        .fold(0.0, |most: f64, one| most.max(one.radius));
    // neighbours by columns of the picture, so that the work grows with the number of seeds
    let mut order: Vec<usize> = (0..circles.len()).collect();
    order.sort_by(|&a, &b| {
        circles[a]
            .center
            .x
            .total_cmp(&circles[b].center.x)
            .then(a.cmp(&b))
    });
    let mut out: Vec<Seed> = circles
        .iter()
        .zip(1..)
        .map(|(circle, number)| Seed {
            center: whole.inward(circle.center),
            number,
            inner: scale * circle.radius,
            rivals: Vec::new(),
        })
        .collect();
    for (place, &i) in order.iter().enumerate() {
        let own = circles[i];
        let reach = 3.2 * (own.radius + largest);
        for &j in order[place + 1..]
            .iter()
            .take_while(|&&j| circles[j].center.x - own.center.x < reach)
        {
            let other = circles[j];
            let apart = own.center.distance(other.center);
            if apart > 0.0 && apart < 3.2 * (own.radius + other.radius) {
                let (a, b) = (out[i].center, out[j].center);
                out[i].rivals.push((b, other.radius / own.radius));
                out[j].rivals.push((a, own.radius / other.radius));
            }
        }
    }
    out
}

/// Pixels of a model inside of curves.
fn mask<'a>(dim: (usize, usize), curves: impl Iterator<Item = &'a [DVec2]>) -> Vec<bool> {
    let mut inside = vec![false; dim.0 * dim.1];
    for curve in curves {
        for (row, from, to) in Spans::of(curve, dim).0 {
            inside[row * dim.1 + from..row * dim.1 + to].fill(true);
        }
    }
    inside
}

/// A circle as a polygon.
fn disk(center: DVec2, radius: f64) -> Vec<DVec2> {
    let turn = |i: u32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 40.0);
    (0..40).map(|i| center + radius * turn(i)).collect()
}

/// The model of a picture as its seeds, or what is known of their objects, tell it.
fn first_model<'a>(whole: &'a Whole, seeds: &[Seed], known: Option<Vec<bool>>) -> Model<'a> {
    let dim = whole.dim();
    let disks = |times: f64| -> Vec<Vec<DVec2>> {
        let all = seeds.iter();
        all.map(|seed| disk(seed.center, (times * seed.inner).max(0.6)))
            .collect()
    };
    let is_known = known.is_some();
    let inside = known.unwrap_or_else(|| mask(dim, disks(1.0).iter().map(Vec::as_slice)));
    let mut outside: Vec<bool> = if is_known {
        inside.iter().map(|inside| !inside).collect()
    } else {
        let near = mask(dim, disks(FAR).iter().map(Vec::as_slice));
        near.iter().map(|near| !near).collect()
    };
    let count = outside.iter().filter(|one| **one).count() as f64;
    if count < LEAST * outside.len() as f64 {
        let all = vec![true; outside.len()];
        let like = whole.likelihood(&inside, &all);
        let mut list: Vec<f64> = like.iter().copied().collect();
        let least = quantile(&mut list, LEAST);
        let both = outside.iter_mut().zip(&inside).zip(&like);
        both.for_each(|((out, inside), like)| *out = *out || (*like <= least && !inside));
    }
    Model {
        whole,
        owners: None,
        likelihood: Some(whole.likelihood(&inside, &outside)),
        polarity: whole.polarity(&inside, &outside),
    }
}

/// The model of a picture by outlines found in it.
fn learnt<'a>(whole: &'a Whole, inside: &[bool]) -> Model<'a> {
    let outside: Vec<bool> = inside.iter().map(|inside| !inside).collect();
    Model {
        whole,
        owners: None,
        likelihood: Some(whole.likelihood(inside, &outside)),
        polarity: whole.polarity(inside, &outside),
    }
}

/// Labels of a picture at the scale of a model.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the picture first"
)]
fn scaled(whole: &Whole, labels: &Array2<u32>) -> Array2<u32> {
    let (height, width) = labels.dim();
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    Array2::from_shape_fn(whole.dim(), |(y, x)| {
        let p = whole.outward(DVec2::new(x as f64, y as f64));
        let p = p.round().clamp(DVec2::ZERO, last);
        labels[[p.y as usize, p.x as usize]]
    })
}

/// The outline about each seed; None where there is no path. `known` are labels that cover the objects roughly, in
/// the order of the seeds.
pub(crate) fn seeded(
    pixels: &dyn Pixels,
    circles: &[Circle],
    known: Option<&Array2<u32>>,
    rules: &Rules,
) -> Vec<Option<Found>> {
    if circles.is_empty() {
        return Vec::new();
    }
    let whole = Whole::new(pixels, scale_for(pixels, circles));
    let seeds = seeds(&whole, circles);
    let owners = known.map(|labels| scaled(&whole, labels));
    let inside = owners
        .as_ref()
        .map(|owners| owners.iter().map(|owner| *owner > 0).collect());
    let mut model = first_model(&whole, &seeds, inside);
    model.owners.clone_from(&owners);
    let mut found: Vec<Option<(Vec<DVec2>, f64)>> = Vec::new();
    for round in 0..ROUNDS {
        if round > 0 {
            let curves = found.iter().flatten().map(|(curve, _)| curve.as_slice());
            model = learnt(&whole, &mask(whole.dim(), curves));
            model.owners.clone_from(&owners);
        }
        found = jobs::map(seeds.len(), |at| rays(&model, &seeds[at], FINE, rules));
    }
    let found = &found;
    jobs::map(seeds.len(), |at| {
        let (seed, (curve, half)) = (&seeds[at], found[at].as_ref()?);
        let curve = ribbon(&model, seed, curve, *half, rules).unwrap_or_else(|| curve.clone());
        Some(Found {
            support: support(&model, seed, &curve, *half),
            curve: curve.iter().map(|p| whole.outward(*p)).collect(),
        })
    })
}
