//! A number along an outline over the frames, as a picture.

use glam::DVec2;
use image::{Rgb, RgbImage};

use super::axes::{INK, line, named, ticks, write, write_upwards};
use super::colors::{NOTHING, color};
use crate::picture::as_u32;

/// Height of capitals, and of those of the title. Pixels.
const LETTERS: f64 = 10.0;
const TITLE: f64 = 12.0;

/// Sides of the field of cells that are aimed at; cells are at most so wide.
const WIDTH: usize = 860;
const HEIGHT: usize = 400;
const MOST_CELL: usize = 24;

/// Frames and places that are drawn at most; of more, means are drawn.
const MOST_COLUMNS: usize = 4000;
const MOST_ROWS: usize = 1000;

/// Around the field: left, top, right, bottom.
const LEFT: usize = 66;
const TOP: usize = 42;
const RIGHT: usize = 116;
const BOTTOM: usize = 58;

/// Width of the scale beside the field.
const SCALE: usize = 16;

/// Share of the numbers that lie within the colors of the scale.
const WITHIN: f64 = 0.98;

/// Numbers along an outline over the frames.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Kymograph {
    /// What is shown, for people.
    pub title: String,
    /// The name of the numbers, with their unit: `speed (px/frame)`.
    pub scale: String,
    /// The name of the places along the outline, which go from 0 to 1.
    pub places: String,
    /// The first frame.
    pub first: usize,
    /// The numbers of each frame, equally many, at equal distances along the outline; those that are not finite are
    /// shown as none.
    pub rows: Vec<Vec<f64>>,
    /// Whether numbers are of either sign: zero then is white, in the middle.
    pub signed: bool,
}

