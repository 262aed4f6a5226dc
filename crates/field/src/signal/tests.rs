use super::*;

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_three_smoothings_agree_as_they_should() {
    for signal in [step(), box_()] {
        for passes in [8, 20, 80] {
            let sigma = (f64::from(passes) / 2.0).sqrt();
            let fourier = smooth_fourier(&signal, sigma);
            let direct = smooth_direct(&signal, sigma);
            let binomial = smooth_binomial(&signal, passes);
            // sampling a Gaussian aliases its transform, e^(−π²σ²/2) at most; the rest is rounding of
            // two sums over a hundred cosines
            let bound = (-0.5 * (PI * sigma).powi(2)).exp() + 3e-14;
            let difference = largest_difference(&fourier, &direct);
            assert!(difference < bound, "{passes}: {difference:e}");
            // Edgeworth: the excess kurtosis −1/passes moves a unit step by at most 0.55/(24 · passes)
            // = 0.023/passes, and the next term is 1/passes of that
            let step_bound = 0.025 / f64::from(passes);
            let edges = if signal[99] > 0.5 { 1.0 } else { 2.0 };
            let difference = largest_difference(&direct, &binomial);
            assert!(difference < edges * step_bound, "{passes}: {difference:e}");
            // and the bound means something: it is not far above what is seen
            assert!(difference > 0.5 * step_bound, "{passes}: {difference:e}");
        }
    }
}

#[test]
fn a_narrow_gaussian_is_where_sampling_it_begins_to_tell() {
    let (fourier, direct) = (smooth_fourier(&step(), 0.5), smooth_direct(&step(), 0.5));
    let difference = largest_difference(&fourier, &direct);
    assert!(difference > 1e-4 && difference < 0.05, "{difference}");
}

#[test]
fn d35_weights_sum_to_one_in_one_dimension() {
    for sigma in [0.3, 1.0, 3.1623, 20.0] {
        let w = gaussian_weights(sigma);
        let sum = w[0] + 2.0 * w[1..].iter().sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-14);
    }
    // for σ ≥ 1 the sampled peak is the continuous one-dimensional peak 1/(√(2π) σ), not 1/(2π σ²)
    let sigma = 10.0_f64.sqrt();
    let peak = gaussian_weights(sigma)[0];
    assert!((peak - 1.0 / ((2.0 * PI).sqrt() * sigma)).abs() < 1e-14);
    assert!((peak - 1.0 / (2.0 * PI * sigma * sigma)).abs() > 0.1);
}

#[test]
fn d36_a_pass_has_variance_one_half() {
    let mut spike = vec![0.0; 101];
    spike[50] = 1.0;
    for passes in [1, 7, 20] {
        let smoothed = smooth_binomial(&spike, passes);
        let variance: f64 = smoothed
            .iter()
            .enumerate()
            .map(|(i, s)| s * (i as f64 - 50.0).powi(2))
            .sum();
        assert!((variance - f64::from(passes) / 2.0).abs() < 1e-12);
        let sigma = crate::Smoothing::Binomial(passes).sigma();
        assert!((sigma * sigma - variance).abs() < 1e-12);
    }
}

#[test]
fn d41_masks_used_as_correlation_would_turn_the_second_derivative_round() {
    // abs() hides the first sign, not the second
    let smoothed = smooth_binomial(&step(), 20);
    let correlate = |s: &[f64]| -> Vec<f64> { first_derivative(s).iter().map(|d| -d).collect() };
    let strength: Vec<f64> = correlate(&smoothed).iter().map(|d| d.abs()).collect();
    for (wrong, right) in correlate(&strength).iter().zip(force(&smoothed)) {
        assert_eq!(wrong.to_bits() & !(1 << 63), right.to_bits() & !(1 << 63));
        assert!(wrong * right <= 0.0);
    }
}

/// Zeros of the force with falling slope, that is where a point comes to rest, in the report's count.
fn resting_places(force: &[f64]) -> Vec<f64> {
    let zero = |i: usize| i as f64 + 1.0 + force[i] / (force[i] - force[i + 1]);
    (0..force.len() - 1)
        .filter(|&i| force[i] > 1e-9 && force[i + 1] <= 0.0)
        .map(zero)
        .collect()
}

