//! One chain of an elimination, and the block where chains meet.
//!
//! A chain runs along consecutive rows, in either direction, and knows only the next two nodes and
//! the two of the border.

use crate::BandedError;
use crate::scalar::{Entry, Node};

/// One chain, in the order of elimination.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chain<E> {
    pub(crate) links: Vec<Link<E>>,
    /// Couplings to the border of the first nodes of the chain, over the pivot.
    pub(crate) spikes: Vec<[E; 2]>,
}

/// What an eliminated node needs: its column of L, and one over its pivot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Link<E> {
    pub(crate) next: E,
    pub(crate) after: E,
    pub(crate) reciprocal: E,
}

/// What a chain leaves behind on the two nodes after it and on the border.
pub(crate) struct Rest<E> {
    pub(crate) diagonal: [E; 2],
    pub(crate) between: E,
    /// Couplings of the two nodes to the border.
    pub(crate) border: [[E; 2]; 2],
    /// The border's own block: first, between, second.
    pub(crate) corner: [E; 3],
}

/// Rows of a chain, counted from its start.
pub(crate) struct Rows<E, F> {
    pub(crate) len: usize,
    /// Couplings of its first two nodes to the border.
    pub(crate) border: [[E; 2]; 2],
    /// Row in the matrix, diagonal element, coupling to the next node and to the one after.
    pub(crate) row: F,
}

impl<E: Entry, F: Fn(usize) -> (usize, E, E, E)> Rows<E, F> {
    /// Eliminates the rows in order. Couplings to the border count as zero from `faded` down.
    pub(crate) fn eliminate(self, faded: f64) -> Result<(Chain<E>, Rest<E>), BandedError> {
        let zero = [E::ZERO; 2];
        let mut links = Vec::with_capacity(self.len);
        let mut spikes = Vec::new();
        let mut diagonal = zero;
        let mut between = E::ZERO;
        let mut border = self.border;
        let mut corner = [E::ZERO; 3];
        for k in 0..self.len {
            let (row, d, first, second) = (self.row)(k);
            let reciprocal = (d + diagonal[0]).reciprocal(row)?;
            let beside = first + between;
            let (next, after) = (beside * reciprocal, second * reciprocal);
            links.push(Link {
                next,
                after,
                reciprocal,
            });
            diagonal = [diagonal[1] - next * beside, -(after * second)];
            between = -(next * second);

            let here = border[0];
            let passed = |by: E| [by * here[0], by * here[1]];
            let (near, far) = (passed(next), passed(after));
            border = [
                [border[1][0] - near[0], border[1][1] - near[1]],
                [-far[0], -far[1]],
            ];
            if here[0].size().max(here[1].size()) > faded {
                let spike = [here[0] * reciprocal, here[1] * reciprocal];
                spikes.resize(k, zero);
                spikes.push(spike);
                corner = [
                    corner[0] - spike[0] * here[0],
                    corner[1] - spike[0] * here[1],
                    corner[2] - spike[1] * here[1],
                ];
            } else if border.iter().flatten().all(|g| g.size() <= faded) {
                border = [zero; 2];
            }
        }
        Ok((
            Chain { links, spikes },
            Rest {
                diagonal,
                between,
                border,
                corner,
            },
        ))
    }
}

/// A chain on its way to the middle: what earlier nodes take from the next two.
#[derive(Default)]
pub(crate) struct Forward<V> {
    /// From the next node, by the last one.
    pub(crate) here: V,
    /// From the next node, by the one before the last.
    pub(crate) early: V,
    /// From the node after the next, by the last one.
    pub(crate) later: V,
}

impl<V: Copy> Forward<V> {
    #[inline(always)]
    pub(crate) fn step<E: Copy>(&mut self, b: &mut V, link: &Link<E>) -> V
    where
        V: Node<E>,
    {
        let y = (*b - self.early) - self.here;
        *self = Self {
            here: y * link.next,
            early: self.later,
            later: y * link.after,
        };
        *b = y;
        y
    }
}

/// A chain on its way back: the two nodes solved last.
pub(crate) struct Backward<V> {
    pub(crate) next: V,
    pub(crate) after: V,
}

impl<V: Copy> Backward<V> {
    #[inline(always)]
    pub(crate) fn step<E: Copy>(&mut self, node: &mut V, known: V, link: &Link<E>)
    where
        V: Node<E>,
    {
        let x = (known - self.after * link.after) - self.next * link.next;
        *self = Self {
            next: x,
            after: self.next,
        };
        *node = x;
    }
}

/// LDLᵀ of the block where the chains meet: the middle two, then the border two (an identity when
/// open).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Heart<E> {
    lower: [[E; 4]; 4],
    reciprocal: [E; 4],
}

impl<E: Entry> Heart<E> {
    /// From the lower triangle; `names` are the rows in the whole matrix.
    pub(crate) fn new(mut a: [[E; 4]; 4], names: [usize; 4]) -> Result<Self, BandedError> {
        let mut reciprocal = [E::ONE; 4];
        for k in 0..4 {
            reciprocal[k] = a[k][k].reciprocal(names[k])?;
            let column = [a[0][k], a[1][k], a[2][k], a[3][k]];
            for i in k + 1..4 {
                let factor = column[i] * reciprocal[k];
                for j in k + 1..=i {
                    a[i][j] = a[i][j] - factor * column[j];
                }
                a[i][k] = factor;
            }
        }
        Ok(Self {
            lower: a,
            reciprocal,
        })
    }
}

impl<E: Copy> Heart<E> {
    #[inline(always)]
    pub(crate) fn solve<V: Node<E>>(&self, b: &mut [V; 4]) {
        for k in 0..4 {
            for i in k + 1..4 {
                b[i] = b[i] - b[k] * self.lower[i][k];
            }
        }
        for k in (0..4).rev() {
            b[k] = b[k] * self.reciprocal[k];
            for i in k + 1..4 {
                b[k] = b[k] - b[i] * self.lower[i][k];
            }
        }
    }
}
