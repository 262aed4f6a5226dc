//! From pixels to forces, and reading forces between pixels.
//!
//! `smoothing`: what do twenty passes along both axes cost? `force-field`: each pipeline beside a loop that only
//! reads the picture and writes two floats a pixel, the floor for all of them (12 bytes a pixel for `f32`, 9 for
//! 8 bits); one 8192² round is added where `SNAKE_BENCH_LARGE` is set. `reach`: what σ costs on either side of the
//! switch to thinned-out lines. `sampling`: 1000 points one at a time, and all at once by each rule, with and without the
//! slope; 16 bytes of field twice a point (bilinear) or 32 four times (bicubic) in `f32`. `lazy`: one contour in a
//! large picture, tiles and all. What was measured: `docs/speed.md`.

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};
use field::{
    EdgeForce, FastForce, Grid, Interpolation, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, Recipe,
    Smoothing, binomial_x, binomial_y, edge_force, literal, report_force, signal,
};
use glam::{DMat2, DVec2};
use ndarray::Array2;
use std::hint::black_box;

const SIDES: [usize; 4] = [128, 512, 1024, 2048];

/// Added where `SNAKE_BENCH_LARGE` is set: it takes two gigabytes and a minute.
const LARGEST_SIDE: usize = 8192;

/// The `f64` pipelines are timed up to here: they keep every stage.
const LARGEST_DOUBLE: usize = 2048;

/// The literal program is timed up to here: beyond, a single run takes seconds.
const LARGEST_LITERAL: usize = 512;

/// A bright disk with some texture, 8 bits.
fn picture(side: usize) -> Array2<u8> {
    let center = side as f64 / 2.0;
    Array2::from_shape_fn((side, side), |(y, x)| {
        let inside = (x as f64 - center).hypot(y as f64 - center) < 0.4 * side as f64;
        let texture = u8::try_from((x * 7919 + y * 104_729) % 23).unwrap_or_default();
        if inside { 180 + texture } else { 40 + texture }
    })
}

/// Read once, write two: the floor of every force field.
fn stream(pixels: &[f32], forces: &mut [[f32; 2]]) {
    for (force, &pixel) in forces.iter_mut().zip(pixels) {
        *force = [pixel, -pixel];
    }
}

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10);
    group
}

fn smoothing(criterion: &mut Criterion) {
    let mut group = group(criterion, "smoothing");
    for side in SIDES {
        let image = picture(side).mapv(f64::from);
        group.throughput(Throughput::Elements((side * side) as u64));
        group.bench_with_input(
            BenchmarkId::new("binomial-x", side),
            &image,
            |bench, image| {
                bench.iter(|| binomial_x(black_box(image), REPORT_PASSES));
            },
        );
        group.bench_with_input(
            BenchmarkId::new("binomial-y", side),
            &image,
            |bench, image| {
                bench.iter(|| binomial_y(black_box(image), REPORT_PASSES));
            },
        );
    }
    let step = signal::step();
    group.throughput(Throughput::Elements(step.len() as u64));
    group.bench_function("signal-fourier/100", |bench| {
        bench.iter(|| signal::smooth_fourier(black_box(&step), 10_f64.sqrt()));
    });
    group.bench_function("signal-direct/100", |bench| {
        bench.iter(|| signal::smooth_direct(black_box(&step), 10_f64.sqrt()));
    });
    group.bench_function("signal-binomial/100", |bench| {
        bench.iter(|| signal::smooth_binomial(black_box(&step), REPORT_PASSES));
    });
    group.finish();
}

fn force_field(criterion: &mut Criterion) {
    let mut group = group(criterion, "force-field");
    let corrected = EdgeForce::as_strong_as_the_report();
    let report = Recipe::Report {
        passes: REPORT_PASSES,
        scale: REPORT_SCALE,
        gain: REPORT_GAIN,
    };
    let large = std::env::var_os("SNAKE_BENCH_LARGE").map(|_| LARGEST_SIDE);
    for side in SIDES.into_iter().chain(large) {
        let bytes = picture(side);
        let (words, floats) = (bytes.mapv(u16::from), bytes.mapv(f32::from));
        group.throughput(Throughput::Elements((side * side) as u64));

        let mut forces = vec![[0.0; 2]; side * side];
        group.bench_function(BenchmarkId::new("streaming", side), |bench| {
            bench.iter(|| {
                stream(
                    black_box(floats.as_slice().unwrap_or_default()),
                    black_box(&mut forces),
                );
            });
        });
        for (name, recipe, threads) in [
            ("fused-report", report, 1),
            ("fused-report-2-threads", report, 2),
            ("fused-corrected", Recipe::Edge(corrected), 1),
            ("fused-corrected-2-threads", Recipe::Edge(corrected), 2),
        ] {
            let Ok(mut fast) = FastForce::new(recipe, threads) else {
                continue;
            };
            let Ok(mut field) = fast.field(floats.view()) else {
                continue;
            };
            group.bench_function(BenchmarkId::new(name, side), |bench| {
                bench.iter(|| fast.field_into(black_box(floats.view()), &mut field));
            });
            if threads == 1 {
                group.bench_function(BenchmarkId::new(format!("{name}-u8"), side), |bench| {
                    bench.iter(|| fast.field_into(black_box(bytes.view()), &mut field));
                });
                group.bench_function(BenchmarkId::new(format!("{name}-u16"), side), |bench| {
                    bench.iter(|| fast.field_into(black_box(words.view()), &mut field));
                });
            }
        }
        if side > LARGEST_DOUBLE {
            continue;
        }
        let image: Grid = bytes.mapv(f64::from);
        group.bench_function(BenchmarkId::new("report", side), |bench| {
            bench
                .iter(|| report_force(black_box(&image), REPORT_PASSES, REPORT_SCALE, REPORT_GAIN));
        });
        group.bench_function(BenchmarkId::new("corrected", side), |bench| {
            bench.iter(|| edge_force(black_box(&image), &corrected));
        });
        if side <= LARGEST_LITERAL {
            group.bench_function(BenchmarkId::new("report-literal", side), |bench| {
                bench.iter(|| {
                    literal::report_force(
                        black_box(&image),
                        REPORT_PASSES,
                        REPORT_SCALE,
                        REPORT_GAIN,
                    )
                });
            });
        }
    }
    group.finish();
}

