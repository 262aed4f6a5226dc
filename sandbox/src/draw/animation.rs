//! Lines that move, as a GIF: own palette, only what changed is stored.

use super::figure::DrawError;
use super::palette::{Color, to_byte};
use super::raster::{Canvas, Inks};
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use ndarray::Array2;

/// One line of a shot, in the animation's coordinates; a single point is a disc.
#[derive(Debug, Clone)]
pub struct Stroke {
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Its color.
    pub color: Color,
    /// Its width, or the disc's diameter, in pixels.
    pub width: f64,
}

/// What is to be seen at one time.
#[derive(Debug, Clone)]
pub struct Shot {
    /// From the ground up.
    pub strokes: Vec<Stroke>,
    /// For how long, in hundredths of a second.
    pub hold: u16,
}

/// A sequence of shots over one ground.
#[derive(Debug, Clone)]
pub struct Animation {
    /// Left, top, right, bottom of what is shown; bottom may be less than top.
    pub view: [f64; 4],
    /// Width in pixels; the height follows from the view.
    pub width: usize,
    /// Grey levels 0 to 255 of a picture whose pixel centers lie at whole numbers, from (0, 0).
    pub ground: Option<Array2<f64>>,
    /// In order.
    pub shots: Vec<Shot>,
}

impl Animation {
    /// The animation as GIF bytes, the same every time. It starts again when it is over.
    ///
    /// # Errors
    ///
    /// When there are no shots, more colors than a palette holds, or more pixels than GIF counts.
    pub fn gif(&self) -> Result<Vec<u8>, DrawError> {
        let mut colors: Vec<Color> = Vec::new();
        for stroke in self.shots.iter().flat_map(|shot| &shot.strokes) {
            if !colors.contains(&stroke.color) {
                colors.push(stroke.color);
            }
        }
        if colors.len() > Inks::MOST || self.shots.is_empty() {
            return Err(DrawError::because(
                "an animation needs shots and has few colors",
            ));
        }
        let inks = Inks::new(colors);
        let ground = self.ground_pixels()?;
        let (height, width) = ground.dim();
        let (wide, high) = (side(width)?, side(height)?);
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, wide, high, &inks.table())
            .map_err(|error| DrawError::because(&error.to_string()))?;
        encoder
            .set_repeat(Repeat::Infinite)
            .map_err(|error| DrawError::because(&error.to_string()))?;
        let mut shown: Option<Array2<u8>> = None;
        for shot in &self.shots {
            let mut canvas = Canvas::new(ground.clone());
            for stroke in &shot.strokes {
                let points: Vec<(f64, f64)> = stroke
                    .points
                    .iter()
                    .map(|&p| self.place(p, width, height))
                    .collect();
                canvas.stroke(&points, stroke.width, stroke.color, &inks);
            }
            let entries = canvas.entries(&inks);
            let mut frame = changed(shown.as_ref(), &entries, inks.transparent())?;
            frame.delay = shot.hold;
            encoder
                .write_frame(&frame)
                .map_err(|error| DrawError::because(&error.to_string()))?;
            shown = Some(entries);
        }
        drop(encoder);
        Ok(bytes)
    }

    fn place(&self, at: (f64, f64), width: usize, height: usize) -> (f64, f64) {
        let [left, top, right, bottom] = self.view;
        (
            (at.0 - left) / (right - left) * crate::real(width) - 0.5,
            (at.1 - top) / (bottom - top) * crate::real(height) - 0.5,
        )
    }

    /// The ground on the animation's own pixels, or white.
    fn ground_pixels(&self) -> Result<Array2<u8>, DrawError> {
        let [left, top, right, bottom] = self.view;
        let ratio = ((bottom - top) / (right - left)).abs();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "checked against the format below"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a ratio of lengths is positive")]
        let height = (crate::real(self.width) * ratio).round().min(65_536.0) as usize;
        side(height)?;
        let Some(picture) = &self.ground else {
            return Ok(Array2::from_elem((height, self.width), 255));
        };
        Ok(Array2::from_shape_fn(
            (height, self.width),
            |(row, column)| {
                let x =
                    left + (crate::real(column) + 0.5) / crate::real(self.width) * (right - left);
                let y = top + (crate::real(row) + 0.5) / crate::real(height) * (bottom - top);
                to_byte(between(picture, x, y))
            },
        ))
    }
}

