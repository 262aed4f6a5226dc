//! Planes of numbers, row by row: smoothed, eroded.

/// A plane of numbers.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    pub width: usize,
    pub height: usize,
    pub data: Vec<f32>,
}

impl Plane {
    pub(crate) fn from_fn(
        width: usize,
        height: usize,
        mut at: impl FnMut(usize, usize) -> f32,
    ) -> Self {
        let mut data = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                data.push(at(x, y));
            }
        }
        Self {
            width,
            height,
            data,
        }
    }

    pub(crate) fn map(&self, to: impl Fn(f32) -> f32) -> Self {
        let data = self.data.iter().map(|&v| to(v)).collect();
        Self { data, ..*self }
    }

    /// Smoothed by a Gaussian; at borders the last number is repeated.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "three times a width of a few pixels"
    )]
    pub(crate) fn smoothed(&self, sigma: f32) -> Self {
        let reach = (3.0 * sigma).ceil() as usize;
        let mut weights: Vec<f32> = (0..=reach)
            .map(|k| (-0.5 * (k as f32 / sigma).powi(2)).exp())
            .collect();
        let total = weights[0] + 2.0 * weights[1..].iter().sum::<f32>();
        weights.iter_mut().for_each(|weight| *weight /= total);
        let (width, height) = (self.width, self.height);
        let mut rows = vec![0.0_f32; self.data.len()];
        for y in 0..height {
            let to = &mut rows[y * width..(y + 1) * width];
            for (k, &weight) in weights.iter().enumerate() {
                let mut add = |row: usize, weight: f32| {
                    let from = &self.data[row * width..(row + 1) * width];
                    for (to, from) in to.iter_mut().zip(from) {
                        *to += weight * from;
                    }
                };
                if k == 0 {
                    add(y, weight);
                } else {
                    add(y.saturating_sub(k), weight);
                    add((y + k).min(height - 1), weight);
                }
            }
        }
        let mut data = vec![0.0_f32; self.data.len()];
        let mut line = vec![0.0_f32; width + 2 * reach];
        for y in 0..height {
            let row = &rows[y * width..(y + 1) * width];
            line[..reach].fill(row[0]);
            line[reach..reach + width].copy_from_slice(row);
            line[reach + width..].fill(row[width - 1]);
            let to = &mut data[y * width..(y + 1) * width];
            for (k, &weight) in weights.iter().enumerate() {
                if k == 0 {
                    to.iter_mut()
                        .zip(&line[reach..])
                        .for_each(|(to, v)| *to += weight * v);
                } else {
                    let pair = line[reach - k..].iter().zip(&line[reach + k..]);
                    to.iter_mut()
                        .zip(pair)
                        .for_each(|(to, (a, b))| *to += weight * (a + b));
                }
            }
        }
        Self { data, ..*self }
    }

    /// The least number within a disk of that radius about each place.
    pub(crate) fn eroded(&self, radius: usize) -> Self {
        let (width, height) = (self.width, self.height);
        let mut data = self.data.clone();
        let mut least = vec![0.0_f32; width];
        for down in 0..=radius {
            // half a chord of the disk
            let half = (0..=radius)
                .rev()
                .find(|half| half * half + down * down <= radius * radius)
                .unwrap_or(0);
            for from in 0..height {
                let row = &self.data[from * width..(from + 1) * width];
                least.copy_from_slice(row);
                for k in 1..=half.min(width - 1) {
                    for x in 0..width - k {
                        least[x] = least[x].min(row[x + k]);
                    }
                    for x in k..width {
                        least[x] = least[x].min(row[x - k]);
                    }
                }
                let both = [from.checked_sub(down), (down > 0).then_some(from + down)];
                for y in both.into_iter().flatten().filter(|y| *y < height) {
                    let to = &mut data[y * width..(y + 1) * width];
                    to.iter_mut()
                        .zip(&least)
                        .for_each(|(to, v)| *to = to.min(*v));
                }
            }
        }
        Self { data, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn erosion_is_the_least_of_a_disk() {
        let plane = Plane::from_fn(23, 17, |x, y| ((x * 7 + y * 13) % 31) as f32);
        let eroded = plane.eroded(5);
        for y in 0..17_usize {
            for x in 0..23_usize {
                let mut least = f32::INFINITY;
                for j in 0..17_usize {
                    for i in 0..23_usize {
                        if i.abs_diff(x).pow(2) + j.abs_diff(y).pow(2) <= 25 {
                            least = least.min(plane.data[j * 23 + i]);
                        }
                    }
                }
                assert!((eroded.data[y * 23 + x] - least).abs() < 1e-6, "{x} {y}");
            }
        }
    }

    #[test]
    fn smoothing_keeps_a_constant_and_the_sum() {
        let plane = Plane::from_fn(9, 7, |_, _| 4.0).smoothed(1.0);
        assert!(plane.data.iter().all(|v| (v - 4.0).abs() < 1e-5));
        let point =
            Plane::from_fn(31, 31, |x, y| f32::from(u8::from(x == 15 && y == 15))).smoothed(2.5);
        assert!((point.data.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!((point.data[15 * 31 + 15] - 1.0 / (std::f32::consts::TAU * 6.25)).abs() < 2e-4);
    }
}
