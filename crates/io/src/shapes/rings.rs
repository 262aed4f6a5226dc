//! Rings in rings: areas, and which of them are holes of which.

use glam::DVec2;

/// The area with its sign, positive where x turns to y.
pub(super) fn area(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    let next = ring.iter().skip(1).chain(std::iter::once(&origin));
    let pairs = ring.iter().zip(next);
    pairs
        .map(|(&a, &b)| (a - origin).perp_dot(b - origin))
        .sum::<f64>()
        / 2.0
}

/// The smallest and the largest corner.
pub(super) fn bounds<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> Option<(DVec2, DVec2)> {
    let mut points = points.into_iter();
    let first = *points.next()?;
    Some(points.fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
}

/// Whether a point is inside by the even-odd rule.
pub(super) fn inside(ring: &[DVec2], p: DVec2) -> bool {
    let mut odd = false;
    let mut before = ring.last();
    for b in ring {
        if let Some(a) = before
            && (a.y > p.y) != (b.y > p.y)
            && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
        {
            odd = !odd;
        }
        before = Some(b);
    }
    odd
}

/// An outer ring by its number, and the numbers of the holes in it.
pub(super) type Part = (usize, Vec<usize>);

/// Comparisons of rings that are made at most, a point counting as one.
const MOST_WORK: usize = 1 << 29;

/// Rings by where they are: of a point, those around it are found without looking at all others.
struct Places {
    low: DVec2,
    cell: DVec2,
    /// Cells in a row, and in a column.
    count: usize,
    cells: Vec<Vec<usize>>,
    /// Rings over many cells.
    wide: Vec<usize>,
}

/// Cells that a ring is written down in.
const MOST_CELLS: usize = 64;

impl Places {
    fn new(boxes: &[Option<(DVec2, DVec2)>]) -> Self {
        let all = boxes.iter().flatten().flat_map(|(low, high)| [low, high]);
        let (low, high) = bounds(all).unwrap_or_default();
        let count = boxes.len().isqrt().max(1);
        Self {
            low,
            cell: ((high - low) / count as f64).max(DVec2::splat(f64::MIN_POSITIVE)),
            count,
            cells: vec![Vec::new(); count * count],
            wide: Vec::new(),
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the cells there are"
    )]
    fn at(&self, p: DVec2) -> (usize, usize) {
        let place = (p - self.low) / self.cell;
        let within = |v: f64| v.clamp(0.0, (self.count - 1) as f64) as usize;
        (within(place.x), within(place.y))
    }

    fn add(&mut self, ring: usize, (low, high): (DVec2, DVec2)) {
        let ((left, top), (right, bottom)) = (self.at(low), self.at(high));
        if (right - left + 1) * (bottom - top + 1) > MOST_CELLS {
            self.wide.push(ring);
            return;
        }
        for y in top..=bottom {
            for x in left..=right {
                self.cells[y * self.count + x].push(ring);
            }
        }
    }

    /// Rings that may be around a point, the last added first: of rings in rings, the smallest.
    fn near(&self, p: DVec2) -> impl Iterator<Item = usize> {
        let (x, y) = self.at(p);
        let near = &self.cells[y * self.count + x];
        near.iter().rev().chain(self.wide.iter().rev()).copied()
    }
}

/// The parts that rings make by the even-odd rule; they must not cross.
///
/// # Errors
///
/// So many rings in rings that they would not be told apart in a sensible time.
pub(super) fn parts(rings: &[Vec<DVec2>]) -> Result<Vec<Part>, String> {
    let boxes: Vec<_> = rings.iter().map(bounds).collect();
    let areas: Vec<f64> = rings.iter().map(|ring| area(ring).abs()).collect();
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
    // of each ring: how many go around it, and the smallest of these
    let mut around = vec![(0_usize, None); rings.len()];
    let mut places = Places::new(&boxes);
    let mut work = 0_usize;
    for &own in &order {
        let Some((low, high)) = boxes[own] else {
            continue;
        };
        let mut smallest: Option<usize> = None;
        for other in places.near((low + high) / 2.0) {
            work += 1;
            let Some((least, most)) = boxes[other] else {
                continue;
            };
            let within = least.cmple(low).all() && most.cmpge(high).all();
            if !within || smallest.is_some_and(|known| around[known].0 >= around[other].0) {
                continue;
            }
            work = work.saturating_add(LOOKS * rings[other].len());
            if work > MOST_WORK {
                return Err(
                    "has too many rings in rings to tell which are holes; fewer are needed"
                        .to_owned(),
                );
            }
            if contains(&rings[other], &rings[own]) {
                smallest = Some(other);
            }
        }
        if let Some(other) = smallest {
            around[own] = (around[other].0 + 1, Some(other));
        }
        places.add(own, (low, high));
    }
    let mut parts: Vec<Part> = Vec::new();
    let mut place = vec![0; rings.len()];
    for own in 0..rings.len() {
        if around[own].0 % 2 == 0 {
            place[own] = parts.len();
            parts.push((own, Vec::new()));
        }
    }
    for own in 0..rings.len() {
        if let (true, Some(outer)) = (around[own].0 % 2 == 1, around[own].1) {
            parts[place[outer]].1.push(own);
        }
    }
    Ok(parts)
}

/// Points of a ring that are looked at.
const LOOKS: usize = 32;

/// Whether most of a ring is inside another; they may touch.
fn contains(outer: &[DVec2], ring: &[DVec2]) -> bool {
    let n = ring.len();
    let step = n.div_ceil(LOOKS).max(1);
    let middles = (0..n).step_by(step).map(|i| {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        a + (b - a) * 0.49
    });
    let (mut yes, mut no) = (0, 0);
    for p in middles {
        if inside(outer, p) {
            yes += 1;
        } else {
            no += 1;
        }
    }
    yes > no
}

/// The area inside by the even-odd rule.
///
/// # Errors
///
/// As [`parts`].
pub(super) fn even_odd_area(rings: &[Vec<DVec2>]) -> Result<f64, String> {
    let own = |i: usize| area(&rings[i]).abs();
    let parts = parts(rings)?;
    let each = parts
        .iter()
        .map(|(outer, holes)| own(*outer) - holes.iter().map(|&hole| own(hole)).sum::<f64>());
    Ok(each.sum())
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "areas of whole pixels are exact")]
mod tests {
    use super::*;

