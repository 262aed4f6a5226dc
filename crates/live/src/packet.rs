//! A message as bytes: words as JSON, then numbers as they are.

use glam::DVec2;
use serde_json::{Value, json};

use crate::LiveError;

/// Bytes of the lengths that a message begins with.
const LENGTHS: usize = 8;

/// A message: its words, and the bytes that go with them.
///
/// As bytes: the length of the words and of the rest (two numbers of 32 bits, the lowest byte first), the words as
/// JSON, filled up with spaces to a multiple of eight bytes, and the rest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Packet {
    /// The words.
    pub head: Value,
    /// Numbers, pictures, files.
    pub rest: Vec<u8>,
}

impl Packet {
    /// A message of words only.
    #[must_use]
    pub const fn words(head: Value) -> Self {
        let rest = Vec::new();
        Self { head, rest }
    }

    /// The message that these bytes are.
    ///
    /// # Errors
    ///
    /// Lengths that are not those of the bytes, words that are no JSON.
    pub fn decode(bytes: &[u8]) -> Result<Self, LiveError> {
        let length = |at: usize| {
            let four = bytes.get(at..at + 4)?.try_into().ok()?;
            usize::try_from(u32::from_le_bytes(four)).ok()
        };
        let lengths = length(0).zip(length(4));
        let whole = lengths.and_then(|(head, rest)| {
            let (words, more) = bytes.get(LENGTHS..)?.split_at_checked(head)?;
            (more.len() == rest).then_some((words, more))
        });
        let Some((words, more)) = whole else {
            let got = bytes.len();
            return Err(LiveError::new(format!(
                "a message must be as long as it says, got {got} bytes"
            )));
        };
        let head = serde_json::from_slice(words).map_err(|error| {
            LiveError::new(format!("the words of a message must be JSON: {error}"))
        })?;
        Ok(Self {
            head,
            rest: more.to_vec(),
        })
    }

    /// The bytes of it.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut words = self.head.to_string().into_bytes();
        while !words.len().is_multiple_of(8) {
            words.push(b' ');
        }
        let length = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(u32::MAX).to_le_bytes();
        let mut out = Vec::with_capacity(LENGTHS + words.len() + self.rest.len());
        out.extend(length(&words));
        out.extend(length(&self.rest));
        out.extend(words);
        out.extend(&self.rest);
        out
    }

    /// Put points at the end, as pairs of floats of 32 bits: where they begin and how many there are.
    pub(crate) fn points(&mut self, points: &[DVec2]) -> Value {
        let numbers = points.iter().flat_map(|p| [p.x, p.y]);
        let at = self.floats(numbers);
        json!([at, points.len()])
    }

    /// Put numbers at the end, as floats of 32 bits: where they begin and how many there are.
    pub(crate) fn numbers(&mut self, numbers: impl ExactSizeIterator<Item = f64>) -> Value {
        let count = numbers.len();
        json!([self.floats(numbers), count])
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "what is drawn needs no more digits"
    )]
    fn floats(&mut self, numbers: impl Iterator<Item = f64>) -> usize {
        let at = self.rest.len() / 4;
        for number in numbers {
            self.rest.extend((number as f32).to_le_bytes());
        }
        at
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop the process")]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_what_its_bytes_say_and_other_bytes_are_refused() {
        let mut packet = Packet::words(json!({"a": [1, 2]}));
        let at = packet.points(&[DVec2::new(1.5, -2.0)]);
        assert_eq!(at, json!([0, 1]));
        let bytes = packet.encode();
        assert_eq!(Packet::decode(&bytes).unwrap(), packet);
        for short in 0..bytes.len() {
            assert!(Packet::decode(&bytes[..short]).is_err(), "{short} bytes");
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(Packet::decode(&longer).is_err());
        let mut other = bytes;
        other[LENGTHS] = b'!';
        let said = Packet::decode(&other).unwrap_err().to_string();
        assert!(said.contains("must be JSON"), "{said}");
    }
}
