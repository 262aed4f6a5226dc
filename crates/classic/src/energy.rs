//! What attracts: the weighted sum of a picture's levels and the size of their Sobel gradient.

use crate::spline::{Spline, Stretch};
use crate::{ClassicError, Rules};

/// A picture whose levels are asked for pixel by pixel.
#[derive(Debug, Clone, Copy)]
pub struct Picture<F> {
    /// Rows.
    pub height: usize,
    /// Columns.
    pub width: usize,
    /// Channels: their levels and gradients are added up, the gradients of the first three only.
    pub channels: usize,
    /// The level at a row and a column of a channel.
    pub level: F,
}

/// Channels whose gradients count: a fourth says how opaque a pixel is.
const COLORS: usize = 3;

/// Pixels that there is room for: 1 GiB for each of three stages.
const MOST_PIXELS: u64 = 1 << 27;

impl<F: Fn(usize, usize, usize) -> f64> Picture<F> {
    /// Refuse a picture that has no spline.
    pub(crate) fn check(&self) -> Result<(), ClassicError> {
        let (height, width, channels) = (self.height, self.width, self.channels);
        if height < 3 || width < 3 || channels == 0 {
            return Err(ClassicError::Small {
                height,
                width,
                channels,
            });
        }
        for row in 0..height {
            for channel in 0..channels {
                let level = |column| (self.level)(row, column, channel);
                // a sum is finite if all of it is, but for what overflows
                if (0..width).map(level).sum::<f64>().is_finite() {
                    continue;
                }
                if let Some(column) = (0..width).find(|column| !level(*column).is_finite()) {
                    let got = level(column);
                    return Err(ClassicError::Level { row, column, got });
                }
            }
        }
        Ok(())
    }

    /// The spline of the energy over the pixels from `low` to `high`, columns first.
    pub(crate) fn spline(
        &self,
        rules: &Rules,
        low: [usize; 2],
        high: [usize; 2],
    ) -> Result<Spline, ClassicError> {
        let across = Stretch::around(low[0], high[0], self.width);
        let down = Stretch::around(low[1], high[1], self.height);
        let pixels = across.len as u64 * down.len as u64;
        if pixels > MOST_PIXELS {
            let most = MOST_PIXELS;
            return Err(ClassicError::Large { pixels, most });
        }
        let mut values = vec![0.0; across.len * down.len];
        for channel in 0..self.channels {
            let edge = if channel < COLORS { rules.w_edge } else { 0.0 };
            self.add(&mut values, (across, down), channel, [rules.w_line, edge]);
        }
        Ok(Spline::new(
            values,
            (across, down),
            (self.width, self.height),
        ))
    }

    /// Add what attracts in one channel, with the weights of its levels and of its gradient.
    fn add(
        &self,
        values: &mut [f64],
        (across, down): (Stretch, Stretch),
        channel: usize,
        weights: [f64; 2],
    ) {
        let [line, edge] = weights;
        // a line of levels and one more at either end; beyond the picture the last level is repeated
        let read = |row: usize, out: &mut Vec<f64>| {
            out.clear();
            let level = |column| (self.level)(row, column, channel);
            let (from, to) = (across.low, across.low + across.len);
            out.push(level(from.saturating_sub(1)));
            out.extend((from..to).map(level));
            out.push(level(to.min(self.width - 1)));
        };
        let [mut above, mut here, mut below] = [const { Vec::new() }; 3];
        read(down.low.saturating_sub(1), &mut above);
        read(down.low, &mut here);
        for (k, out) in values.chunks_exact_mut(across.len).enumerate() {
            read((down.low + k + 1).min(self.height - 1), &mut below);
            for (x, out) in out.iter_mut().enumerate() {
                let [a, h, b] = [&above, &here, &below].map(|line| &line[x..x + 3]);
                let down = (b[0] - a[0]) + 2.0 * (b[1] - a[1]) + (b[2] - a[2]);
                let along = (a[2] - a[0]) + 2.0 * (h[2] - h[0]) + (b[2] - b[0]);
                // a quarter of the sum of differences over two pixels, and the mean of both squares
                let size = 0.25 * (0.5 * (down * down + along * along)).sqrt();
                *out += line * h[1] + edge * size;
            }
            std::mem::swap(&mut above, &mut here);
            std::mem::swap(&mut here, &mut below);
        }
    }
}
