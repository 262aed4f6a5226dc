//! Many objects in one picture: average precision of one image of labels against another.

use std::collections::BTreeMap;

use crate::ScoreError;
use crate::mask::same_size;
use ndarray::Array2;

/// The thresholds of the mean.
pub const THRESHOLDS: [f64; 5] = [0.5, 0.6, 0.7, 0.8, 0.9];

/// The least threshold: from here on the matching is unique.
const LEAST: f64 = 0.5;

/// Which objects of one image of labels are those of another, by intersection over union.
///
/// Two objects match if their `IoU` is *above* a threshold of at least 1/2. Each then has more than half of the union
/// of both in common, so no object can match two others, and there is nothing to choose `[kirillov19]`. The average
/// precision at a threshold is `TP / (TP + FP + FN)`: matches over matches, objects found that match none, and true
/// objects that match none (the measure of the Data Science Bowl 2018 `[caicedo19]`, `[schmidt18]`).
///
/// ```
/// let truth = ndarray::array![[1, 1, 0, 2], [1, 1, 0, 2]];
/// let found = ndarray::array![[7, 7, 0, 0], [7, 0, 0, 0]];
/// let instances = score::Instances::of(&found, &truth)?;
/// assert_eq!(instances.matches(0.5), 1); // `IoU` 3/4
/// assert_eq!(instances.average_precision(0.5), 0.5);
/// assert_eq!(instances.average_precision(0.8), 0.0);
/// # Ok::<(), score::ScoreError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Instances {
    /// Number of objects found.
    pub found: usize,
    /// Number of true objects.
    pub truth: usize,
    /// Label found, true label and `IoU` of every pair with an `IoU` above 1/2, by the label found.
    pub pairs: Vec<(u32, u32, f64)>,
}

