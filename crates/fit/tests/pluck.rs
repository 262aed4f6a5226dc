//! Outlines that are plucked: firm where the image has an edge, loose where it has none.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use crate::common::{BRIGHT, DARK, disc, drawn};
use fit::{Contour, Image, OptionKey, Options, Pluck, Plucked, Prepared};
use glam::DVec2;

const CENTER: DVec2 = DVec2::new(48.3, 44.8);
const RADIUS: f64 = 30.0;

fn plucked(levels: field::Grid, outline: &Contour, options: &Options) -> Plucked {
    let prepared = Prepared::of(&Image::grey(levels), options).unwrap();
    prepared.pluck(outline, &Pluck::default()).unwrap()
}

fn circle() -> Contour {
    Contour::circle(CENTER, RADIUS)
}

/// What comes back on a ring by its energy alone, node by node and with small steps: the edge of a disc blurred by the
/// force's σ and by the pixels, of this share of the contrast; the springs, the tension.
fn by_hand(stretches: usize, kick: f64, share: f64) -> f64 {
    let variance: f64 = 10.0 + 1.0 / 12.0;
    let n = 376;
    let spacing = std::f64::consts::TAU * RADIUS / n as f64;
    let edge = share * 720.0 / (std::f64::consts::TAU * variance.powi(3)).sqrt();
    let pull = |u: f64| -edge * u * (-0.5 * u * u / variance).exp();
    let (tether, tension) = (
        0.05 * 720.0 / (std::f64::consts::TAU * 1000.0).sqrt(),
        0.05 * 7200.0 / (std::f64::consts::TAU * 1000.0).sqrt(),
    );
    let wide = n as f64 / stretches as f64;
    let bump: Vec<f64> = (0..n)
        .map(|i| {
            let off = (i as f64 - 0.5 * n as f64).abs() / wide;
            if off < 1.0 {
                (0.5 * std::f64::consts::PI * off).cos().powi(2)
            } else {
                0.0
            }
        })
        .collect();
    let mut u: Vec<f64> = bump.iter().map(|b| kick * b).collect();
    for _ in 0..4000 {
        let e: Vec<f64> = u.iter().zip(&bump).map(|(u, b)| u - kick * b).collect();
        u = (0..n)
            .map(|i| {
                let bent = (e[(i + 1) % n] - 2.0 * e[i] + e[(i + n - 1) % n]) / spacing.powi(2);
                u[i] + 0.01 * (pull(u[i]) - tether * e[i] + tension * bent)
            })
            .collect();
    }
    let size: f64 = bump.iter().map(|b| b * b).sum();
    1.0 - u.iter().zip(&bump).map(|(u, b)| u * b).sum::<f64>() / (kick * size)
}

#[test]
fn a_sharp_disc_is_firm_all_round_and_by_as_much_as_its_energy_says() {
    let found = plucked(disc(CENTER, RADIUS), &circle(), &Options::default());
    assert_eq!(found.stretches.len(), 12);
    let expected = by_hand(12, 2.0, 1.0);
    for stretch in &found.stretches {
        let firmness = stretch.firmness().unwrap();
        assert!((firmness - expected).abs() < 0.03, "{firmness} {expected}");
    }
    assert!((found.firm() - 1.0).abs() < 1e-12 && expected > 0.85);
    // the stretches are the whole outline, once
    let mut next = 0;
    for stretch in &found.stretches {
        assert_eq!(stretch.points.start, next);
        next = stretch.points.end;
    }
    assert_eq!(next, circle().points.len());
}

#[test]
fn a_weak_edge_beside_a_strong_one_is_as_firm_as_its_energy_says() {
    // a bright strip at the side, which is all there is of the contrast
    for (share, told) in [(0.1, 0.6), (0.05, 0.4)] {
        let mut levels = disc(CENTER, RADIUS).mapv(|level| DARK + share * (level - DARK));
        let strip = levels.indexed_iter_mut().filter(|((_, x), _)| *x < 3);
        strip.for_each(|(_, level)| *level = BRIGHT);
        let found = plucked(levels, &circle(), &Options::default());
        let expected = by_hand(12, 2.0, share);
        assert!((expected - told).abs() < 0.06, "{expected}");
        for stretch in &found.stretches {
            let firmness = stretch.firmness().unwrap();
            assert!((firmness - expected).abs() < 0.05, "{firmness} {expected}");
        }
    }
}

