//! A small two-dimensional Fourier transform: radix 2, in place, sides a power of two.

use glam::DVec2;
use std::f64::consts::TAU;

/// Complex numbers (real part x, imaginary part y) on a rectangle whose sides are powers of two.
#[derive(Debug)]
pub(super) struct Plane {
    values: Vec<DVec2>,
    height: usize,
    width: usize,
}

impl Plane {
    pub(super) fn zeros((height, width): (usize, usize)) -> Self {
        debug_assert!(
            height.is_power_of_two() && width.is_power_of_two(),
            "sides are powers of two"
        );
        Self {
            values: vec![DVec2::ZERO; height * width],
            height,
            width,
        }
    }

    pub(super) fn set(&mut self, row: usize, column: usize, value: DVec2) {
        self.values[row * self.width + column] = value;
    }

    pub(super) fn get(&self, row: usize, column: usize) -> DVec2 {
        self.values[row * self.width + column]
    }

    /// Pixel by pixel: this times `other`.
    pub(super) fn multiply(&mut self, other: &Self) {
        for (a, &b) in self.values.iter_mut().zip(&other.values) {
            *a = product(*a, b);
        }
    }

    /// The transform, or its inverse with the factor 1/pixels.
    pub(super) fn transform(&mut self, inverse: bool) {
        let roots = Roots::new(self.width, inverse);
        for row in self.values.chunks_exact_mut(self.width) {
            roots.line(row);
        }
        let roots = Roots::new(self.height, inverse);
        let mut column = vec![DVec2::ZERO; self.height];
        for x in 0..self.width {
            for (y, value) in column.iter_mut().enumerate() {
                *value = self.values[y * self.width + x];
            }
            roots.line(&mut column);
            for (y, &value) in column.iter().enumerate() {
                self.values[y * self.width + x] = value;
            }
        }
        if inverse {
            let factor = 1.0 / self.values.len() as f64;
            self.values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}

fn product(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// Roots of unity for lines of one length.
struct Roots(Vec<DVec2>);

impl Roots {
    fn new(n: usize, inverse: bool) -> Self {
        let turn = if inverse { TAU } else { -TAU };
        Self(
            (0..n / 2)
                .map(|k| DVec2::from_angle(turn * k as f64 / n as f64))
                .collect(),
        )
    }

    /// Transforms one line: bit reversal, then butterflies.
    fn line(&self, values: &mut [DVec2]) {
        let n = values.len();
        let bits = n.trailing_zeros();
        if bits == 0 {
            return;
        }
        for i in 0..n {
            let j = i.reverse_bits() >> (usize::BITS - bits);
            if i < j {
                values.swap(i, j);
            }
        }
        let mut half = 1;
        while half < n {
            let stride = n / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                    let turned = product(*b, self.0[k * stride]);
                    (*a, *b) = (*a + turned, *a - turned);
                }
            }
            half *= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_defining_sum_and_its_inverse_goes_back() {
        for dim in [(1, 1), (1, 8), (4, 2), (8, 16)] {
            let mut plane = Plane::zeros(dim);
            for (i, value) in plane.values.iter_mut().enumerate() {
                *value = DVec2::new((i * 7 % 13) as f64, (i * 5 % 11) as f64);
            }
            let before = plane.values.clone();
            plane.transform(false);
            for v in 0..dim.0 {
                for u in 0..dim.1 {
                    let term = |(i, &value): (usize, &DVec2)| {
                        let (y, x) = (i / dim.1, i % dim.1);
                        let turn = (u * x) as f64 / dim.1 as f64 + (v * y) as f64 / dim.0 as f64;
                        product(value, DVec2::from_angle(-TAU * turn))
                    };
                    let sum: DVec2 = before.iter().enumerate().map(term).sum();
                    assert!((sum - plane.get(v, u)).length() < 1e-10);
                }
            }
            plane.transform(true);
            for (a, b) in plane.values.iter().zip(&before) {
                assert!((a - b).length() < 1e-12);
            }
        }
    }
}
