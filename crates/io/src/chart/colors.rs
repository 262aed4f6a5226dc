//! Colors for numbers, told apart by every eye.

use crate::paint::byte;

/// From below zero over zero to above: blue, white, red (`RdBu` of `ColorBrewer`, Brewer 2003, turned round).
const SIGNED: [[u8; 3]; 11] = [
    [5, 48, 97],
    [33, 102, 172],
    [67, 147, 195],
    [146, 197, 222],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [244, 165, 130],
    [214, 96, 77],
    [178, 24, 43],
    [103, 0, 31],
];

/// From little to much: dark blue over green to yellow (viridis, van der Walt and Smith 2015, at tenths).
const RISING: [[u8; 3]; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];

/// Where there is no number.
pub(super) const NOTHING: [u8; 3] = [205, 205, 205];

/// The color of a share from 0 to 1 of a scale.
pub(super) fn color(share: f64, signed: bool) -> [u8; 3] {
    if !share.is_finite() {
        return NOTHING;
    }
    let stops = if signed { &SIGNED } else { &RISING };
    let place = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to the last stop"
    )]
    let from = (place.floor() as usize).min(stops.len() - 2);
    let part = place - from as f64;
    let (a, b) = (stops[from], stops[from + 1]);
    std::array::from_fn(|c| byte(f64::from(a[c]) + (f64::from(b[c]) - f64::from(a[c])) * part))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How bright a color is, by the weights of Rec. 709.
    fn light([r, g, b]: [u8; 3]) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn scales_are_read_by_their_brightness_alone() {
        let shares = (0..=100).map(|k| f64::from(k) / 100.0);
        let rising: Vec<f64> = shares
            .clone()
            .map(|share| light(color(share, false)))
            .collect();
        assert!(
            rising.windows(2).all(|pair| pair[1] > pair[0]),
            "{rising:?}"
        );
        let signed: Vec<f64> = shares.map(|share| light(color(share, true))).collect();
        assert!(
            signed[..51].windows(2).all(|pair| pair[1] >= pair[0]),
            "{signed:?}"
        );
        assert!(
            signed[50..].windows(2).all(|pair| pair[1] <= pair[0]),
            "{signed:?}"
        );
        assert_eq!(color(f64::NAN, true), NOTHING);
        assert_eq!(
            (color(-3.0, true), color(7.0, true)),
            (SIGNED[0], SIGNED[10])
        );
    }
}
