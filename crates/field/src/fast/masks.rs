//! Masks of three numbers along and across rows, and rows that become forces.

use super::room::Rows;
use super::vector::Lanes;

/// `a + 2 b + c`.
#[inline(always)]
pub(super) fn sum<L: Lanes>(lanes: L, a: L::V, b: L::V, c: L::V) -> L::V {
    lanes.add(lanes.add(a, c), lanes.add(b, b))
}

/// The mask [1 2 1] along a row, or its magnitude.
#[inline(always)]
pub(super) fn along<L: Lanes, const MAGNITUDE: bool>(
    lanes: L,
    from: &Rows<'_>,
    row: usize,
    out: &mut [f32],
) {
    let (left, here) = (L::view(from.shifted(row, -1)), L::view(from.get(row)));
    let right = L::view(from.shifted(row, 1));
    let inputs = left.iter().zip(here).zip(right);
    for (out, ((&a, &b), &c)) in L::view_mut(out).iter_mut().zip(inputs) {
        let sum = sum(lanes, a, b, c);
        *out = if MAGNITUDE { lanes.abs(sum) } else { sum };
    }
}

/// The mask [1 2 1] across three rows.
#[inline(always)]
pub(super) fn across<L: Lanes>(lanes: L, [a, b, c]: [&[f32]; 3], out: &mut [f32]) {
    let inputs = L::view(a).iter().zip(L::view(b)).zip(L::view(c));
    for (out, ((&a, &b), &c)) in L::view_mut(out).iter_mut().zip(inputs) {
        *out = sum(lanes, a, b, c);
    }
}

/// The length of a gradient: the difference along `x`, that between two rows.
#[inline(always)]
pub(super) fn length<L: Lanes>(
    lanes: L,
    x: (&Rows<'_>, usize),
    [above, below]: [&[f32]; 2],
    out: &mut [f32],
) {
    let (right, left) = (L::view(x.0.shifted(x.1, 1)), L::view(x.0.shifted(x.1, -1)));
    let (above, below) = (L::view(above), L::view(below));
    let inputs = right.iter().zip(left).zip(below.iter().zip(above));
    for (out, ((&right, &left), (&below, &above))) in L::view_mut(out).iter_mut().zip(inputs) {
        let (gx, gy) = (lanes.sub(right, left), lanes.sub(below, above));
        *out = lanes.sqrt(lanes.add(lanes.mul(gx, gx), lanes.mul(gy, gy)));
    }
}

/// Where the forces of a tile go.
pub(super) struct Put<'a> {
    pub(super) out: &'a mut [[f32; 2]],
    pub(super) stride: usize,
    pub(super) width: usize,
    /// Whether they are too many to be found in the cache later.
    pub(super) many: bool,
}

impl Put<'_> {
    /// Differences along x and between two rows become a row of forces; they begin with column 2 of those.
    #[inline(always)]
    pub(super) fn row<L: Lanes>(
        &mut self,
        lanes: L,
        row: usize,
        x: (&Rows<'_>, usize),
        y: (&Rows<'_>, [usize; 2]),
    ) {
        let n = self.width;
        let out = &mut self.out[row * self.stride..][..n];
        let (right, left) = (&x.0.shifted(x.1, 3)[..n], &x.0.shifted(x.1, 1)[..n]);
        let [above, below] = y.1.map(|row| &y.0.shifted(row, 2)[..n]);
        let mut done = 0;
        if self.many {
            // up to a line of the cache, then whole lines
            done = out.as_ptr().align_offset(64).min(n);
            differences([right, left, below, above], 0..done, out);
            let lines = out[done..].as_chunks_mut().0.iter_mut();
            let (rights, lefts) = (right[done..].as_chunks().0, left[done..].as_chunks().0);
            let (belows, aboves) = (below[done..].as_chunks().0, above[done..].as_chunks().0);
            let inputs = rights.iter().zip(lefts).zip(belows.iter().zip(aboves));
            for (out, ((right, left), (below, above))) in lines.zip(inputs) {
                if !lanes.stream([right, left, below, above], out) {
                    break;
                }
                done += 16;
            }
        }
        differences([right, left, below, above], done..n, out);
    }
}

#[inline(always)]
fn differences(
    [right, left, below, above]: [&[f32]; 4],
    range: std::ops::Range<usize>,
    out: &mut [[f32; 2]],
) {
    let (right, left) = (&right[range.clone()], &left[range.clone()]);
    let (below, above) = (&below[range.clone()], &above[range.clone()]);
    let out = &mut out[range];
    for (i, out) in out.iter_mut().enumerate() {
        *out = [right[i] - left[i], below[i] - above[i]];
    }
}

/// Smoothed rows that become the gradient of the length of their gradient.
pub(super) struct Gradients<'a> {
    /// Two rows of before, and a group of new ones.
    smooth: Rows<'a>,
    /// Averages across, of those and of lengths.
    across: Rows<'a>,
    /// Averages along, lengths, and averages along of lengths: the last three of each.
    along: Rows<'a>,
    lengths: Rows<'a>,
    lengths_along: Rows<'a>,
}

impl<'a> Gradients<'a> {
    /// Numbers it takes for rows of `n` that come `group` at a time.
    pub(super) const fn size(group: usize, n: usize) -> usize {
        Rows::size(group + 13, n)
    }

    pub(super) fn new(numbers: &'a mut [f32], group: usize, n: usize) -> Self {
        let (smooth, numbers) = numbers.split_at_mut(Rows::size(group + 2, n));
        let (across, numbers) = numbers.split_at_mut(Rows::size(2, n));
        let (along, numbers) = numbers.split_at_mut(Rows::size(3, n));
        let (lengths, lengths_along) = numbers.split_at_mut(Rows::size(3, n));
        Self {
            smooth: Rows::new(smooth, n),
            across: Rows::new(across, n),
            along: Rows::new(along, n),
            lengths: Rows::new(lengths, n),
            lengths_along: Rows::new(lengths_along, n),
        }
    }

    /// Where the next group of smoothed rows goes, and how far one is from the next.
    #[inline(always)]
    pub(super) fn rows(&mut self) -> (&mut [f32], usize, usize) {
        let (out, begin, step) = self.smooth.columns();
        (out, begin + 2 * step, step)
    }

    /// Row `i` of the group, row `row` of the tile's, in order: the fourth after it comes out.
    #[inline(always)]
    pub(super) fn put<L: Lanes>(&mut self, lanes: L, i: usize, row: usize, put: &mut Put<'_>) {
        along::<L, false>(lanes, &self.smooth, i + 2, self.along.get_mut(row % 3));
        if row < 2 {
            return;
        }
        let three = [i, i + 1, i + 2].map(|i| self.smooth.get(i));
        across(lanes, three, self.across.get_mut(0));
        let two = [row - 2, row].map(|row| self.along.get(row % 3));
        length(lanes, (&self.across, 0), two, self.lengths.get_mut(row % 3));
        along::<L, false>(
            lanes,
            &self.lengths,
            row % 3,
            self.lengths_along.get_mut(row % 3),
        );
        if row < 4 {
            return;
        }
        let three = [row - 2, row - 1, row].map(|row| self.lengths.get(row % 3));
        across(lanes, three, self.across.get_mut(1));
        let two = [(row - 2) % 3, row % 3];
        put.row(
            lanes,
            row - 4,
            (&self.across, 1),
            (&self.lengths_along, two),
        );
    }

    /// The last two rows of a whole group are kept for the next.
    #[inline(always)]
    pub(super) fn next(&mut self, group: usize) {
        self.smooth.copy(group, 0);
        self.smooth.copy(group + 1, 1);
    }
}
