//! Kernels of any order against a dense twin, the quick way of order two, and the continuum.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "a test may stop, one that says equal means equal, and counts here are small"
)]

use banded::{BandedFactor, Dense};
use elastic::{End, Kernel, Material, Profile, Topology, elastic_energy, elastic_force, stiffness};
use glam::DVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

/// The same cases at every run.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(1988),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn any_topology() -> impl Strategy<Value = Topology> {
    let end = || {
        prop_oneof![
            Just(End::Free),
            Just(End::Anchored),
            Just(End::Pinned),
            Just(End::Clamped)
        ]
    };
    prop_oneof![
        1 => Just(Topology::Closed),
        2 => (end(), end()).prop_map(|(head, tail)| Topology::Open { head, tail }),
    ]
}

fn any_profile(n: usize) -> impl Strategy<Value = Profile> {
    let value = || prop_oneof![1 => Just(0.0), 4 => 0.0..5.0];
    prop_oneof![
        value().prop_map(Profile::Uniform),
        prop::collection::vec(value(), n).prop_map(Profile::PerNode),
    ]
}

fn any_points(n: usize) -> impl Strategy<Value = Vec<DVec2>> {
    let point = (-3.0..3.0, -3.0..3.0).prop_map(|(x, y)| DVec2::new(x, y));
    prop::collection::vec(point, n)
}

/// A topology, a kernel, a spacing and a deformation; nodes enough for some tiles.
fn any_case(
    orders: std::ops::RangeInclusive<usize>,
) -> impl Strategy<Value = (Topology, Kernel, f64, Vec<DVec2>)> {
    (any_topology(), orders, 0_usize..160).prop_flat_map(|(topology, p, more)| {
        let n = more
            + if topology.is_closed() {
                2 * p + 5
            } else {
                p + 3
            };
        let weights = prop::collection::vec(any_profile(n), p + 1);
        (weights, 0.6..2.0, any_points(n))
            .prop_map(move |(weights, h, e)| (topology, Kernel { weights }, h, e))
    })
}

/// K by the book: a chain of virtual nodes, difference after difference as matrices, rows chosen by hand.
fn twin(topology: Topology, kernel: &Kernel, h: f64, n: usize) -> Vec<Vec<f64>> {
    let p = kernel.order();
    let mut k = vec![vec![0.0; n]; n];
    for (m, weight) in kernel.weights.iter().enumerate() {
        // all rows of order m whose first node is between −p and n
        for first in -(p as isize)..=n as isize {
            // the difference as a function of the first node's index, by its recursion
            let mut coefficients = vec![1.0];
            for _ in 0..m {
                let mut next = vec![0.0; coefficients.len() + 1];
                for (j, c) in coefficients.iter().enumerate() {
                    next[j] -= c;
                    next[j + 1] += c;
                }
                coefficients = next;
            }
            let nodes: Vec<isize> = (0..=m as isize).map(|j| first + j).collect();
            let real = |i: isize| (0..n as isize).contains(&i);
            let (last, end) = (first + m as isize, n as isize - 1);
            // a clamped end has one node beyond it, and differences whose middle is not
            let inside = match topology {
                Topology::Closed => real(first),
                Topology::Open { head, tail } => {
                    let before = match head {
                        End::Anchored => last >= 0,
                        End::Clamped => first >= -1 && first + last >= 0,
                        End::Free | End::Pinned => first >= 0,
                    };
                    let after = match tail {
                        End::Anchored => first <= end,
                        End::Clamped => last <= end + 1 && first + last <= 2 * end,
                        End::Free | End::Pinned => last <= end,
                    };
                    before && after
                }
            };
            if !inside {
                continue;
            }
            let (clamped_head, clamped_tail) = match topology {
                Topology::Closed => (false, false),
                Topology::Open { head, tail } => (head == End::Clamped, tail == End::Clamped),
            };
            // its middle is the end itself: half of it is a mirror image
            let halved = clamped_head && first < 0 && first + last == 0
                || clamped_tail && last > end && first + last == 2 * end;
            let share = if halved { 0.5 } else { 1.0 };
            let middle = first + (m / 2) as isize;
            let index = if topology.is_closed() {
                middle.rem_euclid(n as isize)
            } else {
                middle.clamp(0, n as isize - 1)
            };
            let w = share * weight.at(usize::try_from(index).unwrap()) / h.powi(2 * m as i32);
            for (a, ca) in nodes.iter().zip(&coefficients) {
                for (b, cb) in nodes.iter().zip(&coefficients) {
                    let place = |i: isize| {
                        if topology.is_closed() {
                            Some(i.rem_euclid(n as isize))
                        } else if clamped_head && i == -1 {
                            Some(1)
                        } else if clamped_tail && i == end + 1 {
                            Some(end - 1)
                        } else {
                            real(i).then_some(i)
                        }
                    };
                    if let (Some(a), Some(b)) = (place(*a), place(*b)) {
                        k[usize::try_from(a).unwrap()][usize::try_from(b).unwrap()] += w * ca * cb;
                    }
                }
            }
        }
    }
    k
}

