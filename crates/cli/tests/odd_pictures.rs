//! Pictures that are fine but odd: tiny, narrow, constant, deep, below black, with pixels that do not count.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use io::numbers::float_tiff;
use io::shapes;
use scene::field::Grid;

/// A PGM of 8 bits.
fn bytes(width: usize, height: usize, level: impl Fn(usize, usize) -> u8) -> Vec<u8> {
    let mut file = format!("P5\n{width} {height}\n255\n").into_bytes();
    file.extend((0..width * height).map(|i| level(i % width, i / width)));
    file
}

/// A PGM of 16 bits.
fn words(width: usize, height: usize, level: impl Fn(usize, usize) -> u16) -> Vec<u8> {
    let mut file = format!("P5\n{width} {height}\n65535\n").into_bytes();
    file.extend((0..width * height).flat_map(|i| level(i % width, i / width).to_be_bytes()));
    file
}

/// Whether every number of an NPY file of float64 is finite, and one is not 0.
fn numbers(bytes: &[u8]) -> (bool, bool) {
    let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (words, _) = bytes[length..].as_chunks::<8>();
    let mut list = words.iter().map(|w| f64::from_le_bytes(*w));
    let finite = list.clone().all(f64::is_finite);
    (finite, list.any(|v| v.abs() > 0.0))
}

/// Every kind of field of a picture is finite; whether one of them is not zero.
fn every_kind(folder: &Folder, file: &str) -> bool {
    let answer = folder.snake(&["field", file, "--out", "out", "--all", "--sigma", "1"]);
    assert_eq!(answer.code, Some(0), "{file}: {answer:?}");
    let mut some = false;
    for name in answer.out.lines().filter(|name| name.ends_with(".npy")) {
        let (finite, force) = numbers(&std::fs::read(folder.path(name)).unwrap());
        assert!(finite, "{file}: {name}");
        some |= force && !name.contains("potential");
    }
    some
}

#[test]
fn tiny_narrow_and_constant_pictures_have_every_kind_of_field_and_no_number_that_is_none() {
    let folder = Folder::new();
    let stripes = |x: usize, _: usize| if x % 40 < 20 { 30 } else { 220 };
    for (name, width, height, forces) in [
        ("one.pgm", 1, 1, false),
        ("row.pgm", 50, 1, true),
        ("column.pgm", 1, 50, false),
        ("three.pgm", 3, 3, false),
        ("strip.pgm", 2000, 3, true),
    ] {
        folder.write(name, bytes(width, height, stripes));
        assert_eq!(every_kind(&folder, name), forces, "{name}");
    }
    folder.write("flat.pgm", bytes(30, 20, |_, _| 77));
    assert!(!every_kind(&folder, "flat.pgm"));
}

#[test]
fn a_strip_of_100_000_by_3_is_fitted_in() {
    let folder = Folder::new();
    let step = |x: usize, _: usize| if x < 70_000 { 30 } else { 220 };
    folder.write("strip.pgm", bytes(100_000, 3, step));
    folder.write("c.csv", "69995,0\n69995,1\n69995,2\n");
    let fit = [
        "fit",
        "strip.pgm",
        "--from",
        "c.csv",
        "--open",
        "--nodes",
        "5",
    ];
    for force in [&[][..], &["--force", "vfc"], &["--force", "distance"]] {
        let answer = folder.snake(&[&fit[..], force].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let found = shapes::parse_one(&answer.out).unwrap();
        for p in found.first() {
            assert!((p.x - 69_999.5).abs() < 0.6, "{force:?}: {p}");
        }
    }
}

#[test]
fn deep_pictures_and_levels_below_black_have_their_edges() {
    let folder = Folder::new();
    let disc = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
    folder.write(
        "deep.pgm",
        words(60, 60, |x, y| if disc(x, y) { 31_000 } else { 30_000 }),
    );
    let below = Grid::from_shape_fn((60, 60), |(y, x)| if disc(x, y) { 0.2 } else { -0.7 });
    folder.write("below.tiff", float_tiff(&[&below]).unwrap());
    let start: Vec<String> = (0..24)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 24.0)
        .map(|a| format!("{:.3},{:.3}", 30.0 + 19.0 * a.cos(), 30.0 + 19.0 * a.sin()))
        .collect();
    folder.write("c.csv", start.join("\n"));
    for file in ["deep.pgm", "below.tiff"] {
        assert!(every_kind(&folder, file), "{file}");
        let answer = folder.snake(&["fit", file, "--from", "c.csv", "--sigma", "2"]);
        assert_eq!(answer.code, Some(0), "{file}: {answer:?}");
        for p in shapes::parse_one(&answer.out).unwrap().first() {
            let r = (p.x - 30.0).hypot(p.y - 30.0);
            assert!((r - 15.0).abs() < 0.7, "{file}: {r}");
        }
    }
}

#[test]
fn pixels_that_do_not_count_are_masked_when_asked_and_refused_otherwise() {
    let folder = Folder::new();
    let level = |x: usize| if x < 30 { 0.2 } else { 0.8 };
    let holes = Grid::from_shape_fn(
        (40, 60),
        |(y, x)| {
            if y > 30 && x < 9 { f64::NAN } else { level(x) }
        },
    );
    folder.write("holes.tiff", float_tiff(&[&holes]).unwrap());
    // a bar that does not count
    folder.write(
        "mask.pgm",
        bytes(60, 40, |x, _| if (10..14).contains(&x) { 0 } else { 255 }),
    );
    let scene = |lines: &str| {
        format!(
            "title = \"t\"\n[picture]\nfile = \"holes.tiff\"\n{lines}\n[snake]\nnodes = 5\n\
             topology = \"open\"\nstart = {{ segment = {{ from = [26.0, 10.0], to = [26.0, 25.0] }} }}\n\
             [material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
             [densities]\nmass = 1.0\ndamping = 1.0\n[run]\ndt = 0.05\nsteps = 2000\n"
        )
    };
    folder.write("plain.toml", scene(""));
    folder.refused(&["run", "plain.toml"], &["(0, 31)", "NaN", "mask"]);
    for lines in [
        "invalid = \"mask\"",
        "invalid = \"mask\"\nmask = \"mask.pgm\"",
    ] {
        folder.write("s.toml", scene(lines));
        let answer = folder.snake(&["run", "s.toml", "--out", "-"]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        for p in shapes::parse_one(&answer.out).unwrap().first() {
            assert!((p.x - 29.5).abs() < 0.3, "{lines}: {p}");
        }
    }
}
