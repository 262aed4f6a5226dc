//! The order of names with numbers in them.

use std::cmp::Ordering;

/// The order in which people count: runs of digits by the number that they are, all else letter by letter.
///
/// ```
/// let mut names = ["f10.png", "f2.png", "f1.png"];
/// names.sort_by(|a, b| io::frames::natural_order(a, b));
/// assert_eq!(names, ["f1.png", "f2.png", "f10.png"]);
/// ```
#[must_use]
pub fn natural_order(a: &str, b: &str) -> Ordering {
    let (pieces, others) = (pieces(a), pieces(b));
    for (own, other) in pieces.iter().zip(&others) {
        let order = match (own, other) {
            (Piece::Digits(own), Piece::Digits(other)) => by_value(own, other),
            (own, other) => own.text().cmp(other.text()),
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    // of equal numbers, the one with fewer zeros before it
    let fewer = pieces.len().cmp(&others.len());
    fewer.then(a.len().cmp(&b.len())).then_with(|| a.cmp(b))
}

/// A part of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Piece<'a> {
    Digits(&'a str),
    Letters(&'a str),
}

impl<'a> Piece<'a> {
    const fn text(self) -> &'a str {
        match self {
            Self::Digits(text) | Self::Letters(text) => text,
        }
    }
}

pub(super) fn pieces(name: &str) -> Vec<Piece<'_>> {
    let mut list = Vec::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let digit = first.is_ascii_digit();
        let end = rest.find(|c: char| c.is_ascii_digit() != digit);
        let (piece, after) = rest.split_at(end.unwrap_or(rest.len()));
        list.push(if digit {
            Piece::Digits(piece)
        } else {
            Piece::Letters(piece)
        });
        rest = after;
    }
    list
}

/// Numbers of any length, compared.
pub(super) fn by_value(a: &str, b: &str) -> Ordering {
    let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

/// A name without its ending.
pub(super) fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
