//! What schemes do when they know that the external force is constant.

use glam::DVec2;

use crate::problems::{self, Springs};
use crate::{Fault, Scheme, Start, State, System};

/// The same springs, with or without telling.
struct Told {
    springs: Springs,
    tells: bool,
    asked: u32,
}

impl crate::Wrapped for Told {
    fn inner(&self) -> &dyn System {
        &self.springs
    }

    fn inner_mut(&mut self) -> &mut dyn System {
        &mut self.springs
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        self.asked += 1;
        self.springs.external(t, x, v, force)
    }
    fn external_is_constant(&self) -> bool {
        self.tells
    }
}

/// A ring in gravity after ten steps, and how often its force was asked for.
fn fallen(scheme: Scheme, tells: bool, held: bool) -> (State, u32) {
    let problem = problems::ring(12, 2.0, 0.5, [1.0, 20.0, 70.0]).unwrap();
    let mut springs = problem.system;
    springs.gravity = DVec2::new(0.1, 1.0);
    let mut state = problem.state;
    if held {
        springs.held[3] = true;
        let mut band = springs.stiffness().band().clone();
        band.hold(&springs.held);
        springs.set_stiffness(band.into());
        state.v[3] = DVec2::ZERO;
    }
    let mut system = Told {
        springs,
        tells,
        asked: 0,
    };
    let mut stepper = scheme
        .start(&mut system, &state, 0.1, Start::SecondOrder)
        .unwrap();
    for _ in 0..10 {
        stepper.step(&mut system, &mut state).unwrap();
    }
    (state, system.asked)
}

#[test]
fn a_constant_force_is_asked_for_once_a_step_with_the_same_result() {
    for held in [false, true] {
        for scheme in [
            Scheme::BackwardEuler,
            Scheme::Gauss4,
            Scheme::Radau5,
            Scheme::Etd2,
        ] {
            let (told, few) = fallen(scheme, true, held);
            let (untold, many) = fallen(scheme, false, held);
            assert!(few <= 10 && many >= 20, "{scheme}: {few} and {many}");
            for (a, b) in told
                .x
                .iter()
                .zip(&untold.x)
                .chain(told.v.iter().zip(&untold.v))
            {
                // rounding of forces of some hundreds over ten steps
                assert!(
                    (a - b).length() < 1e-11,
                    "{scheme}, held {held}: {a} and {b}"
                );
            }
        }
    }
}

#[test]
fn exact_motion_needs_no_kicks_from_a_constant_force() {
    let (exact, asked) = fallen(Scheme::Exact, true, false);
    let (ramp, _) = fallen(Scheme::Etd2, false, false);
    assert_eq!(asked, 1);
    for (a, b) in exact.x.iter().zip(&ramp.x) {
        // rounding; kicks of 0.1 would be 1e-3 off
        assert!((a - b).length() < 1e-11, "{a} and {b}");
    }
}