#[test]
fn d45_the_force_is_exactly_zero_beyond_21_and_a_half_pixels() {
    let f = force(&smooth_binomial(&step(), 20));
    for (i, f) in f.iter().enumerate() {
        let distance = (i as f64 + 1.0 - 50.5).abs();
        assert_eq!(*f != 0.0, distance <= 21.5, "at {distance}");
    }
}

#[test]
fn d46_the_steps_edge_is_at_50_5_and_the_boxs_at_35_5_and_64_5() {
    let of = |signal: &[f64]| resting_places(&force(&smooth_binomial(signal, 20)));
    assert_eq!(of(&step()), [50.5]);
    let edges = of(&box_());
    assert_eq!(edges.len(), 2);
    assert!(
        (edges[0] - 35.5).abs() < 2e-3 && (edges[1] - 64.5).abs() < 2e-3,
        "{edges:?}"
    );
}

#[test]
fn figure_4_3_the_second_derivative_is_turned_round_at_the_falling_edge() {
    let smoothed = smooth_binomial(&box_(), 20);
    let (second, right) = (second_derivative(&smoothed), force(&smoothed));
    // three pixels outside each edge (report x = 32 and 68): a force should point to the edge
    assert!(second[31] > 0.0 && right[31] > 0.0);
    assert!(second[67] > 0.0 && right[67] < 0.0);
}

#[test]
fn d44_edges_near_the_border_are_displaced_inwards() {
    for (edge, found) in [(3, 4.35), (4, 4.84), (6, 6.51), (8, 8.50)] {
        let signal: Vec<f64> = (1..=100)
            .map(|x| if x > edge { 1.0 } else { 0.0 })
            .collect();
        let rest = resting_places(&force(&smooth_binomial(&signal, 20)));
        assert!((rest[0] - found).abs() < 0.005, "edge {edge}.5: {rest:?}");
    }
}

#[test]
fn d47_two_close_edges_repel_each_other() {
    for (width, outside, within) in [
        (2, 2.4, 0.05),
        (4, 1.5, 0.05),
        (6, 0.85, 0.005),
        (8, 0.34, 0.005),
        (12, 0.014, 0.0005),
    ] {
        let bar: Vec<f64> = (1..=100)
            .map(|x| if x > 50 && x <= 50 + width { 1.0 } else { 0.0 })
            .collect();
        let rest = resting_places(&force(&smooth_binomial(&bar, 20)));
        assert!(
            (50.5 - rest[0] - outside).abs() < within,
            "{width}: {rest:?}"
        );
        let right = rest[rest.len() - 1];
        assert!(
            (right - (50.5 + f64::from(width)) - outside).abs() < within,
            "{width}: {rest:?}"
        );
    }
}

#[test]
fn peak_force_and_slope_at_an_isolated_edge() {
    // errata §3.3: at the report's scale 0.15 A · 0.90072 and 0.15 A · 0.44504; 40 = 2 · 2 · 10
    let f = force(&smooth_binomial(&step(), 20));
    let peak = 40.0 * f.iter().copied().fold(0.0, f64::max);
    assert!((peak - 0.90072).abs() < 5e-6, "{peak}");
    assert!(0.15 * peak > 0.1350 && 0.15 * peak < 0.1352);
    let at = f.iter().position(|&v| 40.0 * v >= peak).unwrap_or(0);
    let distance = 50.5 - (at as f64 + 1.0);
    assert!((3.0..=4.0).contains(&distance), "{distance}");
    let slope = 40.0 * (f[49] - f[50]);
    assert!((slope - 0.44504).abs() < 5e-6, "{slope}");
}

#[test]
fn short_signals_are_fine() {
    for n in 0..4 {
        let signal = vec![3.0; n];
        assert_eq!(smooth_binomial(&signal, 5), signal);
        assert_eq!(force(&signal), vec![0.0; n]);
        assert_eq!(second_derivative(&signal), vec![0.0; n]);
        assert!(largest_difference(&smooth_direct(&signal, 2.0), &signal) < 1e-14);
        assert!(largest_difference(&smooth_fourier(&signal, 2.0), &signal) < 1e-14);
    }
}