/// The grey level between pixel centers, the border going on outside.
fn between(picture: &Array2<f64>, x: f64, y: f64) -> f64 {
    let split = |value: f64, count: usize| {
        let value = value.clamp(0.0, crate::real(count - 1));
        #[expect(clippy::cast_possible_truncation, reason = "clamped to the picture")]
        #[expect(clippy::cast_sign_loss, reason = "clamped to the picture")]
        let base = (value as usize).min(count.saturating_sub(2));
        (base, (base + 1).min(count - 1), value - crate::real(base))
    };
    let (rows, columns) = picture.dim();
    let ((r0, r1, v), (c0, c1, u)) = (split(y, rows), split(x, columns));
    let above = picture[[r0, c0]] * (1.0 - u) + picture[[r0, c1]] * u;
    let below = picture[[r1, c0]] * (1.0 - u) + picture[[r1, c1]] * u;
    above * (1.0 - v) + below * v
}

fn side(pixels: usize) -> Result<u16, DrawError> {
    match u16::try_from(pixels) {
        Ok(side) if side > 0 => Ok(side),
        _ => Err(DrawError::because(
            "an animation is 1 to 65535 pixels wide and high",
        )),
    }
}

/// The smallest rectangle that holds every change, what did not change being transparent.
fn changed(
    before: Option<&Array2<u8>>,
    now: &Array2<u8>,
    transparent: u8,
) -> Result<Frame<'static>, DrawError> {
    let (height, width) = now.dim();
    let differs = |row: usize, column: usize| {
        before.is_none_or(|before| before[[row, column]] != now[[row, column]])
    };
    let (mut top, mut bottom, mut left, mut right) = (height, 0, width, 0);
    for row in 0..height {
        for column in 0..width {
            if differs(row, column) {
                (top, bottom) = (top.min(row), bottom.max(row + 1));
                (left, right) = (left.min(column), right.max(column + 1));
            }
        }
    }
    if top >= bottom {
        (top, bottom, left, right) = (0, 1, 0, 1);
    }
    let mut buffer = Vec::with_capacity((bottom - top) * (right - left));
    for row in top..bottom {
        for column in left..right {
            buffer.push(if differs(row, column) {
                now[[row, column]]
            } else {
                transparent
            });
        }
    }
    Ok(Frame {
        dispose: DisposalMethod::Keep,
        transparent: Some(transparent),
        top: u16::try_from(top).unwrap_or(0),
        left: u16::try_from(left).unwrap_or(0),
        width: side(right - left)?,
        height: side(bottom - top)?,
        buffer: buffer.into(),
        ..Frame::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving_line() -> Animation {
        let shot = |x: f64| Shot {
            strokes: vec![Stroke {
                points: vec![(x, 1.0), (x, 8.0)],
                color: Color::BLUE,
                width: 2.0,
            }],
            hold: 5,
        };
        Animation {
            view: [0.0, 0.0, 20.0, 10.0],
            width: 100,
            ground: None,
            shots: (0..10).map(|i| shot(2.0 + f64::from(i))).collect(),
        }
    }

    #[test]
    fn the_same_animation_gives_the_same_bytes_and_starts_like_a_gif() {
        let bytes = moving_line().gif().unwrap();
        assert_eq!(bytes, moving_line().gif().unwrap());
        assert!(bytes.starts_with(b"GIF89a"));
    }

    #[test]
    fn later_frames_hold_only_what_changed() {
        let before = Array2::from_elem((5, 5), 1);
        let mut now = before.clone();
        now[[2, 3]] = 7;
        let frame = changed(Some(&before), &now, 9).unwrap();
        assert_eq!(
            (frame.left, frame.top, frame.width, frame.height),
            (3, 2, 1, 1)
        );
        assert_eq!(frame.buffer.as_ref(), [7]);
    }

    #[test]
    fn an_animation_without_shots_is_refused() {
        let none = Animation {
            shots: Vec::new(),
            ..moving_line()
        };
        assert!(none.gif().is_err());
    }
}
