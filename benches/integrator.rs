//! What a step costs by scheme and size, on a ring of springs under gravity and without any forces, and
//! what the parts of a run cost that are not steps: starting, and asking for the largest stable step.
#![allow(clippy::expect_used, reason = "a bench may stop")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use integrator::problems::{self, Problem};
use integrator::{Fault, Scheme, Start, System};
use std::hint::black_box;

const SIZES: [usize; 5] = [32, 128, 512, 2048, 8192];

/// Eigenvectors are n² numbers, and a step that many products.
const VECTORS_UP_TO: usize = 512;

/// A damped ring, moderately stiff: dt² λ is 2 at a step of 0.04. It is pushed to and fro, because what
/// comes to rest ends in subnormal numbers, which are slow.
fn ring(n: usize) -> Problem {
    let mut problem = problems::ring(n, 1.0, 2.0, [0.1, 20.0, 70.0]).expect("five nodes or more");
    problem.system.gravity = DVec2::new(0.0, 0.1);
    problem.system.drive = (DVec2::new(0.3, 0.2), 3.0);
    problem
}

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("integrator-step");
    for n in SIZES {
        group.throughput(Throughput::Elements(n as u64));
        for &scheme in Scheme::ALL {
            let Problem {
                mut system,
                mut state,
                ..
            } = ring(n);
            let mut stepper = scheme
                .start(&mut system, &state, 0.04, Start::SecondOrder)
                .expect("a sound ring");
            group.bench_function(BenchmarkId::new(scheme.name(), n), |b| {
                b.iter(|| {
                    stepper
                        .step(&mut system, &mut state)
                        .expect("a stable step");
                    black_box(state.x[0])
                });
            });
        }
    }
    group.finish();
}

/// Nodes on which nothing acts: what is left of a step is the scheme itself.
struct Alone(problems::Springs);

impl System for Alone {
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
    fn elastic(&mut self, _x: &[DVec2], force: &mut [DVec2]) {
        force.fill(DVec2::ZERO);
    }
    fn external(
        &mut self,
        _t: f64,
        _x: &[DVec2],
        _v: &[DVec2],
        _force: &mut [DVec2],
    ) -> Result<(), Fault> {
        Ok(())
    }
}

fn alone(c: &mut Criterion) {
    let mut group = c.benchmark_group("integrator-alone");
    for n in SIZES {
        group.throughput(Throughput::Elements(n as u64));
        // without damping the gradient flow has nothing to flow against
        for &scheme in Scheme::ALL.iter().filter(|&&s| s != Scheme::GradientFlow) {
            let Problem {
                mut system,
                mut state,
                ..
            } = ring(n);
            system.damping.fill(0.0);
            let mut system = Alone(system);
            let mut stepper = scheme
                .start(&mut system, &state, 0.04, Start::SecondOrder)
                .expect("a sound ring");
            group.bench_function(BenchmarkId::new(scheme.name(), n), |b| {
                b.iter(|| {
                    stepper
                        .step(&mut system, &mut state)
                        .expect("a stable step");
                    black_box(state.x[0])
                });
            });
        }
    }
    group.finish();
}

fn eigenvectors(c: &mut Criterion) {
    let mut group = c.benchmark_group("integrator-step-eigenvectors");
    for n in SIZES.into_iter().filter(|&n| n <= VECTORS_UP_TO) {
        group.throughput(Throughput::Elements(n as u64));
        let mut problem = problems::chain(n, 1.0, 2.0, 20.0).expect("three nodes or more");
        let mut stepper = Scheme::Exact
            .start(
                &mut problem.system,
                &problem.state,
                0.04,
                Start::SecondOrder,
            )
            .expect("a sound chain");
        group.bench_function(BenchmarkId::new("exact", n), |b| {
            b.iter(|| {
                stepper
                    .step(&mut problem.system, &mut problem.state)
                    .expect("a sound step");
                black_box(problem.state.x[0])
            });
        });
    }
    group.finish();
}

fn starts(c: &mut Criterion) {
    let mut group = c.benchmark_group("integrator-start");
    for n in [128, 2048] {
        group.throughput(Throughput::Elements(n as u64));
        let Problem {
            mut system, state, ..
        } = ring(n);
        for &scheme in Scheme::ALL {
            group.bench_function(BenchmarkId::new(scheme.name(), n), |b| {
                b.iter(|| {
                    black_box(
                        scheme
                            .start(&mut system, &state, 0.04, Start::SecondOrder)
                            .is_ok(),
                    )
                });
            });
        }
        for scheme in [Scheme::Report, Scheme::Leapfrog, Scheme::Rk4] {
            let id = BenchmarkId::new(format!("{scheme}-limit"), n);
            group.bench_function(id, |b| b.iter(|| black_box(scheme.step_limit(&system))));
        }
    }
    group.finish();
}

criterion_group!(benches, steps, alone, eigenvectors, starts);
criterion_main!(benches);
