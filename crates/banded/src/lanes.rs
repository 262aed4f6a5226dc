//! Many systems of one size, side by side.
//!
//! Solves of one system wait for one another; solves of different systems do not. Kept lane by lane
//! (node 0 of all systems, then node 1 of all systems), one sweep solves them all, and the compiler
//! turns a lane into a slot of a vector register.

use std::ops::{Add, Mul, Sub};

use glam::DVec2;

use crate::twisted::Twisted;
use crate::{BandedError, Factor, Pentadiagonal};

/// One number for each of `W` systems.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// One node of each of `W` systems: the x of all, then the y of all.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LanePoint<const W: usize> {
    /// The x of each.
    pub x: Lanes<W>,
    /// The y of each.
    pub y: Lanes<W>,
}

impl<const W: usize> Default for Lanes<W> {
    fn default() -> Self {
        Self([0.0; W])
    }
}

impl<const W: usize> Lanes<W> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for k in 0..W {
            out.0[k] = f(self.0[k], other.0[k]);
        }
        out
    }
}

impl<const W: usize> Add for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const W: usize> Sub for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const W: usize> Mul for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<const W: usize> Mul<f64> for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.zip(self, |a, _| a * factor)
    }
}

impl<const W: usize> LanePoint<W> {
    /// The node of one system.
    #[must_use]
    pub fn lane(&self, lane: usize) -> DVec2 {
        DVec2::new(self.x.0[lane], self.y.0[lane])
    }

    /// Sets the node of one system.
    pub fn set_lane(&mut self, lane: usize, point: DVec2) {
        (self.x.0[lane], self.y.0[lane]) = (point.x, point.y);
    }
}

impl<const W: usize> Add for LanePoint<W> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
        }
    }
}

impl<const W: usize> Sub for LanePoint<W> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
        }
    }
}

impl<const W: usize> Mul<Lanes<W>> for LanePoint<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factors: Lanes<W>) -> Self {
        Self {
            x: self.x * factors,
            y: self.y * factors,
        }
    }
}

impl<const W: usize> Mul<f64> for LanePoint<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }
}

/// The factors of up to `W` matrices of one size and kind, a matrix a lane.
///
/// Every lane gives the bytes that its own [`Factor`] gives.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneFactor<const W: usize> {
    twisted: Twisted<Lanes<W>>,
}

impl<const W: usize> LaneFactor<W> {
    /// Lays factors side by side; lanes without one repeat the last.
    ///
    /// # Errors
    ///
    /// Refuses none or more than `W` matrices, matrices of different sizes or kinds, and names the
    /// lane of a matrix that [`Factor::new`] refuses.
    pub fn new(matrices: &[Pentadiagonal]) -> Result<Self, BandedError> {
        let got = matrices.len();
        if got == 0 || got > W {
            return Err(BandedError::Length {
                name: "matrices",
                expected: W,
                got,
            });
        }
        let mut factors = Vec::with_capacity(W);
        for (lane, a) in matrices.iter().enumerate() {
            if a.len() != matrices[0].len() || a.is_cyclic() != matrices[0].is_cyclic() {
                let (expected, got) = (matrices[0].len(), a.len());
                return Err(BandedError::Lane {
                    lane,
                    problem: Box::new(BandedError::Length {
                        name: "matrix",
                        expected,
                        got,
                    }),
                });
            }
            let named = |problem| BandedError::Lane {
                lane,
                problem: Box::new(problem),
            };
            factors.push(Factor::new(a).map_err(named)?);
        }
        let lane = |k: usize| factors[k.min(got - 1)].twisted();
        Ok(Self {
            twisted: Twisted::side_by_side(std::array::from_fn(lane)),
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.twisted.len()
    }

    /// Turns the right-hand sides `b`, node by node, into the solutions.
    ///
    /// O(n W), allocates nothing.
    pub fn solve(&self, b: &mut [LanePoint<W>]) {
        self.twisted.solve(b);
    }
}
