//! Colors as the eye tells them apart: CIE 1976 L\*a\*b\* of sRGB, white point D65.

/// L\* (0 … 100), a\* and b\* of red, green and blue from 0 to 255 (IEC 61966-2-1; CIE 15).
#[must_use]
pub fn lab([red, green, blue]: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = [red, green, blue].map(linear);
    // to X, Y and Z as shares of those of white
    let x = (0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b) / 0.950_47;
    let y = 0.212_672_9 * r + 0.715_152_2 * g + 0.072_175_0 * b;
    let z = (0.019_333_9 * r + 0.119_192_0 * g + 0.950_304_1 * b) / 1.088_83;
    let [x, y, z] = [x, y, z].map(root);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Light of a value of a screen from 0 to 255, as a share of the most.
fn linear(value: f64) -> f64 {
    let share = (value / 255.0).clamp(0.0, 1.0);
    if share <= 0.040_45 {
        share / 12.92
    } else {
        ((share + 0.055) / 1.055).powf(2.4)
    }
}

fn root(share: f64) -> f64 {
    if share > 216.0 / 24_389.0 {
        share.cbrt()
    } else {
        (24_389.0 / 27.0 * share + 16.0) / 116.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colors_have_their_known_values() {
        // from the definition, to two decimals, as tables of the web colors print them
        for (rgb, wanted) in [
            ([255.0, 255.0, 255.0], [100.0, 0.0, 0.0]),
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
            ([255.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
            ([0.0, 255.0, 0.0], [87.73, -86.18, 83.18]),
            ([0.0, 0.0, 255.0], [32.30, 79.19, -107.86]),
        ] {
            for (got, wanted) in lab(rgb).iter().zip(wanted) {
                assert!((got - wanted).abs() < 0.01, "{rgb:?}: {got} for {wanted}");
            }
        }
    }
}