fn force(kernel: &Kernel, topology: Topology, h: f64, e: &[DVec2]) -> Vec<DVec2> {
    kernel.validate(topology, h, e.len()).unwrap();
    let mut force = vec![DVec2::NAN; e.len()];
    kernel.force(e, topology, h, &mut force);
    force
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn force_energy_and_matrix_of_any_order_are_those_of_the_dense_twin(
        (topology, kernel, h, e) in any_case(0..=6),
    ) {
        let n = e.len();
        let k = twin(topology, &kernel, h, n);
        let band = kernel.stiffness(topology, h, n).unwrap();
        let scale = 1.0 + kernel.bound(h);
        let got = force(&kernel, topology, h, &e);
        let mut form = 0.0;
        for i in 0..n {
            let want: DVec2 = (0..n).map(|j| -k[i][j] * e[j]).sum();
            form -= want.dot(e[i]);
            // some dozen roundings of terms of this size
            prop_assert!((got[i] - want).length() < 1e-13 * scale, "node {}: {} for {}", i, got[i], want);
            for j in 0..n {
                prop_assert!((band.entry(i, j) - k[i][j]).abs() < 1e-14 * scale);
            }
        }
        let energy: f64 = kernel.energy(&e, topology, h).iter().sum();
        prop_assert!((energy - 0.5 * h * form).abs() < 1e-13 * scale * n as f64);
    }

    #[test]
    fn a_kernel_of_any_order_is_its_material_to_rounding((topology, kernel, h, e) in any_case(0..=6)) {
        let n = e.len();
        let material = kernel.to_material();
        let scale = 1.0 + kernel.bound(h);
        let mut quick = vec![DVec2::NAN; n];
        elastic_force(&e, topology, &material, h, &mut quick);
        for (a, b) in force(&kernel, topology, h, &e).iter().zip(&quick) {
            prop_assert!((*a - *b).length() < 1e-13 * scale);
        }
        let (a, b) = (kernel.energy(&e, topology, h), elastic_energy(&e, topology, &material, h));
        let a = [a[0], a[1], a[2], a[3..].iter().sum::<f64>()];
        for (a, b) in a.iter().zip([b.tether, b.tension, b.rigidity, b.higher]) {
            prop_assert!((a - b).abs() <= 1e-13 * b);
        }
        let (a, b) = (
            kernel.stiffness(topology, h, n).unwrap(),
            stiffness(topology, &material, h, n).unwrap(),
        );
        for i in 0..n {
            for j in 0..n {
                prop_assert!((a.entry(i, j) - b.entry(i, j)).abs() <= 1e-14 * scale);
            }
        }
    }

    #[test]
    fn no_eigenvalue_of_any_order_leaves_its_bounds((topology, kernel, h, e) in any_case(0..=6)) {
        let k = twin(topology, &kernel, h, e.len());
        let values = Dense::from_fn(e.len(), |i, j| k[i][j]).eigen().unwrap().values;
        let bound = kernel.bound(h);
        prop_assert!(values[0] >= -1e-13 * bound, "{}", values[0]);
        prop_assert!(values[e.len() - 1] <= bound * (1.0 + 1e-13));
    }
}

#[test]
fn a_shift_of_an_untethered_curve_of_any_order_makes_exactly_no_force() {
    for topology in [Topology::Closed, Topology::open(End::Free)] {
        for p in 1..=6 {
            let mut weights = vec![3.0; p + 1];
            weights[0] = 0.0;
            let e = vec![DVec2::new(0.1, -1e9); 150];
            let got = force(&Kernel::uniform(&weights), topology, 0.3, &e);
            assert!(got.iter().all(|f| *f == DVec2::ZERO), "order {p}");
        }
    }
}

