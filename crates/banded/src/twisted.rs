//! LDLᵀ of a pentadiagonal matrix, from both ends to the middle at once.
//!
//! Each unknown waits for the one before it, so an elimination from one end to the other spends most
//! of its time waiting. Starting from both ends gives two independent chains that meet in the
//! middle:
//!
//! ```text
//! 0 → 1 → 2 → … → [m, m+1] ← … ← n−2 ← n−1          open
//! ```
//!
//! A cyclic matrix is cut open at its last two nodes, the border. Both chains begin beside it, so
//! every eliminated node keeps a coupling to it, the spikes; middle and border together leave a
//! symmetric 4×4 block, the heart. This is Gaussian elimination in another order: as stable as any
//! Cholesky factorisation, and no fill but the spikes.
//!
//! Spikes fade along the chain at a rate set by the matrix. They are kept as far as they matter:
//! what is dropped is below [`FADED`] times the largest diagonal element.

use pulp::{Simd, WithSimd};

use crate::BandedError;
use crate::chain::{Backward, Chain, Forward, Heart, Rows};
use crate::scalar::{Entry, Node};

/// Couplings below this part of the largest diagonal element are zero: 1e-5 of its last place.
const FADED: f64 = 1e-21;

/// The factor of a pentadiagonal matrix with entries `E`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Twisted<E> {
    cyclic: bool,
    left: Chain<E>,
    right: Chain<E>,
    heart: Heart<E>,
}

/// The three diagonals of a matrix; the off-diagonals may be cut off where they are not read.
pub(crate) struct Diagonals<'a, E> {
    pub(crate) cyclic: bool,
    pub(crate) diagonal: &'a [E],
    pub(crate) first: &'a [E],
    pub(crate) second: &'a [E],
}

impl<E: Entry + Node<E>> Diagonals<'_, E> {
    /// Row `i` times `x`, and the sum of the row's magnitudes.
    pub(crate) fn row(&self, i: usize, x: &[E]) -> (E, f64) {
        let n = self.diagonal.len();
        let (back, back2) = ((i + n - 1) % n, (i + n - 2) % n);
        let entries = [
            (self.diagonal[i], i),
            (self.first[back], back),
            (self.first[i], (i + 1) % n),
            (self.second[back2], back2),
            (self.second[i], (i + 2) % n),
        ];
        let add = |(sum, size): (E, f64), (a, j): (E, usize)| (sum + a * x[j], size + a.size());
        entries.into_iter().fold((E::ZERO, 0.0), add)
    }

    /// Refuses a number that is not finite.
    pub(crate) fn check_finite(&self) -> Result<(), BandedError> {
        let entries = self.diagonal.iter().zip(self.first).zip(self.second);
        match entries
            .into_iter()
            .position(|((d, f), s)| !(d.size() + f.size() + s.size()).is_finite())
        {
            Some(row) => Err(BandedError::NotFinite { row }),
            None => Ok(()),
        }
    }
}

impl<E: Entry> Twisted<E> {
    pub(crate) fn new(a: &Diagonals<'_, E>) -> Result<Self, BandedError> {
        let n = a.diagonal.len();
        let (d, f, s) = (a.diagonal, a.first, a.second);
        let inner = if a.cyclic { n - 2 } else { n };
        let faded = FADED * d.iter().fold(0.0_f64, |most, d| most.max(d.size()));
        let (half, rest) = ((inner - 1) / 2, inner - 2 - (inner - 1) / 2);
        let zero = [E::ZERO; 2];
        let (mut at_left, mut at_right) = ([zero; 2], [zero; 2]);
        if a.cyclic {
            at_left = [[s[n - 2], f[n - 1]], [E::ZERO, s[n - 1]]];
            at_right = [[f[n - 3], s[n - 3]], [s[n - 4], E::ZERO]];
        }
        let (mut left, after_left) = Rows {
            len: half,
            border: at_left,
            row: |k: usize| (k, d[k], f[k], s[k]),
        }
        .eliminate(faded)?;
        let from_right = |k: usize| {
            let i = inner - 1 - k;
            (i, d[i], f[i - 1], s[i - 2])
        };
        let (mut right, after_right) = Rows {
            len: rest,
            border: at_right,
            row: from_right,
        }
        .eliminate(faded)?;

        let spiked = (left.spikes.len().saturating_sub(half - rest)).max(right.spikes.len());
        left.spikes.resize(
            if spiked > 0 {
                spiked + half - rest
            } else {
                left.spikes.len()
            },
            zero,
        );
        right.spikes.resize(spiked, zero);

        let (l, r) = (&after_left, &after_right);
        let mut heart = [[E::ZERO; 4]; 4];
        heart[0][0] = d[half] + l.diagonal[0] + r.diagonal[1];
        heart[1][0] = f[half] + l.between + r.between;
        heart[1][1] = d[half + 1] + l.diagonal[1] + r.diagonal[0];
        let mut names = [half, half + 1, n - 2, n - 1];
        if a.cyclic {
            for k in 0..2 {
                heart[2 + k][0] = l.border[0][k] + r.border[1][k];
                heart[2 + k][1] = l.border[1][k] + r.border[0][k];
            }
            heart[2][2] = d[n - 2] + l.corner[0] + r.corner[0];
            heart[3][2] = f[n - 2] + l.corner[1] + r.corner[1];
            heart[3][3] = d[n - 1] + l.corner[2] + r.corner[2];
        } else {
            (heart[2][2], heart[3][3]) = (E::ONE, E::ONE);
            names = [half, half + 1, half, half];
        }
        Ok(Self {
            cyclic: a.cyclic,
            left,
            right,
            heart: Heart::new(heart, names)?,
        })
    }
}

