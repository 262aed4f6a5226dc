//! A connected set of pixels, its holes filled, and its shape.

use ndarray::Array2;

use crate::spans::Spans;

/// How far about a pixel a border is made smooth, as a share of the radius of a disk of the region's area.
const SMOOTH: f64 = 0.12;

/// Pixels in a box of a grid.
#[derive(Debug, Clone)]
pub(crate) struct Region {
    /// The first column and row of the box in the grid.
    pub left: usize,
    pub top: usize,
    /// Rows and columns of the box; true for pixels of the region.
    pub bits: Array2<bool>,
    pub area: usize,
    /// The same with its holes, if it has any.
    pub bare: Option<Array2<bool>>,
}

impl Region {
    /// Pixels of a grid by their numbers, and what they enclose.
    pub(crate) fn of(pixels: &[usize], width: usize) -> Option<Self> {
        let (first, last) = (pixels.iter().min()?, pixels.iter().max()?);
        let columns = || pixels.iter().map(|at| at % width);
        let (left, right) = (columns().min()?, columns().max()?);
        let (top, bottom) = (first / width, last / width);
        let mut bits = Array2::from_elem((bottom - top + 1, right - left + 1), false);
        for at in pixels {
            bits[[at / width - top, at % width - left]] = true;
        }
        let mut out = Self {
            left,
            top,
            bits,
            area: pixels.len(),
            bare: None,
        };
        out.fill();
        Some(out)
    }

    /// Fill holes: what cannot be reached from beyond the box.
    fn fill(&mut self) {
        let (height, width) = self.bits.dim();
        let mut outside = Array2::from_elem((height, width), false);
        let mut open: Vec<(usize, usize)> = Vec::new();
        let rim = (0..height).flat_map(|y| [(y, 0), (y, width - 1)]);
        for place in rim.chain((0..width).flat_map(|x| [(0, x), (height - 1, x)])) {
            if !self.bits[place] && !outside[place] {
                outside[place] = true;
                open.push(place);
            }
        }
        while let Some((y, x)) = open.pop() {
            let near = [
                (y.wrapping_sub(1), x),
                (y + 1, x),
                (y, x.wrapping_sub(1)),
                (y, x + 1),
            ];
            for place in near {
                if self.bits.get(place) == Some(&false) && !outside[place] {
                    outside[place] = true;
                    open.push(place);
                }
            }
        }
        let filled = outside.mapv(|out| !out);
        let area = filled.iter().filter(|bit| **bit).count();
        if area > self.area {
            self.bare = Some(std::mem::replace(&mut self.bits, filled));
            self.area = area;
        }
    }

    /// Whether a pixel of the grid belongs to it.
    pub(crate) fn holds(&self, x: usize, y: usize) -> bool {
        let place = (y.wrapping_sub(self.top), x.wrapping_sub(self.left));
        self.bits.get(place) == Some(&true)
    }