impl Instances {
    /// Compare the labels found with the true ones: 0 is the background, every other number an object. O(pixels log
    /// objects).
    ///
    /// # Errors
    ///
    /// Images of different sizes.
    pub fn of(found: &Array2<u32>, truth: &Array2<u32>) -> Result<Self, ScoreError> {
        same_size(found.dim(), truth.dim())?;
        let (mut in_found, mut in_truth, mut in_both) =
            (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        for (&a, &b) in found.iter().zip(truth) {
            if a > 0 {
                *in_found.entry(a).or_insert(0_u64) += 1;
            }
            if b > 0 {
                *in_truth.entry(b).or_insert(0_u64) += 1;
            }
            if a > 0 && b > 0 {
                *in_both.entry((a, b)).or_insert(0_u64) += 1;
            }
        }
        let size = |of: &BTreeMap<u32, u64>, label| of.get(&label).copied().unwrap_or(0);
        let pairs = in_both.iter().filter_map(|(&(a, b), &both)| {
            let either = size(&in_found, a) + size(&in_truth, b) - both;
            // in whole numbers, so that exactly a half is no match
            (2 * both > either).then(|| (a, b, real(both) / real(either)))
        });
        Ok(Self {
            pairs: pairs.collect(),
            found: in_found.len(),
            truth: in_truth.len(),
        })
    }

    /// Number of pairs with an `IoU` above the threshold; a threshold below 1/2 counts as 1/2.
    #[must_use]
    pub fn matches(&self, threshold: f64) -> usize {
        let threshold = threshold.max(LEAST);
        self.pairs.iter().filter(|pair| pair.2 > threshold).count()
    }

    /// Average precision at a threshold of at least 1/2; 1 if there is nothing to find and nothing was found.
    #[must_use]
    pub fn average_precision(&self, threshold: f64) -> f64 {
        let matches = self.matches(threshold);
        let all = self.found + self.truth - matches;
        if all == 0 {
            1.0
        } else {
            matches as f64 / all as f64
        }
    }

    /// The mean of the average precision over [`THRESHOLDS`].
    #[must_use]
    pub fn mean_average_precision(&self) -> f64 {
        let sum: f64 = THRESHOLDS.iter().map(|&t| self.average_precision(t)).sum();
        sum / THRESHOLDS.len() as f64
    }
}

/// A number of pixels.
#[allow(clippy::cast_precision_loss, reason = "far below 2^53")]
const fn real(pixels: u64) -> f64 {
    pixels as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn objects_found_missed_and_made_up_are_counted() {
        // two of three found (IoU 1 and 8/10), one made up
        let truth = Array2::from_shape_fn((10, 30), |(y, x)| match (y, x) {
            (0..4, 0..4) => 5,
            (6..8, 0..5) => 6,
            (0..3, 20..25) => 9,
            _ => 0,
        });
        let found = Array2::from_shape_fn((10, 30), |(y, x)| match (y, x) {
            (0..4, 0..4) => 1,
            (6..8, 0..4) => 2,
            (6..9, 12..19) => 3,
            _ => 0,
        });
        let instances = Instances::of(&found, &truth).unwrap();
        assert_eq!(instances.pairs, [(1, 5, 1.0), (2, 6, 0.8)]);
        assert_eq!((instances.found, instances.truth), (3, 3));
        assert_eq!(instances.average_precision(0.5), 2.0 / 4.0);
        assert_eq!(instances.average_precision(0.7), 2.0 / 4.0);
        assert_eq!(instances.average_precision(0.8), 1.0 / 5.0, "above, not at");
        let mean = (0.5 + 0.5 + 0.5 + 0.2 + 0.2) / 5.0;
        assert!((instances.mean_average_precision() - mean).abs() < 1e-15);
    }

    #[test]
    fn an_object_in_two_equal_halves_matches_neither() {
        let truth = Array2::from_elem((4, 4), 1);
        let found = Array2::from_shape_fn((4, 4), |(_, x)| if x < 2 { 1 } else { 2 });
        let instances = Instances::of(&found, &truth).unwrap();
        assert_eq!((instances.matches(0.5), instances.matches(0.0)), (0, 0));
        assert_eq!(instances.average_precision(0.5), 0.0);
    }

    #[test]
    fn nothing_found_where_there_is_nothing_is_right() {
        let none = Array2::from_elem((3, 3), 0);
        let instances = Instances::of(&none, &none).unwrap();
        assert_eq!(instances.mean_average_precision(), 1.0);
        let one = Array2::from_elem((3, 3), 4);
        assert_eq!(
            Instances::of(&none, &one).unwrap().mean_average_precision(),
            0.0
        );
        assert_eq!(
            Instances::of(&one, &none).unwrap().mean_average_precision(),
            0.0
        );
        assert!(Instances::of(&one, &Array2::from_elem((2, 3), 4)).is_err());
    }

    /// The largest number of pairs that a one to one matching above the threshold can have, by trying all.
    fn most(found: &[u32], pairs: &[(u32, u32)], taken: &mut Vec<u32>) -> usize {
        let Some((&first, rest)) = found.split_first() else {
            return 0;
        };
        let mut best = most(rest, pairs, taken);
        for &(a, b) in pairs {
            if a == first && !taken.contains(&b) {
                taken.push(b);
                best = best.max(1 + most(rest, pairs, taken));
                taken.pop();
            }
        }
        best
    }

    proptest! {
        #[test]
        fn matches_are_those_of_the_best_matching(
            found in prop::collection::vec(0u32..4, 30),
            change in prop::collection::vec((0usize..30, 0u32..4), 0..12),
            threshold in prop::sample::select(THRESHOLDS.to_vec()),
        ) {
            let mut truth = found.clone();
            for (at, label) in change {
                truth[at] = label;
            }
            let (found, truth) = (
                Array2::from_shape_vec((5, 6), found).unwrap(),
                Array2::from_shape_vec((5, 6), truth).unwrap(),
            );
            let iou = |a: u32, b: u32| {
                crate::iou(&found.mapv(|v| v == a), &truth.mapv(|v| v == b)).unwrap()
            };
            let mut pairs = Vec::new();
            for (a, b) in (1..4).flat_map(|a| (1..4).map(move |b| (a, b))) {
                let there = found.iter().any(|v| *v == a) && truth.iter().any(|v| *v == b);
                if there && iou(a, b) > threshold {
                    pairs.push((a, b));
                }
            }
            let got = Instances::of(&found, &truth).unwrap();
            prop_assert_eq!(got.matches(threshold), most(&[1, 2, 3], &pairs, &mut Vec::new()));
        }
    }
}
