//! Borders of stability: by formula, by the step's spectral radius, and on runs.

use glam::DVec2;
use proptest::prelude::*;

use crate::problems::{self, Springs};
use crate::{Mode, Scheme, Start, System, critical_damping, report_critical_damping};

/// Growth per step of a long run of one mode, measured over its last half.
fn measured(scheme: Scheme, mode: Mode, dt: f64) -> f64 {
    let mut problem = problems::damped_spring(mode.mass, mode.damping, mode.stiffness).unwrap();
    problem.system.pull = mode.slope;
    let mut state = problem.state.clone();
    let mut stepper = scheme
        .start(&mut problem.system, &state, dt, Start::FirstOrder)
        .unwrap();
    let size = |state: &crate::State| -> f64 {
        // both parts of the motion, so that a swing does not show
        (0..3)
            .map(|i| state.x[i].length_squared() + (dt * state.v[i]).length_squared())
            .sum::<f64>()
            .sqrt()
    };
    let (mut log, mut steps) = (0.0, 0.0);
    for step in 0..2000 {
        if stepper.step(&mut problem.system, &mut state).is_err() {
            return f64::INFINITY;
        }
        let now = size(&state);
        if !(1e-100..1e100).contains(&now) {
            return if now > 1.0 { f64::INFINITY } else { 0.0 };
        }
        if step == 999 {
            log = -now.ln();
            steps = 1000.0;
        }
    }
    ((log + size(&state).ln()) / steps).exp()
}

