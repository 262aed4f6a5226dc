//! Axes with round numbers.

use glam::DVec2;
use image::RgbImage;

use crate::paint::{Lettering, draw_curve, draw_text};

/// Of lines and letters.
pub(super) const INK: [u8; 3] = [30, 30, 30];

/// Numbers from one to another that are multiples of 1, 2 or 5 times a power of ten, `most` of them at most.
pub(super) fn ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return if low.is_finite() {
            vec![low]
        } else {
            Vec::new()
        };
    }
    let least = span / most.max(1) as f64;
    let power = 10.0_f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|k| k * power)
        .into_iter()
        .find(|step| *step >= least * (1.0 - 1e-9));
    let step = step.unwrap_or(10.0 * power);
    let mut list = Vec::new();
    let mut at = (low / step - 1e-9).ceil();
    while at * step <= high + 1e-9 * span && list.len() <= most + 2 {
        // no zero has a sign
        list.push(at * step + 0.0);
        at += 1.0;
    }
    list
}

/// Numbers in words, all with as many decimals as tell them apart.
pub(super) fn named(ticks: &[f64]) -> Vec<String> {
    let step = ticks
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(f64::INFINITY, f64::min);
    let largest = ticks
        .iter()
        .fold(0.0_f64, |most, tick| most.max(tick.abs()));
    let step = if step.is_finite() { step } else { largest };
    if step > 0.0 && !(1e-4..1e6).contains(&step) {
        return ticks
            .iter()
            .map(|tick| format!("{tick:.1e}").replace('-', "\u{2212}"))
            .collect();
    }
    let decimals = (0..6_usize).find(|&d| {
        let scaled = step * 10.0_f64.powi(i32::try_from(d).unwrap_or(0));
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
    });
    let decimals = decimals.unwrap_or(6);
    ticks
        .iter()
        .map(|tick| format!("{tick:.decimals$}").replace('-', "\u{2212}"))
        .collect()
}

/// A line between two places, a pixel wide.
pub(super) fn line(image: &mut RgbImage, from: DVec2, to: DVec2) {
    draw_curve(image, &[from, to], false, 1.0, INK);
}

/// A text whose place is its beginning (0), its middle (0.5) or its end (1).
pub(super) fn write(image: &mut RgbImage, at: DVec2, text: &str, height: f64, before: f64) {
    draw_text(
        image,
        at,
        text,
        &Lettering {
            height,
            before,
            color: INK,
            ..Lettering::default()
        },
    );
}

/// A text that runs upwards, its middle at a place.
pub(super) fn write_upwards(image: &mut RgbImage, at: DVec2, text: &str, height: f64) {
    let how = Lettering {
        height,
        before: 0.5,
        color: INK,
        upwards: true,
        ..Lettering::default()
    };
    draw_text(image, at, text, &how);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_an_axis_are_round() {
        let said = |low, high, most| named(&ticks(low, high, most)).join(" ");
        assert_eq!(said(0.0, 36.0, 8), "0 5 10 15 20 25 30 35");
        assert_eq!(said(-2.5, 2.5, 6), "\u{2212}2 \u{2212}1 0 1 2");
        assert_eq!(said(0.0, 1.0, 6), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(
            said(-0.05, 0.05, 5),
            "\u{2212}0.04 \u{2212}0.02 0.00 0.02 0.04"
        );
        assert_eq!(said(0.0, 2e-7, 3), "0.0e0 1.0e\u{2212}7 2.0e\u{2212}7");
        assert_eq!(said(3.0, 3.0, 5), "3");
        assert_eq!(said(0.0, f64::INFINITY, 5), "0");
        assert_eq!(said(f64::NAN, f64::NAN, 5), "");
    }
}
