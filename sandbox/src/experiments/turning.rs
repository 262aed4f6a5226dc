//! Report §5.2: a free spinning body, in a frame that turns with it and in one that does not.

use super::soft::{advance, group, keep_shots, picture, shots, times};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Record, SandboxError, Table, Tolerance};
use elastic::{Material, Topology};
use glam::DVec2;
use integrator::State;
use snake::{Body, Frame, Snake, Upkeep, World};

const ID: &str = "sec-5-2-turning";
/// Angular velocity at the start.
const OMEGA: f64 = 0.7;
const NAMES: [(&str, &str, &str); 2] = [
    ("turning", "spin-turning", "shots-turning"),
    ("translating", "spin-translating", "shots-translating"),
];

/// An ellipse that spins freely.
pub(crate) const TURNING: Experiment = Experiment {
    id: ID,
    title: "A body frame that turns",
    place: "§5.2",
    question: "An ellipse is set spinning in empty space. In the report's frame, which moves but does not turn, rotation counts as \
               deformation. What does a frame that turns with the body change?",
    claims: &[
        Claim {
            says: "in the turning frame angular momentum is kept",
            source: "report §5.2",
            judge: |r| judged(r, &[below("turning: angular momentum off", 1e-9)]),
        },
        Claim {
            says: "in the translating frame it is not: the rest shape turns the body back",
            source: "D12",
            judge: |r| judged(r, &[below("translating: least angular momentum", 0.0)]),
        },
        Claim {
            says: "only the centrifugal stretch costs elastic energy where the frame turns",
            source: "report §5.2",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("turning: most elastic energy", 0.1),
                        above("translating: most elastic energy", 0.9),
                    ],
                )
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let dt = 2e-3;
    let whole = std::f64::consts::TAU / OMEGA;
    for ((name, table, pictures), frame) in NAMES
        .into_iter()
        .zip([Frame::turning(), Frame::corrected()])
    {
        let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(3.0, 1.8), 0.0, 40);
        let mut body = Body::of(&nodes, Topology::Closed, 1.0)
            .map_err(SandboxError::refused(ID))?
            .with_material(Material::uniform(50.0, 20.0, 5.0));
        body.frame = frame;
        let mut state = State::at_rest(nodes);
        for (v, x) in state.v.iter_mut().zip(&state.x) {
            *v = OMEGA * x.perp();
        }
        let snake = Snake::new(body, World::default()).map_err(SandboxError::refused(ID))?;
        let mut crowd = group(ID, vec![(snake, state)], dt, Upkeep::default())?;
        let (spin, energy) = (crowd.angular_momentum(), crowd.energies().total());
        let mut rows = vec![(0.0, 1.0, 0.0)];
        let mut kept = Vec::new();
        let mut next = 0.0;
        let (mut off, mut least, mut most) = (0.0_f64, 1.0_f64, 0.0_f64);
        while crowd.t() < 2.0 * whole {
            if crowd.t() >= next {
                let member = &crowd.members()[0];
                kept.push((crowd.t(), 0, true, member.state().x.clone()));
                next += whole / 4.0;
            }
            advance(ID, &mut crowd)?;
            if crowd.steps().is_multiple_of(10) {
                let share = crowd.angular_momentum() / spin;
                let elastic = crowd.energies().elastic() / energy;
                off = off.max((share - 1.0).abs());
                least = least.min(share);
                most = most.max(elastic);
                rows.push((crowd.t(), share, elastic));
            }
        }
        kept.truncate(5);
        let close = Tolerance::Absolute(1e-3);
        let rounding = if off < 1e-9 {
            Tolerance::ROUNDING
        } else {
            close
        };
        record.note(
            format!("{name}: angular momentum off"),
            off,
            "of the start",
            rounding,
        );
        record.note(
            format!("{name}: least angular momentum"),
            least,
            "of the start",
            close,
        );
        record.note(
            format!("{name}: most elastic energy"),
            most,
            "of the start",
            close,
        );
        record.keep(
            Table::raw(table)
                .with(
                    "t",
                    "s",
                    Tolerance::EXACT,
                    rows.iter().map(|r| r.0).collect(),
                )
                .with(
                    "spin",
                    "",
                    Tolerance::EXACT,
                    rows.iter().map(|r| r.1).collect(),
                )
                .with(
                    "elastic",
                    "",
                    Tolerance::EXACT,
                    rows.iter().map(|r| r.2).collect(),
                ),
        );
        keep_shots(&mut record, pictures, &kept);
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new("§5.2  An ellipse spinning in empty space", 1000.0);
    for ((name, _, table), color) in NAMES.into_iter().zip([Color::BLUE, Color::RED]) {
        let all = shots(record, table)?;
        let row = times(&all)
            .into_iter()
            .map(|t| {
                let mut panel = picture(
                    format!("{name}, t = {t:.1} s"),
                    &all,
                    t,
                    [-3.6, -3.6, 3.6, 3.6],
                    &|_| color,
                );
                for shot in all.iter().filter(|shot| shot.t.to_bits() == t.to_bits()) {
                    panel = panel.with(Layer::Dots {
                        points: shot.points.iter().copied().take(1).collect(),
                        radius: 2.5,
                        color: Color::INK,
                        label: String::new(),
                    });
                }
                panel
            })
            .collect();
        figure = figure.with(200.0, row);
    }
    let end = 2.0 * std::f64::consts::TAU / OMEGA;
    let mut panels = Vec::new();
    for (column, title, from, to) in [
        ("spin", "angular momentum, of the start", -1.2, 1.9),
        ("elastic", "elastic energy, of the whole", 0.0, 1.5),
    ] {
        let mut panel = Panel::new(title, Axis::new("t / s", 0.0, end), Axis::new("", from, to))
            .legend_at(Corner::TopRight);
        for ((name, table, _), color) in NAMES.into_iter().zip([Color::BLUE, Color::RED]).rev() {
            panel = panel.with(
                Line::new(record.points(table, "t", column)?, color)
                    .weighing(0.8)
                    .named(name),
            );
        }
        panels.push(panel);
    }
    Ok(vec![Artefact::figure(
        "The dot is the first node. Above, the frame turns with the body, as the best fit of the rest shape does; below it moves only, \
         and the rest shape turns the body to and fro.",
        figure.with(250.0, panels),
    )])
}
