//! What a curve's force on itself costs: the stencil, the same as a banded product, and as the dense one the
//! report multiplied.
#![allow(clippy::expect_used, reason = "a bench may stop")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use elastic::{
    End, Material, Parameter, Topology, circle, elastic_energy, elastic_force, spline, stiffness,
};
use glam::DVec2;
use std::hint::black_box;

const SIZES: [usize; 5] = [32, 128, 512, 2048, 8192];

/// The dense product is O(n²): a matrix of half a gigabyte tells nobody more.
const DENSE_UP_TO: usize = 2048;

/// Some deformation, smooth and small.
fn deformation(n: usize) -> Vec<DVec2> {
    circle(DVec2::ZERO, 3.0, n)
        .iter()
        .map(|p| DVec2::new(p.x * p.y, p.y))
        .collect()
}

fn materials(n: usize) -> [(&'static str, Material); 2] {
    let plain = Material::uniform(0.1, 20.0, 50.0);
    let corners = plain
        .with_corner(n / 3, n)
        .expect("the circle has a node at a third");
    [("", plain), ("-profile", corners)]
}

fn force(c: &mut Criterion) {
    let mut group = c.benchmark_group("elastic-force");
    let spacing = 2.0;
    for n in SIZES {
        group.throughput(Throughput::Elements(n as u64));
        let e = deformation(n);
        let mut force = vec![DVec2::ZERO; n];
        for (ends, topology) in [("", Topology::Closed), ("-open", Topology::open(End::Free))] {
            for (densities, material) in materials(n) {
                let id = BenchmarkId::new(format!("stencil{ends}{densities}"), n);
                group.bench_function(id, |b| {
                    b.iter(|| {
                        elastic_force(black_box(&e), topology, &material, spacing, &mut force);
                        black_box(force[0])
                    });
                });
            }
        }
        let material = Material::uniform(0.1, 20.0, 50.0);
        let k = stiffness(Topology::Closed, &material, spacing, n).expect("a sound material");
        group.bench_function(BenchmarkId::new("banded", n), |b| {
            b.iter(|| {
                k.multiply_into(black_box(&e), &mut force);
                black_box(force[0])
            });
        });
        if n <= DENSE_UP_TO {
            let dense = k.dense();
            let rows: Vec<&[f64]> = dense.rows().collect();
            group.bench_function(BenchmarkId::new("dense", n), |b| {
                b.iter(|| {
                    for (out, row) in force.iter_mut().zip(&rows) {
                        *out = row.iter().zip(black_box(&e)).map(|(&k, &e)| k * e).sum();
                    }
                    black_box(force[0])
                });
            });
        }
    }
    group.finish();
}

fn energy(c: &mut Criterion) {
    let mut group = c.benchmark_group("elastic-energy");
    for n in SIZES {
        group.throughput(Throughput::Elements(n as u64));
        let e = deformation(n);
        for (densities, material) in materials(n) {
            group.bench_function(BenchmarkId::new(format!("closed{densities}"), n), |b| {
                b.iter(|| elastic_energy(black_box(&e), Topology::Closed, &material, 2.0));
            });
        }
    }
    group.finish();
}

fn start(c: &mut Criterion) {
    let mut group = c.benchmark_group("elastic-start");
    let clicks: Vec<_> = circle(DVec2::ZERO, 40.0, 12);
    for n in SIZES {
        group.throughput(Throughput::Elements(n as u64));
        for (name, parameter) in [
            ("point-index", Parameter::PointIndex),
            ("arc-length", Parameter::ArcLength),
        ] {
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| spline(black_box(&clicks), n, parameter, true));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, force, energy, start);
criterion_main!(benches);
