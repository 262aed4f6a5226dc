//! Ends against the eigenvalues every engineer knows: strings and beams, pinned, clamped, free and sliding.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a matrix that is refused should stop it"
)]

use banded::Dense;
use elastic::{End, Hold, Material, Topology, elastic_force, stiffness};
use glam::DVec2;
use std::f64::consts::PI;

/// Length of every rod here.
const LENGTH: f64 = 3.0;

/// The least eigenvalues of K with the held nodes taken out, smallest first.
fn spectrum(head: End, tail: End, material: &Material, n: usize) -> Vec<f64> {
    let topology = Topology::Open { head, tail };
    let k = stiffness(topology, material, LENGTH / (n - 1) as f64, n).unwrap();
    let held = topology.held(n);
    let free: Vec<usize> = (0..n).filter(|&i| !held[i]).collect();
    let inner = Dense::from_fn(free.len(), |i, j| k.entry(free[i], free[j]));
    inner.eigen().unwrap().values
}

/// βL of mode `which` of a beam of rigidity 1, by λ = β⁴.
fn beam(head: End, tail: End, which: usize, n: usize) -> f64 {
    let material = Material::uniform(0.0, 0.0, 1.0);
    spectrum(head, tail, &material, n)[which].powf(0.25) * LENGTH
}

/// Errors at n, 2n and 4n edges, and the two orders between them.
fn orders(error: impl Fn(usize) -> f64) -> [f64; 2] {
    let [a, b, c] = [17, 33, 65].map(|n| error(n).abs());
    [(a / b).log2(), (b / c).log2()]
}

#[test]
fn a_beam_clamped_at_both_ends_has_the_frequencies_of_the_book_at_second_order() {
    // cosh x cos x = 1
    for (which, exact) in [(0, 4.730_040_744_862_704), (1, 7.853_204_624_095_838)] {
        let error = |n| beam(End::Clamped, End::Clamped, which, n) - exact;
        assert!(error(65).abs() < 1e-2, "{}", error(65));
        for order in orders(error) {
            assert!((order - 2.0).abs() < 0.1, "mode {which}: {order}");
        }
    }
}

#[test]
fn a_beam_clamped_at_one_end_and_pinned_at_the_other_is_of_second_order() {
    // tan x = tanh x
    for (which, exact) in [(0, 3.926_602_312_047_919), (1, 7.068_582_745_628_732)] {
        for (head, tail) in [(End::Clamped, End::Pinned), (End::Pinned, End::Clamped)] {
            let error = |n| beam(head, tail, which, n) - exact;
            assert!(error(65).abs() < 1e-2, "{}", error(65));
            for order in orders(error) {
                assert!((order - 2.0).abs() < 0.1, "mode {which}: {order}");
            }
        }
    }
}

#[test]
fn a_cantilever_has_the_frequencies_of_the_book_at_first_order() {
    // cosh x cos x = −1; the free node weighs a whole spacing, not half of one, hence the first order
    for (which, exact) in [(0, 1.875_104_068_711_961), (1, 4.694_091_132_974_175)] {
        let error = |n| beam(End::Clamped, End::Free, which, n) - exact;
        assert!(error(65).abs() < 0.08, "{}", error(65));
        for order in orders(error) {
            assert!((order - 1.0).abs() < 0.1, "mode {which}: {order}");
        }
    }
}

#[test]
fn a_beam_between_nails_has_the_square_of_the_strings_spectrum() {
    // rows of the bends at inner nodes only: with both ends held K is T², exactly
    let n = 20;
    let h = LENGTH / (n - 1) as f64;
    let got = spectrum(
        End::Pinned,
        End::Pinned,
        &Material::uniform(0.3, 2.0, 0.7),
        n,
    );
    for (k, lambda) in (1..).zip(&got) {
        let t = (2.0 / h * (f64::from(k) * PI / (2.0 * (n - 1) as f64)).sin()).powi(2);
        let exact = 0.3 + 2.0 * t + 0.7 * t * t;
        // rounding of an eigenvalue is that of the largest
        assert!((lambda - exact).abs() < 1e-12 * got[n - 3], "mode {k}");
    }
}

#[test]
fn without_rigidity_a_clamped_string_is_a_pinned_one() {
    let material = Material::uniform(0.1, 2.0, 0.0);
    let clamped = spectrum(End::Clamped, End::Clamped, &material, 12);
    assert_eq!(clamped, spectrum(End::Pinned, End::Pinned, &material, 12));
}

#[test]
fn a_clamped_end_leaves_in_its_direction_and_a_pinned_one_does_not() {
    // a rod held at both ends under an even load: the slope at the end, by the first edge
    let slope = |end: End, n: usize| {
        let topology = Topology::open(end);
        let h = LENGTH / (n - 1) as f64;
        let k = stiffness(topology, &Material::uniform(0.0, 0.0, 1.0), h, n).unwrap();
        let inner = Dense::from_fn(n - 2, |i, j| k.entry(i + 1, j + 1));
        inner.solve(&vec![1.0; n - 2]).unwrap()[0] / h
    };
    // e = s²(L−s)²/24 has no slope at the end; e = s(L³−2Ls²+s³)/24 has L³/24
    let order = (slope(End::Clamped, 41) / slope(End::Clamped, 81)).log2();
    assert!((order - 1.0).abs() < 0.1, "a one-sided slope of 0: {order}");
    let pinned = slope(End::Pinned, 81) / (LENGTH.powi(3) / 24.0);
    assert!((pinned - 1.0).abs() < 1e-2, "{pinned}");
}

#[test]
fn an_end_that_slides_is_held_across_the_line_and_free_along_it() {
    // both ends on lines turned by 0.7: across them the string is a pinned one, along them a free one
    let (n, angle) = (14, 0.7_f64);
    let along = DVec2::from_angle(angle);
    let h = LENGTH / (n - 1) as f64;
    let material = Material::uniform(0.0, 1.0, 0.0);
    let free = Topology::open(End::Free);
    let hold = |i: usize| {
        if i == 0 || i == n - 1 {
            Hold::Along(3.0 * along)
        } else {
            Hold::Free
        }
    };
    // the projected force of every unit displacement, x and y side by side
    let column = |j: usize| {
        let axis = if j < n { DVec2::X } else { DVec2::Y };
        let mut e = vec![DVec2::ZERO; n];
        e[j % n] = hold(j % n).project(axis);
        let mut force = vec![DVec2::ZERO; n];
        elastic_force(&e, free, &material, h, &mut force);
        (0..n)
            .map(|i| -hold(i).project(force[i]))
            .collect::<Vec<_>>()
    };
    let columns: Vec<_> = (0..2 * n).map(column).collect();
    let k = Dense::from_fn(2 * n, |i, j| {
        let v = columns[j][i % n];
        if i < n { v.x } else { v.y }
    });
    let got = k.eigen().unwrap().values;
    let t = |angle: f64| (2.0 / h * (angle / 2.0).sin()).powi(2);
    let mut want: Vec<f64> = (1..n - 1)
        .map(|k| t(PI * k as f64 / (n - 1) as f64))
        .chain((0..n).map(|k| t(PI * k as f64 / n as f64)))
        .chain([0.0, 0.0]) // the two directions taken away
        .collect();
    want.sort_by(f64::total_cmp);
    for (a, b) in got.iter().zip(&want) {
        assert!((a - b).abs() < 1e-12 * want[2 * n - 1], "{a} for {b}");
    }
}
