//! The same sum at every node, in registers as wide as the machine has.
//!
//! What is done with a number here is done with x and y of every node alike; the digits are those of a
//! plain loop. The sums are to be `move` closures: what they borrow would be read again at every number.

use glam::DVec2;
use lanes::{Finite, Wide, flat, flat_mut};

/// `p, q = f(from)` for slices of one length; true if all of `p` is finite.
pub(crate) fn both<const N: usize, F: Fn([f64; N]) -> (f64, f64)>(
    from: [&[DVec2]; N],
    [p, q]: [&mut [DVec2]; 2],
    sum: F,
) -> bool {
    lanes::run(Both {
        from: from.map(flat),
        to: [flat_mut(p), flat_mut(q)],
        sum,
    })
}

struct Both<'a, const N: usize, F> {
    from: [&'a [f64]; N],
    to: [&'a mut [f64]; 2],
    sum: F,
}

impl<const N: usize, F: Fn([f64; N]) -> (f64, f64)> Wide for Both<'_, N, F> {
    type Output = bool;

    #[inline(always)]
    fn work(self) -> bool {
        let (sum, from, [p, q]) = (self.sum, self.from, self.to);
        let m = p.len();
        let (from, q) = (from.map(|a| &a[..m]), &mut q[..m]);
        let mut finite = Finite::default();
        for k in 0..m {
            (p[k], q[k]) = sum(std::array::from_fn(|j| from[j][k]));
            finite.see(p[k]);
        }
        finite.all()
    }
}

/// `p = f(from, p)` for slices of one length.
pub(crate) fn onto<const N: usize, F: Fn([f64; N], f64) -> f64>(
    from: [&[DVec2]; N],
    p: &mut [DVec2],
    sum: F,
) {
    lanes::run(Onto {
        from: from.map(flat),
        to: flat_mut(p),
        sum,
    });
}

struct Onto<'a, const N: usize, F> {
    from: [&'a [f64]; N],
    to: &'a mut [f64],
    sum: F,
}

impl<const N: usize, F: Fn([f64; N], f64) -> f64> Wide for Onto<'_, N, F> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let (sum, p) = (self.sum, self.to);
        let m = p.len();
        let from = self.from.map(|a| &a[..m]);
        for k in 0..m {
            p[k] = sum(std::array::from_fn(|j| from[j][k]), p[k]);
        }
    }
}

/// `p[i] = f(w[i], from[i], p[i])`; quicker where all `w` are the same, as `common` says.
pub(crate) fn weighted_onto<const M: usize, const N: usize>(
    (w, common): ([&[f64]; M], Option<[f64; M]>),
    from: [&[DVec2]; N],
    p: &mut [DVec2],
    sum: impl Fn([f64; M], [f64; N], f64) -> f64,
) {
    if let Some(w) = common {
        onto(from, p, move |a, p| sum(w, a, p));
        return;
    }
    for (i, p) in p.iter_mut().enumerate() {
        let w = w.map(|w| w[i]);
        *p = DVec2::new(
            sum(w, from.map(|a| a[i].x), p.x),
            sum(w, from.map(|a| a[i].y), p.y),
        );
    }
}

/// The value all have, if they have one.
pub(crate) fn common(values: &[f64]) -> Option<f64> {
    let first = *values.first()?;
    let same = |value: &f64| value.to_bits() == first.to_bits();
    values.iter().all(same).then_some(first)
}
