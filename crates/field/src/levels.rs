//! How far the levels of a picture reach, and how far those of most of its pixels.

/// The least, the 2nd and the 98th percentile, and the largest, in this order; zeros where there is
/// none. The values are asked for several times. O(values).
#[must_use]
pub fn level_limits<I: Iterator<Item = f64>>(values: impl Fn() -> I) -> [f64; 4] {
    let mut n = 0;
    let (mut least, mut largest) = (None, None);
    for value in values() {
        n += 1;
        let below = |other: &f64| value.total_cmp(other).is_lt();
        if least.as_ref().is_none_or(below) {
            least = Some(value);
        }
        let above = |other: &f64| value.total_cmp(other).is_gt();
        if largest.as_ref().is_none_or(above) {
            largest = Some(value);
        }
    }
    let (Some(least), Some(largest)) = (least, largest) else {
        return [0.0; 4];
    };
    let rank = |part: usize| (n - 1) * part / 100;
    let [low, high] = at_ranks(&values, [rank(2), rank(98)]);
    [least, low, high, largest]
}

/// Bits that are told apart at a time.
const DIGIT: u32 = 16;

/// The values that stand at these ranks in order, found digit by digit: by counting, without a copy
/// of the values.
fn at_ranks<I: Iterator<Item = f64>>(values: impl Fn() -> I, mut ranks: [usize; 2]) -> [f64; 2] {
    // numbers whose order is that of `f64::total_cmp`
    let key = |value: f64| {
        let bits = value.to_bits();
        if bits >> 63 == 1 {
            !bits
        } else {
            bits | (1 << 63)
        }
    };
    let mut known = [0_u64; 2];
    for shift in (0..64 / DIGIT).rev().map(|place| place * DIGIT) {
        let mut counts = [vec![0_usize; 1 << DIGIT], vec![0_usize; 1 << DIGIT]];
        for key in values().map(key) {
            // those that begin as the one that is looked for
            let begin = key.checked_shr(shift + DIGIT).unwrap_or(0);
            #[expect(clippy::cast_possible_truncation, reason = "one digit of 16 bits")]
            let digit = (key >> shift) as u16;
            for (known, counts) in known.iter().zip(&mut counts) {
                if begin == *known {
                    counts[usize::from(digit)] += 1;
                }
            }
        }
        for ((known, rank), counts) in known.iter_mut().zip(&mut ranks).zip(&counts) {
            let mut digit = 0_u64;
            for &count in counts {
                if *rank < count {
                    break;
                }
                *rank -= count;
                digit += 1;
            }
            *known = (*known << DIGIT) | digit;
        }
    }
    known.map(|key| {
        let bits = if key >> 63 == 1 {
            key & !(1 << 63)
        } else {
            !key
        };
        f64::from_bits(bits)
    })
}

/// From the 2nd to the 98th percentile, or where these are one, from the least to the largest; 0
/// for a constant.
#[must_use]
pub fn level_spread([least, low, high, largest]: [f64; 4]) -> f64 {
    // less than the rounding of colors to grey leaves
    if largest - least <= 1e-12 * least.abs().max(largest.abs()) {
        return 0.0;
    }
    if high > low {
        high - low
    } else {
        largest - least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranks_are_those_of_the_values_in_order(
            values in prop::collection::vec(
                prop_oneof![-1e3..1e3_f64, Just(0.0), Just(-0.0), any::<f64>().prop_filter("finite", |v| v.is_finite())],
                1..300,
            ),
        ) {
            let mut ordered = values.clone();
            ordered.sort_by(f64::total_cmp);
            let last = values.len() - 1;
            let expected = [0, 2, 98, 100].map(|part| ordered[last * part / 100]);
            let found = level_limits(|| values.iter().copied());
            prop_assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
        }
    }
}
