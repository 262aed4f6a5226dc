//! Names of files with numbers in them: their order, and whether they are one sequence.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use super::mixed::nested;
use super::order::{Piece, by_value, natural_order, pieces, stem};
use crate::text::clip_to;

/// What names have in common that are of one sequence: all but the digits.
fn shape(name: &str) -> String {
    let plain = |piece: &Piece<'_>| match piece {
        Piece::Digits(_) => "#".to_owned(),
        Piece::Letters(text) => (*text).to_owned(),
    };
    pieces(stem(name)).iter().map(plain).collect()
}

/// Words in the name of a picture that lies beside a frame and is none.
const BESIDE: [&str; 17] = [
    "annotation",
    "annotations",
    "gt",
    "label",
    "labels",
    "mask",
    "masks",
    "outline",
    "outlines",
    "overlay",
    "overlays",
    "preview",
    "seg",
    "segmentation",
    "thumb",
    "thumbnail",
    "truth",
];

/// Whether a picture is a mask, labels or the like by its name.
pub(super) fn is_beside(name: &str) -> bool {
    let lower = stem(name).to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphabetic());
    words.any(|word| BESIDE.contains(&word))
}

/// Numbers that are missing in a sequence, from one to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// The place in the sequence, from 0, of the frame behind it.
    pub before: usize,
    /// The first number that is missing.
    pub first: u64,
    /// The last.
    pub last: u64,
    /// How many are missing.
    pub count: u64,
}

impl std::fmt::Display for Gap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.first == self.last {
            write!(f, "{}", self.first)
        } else {
            write!(f, "{} to {}", self.first, self.last)
        }
    }
}

/// Names in order, and what is known of their numbers.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Sequence {
    /// The places of the names in the list that was given.
    pub order: Vec<usize>,
    pub gaps: Vec<Gap>,
    /// Names that are not of the sequence.
    pub left_out: Vec<usize>,
}

/// The sequence that the pictures of a folder are, or why they are none.
pub(super) fn sequence(names: &[&str]) -> Result<Sequence, String> {
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (place, name) in names.iter().enumerate() {
        groups.entry(shape(name)).or_default().push(place);
    }
    let mut several: Vec<&Vec<usize>> = groups
        .iter()
        .filter(|(shape, own)| shape.contains('#') && own.len() > 1)
        .map(|(_, own)| own)
        .collect();
    // the larger first, of equal ones the one that is named first
    several.sort_by_key(|own| (usize::MAX - own.len(), own[0]));
    if let [one, other, ..] = several[..] {
        return Err(mixed(names, one, other, several.len()));
    }
    let mut found = Sequence::default();
    match several.first() {
        Some(own) => {
            found.order = (*own).clone();
            let own: BTreeSet<usize> = own.iter().copied().collect();
            found.left_out = (0..names.len()).filter(|at| !own.contains(at)).collect();
        }
        None => found.order = (0..names.len()).collect(),
    }
    found
        .order
        .sort_by(|&a, &b| natural_order(names[a], names[b]));
    if several.is_empty() {
        return Ok(found);
    }
    let own: Vec<&str> = found.order.iter().map(|&at| names[at]).collect();
    if let Some((a, b)) = twice(&own) {
        return Err(format!(
            "holds {} and {}, which have the same number; one of them is needed",
            clip_to(a, 60),
            clip_to(b, 60)
        ));
    }
    if let Some((one, other)) = nested(&own) {
        let place = |list: Vec<usize>| {
            list.into_iter()
                .map(|at| found.order[at])
                .collect::<Vec<usize>>()
        };
        return Err(mixed(names, &place(one), &place(other), 2));
    }
    found.gaps = gaps(&own);
    Ok(found)
}

