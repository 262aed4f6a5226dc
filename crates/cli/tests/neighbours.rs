//! `snake fit --from`: labels whose objects touch, and what a network says of every pixel.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common;

use crate::common::Folder;

const SIDE: usize = 120;

/// A grey picture of that level at each pixel.
fn pgm(level: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let mut bytes = format!("P5\n{SIDE} {SIDE}\n255\n").into_bytes();
    for at in 0..SIDE * SIDE {
        let level = level((at % SIDE) as f64, (at / SIDE) as f64);
        bytes.push(common::fits::byte(level));
    }
    bytes
}

/// The outlines of a table `x,y,curve`.
fn curves(folder: &Folder, name: &str) -> Vec<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(folder.path(name)).unwrap();
    let mut all: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for line in text
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
    {
        let words: Vec<&str> = line.split(',').collect();
        let name = words.get(2).copied().unwrap_or("").to_owned();
        if all.last().is_none_or(|last| last.0 != name) {
            all.push((name, Vec::new()));
        }
        let p = [words[0].parse().unwrap(), words[1].parse().unwrap()];
        all.last_mut().unwrap().1.push(p);
    }
    all.into_iter().map(|one| one.1).collect()
}

fn is_inside(curve: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for (k, a) in curve.iter().enumerate() {
        let b = curve[(k + 1) % curve.len()];
        if (a[1] <= y) != (b[1] <= y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) {
            inside = !inside;
        }
    }
    inside
}

#[test]
fn labels_in_contact_end_without_gap_or_overlap() {
    let folder = Folder::new();
    // two discs that touch, one hardly brighter than the other; labels a pixel too large, with stairs
    let disc = |x: f64, y: f64, cx: f64, r: f64| (x - cx).hypot(y - 60.0) < r;
    folder.write(
        "cells.pgm",
        pgm(|x, y| {
            if disc(x, y, 40.0, 20.0) {
                180.0
            } else if disc(x, y, 79.0, 19.5) {
                150.0
            } else {
                50.0
            }
        }),
    );
    folder.write(
        "labels.pgm",
        pgm(|x, y| {
            if disc(x, y, 40.0, 21.0) && x < 60.0 {
                1.0
            } else if disc(x, y, 79.0, 20.5) {
                2.0
            } else {
                0.0
            }
        }),
    );
    let answer = folder.snake(&["fit", "cells.pgm", "--from", "labels.pgm", "-o", "a.csv"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let found = curves(&folder, "a.csv");
    assert_eq!(found.len(), 2);
    // along the line of their middles, from one to the other: no place in both, none between them in neither
    let (mut both, mut neither) = (0, 0);
    for y in 0..40 {
        let y = 56.0 + 0.2 * f64::from(y);
        for x in 0..400 {
            let p = [50.0 + 0.05 * f64::from(x), y];
            match (is_inside(&found[0], p), is_inside(&found[1], p)) {
                (true, true) => both += 1,
                (false, false) if (y - 60.0).abs() < 1.5 => neither += 1,
                _ => {}
            }
        }
    }
    assert!(both < 20, "{both} of 16000 places in both");
    assert!(neither < 60, "{neither} places between them in neither");
}

#[test]
fn what_a_network_says_of_every_pixel_counts_and_not_only_its_outline_at_one_half() {
    // two rings of edges, equally strong; the outline at one half lies in the middle between them
    let folder = Folder::new();
    let far = |x: f64, y: f64| (x - 59.5).hypot(y - 59.5);
    folder.write(
        "rings.pgm",
        pgm(|x, y| {
            200.0 - 70.0 * ((far(x, y) - 36.7).clamp(0.0, 1.0) + (far(x, y) - 42.3).clamp(0.0, 1.0))
        }),
    );
    // how sure it is between the inner ring and the middle, and between the middle and the outer one
    for (name, between, radius) in [
        ("outer.pfm", [0.95, 0.45], 42.8),
        ("inner.pfm", [0.55, 0.05], 37.2),
    ] {
        let mut soft = format!("Pf\n{SIDE} {SIDE}\n-1.0\n").into_bytes();
        for y in (0..SIDE).rev() {
            for x in 0..SIDE {
                let sure: f32 = match far(x as f64, y as f64) {
                    r if r < 37.2 => 0.97,
                    r if r < 40.0 => between[0],
                    r if r < 42.8 => between[1],
                    _ => 0.03,
                };
                soft.extend(sure.to_le_bytes());
            }
        }
        folder.write(name, soft);
        let answer = folder.snake(&["fit", "rings.pgm", "--from", name, "-o", "a.csv"]);
        assert!(
            answer.err.contains("by these probabilities too"),
            "{answer:?}"
        );
        let found = curves(&folder, "a.csv");
        let radii: Vec<f64> = found[0].iter().map(|p| far(p[0], p[1])).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        assert!(
            (mean - radius).abs() < 0.7,
            "{name}: {mean}, needed {radius}: {answer:?}"
        );
    }
}
