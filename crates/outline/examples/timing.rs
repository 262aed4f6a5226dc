//! How long the search for crossings and for neighbours takes, for each node.
//!
//! `cargo run --release -p snakes-outline --example timing`

#![allow(clippy::print_stdout, reason = "an example prints")]

use glam::DVec2;
use outline::{Between, Bounds, Crossings, Neighbours, OutlineError, keep_nearest, respace};
use std::f64::consts::TAU;
use std::time::Instant;

/// A wavy ring with edges of about one pixel.
fn ring(at: DVec2, n: usize) -> Vec<DVec2> {
    let radius = n as f64 / TAU;
    let point = |i: usize| {
        let angle = TAU * i as f64 / n as f64;
        at + radius * (1.0 + 0.05 * (9.0 * angle).sin()) * DVec2::from_angle(angle)
    };
    (0..n).map(point).collect()
}

/// Nanoseconds a node of one call, the best of some seconds' worth.
fn time(
    nodes: usize,
    mut call: impl FnMut() -> Result<(), OutlineError>,
) -> Result<f64, OutlineError> {
    let mut best = f64::INFINITY;
    for _ in 0..(2_000_000 / nodes).clamp(5, 2000) {
        let start = Instant::now();
        call()?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(1e9 * best / nodes as f64)
}

fn main() -> Result<(), OutlineError> {
    println!("nanoseconds a node\nnodes    crossings  rebuild  near_node  respace");
    for size in [128, 1024, 8192, 65_536, 524_288] {
        let one = ring(DVec2::ZERO, size);
        let mut crossings = Crossings::default();
        let cross = time(size, || crossings.find(&one, true).map(drop))?;
        // rings of 64 nodes in rows, half a pixel apart at their waves
        let pitch = 64.0 / TAU * 2.1 + 0.5;
        let side = ((size / 64) as f64).sqrt().ceil();
        let rings: Vec<Vec<DVec2>> = (0..size / 64)
            .map(|k| {
                ring(
                    pitch * DVec2::new(k as f64 % side, (k as f64 / side).floor()),
                    64,
                )
            })
            .collect();
        let mut neighbours = Neighbours::default();
        let curves = || rings.iter().map(|ring| (&ring[..], true));
        let rebuild = time(size, || neighbours.rebuild(curves(), 2.0))?;
        let mut found = Vec::new();
        let near = time(size, || {
            for curve in 0..rings.len() {
                for node in 0..64 {
                    neighbours.near_node(curve, node, 4, 2.0, &mut found);
                    keep_nearest(&mut found);
                }
            }
            Ok(())
        })?;
        let bounds = Bounds::around(0.6);
        let space = time(size, || {
            respace(&one, true, &bounds, Between::Cubic, &[]).map(drop)
        })?;
        println!("{size:<8} {cross:>9.1} {rebuild:>8.1} {near:>10.1} {space:>8.1}");
    }
    Ok(())
}