fn mixed(names: &[&str], one: &[usize], other: &[usize], count: usize) -> String {
    let said = |own: &[usize]| {
        let mut list: Vec<&str> = own.iter().map(|&at| names[at]).collect();
        list.sort_by(|a, b| natural_order(a, b));
        let [first, .., last] = list[..] else {
            return list.concat();
        };
        format!(
            "{} to {} ({} files)",
            clip_to(first, 60),
            clip_to(last, 60),
            list.len()
        )
    };
    let many = if count > 2 {
        format!("{count} sequences, among them")
    } else {
        "two sequences,".to_owned()
    };
    format!(
        "holds {many} {} and {}; needed: one of them, by a pattern of names or in a folder of its own",
        said(one),
        said(other)
    )
}

/// The digits of a name, run by run.
pub(super) fn runs(name: &str) -> Vec<&str> {
    pieces(stem(name))
        .into_iter()
        .filter_map(|piece| match piece {
            Piece::Digits(text) => Some(text),
            Piece::Letters(_) => None,
        })
        .collect()
}

/// Two neighbours with the same numbers.
fn twice<'a>(names: &[&'a str]) -> Option<(&'a str, &'a str)> {
    let same = |pair: &&[&str]| {
        let (a, b) = (runs(pair[0]), runs(pair[1]));
        a.iter()
            .zip(&b)
            .all(|(a, b)| by_value(a, b) == Ordering::Equal)
    };
    names.windows(2).find(same).map(|pair| (pair[0], pair[1]))
}

/// Which runs of digits are not the same in all names.
pub(super) fn varying(names: &[&str]) -> Vec<usize> {
    let all: Vec<Vec<&str>> = names.iter().map(|name| runs(name)).collect();
    let Some(first) = all.first() else {
        return Vec::new();
    };
    let differs = |&k: &usize| {
        all.iter().any(|own| {
            own.get(k)
                .zip(first.get(k))
                .is_some_and(|(a, b)| by_value(a, b) != Ordering::Equal)
        })
    };
    (0..first.len()).filter(differs).collect()
}

/// The one number that tells names of a sequence apart.
fn numbers(names: &[&str]) -> Option<Vec<u64>> {
    let [k] = varying(names)[..] else { return None };
    names
        .iter()
        .map(|name| runs(name).get(k)?.parse::<u64>().ok())
        .collect()
}

/// What is missing among rising numbers, in steps of their greatest common divisor.
pub(super) fn gaps(names: &[&str]) -> Vec<Gap> {
    let Some(numbers) = numbers(names) else {
        return Vec::new();
    };
    if numbers.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Vec::new();
    }
    let each = numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let step = each.fold(0, divisor).max(1);
    let pairs = (1..).zip(numbers.windows(2));
    let gap = |(before, pair): (usize, &[u64])| {
        let count = (pair[1] - pair[0]) / step - 1;
        (count > 0).then(|| Gap {
            before,
            first: pair[0] + step,
            last: pair[1] - step,
            count,
        })
    };
    pairs.filter_map(gap).collect()
}

