//! Crowds watched from start to end: energies, overlap, momentum and pictures.

use crate::draw::{Axis, Color, Line, Panel};
use crate::experiments::motion::pair;
use crate::{Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use integrator::{Scheme, State};
use scene::Scene;
use snake::{Energies, Entry, Rules, Simulation, Snake, Stepping, Until, Upkeep};
use std::ops::ControlFlow;

/// The terms of the account, as columns.
pub(crate) const TERMS: [&str; 10] = [
    "kinetic",
    "elastic",
    "outside",
    "between",
    "wall",
    "damping",
    "contact",
    "parameters",
    "upkeep",
    "scheme",
];

/// What watching a crowd gave.
#[derive(Debug)]
pub(crate) struct Course {
    /// Times of the account.
    pub t: Vec<f64>,
    /// One row a time, in the order of [`TERMS`].
    pub terms: Vec<[f64; 10]>,
    /// The deepest that any node was in another snake.
    pub deepest: f64,
    /// The greatest speed of a node.
    pub fastest: f64,
    /// Momentum at the start, and the largest distance from it.
    pub momentum: (DVec2, f64),
    /// Pictures: time, number of the snake, closed or not, nodes.
    pub shots: Vec<(f64, usize, bool, Vec<DVec2>)>,
}

/// A scene as a simulation that keeps an account of energies.
pub(crate) fn crowd_of(id: &'static str, scene: &Scene) -> Result<Simulation, SandboxError> {
    let stepping = Stepping {
        start: scene.plan.start_rule,
        force: scene.plan.force,
        ..Stepping::of(scene.plan.scheme, scene.plan.dt)
    };
    let mut snakes = vec![(scene.snake.clone(), scene.start.clone())];
    let mut rules = Rules {
        energies: true,
        ..Rules::default()
    };
    if let Some(company) = &scene.company {
        snakes.extend(company.others.iter().cloned());
        (rules.contact, rules.upkeep) = (company.contact, company.upkeep);
    }
    let entries = snakes.into_iter();
    let entries = entries.map(|(snake, state)| Entry::new(snake, state));
    Simulation::new(entries.collect(), stepping, &rules).map_err(SandboxError::refused(id))
}

/// Snakes that pass through each other and are looked after, by leapfrog steps of `dt`.
pub(crate) fn group(
    id: &'static str,
    snakes: Vec<(Snake, State)>,
    dt: f64,
    upkeep: Upkeep,
) -> Result<Simulation, SandboxError> {
    let rules = Rules {
        upkeep,
        energies: true,
        ..Rules::default()
    };
    let entries = snakes.into_iter();
    let entries = entries.map(|(snake, state)| Entry::new(snake, state));
    let stepping = Stepping::of(Scheme::Leapfrog, dt);
    Simulation::new(entries.collect(), stepping, &rules).map_err(SandboxError::refused(id))
}

/// The end of a lone snake by leapfrog steps of `dt`.
pub(crate) fn ended(
    id: &'static str,
    snake: Snake,
    start: State,
    dt: f64,
    until: &Until,
) -> Result<State, SandboxError> {
    let begun = Simulation::of(snake, start, Stepping::of(Scheme::Leapfrog, dt));
    let mut simulation = begun.map_err(SandboxError::refused(id))?;
    let end = simulation.run(until, &mut |_| ControlFlow::Continue(()));
    end.map_err(SandboxError::refused(id))?;
    Ok(simulation.members()[0].state().clone())
}

/// One step; a simulation that ends with it is refused.
pub(crate) fn advance(id: &'static str, simulation: &mut Simulation) -> Result<(), SandboxError> {
    match simulation.step().map_err(SandboxError::refused(id))? {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(outcome) => Err(SandboxError::refused(id)(outcome)),
    }
}

fn terms(energies: &Energies) -> [f64; 10] {
    [
        energies.kinetic,
        energies.elastic(),
        energies.forces[0],
        energies.forces[1],
        energies.wall,
        energies.damping,
        energies.contact,
        energies.parameters + energies.hand,
        energies.upkeep,
        energies.frame + energies.scheme,
    ]
}

/// Moves a crowd by so many steps; the account is read every `every` steps, pictures are taken at
/// the steps of `pictures`.
pub(crate) fn watch(
    id: &'static str,
    crowd: &mut Simulation,
    steps: u64,
    every: u64,
    pictures: &[u64],
) -> Result<Course, SandboxError> {
    let start = crowd.momentum();
    let mut course = Course {
        t: Vec::new(),
        terms: Vec::new(),
        deepest: 0.0,
        fastest: 0.0,
        momentum: (start, 0.0),
        shots: Vec::new(),
    };
    for step in 0..=steps {
        if step > 0 {
            advance(id, crowd)?;
            course.deepest = course.deepest.max(crowd.deepest());
        }
        if step.is_multiple_of(every) || step == steps {
            course.t.push(crowd.t());
            course.terms.push(terms(&crowd.energies()));
            let off = crowd.momentum().distance(start);
            course.momentum.1 = course.momentum.1.max(off);
            let speeds = crowd.members().iter().flat_map(|m| &m.state().v);
            course.fastest = speeds.fold(course.fastest, |most, v| most.max(v.length()));
        }
        if pictures.contains(&step) {
            for member in crowd.members() {
                let closed = member.is_closed();
                let shot = (crowd.t(), member.id(), closed, member.state().x.clone());
                course.shots.push(shot);
            }
        }
    }
    Ok(course)
}

impl Course {
    /// The sum of all terms at each time.
    pub(crate) fn totals(&self) -> Vec<f64> {
        self.terms.iter().map(|row| row.iter().sum()).collect()
    }

    /// How far the sum strays from where it began, as a share of the largest change of any term.
    pub(crate) fn gap(&self) -> f64 {
        gap(&self.terms)
    }

    /// Notes what every crowd is judged by.
    pub(crate) fn note(&self, record: &mut Record, name: &str, loose: f64) {
        let like = Tolerance::Relative(loose);
        // digits of rounding are no result
        let gap = Tolerance::Absolute(1e-9);
        record.note(
            format!("{name}: gap of the account"),
            self.gap(),
            "of the largest term",
            gap,
        );
        let deep = format!("{name}: deepest overlap");
        record.note(deep, self.deepest, "px", Tolerance::Relative(0.1));
        record.note(
            format!("{name}: greatest speed"),
            self.fastest,
            "px/s",
            like,
        );
    }

    /// Keeps the account and the pictures as tables of these names.
    pub(crate) fn keep(&self, record: &mut Record, account: &'static str, pictures: &'static str) {
        let mut table = Table::raw(account).with("t", "s", Tolerance::EXACT, self.t.clone());
        for (k, name) in TERMS.iter().enumerate() {
            let values = self.terms.iter().map(|row| row[k]).collect();
            table = table.with(*name, "", Tolerance::EXACT, values);
        }
        record.keep(table.with("total", "", Tolerance::EXACT, self.totals()));
        keep_shots(record, pictures, &self.shots);
    }
}

/// The largest change of the sum of each row, as a share of the largest change of one of its terms.
pub(crate) fn gap<const N: usize>(rows: &[[f64; N]]) -> f64 {
    let Some(first) = rows.first() else {
        return 0.0;
    };
    let total: f64 = first.iter().sum();
    let (mut off, mut most) = (0.0_f64, 0.0_f64);
    for row in rows {
        off = off.max((row.iter().sum::<f64>() - total).abs());
        for (now, then) in row.iter().zip(first) {
            most = most.max((now - then).abs());
        }
    }
    off / most.max(f64::MIN_POSITIVE)
}

/// Keeps pictures as a table of one row a node.
pub(crate) fn keep_shots(
    record: &mut Record,
    name: &'static str,
    shots: &[(f64, usize, bool, Vec<DVec2>)],
) {
    let mut columns: [Vec<f64>; 5] = Default::default();
    for (t, member, closed, nodes) in shots {
        for node in nodes {
            let row = [
                *t,
                real(*member),
                f64::from(u8::from(*closed)),
                node.x,
                node.y,
            ];
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(value);
            }
        }
    }
    let names = ["t", "snake", "closed", "x", "y"];
    let table = names.into_iter().zip(columns);
    record.keep(table.fold(Table::raw(name), |table, (name, values)| {
        table.with(name, "", Tolerance::EXACT, values)
    }));
}