#[test]
fn growth_is_what_the_schemes_do() {
    let mut compared = 0;
    for &scheme in Scheme::ALL {
        if matches!(scheme, Scheme::DormandPrince { .. }) {
            continue;
        }
        for (damping, stiffness, slope) in [
            (0.0, 1.0, 0.0),
            (0.05, 1.0, 0.0),
            (0.02, 1.0, 0.3),
            (1.0, 4.0, 0.5),
            (0.3, 0.0, 0.7),
        ] {
            if scheme == Scheme::GradientFlow && damping <= 0.0 {
                continue;
            }
            let mode = Mode {
                slope,
                ..Mode::free(1.0, damping, stiffness)
            };
            for dt in [0.05, 0.3, 0.9, 1.3, 2.1, 3.0] {
                if scheme == Scheme::BackwardEuler && slope * dt * dt > 1.0 {
                    continue; // its rounds do not agree there
                }
                if matches!(scheme, Scheme::Gauss4 | Scheme::Radau5) && slope * dt * dt > 1.0 {
                    continue;
                }
                let (growth, run) = (scheme.growth(mode, dt), measured(scheme, mode, dt));
                if !(0.85..1.2).contains(&growth) || !(1e-9..1e3).contains(&run) {
                    // left the range of numbers on the way: at least the same side of 1
                    assert_eq!(
                        growth > 1.0,
                        run > 1.0,
                        "{scheme} {mode:?} {dt}: {growth} {run}"
                    );
                    continue;
                }
                compared += 1;
                // beats and powers of a double root, over 1000 steps
                assert!(
                    (growth - run).abs() < 8e-3,
                    "{scheme} {mode:?} {dt}: {growth} {run}"
                );
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn runs_end_at_rest_below_the_limit_and_blow_up_above() {
    for scheme in [Scheme::Report, Scheme::Leapfrog, Scheme::Rk4] {
        let mut problem = problems::ring(20, 1.0, 0.5, [0.1, 10.0, 5.0]).unwrap();
        let limit = scheme.step_limit(&problem.system).unwrap();
        for (share, bounded) in [(0.995, true), (1.005, false)] {
            let mut state = problem.state.clone();
            let mut stepper = scheme
                .start(
                    &mut problem.system,
                    &state,
                    share * limit,
                    Start::FirstOrder,
                )
                .unwrap();
            let mut ended = Ok(());
            for _ in 0..20_000 {
                ended = stepper.step(&mut problem.system, &mut state);
                if ended.is_err() {
                    break;
                }
            }
            let size = (0..20).map(|i| (state.x[i] - problem.system.rest[i]).length());
            let calm = ended.is_ok() && size.fold(0.0, f64::max) < 2.0;
            assert_eq!(calm, bounded, "{scheme} at {share} of {limit}");
        }
    }
}

#[test]
fn the_formula_of_the_report_holds_for_one_mode() {
    // λ dt² + 2 γ dt < 4 μ
    let (m, c, k) = (1.5, 0.7, 3.0);
    let problem = problems::damped_spring(m, c, k).unwrap();
    let formula = 4.0 * m / (c + f64::sqrt(c * c + 4.0 * m * k));
    let limit = Scheme::Report.step_limit(&problem.system).unwrap();
    assert!((limit / formula - 1.0).abs() < 1e-12, "{limit} {formula}");
    let centred = 2.0 * f64::sqrt(m / k);
    let limit = Scheme::Leapfrog.step_limit(&problem.system).unwrap();
    assert!((limit / centred - 1.0).abs() < 1e-12, "{limit} {centred}");
    // nothing stiff: damping alone limits the report's scheme, nothing the other
    let loose = problems::free_fall(m, c, DVec2::Y).unwrap();
    let limit = Scheme::Report.step_limit(&loose.system).unwrap();
    assert!((limit / (2.0 * m / c) - 1.0).abs() < 1e-12);
    assert_eq!(Scheme::Leapfrog.step_limit(&loose.system), None);
    // 2√2 of the imaginary axis, and the real one's 2.7853 (hairer96 IV.2)
    let limit = Scheme::Rk4.step_limit(&problems::damped_spring(1.0, 0.0, 1.0).unwrap().system);
    assert!((limit.unwrap() - 8.0_f64.sqrt()).abs() < 1e-5, "{limit:?}");
    let limit = Scheme::Rk4.step_limit(&loose.system).unwrap();
    assert!(
        (limit - 2.785_293_563_405_282 * m / c).abs() < 1e-4,
        "{limit}"
    );
}

#[test]
fn implicit_schemes_have_no_limit_and_none_shows() {
    for &scheme in Scheme::ALL {
        if matches!(
            scheme,
            Scheme::Report | Scheme::Leapfrog | Scheme::Rk4 | Scheme::DormandPrince { .. }
        ) {
            continue;
        }
        let mut problem = problems::ring(16, 1.0, 0.3, [0.5, 1e3, 1e5]).unwrap();
        assert_eq!(scheme.step_limit(&problem.system), None, "{scheme}");
        for dt in [0.01, 1.0, 1e3, 1e6] {
            assert!(
                scheme.growth(Mode::free(1.0, 0.3, 1e6), dt) < 1.0 + 1e-9,
                "{scheme} {dt}"
            );
            let mut state = problem.state.clone();
            let mut stepper = scheme
                .start(&mut problem.system, &state, dt, Start::FirstOrder)
                .unwrap();
            for _ in 0..300 {
                stepper.step(&mut problem.system, &mut state).unwrap();
            }
            let size = (0..16).map(|i| (state.x[i] - problem.system.rest[i]).length());
            assert!(size.fold(0.0, f64::max) < 3.0, "{scheme} {dt}");
        }
    }
}

#[test]
fn generalized_alpha_leaves_rho_of_the_fastest() {
    for rho in [0.0, 0.3, 0.8, 1.0] {
        let growth = Scheme::GeneralizedAlpha { rho }.growth(Mode::free(1.0, 0.0, 1e12), 1.0);
        // three equal roots: rounding of 1e-16 to the power of a third
        assert!((growth - rho).abs() < 2e-4, "{rho}: {growth}");
    }
}

#[test]
fn penalty_contacts_count_in_the_limit_of_every_scheme_that_meets_them_explicitly() {
    struct Wall(Springs);
    impl System for Wall {
        fn len(&self) -> usize {
            self.0.len()
        }
        fn mass(&self) -> &[f64] {
            self.0.mass()
        }
        fn damping(&self) -> &[f64] {
            self.0.damping()
        }
        fn held(&self) -> &[bool] {
            self.0.held()
        }
        fn stiffness(&self) -> &banded::Operator {
            self.0.stiffness()
        }
        fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
            self.0.elastic(x, force);
        }
        fn external(
            &mut self,
            t: f64,
            x: &[DVec2],
            v: &[DVec2],
            force: &mut [DVec2],
        ) -> Result<(), crate::Fault> {
            self.0.external(t, x, v, force)
        }
        fn contact_stiffness(&self) -> (f64, f64) {
            (self.0.pull, 0.0)
        }
    }
    for &scheme in Scheme::ALL {
        if matches!(scheme, Scheme::DormandPrince { .. }) {
            continue;
        }
        // gauss and radau meet them in rounds, which end somewhat above
        let above = if matches!(scheme, Scheme::Gauss4 | Scheme::Radau5) {
            2.0
        } else {
            1.3
        };
        let mut problem = problems::damped_spring(1.0, 0.4, 1.0).unwrap();
        problem.system.pull = 100.0;
        let mut wall = Wall(problem.system);
        let limit = scheme.step_limit(&wall).unwrap();
        for (share, bounded) in [(0.99, true), (above, false)] {
            let mut state = problem.state.clone();
            let mut stepper = scheme
                .start(&mut wall, &state, share * limit, Start::FirstOrder)
                .unwrap();
            let mut size = 0.0;
            for _ in 0..3000 {
                if stepper.step(&mut wall, &mut state).is_err() {
                    size = f64::INFINITY;
                    break;
                }
                size = state.x[0].length();
            }
            assert_eq!(
                size < 10.0,
                bounded,
                "{scheme}: {size} at {share} of {limit}"
            );
        }
    }
}

#[test]
fn critical_damping_is_where_the_roots_meet() {
    assert!((critical_damping(1.0, 1.0) - 2.0).abs() < 1e-15);
    // D23: z² − (2 − a − b) z + (1 − a) has a double root
    for (m, k, dt) in [(1.0, 1.0, 0.01), (2.0, 30.0, 0.1)] {
        let a = report_critical_damping(m, k, dt) * dt / m;
        let b = k * dt * dt / m;
        let discriminant = (2.0 - a - b) * (2.0 - a - b) - 4.0 * (1.0 - a);
        assert!(discriminant.abs() < 1e-14, "{discriminant}");
    }
}

#[test]
fn a_uniform_band_with_a_shared_mode_has_the_limit_of_its_dense_twin() {
    let band = problems::ring(9, 1.0, 0.0, [1.0, 2.0, 0.5]).unwrap();
    let band = band.system.stiffness().band().clone();
    for weight in [-0.1, 0.4, 3.0] {
        let column: Vec<f64> = (0..9).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
        let operator = banded::Operator::new(band.clone(), vec![column], vec![weight]).unwrap();
        let dense = operator.dense().eigen().unwrap();
        let most = dense.values.last().unwrap();
        let system = Springs::new(operator, 1.0, 0.0);
        let limit = Scheme::Leapfrog.step_limit(&system).unwrap();
        let twin = 2.0 / most.sqrt();
        // on the safe side, and off only where the band alone is stiffer than the whole
        assert!(limit <= twin * (1.0 + 1e-10), "{weight}: {limit} {twin}");
        assert!(limit > twin * 0.9, "{weight}: {limit} {twin}");
    }
}

proptest! {
    #[test]
    fn the_limit_is_where_the_spectral_radius_passes_1(
        mass in 0.1..10.0_f64, damping in 0.0..5.0_f64, stiffness in 0.01..1e4_f64,
    ) {
        let problem = problems::damped_spring(mass, damping, stiffness).unwrap();
        let mode = Mode::free(mass, damping, stiffness);
        for scheme in [Scheme::Report, Scheme::Leapfrog] {
            let limit = scheme.step_limit(&problem.system).unwrap();
            prop_assert!(scheme.growth(mode, limit * 0.9999) <= 1.0 + 1e-12);
            prop_assert!(scheme.growth(mode, limit * 1.0001) > 1.0);
        }
    }
}
