//! Sequences in one another: positions whose numbers begin again, and clocks, whose numbers do so too.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::names::{runs, varying};
use super::order::{Piece, by_value, pieces, stem};

/// The places of two sequences in one, told apart by an outer number while an inner one begins again, as that of a
/// position `s2_t001` does; a clock, whose minutes begin again too, is one sequence.
pub(super) fn nested(names: &[&str]) -> Option<(Vec<usize>, Vec<usize>)> {
    let varying = varying(names);
    let (&outer, &inner) = (varying.first()?, varying.last()?);
    if outer == inner || is_clock(names, &varying) {
        return None;
    }
    let mut groups: Vec<(&str, Vec<usize>, Vec<&str>)> = Vec::new();
    for (place, name) in names.iter().enumerate() {
        let runs = runs(name);
        match groups.last_mut() {
            Some((known, own, list)) if by_value(known, runs[outer]) == Ordering::Equal => {
                own.push(place);
                list.push(runs[inner]);
            }
            _ => groups.push((runs[outer], vec![place], vec![runs[inner]])),
        }
    }
    let several: Vec<_> = groups
        .into_iter()
        .filter(|(_, own, _)| own.len() > 1)
        .collect();
    let pair = several.windows(2).find(|pair| {
        let plain = |number: &str| number.trim_start_matches('0').to_owned();
        let others: BTreeSet<String> = pair[1].2.iter().map(|number| plain(number)).collect();
        let shared = |number: &&&str| others.contains(&plain(number));
        2 * pair[0].2.iter().filter(shared).count() >= pair[0].2.len().min(pair[1].2.len())
    })?;
    Some((pair[0].1.clone(), pair[1].1.clone()))
}

/// Whether the numbers that vary are those of dates and clocks: two digits below 60, or the parts of a date before
/// them or of a second behind them, with no letters but a T between.
fn is_clock(names: &[&str], varying: &[usize]) -> bool {
    names.iter().all(|name| {
        let pieces = pieces(stem(name));
        let runs = runs(name);
        let mut k = 0;
        let mut letters = "";
        let mut plain = true;
        for piece in &pieces {
            match piece {
                Piece::Letters(text) => letters = text,
                Piece::Digits(text) => {
                    if varying.contains(&k) && k > 0 {
                        plain &= letters.chars().all(|c| !c.is_alphabetic() || c == 'T');
                        let second = k + 1 == runs.len() && runs.len() > 3 && text.len() > 2;
                        let below = text.parse::<u64>().is_ok_and(|number| number < 60);
                        plain &= (text.len() == 2 && below) || text.len() == 6 || second;
                    } else if varying.contains(&k) {
                        plain &= matches!(text.len(), 2 | 4 | 6 | 8);
                    }
                    k += 1;
                }
            }
        }
        plain
    })
}
