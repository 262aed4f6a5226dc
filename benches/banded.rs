//! What narrow systems cost: product, factor and solve, with the dense twin at small sizes.
//!
//! Every solve starts from a fresh right-hand side, so its time includes a copy (about 0.3 ns a node in cache).

#![allow(clippy::expect_used, reason = "a bench that cannot start may stop")]

use banded::{
    Band, Banded, BandedFactor, Circulant, Complex, ComplexFactor, ComplexPoint, Factor, Operator,
    Pentadiagonal, largest_eigenvalue,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use std::hint::black_box;

const SIZES: [usize; 9] = [32, 100, 128, 512, 1000, 2048, 8192, 100_000, 1_000_000];

/// An elimination is O(n³), and a matrix of half a gigabyte tells nobody more.
const DENSE_UP_TO: usize = 128;

/// What an implicit step solves with: one plus tension and rigidity, uneven along the curve if asked for.
fn matrix(n: usize, cyclic: bool, uneven: f64) -> Pentadiagonal {
    let mut a = Pentadiagonal::new(n, cyclic).expect("all sizes are above 5");
    for i in 0..n {
        let weight = 1.0 + uneven * (0.1 * i as f64).sin();
        a.add(i, i, weight);
        if cyclic || i + 1 < n {
            a.add_outer(10.0 * weight, &[(i, -1.0), ((i + 1) % n, 1.0)]);
        }
        if cyclic || i + 2 < n {
            let bend = [(i, 1.0), ((i + 1) % n, -2.0), ((i + 2) % n, 1.0)];
            a.add_outer(1000.0 * weight, &bend);
        }
    }
    a
}

fn right_side(n: usize) -> Vec<DVec2> {
    (0..n).map(|i| DVec2::from_angle(i as f64)).collect()
}

/// Times a solve in place, each from the same start.
fn timed<T: Copy>(
    c: &mut Criterion,
    variant: &str,
    nodes: usize,
    b: &[T],
    mut solve: impl FnMut(&mut [T]),
) {
    let mut group = c.benchmark_group(format!("solve/{variant}"));
    group.throughput(Throughput::Elements(nodes as u64));
    let mut x = b.to_vec();
    group.bench_function(BenchmarkId::from_parameter(b.len()), |bencher| {
        bencher.iter(|| {
            x.copy_from_slice(b);
            solve(black_box(&mut x));
        });
    });
}

fn solve(c: &mut Criterion) {
    for n in SIZES {
        let b = right_side(n);
        for (ends, cyclic) in [("open", false), ("cyclic", true)] {
            let a = matrix(n, cyclic, 0.5);
            let factor = Factor::new(&a).expect("positive by one");
            timed(c, ends, n, &b, |x| factor.solve(x));
            if n <= 100_000 {
                let operator = Operator::new(a.clone(), vec![vec![1.0; n]], vec![1.0 / n as f64]);
                let factor = operator.and_then(|a| a.factor()).expect("positive by one");
                timed(c, &format!("{ends}-with-a-column"), n, &b, |x| {
                    factor.solve(x);
                });

                let shift = vec![Complex::new(1.0, 2.0); n];
                let factor = ComplexFactor::new(&a, &shift).expect("in the right half plane");
                let b: Vec<ComplexPoint> = b.iter().map(|&b| b.into()).collect();
                timed(c, &format!("{ends}-complex"), n, &b, |x| factor.solve(x));
            }
            if n <= DENSE_UP_TO {
                let dense = a.dense();
                let mut group = c.benchmark_group(format!("solve/{ends}-dense"));
                group.throughput(Throughput::Elements(n as u64));
                let right: Vec<f64> = b.iter().map(|b| b.x).collect();
                group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
                    bencher.iter(|| dense.solve(black_box(&right)));
                });
            }
        }
    }
}

