//! Instructions of the inner loops, counted by callgrind and held against pinned numbers.
//! Long because each kernel is a case of its own with its set-up beside it.
//!
//! Times depend on what else runs on the machine, instructions do not. `cargo run --release -p benches --example
//! counts` runs each kernel under valgrind, takes off what setting it up costs, and compares with
//! `benches/counts.csv`; more than 3 % either way is a failure. `-- --accept` writes what was found instead.
//!
//! Instructions depend on the compiler and on the instruction set the kernels choose. Valgrind shows programs a
//! processor of its own: that of the machine, without AVX-512. So the file names the compiler and whether AVX2 was
//! there. Where either is another, or valgrind is missing, the check says that it was skipped, and why.

#![allow(clippy::print_stdout, reason = "a bench tells what it found")]

use std::error::Error;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::sync::Arc;

use banded::{Factor, Pentadiagonal};
use elastic::{Material, Topology};
use field::{EdgeForce, Grid, Interpolation};
use glam::DVec2;
use integrator::problems;
use integrator::{Scheme, Start, State};
use snake::{Body, Rest, Sampling, Simulation, Snake, Stepping, Until, World};

mod rings;

/// How far a count may be from the pinned one, relative.
const ALLOWED: f64 = 0.03;

/// How often a kernel runs under the counter.
const TIMES: u32 = 20;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Something to count: set up once, then run as often as asked.
type Kernel = fn(u32) -> Outcome<()>;

const KERNELS: [(&str, Kernel); 23] = [
    ("banded-solve/1000", solve),
    ("elastic-force/1000", elastic_force),
    ("leapfrog-step/1000", |times| {
        step(Scheme::Leapfrog, 1000, times)
    }),
    ("imex-step/1000", |times| step(Scheme::Imex, 1000, times)),
    ("leapfrog-maps/1000", |times| {
        mapped(Scheme::Leapfrog, times)
    }),
    ("imex-maps/1000", |times| mapped(Scheme::Imex, times)),
    ("newmark-step/1000", |times| {
        step(Scheme::Newmark, 1000, times)
    }),
    ("linearly-implicit-step/200", |times| {
        stiff(Scheme::LinearlyImplicit, 200, times)
    }),
    ("gauss-4-step/200", |times| {
        stiff(Scheme::Gauss4, 200, times)
    }),
    ("exact-step/200", |times| stiff(Scheme::Exact, 200, times)),
    ("crowd-step/10x16", |times| crowd(10, false, times)),
    ("crowd-step/100x16", |times| crowd(100, false, times)),
    ("crowd-account/10x16", |times| crowd(10, true, times)),
    ("run-in-picture/200", |times| whole(Scheme::Leapfrog, times)),
    ("run-in-picture-imex/200", |times| {
        whole(Scheme::Imex, times)
    }),
    ("outline-resolve/1000", resolve),
    ("outline-slide/1000", slide),
    ("field-sample/1000", sample),
    ("field-report/64x64", report),
    ("field-edge/64x64", edge),
    ("fast-report/512x512", |times| {
        let passes = field::REPORT_PASSES;
        fast(
            field::Recipe::Report {
                passes,
                scale: field::REPORT_SCALE,
                gain: field::REPORT_GAIN,
            },
            times,
        )
    }),
    ("fast-edge/512x512", |times| {
        fast(
            field::Recipe::Edge(EdgeForce::as_strong_as_the_report()),
            times,
        )
    }),
    ("fast-wide/512x512", |times| {
        let rule = EdgeForce {
            smoothing: field::Smoothing::Gaussian(40.0),
            gain: 1.0,
        };
        fast(field::Recipe::Edge(rule), times)
    }),
];

fn wave(n: usize) -> Vec<DVec2> {
    (0..n).map(|i| DVec2::from_angle(0.7 * i as f64)).collect()
}