const fn divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Whether names are in the order in which a shell lists them, and that is not the order of their numbers.
pub(super) fn is_listed(names: &[&str]) -> bool {
    let first = names.first().map(|name| shape(name));
    names.len() > 1
        && names.iter().all(|name| Some(shape(name)) == first)
        && names.is_sorted()
        && !names.is_sorted_by(|a, b| natural_order(a, b) != Ordering::Greater)
        && varying(names).len() == 1
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;

    fn order(names: &[&str]) -> Vec<String> {
        let found = sequence(names).unwrap();
        found.order.iter().map(|&at| names[at].to_owned()).collect()
    }

    #[test]
    fn numbers_count_as_people_do() {
        let names = ["f10.png", "f2.png", "f1.png", "f0100.png", "f9.png"];
        assert_eq!(
            order(&names),
            ["f1.png", "f2.png", "f9.png", "f10.png", "f0100.png"]
        );
        let long = "f99999999999999999999999.png";
        assert_eq!(order(&[long, "f3.png"]), ["f3.png", long]);
        assert_eq!(natural_order("a", "a"), Ordering::Equal);
        assert_eq!(natural_order("a1", "a01"), Ordering::Less);
        assert_eq!(
            order(&["c.png", "a.png", "b.png"]),
            ["a.png", "b.png", "c.png"]
        );
    }

    #[test]
    fn what_is_missing_is_named_in_steps_of_the_sequence() {
        let found = |names: &[&str]| {
            let gaps = sequence(names).unwrap().gaps;
            gaps.iter()
                .map(|gap| (gap.before, gap.to_string(), gap.count))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            found(&["t1.tif", "t2.tif", "t5.tif", "t6.tif", "t8.tif"]),
            [(2, "3 to 4".to_owned(), 2), (4, "7".to_owned(), 1)]
        );
        assert_eq!(
            found(&["t0.tif", "t10.tif", "t20.tif", "t40.tif"]),
            [(3, "30".to_owned(), 1)]
        );
        assert!(found(&["t0.tif", "t10.tif", "t20.tif"]).is_empty());
        assert!(found(&["a.tif", "b.tif"]).is_empty());
    }

    #[test]
    fn two_sequences_are_told_apart_and_a_clock_is_one() {
        for names in [
            ["a_1.png", "a_2.png", "b_1.png", "b_2.png"],
            ["s1_t001.png", "s1_t002.png", "s2_t001.png", "s2_t002.png"],
            ["1_001.png", "1_002.png", "2_001.png", "2_002.png"],
        ] {
            let error = sequence(&names).unwrap_err();
            let (one, other) = (error.find(names[0]), error.find(names[2]));
            assert!(
                one.is_some() && one < other && error.contains("needed: one of them"),
                "{error}"
            );
        }
        let clock = [
            "12-58-59.png",
            "12-59-00.png",
            "12-59-59.png",
            "13-00-00.png",
            "13-00-59.png",
        ];
        assert_eq!(order(&clock), clock);
        let date = [
            "x_20240101_120059.png",
            "x_20240101_120100.png",
            "x_20240102_120059.png",
            "x_20240102_120100.png",
        ];
        assert_eq!(order(&date), date);
        let same = sequence(&["a1.png", "a01.png", "a2.png"]).unwrap_err();
        assert!(same.contains("a1.png and a01.png"), "{same}");
        let endings = sequence(&["a1.png", "a1.jpg", "a2.png", "a2.jpg"]).unwrap_err();
        assert!(endings.contains("same number"), "{endings}");
    }

    #[test]
    fn what_lies_beside_a_sequence_is_left_out() {
        let names = ["a1.png", "background.png", "a2.png"];
        let found = sequence(&names).unwrap();
        assert_eq!((found.order, found.left_out), (vec![0, 2], vec![1]));
        for name in [
            "a_mask.png",
            "mask012.tif",
            "t01-labels.tif",
            "x_cp_masks.png",
            "man_seg000.tif",
            "GT_3.png",
        ] {
            assert!(is_beside(name), "{name}");
        }
        for name in ["masked_ball1.png", "t000.tif", "unmask.png", "segment3.png"] {
            assert!(!is_beside(name), "{name}");
        }
    }

    #[test]
    fn a_hundred_thousand_names_are_told_apart_at_once() {
        let mut names: Vec<String> = (0..100_000).map(|k| format!("run3_t{k}.png")).collect();
        names.push("background.png".to_owned());
        let list: Vec<&str> = names.iter().map(String::as_str).collect();
        let found = sequence(&list).unwrap();
        assert_eq!(
            (found.order.len(), found.left_out),
            (100_000, vec![100_000])
        );
        let two: Vec<String> = (0..100_000)
            .map(|k| format!("s{}_t{}.png", k % 2, k / 2))
            .collect();
        assert!(sequence(&two.iter().map(String::as_str).collect::<Vec<_>>()).is_err());
    }

    #[test]
    fn a_list_from_a_shell_is_known_by_its_order() {
        assert!(is_listed(&["f1.png", "f10.png", "f2.png"]));
        assert!(!is_listed(&["f1.png", "f2.png", "f10.png"]));
        assert!(!is_listed(&["f2.png", "f1.png", "f10.png"]));
        assert!(!is_listed(&["f1.png", "f10.png", "g2.png"]));
    }
}
