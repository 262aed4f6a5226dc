//! The one palette: Okabe and Ito's colors, which stay apart for every common color vision, and
//! two color maps that stay ordered in grey.

/// A color of the palette, or any other, as red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8);

impl Color {
    /// Text and axes.
    pub const INK: Self = Self(0x1f, 0x23, 0x28);
    /// Secondary lines: what a curve was, where it went, where zero is.
    pub const GREY: Self = Self(0x8a, 0x8f, 0x96);
    /// Grid lines.
    pub const LIGHT: Self = Self(0xe3, 0xe6, 0xea);
    /// The ground.
    pub const WHITE: Self = Self(0xff, 0xff, 0xff);
    /// First series.
    pub const BLUE: Self = Self(0x00, 0x72, 0xb2);
    /// Second series, and whatever is wrong.
    pub const RED: Self = Self(0xd5, 0x5e, 0x00);
    /// Third series, and exact answers.
    pub const GREEN: Self = Self(0x00, 0x9e, 0x73);
    /// Fourth series.
    pub const PURPLE: Self = Self(0xcc, 0x79, 0xa7);
    /// Fifth series.
    pub const ORANGE: Self = Self(0xe6, 0x9f, 0x00);
    /// Sixth series; curves over a grey picture.
    pub const SKY: Self = Self(0x56, 0xb4, 0xe9);
    /// Marks over a grey picture.
    pub const YELLOW: Self = Self(0xf0, 0xe4, 0x42);

    /// The series colors in order.
    pub const SERIES: [Self; 6] = [
        Self::BLUE,
        Self::RED,
        Self::GREEN,
        Self::PURPLE,
        Self::ORANGE,
        Self::SKY,
    ];

    /// The color between two others: `0` gives `self`, `1` gives `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        let blend = |a: u8, b: u8| {
            let value = f64::from(a) + (f64::from(b) - f64::from(a)) * share;
            to_byte(value)
        };
        Self(
            blend(self.0, other.0),
            blend(self.1, other.1),
            blend(self.2, other.2),
        )
    }
}

/// The nearest byte.
pub(crate) fn to_byte(value: f64) -> u8 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to the range of a byte"
    )]
    #[expect(clippy::cast_sign_loss, reason = "clamped to the range of a byte")]
    let byte = value.round().clamp(0.0, 255.0) as u8;
    byte
}

/// Blue for negative, white for zero, red for positive; `value` from −1 to 1.
#[must_use]
pub fn diverging(value: f64) -> Color {
    const STOPS: [Color; 5] = [
        Color(0x05, 0x48, 0x7c),
        Color(0x4f, 0xa0, 0xd2),
        Color(0xff, 0xff, 0xff),
        Color(0xf0, 0x8a, 0x4b),
        Color(0x9a, 0x2f, 0x05),
    ];
    along(&STOPS, (value + 1.0) / 2.0)
}

/// White for nothing, through orange and purple to near black; `value` from 0 to 1.
#[must_use]
pub fn sequential(value: f64) -> Color {
    const STOPS: [Color; 5] = [
        Color(0xff, 0xff, 0xff),
        Color(0xfc, 0xd2, 0x8c),
        Color(0xe0, 0x6a, 0x4a),
        Color(0x8a, 0x1f, 0x63),
        Color(0x1e, 0x0a, 0x3c),
    ];
    along(&STOPS, value)
}

fn along(stops: &[Color; 5], value: f64) -> Color {
    let place = if value.is_nan() {
        0.0
    } else {
        value.clamp(0.0, 1.0) * 4.0
    };
    let mut left = 0;
    while left < 3 && place > crate::real(left + 1) {
        left += 1;
    }
    stops[left].mix(stops[left + 1], place - crate::real(left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diverging_map_is_white_at_zero_and_apart_at_the_ends() {
        assert_eq!(diverging(0.0), Color::WHITE);
        assert!(diverging(-1.0).2 > diverging(-1.0).0);
        assert!(diverging(1.0).0 > diverging(1.0).2);
        assert_eq!(diverging(7.0), diverging(1.0));
    }

    #[test]
    fn a_sequential_map_gets_darker_all_the_way() {
        let grey = |c: Color| 299 * u32::from(c.0) + 587 * u32::from(c.1) + 114 * u32::from(c.2);
        let levels: Vec<u32> = (0..=20)
            .map(|i| grey(sequential(f64::from(i) / 20.0)))
            .collect();
        assert!(
            levels.windows(2).all(|pair| pair[1] < pair[0]),
            "{levels:?}"
        );
    }
}
