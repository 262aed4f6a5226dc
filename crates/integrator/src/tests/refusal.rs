//! Bad input: a clear error, or a right answer.

use glam::DVec2;

use crate::problems;
use crate::{FaultKind, Scheme, SchemeError, Start};

#[test]
fn a_step_that_is_no_step_is_refused_by_every_scheme() {
    for &scheme in Scheme::ALL {
        let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
        for dt in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            let refused = scheme.start(&mut problem.system, &problem.state, dt, Start::FirstOrder);
            let Err(error) = refused else {
                panic!("{scheme} {dt}")
            };
            assert!(
                matches!(error, SchemeError::BadStep { .. }),
                "{scheme} {error}"
            );
            assert!(
                error
                    .to_string()
                    .starts_with("a step must be finite and above 0"),
                "{error}"
            );
            assert!(scheme.check(&problem.system, dt, true).is_err());
        }
        for dt in [1e300, 1e-300] {
            let refused = scheme.start(&mut problem.system, &problem.state, dt, Start::FirstOrder);
            assert!(
                matches!(refused, Err(SchemeError::BeyondNumbers { .. })),
                "{scheme}"
            );
        }
    }
}

#[test]
fn an_astronomic_step_is_refused_where_it_blows_up_and_rests_where_it_does_not() {
    for &scheme in Scheme::ALL {
        let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
        let dt = 1e12;
        match scheme.check(&problem.system, dt, false) {
            Err(error) => {
                assert!(
                    matches!(scheme, Scheme::Report | Scheme::Leapfrog | Scheme::Rk4),
                    "{scheme}"
                );
                let limit = scheme.step_limit(&problem.system).unwrap();
                let text = error.to_string();
                assert!(
                    text.contains(&limit.to_string()) && text.contains("1e12"),
                    "{text}"
                );
                assert!(scheme.check(&problem.system, dt, true).is_ok());
            }
            // would take a sub-step for each part of a period
            Ok(()) if matches!(scheme, Scheme::DormandPrince { .. }) => {}
            Ok(()) => {
                let mut state = problem.state.clone();
                let mut stepper = scheme
                    .start(&mut problem.system, &state, dt, Start::FirstOrder)
                    .unwrap();
                // generalized-α overshoots at first and forgets it by a factor of ρ a step
                for _ in 0..300 {
                    stepper.step(&mut problem.system, &mut state).unwrap();
                }
                let size = state.x.iter().map(|x| x.length()).fold(0.0, f64::max);
                assert!(size <= 2.1, "{scheme}: {size}");
            }
        }
    }
}

#[test]
fn masses_and_dampings_that_make_no_sense_are_refused() {
    for &scheme in Scheme::ALL {
        for mass in [-1.0, f64::NAN, f64::INFINITY] {
            let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
            problem.system.mass[1] = mass;
            let refused = scheme.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
            assert!(
                matches!(refused, Err(SchemeError::BadMass { node: 1, .. })),
                "{scheme}"
            );
        }
        for damping in [-1.0, f64::NAN, f64::INFINITY] {
            let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
            problem.system.damping[2] = damping;
            let refused = scheme.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
            assert!(
                matches!(refused, Err(SchemeError::BadDamping { node: 2, .. })),
                "{scheme}"
            );
        }
    }
}

#[test]
fn no_mass_is_refused_where_it_divides_and_creeps_where_it_does_not() {
    for &scheme in Scheme::ALL {
        let mut problem = problems::damped_spring(1.0, 2.0, 1.0).unwrap();
        problem.system.mass.fill(0.0);
        let mut state = problem.state.clone();
        match scheme.start(&mut problem.system, &state, 1e-3, Start::FirstOrder) {
            Ok(mut stepper) => {
                let without = matches!(
                    scheme,
                    Scheme::GradientFlow
                        | Scheme::Sbdf2
                        | Scheme::LinearlyImplicit
                        | Scheme::Radau5
                );
                assert!(without, "{scheme}");
                for _ in 0..1000 {
                    stepper.step(&mut problem.system, &mut state).unwrap();
                }
                // γ u̇ = −k u; first order errors of 1e-3
                let error = (state.x[0].x - (-0.5_f64).exp()).abs();
                assert!(error < 2e-4, "{scheme}: {error}");
            }
            Err(error) => {
                let text = error.to_string();
                assert!(
                    text.contains("gradient-flow") && text.contains("node 0 has 0"),
                    "{text}"
                );
            }
        }
    }
}

