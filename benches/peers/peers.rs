//! The same problems by general solvers and by ours, in one run: the bars of the schemes.
//!
//! `cargo bench -p peers` prints a table and the ratios. Peers get the very forces our schemes
//! get, as a system of first order, and each its best tolerance: the fastest run within 1e-3 counts. Setting up
//! a peer's problem is not timed, setting up ours is.

#![allow(clippy::print_stdout, reason = "a bench tells what it found")]

use banded::Operator;
use benches::{Effort, NODES, Stopwatch, Trial, edge, effort, least_steps, ring, scan};
use diffsol::{
    FaerSparseLU, FaerSparseMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, Vector,
};
use glam::{DMat2, DVec2};
use integrator::Scheme;
use ode_solvers::{DVector, Dop853, OutputType};
use sandbox::SandboxError;
use std::cell::RefCell;

/// What every answer must reach. px.
const TARGET: f64 = 1e-3;

/// A run of a general solver: the tolerance it was given, its error and its time.
#[derive(Clone, Copy)]
struct Run {
    tolerance: f64,
    error: f64,
    seconds: f64,
}

/// A trial as a system of first order: positions, then velocities.
struct FirstOrder {
    trial: RefCell<Trial>,
    stiffness: Operator,
}

impl FirstOrder {
    fn new(trial: Trial) -> Self {
        let stiffness = trial.system.stiffness().clone();
        Self {
            trial: RefCell::new(trial),
            stiffness,
        }
    }

    fn start(&self) -> Vec<f64> {
        let trial = self.trial.borrow();
        trial
            .start
            .x
            .iter()
            .chain(&trial.start.v)
            .flat_map(|p| p.to_array())
            .collect()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let system = &mut self.trial.borrow_mut().system;
        let (x, v) = (points(&y[..2 * NODES]), points(&y[2 * NODES..]));
        let mut force = vec![DVec2::ZERO; NODES];
        system.elastic(&x, &mut force);
        // where a peer tries a point of no force it gets a NaN and comes back
        if system.external(t, &x, &v, &mut force).is_err() {
            force.fill(DVec2::NAN);
        }
        let (mass, damping) = (system.mass()[0], system.damping()[0]);
        out[..2 * NODES].copy_from_slice(&y[2 * NODES..]);
        for i in 0..NODES {
            let a = (force[i] - damping * v[i]) / mass;
            (out[2 * NODES + 2 * i], out[2 * NODES + 2 * i + 1]) = (a.x, a.y);
        }
    }

    /// The Jacobian times a vector.
    fn slope(&self, t: f64, y: &[f64], w: &[f64], out: &mut [f64]) {
        let system = &mut self.trial.borrow_mut().system;
        let x = points(&y[..2 * NODES]);
        let (dx, dv) = (points(&w[..2 * NODES]), points(&w[2 * NODES..]));
        let mut slope = vec![DMat2::ZERO; NODES];
        system.external_slope(t, &x, &mut slope);
        let mut force = vec![DVec2::ZERO; NODES];
        self.stiffness.multiply_into(&dx, &mut force);
        let (mass, damping) = (system.mass()[0], system.damping()[0]);
        out[..2 * NODES].copy_from_slice(&w[2 * NODES..]);
        for i in 0..NODES {
            let a = (slope[i] * dx[i] - force[i] - damping * dv[i]) / mass;
            (out[2 * NODES + 2 * i], out[2 * NODES + 2 * i + 1]) = (a.x, a.y);
        }
    }

    /// Largest distance of a node from where it should be.
    fn error(&self, moment: usize, y: &[f64]) -> f64 {
        let trial = self.trial.borrow();
        let apart = points(&y[..2 * NODES]);
        apart
            .iter()
            .zip(&trial.truth[moment].1)
            .map(|(x, z)| x.distance(*z))
            .fold(0.0, f64::max)
    }

    /// When the trial is judged.
    fn moments(&self) -> Vec<f64> {
        let trial = self.trial.borrow();
        trial
            .truth
            .iter()
            .map(|(share, _)| share * trial.until)
            .collect()
    }
}

