//! Which of many outlines are objects: those without overlap that the picture supports most in all.

use crate::spans::Spans;

/// Outlines overlap that have more than this share of the smaller one in common.
const OVERLAP: f64 = 0.2;

/// Outlines are alike that have this share of their union in common.
const ALIKE: f64 = 0.8;

/// An outline to choose from.
#[derive(Debug, Clone)]
pub(crate) struct Choice {
    pub spans: Spans,
    /// What it is worth to have it.
    pub value: f64,
}

/// The outlines, by their numbers, that are worth most together and do not overlap.
///
/// Chosen greedily by value, then bettered until no exchange of one for those it overlaps, or of one for others
/// that overlap only it, is worth more. The sum grows with each exchange, so it ends.
pub(crate) fn select(choices: &[Choice]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..choices.len())
        .filter(|&i| choices[i].value > 0.0)
        .collect();
    order.sort_by(|&a, &b| {
        choices[b]
            .value
            .total_cmp(&choices[a].value)
            .then(a.cmp(&b))
    });
    let near = Buckets::of(choices, &order);
    // of outlines that are alike, the best is enough
    let mut kept: Vec<usize> = Vec::new();
    let mut is_kept = vec![false; choices.len()];
    for &i in &order {
        let own = choices[i].spans.area();
        let alike = near.beside(&choices[i].spans).any(|j| {
            if !is_kept[j] {
                return false;
            }
            let common = choices[i].spans.common(&choices[j].spans) as f64;
            common > ALIKE * (own + choices[j].spans.area()) as f64 - ALIKE * common
        });
        if !alike {
            is_kept[i] = true;
            kept.push(i);
        }
    }
    let mut rivals: Vec<Vec<usize>> = vec![Vec::new(); choices.len()];
    for &i in &kept {
        let own = choices[i].spans.area();
        let mut list: Vec<usize> = near
            .beside(&choices[i].spans)
            .filter(|&j| {
                if j == i || !is_kept[j] {
                    return false;
                }
                let least = own.min(choices[j].spans.area()) as f64;
                choices[i].spans.common(&choices[j].spans) as f64 > OVERLAP * least
            })
            .collect();
        list.sort_unstable();
        list.dedup();
        rivals[i] = list;
    }
    let mut chosen = vec![false; choices.len()];
    let value = |list: &[usize], chosen: &[bool]| -> f64 {
        list.iter()
            .filter(|&&j| chosen[j])
            .map(|&j| choices[j].value)
            .sum()
    };
    loop {
        let mut changed = false;
        for &i in &kept {
            if !chosen[i] && choices[i].value > value(&rivals[i], &chosen) + 1e-9 {
                rivals[i].iter().for_each(|&j| chosen[j] = false);
                chosen[i] = true;
                changed = true;
            }
        }
        for &i in &kept {
            if chosen[i]
                && let Some(set) = more_for(i, choices, &rivals, &chosen)
            {
                chosen[i] = false;
                set.iter().for_each(|&j| chosen[j] = true);
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    let mut out: Vec<usize> = kept.into_iter().filter(|&i| chosen[i]).collect();
    out.sort_unstable();
    out
}

/// Outlines that overlap only a chosen one, not each other, and are worth more: from each to begin with, then the best
/// that fit.
fn more_for(
    i: usize,
    choices: &[Choice],
    rivals: &[Vec<usize>],
    chosen: &[bool],
) -> Option<Vec<usize>> {
    let alone = |j: &&usize| rivals[**j].iter().all(|&k| k == i || !chosen[k]);
    let mut free: Vec<usize> = rivals[i].iter().filter(alone).copied().collect();
    free.sort_by(|&a, &b| {
        choices[b]
            .value
            .total_cmp(&choices[a].value)
            .then(a.cmp(&b))
    });
    let mut best = (choices[i].value + 1e-9, None);
    for &first in &free {
        let mut set = vec![first];
        let mut sum = choices[first].value;
        for &j in &free {
            let fits = |k: &usize| *k != j && rivals[j].binary_search(k).is_err();
            if set.iter().all(fits) {
                set.push(j);
                sum += choices[j].value;
            }
        }
        if sum > best.0 {
            best = (sum, Some(set));
        }
    }
    best.1
}

/// Side of the squares that outlines are sorted into, in pixels.
const SIDE: usize = 32;

/// Outlines by the squares of the picture that they reach into.
struct Buckets {
    columns: usize,
    lists: Vec<Vec<usize>>,
}

impl Buckets {
    fn of(choices: &[Choice], order: &[usize]) -> Self {
        let all = order.iter().flat_map(|&i| choices[i].spans.0.iter());
        let most = all.fold((0, 0), |most, one| (most.0.max(one.0), most.1.max(one.2)));
        let columns = most.1 / SIDE + 1;
        let mut lists = vec![Vec::new(); columns * (most.0 / SIDE + 1)];
        for &i in order {
            for at in squares(&choices[i].spans, columns) {
                lists[at].push(i);
            }
        }
        Self { columns, lists }
    }

    /// All that reach into squares of an outline, some several times.
    fn beside(&self, spans: &Spans) -> impl Iterator<Item = usize> + '_ {
        let all = squares(spans, self.columns).into_iter();
        all.flat_map(|at| self.lists[at].iter().copied())
    }
}

/// The squares that spans reach into, in order.
fn squares(spans: &Spans, columns: usize) -> Vec<usize> {
    let mut out: Vec<usize> = spans
        .0
        .iter()
        .flat_map(|&(row, from, to)| {
            (from / SIDE..=(to - 1) / SIDE).map(move |x| row / SIDE * columns + x)
        })
        .collect();
    out.sort_unstable();
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn strip(from: f64, to: f64, value: f64) -> Choice {
        let corners = [(from, -0.5), (to, -0.5), (to, 9.5), (from, 9.5)].map(DVec2::from);
        Choice {
            spans: Spans::of(&corners, (10, 100)),
            value,
        }
    }

    #[test]
    fn the_best_set_is_found_where_greed_alone_fails() {
        // one across two, and worth less than both together
        let mut list = vec![
            strip(0.5, 20.5, 5.0),
            strip(5.5, 35.5, 6.0),
            strip(22.5, 40.5, 4.0),
        ];
        assert_eq!(select(&list), [0, 2]);
        // and more
        list[1].value = 9.5;
        assert_eq!(select(&list), [1]);
        // what has no value is none
        list.iter_mut().for_each(|one| one.value = -1.0);
        assert!(select(&list).is_empty());
        assert!(select(&[]).is_empty());
    }

    #[test]
    fn of_those_that_are_alike_the_best_is_taken() {
        let list = [
            strip(0.5, 20.5, 5.0),
            strip(1.5, 21.5, 5.5),
            strip(60.5, 80.5, 1.0),
        ];
        assert_eq!(select(&list), [1, 2]);
    }
}
