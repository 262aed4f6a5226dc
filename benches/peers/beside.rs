//! Our side of a comparison: runs the case that is named on a line of its input, and answers with its processor time.
//!
//! `benches/peers/beside.py` starts it, has it and its peers work in turn, and writes `docs/benchmarks.md`. By hand:
//! `echo field report f32 2048 | cargo run --release -p benches --example beside`. A case is set up when it is first
//! named; the answer is nanoseconds of this thread for one run of it.

#![allow(clippy::print_stdout, reason = "it answers there")]

use std::collections::HashMap;
use std::error::Error;
use std::hint::black_box;
use std::io::{BufRead, Write};
use std::ops::ControlFlow;
use std::sync::Arc;

use elastic::{Material, Topology};
use field::{EdgeForce, FastForce, ForceField, Recipe, Smoothing};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use ndarray::Array2;
use rustix::time::{ClockId, clock_gettime};
use snake::{Body, Rest, Sampling, Simulation, Snake, Stepping, Until, World};

type Outcome<T> = Result<T, Box<dyn Error>>;
type Case = Box<dyn FnMut() -> Outcome<()>>;

/// Steps of one run of a snake.
const STEPS: u64 = 2000;

/// Nanoseconds of this thread.
fn now() -> i64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec * 1_000_000_000 + time.tv_nsec
}

/// A bright disk with some texture.
fn picture(side: usize) -> Array2<u8> {
    let center = side as f64 / 2.0;
    Array2::from_shape_fn((side, side), |(y, x)| {
        let inside = (x as f64 - center).hypot(y as f64 - center) < 0.4 * side as f64;
        let texture = u8::try_from((x * 7919 + y * 104_729) % 23).unwrap_or_default();
        if inside { 180 + texture } else { 40 + texture }
    })
}

fn field_of<P: field::Pixel>(image: Array2<P>, recipe: Recipe) -> Outcome<Case> {
    let mut fast = FastForce::new(recipe, 1)?;
    let mut field = fast.field(image.view())?;
    Ok(Box::new(move || {
        fast.field_into(black_box(image.view()), &mut field)?;
        Ok(())
    }))
}

fn recipe(rules: &str) -> Outcome<Recipe> {
    Ok(match rules {
        "report" => Recipe::Report {
            passes: field::REPORT_PASSES,
            scale: field::REPORT_SCALE,
            gain: field::REPORT_GAIN,
        },
        "corrected" => Recipe::Edge(EdgeForce::as_strong_as_the_report()),
        sigma => Recipe::Edge(EdgeForce {
            smoothing: Smoothing::Gaussian(sigma.parse()?),
            gain: 1.0,
        }),
    })
}

fn field_case(rules: &str, pixels: &str, side: &str) -> Outcome<Case> {
    let (recipe, image) = (recipe(rules)?, picture(side.parse()?));
    match pixels {
        "u8" => field_of(image, recipe),
        "u16" => field_of(image.mapv(u16::from), recipe),
        "f32" => field_of(image.mapv(f32::from), recipe),
        _ => Err(format!("pixels must be u8, u16 or f32, got {pixels}").into()),
    }
}

fn scheme(name: &str) -> Outcome<Scheme> {
    let found = Scheme::ALL.iter().find(|scheme| scheme.name() == name);
    found
        .copied()
        .ok_or_else(|| format!("no scheme {name}").into())
}

/// A ring of so many nodes in a picture of 512² pixels.
fn ring(nodes: usize) -> Outcome<(Snake, State)> {
    let field: ForceField = field::fast_force(picture(512).view(), &recipe("corrected")?, 1)?;
    let nodes = elastic::circle(DVec2::splat(256.0), 205.0, nodes);
    let body = Body::of(&nodes, Topology::Closed, 1.0)?;
    let h = body.spacing;
    let body = body
        .with_material(Material::uniform(0.05, 2.0 * h * h, 2.0 * h.powi(4)))
        .with_damping(1.0);
    let world = World::default().with_image(Arc::new(field), Sampling::Bilinear);
    Ok((Snake::new(body, world)?, State::at_rest(nodes)))
}

/// [`STEPS`] steps of the stepper alone.
fn step_case(name: &str, nodes: &str) -> Outcome<Case> {
    let (mut snake, mut state) = ring(nodes.parse()?)?;
    let mut stepper = scheme(name)?.start(&mut snake, &state, 0.05, Start::SecondOrder)?;
    Ok(Box::new(move || {
        for _ in 0..STEPS {
            stepper.step(&mut snake, &mut state)?;
        }
        Ok(())
    }))
}

/// The same through a whole run, which looks for rest.
fn run_case(name: &str, nodes: &str) -> Outcome<Case> {
    let (snake, state) = ring(nodes.parse()?)?;
    let stepping = Stepping::of(scheme(name)?, 0.05);
    let mut simulation = Simulation::of(snake, state, stepping)?;
    let until = Until::at_rest(
        Rest {
            balance: 1e-30,
            ..Rest::default()
        },
        STEPS,
    );
    Ok(Box::new(move || {
        simulation.run(&until, &mut |_| ControlFlow::Continue(()))?;
        Ok(())
    }))
}

fn case(line: &str) -> Outcome<Case> {
    match line.split_whitespace().collect::<Vec<_>>().as_slice() {
        ["field", rules, pixels, side] => field_case(rules, pixels, side),
        ["step", scheme, nodes] => step_case(scheme, nodes),
        ["run", scheme, nodes] => run_case(scheme, nodes),
        _ => Err(format!("no case {line:?}").into()),
    }
}

fn main() -> Outcome<()> {
    let mut cases = HashMap::new();
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        if line == "registers" {
            println!("{}", lanes::register_bits());
        } else {
            if !cases.contains_key(&line) {
                cases.insert(line.clone(), case(&line)?);
            }
            let Some(work) = cases.get_mut(&line) else {
                continue;
            };
            let begin = now();
            work()?;
            println!("{}", now() - begin);
        }
        std::io::stdout().flush()?;
    }
    Ok(())
}