fn solve(times: u32) -> Outcome<()> {
    let mut band = Pentadiagonal::new(1000, true)?;
    band.add_identity(7.0);
    for i in 0..1000 {
        band.add(i, (i + 1) % 1000, -2.0);
        band.add(i, (i + 2) % 1000, 0.5);
    }
    let factor = Factor::new(&band)?;
    let mut b = wave(1000);
    for _ in 0..times {
        factor.solve(black_box(&mut b));
    }
    Ok(())
}

fn elastic_force(times: u32) -> Outcome<()> {
    let (e, mut force) = (wave(1000), wave(1000));
    let material = Material::uniform(0.1, 2.0, 3.0);
    for _ in 0..times {
        elastic::elastic_force(black_box(&e), Topology::Closed, &material, 1.0, &mut force);
    }
    black_box(&force);
    Ok(())
}

/// A snake without forces from outside.
fn step(scheme: Scheme, n: usize, times: u32) -> Outcome<()> {
    let nodes = elastic::circle(DVec2::splat(256.0), 205.0, n);
    let mut state = State::at_rest(nodes.clone());
    state.x[0].x += 0.01;
    let body = Body::of(&nodes, Topology::Closed, 1.0)?;
    let h = body.spacing;
    let material = Material::uniform(0.05, 2.0 * h * h, 2.0 * h.powi(4));
    let body = body.with_material(material).with_damping(1.0);
    let mut snake = Snake::new(body, World::default())?;
    let mut stepper = scheme.start(&mut snake, &state, 0.05, Start::SecondOrder)?;
    for _ in 0..times {
        stepper.step(&mut snake, &mut state)?;
    }
    Ok(())
}

/// A ring of springs that are partly external.
fn stiff(scheme: Scheme, n: usize, times: u32) -> Outcome<()> {
    let ring = problems::ring(n, 1.0, 2.0, [0.1, 20.0, 70.0])?;
    let (mut system, mut state) = (ring.system, ring.state);
    if scheme == Scheme::LinearlyImplicit {
        system.pull = 1.0;
    }
    let mut stepper = scheme.start(&mut system, &state, 0.04, Start::SecondOrder)?;
    for _ in 0..times {
        stepper.step(&mut system, &mut state)?;
    }
    Ok(())
}

/// A snake of 1000 nodes in no picture, whose tension and rigidity a map gives.
fn mapped(scheme: Scheme, times: u32) -> Outcome<()> {
    let nodes = elastic::circle(DVec2::splat(256.0), 200.0, 1000);
    let factors = Grid::from_shape_fn((512, 512), |(y, x)| 0.2 + 0.8 * ((x + y) as f64) / 1024.0);
    let map = Arc::new(field::Map::new(&factors)?);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)?
        .with_material(Material::uniform(0.01, 10.0, 10.0))
        .with_damping(0.5);
    body.maps.tension = Some(Arc::clone(&map));
    body.maps.rigidity = Some(map);
    let mut snake = Snake::new(body, World::default())?;
    let mut state = State::at_rest(nodes);
    let mut stepper = scheme.start(&mut snake, &state, 0.02, Start::SecondOrder)?;
    for _ in 0..times {
        stepper.step(&mut snake, &mut state)?;
    }
    Ok(())
}

/// Rings in rows of ten, all touching their neighbors: ten times as many should take ten times as long.
fn crowd(count: u32, account: bool, times: u32) -> Outcome<()> {
    let mut crowd = rings::crowd((count, 10), 16, account)?;
    for _ in 0..times {
        let _ = crowd.step()?;
    }
    black_box(crowd.momentum());
    Ok(())
}

