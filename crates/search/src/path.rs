//! The cheapest path through a table of costs, exactly: one state a node, neighbours close to each other.
//!
//! The energy of a path k is `Σ cost[i][k_i] + bend · Σ (k_{i+1} − k_i)²`, where a step from one node to
//! the next is
//! at most `reach` states. Of a closed path the last node has the first as neighbour.
//!
//! An open path is found by the forward recursion of Viterbi and Bellman in O(n K reach). For a closed one, two best
//! paths of different first states need not cross, since the price of a step is convex in its length (exchanging
//! the parts behind a crossing costs nothing), so the best path of a middle first state splits the table in two
//! halves for the others: O(n K reach log K) in all. First states whose cheapest path to any last state costs more than
//! a closed path that is known are left out (\[appleton03\] has the same aim by bounds).

use crate::walk::{Walk, least};

/// Costs of `states` states at each of some nodes, in rows of one node each.
#[derive(Debug, Clone, PartialEq)]
pub struct Costs {
    states: usize,
    cost: Vec<f64>,
}

/// What a path pays for its steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Price of a step by one state; by k states it is k² times that. At least 0.
    pub bend: f64,
    /// The most states that a step may lead.
    pub reach: usize,
}

/// The cheapest path.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The state at each node.
    pub states: Vec<usize>,
    /// What it costs in all.
    pub energy: f64,
}

impl Costs {
    /// A table by its rows, one after the other. `cost` is cut to whole rows.
    #[must_use]
    pub fn new(states: usize, mut cost: Vec<f64>) -> Self {
        let nodes = cost.len().checked_div(states).unwrap_or(0);
        cost.truncate(nodes * states);
        Self { states, cost }
    }

    /// How many nodes there are.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.cost.len().checked_div(self.states).unwrap_or(0)
    }

    /// How many states a node has.
    #[must_use]
    pub const fn states(&self) -> usize {
        self.states
    }

    /// The costs of one node.
    #[must_use]
    pub fn row(&self, node: usize) -> &[f64] {
        &self.cost[node * self.states..(node + 1) * self.states]
    }

    /// The costs of one node, to be changed.
    pub fn row_mut(&mut self, node: usize) -> &mut [f64] {
        &mut self.cost[node * self.states..(node + 1) * self.states]
    }

    /// What a path costs, and infinite for a step beyond the reach.
    #[must_use]
    pub fn energy(&self, path: &[usize], steps: Steps, closed: bool) -> f64 {
        let own: f64 = path.iter().enumerate().map(|(i, &k)| self.row(i)[k]).sum();
        let pairs = path.windows(2).map(|pair| (pair[0], pair[1]));
        let last = closed.then(|| path.last().copied().zip(path.first().copied()));
        let price = |(a, b): (usize, usize)| {
            let apart = a.abs_diff(b);
            if apart > steps.reach {
                f64::INFINITY
            } else {
                steps.bend * (apart * apart) as f64
            }
        };
        own + pairs.chain(last.flatten()).map(price).sum::<f64>()
    }

    /// The cheapest open path; with `ends`, from one given state to another. None if there is no
    /// node, or no path within the reach.
    #[must_use]
    pub fn open_path(&self, steps: Steps, ends: Option<(usize, usize)>) -> Option<Path> {
        let n = self.nodes();
        if n == 0 {
            return None;
        }
        let all = self.states - 1;
        let mut walk = Walk::new(self, steps);
        let (low, high) = (vec![0; n], vec![all; n]);
        match ends {
            None => walk.best(&low, &high, None, 0..=all, false),
            Some((first, last)) if first <= all && last <= all => {
                walk.best(&low, &high, Some(first), last..=last, false)
            }
            Some(_) => None,
        }
    }

    /// The cheapest closed path. None if there is no node, or no path.
    #[must_use]
    pub fn closed_path(&self, steps: Steps) -> Option<Path> {
        let n = self.nodes();
        if n == 0 {
            return None;
        }
        let mut walk = Walk::new(self, steps);
        let least = least(self, &walk.price);
        // what a path of that first state costs at least, but for rounding
        let sizes = self.cost.iter().map(|cost| cost.abs());
        let margin = ROUNDING * sizes.filter(|size| size.is_finite()).sum::<f64>();
        let likely = (0..self.states).min_by(|&a, &b| least[a].total_cmp(&least[b]))?;
        let mut best: Option<Path> = None;
        // first states from .. to, and the paths that bound theirs from below and above
        let mut open = vec![(0, self.states, vec![0; n], vec![self.states - 1; n])];
        while let Some((mut from, mut to, low, high)) = open.pop() {
            if let Some(known) = &best {
                let hopeless = |first: usize| least[first] > known.energy + margin;
                while from < to && hopeless(from) {
                    from += 1;
                }
                while from < to && hopeless(to - 1) {
                    to -= 1;
                }
            }
            if from >= to {
                continue;
            }
            let first = if best.is_none() && (from..to).contains(&likely) {
                likely
            } else {
                usize::midpoint(from, to)
            };
            let found = walk.closed(&low, &high, first);
            let (below, above) = match found {
                Some(path) => {
                    let bound = path.states.clone();
                    if best.as_ref().is_none_or(|known| path.energy < known.energy) {
                        best = Some(path);
                    }
                    (bound.clone(), bound)
                }
                None => (high.clone(), low.clone()),
            };
            open.push((from, first, low, below));
            open.push((first + 1, to, above, high));
        }
        best
    }
}

