//! Numbers of objects: those of their starts, where each has one of its own, and others behind them.

use std::collections::{BTreeMap, BTreeSet};

use io::shapes::Shape;

/// The numbers that objects are written with, by the numbers that they are followed with.
#[derive(Debug, Clone, Default)]
pub(super) struct Numbers {
    known: BTreeMap<u32, u32>,
    next: u32,
}

impl Numbers {
    /// Those of starts.
    pub(super) fn of(shapes: &[Shape]) -> Self {
        let own = shapes
            .iter()
            .map(|shape| shape.id.as_ref()?.parse::<u32>().ok().filter(|&id| id > 0));
        let own: Option<Vec<u32>> = own.collect();
        let different = |list: &Vec<u32>| list.iter().collect::<BTreeSet<_>>().len() == list.len();
        match own.filter(different) {
            Some(list) => Self::given(list.into_iter()),
            None => Self::given((1..).take(shapes.len())),
        }
    }

    /// These, for the objects from 1 on.
    pub(super) fn given(list: impl Iterator<Item = u32>) -> Self {
        let known: BTreeMap<u32, u32> = (1..).zip(list).collect();
        let next = known
            .values()
            .max()
            .map_or(1, |most| most.saturating_add(1));
        Self { known, next }
    }

    /// The number of an object that is followed.
    pub(super) fn of_object(&mut self, id: u32) -> u32 {
        *self.known.entry(id).or_insert_with(|| {
            let own = self.next;
            self.next = self.next.saturating_add(1);
            own
        })
    }

    /// An object that is followed has that number from now on, and no other has it.
    pub(super) fn set(&mut self, id: u32, number: u32) {
        self.known.retain(|_, own| *own != number);
        self.known.insert(id, number);
        self.next = self.next.max(number.saturating_add(1));
    }

    /// The least number there is.
    pub(super) fn first(&self) -> u32 {
        self.known.values().min().copied().unwrap_or(1)
    }

    /// Whether an object has that number.
    pub(super) fn is_known(&self, number: u32) -> bool {
        self.known.values().any(|own| *own == number)
    }

    /// The numbers there are, in words.
    pub(super) fn list(&self) -> String {
        let own: BTreeSet<u32> = self.known.values().copied().collect();
        let some: Vec<String> = own.iter().take(20).map(u32::to_string).collect();
        let more = if own.len() > some.len() { ", …" } else { "" };
        some.join(", ") + more
    }

    /// The object that has that number.
    pub(super) fn object(&self, number: u32) -> Option<u32> {
        self.known
            .iter()
            .find(|(_, own)| **own == number)
            .map(|(id, _)| *id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_keep_their_numbers_and_others_come_behind_them() {
        let shape = |id: &str| Shape {
            id: Some(id.to_owned()),
            ..Shape::default()
        };
        let mut numbers = Numbers::of(&[shape("7"), shape("3")]);
        assert_eq!(
            [1, 2, 3, 9, 3].map(|id| numbers.of_object(id)),
            [7, 3, 8, 9, 8]
        );
        assert_eq!((numbers.object(3), numbers.object(4)), (Some(2), None));
        // one that was lost and is taken up again under its number
        numbers.set(11, 3);
        assert_eq!((numbers.object(3), numbers.of_object(12)), (Some(11), 10));
        for list in [["7", "7"], ["a", "1"], ["0", "1"]] {
            let mut numbers = Numbers::of(&list.map(shape));
            assert_eq!([1, 2, 3].map(|id| numbers.of_object(id)), [1, 2, 3]);
        }
    }
}
