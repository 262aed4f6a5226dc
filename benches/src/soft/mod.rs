//! The five soft bodies under three methods: the snake, masses and springs, positions.

mod mass_spring;
mod model;
#[cfg(test)]
mod tests;
mod touch;
mod world;
mod xpbd;

use integrator::State;
use sandbox::prelude::*;
use snake::Snake;
use world::{Method, World};

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
    let size = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = range(values, 0.0);
        high - low
    };
    size(&mut x.iter().map(|p| p.x)) / size(&mut x.iter().map(|p| p.y))
}

/// The same five scenes, three ways.
pub const PEERS: Experiment = Experiment {
    id: "soft-peers",
    title: "Soft bodies by three methods",
    place: "beyond",
    question: "Masses with springs and hinges, and extended position-based dynamics, each written fairly and given its own \
               best step: what do they make of the same five scenes?",
    claims: &[
        claim("all keep momentum without walls [pushes are taken back where they are given]")
            .when(&[below("flung, *: momentum off", 1e-9)]),
        claim("of energy the snake keeps all, positions lose the more the longer their steps \
               [the leapfrog is symplectic; a prediction put right is backward Euler]")
            .when(&[
                near("rope, snake: energy left after ten periods", 1.0, 0.01),
                near("flung, snake: energy left", 1.0, 0.01),
                below("rope, positions: energy left after ten periods", 0.9),
                less(
                    "rope, 8 passes: energy left after ten periods",
                    1.0,
                    "rope, positions: energy left after ten periods",
                ),
                less("flung, 8 passes: energy left", 1.0, "flung, positions: energy left"),
            ]),
        claim("what the snake ends with depends least on nodes and step [parameters are densities along the curve]")
            .judged(|r| {
                let worst = Method::ALL.map(|method| most_change(r, method));
                let worst = worst.into_iter().collect::<Result<Vec<f64>>>()?;
                let others = least(worst[1..].iter().copied());
                let words = Method::ALL.into_iter().zip(&worst);
                let words = words.map(|(method, change)| format!("{} {:.1} %", method.name(), 100.0 * change));
                let words = words.collect::<Vec<_>>().join(", ");
                Ok(Finding::new(
                    worst[0] < 0.05 && worst[0] < others,
                    format!("the most that any result changes: {words}"),
                ))
            }),
    ],
    run,
    draw,
};

/// The largest change of a result by other nodes or half the step; more than everything where it
/// blew up.
fn most_change(record: &Record, method: Method) -> Result<f64> {
    let mut largest = 0.0_f64;
    for case in &CASES {
        let name = format!("{}, {}", case.scene, method.name());
        let own = record.number(&format!("{name}: {}", case.result))?;
        for what in OTHERS {
            let change = (record.number(&format!("{name}: {what}"))? / own - 1.0).abs();
            largest = largest.max(if change.is_finite() {
                change
            } else {
                f64::INFINITY
            });
        }
    }
    Ok(largest)
}

const OTHERS: [&str; 3] = [
    "with two thirds of the nodes",
    "with three halves of the nodes",
    "with half the step",
];

/// What a run is read for.
struct Reading {
    dt: f64,
    result: f64,
    deepest: f64,
    end: Frame,
}

