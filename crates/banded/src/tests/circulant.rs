//! Circulants against the dense twin and against the factor.

use glam::DVec2;
use proptest::prelude::*;

use super::{springs, vectors};
use crate::{BandedError, Circulant, Factor};

fn rings() -> impl Strategy<Value = (usize, f64, f64, f64, Vec<DVec2>)> {
    let parameters = (5..60_usize, 0.01..10.0_f64, 0.01..10.0_f64, -4.0..1.0_f64);
    parameters.prop_flat_map(|(n, tension, rigidity, tether)| {
        (
            Just(n),
            Just(tension),
            Just(rigidity),
            Just(10.0_f64.powf(tether)),
            vectors(n),
        )
    })
}

proptest! {
    #[test]
    fn eigenvalues_are_the_dense_ones((n, tension, rigidity, tether, _) in rings()) {
        let a = springs(n, true, &[tension, 1.0, rigidity], tether);
        let circulant = Circulant::new(&a.clone().into()).unwrap();
        let mut found = circulant.eigenvalues().to_vec();
        found.sort_by(f64::total_cmp);
        for (found, expected) in found.iter().zip(a.dense().eigen().unwrap().values) {
            // Jacobi rounds some hundred times in units of the norm
            prop_assert!((found - expected).abs() <= 1e-13 * a.norm());
        }
        for k in 1..n {
            let (one, other) = (circulant.eigenvalues()[k], circulant.eigenvalues()[n - k]);
            prop_assert_eq!(one.to_bits(), other.to_bits());
        }
    }

    #[test]
    fn modes_are_multiplied_by_their_eigenvalues((n, tension, rigidity, tether, x) in rings()) {
        let a = springs(n, true, &[tension, 1.0, rigidity], tether);
        let mut circulant = Circulant::new(&a.clone().into()).unwrap();
        let (mut modes, mut out) = (vec![DVec2::NAN; n], vec![DVec2::NAN; n]);
        circulant.to_modes(&x, &mut modes);
        for (mode, value) in modes.iter_mut().zip(circulant.eigenvalues()) {
            *mode *= *value;
        }
        circulant.from_modes(&modes, &mut out);
        let mut expected = vec![DVec2::NAN; n];
        a.multiply_into(&x, &mut expected);
        let mut filtered = x.clone();
        let gains = circulant.eigenvalues().to_vec();
        circulant.filter(&gains, &mut filtered);
        for i in 0..n {
            // log n sums in each direction
            prop_assert!((out[i] - expected[i]).abs().max_element() <= 1e-14 * a.norm());
            prop_assert!((filtered[i] - expected[i]).abs().max_element() <= 1e-14 * a.norm());
        }
    }

    #[test]
    fn reciprocals_solve_as_the_factor_does((n, tension, rigidity, tether, b) in rings()) {
        let a = springs(n, true, &[tension, 1.0, rigidity], tether);
        let mut circulant = Circulant::new(&a.clone().into()).unwrap();
        let gains = circulant.reciprocals().unwrap();
        let (mut x, mut expected) = (b.clone(), b);
        circulant.filter(&gains, &mut x);
        let factor = Factor::new(&a).unwrap();
        factor.solve(&mut expected);
        let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs().max_element()));
        let allowed = 64.0 * f64::EPSILON / factor.reciprocal_condition() * size;
        for (x, expected) in x.iter().zip(expected) {
            prop_assert!((*x - expected).abs().max_element() <= allowed);
        }
    }
}

#[test]
fn a_wave_is_one_mode() {
    let a = springs(12, true, &[1.0], 1.0);
    let mut circulant = Circulant::new(&a.clone().into()).unwrap();
    let turn = std::f64::consts::TAU / 12.0;
    let wave: Vec<DVec2> = (0..12)
        .map(|j| DVec2::from_angle(3.0 * turn * f64::from(j)))
        .collect();
    let mut modes = vec![DVec2::NAN; 12];
    circulant.to_modes(&wave, &mut modes);
    for (k, mode) in modes.iter().enumerate() {
        let expected = if k == 3 {
            DVec2::new(12.0, 0.0)
        } else {
            DVec2::ZERO
        };
        // twelve numbers of size one
        assert!((*mode - expected).length() <= 1e-14, "{k}");
    }
}

#[test]
fn what_is_not_circulant_or_has_no_inverse_is_refused() {
    let mut a = springs(9, true, &[1.0], 0.0);
    let circulant = Circulant::new(&a.clone().into()).unwrap();
    assert!(matches!(
        circulant.reciprocals(),
        Err(BandedError::Singular { row: 0, .. })
    ));
    a.add(4, 4, 1.0);
    assert_eq!(
        Circulant::new(&a.clone().into()).unwrap_err(),
        BandedError::NotCirculant
    );
    let open = springs(9, false, &[1.0], 0.0);
    assert_eq!(
        Circulant::new(&open.into()).unwrap_err(),
        BandedError::NotCirculant
    );
    let mut infinite = springs(9, true, &[1.0], 0.0);
    infinite.add_identity(f64::INFINITY);
    assert_eq!(
        Circulant::new(&infinite.into()).unwrap_err(),
        BandedError::NotFinite { row: 0 }
    );
}
