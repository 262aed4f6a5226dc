//! The pixels inside a polygon, as rows of spans.

use glam::DVec2;

use crate::seeds::Circle;

/// Spans of pixels: row, first column, and the column behind the last; by rows.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Spans(pub Vec<(usize, usize, usize)>);

impl Spans {
    /// The pixels of a picture of that size whose middles lie inside.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture first"
    )]
    pub(crate) fn of(points: &[DVec2], (height, width): (usize, usize)) -> Self {
        let low = points.iter().fold(f64::INFINITY, |low, p| low.min(p.y));
        let high = points
            .iter()
            .fold(f64::NEG_INFINITY, |high, p| high.max(p.y));
        let first = low.ceil().clamp(0.0, height as f64) as usize;
        let behind = (high.floor() + 1.0).clamp(first as f64, height as f64) as usize;
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); behind - first];
        for (i, a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let (top, bottom) = if a.y <= b.y { (*a, b) } else { (b, *a) };
            let mut y = top.y.ceil().max(first as f64);
            let to = bottom.y.ceil().min(behind as f64);
            while y < to {
                let share = (y - top.y) / (bottom.y - top.y);
                crossings[y as usize - first].push(top.x + share * (bottom.x - top.x));
                y += 1.0;
            }
        }
        let mut spans = Vec::new();
        for (row, list) in crossings.iter_mut().enumerate() {
            list.sort_by(f64::total_cmp);
            for pair in list.chunks_exact(2) {
                let from = pair[0].ceil().clamp(0.0, width as f64) as usize;
                let to = pair[1].ceil().clamp(0.0, width as f64) as usize;
                if from < to {
                    spans.push((first + row, from, to));
                }
            }
        }
        Self(spans)
    }

    /// Number of pixels.
    pub(crate) fn area(&self) -> usize {
        self.0.iter().map(|(_, from, to)| to - from).sum()
    }

    /// Number of pixels in both.
    pub(crate) fn common(&self, other: &Self) -> usize {
        let (mut i, mut j, mut sum) = (0, 0, 0);
        while let (Some(a), Some(b)) = (self.0.get(i), other.0.get(j)) {
            if a.0 == b.0 {
                sum += a.2.min(b.2).saturating_sub(a.1.max(b.1));
            }
            if (a.0, a.2) < (b.0, b.2) {
                i += 1;
            } else {
                j += 1;
            }
        }
        sum
    }

    /// The circle of a seed in it: half the size of its area, about the pixel nearest to its middle.
    pub(crate) fn circle(&self) -> Option<Circle> {
        let place = |(y, x): (usize, usize)| DVec2::new(x as f64, y as f64);
        let area = self.area() as f64;
        let middle = self.pixels().map(place).sum::<DVec2>() / area;
        let nearest = self.pixels().map(place).min_by(|a, b| {
            let (a, b) = (a.distance_squared(middle), b.distance_squared(middle));
            a.total_cmp(&b)
        })?;
        let center = if nearest.distance(middle) < 1.0 {
            middle
        } else {
            nearest
        };
        let radius = 0.5 * (area / std::f64::consts::PI).sqrt();
        Some(Circle { center, radius })
    }

    /// All pixels.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.0.iter();
        all.flat_map(|&(row, from, to)| (from..to).map(move |column| (row, column)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Vec<DVec2> {
        [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
            .map(|(i, j)| DVec2::new(x + i, y + j))
            .to_vec()
    }

    #[test]
    fn squares_have_their_pixels() {
        let (a, b) = (square(1.5, 2.5, 4.0), square(3.5, 4.5, 10.0));
        let (a, b) = (Spans::of(&a, (12, 10)), Spans::of(&b, (12, 10)));
        assert_eq!((a.area(), b.area()), (16, 42));
        assert_eq!((a.common(&b), b.common(&a), a.common(&a)), (4, 4, 16));
        assert_eq!(a.pixels().next(), Some((3, 2)));
        assert_eq!(Spans::of(&square(-9.0, -9.0, 5.0), (12, 10)).area(), 0);
    }
}
