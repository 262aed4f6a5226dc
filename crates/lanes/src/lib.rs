//! Loops over the coordinates of points, in registers as wide as the machine has.
//!
//! The compiler's portable build keeps two doubles in a register; most machines have room for four or
//! eight. A loop opts in by two steps: it sees its points as plain numbers ([`flat`]), so that nothing but a
//! stride of one is left to find out, and it is declared inside [`wide!`], which compiles it for
//! each width and picks one at run time.
//!
//! ```
//! use glam::DVec2;
//! use lanes::{flat, flat_mut, wide};
//!
//! wide! {
//!     /// `next = x + dt v`.
//!     fn drift(x: &[f64], v: &[f64], dt: f64, next: &mut [f64]) {
//!         for ((next, x), v) in next.iter_mut().zip(x).zip(v) {
//!             *next = x + dt * v;
//!         }
//!     }
//! }
//!
//! let (x, v) = (vec![DVec2::ONE; 100], vec![DVec2::X; 100]);
//! let mut next = vec![DVec2::ZERO; 100];
//! drift(flat(&x), flat(&v), 0.5, flat_mut(&mut next));
//! assert_eq!(next[99], DVec2::new(1.5, 1.0));
//! ```
//!
//! Every number is made by the operations the source names, in their order, each rounded once: no product is
//! fused with a sum, so that the digits are the same in registers of any width. Sums over a slice
//! are in an order of their own, fixed here: [`total`].

mod registers;

pub use registers::{register_bits, registers};

use glam::DVec2;

/// The coordinates of points, x and y in turn: a view, nothing is copied.
#[inline]
#[must_use]
pub fn flat(points: &[DVec2]) -> &[f64] {
    bytemuck::cast_slice(points)
}

/// The same to write to.
#[inline]
#[must_use]
pub fn flat_mut(points: &mut [DVec2]) -> &mut [f64] {
    bytemuck::cast_slice_mut(points)
}

/// A loop with what it works on, to be [`run`] in wide registers. Mostly written by [`wide!`].
pub trait Wide {
    /// What it finds.
    type Output;

    /// The loop, marked `#[inline(always)]`: only what is compiled into its caller gets that one's registers.
    fn work(self) -> Self::Output;
}

struct Job<T>(T);

impl<T: Wide> pulp::WithSimd for Job<T> {
    type Output = T::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> T::Output {
        self.0.work()
    }
}

/// Run a loop in the widest registers of this machine. Choosing them costs a few nanoseconds.
#[inline]
pub fn run<T: Wide>(job: T) -> T::Output {
    registers().dispatch(Job(job))
}

/// Declares a function that runs in the widest registers of this machine.
///
/// What its body calls is to be marked `#[inline(always)]`; other functions stay as narrow as they were.
#[macro_export]
macro_rules! wide {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) $body:block) => {
        $crate::wide! { $(#[$meta])* $vis fn $name($($arg: $type),*) -> () $body }
    };
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) -> $out:ty $body:block) => {
        $(#[$meta])*
        $vis fn $name($($arg: $type),*) -> $out {
            struct Job<T>(T);
            impl $crate::Wide for Job<($($type,)*)> {
                type Output = $out;
                #[inline(always)]
                fn work(self) -> $out {
                    let ($($arg,)*) = self.0;
                    $body
                }
            }
            $crate::run(Job(($($arg,)*)))
        }
    };
}

wide! {
    /// The sum of all points, in eight parts that do not wait for each other; the same order on every machine.
    #[must_use]
    pub fn total(points: &[DVec2]) -> DVec2 {
        let (sixteens, rest) = flat(points).as_chunks::<16>();
        let mut sums = [0.0; 16];
        for sixteen in sixteens {
            for (sum, number) in sums.iter_mut().zip(sixteen) {
                *sum += *number;
            }
        }
        let at = |k: usize| DVec2::new(sums[2 * k], sums[2 * k + 1]);
        let whole = ((at(0) + at(1)) + (at(2) + at(3))) + ((at(4) + at(5)) + (at(6) + at(7)));
        rest.as_chunks::<2>()
            .0
            .iter()
            .fold(whole, |sum, &[x, y]| sum + DVec2::new(x, y))
    }
}

wide! {
    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn finite(points: &[DVec2]) -> bool {
        all_finite(flat(points))
    }
}

/// Whether all numbers shown to it were finite, found on the way: three operations on whole numbers each.
///
/// To be used inside [`wide!`] or [`Wide`]. There is no early way out, so that the loop fills registers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Finite(u64);

impl Finite {
    /// See one more number.
    #[inline(always)]
    pub const fn see(&mut self, number: f64) {
        // infinities and what is no number have an exponent of ones: one more runs over into the sign
        const EXPONENT: u64 = 0x7ff0 << 48;
        const ONE: u64 = 0x0010 << 48;
        self.0 |= (number.to_bits() & EXPONENT).wrapping_add(ONE);
    }

    /// The verdict.
    #[inline(always)]
    #[must_use]
    pub const fn all(self) -> bool {
        self.0 >> 63 == 0
    }
}

/// Whether all numbers are finite; to be used inside [`wide!`] or [`Wide`].
#[inline(always)]
#[must_use]
pub fn all_finite(numbers: &[f64]) -> bool {
    let mut finite = Finite::default();
    for &number in numbers {
        finite.see(number);
    }
    finite.all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(n: usize) -> Vec<DVec2> {
        (0..n)
            .map(|i| DVec2::from_angle(0.7 * i as f64) * (1.0 + i as f64))
            .collect()
    }

    #[test]
    fn a_sum_is_that_of_the_scalar_loop_in_the_same_order() {
        for n in 0..40 {
            let points = points(n);
            let (eights, rest) = points.as_chunks::<8>();
            let mut sums = [DVec2::ZERO; 8];
            for eight in eights {
                for (sum, point) in sums.iter_mut().zip(eight) {
                    *sum += *point;
                }
            }
            let [a, b, c, d, e, f, g, h] = sums;
            let whole = ((a + b) + (c + d)) + ((e + f) + (g + h));
            let slow = rest.iter().fold(whole, |sum, point| sum + *point);
            assert_eq!(total(&points), slow, "{n} points");
        }
    }

    #[test]
    fn one_number_that_is_not_finite_is_seen_wherever_it_stands() {
        for n in 1..50 {
            assert!(finite(&points(n)));
            for i in 0..n {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut points = points(n);
                    points[i].y = bad;
                    assert!(!finite(&points), "{bad} at {i} of {n}");
                }
            }
        }
        assert!(finite(&[DVec2::splat(f64::MAX); 9]));
        assert!(finite(&[DVec2::new(-f64::MAX, f64::MIN_POSITIVE); 9]));
        assert!(finite(&[DVec2::new(-0.0, 5e-324); 9]));
    }

    #[test]
    fn wide_registers_leave_the_digits_as_they_are() {
        wide! {
            fn work(x: &[f64], y: &mut [f64]) {
                for (y, x) in y.iter_mut().zip(x) {
                    *y = (x * x + 0.1 * x) / 3.0 - x;
                }
            }
        }
        let points = points(1001);
        let mut found = points.clone();
        work(flat(&points), flat_mut(&mut found));
        for (k, (wide, p)) in flat(&found).iter().zip(flat(&points)).enumerate() {
            let narrow = std::hint::black_box(std::hint::black_box(p * p) + 0.1 * p) / 3.0 - p;
            assert_eq!(wide.to_bits(), narrow.to_bits(), "number {k}");
        }
    }
}
