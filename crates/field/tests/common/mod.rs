//! Reading the fixtures of `tests/oracle` and `tests/outside`.
#![allow(dead_code, reason = "each test crate uses its own part")]
#![allow(
    clippy::unwrap_used,
    reason = "a fixture that cannot be read fails the test"
)]

use field::Grid;
use std::path::PathBuf;

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/oracle")
        .join(name)
}

/// An 8-bit binary PGM.
pub(crate) fn pgm(name: &str) -> Grid {
    let bytes = std::fs::read(path(name)).unwrap();
    let mut fields = Vec::new();
    let mut at = 0;
    while fields.len() < 4 {
        let end = at
            + bytes[at..]
                .iter()
                .position(u8::is_ascii_whitespace)
                .unwrap();
        if end > at {
            fields.push(std::str::from_utf8(&bytes[at..end]).unwrap());
        }
        at = end + 1;
    }
    assert_eq!((fields[0], fields[3]), ("P5", "255"));
    let (width, height) = (fields[1].parse().unwrap(), fields[2].parse().unwrap());
    let pixels = bytes[at..].iter().map(|&b| f64::from(b)).collect();
    Grid::from_shape_vec((height, width), pixels).unwrap()
}

/// A grid as text, one line a row.
pub(crate) fn csv(name: &str) -> Grid {
    let rows = table(name, 0);
    Grid::from_shape_vec((rows.len(), rows[0].len()), rows.concat()).unwrap()
}

/// A grid of `tests/outside`, without its ending.
pub(crate) fn outside(name: &str) -> Grid {
    let rows = table(&format!("../outside/{name}.csv"), 0);
    Grid::from_shape_vec((rows.len(), rows[0].len()), rows.concat()).unwrap()
}

/// A grid as little-endian doubles, of the shape of `like`.
pub(crate) fn doubles(name: &str, like: &Grid) -> Grid {
    let bytes = std::fs::read(path(name)).unwrap();
    let values = bytes
        .chunks_exact(8)
        .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
        .collect();
    Grid::from_shape_vec(like.dim(), values).unwrap()
}

/// The numbers of a table, after so many header lines.
pub(crate) fn table(name: &str, header: usize) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path(name)).unwrap();
    let row = |line: &str| line.split(',').map(|t| t.trim().parse().unwrap()).collect();
    text.lines().skip(header).map(row).collect()
}

/// Fails unless every number is the same double (−0 counts as 0).
pub(crate) fn same_bits(what: &str, got: &Grid, wanted: &Grid) {
    assert_eq!(got.dim(), wanted.dim(), "{what}");
    for ((at, g), w) in got.indexed_iter().zip(wanted) {
        assert_eq!(
            (g + 0.0).to_bits(),
            (w + 0.0).to_bits(),
            "{what} at {at:?}: {g} and {w}"
        );
    }
}

/// Fails unless every number is within `tolerance` of its twin.
pub(crate) fn within(what: &str, tolerance: f64, got: &Grid, wanted: &Grid) {
    assert_eq!(got.dim(), wanted.dim(), "{what}");
    for ((at, g), w) in got.indexed_iter().zip(wanted) {
        assert!((g - w).abs() <= tolerance, "{what} at {at:?}: {g} and {w}");
    }
}