#[test]
fn between_free_ends_order_m_is_blind_to_polynomials_below_m_and_exact_at_m() {
    let (n, h) = (80, 0.5);
    let free = Topology::open(End::Free);
    for m in 1..=6 {
        let mut weights = vec![0.0; m + 1];
        weights[m] = 2.0;
        let kernel = Kernel::uniform(&weights);
        // ∏ (s − j h): a whole multiple of h^m, so that nothing is rounded
        let power = |i: usize, degree: usize| -> f64 {
            (0..degree).map(|j| h * (i as f64 - j as f64)).product()
        };
        for degree in 0..m {
            let e: Vec<_> = (0..n).map(|i| DVec2::new(power(i, degree), 0.0)).collect();
            let got = force(&kernel, free, h, &e);
            assert!(got.iter().all(|f| *f == DVec2::ZERO), "order {m}: {degree}");
        }
        let e: Vec<_> = (0..n).map(|i| DVec2::new(power(i, m), 0.0)).collect();
        let factorial: f64 = (1..=m).map(|k| k as f64).product();
        // ½ ω (m!)² over the n − m differences
        let want = 0.5 * 2.0 * factorial * factorial * h * (n - m) as f64;
        let got = kernel.energy(&e, free, h);
        assert_eq!(got[m], want, "order {m}");
        assert_eq!(got[..m], [0.0; 6][..m]);
    }
}

#[test]
fn waves_round_a_ring_are_modes_of_every_order_and_converge_at_second_order() {
    let (length, waves) = (10.0, 3.0);
    let wave = TAU * waves / length;
    for p in 1..=6 {
        // each order with a say of its own
        let weights: Vec<f64> = (0..=p).map(|m| wave.powi(-2 * m as i32)).collect();
        let kernel = Kernel::uniform(&weights);
        let eigenvalue = |n: usize| {
            let h = length / n as f64;
            let e: Vec<_> = (0..n)
                .map(|i| DVec2::from_angle(wave * h * i as f64))
                .collect();
            let sine = 2.0 * (0.5 * wave * h).sin() / h;
            let exact: f64 = (0..=p).map(|m| weights[m] * sine.powi(2 * m as i32)).sum();
            for (f, e) in force(&kernel, Topology::Closed, h, &e).iter().zip(&e) {
                assert!((*f + exact * *e).length() < 1e-13 * kernel.bound(h), "{p}");
            }
            exact
        };
        // the continuum: Σ ω_m k²ᵐ, every term 1
        let error = |n| (eigenvalue(n) - (p + 1) as f64).abs();
        let orders = [60, 120, 240].map(|n| (error(n) / error(2 * n)).log2());
        for order in orders {
            assert!((order - 2.0).abs() < 0.05, "p = {p}: {orders:?}");
        }
    }
}

#[test]
fn profiles_of_even_order_converge_to_equation_2_9_at_second_order_and_odd_ones_at_first() {
    let length = 10.0;
    let a = TAU / length;
    for m in 0..=4_usize {
        // ω(s) = 2 + sin a s, e = sin(2 a s + 0.3): derivatives are quarter turns
        let omega = |j: usize, s: f64| {
            f64::from(u8::from(j == 0)) * 2.0
                + a.powi(j as i32) * (a * s + j as f64 * TAU / 4.0).sin()
        };
        let e = |j: usize, s: f64| {
            (2.0 * a).powi(j as i32) * (2.0 * a * s + 0.3 + j as f64 * TAU / 4.0).sin()
        };
        let exact = |s: f64| {
            let mut binomial = 1.0;
            let mut sum = 0.0;
            for j in 0..=m {
                sum += binomial * omega(j, s) * e(2 * m - j, s);
                binomial *= (m - j) as f64 / (j + 1) as f64;
            }
            if m.is_multiple_of(2) { -sum } else { sum }
        };
        let error = |n: usize| {
            let h = length / n as f64;
            let mut weights = vec![Profile::Uniform(0.0); m + 1];
            weights[m] = Profile::PerNode((0..n).map(|i| omega(0, h * i as f64)).collect());
            let nodes: Vec<_> = (0..n)
                .map(|i| DVec2::new(0.0, e(0, h * i as f64)))
                .collect();
            let got = force(&Kernel { weights }, Topology::Closed, h, &nodes);
            (0..n)
                .map(|i| (got[i].y - exact(h * i as f64)).abs())
                .fold(0.0, f64::max)
        };
        if m == 0 {
            assert!(error(80) < 1e-14, "no difference, no error");
            continue;
        }
        let order = (error(80) / error(160)).log2();
        let known = if m.is_multiple_of(2) { 2.0 } else { 1.0 };
        // the next term of the series: a seventh at these n; finer nodes would show rounding by 1/h⁸
        assert!((order - known).abs() < 0.15, "order {m}: {order}");
    }
}

