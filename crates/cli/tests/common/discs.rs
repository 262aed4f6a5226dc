//! A data set of three discs whose scores are known by hand.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use super::{Folder, disc};

pub(crate) const SIZE: usize = 96;
/// Centers and radii of the three discs.
pub(crate) const DISCS: [([f64; 2], f64); 3] = [
    ([47.0, 45.0], 22.0),
    ([40.0, 52.0], 27.0),
    ([50.0, 50.0], 18.0),
];

/// The pixels of a disc.
pub(crate) fn pixels([x, y]: [f64; 2], radius: f64) -> Vec<bool> {
    let inside = |at: usize| {
        let (dx, dy) = ((at % SIZE) as f64 - x, (at / SIZE) as f64 - y);
        dx.hypot(dy) <= radius
    };
    (0..SIZE * SIZE).map(inside).collect()
}

/// A square about a point as a table of starts has it: `half` pixels to each side of the middle pixel, and half a one.
pub(crate) fn square([x, y]: [f64; 2], half: f64) -> String {
    let h = half + 0.5;
    let side = |k: usize| {
        let t = k as f64 / 8.0 * 2.0 * h - h;
        [(t, -h), (h, t), (-t, h), (-h, -t)]
    };
    // side after side
    let points = (0..4).flat_map(|s| (0..8).map(move |k| side(k)[s]));
    points
        .map(|(u, v)| format!("{} {}", x + u, y + v))
        .collect::<Vec<_>>()
        .join(";")
}

/// A data set of three discs in the folder `set`; each starts from a square about it.
pub(crate) fn set() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("set")).unwrap();
    let mut manifest = String::from("file,mask,source\n");
    let mut inits = String::from("stem,quality,kind,points\n");
    for (k, &(center, radius)) in DISCS.iter().enumerate() {
        folder.write(&format!("set/d{k}.pgm"), disc(SIZE, center, radius));
        let mut mask = format!("P5 {SIZE} {SIZE} 255\n").into_bytes();
        mask.extend(
            pixels(center, radius)
                .iter()
                .map(|inside| if *inside { 255 } else { 0 }),
        );
        folder.write(&format!("set/d{k}_mask.pgm"), mask);
        manifest += &format!("d{k}.pgm,d{k}_mask.pgm,\"a disc, drawn\"\n");
        inits += &format!("d{k},near,polygon,{}\n", square(center, radius + 1.0));
        inits += &format!("d{k},wide,polygon,{}\n", square(center, radius + 3.0));
    }
    folder.write("set/manifest.csv", manifest);
    folder.write("set/inits.csv", inits);
    folder
}

/// The share of a square's pixels that are in its disc: all of the disc's are in the square.
pub(crate) fn start_iou(k: usize, more: f64) -> f64 {
    let (center, radius) = DISCS[k];
    let inside = pixels(center, radius)
        .iter()
        .filter(|inside| **inside)
        .count();
    inside as f64 / (2.0 * (radius + more) + 1.0).powi(2)
}

/// The rows of a table behind its head, as words.
pub(crate) fn words(table: &str) -> Vec<Vec<&str>> {
    table
        .lines()
        .skip(1)
        .map(|line| line.split_whitespace().collect())
        .collect()
}

/// The columns of a CSV file by their names, a row each.
pub(crate) fn columns(text: &str, names: &[&str]) -> Vec<Vec<String>> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at: Vec<usize> = names
        .iter()
        .map(|n| head.iter().position(|h| h == n).unwrap())
        .collect();
    lines
        .map(|line| {
            let values: Vec<&str> = line.split(',').collect();
            at.iter().map(|&k| values[k].to_owned()).collect()
        })
        .collect()
}
