//! The same sum at every node, in registers as wide as the machine has.
//!
//! What is done with a number here is done with x and y of every node alike; the digits are those of a
//! plain loop.

use glam::DVec2;
use lanes::{Wide, all_finite, flat, flat_mut};

/// Numbers between two looks at whether all are finite: they are still in the first cache.
const STRETCH: usize = 256;

/// `p, q = f(a, b, c)` for slices of one length; true if all of `p` is finite.
pub(crate) fn three_to_two<F: Fn(f64, f64, f64) -> (f64, f64)>(
    [a, b, c]: [&[DVec2]; 3],
    [p, q]: [&mut [DVec2]; 2],
    sum: F,
) -> bool {
    lanes::run(ThreeToTwo {
        from: [flat(a), flat(b), flat(c)],
        to: [flat_mut(p), flat_mut(q)],
        sum,
    })
}

struct ThreeToTwo<'a, F> {
    from: [&'a [f64]; 3],
    to: [&'a mut [f64]; 2],
    sum: F,
}

impl<F: Fn(f64, f64, f64) -> (f64, f64)> Wide for ThreeToTwo<'_, F> {
    type Output = bool;

    #[inline(always)]
    fn work(self) -> bool {
        let (sum, [a, b, c], [p, q]) = (self.sum, self.from, self.to);
        let mut finite = true;
        for (k, (p, q)) in p.chunks_mut(STRETCH).zip(q.chunks_mut(STRETCH)).enumerate() {
            let (from, m) = (k * STRETCH, p.len());
            let (a, b, c) = (&a[from..][..m], &b[from..][..m], &c[from..][..m]);
            let q = &mut q[..m];
            for k in 0..m {
                (p[k], q[k]) = sum(a[k], b[k], c[k]);
            }
            finite &= all_finite(p);
        }
        finite
    }
}

/// `p, q = f(a, b)` for slices of one length; true if all of `p` is finite.
pub(crate) fn two_to_two(
    [a, b]: [&[DVec2]; 2],
    to: [&mut [DVec2]; 2],
    sum: impl Fn(f64, f64) -> (f64, f64),
) -> bool {
    three_to_two([a, b, b], to, move |a, b, _| sum(a, b))
}

/// `p = f(a, b)` for slices of one length.
pub(crate) fn two_into<F: Fn(f64, f64) -> f64>([a, b]: [&[DVec2]; 2], p: &mut [DVec2], sum: F) {
    lanes::run(TwoInto {
        from: [flat(a), flat(b)],
        to: flat_mut(p),
        sum: move |a, b, _| sum(a, b),
    });
}

/// `p = f(a, p)` for slices of one length.
pub(crate) fn onto(a: &[DVec2], p: &mut [DVec2], sum: impl Fn(f64, f64) -> f64) {
    lanes::run(TwoInto {
        from: [flat(a); 2],
        to: flat_mut(p),
        sum: move |a, _, p| sum(a, p),
    });
}

/// `p[i] = f(w[i], a[i], p[i])` for slices of one length; quicker where all `w` are the same, as `common` says.
pub(crate) fn weighted_onto(
    (w, common): (&[f64], Option<f64>),
    a: &[DVec2],
    p: &mut [DVec2],
    sum: impl Fn(f64, f64, f64) -> f64,
) {
    if let Some(w) = common {
        onto(a, p, move |a, p| sum(w, a, p));
        return;
    }
    for ((p, a), &w) in p.iter_mut().zip(a).zip(w) {
        *p = DVec2::new(sum(w, a.x, p.x), sum(w, a.y, p.y));
    }
}

/// The value all have, if they have one.
pub(crate) fn common(values: &[f64]) -> Option<f64> {
    let first = *values.first()?;
    let same = |value: &f64| value.to_bits() == first.to_bits();
    values.iter().all(same).then_some(first)
}

struct TwoInto<'a, F> {
    from: [&'a [f64]; 2],
    to: &'a mut [f64],
    sum: F,
}

impl<F: Fn(f64, f64, f64) -> f64> Wide for TwoInto<'_, F> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let (sum, [a, b], p) = (self.sum, self.from, self.to);
        let m = p.len();
        let (a, b) = (&a[..m], &b[..m]);
        for k in 0..m {
            p[k] = sum(a[k], b[k], p[k]);
        }
    }
}