fn points(y: &[f64]) -> Vec<DVec2> {
    y.chunks_exact(2).map(DVec2::from_slice).collect()
}

impl ode_solvers::System<f64, DVector<f64>> for &FirstOrder {
    fn system(&self, t: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        self.rates(t, y.as_slice(), dy.as_mut_slice());
    }
}

fn dop853(problem: &FirstOrder, tolerance: f64) -> Option<Run> {
    let watch = Stopwatch::start();
    let (mut from, mut y, mut error) = (0.0, DVector::from_vec(problem.start()), 0.0_f64);
    for (moment, until) in problem.moments().into_iter().enumerate() {
        // its stiffness test would stop it here; all else is its default
        let mut solver = Dop853::from_param(
            problem,
            from,
            until,
            until - from,
            y,
            tolerance,
            tolerance,
            0.9,
            0.0,
            0.333,
            6.0,
            until - from,
            0.0,
            1_000_000,
            u32::MAX,
            OutputType::Sparse,
        );
        solver.integrate().ok()?;
        y = solver.y_out().last()?.clone();
        error = error.max(problem.error(moment, y.as_slice()));
        from = until;
    }
    Some(Run {
        tolerance,
        error,
        seconds: watch.seconds(),
    })
}

type Matrix = FaerSparseMat<f64>;
type Solver = FaerSparseLU<f64>;

#[derive(Clone, Copy)]
enum Diffsol {
    Tsit45,
    Esdirk34,
    Bdf,
}

fn diffsol(problem: &FirstOrder, method: Diffsol, tolerance: f64) -> Option<Run> {
    let start = problem.start();
    let built = OdeBuilder::<Matrix>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs_implicit(
            |y, _p, t, out| problem.rates(t, y, out),
            |y, _p, t, w, out| problem.slope(t, y, w, out),
        )
        .init(|_p, _t, y| y.copy_from_slice(&start), start.len())
        .build()
        .ok()?;
    let moments = problem.moments();
    let watch = Stopwatch::start();
    let error = match method {
        Diffsol::Tsit45 => follow(problem, built.tsit45().ok()?, &moments),
        Diffsol::Esdirk34 => follow(problem, built.esdirk34::<Solver>().ok()?, &moments),
        Diffsol::Bdf => follow(problem, built.bdf::<Solver>().ok()?, &moments),
    }?;
    Some(Run {
        tolerance,
        error,
        seconds: watch.seconds(),
    })
}

/// Step to every moment of truth; the largest error.
fn follow<'a, Eqn, S>(problem: &FirstOrder, mut solver: S, moments: &[f64]) -> Option<f64>
where
    Eqn: diffsol::OdeEquations<T = f64> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let watch = Stopwatch::start();
    let mut error = 0.0_f64;
    for (moment, &until) in moments.iter().enumerate() {
        solver.set_stop_time(until).ok()?;
        while !matches!(solver.step().ok()?, OdeSolverStopReason::TstopReached) {
            if watch.seconds() > 8.0 {
                return None;
            }
        }
        error = error.max(problem.error(moment, &solver.state().y.clone_as_vec()));
    }
    Some(error)
}

/// The fastest run within the target over a range of tolerances; each tolerance twice.
fn fastest(run: &Peer<'_>) -> Option<Run> {
    let tolerances = (2..=18).map(|halves| 10.0_f64.powf(-0.5 * f64::from(halves)));
    let mut within = 0;
    let mut best: Option<Run> = None;
    for tolerance in tolerances {
        for _ in 0..2 {
            let Some(now) = run(tolerance).filter(|run| run.error <= TARGET) else {
                continue;
            };
            within += 1;
            if best.is_none_or(|best| now.seconds < best.seconds) {
                best = Some(now);
            }
        }
        // tighter ones only take longer from here on
        if within >= 6 {
            break;
        }
    }
    best
}

