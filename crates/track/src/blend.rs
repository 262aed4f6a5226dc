//! An object between two frames in which its outline is known: from the first it is followed onwards, from the second
//! back, and the two are blended.
//!
//! The share of the way back rises from 0 to 1, linearly in time where both ways agree. Where they do not, one of them
//! is wrong, and what lies between is no outline: the share is that of least cost, in which a frame costs
//!
//! - the variance of the blend, λ (1 − λ) d² with d the distance of both ways beyond what is taken for agreement;
//! - what each way lacks of confidence, by its share;
//! - the square of the step of the share.

use glam::DVec2;

use crate::{Outline, ring};

/// Shares are so many parts of 1.
const PARTS: usize = 32;

/// Two ways agree at a root mean square distance of so many pixels, or radii, whichever is more.
const NEAR: f64 = 1.0;
const NEAR_RADII: f64 = 0.05;

/// What counts, in all frames together: missing confidence, against steps of the share, whose squares sum to 1 at
/// least.
const TRUST: f64 = 2.0;

/// Of shares that cost the same, those nearer to time are taken.
const TIME: f64 = 0.01;

/// Where nothing is to be had.
const NEVER: f64 = 1e12;

/// Blend the outlines of an object in frames one after the other: `onward`, of which the first is known, and `back`, of
/// which the last is known. Both are as long as there are frames; None where a way has no outline. Velocities of both
/// are in the order of the frames.
///
/// ```
/// assert!(track::blended(&[], &[]).is_empty());
/// ```
#[must_use]
pub fn blended(onward: &[Option<Outline>], back: &[Option<Outline>]) -> Vec<Option<Outline>> {
    let both: Vec<Option<Pair>> = onward
        .iter()
        .zip(back)
        .map(|(a, b)| Pair::of(a.as_ref()?, b.as_ref()?))
        .collect();
    let costs: Vec<[f64; PARTS + 1]> = (0..both.len())
        .map(|at| {
            costs(
                onward[at].as_ref(),
                back[at].as_ref(),
                both[at].as_ref(),
                (at, both.len()),
            )
        })
        .collect();
    let shares = cheapest(&costs);
    let one = |at: usize| match shares[at] {
        0 => onward[at].clone().or_else(|| back[at].clone()),
        PARTS => back[at].clone().or_else(|| onward[at].clone()),
        share => both[at].as_ref().map_or_else(
            || onward[at].clone().or_else(|| back[at].clone()),
            |pair| Some(pair.mixed(share as f64 / PARTS as f64)),
        ),
    };
    (0..both.len()).map(one).collect()
}

/// What each share costs in a frame.
fn costs(
    onward: Option<&Outline>,
    back: Option<&Outline>,
    pair: Option<&Pair>,
    (at, frames): (usize, usize),
) -> [f64; PARTS + 1] {
    let lack =
        |outline: Option<&Outline>| outline.map_or(1.0, |one| 1.0 - one.confidence.clamp(0.0, 1.0));
    let (first, last) = (at == 0, at + 1 == frames);
    let (trust, time) = (TRUST / frames as f64, TIME / frames as f64);
    let now = at as f64 / (frames.max(2) - 1) as f64;
    let mut all = [0.0; PARTS + 1];
    for (part, cost) in all.iter_mut().enumerate() {
        let share = part as f64 / PARTS as f64;
        *cost = trust * ((1.0 - share) * lack(onward) + share * lack(back))
            + time * (share - now).powi(2);
        let never = match (onward, back) {
            (Some(_), None) => part > 0,
            (None, Some(_)) => part < PARTS,
            _ => false,
        };
        let known = (first && onward.is_some() && part > 0)
            || (last && !first && back.is_some() && part < PARTS);
        if never || known {
            *cost += NEVER;
        } else if let Some(pair) = pair {
            *cost += share * (1.0 - share) * pair.apart;
        }
    }
    all
}

