//! Edges that hold fast: the external slope in the matrix.

use banded::{Dense, Operator};
use glam::{DMat2, DVec2};

use crate::problems::{self, Springs};
use crate::{Fault, Scheme, Start, State, System};

/// A ring of springs drawn to a circular edge, with the force `κ d exp(−d²/2)` at distance `d`.
struct Edge {
    springs: Springs,
    radius: f64,
    strength: f64,
}

impl crate::Wrapped for Edge {
    fn inner(&self) -> &dyn System {
        &self.springs
    }

    fn inner_mut(&mut self) -> &mut dyn System {
        &mut self.springs
    }

    fn external(
        &mut self,
        _t: f64,
        x: &[DVec2],
        _v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        for (x, force) in x.iter().zip(force) {
            let d = x.length() - self.radius;
            *force -= self.strength * d * (-0.5 * d * d).exp() * x.normalize();
        }
        Ok(())
    }
    fn external_is_constant(&self) -> bool {
        false
    }

    fn external_slope(&mut self, _t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        for (x, slope) in x.iter().zip(slope) {
            let (n, r) = (x.normalize(), x.length());
            let d = r - self.radius;
            let fade = self.strength * (-0.5 * d * d).exp();
            let (along, across) = (-fade * (1.0 - d * d), -fade * d / r);
            let normal = DMat2::from_cols(n * n.x, n * n.y);
            *slope = along * normal + across * (DMat2::IDENTITY - normal);
        }
        true
    }
}

/// A wavy ring of 30 nodes of radius about 10 in front of an edge at 10.5, within its reach: beyond
/// a distance of 1 the slope turns, and no linear step knows where the edge is.
fn edge(strength: f64) -> (Edge, State) {
    let mut springs = problems::ring(30, 1.0, 2.0, [0.5, 2.0, 1.0])
        .unwrap()
        .system;
    for (i, rest) in springs.rest.iter_mut().enumerate() {
        *rest *= 1.0 + 0.01 * (0.6 * i as f64).sin();
    }
    let state = State::at_rest(springs.rest.clone());
    (
        Edge {
            springs,
            radius: 10.5,
            strength,
        },
        state,
    )
}

fn settle(scheme: Scheme, edge: &mut Edge, state: &State, dt: f64, end: f64) -> (State, u64) {
    let mut state = state.clone();
    let mut stepper = scheme.start(edge, &state, dt, Start::SecondOrder).unwrap();
    while state.t < end {
        stepper.step(edge, &mut state).unwrap();
    }
    let steps = state.step;
    (state, steps)
}

#[test]
fn a_stiff_edge_is_found_in_few_steps_at_the_same_place() {
    let (mut edge, start) = edge(1e4);
    // κ of 1e4 asks for a step below 0.02 of every scheme that takes the edge explicitly
    let (truth, many) = settle(Scheme::Leapfrog, &mut edge, &start, 0.01, 60.0);
    let (found, few) = settle(Scheme::LinearlyImplicit, &mut edge, &start, 0.5, 60.0);
    assert!(few * 40 < many, "{few} {many}");
    for (a, b) in truth.x.iter().zip(&found.x) {
        // both at rest but for exp(−λt/γ) of the slowest mode, 3e-7
        assert!((a - b).length() < 1e-6, "{a} {b}");
    }
    // and the explicit one blows up or hops about at that step
    let mut state = start.clone();
    let mut stepper = Scheme::Imex
        .start(&mut edge, &state, 0.5, Start::FirstOrder)
        .unwrap();
    let stopped = (0..120).any(|_| stepper.step(&mut edge, &mut state).is_err());
    let off = |state: &State| -> f64 {
        state
            .x
            .iter()
            .zip(&truth.x)
            .map(|(a, b)| (a - b).length())
            .fold(0.0, f64::max)
    };
    assert!(stopped || off(&state) > 0.1, "{}", off(&state));
}

