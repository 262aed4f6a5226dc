//! The boundary measure of the DAVIS challenge.

use ndarray::Array2;

use crate::ScoreError;
use crate::mask::same_size;

/// The share of the diagonal that is near.
const NEAR: f64 = 0.008;

/// The boundary F of two masks as the DAVIS challenge takes it `[perazzi16]`.
///
/// A pixel is on a boundary if its right, lower or lower right neighbor is on the other side. What lies within 0.008 of
/// the diagonal, rounded up to whole pixels, of the other boundary is near (the toolkit's disc in place of a match of
/// one to one `[martin04]`). 1 if neither mask has a boundary, 0 if one has none.
///
/// # Errors
///
/// Masks of different sizes.
pub fn boundary_f(found: &Array2<bool>, truth: &Array2<bool>) -> Result<f64, ScoreError> {
    same_size(found.dim(), truth.dim())?;
    let (height, width) = found.dim();
    let near = (NEAR * (height as f64).hypot(width as f64)).ceil();
    let (found, truth) = (boundary(found), boundary(truth));
    let count = |mask: &Array2<bool>| mask.iter().filter(|on| **on).count();
    match (count(&found), count(&truth)) {
        (0, 0) => return Ok(1.0),
        (0, _) | (_, 0) => return Ok(0.0),
        _ => {}
    }
    let share = |of: &Array2<bool>, other: &Array2<bool>| {
        let far = field::squared_distance(other);
        let pairs = of.iter().zip(&far).filter(|(on, _)| **on);
        let within = pairs.filter(|(_, far)| **far <= near * near).count();
        within as f64 / count(of) as f64
    };
    let (precision, recall) = (share(&found, &truth), share(&truth, &found));
    let sum = precision + recall;
    Ok(if sum > 0.0 {
        2.0 * precision * recall / sum
    } else {
        0.0
    })
}

fn boundary(mask: &Array2<bool>) -> Array2<bool> {
    Array2::from_shape_fn(mask.dim(), |(y, x)| {
        let here = mask[[y, x]];
        let other = |y: usize, x: usize| mask.get([y, x]).is_some_and(|there| *there != here);
        other(y, x + 1) || other(y + 1, x) || other(y + 1, x + 1)
    })
}