impl Kymograph {
    /// The picture: frames to the right, places upwards, the scale beside.
    #[must_use]
    pub fn draw(&self) -> RgbImage {
        let places = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let (frames, fewer) = means(self.rows.len(), MOST_COLUMNS);
        let (high, thinner) = means(places, MOST_ROWS);
        let cell = |count: usize, side: usize| (side / count.max(1)).clamp(1, MOST_CELL);
        let (wide, tall) = (cell(frames, WIDTH), (HEIGHT / high.max(1)).max(1));
        let field = (wide * frames.max(1), tall * high.max(1));
        let title = crate::paint::text_length(&self.title, TITLE).max(0.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a length in pixels above 0"
        )]
        let title = title.min(4096.0) as usize;
        let size = (
            (LEFT + field.0 + RIGHT).max(LEFT + title + 12),
            TOP + field.1 + BOTTOM,
        );
        let mut image = RgbImage::from_pixel(as_u32(size.0), as_u32(size.1), Rgb([255; 3]));
        let limits = self.limits();
        for column in 0..frames {
            for row in 0..high {
                let share = self
                    .mean(column * fewer, fewer, row * thinner, thinner)
                    .map_or(f64::NAN, |value| (value - limits.0) / (limits.1 - limits.0));
                let ink = Rgb(color(share, self.signed));
                let (left, top) = (LEFT + column * wide, TOP + (high - 1 - row) * tall);
                for y in top..top + tall {
                    for x in left..left + wide {
                        image.put_pixel(as_u32(x), as_u32(y), ink);
                    }
                }
            }
        }
        self.axes(&mut image, field, wide as f64 / fewer as f64);
        self.scale(&mut image, field, limits);
        self.none(&mut image, field);
        image
    }

    /// The mean of the numbers of so many frames and places; None if there is none.
    fn mean(&self, frame: usize, frames: usize, place: usize, places: usize) -> Option<f64> {
        let rows = self.rows.iter().skip(frame).take(frames);
        let all = rows
            .flat_map(|row| row.iter().skip(place).take(places))
            .filter(|value| value.is_finite());
        let (sum, count) = all.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        (count > 0.0).then_some(sum / count)
    }

    /// The least and the largest number that the scale has.
    fn limits(&self) -> (f64, f64) {
        let mut all: Vec<f64> = self
            .rows
            .iter()
            .flatten()
            .copied()
            .filter(|value| value.is_finite())
            .collect();
        if self.signed {
            all.iter_mut().for_each(|value| *value = value.abs());
        }
        all.sort_by(f64::total_cmp);
        let at = |share: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a place in the list"
            )]
            let place = (share * all.len().saturating_sub(1) as f64).round() as usize;
            all.get(place).copied().unwrap_or(0.0)
        };
        if self.signed {
            let most = [at(WITHIN), at(1.0), 1.0]
                .into_iter()
                .find(|most| *most > 0.0)
                .unwrap_or(1.0);
            return (-most, most);
        }
        let (low, high) = (at(1.0 - WITHIN), at(WITHIN));
        if high > low {
            (low, high)
        } else {
            (low - 0.5, low + 0.5)
        }
    }

    fn axes(&self, image: &mut RgbImage, (width, height): (usize, usize), wide: f64) {
        let (left, top) = (LEFT as f64 - 1.0, TOP as f64 - 1.0);
        let (right, bottom) = ((LEFT + width) as f64, (TOP + height) as f64);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)].map(DVec2::from);
        crate::paint::draw_curve(image, &corners, true, 1.0, INK);
        write(image, DVec2::new(left, 24.0), &self.title, TITLE, 0.0);
        let last = self.first as f64 + self.rows.len().saturating_sub(1) as f64;
        let most = (width / 60).clamp(1, 12);
        let frames: Vec<f64> = ticks(self.first as f64, last, most)
            .into_iter()
            .filter(|tick| tick.fract() == 0.0)
            .collect();
        for (tick, name) in frames.iter().zip(named(&frames)) {
            let x = LEFT as f64 + (tick - self.first as f64 + 0.5) * wide - 0.5;
            line(image, DVec2::new(x, bottom), DVec2::new(x, bottom + 5.0));
            write(image, DVec2::new(x, bottom + 20.0), &name, LETTERS, 0.5);
        }
        write(
            image,
            DVec2::new(0.5 * (left + right), bottom + 42.0),
            "frame",
            LETTERS,
            0.5,
        );
        let shares = ticks(0.0, 1.0, 5);
        for (tick, name) in shares.iter().zip(named(&shares)) {
            let y = bottom - tick * (bottom - top);
            line(image, DVec2::new(left - 5.0, y), DVec2::new(left, y));
            write(
                image,
                DVec2::new(left - 9.0, y + 0.5 * LETTERS),
                &name,
                LETTERS,
                1.0,
            );
        }
        write_upwards(
            image,
            DVec2::new(18.0, 0.5 * (top + bottom)),
            &self.places,
            LETTERS,
        );
    }

    fn scale(
        &self,
        image: &mut RgbImage,
        (width, height): (usize, usize),
        (low, high): (f64, f64),
    ) {
        let (left, top) = (LEFT + width + 22, TOP);
        for row in 0..height {
            let ink = Rgb(color(1.0 - (row as f64 + 0.5) / height as f64, self.signed));
            for x in left..left + SCALE {
                image.put_pixel(as_u32(x), as_u32(top + row), ink);
            }
        }
        let (from, to) = (left as f64 - 1.0, (left + SCALE) as f64);
        let (above, below) = (top as f64 - 1.0, (top + height) as f64);
        let corners = [(from, above), (to, above), (to, below), (from, below)].map(DVec2::from);
        crate::paint::draw_curve(image, &corners, true, 1.0, INK);
        let list = ticks(low, high, 6);
        let mut longest = 0.0_f64;
        for (tick, name) in list.iter().zip(named(&list)) {
            let y = below - (tick - low) / (high - low) * (below - above);
            line(image, DVec2::new(to, y), DVec2::new(to + 5.0, y));
            write(
                image,
                DVec2::new(to + 9.0, y + 0.5 * LETTERS),
                &name,
                LETTERS,
                0.0,
            );
            longest = longest.max(crate::paint::text_length(&name, LETTERS));
        }
        let at = DVec2::new(to + 9.0 + longest + 10.0 + LETTERS, 0.5 * (above + below));
        write_upwards(image, at, &self.scale, LETTERS);
    }

    /// Say below the scale what has no number, if anything has none.
    fn none(&self, image: &mut RgbImage, (width, height): (usize, usize)) {
        if self.rows.iter().flatten().all(|value| value.is_finite()) {
            return;
        }
        let (left, top) = (LEFT + width + 22, TOP + height + 12);
        for y in top..top + SCALE {
            for x in left..left + SCALE {
                image.put_pixel(as_u32(x), as_u32(y), Rgb(NOTHING));
            }
        }
        let at = DVec2::new(
            (left + SCALE) as f64 + 9.0,
            (top + SCALE / 2) as f64 + 0.5 * LETTERS,
        );
        write(image, at, "none", LETTERS, 0.0);
    }

    /// The numbers as a table: `frame,place,` and their name, a line each; empty where there is none.
    #[must_use]
    pub fn table(&self, name: &str) -> String {
        use std::fmt::Write as _;
        let mut text = format!("frame,share,{name}\n");
        for (frame, row) in (self.first..).zip(&self.rows) {
            for (place, value) in row.iter().enumerate() {
                // the middle of the stretch that it is of; writing to a String cannot fail
                let share = (place as f64 + 0.5) / row.len() as f64;
                let _ = write!(text, "{frame},{share},");
                if value.is_finite() {
                    let _ = write!(text, "{value}");
                }
                text.push('\n');
            }
        }
        text
    }
}

