//! Four points at a time.
//!
//! Plain loops over points keep the two coordinates of one point in a register, no more. Written over eight
//! numbers the same sums fill registers of any width, to the same digits.

use glam::DVec2;

/// The coordinates of four points.
pub(crate) type Eight = [f64; 8];

#[inline(always)]
pub(crate) fn numbers(p: &[DVec2; 4]) -> Eight {
    [
        p[0].x, p[0].y, p[1].x, p[1].y, p[2].x, p[2].y, p[3].x, p[3].y,
    ]
}

#[inline(always)]
pub(crate) fn points(a: Eight) -> [DVec2; 4] {
    [
        DVec2::new(a[0], a[1]),
        DVec2::new(a[2], a[3]),
        DVec2::new(a[4], a[5]),
        DVec2::new(a[6], a[7]),
    ]
}

/// Whether all numbers that passed were finite: zero times anything else is not zero.
#[derive(Clone, Copy, Default)]
pub(crate) struct Finite(Eight);

impl Finite {
    #[inline(always)]
    pub(crate) fn see(&mut self, a: &Eight) {
        for k in 0..8 {
            self.0[k] += a[k] * 0.0;
        }
    }

    pub(crate) fn all(self) -> bool {
        self.0.iter().all(|a| a.is_finite())
    }
}

/// The last few points, with zeros beside them.
fn padded(rest: &[DVec2]) -> Eight {
    let mut four = [DVec2::ZERO; 4];
    four[..rest.len()].copy_from_slice(rest);
    numbers(&four)
}

/// `p, q = f(a, b, c)` for slices of one length; true if all of `p` is finite.
#[inline(always)]
pub(crate) fn three_to_two(
    [a, b, c]: [&[DVec2]; 3],
    [p, q]: [&mut [DVec2]; 2],
    work: impl Fn(Eight, Eight, Eight) -> (Eight, Eight),
) -> bool {
    let (a, a_rest) = a.as_chunks::<4>();
    let (b, b_rest) = b.as_chunks::<4>();
    let (c, c_rest) = c.as_chunks::<4>();
    let (p, p_rest) = p.as_chunks_mut::<4>();
    let (q, q_rest) = q.as_chunks_mut::<4>();
    let mut finite = Finite::default();
    for ((((a, b), c), p), q) in a.iter().zip(b).zip(c).zip(p).zip(q) {
        let (place, speed) = work(numbers(a), numbers(b), numbers(c));
        finite.see(&place);
        (*p, *q) = (points(place), points(speed));
    }
    let (place, speed) = work(padded(a_rest), padded(b_rest), padded(c_rest));
    finite.see(&place);
    p_rest.copy_from_slice(&points(place)[..p_rest.len()]);
    q_rest.copy_from_slice(&points(speed)[..q_rest.len()]);
    finite.all()
}

/// `p, q = f(a, b)` for slices of one length; true if all of `p` is finite.
#[inline(always)]
pub(crate) fn two_to_two(
    [a, b]: [&[DVec2]; 2],
    [p, q]: [&mut [DVec2]; 2],
    work: impl Fn(Eight, Eight) -> (Eight, Eight),
) -> bool {
    three_to_two([a, b, b], [p, q], |a, b, _| work(a, b))
}

/// `p = f(a, b, p)` for slices of one length.
#[inline(always)]
pub(crate) fn two_into(
    [a, b]: [&[DVec2]; 2],
    p: &mut [DVec2],
    work: impl Fn(Eight, Eight, Eight) -> Eight,
) {
    let (a, a_rest) = a.as_chunks::<4>();
    let (b, b_rest) = b.as_chunks::<4>();
    let (p, p_rest) = p.as_chunks_mut::<4>();
    for ((a, b), p) in a.iter().zip(b).zip(p) {
        *p = points(work(numbers(a), numbers(b), numbers(p)));
    }
    let last = work(padded(a_rest), padded(b_rest), padded(p_rest));
    p_rest.copy_from_slice(&points(last)[..p_rest.len()]);
}
