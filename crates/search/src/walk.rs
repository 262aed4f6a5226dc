//! The recursion along a table of costs: what the best way to each state costs, node by node.

use crate::path::{Costs, Path, Steps};

/// A forward recursion with its memory.
pub(crate) struct Walk<'a> {
    costs: &'a Costs,
    /// Prices of steps by their length, up to the longest.
    pub(crate) price: Vec<f64>,
    /// What the best way to each state of each node costs: a row a node, with so many more at either end as a step may
    /// lead, which nothing reaches.
    reached: Vec<f64>,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(costs: &'a Costs, steps: Steps) -> Self {
        let reach = steps.reach.min(costs.states() - 1);
        let price: Vec<f64> = (0..=reach).map(|k| steps.bend * (k * k) as f64).collect();
        let width = costs.states() + 2 * reach;
        Self {
            costs,
            price,
            reached: vec![f64::INFINITY; costs.nodes() * width],
        }
    }

    fn reach(&self) -> usize {
        self.price.len() - 1
    }

    /// The cheapest path from `first` back to itself.
    pub(crate) fn closed(&mut self, low: &[usize], high: &[usize], first: usize) -> Option<Path> {
        let n = self.costs.nodes();
        let reach = self.reach();
        let near = first.saturating_sub(reach)..=(first + reach).min(self.costs.states() - 1);
        if n == 1 {
            let energy = self.costs.row(0)[first];
            return Some(Path {
                states: vec![first],
                energy,
            });
        }
        self.best(low, high, Some(first), near, true)
    }

    /// The cheapest path between two paths that bound it. With `first` it begins there; a `closed` one pays for the
    /// step from the last state back to the first.
    pub(crate) fn best(
        &mut self,
        low: &[usize],
        high: &[usize],
        first: Option<usize>,
        last: std::ops::RangeInclusive<usize>,
        closed: bool,
    ) -> Option<Path> {
        let (n, states, reach) = (self.costs.nodes(), self.costs.states(), self.reach());
        let width = states + 2 * reach;
        forward(
            &mut self.reached,
            self.costs,
            &self.price,
            (low, high),
            first,
        );
        let reached = |node: usize, state: usize| self.reached[node * width + reach + state];
        let closing = first.filter(|_| closed);
        let (energy, mut state) = last
            .filter(|&k| low[n - 1] <= k && k <= high[n - 1])
            .map(|k| {
                let back = closing.map_or(0.0, |first| {
                    self.price
                        .get(k.abs_diff(first))
                        .copied()
                        .unwrap_or(f64::INFINITY)
                });
                (reached(n - 1, k) + back, k)
            })
            .fold((f64::INFINITY, usize::MAX), |best, one| {
                if one.0 < best.0 { one } else { best }
            });
        if !energy.is_finite() {
            return None;
        }
        let mut path = vec![0; n];
        for i in (0..n).rev() {
            path[i] = state;
            if i > 0 {
                let before = state.saturating_sub(reach)..=(state + reach).min(states - 1);
                let total = |k: usize| reached(i - 1, k) + self.price[k.abs_diff(state)];
                // the first of equals
                state = before
                    .map(|k| (total(k), k))
                    .fold((f64::INFINITY, state), |best, one| {
                        if one.0 < best.0 { one } else { best }
                    })
                    .1;
            }
        }
        Some(Path {
            states: path,
            energy,
        })
    }
}

lanes::wide! {
    /// The recursion from the first node to the last, between two paths that bound it.
    fn forward(
        reached: &mut [f64],
        costs: &Costs,
        price: &[f64],
        bounds: (&[usize], &[usize]),
        first: Option<usize>,
    ) {
        let reach = price.len() - 1;
        let mut rows = reached.chunks_exact_mut(costs.states() + 2 * reach);
        let Some(mut before) = rows.next() else {
            return;
        };
        before.fill(f64::INFINITY);
        match first {
            Some(first) => before[reach + first] = costs.row(0)[first],
            None => before[reach..reach + costs.states()].copy_from_slice(costs.row(0)),
        }
        for (row, node) in rows.zip(1..) {
            let (from, to) = (bounds.0[node], bounds.1[node] + 1);
            row.fill(f64::INFINITY);
            if from < to {
                let next = &mut row[reach + from..reach + to];
                step(&before[from..to + 2 * reach], price, &costs.row(node)[from..to], next);
            }
            before = row;
        }
    }
}

lanes::wide! {
    /// What the cheapest path from each first state to any last one costs.
    pub(crate) fn least(costs: &Costs, price: &[f64]) -> Vec<f64> {
        let (states, reach) = (costs.states(), price.len() - 1);
        let mut here = vec![f64::INFINITY; states + 2 * reach];
        let mut next = vec![0.0; states];
        for node in (0..costs.nodes()).rev() {
            if node + 1 == costs.nodes() {
                next.copy_from_slice(costs.row(node));
            } else {
                step(&here, price, costs.row(node), &mut next);
            }
            here[reach..reach + states].copy_from_slice(&next);
        }
        next
    }
}

/// What the best way to each state of a node costs: the best by way of a state of the node before, and its own cost.
/// `before` has so many more states at either end as a step may lead.
#[inline(always)]
fn step(before: &[f64], price: &[f64], own: &[f64], next: &mut [f64]) {
    match price {
        [a, b, c] => nearest(before, [*c, *b, *a, *b, *c], own, next),
        [a, b, c, d] => nearest(before, [*d, *c, *b, *a, *b, *c, *d], own, next),
        [a, b, c, d, e] => nearest(before, [*e, *d, *c, *b, *a, *b, *c, *d, *e], own, next),
        _ => {
            let reach = price.len() - 1;
            next.fill(f64::INFINITY);
            for k in 0..=2 * reach {
                nearer(&before[k..], price[k.abs_diff(reach)], next);
            }
            for (next, own) in next.iter_mut().zip(own) {
                *next += *own;
            }
        }
    }
}

/// The same for steps of one of some prices, all at once.
#[inline(always)]
fn nearest<const N: usize>(before: &[f64], prices: [f64; N], own: &[f64], next: &mut [f64]) {
    let count = next.len();
    let shifted: [&[f64]; N] = std::array::from_fn(|k| &before[k..k + count]);
    for ((at, next), own) in next.iter_mut().enumerate().zip(&own[..count]) {
        let mut best = f64::INFINITY;
        for (shifted, price) in shifted.iter().zip(prices) {
            let total = shifted[at] + price;
            best = if total < best { total } else { best };
        }
        *next = best + *own;
    }
}

/// The same for steps of one price, where that is less.
#[inline(always)]
fn nearer(before: &[f64], price: f64, next: &mut [f64]) {
    for (next, before) in next.iter_mut().zip(before) {
        let total = before + price;
        *next = if total < *next { total } else { *next };
    }
}