/// How many groups so many make, and how many are in a group.
const fn means(count: usize, most: usize) -> (usize, usize) {
    let each = count.div_ceil(most);
    if each < 2 {
        (count, 1)
    } else {
        (count.div_ceil(each), each)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave that runs along, with a frame of nothing.
    fn wave(frames: usize, places: usize) -> Kymograph {
        let value = |t: usize, s: usize| {
            (s as f64 * std::f64::consts::TAU / places as f64 + t as f64 / 5.0).sin() * 2.0
        };
        let mut rows: Vec<Vec<f64>> = (0..frames)
            .map(|t| (0..places).map(|s| value(t, s)).collect())
            .collect();
        if let Some(row) = rows.first_mut() {
            row.fill(f64::NAN);
        }
        Kymograph {
            title: "Speed along the normal, object 1".to_owned(),
            scale: "outward speed (px/frame)".to_owned(),
            places: "share of the first outline".to_owned(),
            first: 3,
            rows,
            signed: true,
        }
    }

    #[test]
    fn cells_have_the_color_of_their_numbers() {
        let one = wave(40, 100);
        let image = one.draw();
        let (wide, tall) = (21, 4);
        let (low, high) = one.limits();
        for (frame, place) in [(0, 5), (1, 0), (20, 50), (39, 99)] {
            let at = (
                LEFT + frame * wide + wide / 2,
                TOP + (99 - place) * tall + tall / 2,
            );
            let share = (one.rows[frame][place] - low) / (high - low);
            let own = image.get_pixel(as_u32(at.0), as_u32(at.1)).0;
            assert_eq!(own, color(share, true), "{frame} {place}");
        }
        assert!((low + high).abs() < 1e-12 && (1.9..2.0).contains(&high));
    }

    #[test]
    fn none_one_and_very_many_numbers_are_drawn() {
        for (frames, places) in [(0, 0), (1, 1), (2, 0), (9000, 3), (3, 5000)] {
            let image = wave(frames, places).draw();
            assert!(
                image.width() < 5000 && image.height() < 1600,
                "{:?}",
                image.dimensions()
            );
        }
        let flat = Kymograph {
            rows: vec![vec![3.0; 4]; 4],
            ..Kymograph::default()
        };
        assert_eq!(flat.limits(), (2.5, 3.5));
        assert!(flat.draw().width() > 0);
    }

    #[test]
    fn a_table_has_a_line_a_number() {
        let text = wave(2, 2).table("speed_px_per_frame");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..3],
            ["frame,share,speed_px_per_frame", "3,0.25,", "3,0.75,"]
        );
        assert!(lines[3].starts_with("4,0.25,0.39"), "{text}");
    }
}