#[test]
fn a_gradient_flow_with_nothing_to_hold_it_is_refused() {
    let mut problem = problems::free_fall(1.0, 0.0, DVec2::Y).unwrap();
    let flow = Scheme::GradientFlow;
    let refused = flow.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
    assert!(
        matches!(refused, Err(SchemeError::Matrix(_))),
        "{refused:?}"
    );
}

#[test]
fn lengths_and_starts_that_do_not_fit_are_refused() {
    for &scheme in Scheme::ALL {
        let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
        let mut short = problem.state.clone();
        short.v.pop();
        let refused = scheme.start(&mut problem.system, &short, 0.1, Start::FirstOrder);
        assert!(
            matches!(
                refused,
                Err(SchemeError::Length {
                    needed: 3,
                    got: 2,
                    ..
                })
            ),
            "{scheme}"
        );
        let mut lost = problem.state.clone();
        lost.x[1].y = f64::NAN;
        let refused = scheme.start(&mut problem.system, &lost, 0.1, Start::FirstOrder);
        assert!(
            matches!(refused, Err(SchemeError::BadStart { node: 1 })),
            "{scheme}"
        );
    }
}

#[test]
fn names_are_read_back_and_typing_slips_get_the_nearest() {
    for &scheme in Scheme::ALL {
        assert_eq!(scheme.name().parse::<Scheme>(), Ok(scheme));
        assert_eq!(scheme.to_string().parse::<Scheme>(), Ok(scheme));
        assert!(!scheme.summary().is_empty() && !scheme.source().is_empty());
    }
    let alpha = "generalized-alpha(0.25)".parse::<Scheme>();
    assert_eq!(alpha, Ok(Scheme::GeneralizedAlpha { rho: 0.25 }));
    for (slip, meant) in [("leapfrgo", "leapfrog"), ("rk-4", "rk4"), ("sbdf", "sbdf2")] {
        let error = slip.parse::<Scheme>().unwrap_err();
        assert_eq!(
            error,
            SchemeError::Unknown {
                name: slip.to_owned(),
                nearest: meant
            }
        );
    }
    for odd in [
        "",
        "newmark(0.5)",
        "generalized-alpha(much)",
        "dormand-prince(",
        "Report",
    ] {
        assert!(odd.parse::<Scheme>().is_err(), "{odd}");
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
    for scheme in [
        Scheme::GeneralizedAlpha { rho: 1.5 },
        Scheme::GeneralizedAlpha { rho: f64::NAN },
        Scheme::DormandPrince { tolerance: 0.0 },
        Scheme::DormandPrince { tolerance: -1.0 },
    ] {
        let refused = scheme.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
        assert!(
            matches!(refused, Err(SchemeError::BadParameter { .. })),
            "{scheme}"
        );
    }
}

#[test]
fn a_blow_up_ends_in_a_fault_and_leaves_the_state_before_it() {
    for scheme in [Scheme::Report, Scheme::Leapfrog, Scheme::Rk4] {
        let mut problem = problems::ring(8, 1.0, 0.0, [1.0, 1.0, 1.0]).unwrap();
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut problem.system, &state, 10.0, Start::FirstOrder)
            .unwrap();
        let fault = loop {
            let before = state.clone();
            if let Err(fault) = stepper.step(&mut problem.system, &mut state) {
                assert_eq!(state, before);
                break fault;
            }
            assert!(state.step < 1000, "{scheme} never blew up");
        };
        assert_eq!(fault.kind, FaultKind::NotFinite, "{scheme}");
        assert!(state.x.iter().all(|x| x.is_finite()));
    }
}
