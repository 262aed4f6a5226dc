//! How large a pixel of a picture is.

use image::metadata::Orientation;

/// How large a pixel is, in some unit.
#[derive(Debug, Clone, PartialEq)]
pub struct PixelSize {
    /// Its width.
    pub x: f64,
    /// Its height.
    pub y: f64,
    /// The unit of both, as a file calls it: `micron`, `mm`, `inch`, `m`, …
    pub unit: String,
}

impl PixelSize {
    /// A size that can be one: above zero and finite.
    pub(super) fn new(x: f64, y: f64, unit: &str) -> Option<Self> {
        let good = |v: f64| v.is_finite() && v > 0.0;
        (good(x) && good(y)).then(|| Self {
            x,
            y,
            unit: crate::text::clip_to(unit, 30),
        })
    }

    /// That of the picture turned.
    pub(super) fn turned(self, orientation: Orientation) -> Self {
        let across = matches!(
            orientation,
            Orientation::Rotate90
                | Orientation::Rotate270
                | Orientation::Rotate90FlipH
                | Orientation::Rotate270FlipH
        );
        if across {
            return Self {
                x: self.y,
                y: self.x,
                unit: self.unit,
            };
        }
        self
    }
}
