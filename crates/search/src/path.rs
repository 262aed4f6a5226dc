//! The cheapest path through a table of costs, exactly: one state a node, neighbours close to each other.
//!
//! The energy of a path k is `Σ cost[i][k_i] + bend · Σ (k_{i+1} − k_i)²`, where a step from one node to
//! the next is
//! at most `reach` states. Of a closed path the last node has the first as neighbour.
//!
//! An open path is found by the forward recursion of Viterbi and Bellman in O(n K reach). For a closed one, two best
//! paths of different first states need not cross, since the price of a step is convex in its length (exchanging
//! the parts behind a crossing costs nothing), so the best path of a middle first state splits the table in two
//! halves for the others: O(n K reach log K) in all (\[appleton03\] has the same aim by bounds).

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
            None => walk.best(&low, &high, None, 0..=all),
            Some((first, last)) if first <= all && last <= all => {
                walk.best(&low, &high, Some(first), last..=last)
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
        let mut best: Option<Path> = None;
        // first states from .. to, and the paths that bound theirs from below and above
        let mut open = vec![(0, self.states, vec![0; n], vec![self.states - 1; n])];
        while let Some((from, to, low, high)) = open.pop() {
            if from >= to {
                continue;
            }
            let first = usize::midpoint(from, to);
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

/// A forward recursion with its memory.
struct Walk<'a> {
    costs: &'a Costs,
    steps: Steps,
    /// What the best way to each state of a node costs.
    reached: Vec<f64>,
    next: Vec<f64>,
    /// From which state of the node before.
    from: Vec<u32>,
    /// Prices of steps by their length.
    price: Vec<f64>,
}

impl<'a> Walk<'a> {
    fn new(costs: &'a Costs, steps: Steps) -> Self {
        let states = costs.states;
        let reach = steps.reach.min(states - 1);
        Self {
            costs,
            steps: Steps { reach, ..steps },
            reached: vec![f64::INFINITY; states],
            next: vec![f64::INFINITY; states],
            from: vec![0; costs.cost.len()],
            price: (0..=reach).map(|k| steps.bend * (k * k) as f64).collect(),
        }
    }

    /// The cheapest path from `first` back to itself.
    fn closed(&mut self, low: &[usize], high: &[usize], first: usize) -> Option<Path> {
        let n = self.costs.nodes();
        let reach = self.steps.reach;
        let near = first.saturating_sub(reach)..=(first + reach).min(self.costs.states - 1);
        if n == 1 {
            let energy = self.costs.row(0)[first];
            return Some(Path {
                states: vec![first],
                energy,
            });
        }
        self.best(low, high, Some(first), near)
    }

    /// The cheapest path between two paths that bound it. With `first` it begins there; when `last` has several
    /// states and `first` is given, the price of a step from the last back to the first is added.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a table of 2³² states is beyond any memory"
    )]
    fn best(
        &mut self,
        low: &[usize],
        high: &[usize],
        first: Option<usize>,
        last: std::ops::RangeInclusive<usize>,
    ) -> Option<Path> {
        let (n, states, reach) = (self.costs.nodes(), self.costs.states, self.steps.reach);
        self.reached.fill(f64::INFINITY);
        match first {
            Some(first) => self.reached[first] = self.costs.row(0)[first],
            None => self.reached.copy_from_slice(self.costs.row(0)),
        }
        for i in 1..n {
            self.next.fill(f64::INFINITY);
            let row = self.costs.row(i);
            for k in low[i]..=high[i] {
                let begin = k.saturating_sub(reach).max(low[i - 1]);
                let end = (k + reach).min(high[i - 1]);
                let (mut best, mut at) = (f64::INFINITY, k);
                for before in begin..=end {
                    let total = self.reached[before] + self.price[before.abs_diff(k)];
                    if total < best {
                        (best, at) = (total, before);
                    }
                }
                self.next[k] = best + row[k];
                self.from[i * states + k] = at as u32;
            }
            std::mem::swap(&mut self.reached, &mut self.next);
        }
        let closing = first.filter(|_| last.start() != last.end() || self.steps.reach == 0);
        let (energy, mut state) = last
            .filter(|&k| low[n - 1] <= k && k <= high[n - 1])
            .map(|k| {
                let back = closing.map_or(0.0, |first| {
                    self.price
                        .get(k.abs_diff(first))
                        .copied()
                        .unwrap_or(f64::INFINITY)
                });
                (self.reached[k] + back, k)
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
            state = self.from[i * states + state] as usize;
        }
        Some(Path {
            states: path,
            energy,
        })
    }
}

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
            reach in 0_usize..4,
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
