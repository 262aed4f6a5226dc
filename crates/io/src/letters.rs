//! Text in pictures: letters drawn as strokes, of any size.

use glam::DVec2;
use image::RgbImage;

use crate::paint::{byte, covered};

/// A letter: how far the next one is, and its strokes. Capitals are 6 high, the line is at 0.
///
/// A stroke is a line through its points (`-`), or a curve whose corners are cut, open (`~`) or closed (`o`).
type Letter = (char, f64, &'static [&'static str]);

const BOWL: &str = "o 0,0 3.4,0 3.4,4 0,4";
const ARCH: &str = "~ 0,2.2 0.3,4.1 3.2,4.5 3.2,2 3.2,0";
const ROUND: &str = "~ 4.2,4.8 3.8,6.1 0,6.3 0,-0.3 3.8,-0.1 4.2,1.2";

#[rustfmt::skip]
const LETTERS: [Letter; 94] = [
    (' ', 2.6, &[]),
    ('0', 4.0, &["o 0,0 4,0 4,6 0,6"]),
    ('1', 4.0, &["- 0.7,4.6 2.1,6 2.1,0", "- 0.7,0 3.5,0"]),
    ('2', 4.0, &["~ 0.1,4.4 0,6.2 4,6.2 4,3.6 2.4,2.3 0,0", "- 0,0 4,0"]),
    ('3', 4.0, &["~ 0.1,5 0.4,6.2 3.8,6.3 3.8,3.2 1.4,3.2", "~ 1.4,3.2 4.2,3.2 4.2,-0.2 0.2,-0.3 0,1.2"]),
    ('4', 4.2, &["- 3,0 3,6 0,1.9 4.2,1.9"]),
    ('5', 4.0, &["- 3.7,6 0.5,6 0.3,3.3", "~ 0.3,3.3 4.2,4.6 4.3,-0.3 0.3,-0.3 0,1"]),
    ('6', 4.0, &["~ 3.6,5.2 3,6.2 0,6.2 0,1.9", "o 0,0 4,0 4,3.8 0,3.8"]),
    ('7', 4.0, &["- 0,6 4,6 1.4,0"]),
    ('8', 4.0, &["o 0.3,3.2 3.7,3.2 3.7,6 0.3,6", "o 0,0 4,0 4,3.2 0,3.2"]),
    ('9', 4.0, &["o 0,2.2 4,2.2 4,6 0,6", "~ 4,4.1 4,-0.2 1,-0.2 0.4,0.8"]),
    ('a', 3.4, &[BOWL, "- 3.4,4 3.4,0"]),
    ('b', 3.4, &["- 0,6 0,0", BOWL]),
    ('c', 3.2, &["~ 3.2,3.1 2.9,4.1 0,4.3 0,-0.3 2.9,-0.1 3.2,0.9"]),
    ('d', 3.4, &["- 3.4,6 3.4,0", BOWL]),
    ('e', 3.4, &["- 0.1,2.1 3.4,2.1", "~ 3.4,2.1 3.4,4.2 0,4.3 0,-0.3 2.8,-0.2 3.2,0.8"]),
    ('f', 2.3, &["~ 2.6,5.9 1,6.5 1,4.5 1,0", "- 0,4 2.2,4"]),
    ('g', 3.4, &[BOWL, "~ 3.4,4 3.4,0 3.4,-2.2 0.8,-2.2 0.3,-1.3"]),
    ('h', 3.2, &["- 0,6 0,0", ARCH]),
    ('i', 1.0, &["- 0.5,4 0.5,0", "- 0.5,5.5 0.5,5.8"]),
    ('j', 1.2, &["~ 0.8,4 0.8,0 0.8,-2.3 -0.7,-1.9", "- 0.8,5.5 0.8,5.8"]),
    ('k', 3.1, &["- 0,6 0,0", "- 2.9,4 0,1.6", "- 1.1,2.5 3.1,0"]),
    ('l', 1.5, &["~ 0.5,6 0.5,1 0.5,-0.2 1.5,0"]),
    ('m', 4.8, &["- 0,4 0,0", "~ 0,2.2 0.2,4.1 2.4,4.5 2.4,2 2.4,0", "~ 2.4,2.2 2.6,4.1 4.8,4.5 4.8,2 4.8,0"]),
    ('n', 3.2, &["- 0,4 0,0", ARCH]),
    ('o', 3.6, &["o 0,0 3.6,0 3.6,4 0,4"]),
    ('p', 3.4, &["- 0,4 0,-2", BOWL]),
    ('q', 3.4, &[BOWL, "- 3.4,4 3.4,-2"]),
    ('r', 2.2, &["- 0,4 0,0", "~ 0,2.2 0.4,4 2.2,4"]),
    ('s', 3.0, &["~ 2.8,3.2 2.6,4.2 0.2,4.2 0.1,2.2 3,1.9 3,-0.2 0.3,-0.2 0,0.8"]),
    ('t', 2.4, &["~ 1,5.4 1,1 1,-0.3 2.4,0.1", "- 0,4 2.2,4"]),
    ('u', 3.2, &["~ 0,4 0,2 0,-0.5 2.9,-0.1 3.2,1.8", "- 3.2,4 3.2,0"]),
    ('v', 3.2, &["- 0,4 1.6,0 3.2,4"]),
    ('w', 4.8, &["- 0,4 1.2,0 2.4,4 3.6,0 4.8,4"]),
    ('x', 3.0, &["- 0,4 3,0", "- 3,4 0,0"]),
    ('y', 3.2, &["- 0,4 1.6,0", "~ 3.2,4 1.6,0 1,-1.9 0,-1.9"]),
    ('z', 3.0, &["- 0,4 3,4 0,0 3,0"]),
    ('A', 4.4, &["- 0,0 2.2,6 4.4,0", "- 0.8,2 3.6,2"]),
    ('B', 4.0, &["- 0,0 0,6 1.6,6", "~ 1.6,6 3.7,6 3.7,3.2 1.6,3.2", "- 1.6,3.2 0,3.2", "~ 1.6,3.2 4.1,3.2 4.1,0 1.6,0", "- 1.6,0 0,0"]),
    ('C', 4.2, &[ROUND]),
    ('D', 4.3, &["- 1.4,0 0,0 0,6 1.4,6", "~ 1.4,6 4.3,6 4.3,0 1.4,0"]),
    ('E', 3.8, &["- 3.8,6 0,6 0,0 3.8,0", "- 0,3.1 3.2,3.1"]),
    ('F', 3.7, &["- 3.7,6 0,6 0,0", "- 0,3.1 3.1,3.1"]),
    ('G', 4.3, &[ROUND, "- 4.2,1.2 4.2,2.8 2.4,2.8"]),
    ('H', 4.2, &["- 0,0 0,6", "- 4.2,0 4.2,6", "- 0,3.1 4.2,3.1"]),
    ('I', 1.0, &["- 0.5,0 0.5,6"]),
    ('J', 2.8, &["~ 2.7,6 2.7,2 2.7,-0.4 0,-0.3 0,1.4"]),
    ('K', 4.0, &["- 0,0 0,6", "- 3.9,6 0,2.2", "- 1.4,3.5 4.1,0"]),
    ('L', 3.5, &["- 0,6 0,0 3.5,0"]),
    ('M', 5.0, &["- 0,0 0,6 2.5,1.5 5,6 5,0"]),
    ('N', 4.2, &["- 0,0 0,6 4.2,0 4.2,6"]),
    ('O', 4.8, &["o 0,0 4.8,0 4.8,6 0,6"]),
    ('P', 3.9, &["- 0,0 0,6 1.4,6", "~ 1.4,6 3.9,6 3.9,2.8 1.4,2.8", "- 1.4,2.8 0,2.8"]),
    ('Q', 4.8, &["o 0,0 4.8,0 4.8,6 0,6", "- 2.8,1.7 4.8,-0.4"]),
    ('R', 4.0, &["- 0,0 0,6 1.4,6", "~ 1.4,6 3.9,6 3.9,2.8 1.4,2.8", "- 1.4,2.8 0,2.8", "- 1.8,2.8 4,0"]),
    ('S', 4.0, &["~ 3.8,4.8 3.5,6.2 0.2,6.3 0.1,3.3 4,2.9 4,-0.3 0.3,-0.2 0,1.2"]),
    ('T', 4.4, &["- 0,6 4.4,6", "- 2.2,6 2.2,0"]),
    ('U', 4.2, &["~ 0,6 0,2.5 0,-0.3 4.2,-0.3 4.2,2.5 4.2,6"]),
    ('V', 4.4, &["- 0,6 2.2,0 4.4,6"]),
    ('W', 6.0, &["- 0,6 1.5,0 3,6 4.5,0 6,6"]),
    ('X', 4.2, &["- 0,0 4.2,6", "- 0,6 4.2,0"]),
    ('Y', 4.2, &["- 0,6 2.1,3 2.1,0", "- 4.2,6 2.1,3"]),
    ('Z', 4.0, &["- 0,6 4,6 0,0 4,0"]),
    ('.', 0.8, &["- 0.4,0 0.4,0.3"]),
    (',', 0.8, &["- 0.6,0.4 0.2,-1"]),
    (':', 0.8, &["- 0.4,0.2 0.4,0.5", "- 0.4,3.2 0.4,3.5"]),
    (';', 0.8, &["- 0.6,0.4 0.2,-1", "- 0.5,3.2 0.5,3.5"]),
    ('-', 2.4, &["- 0,2.3 2.4,2.3"]),
    ('\u{2212}', 3.2, &["- 0,2.6 3.2,2.6"]),
    ('\u{2013}', 3.6, &["- 0,2.3 3.6,2.3"]),
    ('+', 3.2, &["- 0,2.6 3.2,2.6", "- 1.6,1 1.6,4.2"]),
    ('=', 3.2, &["- 0,1.9 3.2,1.9", "- 0,3.4 3.2,3.4"]),
    ('(', 1.5, &["~ 1.5,6.7 0,5 0,0.4 1.5,-1.3"]),
    (')', 1.5, &["~ 0,6.7 1.5,5 1.5,0.4 0,-1.3"]),
    ('[', 1.2, &["- 1.2,6.6 0,6.6 0,-1 1.2,-1"]),
    (']', 1.2, &["- 0,6.6 1.2,6.6 1.2,-1 0,-1"]),
    ('/', 2.6, &["- 0,-0.7 2.6,6.6"]),
    ('|', 0.8, &["- 0.4,-1 0.4,6.6"]),
    ('%', 5.4, &["o 0,3.2 2.2,3.2 2.2,6 0,6", "- 1,0 4.4,6", "o 3.2,0 5.4,0 5.4,2.8 3.2,2.8"]),
    ('\u{b0}', 1.8, &["o 0,4.2 1.8,4.2 1.8,6.2 0,6.2"]),
    ('\u{b2}', 2.0, &["~ 0,5.4 0,6.6 2,6.6 1.9,5 0,3.6", "- 0,3.6 2,3.6"]),
    ('\u{b5}', 3.2, &["- 0,4 0,-2", "~ 0,2 0,-0.5 2.9,-0.1 3.2,1.8", "- 3.2,4 3.2,0"]),
    ('\u{d7}', 2.8, &["- 0,1.1 2.8,3.9", "- 0,3.9 2.8,1.1"]),
    ('\u{b7}', 0.8, &["- 0.4,2.4 0.4,2.7"]),
    ('\u{2026}', 3.6, &["- 0.4,0 0.4,0.3", "- 1.8,0 1.8,0.3", "- 3.2,0 3.2,0.3"]),
    ('_', 3.6, &["- 0,-0.8 3.6,-0.8"]),
    ('#', 4.2, &["- 1,0 1.8,6", "- 2.6,0 3.4,6", "- 0.3,1.9 3.9,1.9", "- 0.5,4.1 4.1,4.1"]),
    ('\'', 0.8, &["- 0.4,6 0.4,4.4"]),
    ('"', 2.0, &["- 0.4,6 0.4,4.4", "- 1.6,6 1.6,4.4"]),
    ('!', 0.8, &["- 0.4,6 0.4,1.8", "- 0.4,0 0.4,0.3"]),
    ('?', 3.4, &["~ 0,4.9 0.2,6.3 3.4,6.2 3.3,3.6 1.6,3.2 1.6,1.6", "- 1.6,0 1.6,0.3"]),
    ('<', 3.0, &["- 3,4.4 0,2.6 3,0.8"]),
    ('>', 3.0, &["- 0,4.4 3,2.6 0,0.8"]),
    ('*', 2.6, &["- 1.3,6 1.3,3.4", "- 0.1,5.4 2.5,4", "- 0.1,4 2.5,5.4"]),
];

