//! The five soft bodies under three methods: the snake, masses and springs, positions.

mod mass_spring;
mod model;
#[cfg(test)]
mod tests;
mod touch;
mod world;
mod xpbd;

use crate::prelude::*;
use super::course::{keep_shots, picture, shots, wall};
use scene::Scene;
use world::{Method, World};

const ID: &str = "soft-peers";

/// One of the scenes, and what is read off it.
struct Case {
    scene: &'static str,
    /// What is read.
    result: &'static str,
    unit: &'static str,
    /// Other numbers of nodes of the first snakes.
    nodes: [&'static str; 3],
    time: f64,
    read: fn(&World) -> f64,
    /// The time of something, instead of what is there at the end.
    when: bool,
}

const CASES: [Case; 5] = [
    Case {
        scene: "rope",
        result: "length it hangs with",
        unit: "px",
        nodes: ["nodes = 41", "nodes = 27", "nodes = 61"],
        time: 120.0,
        read: |world| {
            let rope = world.curve(0);
            rope[0].y - rope[rope.len() - 1].y
        },
        when: false,
    },
    Case {
        scene: "gas-bag",
        result: "width over height at rest",
        unit: "",
        nodes: ["nodes = 48", "nodes = 32", "nodes = 72"],
        time: 60.0,
        read: |world| wide(world.curve(0)),
        when: false,
    },
    Case {
        scene: "pile",
        result: "mean height of the balls",
        unit: "px",
        nodes: ["nodes = 24", "nodes = 16", "nodes = 36"],
        time: 12.0,
        read: |world| {
            let each = (0..world.curves()).map(|k| elastic::center(world.curve(k), None).y);
            each.sum::<f64>() / real(world.curves())
        },
        when: false,
    },
    Case {
        scene: "funnel",
        result: "time at which it has passed",
        unit: "s",
        nodes: ["nodes = 40", "nodes = 28", "nodes = 60"],
        time: 20.0,
        read: |world| elastic::center(world.curve(0), None).y - 5.0,
        when: true,
    },
    Case {
        scene: "dented-ring",
        result: "width over height in the end",
        unit: "",
        nodes: ["nodes = 48", "nodes = 32", "nodes = 72"],
        time: 16.0,
        read: |world| wide(world.curve(0)),
        when: false,
    },
];

fn wide(x: &[DVec2]) -> f64 {
    let (low, high) = x
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
            (a.min(*p), b.max(*p))
        });
    (high.x - low.x) / (high.y - low.y)
}

/// The same five scenes, three ways.
pub(crate) const PEERS: Experiment = Experiment {
    id: ID,
    title: "Soft bodies by three methods",
    place: "beyond",
    question: "Masses with springs and hinges, and extended position-based dynamics, each written fairly and given its own \
               best step: what do they make of the same five scenes?",
    claims: &[
        claim("all keep momentum without walls [pushes are taken back where they are given]").judged(|r| {
                let mut off = 0.0_f64;
                for method in Method::ALL {
                    off = off.max(r.number(&format!("flung, {}: momentum off", method.name()))?);
                }
                Ok(Finding::new(
                    off < 1e-9,
                    format!("off by at most {off:.0e} of Σ|p|"),
                ))
            }),
        claim("of energy the snake keeps all, positions lose the more the longer their steps [the leapfrog is symplectic; a prediction put right is backward Euler]").judged(|r| {
                let mut left = Vec::new();
                for method in Method::ALL {
                    let name = method.name();
                    let keys = [
                        format!("rope, {name}: energy left after ten periods"),
                        format!("flung, {name}: energy left"),
                    ];
                    // of springs nothing is claimed
                    left.push(if name == "springs" {
                        [r.told(&keys[0])?, r.told(&keys[1])?]
                    } else {
                        [r.number(&keys[0])?, r.number(&keys[1])?]
                    });
                }
                let kept = left[0].iter().all(|e| (e - 1.0).abs() < 0.01);
                let words: Vec<String> = Method::ALL
                    .into_iter()
                    .zip(&left)
                    .map(|(method, [rope, balls])| {
                        format!("{} {rope:.3} and {balls:.3}", method.name())
                    })
                    .collect();
                Ok(Finding::new(
                    kept && (0..2).all(|of| left[3][of] < left[2][of]) && left[2][0] < 0.9,
                    format!("left of the rope's and of the balls': {}", words.join(", ")),
                ))
            }),
        claim("what the snake ends with depends least on nodes and step [parameters are densities along the curve]").judged(|r| {
                let mut worst = Vec::new();
                for method in Method::ALL {
                    worst.push((most_change(r, method)?, method.name()));
                }
                let others = worst.iter().skip(1).map(|w| w.0);
                let least = others.fold(f64::INFINITY, f64::min);
                let words: Vec<String> = worst
                    .iter()
                    .map(|(change, name)| format!("{name} {:.1} %", 100.0 * change))
                    .collect();
                Ok(Finding::new(
                    worst[0].0 < 0.05 && worst[0].0 < least,
                    format!("the most that any result changes: {}", words.join(", ")),
                ))
            }),
    ],
    run,
    draw,
};