/// One curve of a picture.
#[derive(Debug, Clone)]
pub(crate) struct Shot {
    /// When.
    pub t: f64,
    /// Whose.
    pub snake: usize,
    /// Its nodes, a closed one led back to its first.
    pub points: Vec<(f64, f64)>,
}

/// Pictures read back.
pub(crate) fn shots(record: &Record, name: &str) -> Result<Vec<Shot>, SandboxError> {
    let (t, snake) = (record.column(name, "t")?, record.column(name, "snake")?);
    let closed = record.column(name, "closed")?;
    let points = record.points(name, "x", "y")?;
    let mut out: Vec<Shot> = Vec::new();
    let mut loops = Vec::new();
    for i in 0..t.len() {
        let same = i > 0
            && t[i].to_bits() == t[i - 1].to_bits()
            && snake[i].to_bits() == snake[i - 1].to_bits();
        if !same {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "was a count"
            )]
            let number = snake[i] as usize;
            out.push(Shot {
                t: t[i],
                snake: number,
                points: Vec::new(),
            });
            loops.push(closed[i] > 0.5);
        }
        if let Some(shot) = out.last_mut() {
            shot.points.push(points[i]);
        }
    }
    for (shot, closed) in out.iter_mut().zip(loops) {
        if closed && let Some(&first) = shot.points.first() {
            shot.points.push(first);
        }
    }
    Ok(out)
}

