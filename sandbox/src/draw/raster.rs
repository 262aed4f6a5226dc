//! Lines on pixels, with smooth borders: each pixel asks nine of its points whether they are
//! within half a width of the line.

use super::palette::{Color, to_byte};
use ndarray::Array2;

/// Steps of grey the palette keeps for the ground.
const GREYS: usize = 64;
/// Steps of grey under a border that covers a pixel in part.
const UNDER: usize = 8;
/// Palette entries a line color needs: two partial coverages over each grey, and itself.
const PER_COLOR: usize = 2 * UNDER + 1;

/// A palette that holds a grey ground and up to eleven line colors over it.
#[derive(Debug, Clone)]
pub(crate) struct Inks {
    colors: Vec<Color>,
}

impl Inks {
    /// How many line colors one palette can hold.
    pub(crate) const MOST: usize = (255 - GREYS) / PER_COLOR;

    pub(crate) fn new(colors: Vec<Color>) -> Self {
        Self { colors }
    }

    fn number(&self, color: Color) -> usize {
        self.colors.iter().position(|&c| c == color).unwrap_or(0)
    }

    /// The entry no pixel shows: "as before".
    pub(crate) fn transparent(&self) -> u8 {
        u8::try_from(GREYS + PER_COLOR * self.colors.len()).unwrap_or(u8::MAX)
    }

    /// Red, green, blue of every entry.
    pub(crate) fn table(&self) -> Vec<u8> {
        let grey = |step: usize, steps: usize| {
            let level = to_byte(255.0 * crate::real(step) / crate::real(steps - 1));
            Color(level, level, level)
        };
        let mut out: Vec<Color> = (0..GREYS).map(|step| grey(step, GREYS)).collect();
        for &color in &self.colors {
            for share in [1.0 / 3.0, 2.0 / 3.0] {
                out.extend((0..UNDER).map(|step| grey(step, UNDER).mix(color, share)));
            }
            out.push(color);
        }
        out.push(Color::WHITE);
        out.iter().flat_map(|c| [c.0, c.1, c.2]).collect()
    }

    fn entry(&self, ground: u8, over: Option<(usize, u32)>) -> u8 {
        let step = |steps: usize| (usize::from(ground) * (steps - 1) + 127) / 255;
        let index = match over {
            None | Some((_, 0 | 1)) => step(GREYS),
            Some((color, covered @ 2..=7)) => {
                let share = usize::from(covered > 4);
                GREYS + PER_COLOR * color + UNDER * share + step(UNDER)
            }
            Some((color, _)) => GREYS + PER_COLOR * color + 2 * UNDER,
        };
        u8::try_from(index).unwrap_or(0)
    }
}

/// A frame in the making: a grey ground and, at each pixel, the topmost line.
#[derive(Debug, Clone)]
pub(crate) struct Canvas {
    ground: Array2<u8>,
    over: Array2<Option<(usize, u16)>>,
}

impl Canvas {
    pub(crate) fn new(ground: Array2<u8>) -> Self {
        let over = Array2::from_elem(ground.dim(), None);
        Self { ground, over }
    }

    /// A line of one color through points in pixels; one point alone is a disc.
    pub(crate) fn stroke(&mut self, points: &[(f64, f64)], width: f64, color: Color, inks: &Inks) {
        let number = inks.number(color);
        let mut mask: Array2<u16> = Array2::zeros(self.ground.dim());
        if let [only] = points {
            cover(&mut mask, *only, *only, width / 2.0);
        }
        for pair in points.windows(2) {
            cover(&mut mask, pair[0], pair[1], width / 2.0);
        }
        for (over, &covered) in self.over.iter_mut().zip(&mask) {
            // who covers most of the pixel is seen; the topmost if several do
            let below = over.map_or(0, |(_, below)| below.count_ones());
            if covered.count_ones() > below.min(4) {
                *over = Some((number, covered));
            }
        }
    }

    /// The palette entry of every pixel.
    pub(crate) fn entries(&self, inks: &Inks) -> Array2<u8> {
        let mut out = Array2::zeros(self.ground.dim());
        for ((entry, &ground), over) in out.iter_mut().zip(&self.ground).zip(&self.over) {
            *entry = inks.entry(ground, over.map(|(color, mask)| (color, mask.count_ones())));
        }
        out
    }
}

/// Marks the points within `reach` of the segment.
fn cover(mask: &mut Array2<u16>, a: (f64, f64), b: (f64, f64), reach: f64) {
    if ![a.0, a.1, b.0, b.1].iter().all(|value| value.is_finite()) {
        return;
    }
    let (rows, columns) = mask.dim();
    let bound = |value: f64, most: usize| {
        #[expect(clippy::cast_possible_truncation, reason = "clamped to the picture")]
        #[expect(clippy::cast_sign_loss, reason = "clamped to the picture")]
        let index = value.clamp(0.0, crate::real(most)) as usize;
        index
    };
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    for row in bound(a.1.min(b.1) - reach - 1.0, rows)..bound(a.1.max(b.1) + reach + 2.0, rows) {
        let from = bound(a.0.min(b.0) - reach - 1.0, columns);
        for column in from..bound(a.0.max(b.0) + reach + 2.0, columns) {
            for point in 0..9_usize {
                let x = crate::real(column) + crate::real(point % 3) / 3.0 - 1.0 / 3.0;
                let y = crate::real(row) + crate::real(point / 3) / 3.0 - 1.0 / 3.0;
                let along = if square > 0.0 {
                    (((x - a.0) * dx + (y - a.1) * dy) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let (ox, oy) = (x - a.0 - along * dx, y - a.1 - along * dy);
                if ox * ox + oy * oy <= reach * reach {
                    mask[[row, column]] |= 1 << point;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_level_line_covers_its_rows_and_nothing_else() {
        let inks = Inks::new(vec![Color::BLUE]);
        let mut canvas = Canvas::new(Array2::from_elem((9, 9), 255));
        canvas.stroke(&[(0.0, 4.0), (8.0, 4.0)], 3.0, Color::BLUE, &inks);
        let entries = canvas.entries(&inks);
        let full = inks.entry(255, Some((0, 9)));
        let bare = inks.entry(255, None);
        assert_eq!(
            entries.column(4).to_vec(),
            [bare, bare, bare, full, full, full, bare, bare, bare]
        );
    }

    #[test]
    fn the_palette_fits_into_bytes_with_as_many_colors_as_allowed() {
        let inks = Inks::new(vec![Color::BLUE; Inks::MOST]);
        assert!(inks.table().len() <= 3 * 256);
        assert_eq!(
            inks.table().len(),
            3 * (usize::from(inks.transparent()) + 1)
        );
    }
}