/// The largest change of a result by other nodes or half the step; more than everything where it blew up.
fn most_change(record: &Record, method: Method) -> Result<f64> {
    let mut most = 0.0_f64;
    for case in &CASES {
        let name = format!("{}, {}", case.scene, method.name());
        let own = record.number(&format!("{name}: {}", case.result))?;
        for what in OTHERS {
            let change = (record.number(&format!("{name}: {what}"))? / own - 1.0).abs();
            most = most.max(if change.is_finite() {
                change
            } else {
                f64::INFINITY
            });
        }
    }
    Ok(most)
}

const OTHERS: [&str; 3] = [
    "with two thirds of the nodes",
    "with three halves of the nodes",
    "with half the step",
];

/// What a run is read for.
struct Reading {
    result: f64,
    deepest: f64,
    shot: Vec<(usize, bool, Vec<DVec2>)>,
}

/// One case under one method. A result that is no number: it blew up, or never happened.
fn read(
    case: &Case,
    method: Method,
    nodes: usize,
    share: f64,
) -> Result<(f64, Reading)> {
    let scene = scene_with(case.scene, &[(case.nodes[0], case.nodes[nodes])])?;
    // the snake's own limit goes with the square of the spacing
    let count = |k: usize| -> f64 {
        let number = case.nodes[k].rsplit(' ').next().unwrap_or("1");
        number.parse().unwrap_or(1.0)
    };
    let finer = (count(0) / count(nodes)).powi(2).min(1.0);
    let share = if method == Method::Springs {
        share
    } else {
        share * finer
    };
    let mut world = World::new(ID, &scene, method, share)?;
    let (mut result, mut deepest) = (f64::NAN, 0.0_f64);
    let mut next = 0.0;
    while world.t() < case.time - 0.5 * world.dt {
        world.step(ID)?;
        if !world.is_fine() {
            break;
        }
        if world.t() >= next {
            next += 0.02;
            deepest = deepest.max(world.deepest());
        }
        if case.when && (case.read)(&world) < 0.0 {
            result = world.t();
            break;
        }
    }
    if !case.when && world.is_fine() {
        result = (case.read)(&world);
    }
    let shot = (0..world.curves())
        .map(|k| (k, world.closed(k), world.curve(k).to_vec()))
        .collect();
    let dt = world.dt;
    Ok((
        dt,
        Reading {
            result,
            deepest,
            shot,
        },
    ))
}

fn cases(record: &mut Record) -> Result<()> {
    let like = share(0.05);
    for case in &CASES {
        let mut kept = Vec::new();
        for (k, method) in Method::ALL.into_iter().enumerate() {
            let name = format!("{}, {}", case.scene, method.name());
            let (dt, own) = read(case, method, 0, 1.0)?;
            record.note(format!("{name}: step [s]"), dt, share(1e-9));
            record.note(format!("{name}: {} [{case.unit}]", case.result), own.result, like);
            record.note(format!("{name}: deepest overlap [px]"), own.deepest, share(0.1));
            for ((nodes, share), what) in [(1, 1.0), (2, 1.0), (0, 0.5)].into_iter().zip(OTHERS) {
                let (_, other) = read(case, method, nodes, share)?;
                record.note(format!("{name}: {what} [{case.unit}]"), other.result, like);
            }
            for (curve, closed, x) in own.shot {
                kept.push((real(k), curve, closed, x));
            }
        }
        keep_shots(record, case.scene, &kept);
    }
    Ok(())
}

/// The rope without damping and gravity: its energy, and where its free end is.
fn swing(record: &mut Record) -> Result<()> {
    let still = [("damping = 0.15", "damping = 0.0"), ("-2.0]", "0.0]")];
    let scene = scene_with("rope", &still)?;
    for (method, table) in Method::ALL
        .into_iter()
        .zip(["swing-0", "swing-1", "swing-2", "swing-3"])
    {
        let mut world = World::new(ID, &scene, method, 1.0)?;
        let first = world.energy().1;
        let (mut t, mut left, mut tail, mut crossings) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut before = 10.0;
        while world.t() < 80.0 {
            world.step(ID)?;
            let rope = world.curve(0);
            let x = rope[rope.len() - 1].x - 0.1;
            if x * before < 0.0 {
                crossings.push(world.t() - world.dt * x / (x - before));
            }
            before = x;
            t.push(world.t());
            tail.push(x);
            left.push(world.energy().1 / first);
        }
        let name = method.name();
        let last = crossings.len() - 1;
        let period = 2.0 * (crossings[last] - crossings[0]) / real(last);
        let like = share(0.01);
        record.note(format!("rope, {name}: period [s]"), period, like);
        let kept = left.last().copied().unwrap_or(f64::NAN);
        record.note(format!("rope, {name}: energy left after ten periods [of it]"), kept, like);
        record.keep(
            Table::raw(table)
                .exact("t [s]", t)
                .exact("energy", left)
                .exact("x [px]", tail),
        );
    }
    Ok(())
}

