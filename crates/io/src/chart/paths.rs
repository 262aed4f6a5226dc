//! Where things went, over a picture.

use glam::DVec2;
use image::RgbImage;

use crate::paint::{Lettering, color_of, draw_curve, draw_text};

/// The way of a thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Its number.
    pub id: u32,
    /// Its places, in pixels of the picture, and whether it was seen at each.
    pub places: Vec<(DVec2, bool)>,
}

/// Ways over a picture `zoom` times as large as that of their places: each in the color of its number, its beginning as
/// a ring, its end as a disk, dashed where it was not seen.
pub fn paths(image: &mut RgbImage, list: &[Path], zoom: f64) {
    let side = f64::from(image.width().max(image.height()));
    let wide = (side / 320.0).clamp(1.5, 4.0);
    let circle = |center: DVec2, radius: f64| -> Vec<DVec2> {
        (0..24)
            .map(|k| {
                center + radius * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 24.0)
            })
            .collect()
    };
    for one in list {
        let color = color_of(one.id);
        let at = |place: &(DVec2, bool)| place.0 * zoom;
        // a dark border, so that each is seen on any ground
        for (width, ink) in [(wide + 1.6, [20; 3]), (wide, color)] {
            for pair in one.places.windows(2) {
                let (a, b) = (at(&pair[0]), at(&pair[1]));
                let seen = pair[0].1 && pair[1].1;
                let pieces = if seen {
                    vec![vec![a, b]]
                } else {
                    crate::film::dashes(&[a, b], false, 3.0, 3.0)
                };
                for piece in pieces {
                    draw_curve(image, &piece, false, width, ink);
                }
            }
            if let Some(first) = one.places.first() {
                draw_curve(
                    image,
                    &circle(at(first), 1.8 * wide),
                    true,
                    width * 0.7,
                    ink,
                );
            }
            if let Some(last) = one.places.last() {
                draw_curve(
                    image,
                    &circle(at(last), 0.8 * wide),
                    true,
                    1.6 * wide + (width - wide),
                    ink,
                );
            }
        }
    }
    if list.len() < 2 {
        return;
    }
    let height = (side / 45.0).clamp(7.0, 16.0);
    for one in list {
        if let Some((last, _)) = one.places.last() {
            let how = Lettering {
                height,
                color: color_of(one.id),
                casing: Some([0; 3]),
                ..Lettering::default()
            };
            let at = *last * zoom + DVec2::new(3.0 * wide, 0.5 * height);
            draw_text(image, at, &one.id.to_string(), &how);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_is_drawn_from_its_beginning_to_its_end() {
        let mut image = RgbImage::from_pixel(100, 60, image::Rgb([128; 3]));
        let place = |x: f64| (DVec2::new(x, 15.0), true);
        let list = [Path {
            id: 2,
            places: vec![place(5.0), place(20.0), place(45.0)],
        }];
        paths(&mut image, &list, 2.0);
        for x in [20, 40, 80, 90] {
            assert_eq!(image.get_pixel(x, 30).0, color_of(2), "{x}");
        }
        assert_eq!(image.get_pixel(60, 40).0, [128; 3]);
        paths(
            &mut image,
            &[
                Path {
                    id: 1,
                    places: Vec::new(),
                },
                Path {
                    id: 3,
                    places: vec![place(-9e9)],
                },
            ],
            1.0,
        );
    }
}