/// What stands for a letter that there is not.
const UNKNOWN: Letter = ('\u{fffd}', 3.0, &["- 0,0 3,0 3,6 0,6 0,0"]);

/// Between letters, and how wide a stroke is, in sixths of the height of capitals.
const SPACE: f64 = 1.5;
const STROKE: f64 = 0.8;

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub struct Lettering {
    /// Height of capitals. Pixels.
    pub height: f64,
    /// Its color.
    pub color: [u8; 3],
    /// How much of it is before its place, from 0 (it begins there) to 1 (it ends there).
    pub before: f64,
    /// Whether it runs upwards.
    pub upwards: bool,
    /// A color around its strokes, for grounds of any color.
    pub casing: Option<[u8; 3]>,
}

impl Default for Lettering {
    fn default() -> Self {
        Self {
            height: 8.0,
            color: [0; 3],
            before: 0.0,
            upwards: false,
            casing: None,
        }
    }
}

fn letter(c: char) -> &'static Letter {
    LETTERS
        .iter()
        .find(|(known, ..)| *known == c)
        .unwrap_or(&UNKNOWN)
}

/// How long a text is, with capitals of that height. Pixels.
#[must_use]
pub fn text_length(text: &str, height: f64) -> f64 {
    let sixths: f64 = text.chars().map(|c| letter(c).1 + SPACE).sum();
    (sixths - SPACE).max(0.0) * height / 6.0
}