#[test]
fn a_linearly_implicit_step_is_its_dense_twin() {
    for cyclic in [true, false] {
        let n = 9;
        let mut band = banded::Pentadiagonal::new(n, cyclic).unwrap();
        for i in 0..n {
            let row: Vec<(usize, f64)> = [(0, 1.0), (1, -2.1), (2, 1.0)]
                .iter()
                .map(|&(j, w): &(usize, f64)| (i + j, w))
                .filter(|&(j, _)| cyclic || j < n)
                .map(|(j, w)| (j % n, w))
                .collect();
            band.add_outer(1.0 + 0.3 * i as f64, &row);
        }
        let columns: Vec<Vec<f64>> = (0..2)
            .map(|c| (0..n).map(|i| 1.0 + ((i * (c + 2)) as f64).sin()).collect())
            .collect();
        let operator = Operator::new(band, columns, vec![0.4, 0.1, 0.1, 0.9]).unwrap();
        let mut springs = Springs::new(operator, 1.3, 0.7);
        springs.rest = (0..n)
            .map(|i| 10.4 * DVec2::from_angle(0.7 * i as f64) + DVec2::X)
            .collect();
        let mut state = State::at_rest(springs.rest.iter().map(|r| *r * 1.02).collect());
        state
            .v
            .iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v = DVec2::new(0.1, 0.2 * i as f64));
        let mut edge = Edge {
            springs,
            radius: 10.5,
            strength: 50.0,
        };
        let dt = 0.4;

        let mut force = vec![DVec2::ZERO; n];
        edge.elastic(&state.x, &mut force);
        edge.external(0.0, &state.x, &state.v, &mut force).unwrap();
        let mut slope = vec![DMat2::ZERO; n];
        edge.external_slope(0.0, &state.x, &mut slope);
        let a = edge.stiffness().dense();
        let pulling: Vec<DMat2> = slope
            .iter()
            .map(|g| {
                let own = Dense::from_fn(2, |i, j| g.col(j)[i]).eigen().unwrap();
                let part = |i: usize, j: usize| -> f64 {
                    (0..2)
                        .map(|k| own.values[k].min(0.0) * own.vectors[k][i] * own.vectors[k][j])
                        .sum()
                };
                DMat2::from_cols_array(&[part(0, 0), part(1, 0), part(0, 1), part(1, 1)])
            })
            .collect();
        let inertia = 1.3 / (dt * dt) + 0.7 / dt;
        let matrix = Dense::from_fn(2 * n, |row, column| {
            let (i, j) = (row / 2, column / 2);
            let mut entry = if row % 2 == column % 2 {
                a[(i, j)]
            } else {
                0.0
            };
            if i == j {
                entry -= pulling[i].col(column % 2)[row % 2];
            }
            if row == column {
                entry + inertia
            } else {
                entry
            }
        });
        let right: Vec<f64> = (0..n)
            .flat_map(|i| (force[i] + 1.3 / dt * state.v[i]).to_array())
            .collect();
        let twin = matrix.solve(&right).unwrap();

        let before = state.clone();
        let scheme = Scheme::LinearlyImplicit;
        let mut stepper = scheme
            .start(&mut edge, &state, dt, Start::FirstOrder)
            .unwrap();
        stepper.step(&mut edge, &mut state).unwrap();
        for i in 0..n {
            let increment = state.x[i] - before.x[i];
            let (x, y) = (twin[2 * i], twin[2 * i + 1]);
            // condition some thousand
            assert!(
                (increment - DVec2::new(x, y)).length() < 1e-11,
                "{cyclic} {i}: {increment} {x} {y}"
            );
        }
    }
}

#[test]
fn extrapolated_backward_differences_follow_a_stiff_curve_to_an_edge_in_few_steps() {
    // stiffness ratio 1e6 as in a fine snake, an edge that is soft in comparison
    let mut springs = problems::ring(60, 0.01, 1.0, [1.0, 0.0, 6e4])
        .unwrap()
        .system;
    for (i, rest) in springs.rest.iter_mut().enumerate() {
        *rest += 0.2 * DVec2::new((0.2 * i as f64).cos(), 0.0);
    }
    let state = State::at_rest(springs.rest.clone());
    let mut edge = Edge {
        springs,
        radius: 10.3,
        strength: 4.0,
    };
    let reference = Scheme::Radau5;
    let (truth, _) = settle(reference, &mut edge, &state, 0.005, 0.9999);
    let (found, few) = settle(Scheme::Sbdf2, &mut edge, &state, 0.025, 0.9999);
    let limit = Scheme::Report.step_limit(&edge).unwrap();
    let most = truth
        .x
        .iter()
        .zip(&found.x)
        .map(|(a, b)| (a - b).length())
        .fold(0.0, f64::max);
    assert!(most < 1e-3, "{most} in {few} steps");
    let many = 1.0 / limit;
    assert!(
        few as f64 * 100.0 < many,
        "{few} steps, the report's scheme {many}"
    );
}