/// The row of shares, in parts, that costs least with its steps.
fn cheapest(costs: &[[f64; PARTS + 1]]) -> Vec<usize> {
    let Some((first, rest)) = costs.split_first() else {
        return Vec::new();
    };
    let step = rest.len().max(1) as f64 / (PARTS * PARTS) as f64;
    let mut sums = *first;
    let mut ways: Vec<[usize; PARTS + 1]> = Vec::with_capacity(rest.len());
    for costs in rest {
        let (mut next, mut from) = ([0.0; PARTS + 1], [0; PARTS + 1]);
        for part in 0..=PARTS {
            let sum = |before: usize| sums[before] + step * part.abs_diff(before).pow(2) as f64;
            let best = (0..=PARTS)
                .min_by(|&a, &b| sum(a).total_cmp(&sum(b)))
                .unwrap_or(part);
            (next[part], from[part]) = (sum(best) + costs[part], best);
        }
        sums = next;
        ways.push(from);
    }
    let last = (0..=PARTS).min_by(|&a, &b| sums[a].total_cmp(&sums[b]));
    let mut shares = vec![last.unwrap_or(0)];
    for from in ways.iter().rev() {
        let at = shares[shares.len() - 1];
        shares.push(from[at]);
    }
    shares.reverse();
    shares
}

/// Two outlines of an object in a frame, node by node.
#[derive(Debug)]
struct Pair {
    /// The one that is followed onwards, at even distances.
    onward: Outline,
    /// The other, at as many places, each opposite its own.
    back: Outline,
    /// The mean square distance beyond agreement, in distances of agreement.
    apart: f64,
}

impl Pair {
    /// None where one of them is no curve.
    fn of(onward: &Outline, back: &Outline) -> Option<Self> {
        let is_curve = |outline: &Outline| {
            let n = outline.points.len();
            n > 2 && outline.material.len() == n && outline.errors.len() == n
        };
        if !is_curve(onward) || !is_curve(back) {
            return None;
        }
        let count = onward.points.len();
        let onward = even(onward, count);
        let mut turned = back.clone();
        if elastic::signed_area(&onward.points) * elastic::signed_area(&back.points) < 0.0 {
            turned.points.reverse();
            turned.errors.reverse();
            turned.material.reverse();
        }
        let mut back = even(&turned, count);
        let middle = back.points.iter().sum::<DVec2>() / count as f64;
        let alike = |shift: &usize| -> f64 {
            let others = back.points[*shift..].iter().chain(&back.points[..*shift]);
            let both = onward.points.iter().zip(others);
            both.map(|(a, b)| a.dot(*b - middle)).sum()
        };
        let shift = (0..count).map(|shift| (shift, alike(&shift)));
        let shift = shift.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
        back.points.rotate_left(shift.0);
        back.errors.rotate_left(shift.0);
        let both = onward.points.iter().zip(&back.points);
        let square = both.map(|(a, b)| a.distance_squared(*b)).sum::<f64>() / count as f64;
        let near = NEAR.max(NEAR_RADII * ring::radius(&onward.points));
        let apart = (square / (near * near) - 1.0).max(0.0);
        Some(Self {
            onward,
            back,
            apart,
        })
    }

    /// What lies between them.
    fn mixed(&self, share: f64) -> Outline {
        let (a, b) = (&self.onward, &self.back);
        let mix = |a: f64, b: f64| a + share * (b - a);
        let heavier = if share < 0.5 { a } else { b };
        Outline {
            points: each(&a.points, &b.points, |a, b| a.lerp(*b, share)),
            errors: each(&a.errors, &b.errors, |a, b| mix(*a, *b)),
            state: heavier.state,
            prediction: heavier.prediction,
            confidence: mix(a.confidence, b.confidence),
            velocity: a.velocity.lerp(b.velocity, share),
            rotation: mix(a.rotation, b.rotation),
            ..a.clone()
        }
    }
}

fn each<T, U>(a: &[T], b: &[T], mix: impl Fn(&T, &T) -> U) -> Vec<U> {
    a.iter().zip(b).map(|(a, b)| mix(a, b)).collect()
}

