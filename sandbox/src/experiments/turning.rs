//! Report §5.2: a free spinning body, in a frame that turns with it and in one that does not.

use crate::prelude::*;
use elastic::{Material, Topology};
use integrator::State;
use snake::{Body, Snake, Upkeep, World};
use std::f64::consts::TAU;

/// Angular velocity at the start.
const OMEGA: f64 = 0.7;
const NAMES: [(&str, &str); 2] = [
    ("turning", "spin-turning"),
    ("translating", "spin-translating"),
];

/// An ellipse that spins freely.
pub(crate) const TURNING: Experiment = Experiment {
    id: "sec-5-2-turning",
    title: "A body frame that turns",
    place: "§5.2",
    question: "An ellipse is set spinning in empty space. In the report's frame, which moves but does not turn, rotation counts as \
               deformation. What does a frame that turns with the body change?",
    claims: &[
        claim("in the turning frame angular momentum is kept [report §5.2]")
            .when(&[below("turning: angular momentum off", 1e-9)]),
        claim("in the translating frame it is not: the rest shape turns the body back [D12]")
            .when(&[below("translating: least angular momentum", 0.0)]),
        claim(
            "only the centrifugal stretch costs elastic energy where the frame turns [report §5.2]",
        )
        .when(&[
            below("turning: most elastic energy", 0.1),
            above("translating: most elastic energy", 0.9),
        ]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let mut record = Record::default();
    let whole = TAU / OMEGA;
    let frames_of = [snake::Frame::turning(), snake::Frame::corrected()];
    for ((name, table), body_frame) in NAMES.into_iter().zip(frames_of) {
        let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(3.0, 1.8), 0.0, 40);
        let material = Material::uniform(50.0, 20.0, 5.0);
        let mut body = Body::of(&nodes, Topology::Closed, 1.0)?.with_material(material);
        body.frame = body_frame;
        let mut state = State::at_rest(nodes);
        for (v, x) in state.v.iter_mut().zip(&state.x) {
            *v = OMEGA * x.perp();
        }
        let snake = Snake::new(body, World::default())?;
        let mut group = group_of(snake, state, 2e-3, Upkeep::default())?;
        let (spin, energy) = (group.angular_momentum(), group.energies().total());
        let (mut spins, mut stretch) = (vec![(0.0, 1.0)], vec![(0.0, 0.0)]);
        let (mut shots, mut next) = (Vec::new(), 0.0);
        while group.t() < 2.0 * whole {
            if group.t() >= next {
                shots.push(frame(&group));
                next += whole / 4.0;
            }
            advance(&mut group)?;
            if group.steps().is_multiple_of(10) {
                spins.push((group.t(), group.angular_momentum() / spin));
                stretch.push((group.t(), group.energies().elastic() / energy));
            }
        }
        shots.truncate(5);
        let off = most(spins.iter().map(|p| (p.1 - 1.0).abs()));
        let close = if off < 1e-9 { ROUNDING } else { 1e-3 };
        let mut own = record.under(name);
        own.note("angular momentum off [of the start]", off, close);
        let lowest = least(spins.iter().map(|p| p.1));
        own.note("least angular momentum [of the start]", lowest, 1e-3);
        let highest = most(stretch.iter().map(|p| p.1));
        own.note("most elastic energy [of the start]", highest, 1e-3);
        let spins = Table::raw(table).pairs("t [s]", "spin", &spins);
        record.keep(spins.exact("elastic", stretch.iter().map(|p| p.1)));
        record.keep_run(name, shots);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("§5.2  An ellipse spinning in empty space", 1000.0);
    let (time, spin) = (("t / s", 0.0, 2.0 * TAU / OMEGA), ("", -1.2, 1.9));
    let mut momentum = plot("angular momentum, of the start", time, spin);
    let mut stretch = plot("elastic energy, of the whole", time, ("", 0.0, 1.5));
    let colors = [Color::BLUE, Color::RED];
    for ((name, _), color) in NAMES.into_iter().zip(colors) {
        let row = record.run(name)?.frames.iter().map(|frame| {
            let title = format!("{name}, t = {:.1} s", frame.t);
            let first = pair(frame.curves[0].nodes[0]);
            picture(title, &frame.curves, [-3.6, -3.6, 3.6, 3.6], &|_| color).with(dots(
                [first],
                2.5,
                Color::INK,
            ))
        });
        figure = figure.with(200.0, row.collect());
    }
    for ((name, table), color) in NAMES.into_iter().zip(colors).rev() {
        let over_time = |column: &str| -> Result<Line> {
            let points = record.points(table, "t", column)?;
            Ok(line(points, color).weighing(0.8).named(name))
        };
        momentum = momentum.with(over_time("spin")?);
        stretch = stretch.with(over_time("elastic")?);
    }
    Artefact::only(
        "The dot is the first node. Above, the frame turns with the body, as the best fit of the rest shape does; below it moves only, \
         and the rest shape turns the body to and fro.",
        figure.with(250.0, vec![momentum, stretch]),
    )
}