/// A peer on a problem, waiting for a tolerance.
type Peer<'a> = dyn Fn(f64) -> Option<Run> + 'a;

/// All peers on a trial; the best time.
fn peers(trial: Trial) -> f64 {
    let problem = FirstOrder::new(trial);
    let mut best = f64::INFINITY;
    let all: [(&str, &Peer<'_>); 4] = [
        ("ode_solvers dop853", &|tolerance| {
            dop853(&problem, tolerance)
        }),
        ("diffsol tsit45", &|tolerance| {
            diffsol(&problem, Diffsol::Tsit45, tolerance)
        }),
        ("diffsol esdirk34", &|tolerance| {
            diffsol(&problem, Diffsol::Esdirk34, tolerance)
        }),
        ("diffsol bdf", &|tolerance| {
            diffsol(&problem, Diffsol::Bdf, tolerance)
        }),
    ];
    for (name, run) in all {
        match fastest(run) {
            Some(run) => {
                best = best.min(run.seconds);
                println!(
                    "  {name:<24} {:>12.1} µs   tolerance {:.1e}, error {:.1e}",
                    1e6 * run.seconds,
                    run.tolerance,
                    run.error
                );
            }
            None => println!("  {name:<24} does not get there"),
        }
    }
    best
}

/// Our schemes on a trial; the best time of those that are not exact, and the exact one's run.
fn ours(trial: &mut Trial) -> (f64, Option<Effort>) {
    let mut best = f64::INFINITY;
    for &scheme in Scheme::ALL {
        let exact = matches!(scheme, Scheme::Exact | Scheme::Etd2);
        let general = matches!(
            scheme,
            Scheme::DormandPrince { .. } | Scheme::GradientFlow | Scheme::LinearlyImplicit
        );
        if general {
            continue;
        }
        let seen = scan(trial, scheme);
        let Some(run) = least_steps(trial, scheme, &seen, TARGET) else {
            println!("  {:<24} does not get there", scheme.name());
            continue;
        };
        if !exact {
            best = best.min(run.seconds);
        }
        println!(
            "  {:<24} {:>12.1} µs   {} steps, {} forces, error {:.1e}; its steps alone {:.1} µs",
            scheme.name(),
            1e6 * run.seconds,
            run.steps,
            run.forces,
            run.error,
            1e6 * run.stepping
        );
    }
    (best, effort(trial, Scheme::Etd2, trial.truth.len() as u64))
}

/// The bars are for the stiff ring; nothing is asked of the other.
fn asked(ratio: f64, bar: f64) -> f64 {
    if ratio > 1e5 { bar } else { 1.0 }
}

fn verdict(what: &str, found: f64, bar: f64) {
    let word = if found >= bar { "met" } else { "MISSED" };
    println!("  {word}: {what}: {found:.0} times, asked {bar:.0}");
}

fn main() -> Result<(), SandboxError> {
    for ratio in [1e4, 1e6] {
        println!(
            "ring of {NODES} nodes in gravity, stiffness ratio {ratio:.0e}, to {TARGET:.0e} px"
        );
        let best = peers(ring(ratio, 1.0)?);
        let (implicit, falling) = ours(&mut ring(ratio, 1.0)?);
        let free = effort(&mut ring(ratio, 0.0)?, Scheme::Exact, 1);
        for (name, run) in [("etd2, in gravity", falling), ("exact, free", free)] {
            let Some(run) = run else { continue };
            println!("  {name}: one step of 5 s, error {:.1e} px", run.error);
            verdict("its step", best / run.stepping, asked(ratio, 5000.0));
            verdict(
                "the same, set-up included",
                best / run.seconds,
                asked(ratio, 5000.0),
            );
        }
        verdict("best other scheme", best / implicit, asked(ratio, 80.0));
    }
    println!("ring on an edge, stiffness ratio 1e6, to {TARGET:.0e} px");
    let best = peers(edge(1e6)?);
    let (own, _) = ours(&mut edge(1e6)?);
    println!("  best peer over best of ours: {:.0}", best / own);
    Ok(())
}