fn other_ways(c: &mut Criterion) {
    for n in [100, 128, 1000, 8192, 100_000] {
        let b = right_side(n);
        let mut circulant = Circulant::new(&matrix(n, true, 0.0).into()).expect("even and closed");
        let gains = circulant.reciprocals().expect("positive by one");
        timed(c, "cyclic-fourier", n, &b, |x| circulant.filter(&gains, x));

        // x and y alternate, and a spring across at every node couples them
        let narrow = matrix(n, true, 0.5);
        let mut wide = Banded::new(2 * n, 4, true).expect("all sizes are above 9");
        for i in 0..n {
            wide.add_outer(1.0, &[(2 * i, 1.0), (2 * i + 1, 0.5)]);
            for k in 0..3 {
                let j = (i + k) % n;
                wide.add(2 * i, 2 * j, narrow.entry(i, j));
                wide.add(2 * i + 1, 2 * j + 1, narrow.entry(i, j));
            }
        }
        let factor = BandedFactor::new(&wide).expect("positive by one");
        let flat: Vec<f64> = b.iter().flat_map(|b| b.to_array()).collect();
        timed(c, "cyclic-coupled", n, &flat, |x| factor.solve_scalars(x));
    }
}

/// Products, factors and solves against the order p: five diagonals, then two more for each order.
fn orders(c: &mut Criterion) {
    let n = 1000;
    for p in 2..=6 {
        let mut a = Band::new(n, p, true).expect("rows enough");
        a.add_identity(1.0);
        for i in 0..n {
            let spring: Vec<_> = (0..=p)
                .map(|k| ((i + k) % n, 1.0 - 0.3 * k as f64))
                .collect();
            a.add_outer(1.0 + 0.5 * (i as f64).sin(), &spring);
        }
        let b = right_side(n);
        let own = a.factor().expect("positive by one");
        timed(c, &format!("order-{p}"), n, &b, |x| own.solve(x));
        let mut group = c.benchmark_group(format!("order-{p}"));
        group.throughput(Throughput::Elements(n as u64));
        let mut out = b.clone();
        group.bench_function("product", |bencher| {
            bencher.iter(|| a.multiply_into(black_box(&b), black_box(&mut out)));
        });
        group.bench_function("factor", |bencher| bencher.iter(|| black_box(&a).factor()));
    }
}

fn factor(c: &mut Criterion) {
    for (ends, cyclic) in [("open", false), ("cyclic", true)] {
        let mut group = c.benchmark_group(format!("factor/{ends}"));
        for n in SIZES {
            let a = matrix(n, cyclic, 0.5);
            group.throughput(Throughput::Elements(n as u64));
            group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
                bencher.iter(|| Factor::new(black_box(&a)));
            });
        }
    }
}

fn product(c: &mut Criterion) {
    for (ends, cyclic) in [("open", false), ("cyclic", true)] {
        let mut group = c.benchmark_group(format!("product/{ends}"));
        for n in SIZES {
            let (a, x) = (matrix(n, cyclic, 0.5), right_side(n));
            let mut out = x.clone();
            group.throughput(Throughput::Elements(n as u64));
            group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
                bencher.iter(|| a.multiply_into(black_box(&x), black_box(&mut out)));
            });
        }
    }
}

fn eigenvalue(c: &mut Criterion) {
    let mut group = c.benchmark_group("largest-eigenvalue/cyclic");
    for n in [32, 100, 512, 8192] {
        let (a, w) = (Band::from(matrix(n, true, 0.5)), vec![1.0; n]);
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| largest_eigenvalue(black_box(&a), &w));
        });
    }
    group.finish();
    let mut group = c.benchmark_group("eigenbasis/cyclic");
    group.sample_size(10);
    for n in [32, 100, 200] {
        let a = matrix(n, true, 0.5).dense();
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| black_box(&a).eigen());
        });
    }
}

criterion_group!(
    benches, solve, other_ways, orders, factor, product, eigenvalue
);
criterion_main!(benches);
