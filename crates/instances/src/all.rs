//! From a picture and its seeds to outlines and labels.

use field::Pixels;
use glam::DVec2;
use ndarray::Array2;
use search::along::Polygon;

use crate::auto::auto;
use crate::contact::{joined, labelled};
use crate::points::about_points;
use crate::rules::Rules;
use crate::seeded::{Found, seeded};
use crate::seeds::{Circle, SeedError, Seeds, circles};
use crate::spans::Spans;
use crate::support::Support;

/// Distance of nodes, and over how long a way an outline is rough by the search, for the last stage. Pixels.
const SPACING: f64 = 1.0;
const ROUGH: f64 = 2.0;

/// The last stage needs an object of at least so many blurs of its edge, or its levels inside cannot be measured.
const ROOM: f64 = 8.0;

/// An object of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Its number in the image of labels, from 1.
    pub label: u32,
    /// The number of its seed as given, from 0; of automatic ones, in the order of their labels.
    pub seed: usize,
    /// Its outline in the picture, clockwise on the screen.
    pub outline: Vec<DVec2>,
    /// What the picture says for it.
    pub support: Support,
    /// Labels of the objects it has a border with, in order.
    pub touching: Vec<u32>,
    /// Whether the border of the picture cuts it.
    pub cut: bool,
}

/// All objects of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Instances {
    /// The objects by their labels.
    pub objects: Vec<Object>,
    /// The label of each pixel, 0 for none.
    pub labels: Array2<u32>,
    /// Seeds without an object, by their numbers from 0.
    pub missing: Vec<usize>,
}

/// The outlines of all objects of a picture, one for each.
///
/// # Errors
///
/// Seeds outside the picture or without size, labels of another size.
pub fn outline_all(
    pixels: &dyn Pixels,
    seeds: &Seeds,
    rules: &Rules,
) -> Result<Instances, SeedError> {
    seeds.check(pixels)?;
    let size = pixels.size();
    match seeds {
        Seeds::Circles(list) => {
            let found = seeded(pixels, list, None, rules);
            Ok(finished(pixels, list, &found, rules))
        }
        Seeds::Labels(labels) => {
            let circles = circles(labels);
            let found = seeded(pixels, &circles, None, rules);
            Ok(finished(pixels, &circles, &found, rules))
        }
        Seeds::Points(points) => {
            let found = about_points(pixels, points);
            let there = |at: &usize| found[*at].is_some();
            let numbers: Vec<usize> = (0..points.len()).filter(there).collect();
            let regions: Vec<Spans> = found.into_iter().flatten().collect();
            let mut out = within(pixels, &regions, size, rules);
            for object in &mut out.objects {
                object.seed = numbers[object.seed];
            }
            let known: Vec<usize> = out.objects.iter().map(|object| object.seed).collect();
            let is_missing = |at: &usize| known.binary_search(at).is_err();
            out.missing = (0..points.len()).filter(is_missing).collect();
            Ok(out)
        }
        Seeds::Auto => {
            let mut found: Vec<(DVec2, Spans)> = auto(pixels)
                .into_iter()
                .map(|one| {
                    (
                        one.circle().map_or(DVec2::ZERO, |circle| circle.center),
                        one,
                    )
                })
                .collect();
            found.sort_by(|(a, _), (b, _)| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
            let found: Vec<Spans> = found.into_iter().map(|(_, one)| one).collect();
            Ok(within(pixels, &found, size, rules))
        }
    }
}

/// The outlines of objects that some regions cover roughly.
fn within(
    pixels: &dyn Pixels,
    regions: &[Spans],
    (width, height): (usize, usize),
    rules: &Rules,
) -> Instances {
    let circles: Vec<Circle> = regions.iter().filter_map(Spans::circle).collect();
    let mut labels = Array2::<u32>::zeros((height, width));
    // the smaller above the larger
    let mut order: Vec<usize> = (0..regions.len()).collect();
    order.sort_by_key(|&at| (std::cmp::Reverse(regions[at].area()), at));
    for at in order {
        for place in regions[at].pixels() {
            labels[place] = u32::try_from(at + 1).unwrap_or(u32::MAX);
        }
    }
    let found = seeded(pixels, &circles, Some(&labels), rules);
    finished(pixels, &circles, &found, rules)
}

/// Outlines on their edges, with common borders, and their labels.
fn finished(
    pixels: &dyn Pixels,
    circles: &[Circle],
    found: &[Option<Found>],
    rules: &Rules,
) -> Instances {
    let (width, height) = pixels.size();
    let (low, high) = (
        DVec2::splat(-0.5),
        DVec2::new(width as f64, height as f64) - 0.5,
    );
    let is_one = |one: &&Found| one.support.edge >= rules.unsure;
    let good: Vec<usize> = (0..found.len())
        .filter(|&at| found[at].as_ref().filter(is_one).is_some())
        .collect();
    let own: Vec<Circle> = good.iter().map(|&at| circles[at]).collect();
    let mut supports = Vec::new();
    let mut outlines: Vec<Vec<DVec2>> = Vec::new();
    for one in good.iter().filter_map(|&at| found[at].as_ref()) {
        supports.push(one.support);
        let mut points = last_stage(pixels, &one.curve, rules);
        points.iter_mut().for_each(|p| *p = p.clamp(low, high));
        outlines.push(points);
    }
    let touching = joined(&mut outlines, &own);
    let labels = labelled(&outlines, &own, (height, width));
    let number = |at: usize| u32::try_from(at + 1).unwrap_or(u32::MAX);
    let objects = outlines.into_iter().enumerate().map(|(at, outline)| {
        let mut beside: Vec<u32> = touching
            .iter()
            .filter_map(|&(i, j)| match at {
                _ if at == i => Some(number(j)),
                _ if at == j => Some(number(i)),
                _ => None,
            })
            .collect();
        beside.sort_unstable();
        Object {
            label: number(at),
            seed: good[at],
            cut: outline
                .iter()
                .any(|p| p.cmple(low).any() || p.cmpge(high).any()),
            outline,
            support: supports[at],
            touching: beside,
        }
    });
    Instances {
        objects: objects.collect(),
        labels,
        missing: (0..found.len())
            .filter(|at| good.binary_search(at).is_err())
            .collect(),
    }
}

/// An outline at equal distances and on its edge, if there is one that can be measured.
fn last_stage(pixels: &dyn Pixels, curve: &[DVec2], rules: &Rules) -> Vec<DVec2> {
    let polygon = Polygon {
        points: curve.to_vec(),
        closed: true,
    }
    .outwards();
    let precise = (rules.reach > 0.0).then(|| {
        let rules = subpixel::Rules {
            reach: rules.reach,
            spacing: SPACING,
            rough: ROUGH,
        };
        subpixel::refine(pixels, &polygon, rules)
    });
    let radius = (polygon.area() / std::f64::consts::PI).sqrt();
    let measured = precise
        .flatten()
        .filter(|precise| precise.edge.is_some_and(|edge| radius > ROOM * edge.blur));
    measured.map_or_else(
        || {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "the length of an outline in pixels"
            )]
            let count = (polygon.length() / SPACING).ceil().max(24.0) as usize;
            polygon.evenly(count).points
        },
        |precise| precise.points,
    )
}