/// A whole run of a snake of 200 nodes in a picture, watched for rest: what a user waits for, step by step.
fn whole(scheme: Scheme, times: u32) -> Outcome<()> {
    let image = Grid::from_shape_fn((256, 256), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64) - 127.5;
        if p.length() < 80.0 { 200.0 } else { 60.0 }
    });
    let field = field::edge_force(&image, &EdgeForce::as_strong_as_the_report())?;
    let nodes = elastic::circle(DVec2::splat(127.5), 84.0, 200);
    let body = Body::of(&nodes, Topology::Closed, 1.0)?
        .with_material(Material::uniform(0.0, 20.0, 100.0))
        .with_damping(2.0);
    let world = World::default().with_image(Arc::new(field), Sampling::Bilinear);
    let snake = Snake::new(body, world)?;
    let stepping = Stepping::of(scheme, 0.1);
    let mut simulation = Simulation::of(snake, State::at_rest(nodes), stepping)?;
    let until = Until::at_rest(Rest::default(), u64::from(times));
    simulation.run(&until, &mut |_| ControlFlow::Continue(()))?;
    black_box(simulation.momentum());
    Ok(())
}

/// A figure of eight, whose one crossing is cut.
fn eight() -> Vec<DVec2> {
    let node = |i: u32| {
        let angle = 0.3 + std::f64::consts::TAU * f64::from(i) / 1000.0;
        DVec2::new(150.0 * angle.sin(), 80.0 * (2.0 * angle).sin())
    };
    (0..1000).map(node).collect()
}

fn resolve(times: u32) -> Outcome<()> {
    let nodes = eight();
    for _ in 0..times {
        black_box(outline::resolve(black_box(&nodes), 1.0)?);
    }
    Ok(())
}

fn slide(times: u32) -> Outcome<()> {
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(200.0, 50.0), 0.0, 1000);
    for _ in 0..times {
        let plan = outline::slide(black_box(&nodes), true, 900, outline::Between::Cubic)?;
        black_box(plan.draw(&nodes)?);
    }
    Ok(())
}

fn picture() -> Grid {
    Grid::from_shape_fn((64, 64), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64) - 31.5;
        if p.length() < 20.0 { 200.0 } else { 60.0 }
    })
}

fn sample(times: u32) -> Outcome<()> {
    let field = field::edge_force(&picture(), &EdgeForce::as_strong_as_the_report())?;
    let points: Vec<DVec2> = wave(1000).iter().map(|p| 31.5 + 20.0 * *p).collect();
    let mut forces = points.clone();
    for _ in 0..times {
        field.sample_into(black_box(&points), Interpolation::Bilinear, &mut forces);
    }
    black_box(&forces);
    Ok(())
}

fn report(times: u32) -> Outcome<()> {
    let picture = picture();
    for _ in 0..times {
        let passes = field::REPORT_PASSES;
        black_box(field::report_force(
            black_box(&picture),
            passes,
            field::REPORT_SCALE,
            field::REPORT_GAIN,
        )?);
    }
    Ok(())
}

fn edge(times: u32) -> Outcome<()> {
    let (picture, rule) = (picture(), EdgeForce::as_strong_as_the_report());
    for _ in 0..times {
        black_box(field::edge_force(black_box(&picture), &rule)?);
    }
    Ok(())
}

/// A field in single precision: 262 144 pixels of 8 bits.
fn fast(recipe: field::Recipe, times: u32) -> Outcome<()> {
    let picture = ndarray::Array2::from_shape_fn((512, 512), |(y, x)| {
        u8::try_from((7 * x + 3 * y) % 251).unwrap_or_default()
    });
    let mut fast = field::FastForce::new(recipe, 1)?;
    let mut field = fast.field(picture.view())?;
    for _ in 0..times {
        fast.field_into(black_box(picture.view()), &mut field)?;
    }
    Ok(())
}

/// Instructions of one run of a kernel, as callgrind counts them.
fn count(name: &str) -> Outcome<u64> {
    let all = |times: u32| -> Outcome<u64> {
        let run = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(std::env::current_exe()?)
            .args(["--kernel", name, &times.to_string()])
            .output()?;
        let said = String::from_utf8_lossy(&run.stderr);
        let total = said.lines().find_map(|line| {
            let (_, count) = line.split_once("Collected :")?;
            count.trim().parse().ok()
        });
        total.ok_or_else(|| format!("valgrind has not counted {name}:\n{said}").into())
    };
    Ok((all(TIMES)? - all(0)?) / u64::from(TIMES))
}