impl<E: Copy> Twisted<E> {
    pub(crate) fn len(&self) -> usize {
        self.left.links.len() + 2 + self.right.links.len() + if self.cyclic { 2 } else { 0 }
    }

    /// Turns the right-hand side into the solution. O(n), allocates nothing.
    ///
    /// With the widest registers there are. Every operation rounds by itself, so width changes the
    /// time and never a digit.
    pub(crate) fn solve<V: Node<E>>(&self, b: &mut [V]) {
        lanes::registers().dispatch(Sweep { factor: self, b });
    }

    #[inline(always)]
    fn sweep<V: Node<E>>(&self, b: &mut [V]) {
        debug_assert_eq!(b.len(), self.len(), "one element a row");
        let (inner, border) = b.split_at_mut(self.left.links.len() + 2 + self.right.links.len());
        let (left, inner) = inner.split_at_mut(self.left.links.len());
        let (middle, right) = inner.split_at_mut(2);
        let mut heart = [middle[0], middle[1], V::default(), V::default()];
        if let [second_last, last] = border {
            (heart[2], heart[3]) = (*second_last, *last);
        }
        self.forward(left, right, &mut heart);
        self.heart.solve(&mut heart);
        self.backward(left, right, &heart);
        middle.copy_from_slice(&heart[..2]);
        if self.cyclic {
            border.copy_from_slice(&heart[2..]);
        }
    }

    /// Both chains towards the middle; the left one may be a node longer, and starts alone.
    #[inline(always)]
    fn forward<V: Node<E>>(&self, left: &mut [V], right: &mut [V], heart: &mut [V; 4]) {
        let mut from_left = Forward::default();
        let mut from_right = Forward::default();
        let (mut border_left, mut border_right) = ([V::default(); 2], [V::default(); 2]);
        let ahead = left.len() - right.len();
        for k in 0..ahead {
            let y = from_left.step(&mut left[k], &self.left.links[k]);
            if let Some(spike) = self.left.spikes.get(k) {
                border_left = [border_left[0] + y * spike[0], border_left[1] + y * spike[1]];
            }
        }
        let spiked_left = self.left.spikes.get(ahead..).unwrap_or_default();
        let spiked_right = &self.right.spikes[..];
        let spiked = spiked_left.len();
        debug_assert!(
            spiked_right.len() == spiked,
            "chains are padded to the same length"
        );
        let (left_spiked, left) = left[ahead..].split_at_mut(spiked);
        let (right, right_spiked) = right.split_at_mut(right.len() - spiked);
        let (links_spiked, links) = self.left.links[ahead..].split_at(spiked);
        let (mirror_spiked, mirror) = self.right.links.split_at(spiked);

        let nodes = left_spiked.iter_mut().zip(right_spiked.iter_mut().rev());
        let links_both = links_spiked.iter().zip(mirror_spiked);
        let spikes = spiked_left.iter().zip(spiked_right);
        for (((a, z), (to, from)), (f, g)) in nodes.zip(links_both).zip(spikes) {
            let y = from_left.step(a, to);
            border_left = [border_left[0] + y * f[0], border_left[1] + y * f[1]];
            let y = from_right.step(z, from);
            border_right = [border_right[0] + y * g[0], border_right[1] + y * g[1]];
        }
        let nodes = left.iter_mut().zip(right.iter_mut().rev());
        for ((a, z), (to, from)) in nodes.zip(links.iter().zip(mirror)) {
            from_left.step(a, to);
            from_right.step(z, from);
        }
        heart[0] = heart[0] - from_left.early - from_left.here - from_right.later;
        heart[1] = heart[1] - from_right.early - from_right.here - from_left.later;
        heart[2] = heart[2] - border_left[0] - border_right[0];
        heart[3] = heart[3] - border_left[1] - border_right[1];
    }