#[test]
fn where_the_edge_has_faded_the_outline_is_loose() {
    // to the left the disc is as its ground, and so it becomes over 10 pixels
    let mut levels = disc(CENTER, RADIUS);
    let (bright, dark) = (BRIGHT, DARK);
    levels.indexed_iter_mut().for_each(|((_, x), level)| {
        let share = ((x as f64 - CENTER.x) / 10.0 + 0.5).clamp(0.0, 1.0);
        *level = bright + share * (*level - bright);
    });
    assert!(levels.iter().any(|level| (*level - dark).abs() < 1e-9));
    let found = plucked(levels, &circle(), &Options::default());
    for stretch in &found.stretches {
        let (side, firmness) = (stretch.at.x - CENTER.x, stretch.firmness().unwrap());
        if side > 15.0 {
            assert!(stretch.is_firm() && firmness > 0.85, "{side} {firmness}");
        } else if side < -25.0 {
            assert!(firmness.abs() < 0.05, "{side} {firmness}");
        } else if side < -15.0 {
            // the bump reaches to where the edge begins
            assert!(!stretch.is_firm() && firmness < 0.2, "{side} {firmness}");
        }
    }
    assert!((found.firm() - 0.5).abs() < 0.2);
    assert!(found.loosest().unwrap().at.x < CENTER.x);
}

#[test]
fn in_a_blank_image_everything_stays_where_it_is_put() {
    let blank = drawn((97, 91), |_| false);
    for outline in [
        circle(),
        Contour::open(vec![DVec2::new(20.0, 20.0), DVec2::new(70.0, 60.0)]),
    ] {
        let found = plucked(blank.clone(), &outline, &Options::default());
        assert!(found.firm() < 1e-12);
        for stretch in &found.stretches {
            assert!(stretch.firmness().unwrap().abs() < 1e-6, "{stretch:?}");
        }
    }
}

#[test]
fn a_loose_outline_does_not_drift_away_as_a_whole() {
    // a short line across the edge, which has nothing to rest on
    let across = Contour::open(vec![
        CENTER + DVec2::new(0.0, -36.0),
        CENTER + DVec2::new(-1.0, -2.0),
    ]);
    let found = plucked(disc(CENTER, RADIUS), &across, &Options::default());
    for stretch in &found.stretches {
        for way in [stretch.outward, stretch.inward] {
            assert!(way.unwrap().abs() < 1.5, "{stretch:?}");
        }
    }
}

#[test]
fn an_outline_between_two_edges_runs_away() {
    // half way between the two sides of a bright ring: each kick falls to the nearer side
    let ring = drawn((97, 91), |p| (p.distance(CENTER) - RADIUS).abs() < 5.0);
    let found = plucked(ring, &circle(), &Options::default());
    for stretch in &found.stretches {
        assert!(stretch.firmness().unwrap() < -0.3, "{stretch:?}");
    }
}

#[test]
fn the_way_an_outline_runs_and_the_exposure_do_not_matter() {
    let levels = disc(CENTER, RADIUS);
    let mut back = circle();
    back.points.reverse();
    let one = plucked(levels.clone(), &circle(), &Options::default());
    let other = plucked(levels.clone(), &back, &Options::default());
    let dim = plucked(
        levels.mapv(|l| 3.0 + 0.01 * l),
        &circle(),
        &Options::default(),
    );
    for found in [&other, &dim] {
        for (a, b) in one.stretches.iter().zip(&found.stretches) {
            assert!((a.outward.unwrap() - b.outward.unwrap()).abs() < 0.02);
            assert!((a.inward.unwrap() - b.inward.unwrap()).abs() < 0.02);
        }
    }
}

#[test]
fn a_kick_is_above_nothing_and_within_the_reach_of_the_force() {
    let prepared = Prepared::of(&Image::grey(disc(CENTER, RADIUS)), &Options::default()).unwrap();
    for kick in [0.0, -1.0, f64::NAN, f64::INFINITY, 9.6] {
        let error = prepared.pluck(&circle(), &Pluck { kick }).unwrap_err();
        assert_eq!(error.key, OptionKey::Kick, "{kick}");
    }
    let nothing = Contour::closed(vec![CENTER; 5]);
    assert!(prepared.pluck(&nothing, &Pluck::default()).is_err());
}