fn table() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "counts.csv"].iter().collect()
}

/// What a program answers to `--version`, or nothing where there is none.
fn version(program: &str) -> Option<String> {
    let run = Command::new(program).arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&run.stdout);
    text.lines().next().map(str::to_owned)
}

/// The widest instruction set that kernels find under valgrind.
fn instruction_set() -> Outcome<String> {
    let run = Command::new("valgrind")
        .args(["--tool=none", "--quiet"])
        .arg(std::env::current_exe()?)
        .arg("--instruction-set")
        .output()?;
    Ok(String::from_utf8_lossy(&run.stdout).trim().to_owned())
}

/// The widest set that kernels choose among, on the processor this program sees.
fn widest() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        return "avx2";
    }
    std::env::consts::ARCH
}

/// The pinned counts: what they are from, and each kernel's.
fn pinned() -> Outcome<(String, Vec<(String, f64)>)> {
    let path = table();
    let text =
        std::fs::read_to_string(&path).map_err(|reason| format!("{}: {reason}", path.display()))?;
    let from = text.lines().find_map(|line| line.strip_prefix("# "));
    let from =
        from.ok_or_else(|| format!("{} must begin with \"# \" and a compiler", path.display()))?;
    let mut counts = Vec::new();
    for line in text.lines().skip(2) {
        let count = line
            .split_once(',')
            .and_then(|(name, count)| Some((name.to_owned(), count.parse().ok()?)));
        counts.push(count.ok_or_else(|| format!("{}: {line:?} is no count", path.display()))?);
    }
    Ok((from.to_owned(), counts))
}

fn check(accept: bool) -> Outcome<bool> {
    let (Some(compiler), Some(_)) = (version("rustc"), version("valgrind")) else {
        println!("SKIPPED: no valgrind here, or no rustc; no instructions were counted");
        return Ok(!accept);
    };
    let here = format!("{compiler}, {}", instruction_set()?);
    let (from, before) = if accept {
        (here.clone(), Vec::new())
    } else {
        pinned()?
    };
    if from != here {
        println!("SKIPPED: the counts are from {from}, this is {here}; nothing was compared");
        return Ok(true);
    }
    let mut good = true;
    for (name, _) in &before {
        if !KERNELS.iter().any(|(own, _)| own == name) {
            println!("{name:<28} is counted no longer");
            good = false;
        }
    }
    let mut found = format!("# {here}\nkernel,instructions\n");
    for (name, _) in KERNELS {
        let now = count(name)?;
        found += &format!("{name},{now}\n");
        let pinned = before.iter().find(|(own, _)| own == name);
        let change = pinned.map(|(_, before)| now as f64 / before - 1.0);
        let moved = change.is_none_or(|change| change.abs() > ALLOWED);
        good &= !moved;
        match change {
            Some(change) => {
                let word = if moved { "MOVED" } else { "as pinned" };
                println!("{name:<28} {now:>9}  {:+6.2} %  {word}", 100.0 * change);
            }
            None => println!("{name:<28} {now:>9}  new"),
        }
    }
    if accept {
        std::fs::write(table(), found)?;
        println!("written to {}", table().display());
        return Ok(true);
    }
    if !good {
        println!("if that is meant: cargo run --release -p benches --example counts -- --accept");
    }
    Ok(good)
}

fn run() -> Outcome<bool> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        [] => check(false),
        ["--accept"] => check(true),
        ["--instruction-set"] => {
            println!("{}", widest());
            Ok(true)
        }
        ["--kernel", name, times] => {
            let kernel = KERNELS.iter().find(|(own, _)| own == name);
            let (_, kernel) = kernel.ok_or_else(|| format!("no kernel {name}"))?;
            kernel(times.parse()?).map(|()| true)
        }
        _ => Err("usage: counts [--accept]".into()),
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            println!("{error}");
            ExitCode::from(2)
        }
    }
}
