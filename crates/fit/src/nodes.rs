//! What the image says at each node: how steep it is there, and where the edge is.

use glam::DVec2;
use integrator::State;
use snake::Snake;

use crate::evidence::{held, normals, pulls};
use crate::force::NORMAL_AT_0;
use crate::image::Image;
use crate::{NodeEvidence, Prepared};

/// How far along the normal an edge is looked for, in σ.
const FAR: f64 = 1.5;

/// The distance of two looks. Pixels.
const LOOK: f64 = 0.25;

/// A Gaussian is cut at so many σ: what is beyond is a part in ten thousand of its slope.
const CUT: f64 = 4.5;

/// Ask the image at every node. O(n σ²).
pub(crate) fn node_evidence(
    prepared: &Prepared,
    snake: &mut Snake,
    end: &State,
) -> Vec<NodeEvidence> {
    let closed = snake.body().topology.is_closed();
    let sigma = prepared.options().sigma;
    let mut out = normals(&end.x, closed);
    // perp of the direction of travel: inwards where the area is positive
    if closed && elastic::signed_area(&end.x) > 0.0 {
        out.iter_mut().for_each(|normal| *normal = -*normal);
    }
    let held = held(snake, end);
    let offsets = offsets(snake, end, &out, FAR * sigma.max(1.0));
    let contrast = prepared.sight().map_or(1.0, crate::force::Sight::contrast);
    let steepest = NORMAL_AT_0 * contrast / sigma;
    let image = prepared.image();
    let nodes = end.x.iter().zip(out).zip(held).zip(offsets);
    nodes
        .map(|(((&at, normal), held), offset)| {
            let slope = slope_at(image, sigma, at).dot(normal);
            NodeEvidence {
                normal,
                slope,
                strength: slope.abs() / steepest,
                offset,
                held,
                error: None,
            }
        })
        .collect()
}

/// Where along its normal each node is pulled neither way, and back from both sides; the nearest
/// such place.
fn offsets(snake: &mut Snake, end: &State, normals: &[DVec2], far: f64) -> Vec<Option<f64>> {
    let mut found = vec![None; end.len()];
    let Some(here) = pulls(snake, end, normals, 0.0) else {
        return found;
    };
    // outwards and inwards in turn: the pull at the last look each way
    let mut last = [here.clone(), here];
    let mut way = 0.0;
    while way < far {
        let next = way + LOOK;
        for (side, last) in [1.0, -1.0].into_iter().zip(&mut last) {
            let Some(now) = pulls(snake, end, normals, side * next) else {
                continue;
            };
            for ((found, last), &now) in found.iter_mut().zip(&mut *last).zip(&now) {
                // outwards up to the balance, inwards beyond
                let (near, beyond) = (side * *last, side * now);
                if near >= 0.0 && beyond < 0.0 {
                    let crossing = side * (way + LOOK * near / (near - beyond));
                    let nearer = |known: &f64| crossing.abs() < known.abs();
                    if found.as_ref().is_none_or(nearer) {
                        *found = Some(crossing);
                    }
                }
                *last = now;
            }
        }
        way = next;
    }
    found
}

/// The gradient of the image smoothed by a Gaussian, over the pixels that count. Levels per pixel.
///
/// The smoothed level is N / D with N = Σ G I and D = Σ G over the pixels that count, so its
/// gradient is (∇N − (N / D) ∇D) / D.
fn slope_at(image: &Image, sigma: f64, at: DVec2) -> DVec2 {
    let (width, height) = image.size();
    let pixels = image.pixels();
    let valid = pixels.valid();
    let span = |center: f64, length: usize| {
        let (low, high) = (center - CUT * sigma, center + CUT * sigma + 1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the image first"
        )]
        let place = |value: f64| value.clamp(0.0, length as f64) as usize;
        place(low.ceil())..place(high.floor().max(0.0))
    };
    let weight = |d: f64| (-0.5 * (d / sigma) * (d / sigma)).exp();
    let columns: Vec<(usize, f64, f64)> = span(at.x, width)
        .map(|x| (x, x as f64 - at.x, weight(x as f64 - at.x)))
        .collect();
    let (mut sum, mut total) = (0.0, 0.0);
    let (mut sum_slope, mut total_slope) = (DVec2::ZERO, DVec2::ZERO);
    for y in span(at.y, height) {
        let dy = y as f64 - at.y;
        let row = weight(dy);
        for &(x, dx, column) in &columns {
            if valid.is_some_and(|valid| !valid[[y, x]]) {
                continue;
            }
            let weight = row * column;
            let away = DVec2::new(dx, dy) * weight;
            let level = pixels.level(x, y);
            sum += weight * level;
            total += weight;
            sum_slope += away * level;
            total_slope += away;
        }
    }
    if total <= 0.0 {
        return DVec2::ZERO;
    }
    (sum_slope - total_slope * (sum / total)) / (total * sigma * sigma)
}