/// An outline with so many nodes at equal distances.
fn even(outline: &Outline, count: usize) -> Outline {
    let (points, places) = ring::evenly(&outline.points, count);
    Outline {
        errors: ring::between(&outline.errors, &places),
        material: ring::turned(&outline.material, &places),
        points,
        ..outline.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Prediction, State};

    /// A circle with nodes from an angle on, one way round or the other.
    fn circle(center: DVec2, radius: f64, count: u32, from: f64, way: f64) -> Outline {
        let share = |k: u32| f64::from(k) / f64::from(count);
        let angle = |k: u32| from + way * share(k) * std::f64::consts::TAU;
        Outline {
            id: 1,
            parent: None,
            points: (0..count)
                .map(|k| center + radius * DVec2::from_angle(angle(k)))
                .collect(),
            material: (0..count).map(share).collect(),
            errors: vec![0.1; count as usize],
            state: State::Seen,
            confidence: 0.9,
            velocity: DVec2::X,
            rotation: 0.0,
            prediction: Prediction::Carried,
        }
    }

    /// How far nodes are from a circle, at most.
    fn off(outline: Option<&Outline>, center: DVec2, radius: f64) -> f64 {
        let points = outline.map_or(&[][..], |one| &one.points);
        let off = points.iter().map(|p| (p.distance(center) - radius).abs());
        off.fold(
            if points.is_empty() {
                f64::INFINITY
            } else {
                0.0
            },
            f64::max,
        )
    }

    #[test]
    fn ways_that_agree_are_blended_linearly_in_time() {
        // 0.8 px beside each other, with other nodes, run the other way round
        let center = |t: u32| DVec2::new(40.0 + 3.0 * f64::from(t), 50.0);
        let onward: Vec<_> = (0..9)
            .map(|t| Some(circle(center(t), 14.0, 90, 0.3, 1.0)))
            .collect();
        let beside = DVec2::new(0.0, 0.8);
        let back: Vec<_> = (0..9)
            .map(|t| Some(circle(center(t) + beside, 14.0, 70, 2.0, -1.0)))
            .collect();
        let found = blended(&onward, &back);
        for (t, one) in (0..9).zip(&found) {
            let between = center(t) + beside * f64::from(t) / 8.0;
            assert!(off(one.as_ref(), between, 14.0) < 0.05, "{t}");
        }
        assert_eq!((&found[0], &found[8]), (&onward[0], &back[8]));
    }

    #[test]
    fn a_way_that_goes_wrong_is_left_where_both_still_agree() {
        let center = |t: u32| DVec2::new(40.0 + 3.0 * f64::from(t), 50.0);
        for wrong in 2..20 {
            // onwards it sits on something else from then on; back it is off before the fourth frame
            let onward: Vec<_> = (0..20)
                .map(|t| {
                    let at = if t < wrong {
                        center(t)
                    } else {
                        DVec2::new(90.0, 20.0)
                    };
                    Some(circle(at, 14.0, 90, 0.0, 1.0))
                })
                .collect();
            let back: Vec<_> = (0..20)
                .map(|t| Some(circle(center(t), 14.0, 80, 1.0, 1.0)))
                .collect();
            for (t, one) in (0..20).zip(blended(&onward, &back)) {
                let off = off(one.as_ref(), center(t), 14.0);
                assert!(off < 0.1, "wrong from {wrong}, frame {t}: {off}");
            }
        }
    }

    #[test]
    fn a_way_without_an_outline_leaves_it_to_the_other() {
        let one = |x: f64| Some(circle(DVec2::new(x, 20.0), 9.0, 60, 0.0, 1.0));
        let found = blended(
            &[one(20.0), None, None, one(26.0)],
            &[None, one(22.0), None, one(26.5)],
        );
        let off: Vec<f64> = [20.0, 22.0, 24.0, 26.5]
            .iter()
            .zip(&found)
            .map(|(x, one)| off(one.as_ref(), DVec2::new(*x, 20.0), 9.0))
            .collect();
        assert!(
            off[0] < 1e-9 && off[1] < 1e-9 && off[2].is_infinite() && off[3] < 1e-9,
            "{off:?}"
        );
    }
}
