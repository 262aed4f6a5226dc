//! Parts of a picture as they are shown, at any size of picture.

use io::Picture;

use crate::LiveError;

/// Pixels of a tile along each side.
pub(crate) const SIDE: usize = 256;

/// The coarsest level: a pixel of it is so many, as a power of two.
const COARSEST: u32 = 16;

/// Looks at the picture for one pixel of a coarse tile, each way.
const LOOKS: usize = 3;

/// How levels become tones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tones {
    /// Levels that become black and white, of 255.
    pub low: f64,
    pub high: f64,
    /// 1 leaves tones as they are, more makes them lighter.
    pub gamma: f64,
}

/// A tile as red, green, blue and opacity of each of its pixels; beyond the picture it is clear.
pub(crate) fn tile(
    picture: &Picture,
    level: u32,
    (x, y): (usize, usize),
    tones: Tones,
) -> Result<Vec<u8>, LiveError> {
    if level > COARSEST {
        return Err(LiveError::new(format!(
            "a tile must be of level {COARSEST} at most, got {level}"
        )));
    }
    let Tones { low, high, gamma } = tones;
    if !(low.is_finite() && high > low && high.is_finite() && gamma > 0.0 && gamma.is_finite()) {
        return Err(LiveError::new(format!(
            "tones must go from a level to a higher one with a gamma above 0, got {low}, {high}, {gamma}"
        )));
    }
    let (width, height) = picture.size();
    let scale = 1_usize << level;
    let looks = scale.min(LOOKS);
    let mut out = vec![0; 4 * SIDE * SIDE];
    let first = |at: usize, i: usize| {
        at.saturating_mul(SIDE)
            .saturating_add(i)
            .saturating_mul(scale)
    };
    for j in 0..SIDE {
        let top = first(y, j);
        if top >= height {
            break;
        }
        for i in 0..SIDE {
            let left = first(x, i);
            if left >= width {
                break;
            }
            let (mut sum, mut count) = ([0.0; 3], 0.0);
            for b in 0..looks {
                for a in 0..looks {
                    let px = (left + (2 * a + 1) * scale / (2 * looks)).min(width - 1);
                    let py = (top + (2 * b + 1) * scale / (2 * looks)).min(height - 1);
                    let color = picture.color_at(px, py);
                    (0..3).for_each(|c| sum[c] += color[c]);
                    count += 1.0;
                }
            }
            let valid = picture.valid().is_none_or(|valid| valid[[top, left]]);
            let pixel = &mut out[4 * (j * SIDE + i)..][..4];
            for c in 0..3 {
                let share = ((sum[c] / count - low) / (high - low)).clamp(0.0, 1.0);
                pixel[c] = byte(share.powf(gamma.recip()));
            }
            pixel[3] = if valid { 255 } else { 96 };
        }
    }
    Ok(out)
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 0 to 255"
)]
fn byte(share: f64) -> u8 {
    (255.0 * share).round() as u8
}

/// Tones that show most of what a picture has: all levels where they are those of a screen.
pub(crate) fn usual(picture: &Picture) -> Tones {
    let [least, low, high, most] = picture.grey_limits();
    let screen = least >= 0.0 && most <= 255.0 && high - low > 64.0;
    let (low, high) = if screen {
        (0.0, 255.0)
    } else if high > low {
        (low, high)
    } else if most > least {
        (least, most)
    } else {
        (least - 0.5, least + 0.5)
    };
    Tones {
        low,
        high,
        gamma: 1.0,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop the process")]
mod tests {
    use super::*;
    use scene::field::Grid;

    const PLAIN: Tones = Tones {
        low: 0.0,
        high: 255.0,
        gamma: 1.0,
    };

    #[test]
    fn a_tile_shows_its_part_of_the_picture_and_nothing_beyond_it() {
        let level = |(y, x): (usize, usize)| ((x + 2 * y) % 251) as f64;
        let picture = Picture::from_levels(Grid::from_shape_fn((300, 400), level));
        let shown = tile(&picture, 0, (1, 1), PLAIN).unwrap();
        let at = |i: usize, j: usize| &shown[4 * (j * SIDE + i)..][..4];
        assert_eq!(at(0, 0)[0], ((256 + 512) % 251) as u8);
        assert_eq!(at(10, 20)[0], ((266 + 2 * 276) % 251) as u8);
        assert_eq!(at(10, 20)[3], 255);
        assert_eq!(at(144, 0), [0; 4]);
        assert_eq!(at(0, 44), [0; 4]);
        let coarse = tile(&picture, 1, (0, 0), PLAIN).unwrap();
        assert!(coarse[4 * (149 * SIDE + 199) + 3] == 255 && coarse[4 * (150 * SIDE) + 3] == 0);
        assert!(tile(&picture, 99, (0, 0), PLAIN).is_err());
        let no = Tones { high: 0.0, ..PLAIN };
        assert!(tile(&picture, 0, (0, 0), no).is_err());
        assert!(tile(&picture, 16, (usize::MAX, usize::MAX), PLAIN).is_ok());
    }
}