/// Write a text into a picture, its line beginning at a place; what is outside of the picture is cut.
pub fn draw_text(image: &mut RgbImage, at: DVec2, text: &str, how: &Lettering) {
    let unit = how.height / 6.0;
    let (along, up) = if how.upwards {
        (DVec2::new(0.0, -1.0), DVec2::new(-1.0, 0.0))
    } else {
        (DVec2::new(1.0, 0.0), DVec2::new(0.0, -1.0))
    };
    let start = at - along * (how.before * text_length(text, how.height));
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    let mut x = 0.0;
    for c in text.chars() {
        let (_, width, strokes) = letter(c);
        for stroke in *strokes {
            let points = points(stroke);
            lines.push(
                points
                    .into_iter()
                    .map(|p| start + unit * (along * (x + p.x) + up * p.y))
                    .collect(),
            );
        }
        x += width + SPACE;
    }
    let width = (STROKE * unit).max(1.0);
    if let Some(casing) = how.casing {
        fill(image, &lines, width + (1.3 * unit).max(2.0), casing);
    }
    fill(image, &lines, width, how.color);
}

/// Draw lines together, so that none is darker where two meet.
fn fill(image: &mut RgbImage, lines: &[Vec<DVec2>], width: f64, color: [u8; 3]) {
    let size = image.dimensions();
    let mut covers = std::collections::BTreeMap::new();
    for line in lines {
        covered(size, (line, false), width, |x, y, cover| {
            let most = covers.entry((y, x)).or_insert(0.0_f64);
            *most = most.max(cover);
        });
    }
    for ((y, x), cover) in covers {
        let pixel = image.get_pixel_mut(x, y);
        for (under, over) in pixel.0.iter_mut().zip(color) {
            let way = (f64::from(over) - f64::from(*under)) * cover;
            *under = byte(f64::from(*under) + way);
        }
    }
}

