//! Sub-steps chosen by the program: they keep to the tolerance, below the limit, and take no more than it takes.

use super::contact::drops;
use crate::problems::{self, Problem};
use crate::{Adaptive, Limit, Reason, Scheme, SchemeError, Start, State, Stepper};

/// Ten units of time in outputs of one; the largest error and the stepper.
fn follow(scheme: Scheme, problem: &Problem, tolerance: f64) -> (f64, Adaptive) {
    let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
    let limit = Limit::of(scheme, &system);
    let mut stepper = Adaptive::new(scheme, &mut system, &state, 1.0, tolerance, limit).unwrap();
    let mut error = 0.0_f64;
    for _ in 0..10 {
        stepper.step(&mut system, &mut state).unwrap();
        error = error.max(distance(&state, &(problem.exact)(state.t)));
    }
    (error, stepper)
}

fn distance(a: &State, b: &State) -> f64 {
    let apart = a.x.iter().zip(&b.x).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f64::max)
}

#[test]
fn the_error_of_a_spring_follows_the_tolerance() {
    let problem = problems::driven_spring(1.0, 0.3, 4.0, 1.5).unwrap();
    for scheme in [
        Scheme::Leapfrog,
        Scheme::Rk4,
        Scheme::Imex,
        Scheme::Newmark,
        Scheme::GeneralizedAlpha { rho: 0.8 },
        Scheme::Sbdf2,
        Scheme::Gauss4,
        Scheme::Radau5,
        Scheme::Exact,
        Scheme::Etd2,
    ] {
        let coarse = if scheme.order() == 1 { 1e-4 } else { 1e-5 };
        let runs = [coarse, 1e-3 * coarse].map(|tolerance| {
            let (error, stepper) = follow(scheme, &problem, tolerance);
            // every pair within about the tolerance, a velocity counting twice, and a damped spring forgets
            let most = stepper.summary().made as f64 * tolerance;
            assert!(error < most, "{scheme}: {error} of {most}");
            (error, tolerance)
        });
        let errors = runs.map(|(error, _)| error);
        let order = f64::from(scheme.order());
        let slope = (errors[0] / errors[1]).log10() / 3.0;
        // p/(p+1), give or take the factor of 2 between lengths and the few steps of high orders
        let expected = match scheme {
            // each new length starts with a step of Euler's, which costs it half of that
            Scheme::Sbdf2 => 1.0 / 3.0,
            _ => order / (order + 1.0),
        };
        assert!(
            (slope - expected).abs() < 0.25,
            "{scheme}: {slope} for {expected}, {errors:?}"
        );
    }
}

#[test]
fn an_explicit_run_on_a_stiff_ring_stays_below_the_limit_and_says_so() {
    let problem = problems::ring(40, 1.0, 1.0, [1.0, 0.0, 6e3]).unwrap();
    for scheme in [Scheme::Leapfrog, Scheme::Rk4] {
        let limit = scheme.step_limit(&problem.system).unwrap();
        let (error, stepper) = follow(scheme, &problem, 1e-2);
        let summary = stepper.summary();
        assert!(
            summary.longest < limit,
            "{scheme}: {} of {limit}",
            summary.longest
        );
        // and not without need: the first motion dies out, and then only the limit holds
        assert!(
            summary.longest > 0.3 * limit,
            "{scheme}: {} of {limit}",
            summary.longest
        );
        assert!(
            matches!(stepper.reason(), Reason::Stability(_)),
            "{scheme}: {summary}"
        );
        assert!(stepper.reason().to_string().contains("the elastic force"));
        assert!(error < 0.1, "{scheme}: {error}");
    }
}

#[test]
fn an_implicit_run_takes_short_steps_at_first_and_the_longest_at_rest() {
    // the fast waves are damped out within a unit of time, the slow ones within ten
    let mut problem = problems::ring(40, 0.01, 1.0, [1.0, 0.0, 6e3]).unwrap();
    problem.state.v.fill(glam::DVec2::ZERO);
    let scheme = Scheme::Sbdf2;
    let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
    let mut stepper = Adaptive::new(scheme, &mut system, &state, 5.0, 1e-4, None).unwrap();
    stepper.step(&mut system, &mut state).unwrap();
    let early = stepper.summary().made;
    assert!(stepper.summary().shortest < 0.02, "{}", stepper.summary());
    for _ in 0..9 {
        stepper.step(&mut system, &mut state).unwrap();
    }
    let summary = stepper.summary();
    // at rest an output takes one pair
    assert!(
        summary.longest >= 2.5 && summary.made - early < 2 * early,
        "{summary}"
    );
    assert_eq!(stepper.reason(), Reason::Output);
    // a fixed step as short as the start needs would take this many
    let fixed = 50.0 / summary.shortest;
    assert!(
        10.0 * (summary.made + summary.spent) as f64 <= fixed,
        "{summary}, fixed {fixed}"
    );
    let rest = &problem.system.rest;
    let apart = state.x.iter().zip(rest).map(|(x, r)| x.distance(*r));
    assert!(apart.fold(0.0, f64::max) < 1e-2);
}

