//! A crowd: objects that come, go, meet and part.

use std::f64::consts::TAU;

use field::drawn::uniform;
use glam::DVec2;

use super::region::{Form, Region};
use super::scene::{Body, Scene};
use super::single::DARK;
use super::{Event, Sequence};

/// The seed of all numbers of the crowd.
const SEED: u64 = 7003;

/// The longest that two objects overlap, as discs; each then ends at the line between them. Pixels.
const OVERLAP: f64 = 1.5;

/// Objects of frame 0.
const FIRST: u32 = 20;

/// One object of the crowd.
struct Member {
    id: u32,
    center: DVec2,
    radius: f64,
    /// Frames it is there.
    life: std::ops::Range<usize>,
}

/// A number of an object, even in [0, 1).
fn number(id: u32, which: u64) -> f64 {
    uniform(SEED, 16 * u64::from(id) + which)
}

/// Frames at which objects are lost, and that at which one begins to leave.
fn end_of(id: u32) -> usize {
    match id {
        5 => 14,
        12 => 26,
        16 => 33,
        _ => 40,
    }
}

/// The object that leaves over the right border, from which frame on it makes for it.
const LEAVER: (u32, usize) = (15, 12);

/// Frames of birth, place, and whether it grows there from nothing (else it comes over the border).
const BIRTHS: [(usize, f64, f64, bool); 4] = [
    (8, 170.0, 60.0, true),
    (12, -10.0, 100.0, false),
    (18, 60.0, 170.0, true),
    (24, 100.0, 30.0, true),
];

/// The crowd, drawn as [`sequences`](super::sequences) says.
pub(super) fn crowd() -> Sequence {
    let mut members: Vec<Member> = (0..FIRST)
        .map(|k| {
            let (column, row) = (f64::from(k % 5), f64::from(k / 5));
            let place = DVec2::new(22.0 + 37.0 * column, 25.0 + 47.0 * row);
            let jitter = DVec2::new(number(k + 1, 0) - 0.5, number(k + 1, 1) - 0.5);
            Member {
                id: k + 1,
                center: place + 8.0 * jitter,
                radius: radius(k + 1),
                life: 0..end_of(k + 1),
            }
        })
        .collect();
    let mut scenes = Vec::new();
    let mut events = Vec::new();
    let mut seen: Vec<u32> = Vec::new();
    for t in 0..40 {
        for (id, (birth, x, y, grows)) in (FIRST + 1..).zip(BIRTHS) {
            if birth == t {
                let center = DVec2::new(x, y);
                let radius = if grows { 0.4 * radius(id) } else { radius(id) };
                let life = t..40;
                members.push(Member {
                    id,
                    center,
                    radius,
                    life,
                });
            }
        }
        members.retain(|one| one.life.contains(&t));
        if t > 0 {
            walk(&mut members, t);
        }
        for _ in 0..200 {
            push_apart(&mut members);
        }
        let scene = scene(&members);
        let now: Vec<u32> = members
            .iter()
            .filter(|m| in_picture(m))
            .map(|m| m.id)
            .collect();
        if t > 0 {
            let born = now.iter().filter(|id| !seen.contains(id));
            events.extend(born.map(|id| (t, *id, Event::Born)));
            let gone = seen.iter().filter(|id| !now.contains(id));
            events.extend(gone.map(|id| {
                let event = if *id == LEAVER.0 {
                    Event::Left
                } else {
                    Event::Lost
                };
                (t, *id, event)
            }));
        }
        seen = now;
        scenes.push(scene);
    }
    let mut sequence = Sequence::new("crowd", |t| scenes[t].clone());
    sequence.events = events;
    sequence
}

/// The radius of an object that has grown.
fn radius(id: u32) -> f64 {
    8.0 + 3.0 * number(id, 2)
}

fn in_picture(member: &Member) -> bool {
    let Member { center, radius, .. } = member;
    let nearest = center.clamp(DVec2::splat(-0.5), DVec2::splat(191.5));
    nearest.distance(*center) < *radius
}

/// One step of all.
fn walk(members: &mut [Member], t: usize) {
    let places: Vec<(u32, DVec2)> = members.iter().map(|one| (one.id, one.center)).collect();
    for one in members {
        let time = t as f64;
        let turn = TAU * number(one.id, 3) + 0.2 * (number(one.id, 4) - 0.5) * time;
        let mut step = DVec2::from_angle(turn);
        let other = if one.id % 2 == 1 {
            one.id + 1
        } else {
            one.id - 1
        };
        if let Some((_, place)) = places.iter().find(|(id, _)| *id == other)
            && one.id <= FIRST
        {
            let toward = (*place - one.center).normalize_or_zero();
            if (6..20).contains(&t) {
                step = 0.4 * step + 1.2 * toward;
            } else if (20..26).contains(&t) {
                step -= 1.2 * toward;
            }
        }
        if one.id == LEAVER.0 && t >= LEAVER.1 {
            step = 2.5 * DVec2::X;
        } else if one.life.start + 10 > t && one.center.x < 14.0 {
            step = 2.0 * DVec2::X;
        }
        one.center += step;
        one.radius = (one.radius + 0.12 * radius(one.id)).min(radius(one.id));
        // what does not leave stays inside
        if one.id != LEAVER.0 && one.center.x > one.radius {
            let (low, high) = (one.radius + 2.0, 189.0 - one.radius);
            one.center = one.center.clamp(DVec2::splat(low), DVec2::splat(high));
        }
    }
}

/// Moves what overlaps too far apart, half of it each.
fn push_apart(members: &mut [Member]) {
    for i in 1..members.len() {
        let (before, [one, ..]) = members.split_at_mut(i) else {
            continue;
        };
        for other in before {
            let between = one.center - other.center;
            let least = one.radius + other.radius - OVERLAP;
            let short = least - between.length();
            if short > 0.0 {
                let push = 0.5 * short * between.normalize_or(DVec2::X);
                one.center += push;
                other.center -= push;
            }
        }
    }
}

/// The discs, each cut at the lines of equal power with those that it overlaps.
fn scene(members: &[Member]) -> Scene {
    let bodies = members.iter().map(|one| {
        let mut region = Region::new(Form::Disc(one.radius), one.center);
        for other in members {
            let between = other.center - one.center;
            let far = between.length();
            if other.id == one.id || far >= one.radius + other.radius {
                continue;
            }
            // |p − c|² − r² equal for both
            let along = 0.5 * (far + (one.radius.powi(2) - other.radius.powi(2)) / far);
            let normal = between / far;
            region.cuts.push((normal, normal.dot(one.center) + along));
        }
        Body::new(one.id, region, 160.0 + 60.0 * number(one.id, 5))
    });
    Scene::of(DARK, bodies.collect())
}