/// The points of a stroke.
fn points(stroke: &str) -> Vec<DVec2> {
    let (kind, rest) = stroke.split_at(1);
    let number = |text: &str| text.parse::<f64>().unwrap_or_default();
    let corner = |word: &str| {
        word.split_once(',')
            .map(|(x, y)| DVec2::new(number(x), number(y)))
    };
    let mut list: Vec<DVec2> = rest.split_whitespace().filter_map(corner).collect();
    if kind == "-" {
        return list;
    }
    for _ in 0..3 {
        list = cut(&list, kind == "o");
    }
    if kind == "o" {
        list.extend(list.first().copied());
    }
    list
}

/// The same with each corner cut to a quarter; the ends of an open one stay.
fn cut(list: &[DVec2], closed: bool) -> Vec<DVec2> {
    let n = list.len();
    if n < 3 {
        return list.to_vec();
    }
    let edges = if closed { n } else { n - 1 };
    let mut out = Vec::with_capacity(2 * n);
    for i in 0..edges {
        let (a, b) = (list[i], list[(i + 1) % n]);
        out.push(if i == 0 && !closed {
            a
        } else {
            a.lerp(b, 0.25)
        });
        out.push(if i + 1 == edges && !closed {
            b
        } else {
            a.lerp(b, 0.75)
        });
    }
    out
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;

    #[test]
    fn every_letter_is_different_and_within_its_place() {
        let drawn = |c: char| {
            let mut image = RgbImage::from_pixel(60, 80, image::Rgb([255; 3]));
            let how = Lettering {
                height: 36.0,
                ..Lettering::default()
            };
            draw_text(&mut image, DVec2::new(12.0, 54.0), &c.to_string(), &how);
            image
        };
        let all: Vec<(char, RgbImage)> = LETTERS.iter().map(|(c, ..)| (*c, drawn(*c))).collect();
        for (place, (c, image)) in all.iter().enumerate() {
            assert!(
                all[..place]
                    .iter()
                    .all(|(other, known)| known != image || other == c),
                "{c}"
            );
            let dark = image
                .enumerate_pixels()
                .filter(|(.., pixel)| pixel.0[0] < 128);
            for (x, ..) in dark {
                assert!((4..12 + 6 * 7).contains(&x), "{c}: {x}");
            }
        }
        let dark = |c: char| drawn(c).pixels().filter(|pixel| pixel.0[0] < 128).count();
        assert_eq!(dark(' '), 0);
        assert!(dark('8') > dark('0') && dark('0') > dark('.'));
    }

    #[test]
    fn a_text_is_where_it_is_put_and_cut_at_the_border() {
        let mut image = RgbImage::from_pixel(200, 30, image::Rgb([255; 3]));
        let how = Lettering {
            height: 12.0,
            before: 1.0,
            ..Lettering::default()
        };
        draw_text(&mut image, DVec2::new(150.0, 20.0), "frame 12", &how);
        let dark: Vec<u32> = image
            .enumerate_pixels()
            .filter(|(.., p)| p.0[0] < 128)
            .map(|(x, ..)| x)
            .collect();
        let (least, most) = (*dark.iter().min().unwrap(), *dark.iter().max().unwrap());
        let length = text_length("frame 12", 12.0);
        assert!(
            (f64::from(most) - 150.0).abs() < 2.0
                && (f64::from(least) - 150.0 + length).abs() < 3.0
        );
        draw_text(
            &mut image,
            DVec2::new(-40.0, 300.0),
            "far away and cut",
            &Lettering::default(),
        );
        let upwards = Lettering {
            upwards: true,
            casing: Some([9; 3]),
            ..Lettering::default()
        };
        draw_text(&mut image, DVec2::new(20.0, 28.0), "up \u{1f40d}", &upwards);
    }
}
