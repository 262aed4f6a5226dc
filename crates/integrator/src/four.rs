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

/// `to = f(a, b, …)` for slices of one length, `f` taking and giving eight numbers; true if `check`ed results are
/// finite. The last few points go round with zeros beside them.
#[inline(always)]
pub(crate) fn each<const IN: usize, const OUT: usize>(
    from: [&[DVec2]; IN],
    mut to: [&mut [DVec2]; OUT],
    work: impl Fn([Eight; IN]) -> [Eight; OUT],
) -> bool {
    let n = to[0].len();
    let mut finite = Finite::default();
    let whole = n / 4 * 4;
    let from = from.map(|slice| &slice[..n]);
    let mut at = 0;
    while at < whole {
        let read = from.map(|slice| match slice[at..].first_chunk::<4>() {
            Some(four) => numbers(four),
            None => [0.0; 8],
        });
        let made = work(read);
        finite.see(&made[0]);
        for (slice, made) in to.iter_mut().zip(made) {
            if let Some(four) = slice[at..].first_chunk_mut::<4>() {
                *four = points(made);
            }
        }
        at += 4;
    }
    if whole < n {
        let read = from.map(|slice| {
            let mut four = [DVec2::ZERO; 4];
            four[..n - whole].copy_from_slice(&slice[whole..]);
            numbers(&four)
        });
        let made = work(read);
        finite.see(&made[0]);
        for (slice, made) in to.iter_mut().zip(made) {
            slice[whole..].copy_from_slice(&points(made)[..n - whole]);
        }
    }
    finite.all()
}
