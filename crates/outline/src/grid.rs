//! A grid of square cells over the plane, each with the segments that pass through it.
//!
//! Only cells with something in them are kept, in a table of buckets that may hold several cells; whoever
//! asks looks at the distance anyway. Built by counting, twice over the segments: linear, and in one order.

use crate::segments::Segment;
use glam::DVec2;

/// Entries a segment, on the average, that the grid may grow to before its cells do.
const ENTRIES: f64 = 8.0;

/// Which segments pass through a cell. Memory is kept from one build to the next.
#[derive(Debug, Clone, Default)]
pub(crate) struct Grid {
    cell: f64,
    bits: u32,
    /// Where each bucket starts in `items`; one more than buckets.
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Grid {
    /// Files all segments. Cells are as wide as `reach`, or as the finest curve's mean edge if that is wider.
    #[allow(clippy::cast_possible_truncation, reason = "the door counts the nodes")]
    pub(crate) fn build(&mut self, segments: &[Segment], reach: f64) {
        self.cell = cell_size(segments, reach);
        let mut entries = 0_usize;
        for segment in segments {
            cells_along(segment, self.cell, |_, _| entries += 1);
        }
        self.bits = (2 * entries).max(16).next_power_of_two().ilog2();
        self.starts.clear();
        self.starts.resize((1 << self.bits) + 1, 0);
        self.items.clear();
        self.items.resize(entries, 0);
        let (cell, bits) = (self.cell, self.bits);
        for segment in segments {
            cells_along(segment, cell, |x, y| self.starts[bucket(x, y, bits)] += 1);
        }
        let mut total = 0;
        for start in &mut self.starts {
            total += *start;
            *start = total;
        }
        // filled from the back, so that each bucket's start walks down to where it belongs
        for (k, segment) in segments.iter().enumerate().rev() {
            cells_along(segment, cell, |x, y| {
                let start = &mut self.starts[bucket(x, y, bits)];
                *start -= 1;
                self.items[*start as usize] = k as u32;
            });
        }
    }

    /// All segments that pass through the cells within the box, and perhaps others; some more than once.
    pub(crate) fn visit_box(&self, least: DVec2, most: DVec2, mut visit: impl FnMut(u32)) {
        if self.items.is_empty() {
            return;
        }
        let (low, high) = (cell_of(least, self.cell), cell_of(most, self.cell));
        let cells = (high.0 - low.0 + 1).saturating_mul(high.1 - low.1 + 1);
        if cells >= (1_i64 << self.bits) {
            // more cells than buckets: everything is looked at once
            self.items.iter().copied().for_each(visit);
            return;
        }
        for y in low.1..=high.1 {
            for x in low.0..=high.0 {
                self.visit(bucket(x, y, self.bits), &mut visit);
            }
        }
    }

    /// The same for the cells a segment passes through.
    pub(crate) fn visit_along(&self, segment: &Segment, mut visit: impl FnMut(u32)) {
        cells_along(segment, self.cell, |x, y| {
            self.visit(bucket(x, y, self.bits), &mut visit);
        });
    }

    fn visit(&self, bucket: usize, visit: &mut impl FnMut(u32)) {
        let (from, to) = (
            self.starts[bucket] as usize,
            self.starts[bucket + 1] as usize,
        );
        self.items[from..to].iter().copied().for_each(visit);
    }
}

/// As wide as the reach, or the mean edge of the finest curve; but so wide that entries stay linear.
fn cell_size(segments: &[Segment], reach: f64) -> f64 {
    let (mut total, mut finest) = (0.0, f64::INFINITY);
    for curve in segments.chunk_by(|one, other| one.curve == other.curve) {
        let length: f64 = curve.iter().map(Segment::length).sum();
        finest = finest.min(length / curve.len() as f64);
        total += length;
    }
    let budget = total / (ENTRIES * segments.len() as f64);
    let cell = reach.max(finest).max(budget);
    if cell > 0.0 && cell.is_finite() {
        cell
    } else {
        1.0
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "it saturates; far cells run together"
)]
fn index(x: f64, cell: f64) -> i64 {
    // a quarter of the range, so that differences do not overflow
    const EDGE: f64 = (1_i64 << 61) as f64;
    (x / cell).floor().clamp(-EDGE, EDGE) as i64
}

fn cell_of(p: DVec2, cell: f64) -> (i64, i64) {
    (index(p.x, cell), index(p.y, cell))
}

/// All cells a segment passes through, row by row; one too many where it runs along a border.
fn cells_along(segment: &Segment, cell: f64, mut visit: impl FnMut(i64, i64)) {
    let (low, high) = if segment.a.y <= segment.b.y {
        (segment.a, segment.b)
    } else {
        (segment.b, segment.a)
    };
    let (left, right) = (low.x.min(high.x), low.x.max(high.x));
    let (first, last) = (index(low.y, cell), index(high.y, cell));
    let slope = if last > first {
        (high.x - low.x) / (high.y - low.y)
    } else {
        0.0
    };
    // rounding of where a row's border is crossed, many times over
    let slack = 1e-9 * cell + 1e-12 * (right - left);
    for row in first..=last {
        let (mut from, mut to) = (left, right);
        if last > first {
            let at = |y: f64| low.x + slope * (y - low.y);
            let one = if row == first {
                low.x
            } else {
                at(row as f64 * cell)
            };
            let other = if row == last {
                high.x
            } else {
                at((row + 1) as f64 * cell)
            };
            from = (one.min(other) - slack).max(left);
            to = (one.max(other) + slack).min(right);
        }
        for column in index(from, cell)..=index(to, cell) {
            visit(column, row);
        }
    }
}

/// The bucket of a cell: two odd numbers near the golden section of 2⁶⁴ spread neighbours far apart.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bits of a hash, of which the highest are kept"
)]
fn bucket(x: i64, y: i64, bits: u32) -> usize {
    let mixed = (x as u64)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add((y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
    ((mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> (64 - bits)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segments::push_curve;
    use proptest::prelude::*;

    proptest! {
        /// A point of a segment finds it in its own cell.
        #[test]
        fn every_point_of_a_segment_lies_in_a_cell_that_has_it(
            points in prop::collection::vec((-50.0..50.0_f64, -50.0..50.0_f64), 2..40),
            reach in 0.0..20.0_f64,
            shift in -1e6..1e6_f64,
        ) {
            let nodes: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x + shift, y)).collect();
            let mut segments = Vec::new();
            push_curve(&mut segments, 0, &nodes, true);
            let mut grid = Grid::default();
            grid.build(&segments, reach);
            for (k, segment) in segments.iter().enumerate() {
                for step in 0..=16 {
                    let p = segment.a.lerp(segment.b, f64::from(step) / 16.0);
                    // the sixteenth's own rounding
                    let room = DVec2::splat(1e-9);
                    let mut found = false;
                    grid.visit_box(p - room, p + room, |other| found |= other as usize == k);
                    prop_assert!(found, "{k} at {p}");
                }
            }
        }
    }

    #[test]
    fn one_long_edge_among_many_short_ones_keeps_the_entries_linear() {
        let mut nodes: Vec<DVec2> = (0..1000)
            .map(|i| DVec2::new(0.001 * f64::from(i), 0.0))
            .collect();
        nodes.push(DVec2::new(1e9, 1e9));
        let mut segments = Vec::new();
        push_curve(&mut segments, 0, &nodes, true);
        let mut grid = Grid::default();
        grid.build(&segments, 0.0);
        // 8 a segment for length in both directions, and 3 for where it starts
        assert!(
            grid.items.len() < 19 * segments.len(),
            "{}",
            grid.items.len()
        );
    }

    #[test]
    fn far_away_and_tiny_cells_neither_hang_nor_overflow() {
        let nodes = [
            DVec2::splat(1e75),
            DVec2::splat(-1e75),
            DVec2::new(1e75, -1e75),
        ];
        let mut segments = Vec::new();
        push_curve(&mut segments, 0, &nodes, true);
        let mut grid = Grid::default();
        grid.build(&segments, 1e-75);
        let mut seen = 0;
        grid.visit_box(DVec2::splat(-1e75), DVec2::splat(1e75), |_| seen += 1);
        assert!(seen >= 3);
    }
}
