//! One whole step of a snake: elastic force or solve, image, walls, update.
//!
//! `step/SCHEME/free` has no picture, `step/SCHEME/image` samples a 512² field, which stays in
//! cache for a snake of moderate size; throughput is in nodes. `step/dense` is the slow twin: the same step
//! with the stiffness as a full matrix.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use snake::{Body, Sampling, Snake, World};

mod rings;

const NODES: [usize; 5] = [32, 128, 512, 2048, 8192];

/// For the schemes that bars were set for: far beyond all caches.
const MANY: [usize; 3] = [32_768, 262_144, 1_000_000];

/// As many as a dense matrix of is worth waiting for.
const FEW: [usize; 3] = [32, 512, 2048];

/// A disk's field: as large as a picture of a camera, and with an edge.
fn disk() -> Arc<ForceField> {
    let picture = Grid::from_shape_fn((512, 512), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64) - 256.0;
        if p.length() < 200.0 { 200.0 } else { 60.0 }
    });
    let rule = EdgeForce::as_strong_as_the_report();
    Arc::new(field::edge_force(&picture, &rule).unwrap_or_else(|error| unreachable!("{error}")))
}

fn ring(n: usize, world: World) -> (Snake, State) {
    let nodes = elastic::circle(DVec2::splat(256.0), 205.0, n);
    let mut state = State::at_rest(nodes.clone());
    state.x[0].x += 0.01;
    let made = Body::of(&nodes, Topology::Closed, 1.0).and_then(|body| {
        let h = body.spacing;
        // the same stiffness ratio for any number of nodes, so that one step suits all
        let material = Material::uniform(0.05, 2.0 * h * h, 2.0 * h.powi(4));
        Snake::new(body.with_material(material).with_damping(1.0), world)
    });
    (made.unwrap_or_else(|error| unreachable!("{error}")), state)
}

fn step(c: &mut Criterion) {
    let field = disk();
    for scheme in Scheme::ALL {
        for image in [false, true] {
            let place = if image { "image" } else { "free" };
            let mut group = c.benchmark_group(format!("step/{}/{place}", scheme.name()));
            let long = matches!(scheme, Scheme::Leapfrog | Scheme::Imex);
            let more = MANY.iter().filter(|_| long);
            for &n in NODES.iter().chain(more) {
                let world = if image {
                    World::default().with_image(Arc::clone(&field), Sampling::Bilinear)
                } else {
                    World::default()
                };
                let (mut snake, mut state) = ring(n, world);
                // a scheme that is not made for such a snake has nothing to time
                let Ok(mut stepper) = scheme.start(&mut snake, &state, 0.05, Start::SecondOrder)
                else {
                    continue;
                };
                group.throughput(Throughput::Elements(n as u64));
                group.bench_function(BenchmarkId::from_parameter(n), |b| {
                    b.iter(|| {
                        let fault = stepper.step(&mut snake, &mut state);
                        black_box(&fault);
                    });
                });
            }
            group.finish();
        }
    }
}

/// The explicit step with a full matrix: what a program costs that does not know its matrix is banded.
fn dense(c: &mut Criterion) {
    let mut group = c.benchmark_group("step/dense/free");
    for n in FEW {
        let (snake, state) = ring(n, World::default());
        let operator = snake.stiffness();
        let (mut matrix, mut unit) = (vec![0.0; n * n], vec![0.0; n]);
        for (row, out) in matrix.chunks_mut(n).enumerate() {
            unit[row] = 1.0;
            operator.multiply_scalars_into(&unit, out); // symmetric: a row is a column
            unit[row] = 0.0;
        }
        let (mut x, mut v) = (state.x, state.v);
        let rest = snake.body().rest.clone();
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| {
                let e: Vec<DVec2> = x.iter().zip(&rest).map(|(x, r)| x - r).collect();
                for (row, v) in matrix.chunks(n).zip(&mut v) {
                    let pull: DVec2 = row.iter().zip(&e).map(|(&k, &e)| k * e).sum();
                    *v = (*v * 0.975 - 0.05 * pull) / 1.025;
                }
                for (x, v) in x.iter_mut().zip(&v) {
                    *x += 0.05 * v;
                }
                black_box(&x);
            });
        });
    }
    group.finish();
}

/// A step of a crowd of rings in rows, each touching its neighbors: linear, so that the throughput stays.
fn crowd(c: &mut Criterion) {
    let mut group = c.benchmark_group("crowd");
    group.sample_size(10);
    for count in [100_u32, 1000, 10_000] {
        // as scenes do that record no energies
        let crowd = rings::crowd((count, 100), 8, false);
        let mut crowd = crowd.unwrap_or_else(|error| unreachable!("{error}"));
        group.throughput(Throughput::Elements(u64::from(count)));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| {
                let outcome = crowd.step();
                black_box(&outcome);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, step, dense, crowd);
criterion_main!(benches);