/// Energies are exact to this share of the sum of all costs.
const ROUNDING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every path there is.
    fn brute(costs: &Costs, steps: Steps, closed: bool) -> f64 {
        let (n, states) = (costs.nodes(), costs.states());
        let count = states.pow(u32::try_from(n).unwrap());
        let path = |number: usize| -> Vec<usize> {
            (0..n)
                .scan(number, |left, _| {
                    let digit = *left % states;
                    *left /= states;
                    Some(digit)
                })
                .collect()
        };
        (0..count)
            .map(|number| costs.energy(&path(number), steps, closed))
            .fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn a_path_is_the_cheapest_of_all(
            states in 1_usize..6,
            nodes in 1_usize..6,
            bend in 0.0..2.0_f64,
            reach in 0_usize..7,
            numbers in proptest::collection::vec(-1.0..1.0_f64, 25),
        ) {
            let costs = Costs::new(states, numbers[..states * nodes].to_vec());
            let steps = Steps { bend, reach };
            let open = costs.open_path(steps, None).unwrap();
            prop_assert!((open.energy - brute(&costs, steps, false)).abs() < 1e-12);
            prop_assert!((open.energy - costs.energy(&open.states, steps, false)).abs() < 1e-12);
            let closed = costs.closed_path(steps).unwrap();
            prop_assert!((closed.energy - costs.energy(&closed.states, steps, true)).abs() < 1e-12);
            prop_assert!((closed.energy - brute(&costs, steps, true)).abs() < 1e-12);
        }
    }

    /// The least energy of a closed path: one recursion for each first state, step by step.
    fn slow(costs: &Costs, steps: Steps) -> f64 {
        let (n, states) = (costs.nodes(), costs.states());
        let price = |a: usize, b: usize| {
            let apart = a.abs_diff(b);
            if apart > steps.reach {
                f64::INFINITY
            } else {
                steps.bend * (apart * apart) as f64
            }
        };
        let from = |first: usize| {
            let mut reached = vec![f64::INFINITY; states];
            reached[first] = costs.row(0)[first];
            for node in 1..n {
                let best = |k: usize| {
                    let ways = (0..states).map(|before| reached[before] + price(before, k));
                    ways.fold(f64::INFINITY, f64::min) + costs.row(node)[k]
                };
                reached = (0..states).map(best).collect();
            }
            let ends = (0..states).map(|last| reached[last] + price(last, first));
            ends.fold(f64::INFINITY, f64::min)
        };
        (0..states).map(from).fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn of_many_first_states_those_left_out_are_worse(
            states in 1_usize..40,
            nodes in 2_usize..30,
            bend in 0.0..0.5_f64,
            reach in 1_usize..6,
            numbers in proptest::collection::vec(-1.0..1.0_f64, 1200),
        ) {
            let costs = Costs::new(states, numbers[..states * nodes].to_vec());
            let steps = Steps { bend, reach };
            let closed = costs.closed_path(steps).unwrap();
            prop_assert!((closed.energy - costs.energy(&closed.states, steps, true)).abs() < 1e-12);
            prop_assert!((closed.energy - slow(&costs, steps)).abs() < 1e-12);
        }
    }

    #[test]
    fn ends_are_kept_or_no_path_is_found() {
        let costs = Costs::new(4, vec![0.0; 12]);
        let steps = Steps {
            bend: 1.0,
            reach: 1,
        };
        let path = costs.open_path(steps, Some((0, 2))).unwrap();
        assert_eq!((path.states[0], path.states[2]), (0, 2));
        assert!(costs.open_path(steps, Some((0, 3))).is_none());
        assert!(costs.open_path(steps, Some((0, 4))).is_none());
        assert!(Costs::new(0, vec![]).closed_path(steps).is_none());
    }
}