/// One case under one method. A result that is no number: it blew up, or never happened.
fn read(case: &Case, method: Method, nodes: usize, share: f64) -> Result<Reading> {
    let scene = scene_with(case.scene, &[(case.nodes[0], case.nodes[nodes])])?;
    // the snake's own limit goes with the square of the spacing
    let count = |k: usize| -> f64 {
        let number = case.nodes[k].rsplit(' ').next().unwrap_or("1");
        number.parse().unwrap_or(1.0)
    };
    let finer = match method {
        Method::Springs => 1.0,
        _ => (count(0) / count(nodes)).powi(2).min(1.0),
    };
    let mut world = World::new(&scene, method, share * finer)?;
    let (mut result, mut deepest, mut next) = (f64::NAN, 0.0_f64, 0.0);
    while world.t() < case.time - 0.5 * world.dt {
        world.step()?;
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
    Ok(Reading {
        dt: world.dt,
        result,
        deepest,
        end: world.frame(0.0),
    })
}

fn cases(record: &mut Record) -> Result<()> {
    let like = share(0.05);
    for case in &CASES {
        let mut ends = Vec::new();
        for method in Method::ALL {
            let name = format!("{}, {}", case.scene, method.name());
            let own = read(case, method, 0, 1.0)?;
            record.note(format!("{name}: step [s]"), own.dt, share(1e-9));
            let unit = case.unit;
            record.note(
                format!("{name}: {} [{unit}]", case.result),
                own.result,
                like,
            );
            record.note(
                format!("{name}: deepest overlap [px]"),
                own.deepest,
                share(0.1),
            );
            for ((nodes, share), what) in [(1, 1.0), (2, 1.0), (0, 0.5)].into_iter().zip(OTHERS) {
                let other = read(case, method, nodes, share)?.result;
                record.note(format!("{name}: {what} [{unit}]"), other, like);
            }
            ends.push(own.end);
        }
        record.keep_run(case.scene, ends);
    }
    Ok(())
}

/// The rope without damping and gravity: its energy, and where its free end is.
fn swing(record: &mut Record) -> Result<()> {
    let still = [("damping = 0.15", "damping = 0.0"), ("-2.0]", "0.0]")];
    let scene = scene_with("rope", &still)?;
    for (method, table) in Method::ALL.into_iter().zip(SWINGS) {
        let mut world = World::new(&scene, method, 1.0)?;
        let first = world.energy().1;
        let (mut left, mut tail, mut crossings) = (Vec::new(), Vec::new(), Vec::new());
        let mut before = 10.0;
        while world.t() < 80.0 {
            world.step()?;
            let rope = world.curve(0);
            let x = rope[rope.len() - 1].x - 0.1;
            if x * before < 0.0 {
                crossings.push(world.t() - world.dt * x / (x - before));
            }
            before = x;
            tail.push((world.t(), x));
            left.push(world.energy().1 / first);
        }
        let name = method.name();
        let last = crossings.len() - 1;
        let period = 2.0 * (crossings[last] - crossings[0]) / real(last);
        record.note(format!("rope, {name}: period [s]"), period, share(0.01));
        let kept = left[left.len() - 1];
        let energy = format!("rope, {name}: energy left after ten periods [of it]");
        record.note(energy, kept, share(0.01));
        record.keep(
            Table::raw(table)
                .pairs("t [s]", "x [px]", &tail)
                .exact("energy", left),
        );
    }
    Ok(())
}

/// The tables of the rope and of the balls under each method.
const SWINGS: [&str; 4] = ["swing-0", "swing-1", "swing-2", "swing-3"];
const FLUNG: [&str; 4] = ["flung-0", "flung-1", "flung-2", "flung-3"];

/// The pile's balls flung at each other in empty space, without loss of any kind asked for.
fn flung(record: &mut Record) -> Result<()> {
    let changes = [
        ("damping = 0.6", "damping = 0.0"),
        ("-4.0]", "0.0]"),
        ("damping = 8.0", "damping = 0.0"),
        ("friction = 0.4", "friction = 0.0"),
    ];
    let mut scene = scene_with("pile", &changes)?;
    let fling = |snake: &mut Snake, state: &mut State| {
        let way = DVec2::new(10.0, 12.0) - elastic::center(&state.x, None);
        state.v.fill(0.6 * way + DVec2::new(0.5, 0.2));
        snake.set_world(snake::World::default())
    };
    fling(&mut scene.snake, &mut scene.start)?;
    for (snake, state) in scene
        .company
        .iter_mut()
        .flat_map(|company| &mut company.others)
    {
        fling(snake, state)?;
    }
    for (method, table) in Method::ALL.into_iter().zip(FLUNG) {
        let mut world = World::new(&scene, method, 1.0)?;
        let (start, first) = (world.momentum(), world.energy().1);
        let scale: f64 = start.length().max(first.sqrt());
        let (mut off, mut left, mut next) = (0.0_f64, Vec::new(), 0.0);
        while world.t() < 6.0 {
            world.step()?;
            if world.t() >= next {
                next += 0.01;
                off = off.max(world.momentum().distance(start) / scale);
                left.push((world.t(), world.energy().1 / first));
            }
        }
        let name = method.name();
        record.note(format!("flung, {name}: momentum off [of it]"), off, 1e-9);
        let kept = left[left.len() - 1].1;
        record.note(
            format!("flung, {name}: energy left [of it]"),
            kept,
            share(0.05),
        );
        record.keep(Table::raw(table).pairs("t [s]", "energy", &left));
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
    for (name, window) in [
        ("pile", [-0.6, -0.6, 20.6, 14.0]),
        ("gas-bag", [-5.0, -0.5, 5.0, 6.0]),
        ("dented-ring", [-5.0, -0.5, 5.0, 6.0]),
    ] {
        let ends = Method::ALL
            .into_iter()
            .zip(COLORS)
            .zip(&record.run(name)?.frames);
        let row = ends.map(|((method, color), end)| {
            let title = format!("{name}: {}", method.name());
            let floor = wall((window[0], 0.0), (window[2], 0.0));
            picture(title, &end.curves, window, &|_| color).with(floor)
        });
        figure = figure.with(190.0, row.collect());
    }
    let title = "the free end of the undamped rope";
    let mut swing = plot(title, ("t / s", 40.0, 80.0), ("x / px", -12.0, 25.0));
    let mut energy = plot("its energy", ("t / s", 0.0, 80.0), ("share", 0.0, 2.0));
    let title = "energy of twenty balls flung at each other";
    let mut thrown = plot(title, ("t / s", 0.0, 6.0), ("share", 0.0, 2.0));
    for (k, method) in Method::ALL.into_iter().enumerate() {
        let own = |points: Vec<(f64, f64)>| line(points, COLORS[k]).named(method.name());
        let mut tail = record.points(SWINGS[k], "t", "x")?;
        tail.retain(|p| p.0 >= 40.0);
        swing = swing.with(own(tail));
        energy = energy.with(own(record.points(SWINGS[k], "t", "energy")?));
        thrown = thrown.with(own(record.points(FLUNG[k], "t", "energy")?));
    }
    Artefact::only(
        "Three of the scenes at their end under each method, and what becomes of energy where nothing should take any.",
        figure.with(270.0, vec![swing, energy, thrown]),
    )
}