#[test]
fn a_drop_on_a_floor_shortens_sub_steps_only_where_it_hits() {
    for scheme in [Scheme::Leapfrog, Scheme::Newmark, Scheme::Sbdf2] {
        let (mut floor, mut state) = drops(0.5);
        let mut stepper = Adaptive::new(scheme, &mut floor, &state, 0.05, 1e-4, None).unwrap();
        let mut peak = 0.0_f64;
        for _ in 0..18 {
            stepper.step(&mut floor, &mut state).unwrap();
            if state.t > 0.46 {
                peak = peak.max(-state.x[0].y);
            }
        }
        let summary = stepper.summary();
        // the parabola between two outputs, 3e-3, and some tolerances
        assert!((peak - 0.25).abs() < 5e-3, "{scheme}: {peak}, {summary}");
        assert!(summary.held_by[3] > 0, "{scheme}: {summary}");
        // hits the floor at 4.5, so that the tolerance is 2e-5 of time: 40000 equal steps
        assert!(
            summary.shortest < 1e-4 && summary.longest > 100.0 * summary.shortest,
            "{scheme}: {summary}"
        );
        assert!(summary.made + summary.spent < 4000, "{scheme}: {summary}");
    }
}

#[test]
fn a_refused_pair_leaves_no_trace_and_runs_repeat_to_the_byte() {
    let problem = problems::driven_spring(1.0, 0.3, 4.0, 1.5).unwrap();
    for &scheme in Scheme::ALL.iter().filter(|&&s| s != Scheme::Report) {
        let once = || {
            let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
            let limit = Limit::of(scheme, &system);
            let mut stepper = Adaptive::new(scheme, &mut system, &state, 2.0, 1e-6, limit).unwrap();
            for _ in 0..3 {
                stepper.step(&mut system, &mut state).unwrap();
            }
            let text = stepper.summary().to_string();
            (state, text)
        };
        let (first, second) = (once(), once());
        assert_eq!(first, second, "{scheme}");
        assert_eq!((first.0.t.to_bits(), first.0.step), (6.0_f64.to_bits(), 3));
    }
}

#[test]
fn a_stepper_that_resumes_is_one_that_starts_there() {
    let problem = problems::driven_spring(1.0, 0.3, 4.0, 1.5).unwrap();
    for &scheme in Scheme::ALL {
        let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
        let mut old = scheme
            .start(&mut system, &state, 0.1, Start::FirstOrder)
            .unwrap();
        for _ in 0..3 {
            old.step(&mut system, &mut state).unwrap();
        }
        state.x[1].x += 0.25;
        state.t = 7.0;
        let mut twin = state.clone();
        old.resume(&mut system, &state);
        let mut new = scheme
            .start(&mut system, &twin, 0.1, Start::SecondOrder)
            .unwrap();
        for _ in 0..3 {
            old.step(&mut system, &mut state).unwrap();
            new.step(&mut system, &mut twin).unwrap();
        }
        if matches!(scheme, Scheme::DormandPrince { .. }) {
            // it remembers how long its sub-steps were; the same to its tolerance of 1e-9
            assert!(distance(&state, &twin) < 1e-7);
        } else {
            assert_eq!(state, twin, "{scheme}");
        }
    }
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let Problem {
        mut system, state, ..
    } = problems::damped_spring(1.0, 0.3, 4.0).unwrap();
    let mut ask = |scheme, output, tolerance, limit| {
        Adaptive::new(scheme, &mut system, &state, output, tolerance, limit).map(|_| ())
    };
    let one = ask(Scheme::Report, 1.0, 1e-3, None).unwrap_err();
    assert!(one.to_string().contains("leapfrog"), "{one}");
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = ask(Scheme::Newmark, 1.0, tolerance, None);
        assert!(matches!(refused, Err(SchemeError::BadParameter { .. })));
    }
    assert!(matches!(
        ask(Scheme::Newmark, -1.0, 1e-3, None),
        Err(SchemeError::BadStep { .. })
    ));
    let none = Limit {
        dt: 0.0,
        of: "a contact",
    };
    assert!(ask(Scheme::Newmark, 1.0, 1e-3, Some(none)).is_err());
}