/// The corrected recipe on 512² pixels, below the switch (σ ≈ 18 px) and above it.
fn reach(criterion: &mut Criterion) {
    let mut group = group(criterion, "reach");
    let image = picture(512);
    group.throughput(Throughput::Elements(512 * 512));
    for sigma in [1.0, 3.2, 10.0, 17.0, 20.0, 40.0, 80.0] {
        let rule = EdgeForce {
            smoothing: Smoothing::Gaussian(sigma),
            gain: 1.0,
        };
        let Ok(mut fast) = FastForce::new(Recipe::Edge(rule), 1) else {
            continue;
        };
        group.bench_function(BenchmarkId::new("corrected", sigma), |bench| {
            bench.iter(|| fast.field(black_box(image.view())));
        });
    }
    group.finish();
}

/// A contour 100 px across in 4096² pixels, from nothing: at most a handful of tiles.
fn lazy(criterion: &mut Criterion) {
    let mut group = group(criterion, "lazy");
    let rule = EdgeForce::as_strong_as_the_report();
    let image = picture(4096);
    let points: Vec<DVec2> = (0..300)
        .map(|i| DVec2::splat(2000.0) + 50.0 * DVec2::from_angle(f64::from(i) * 0.021))
        .collect();
    let mut forces = vec![DVec2::ZERO; points.len()];
    group.bench_function("one-cell-in/4096", |bench| {
        bench.iter_batched(
            || field::lazy_force(image.clone(), &Recipe::Edge(rule)),
            |field| {
                if let Ok(field) = &field {
                    field.sample_into(&points, Interpolation::Bilinear, &mut forces);
                }
                // dropped outside: giving the picture back is not part of it
                field
            },
            criterion::BatchSize::PerIteration,
        );
    });
    group.finish();
}

fn sampling(criterion: &mut Criterion) {
    let mut group = group(criterion, "sampling");
    for side in SIDES {
        let bytes = picture(side);
        let rule = EdgeForce {
            smoothing: Smoothing::Binomial(REPORT_PASSES),
            gain: 1.0,
        };
        let Ok(double) = edge_force(&bytes.mapv(f64::from), &rule) else {
            continue;
        };
        let Ok(single) = field::fast_force(bytes.view(), &Recipe::Edge(rule), 1) else {
            continue;
        };
        let Ok(lazy) = field::lazy_force(bytes, &Recipe::Edge(rule)) else {
            continue;
        };
        let center = DVec2::splat(side as f64 / 2.0);
        let points: Vec<DVec2> = (0..1000)
            .map(|i| center + 0.4 * side as f64 * DVec2::from_angle(f64::from(i) * 0.00628))
            .collect();
        group.throughput(Throughput::Elements(points.len() as u64));
        for (name, field) in [("f64", &double), ("f32", &single), ("lazy", &lazy)] {
            group.bench_function(
                BenchmarkId::new(format!("bilinear-{name}"), side),
                |bench| {
                    bench.iter(|| {
                        black_box(&points)
                            .iter()
                            .map(|&p| field.at(p))
                            .sum::<DVec2>()
                    });
                },
            );
        }
        let (mut forces, mut slopes) = (vec![DVec2::ZERO; 1000], vec![DMat2::ZERO; 1000]);
        for (rule_name, rule) in [
            ("bilinear", Interpolation::Bilinear),
            ("bicubic", Interpolation::Bicubic),
        ] {
            for (name, field) in [("f64", &double), ("f32", &single), ("lazy", &lazy)] {
                let id = BenchmarkId::new(format!("many-{rule_name}-{name}"), side);
                group.bench_function(id, |bench| {
                    bench.iter(|| field.sample_into(black_box(&points), rule, &mut forces));
                });
                let id = BenchmarkId::new(format!("many-{rule_name}-slope-{name}"), side);
                group.bench_function(id, |bench| {
                    bench.iter(|| {
                        let (forces, slopes) = (&mut forces, &mut slopes);
                        field.sample_with_slope_into(black_box(&points), rule, forces, slopes);
                    });
                });
            }
        }
        group.bench_function(BenchmarkId::new("report-f64", side), |bench| {
            bench.iter(|| {
                let forces = black_box(&points)
                    .iter()
                    .filter_map(|&p| double.at_report(p).ok());
                forces.sum::<DVec2>()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, smoothing, force_field, reach, sampling, lazy);
criterion_main!(benches);