    /// The pixels in rows.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.bits.indexed_iter().filter(|(_, bit)| **bit);
        all.map(|((y, x), _)| (y + self.top, x + self.left))
    }

    /// Its largest connected part that meets a condition on pixels (column and row).
    pub(crate) fn part(&self, keep: impl Fn(usize, usize) -> bool, width: usize) -> Option<Self> {
        let mut left = self.bits.clone();
        for (y, x) in self.pixels() {
            left[[y - self.top, x - self.left]] = keep(x, y);
        }
        let mut best: Vec<usize> = Vec::new();
        let all: Vec<(usize, usize)> = left
            .indexed_iter()
            .filter(|(_, bit)| **bit)
            .map(|(place, _)| place)
            .collect();
        for place in all {
            if !left[place] {
                continue;
            }
            left[place] = false;
            let (mut open, mut found) = (vec![place], Vec::new());
            while let Some((y, x)) = open.pop() {
                found.push((y + self.top) * width + x + self.left);
                let near = [
                    (y.wrapping_sub(1), x),
                    (y + 1, x),
                    (y, x.wrapping_sub(1)),
                    (y, x + 1),
                ];
                for place in near {
                    if left.get(place) == Some(&true) {
                        left[place] = false;
                        open.push(place);
                    }
                }
            }
            if found.len() > best.len() {
                best = found;
            }
        }
        Self::of(&best, width)
    }

    /// What most pixels about each belong to, over a tenth of its size: a border without teeth.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the size of a region"
    )]
    pub(crate) fn smoothed(&self, width: usize) -> Option<Self> {
        let reach = (SMOOTH * (self.area as f64 / std::f64::consts::PI).sqrt()).round() as usize;
        if reach == 0 {
            return Some(self.clone());
        }
        let (rows, columns) = self.bits.dim();
        // sums of all above and to the left
        let mut sums = Array2::<u32>::zeros((rows + 1, columns + 1));
        for ((y, x), bit) in self.bits.indexed_iter() {
            sums[[y + 1, x + 1]] =
                sums[[y, x + 1]] + sums[[y + 1, x]] + u32::from(*bit) - sums[[y, x]];
        }
        let keep = |x: usize, y: usize| {
            let (x, y) = (x - self.left, y - self.top);
            let (x0, y0) = (x.saturating_sub(reach), y.saturating_sub(reach));
            let (x1, y1) = ((x + reach + 1).min(columns), (y + reach + 1).min(rows));
            let sum = sums[[y1, x1]] + sums[[y0, x0]] - sums[[y0, x1]] - sums[[y1, x0]];
            2 * sum as usize > (y1 - y0) * (x1 - x0)
        };
        self.part(keep, width)
    }

    /// The share of the pixels of its convex hull that it holds: 1 for one that is convex. Pixels of the hull of a
    /// polygon are counted by Pick's formula.
    pub(crate) fn solidity(&self) -> f64 {
        let mut ends: Vec<(i64, i64)> = Vec::new();
        for (y, row) in (0_i64..).zip(self.bits.rows()) {
            let mut own = (0_i64..).zip(row).filter(|(_, bit)| **bit).map(|(x, _)| x);
            if let Some(first) = own.next() {
                ends.push((first, y));
                ends.push((own.last().unwrap_or(first), y));
            }
        }
        let hull = hull(ends);
        let (mut twice, mut on) = (0_i64, 0_u64);
        for (i, a) in hull.iter().enumerate() {
            let b = hull[(i + 1) % hull.len()];
            twice += a.0 * b.1 - a.1 * b.0;
            on += divisor(a.0.abs_diff(b.0), a.1.abs_diff(b.1));
        }
        let within = 0.5 * (twice.abs() as f64) + 0.5 * on as f64 + 1.0;
        (self.area as f64 / within).min(1.0)
    }

    /// Its pixels in a picture that is so many times as large.
    pub(crate) fn spans(&self, times: usize, (height, width): (usize, usize)) -> Spans {
        let mut out = Vec::new();
        for (y, row) in self.bits.rows().into_iter().enumerate() {
            let mut own = Vec::new();
            let mut from = None;
            for x in 0..=row.len() {
                let is_in = row.get(x) == Some(&true);
                match from {
                    None if is_in => from = Some(x),
                    Some(first) if !is_in => {
                        let left = times * (self.left + first);
                        own.push((left, (times * (self.left + x)).min(width)));
                        from = None;
                    }
                    _ => {}
                }
            }
            for k in 0..times {
                let row = times * (self.top + y) + k;
                if row < height {
                    out.extend(own.iter().map(|&(from, to)| (row, from, to)));
                }
            }
        }
        Spans(out)
    }
}

/// The corners of the convex hull of points, in order.
fn hull(mut points: Vec<(i64, i64)>) -> Vec<(i64, i64)> {
    points.sort_unstable();
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull: Vec<(i64, i64)> = Vec::new();
    for _ in 0..2 {
        let base = hull.len();
        for &p in &points {
            while let [.., a, b] = hull[base..] {
                if (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0) > 0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        points.reverse();
    }
    hull
}

/// The greatest common divisor.
const fn divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn drawn(size: usize, is_in: impl Fn(f64, f64) -> bool) -> Option<Region> {
        let at = |place: &usize| is_in((place % size) as f64, (place / size) as f64);
        Region::of(&(0..size * size).filter(at).collect::<Vec<_>>(), size)
    }

    #[test]
    fn a_ring_is_filled_and_a_disk_is_convex() {
        for radius in [2.0, 3.5, 9.2, 20.0] {
            let far = |x: f64, y: f64| (x - 30.0).hypot(y - 31.0);
            let disk = drawn(60, |x, y| far(x, y) <= radius).unwrap();
            assert!(disk.solidity() > 0.95, "{radius}: {}", disk.solidity());
            let ring = drawn(60, |x, y| (radius - 1.5..=radius).contains(&far(x, y)));
            let ring = ring.unwrap();
            assert_eq!(ring.bits, disk.bits);
            let circle = ring.spans(1, (60, 60)).circle().unwrap();
            assert!(circle.center.distance(DVec2::new(30.0, 31.0)) < 0.1);
        }
    }

    #[test]
    fn an_l_is_not_convex_and_has_its_parts() {
        let corner = |x: f64, y: f64| x < 20.0 && y < 20.0 && (x < 10.0 || y < 10.0);
        let region = drawn(30, corner).unwrap();
        // three quarters of a square, whose hull is seven eighths of it and a little more
        assert!((region.solidity() - 6.0 / 7.0).abs() < 0.02);
        let part = region.part(|x, y| y >= 12 || x >= 18, 30).unwrap();
        assert_eq!((part.area, part.left, part.top), (80, 0, 12));
        assert_eq!(region.spans(1, (30, 30)).area(), 300);
        assert_eq!(region.spans(2, (60, 60)).area(), 1200);
        assert_eq!(region.spans(2, (39, 60)).area(), 1180);
    }
}
