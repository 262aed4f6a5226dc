//! The bodies of the fuzz targets on their seeds, whole and damaged.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]

use std::path::Path;

#[path = "../fuzz/fuzz_targets/bodies.rs"]
#[allow(
    clippy::cast_precision_loss,
    unreachable_pub,
    reason = "shared with the fuzz targets, which are another workspace"
)]
mod bodies;

/// The files of a folder with one of these endings, in order.
fn seeds(folder: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            let ending = path.extension().and_then(|ending| ending.to_str());
            ending.is_some_and(|ending| endings.contains(&ending))
        })
        .collect();
    paths.sort();
    assert!(!paths.is_empty(), "no seeds");
    paths
        .iter()
        .map(|path| std::fs::read(path).unwrap())
        .collect()
}

/// Numbers that look random and are the same on every machine (splitmix64).
struct Dice(u64);

impl Dice {
    fn throw(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % u64::try_from(sides.max(1)).unwrap()).unwrap()
    }
}

/// A seed with a few bytes changed, taken out, doubled, or its end cut off.
fn damaged(seed: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut out = seed.to_vec();
    for _ in 0..=dice.throw(3) {
        let at = dice.throw(out.len());
        let kind = if out.is_empty() { 3 } else { dice.throw(5) };
        match kind {
            0 => out[at] = b"0123456789.-e\"[],=\n\0\xff"[dice.throw(21)],
            1 => {
                out.remove(at);
            }
            2 => out.truncate(at),
            3 => out.insert(at, b'9'),
            _ => {
                let piece = out[at..(at + 8).min(out.len())].to_vec();
                let to = dice.throw(out.len());
                out.splice(to..to, piece);
            }
        }
    }
    out
}

/// Each seed whole, and `times` damaged.
fn against(body: fn(&[u8]), seeds: &[Vec<u8>], times: usize) {
    let mut dice = Dice(11);
    for seed in seeds {
        body(seed);
        for _ in 0..times {
            body(&damaged(seed, &mut dice));
        }
    }
}

#[test]
fn contours_whole_and_damaged_are_read_or_refused() {
    against(bodies::contour, &seeds("pictures", &["csv"]), 300);
    against(bodies::contour, &[b"x,y\n1,2\n3,4\n5,1\n".to_vec()], 2000);
}

#[test]
fn pictures_whole_and_damaged_are_read_or_refused() {
    let endings = ["pgm", "png", "tif", "tiff", "jpg"];
    against(
        bodies::picture,
        &seeds("tests/oracle/images", &endings),
        100,
    );
}

#[test]
fn scenes_whole_and_damaged_run_or_are_refused() {
    against(bodies::scene_text, &seeds("scenes", &["toml"]), 4);
}

#[test]
fn nothing_at_all_is_refused() {
    for body in [bodies::contour, bodies::picture, bodies::scene_text] {
        body(b"");
        body(b"\xff\xfe");
    }
}