/// The different times of pictures, in order.
pub(crate) fn times(shots: &[Shot]) -> Vec<f64> {
    let mut out: Vec<f64> = shots.iter().map(|shot| shot.t).collect();
    out.dedup_by(|a, b| a.to_bits() == b.to_bits());
    out
}

/// The pictures of one time in a panel without axes, the inside of closed curves filled.
pub(crate) fn picture(
    title: impl Into<String>,
    shots: &[Shot],
    t: f64,
    window: [f64; 4],
    color: &dyn Fn(usize) -> Color,
) -> Panel {
    let [x0, y0, x1, y1] = window;
    let mut panel = Panel::new(title, Axis::new("", x0, x1), Axis::new("", y0, y1))
        .equal()
        .bare();
    for shot in shots.iter().filter(|shot| shot.t.to_bits() == t.to_bits()) {
        let round = shot.points.first() == shot.points.last();
        if round {
            panel = panel.with(crate::draw::Layer::Area {
                points: shot.points.clone(),
                color: color(shot.snake),
                opacity: 0.18,
            });
        }
        panel = panel.with(Line::new(shot.points.clone(), color(shot.snake)).weighing(0.8));
    }
    panel
}

/// A wall from one point to another.
pub(crate) fn wall(from: DVec2, to: DVec2) -> Line {
    Line::new(vec![pair(from), pair(to)], Color::INK).weighing(1.4)
}

/// The account over time: what is there piled from zero up, and the sum.
pub(crate) fn account(
    record: &Record,
    table: &str,
    title: &str,
    chosen: &[(&str, &str, Color)],
) -> Result<Panel, SandboxError> {
    let t = record.column(table, "t")?;
    let mut ground = vec![0.0; t.len()];
    let mut layers = Vec::new();
    for (column, name, color) in chosen {
        let values = record.column(table, column)?;
        // a potential may begin anywhere
        let least = values.iter().copied().fold(0.0_f64, f64::min);
        let values = values.iter().map(|v| v - least);
        let top: Vec<f64> = ground.iter().zip(values).map(|(g, v)| g + v).collect();
        let mut area: Vec<(f64, f64)> = t.iter().copied().zip(top.iter().copied()).collect();
        let edge = area.clone();
        area.extend(t.iter().copied().zip(ground.iter().copied()).rev());
        layers.push((area, edge, *name, *color));
        ground = top;
    }
    let most = layers
        .iter()
        .flat_map(|(_, edge, ..)| edge.iter().map(|p| p.1))
        .fold(0.0_f64, f64::max);
    let end = t.last().copied().unwrap_or(1.0);
    let mut panel = Panel::new(
        title,
        Axis::new("t / s", 0.0, end),
        Axis::new("energy", 0.0, 1.35 * most),
    );
    for (area, edge, name, color) in layers {
        panel = panel
            .with(crate::draw::Layer::Area {
                points: area,
                color,
                opacity: 0.55,
            })
            .with(Line::new(edge, color).weighing(0.5).named(name));
    }
    Ok(panel)
}