#[test]
fn a_wide_band_is_solved_in_its_own_width() {
    // an implicit step needs (I + K)⁻¹: what is solved is what the force gives back
    let (n, h) = (90, 0.9);
    let kernel = Kernel::uniform(&[0.0, 1.0, 2.0, 0.5, 0.25]);
    for topology in [Topology::Closed, Topology::open(End::Free)] {
        let mut a = kernel.stiffness(topology, h, n).unwrap();
        for i in 0..n {
            a.add(i, i, 1.0);
        }
        let factor = BandedFactor::new(&a).unwrap();
        let b: Vec<_> = (0..n)
            .map(|i| DVec2::from_angle(0.37 * (i * i) as f64))
            .collect();
        let mut x = b.clone();
        factor.solve(&mut x);
        let pulled = force(&kernel, topology, h, &x);
        for ((x, f), b) in x.iter().zip(&pulled).zip(&b) {
            assert!((*x - *f - *b).length() < 1e-13 * kernel.bound(h));
        }
    }
}

#[test]
fn a_material_with_corners_is_the_same_kernel() {
    let higher = vec![Profile::Uniform(0.5), Profile::Uniform(0.2)];
    let material = Material::uniform(0.1, 2.0, 5.0).with_higher(higher);
    let material = material.with_corner(7, 70).unwrap();
    let kernel = Kernel::from(&material);
    let e: Vec<_> = (0..70_u32)
        .map(|i| DVec2::from_angle(f64::from(i * i)))
        .collect();
    let mut quick = vec![DVec2::ZERO; 70];
    elastic_force(&e, Topology::Closed, &material, 1.0, &mut quick);
    for (a, b) in force(&kernel, Topology::Closed, 1.0, &e).iter().zip(&quick) {
        assert!((*a - *b).length() < 1e-13 * kernel.bound(1.0));
    }
}

#[test]
fn corners_and_breaks_cost_nothing_of_any_order() {
    let uniform = |w: f64| Profile::Uniform(w);
    let plain = Material::uniform(0.0, 2.0, 5.0);
    let plain = plain.with_higher(vec![uniform(3.0), uniform(2.0), uniform(1.0), uniform(4.0)]);
    let n = 40;
    let broken = plain.with_break(20, n).unwrap();
    let mut cornered = plain.with_corner(20, n).unwrap();
    cornered.tension = 0.0.into();
    let jump: Vec<_> = (0..n)
        .map(|i| {
            if i > 20 {
                DVec2::new(3.0, -1.0)
            } else {
                DVec2::ZERO
            }
        })
        .collect();
    let kink: Vec<_> = (0..n)
        .map(|i| DVec2::new(2.0, 1.0) * i.saturating_sub(20) as f64)
        .collect();
    for topology in [Topology::open(End::Free), Topology::open(End::Clamped)] {
        let mut energies = Vec::new();
        for (material, e) in [
            (&broken, &jump),
            (&cornered, &kink),
            (&plain, &jump),
            (&plain, &kink),
        ] {
            // flat at the clamped head; the tail of the kink is bent there, and its vice is left out
            let topology = match topology {
                Topology::Open { head, .. } => Topology::Open {
                    head,
                    tail: End::Free,
                },
                Topology::Closed => topology,
            };
            energies.push(elastic_energy(e, topology, material, 1.0).total());
        }
        assert_eq!(energies[..2], [0.0, 0.0]);
        assert!(energies[2] > 100.0 && energies[3] > 100.0, "{energies:?}");
    }
}

#[test]
fn a_strip_of_order_three_between_vices_sags_as_its_polynomial() {
    // −u⁗″ = 1 with u = u′ = 0 at both ends, and u‴ = 0, which nothing holds: u(½) = 3/46080
    let sag = |n: usize| {
        let h = 1.0 / (n - 1) as f64;
        let topology = Topology::open(End::Clamped);
        let material = Material::uniform(0.0, 0.0, 0.0).with_higher(vec![1.0.into()]);
        let k = stiffness(topology, &material, h, n).unwrap();
        let inner = Dense::from_fn(n - 2, |i, j| k.entry(i + 1, j + 1));
        inner.solve(&vec![1.0; n - 2]).unwrap()[(n - 3) / 2]
    };
    let exact = 3.0 / 46080.0;
    let error = |n| (sag(n) / exact - 1.0).abs();
    let order = (error(21) / error(41)).log2();
    assert!(
        (order - 1.0).abs() < 0.2 || (order - 2.0).abs() < 0.2,
        "{order}: {} {}",
        error(21),
        error(41)
    );
}