/// The pile's balls flung at each other in empty space, without loss of any kind asked for.
fn flung(record: &mut Record) -> Result<()> {
    let changes = [
        ("damping = 0.6", "damping = 0.0"),
        ("-4.0]", "0.0]"),
        ("damping = 8.0", "damping = 0.0"),
        ("friction = 0.4", "friction = 0.0"),
    ];
    let mut scene = scene_with("pile", &changes)?;
    let bare = |snake: &mut snake::Snake| snake.set_world(snake::World::default());
    let aim = |x: &[DVec2]| {
        0.6 * (DVec2::new(10.0, 12.0) - elastic::center(x, None)) + DVec2::new(0.5, 0.2)
    };
    let fling = |scene: &mut Scene| -> Result<(), snake::SnakeError> {
        bare(&mut scene.snake)?;
        scene.start.v.fill(aim(&scene.start.x));
        if let Some(company) = &mut scene.company {
            for (snake, state) in &mut company.others {
                bare(snake)?;
                state.v.fill(aim(&state.x));
            }
        }
        Ok(())
    };
    fling(&mut scene)?;
    for (method, table) in Method::ALL
        .into_iter()
        .zip(["flung-0", "flung-1", "flung-2", "flung-3"])
    {
        let mut world = World::new(ID, &scene, method, 1.0)?;
        let (start, first) = (world.momentum(), world.energy().1);
        let scale: f64 = start.length().max(first.sqrt());
        let (mut off, mut t, mut left) = (0.0_f64, Vec::new(), Vec::new());
        let mut next = 0.0;
        while world.t() < 6.0 {
            world.step(ID)?;
            if world.t() >= next {
                next += 0.01;
                off = off.max(world.momentum().distance(start) / scale);
                t.push(world.t());
                left.push(world.energy().1 / first);
            }
        }
        let name = method.name();
        record.note(format!("flung, {name}: momentum off [of it]"), off, 1e-9);
        let kept = left.last().copied().unwrap_or(f64::NAN);
        record.note(format!("flung, {name}: energy left [of it]"), kept, share(0.05));
        record.keep(Table::raw(table).exact("t [s]", t).exact("energy", left));
    }
    Ok(())
}

fn run() -> Result {
    let mut record = Record::default();
    swing(&mut record)?;
    flung(&mut record)?;
    cases(&mut record)?;
    Ok(record)
}

/// The methods' colors.
const COLORS: [Color; 4] = [Color::BLUE, Color::ORANGE, Color::GREEN, Color::PURPLE];

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("Soft bodies by three methods", 1000.0);
    for (table, window, height) in [
        ("pile", [-0.6, -0.6, 20.6, 14.0], 190.0),
        ("gas-bag", [-5.0, -0.5, 5.0, 6.0], 190.0),
        ("dented-ring", [-5.0, -0.5, 5.0, 6.0], 190.0),
    ] {
        let all = shots(record, table)?;
        let mut row = Vec::new();
        for (k, method) in Method::ALL.into_iter().enumerate() {
            let [x0, _, x1, _] = window;
            let title = format!("{table}: {}", method.name());
            let panel = picture(title, &all, real(k), window, &|_| COLORS[k]);
            row.push(panel.with(wall(DVec2::new(x0, 0.0), DVec2::new(x1, 0.0))));
        }
        figure = figure.with(height, row);
    }
    let mut swing = plot("the free end of the undamped rope", ("t / s", 40.0, 80.0), ("x / px", -12.0, 25.0));
    let mut energy = plot("its energy", ("t / s", 0.0, 80.0), ("share", 0.0, 2.0));
    let mut thrown = plot("energy of twenty balls flung at each other", ("t / s", 0.0, 6.0), ("share", 0.0, 2.0));
    for (k, method) in Method::ALL.into_iter().enumerate() {
        let line = |points| line(points, COLORS[k]).named(method.name());
        let (a, b) = (format!("swing-{k}"), format!("flung-{k}"));
        let mut tail = record.points(&a, "t", "x")?;
        tail.retain(|p| p.0 >= 40.0);
        swing = swing.with(line(tail));
        energy = energy.with(line(record.points(&a, "t", "energy")?));
        thrown = thrown.with(line(record.points(&b, "t", "energy")?));
    }
    figure = figure.with(270.0, vec![swing, energy, thrown]);
    Artefact::only("Three of the scenes at their end under each method, and what becomes of energy where nothing should take any.",
        figure,)
}