    fn square(at: f64, size: f64) -> Vec<DVec2> {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(x, y)| DVec2::splat(at) + size * DVec2::new(x, y))
            .to_vec()
    }

    #[test]
    fn a_hundred_thousand_rings_are_told_apart_and_far_more_work_is_refused() {
        let many = (0..100_000).map(|i| {
            let shift = DVec2::new(f64::from(i % 316), f64::from(i / 316)) * 2.0;
            square(0.0, 1.5)
                .into_iter()
                .map(|p| p + shift)
                .collect::<Vec<_>>()
        });
        let mut rings: Vec<_> = many.collect();
        rings.push(square(-5.0, 1000.0));
        let found = parts(&rings).unwrap();
        assert_eq!(
            (found.len(), found[0].0, found[0].1.len()),
            (1, 100_000, 100_000)
        );
        let nested: Vec<_> = (1..200_000)
            .map(|i| square(-f64::from(i), 2.0 * f64::from(i)))
            .collect();
        assert!(parts(&nested).is_err());
    }

    #[test]
    fn rings_in_rings_are_holes_and_islands() {
        let rings = [
            square(3.0, 2.0),
            square(0.0, 10.0),
            square(2.0, 5.0),
            square(20.0, 1.0),
            square(7.0, 1.0), // touches the corner of the hole
        ];
        assert_eq!(
            parts(&rings).unwrap(),
            [(0, vec![]), (1, vec![2, 4]), (3, vec![])]
        );
        assert_eq!(
            even_odd_area(&rings).unwrap(),
            100.0 - 25.0 - 1.0 + 4.0 + 1.0
        );
    }
}