    #[inline(always)]
    fn backward<V: Node<E>>(&self, left: &mut [V], right: &mut [V], heart: &[V; 4]) {
        let [m0, m1, b0, b1] = *heart;
        let mut to_left = Backward {
            next: m0,
            after: m1,
        };
        let mut to_right = Backward {
            next: m1,
            after: m0,
        };
        let ahead = left.len() - right.len();
        let (start, left) = left.split_at_mut(ahead);
        let (links_start, links) = self.left.links.split_at(ahead);
        let spiked_left = self.left.spikes.get(ahead..).unwrap_or_default();
        let spiked_right = &self.right.spikes[..];
        let spiked = spiked_left.len();
        let (left_spiked, left) = left.split_at_mut(spiked);
        let (right, right_spiked) = right.split_at_mut(right.len() - spiked);
        let (links_spiked, links) = links.split_at(spiked);
        let (mirror_spiked, mirror) = self.right.links.split_at(spiked);

        let nodes = left.iter_mut().rev().zip(right.iter_mut());
        for ((a, z), (to, from)) in nodes.zip(links.iter().rev().zip(mirror.iter().rev())) {
            let x = *a * to.reciprocal;
            to_left.step(a, x, to);
            let x = *z * from.reciprocal;
            to_right.step(z, x, from);
        }
        let nodes = left_spiked.iter_mut().rev().zip(right_spiked.iter_mut());
        let links_both = links_spiked.iter().rev().zip(mirror_spiked.iter().rev());
        let spikes = spiked_left.iter().rev().zip(spiked_right.iter().rev());
        for (((a, z), (to, from)), (f, g)) in nodes.zip(links_both).zip(spikes) {
            let x = *a * to.reciprocal - (b0 * f[0] + b1 * f[1]);
            to_left.step(a, x, to);
            let x = *z * from.reciprocal - (b0 * g[0] + b1 * g[1]);
            to_right.step(z, x, from);
        }
        for (k, (a, to)) in start.iter_mut().zip(links_start).enumerate().rev() {
            let mut x = *a * to.reciprocal;
            if let Some(f) = self.left.spikes.get(k) {
                x = x - (b0 * f[0] + b1 * f[1]);
            }
            to_left.step(a, x, to);
        }
    }
}

/// A solve, to be compiled once for each kind of machine.
struct Sweep<'a, E, V> {
    factor: &'a Twisted<E>,
    b: &'a mut [V],
}

impl<E: Copy, V: Node<E>> WithSimd for Sweep<'_, E, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.factor.sweep(self.b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn wide_registers_change_no_digit() {
        for (n, cyclic) in [(5, true), (40, true), (41, true), (40, false), (41, false)] {
            let wave = |scale: f64| -> Vec<f64> {
                (0..n)
                    .map(|i| scale * (1.0 + 0.3 * (1.7 * f64::from(i)).sin()))
                    .collect()
            };
            let mut first = wave(-4.0);
            let mut second = wave(1.0);
            if !cyclic {
                let last = first.len() - 1;
                first[last] = 0.0;
                second[last - 1..].fill(0.0);
            }
            let diagonal = &wave(12.0);
            let diagonals = Diagonals {
                cyclic,
                diagonal,
                first: &first,
                second: &second,
            };
            let factor = Twisted::new(&diagonals).unwrap();
            let mut wide: Vec<DVec2> = wave(1.0).into_iter().map(DVec2::from_angle).collect();
            let mut plain = wide.clone();
            factor.solve(&mut wide);
            factor.sweep(&mut plain);
            let bits = |x: &[DVec2]| {
                x.iter()
                    .map(|x| x.to_array().map(f64::to_bits))
                    .collect::<Vec<_>>()
            };
            assert_eq!(bits(&wide), bits(&plain), "{n} {cyclic}");
        }
    }
}
