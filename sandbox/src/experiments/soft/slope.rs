//! Twenty balls on a rough slope: friction that sticks, and Coulomb's number where it slips.

use super::course::{advance, crowd_of, picture, shots, times, wall, watch};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use glam::DVec2;
use scene::Scene;
use snake::{Edit, Parameter, Simulation, World};

const ID: &str = "soft-slope";
const G: f64 = 4.0;
const ETA: f64 = 0.5;
const STEEP: [f64; 7] = [10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0];

/// Below the angle of friction they stay, above it they slide.
pub(crate) const SLOPE: Experiment = Experiment {
    id: ID,
    title: "Twenty balls on a rough slope",
    place: "beyond",
    question: "Friction of coefficient ½ holds on a slope up to 26.6°. Do balls on a flatter one stay where they are, and \
               on a steeper one slide at g (sin α − η cos α)?",
    claims: &[
        Claim {
            says: "on 20° nobody moves once they stand",
            source: "Coulomb's friction",
            judge: |r| judged(r, &[below("way in 12 s on 20°", 1e-6)]),
        },
        Claim {
            says: "with friction from slip alone they creep",
            source: "the same run without stick",
            judge: |r| judged(r, &[above("the same without stick", 0.01)]),
        },
        Claim {
            says: "above 26.6° they slide at g (sin α − η cos α), to a hundredth",
            source: "Coulomb's friction, solved",
            judge: |r| {
                let (found, exact) = (
                    r.column("angles", "acceleration")?,
                    r.column("angles", "exact")?,
                );
                let off = found
                    .iter()
                    .zip(exact)
                    .filter(|(_, exact)| **exact > 0.0)
                    .map(|(found, exact)| (found / exact - 1.0).abs())
                    .fold(0.0, f64::max);
                let stay = found
                    .iter()
                    .zip(exact)
                    .filter(|(_, exact)| **exact <= 0.0)
                    .map(|(found, _)| found.abs())
                    .fold(0.0, f64::max);
                Ok(Finding::new(
                    off < 0.01 && stay < 1e-4,
                    format!(
                        "off by at most {:.2} %; below it {stay:.0e} px/s²",
                        100.0 * off
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The balls of the scene on a slope of so many degrees.
fn on(degrees: f64, stick: f64) -> Result<Simulation, SandboxError> {
    let mut scene: Scene = changed_scene(ID, "slope", &[])?;
    let angle = degrees.to_radians();
    let lean = G * DVec2::new(angle.sin(), -angle.cos());
    let turned = |world: &World| {
        let mut out = World::default().with_gravity(lean);
        out.walls.clone_from(&world.walls);
        out
    };
    let refused = SandboxError::refused;
    let world = turned(scene.snake.world());
    scene.snake.set_world(world).map_err(refused(ID))?;
    if let Some(company) = &mut scene.company {
        for (snake, _) in &mut company.others {
            let world = turned(snake.world());
            snake.set_world(world).map_err(refused(ID))?;
        }
        if let Some(contact) = &mut company.contact {
            contact.stick = stick;
        }
    }
    // what rings inside a ball has nothing to do with the slope
    let mut crowd = crowd_of(ID, &scene)?;
    for id in 0..crowd.members().len() {
        let less = Edit::Set(Parameter::Internal, 0.001);
        crowd.edit(id, less).map_err(SandboxError::refused(ID))?;
    }
    Ok(crowd)
}

fn centers(crowd: &Simulation) -> Vec<DVec2> {
    let each = crowd.members().iter();
    each.map(|m| elastic::center(&m.state().x, None)).collect()
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, stick, table) in [
        ("way in 12 s on 20°", 1.0, "stuck"),
        ("the same without stick", 0.0, "creeping"),
    ] {
        let mut crowd = on(20.0, stick)?;
        let start = centers(&crowd);
        let (mut t, mut way) = (Vec::new(), Vec::new());
        let mut settled = start.clone();
        for step in 1..=10_000_u32 {
            advance(ID, &mut crowd)?;
            if step == 4000 {
                settled = centers(&crowd);
            }
            if step % 50 == 0 {
                t.push(crowd.t());
                way.push(centers(&crowd)[0].x - start[0].x);
            }
        }
        let ends = centers(&crowd);
        let far = settled.iter().zip(&ends).map(|(a, b)| a.distance(*b));
        let like = if stick > 0.0 {
            Tolerance::Absolute(1e-6)
        } else {
            Tolerance::Relative(0.05)
        };
        record.note(name, far.fold(0.0, f64::max), "px", like);
        record.keep(Table::raw(table).with("t", "s", Tolerance::EXACT, t).with(
            "x",
            "px",
            Tolerance::EXACT,
            way,
        ));
    }
    let (mut found, mut exact) = (Vec::new(), Vec::new());
    for degrees in STEEP {
        let mut crowd = on(degrees, 1.0)?;
        let pictures: &[u64] = if (degrees - 30.0).abs() < 1.0 {
            &[0, 1500, 3000]
        } else {
            &[]
        };
        let first = watch(ID, &mut crowd, 1500, 1500, pictures)?;
        let (t, then) = (crowd.t(), crowd.momentum().x);
        let second = watch(
            ID,
            &mut crowd,
            1500,
            1500,
            &pictures[pictures.len().min(1)..],
        )?;
        let mass: f64 = crowd
            .members()
            .iter()
            .map(|m| {
                let body = m.snake().body();
                body.mass.to_vec(body.len()).iter().sum::<f64>() * body.spacing
            })
            .sum();
        found.push((crowd.momentum().x - then) / (crowd.t() - t) / mass);
        let angle = degrees.to_radians();
        exact.push((G * (angle.sin() - ETA * angle.cos())).max(0.0));
        if !pictures.is_empty() {
            let mut all = first.shots;
            all.extend(second.shots);
            super::course::keep_shots(&mut record, "balls", &all);
        }
    }
    record.keep(
        Table::new("angles")
            .with("angle", "°", Tolerance::EXACT, STEEP.to_vec())
            .with("acceleration", "px/s²", Tolerance::Absolute(0.01), found)
            .with("exact", "px/s²", Tolerance::ROUNDING, exact),
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let balls = shots(record, "balls")?;
    let mut figure = Figure::new("Twenty balls on a rough slope", 1000.0);
    // the picture leans as the slope does
    let lean = DVec2::from_angle(-30_f64.to_radians());
    let mut row = Vec::new();
    for t in times(&balls) {
        let mut leaning = balls.clone();
        leaning.retain(|shot| shot.snake < 8);
        for shot in &mut leaning {
            for p in &mut shot.points {
                let turned = lean.rotate(DVec2::new(p.0, p.1));
                *p = (turned.x, turned.y);
            }
        }
        row.push(
            picture(
                format!("30°, t = {t:.0} s"),
                &leaning,
                t,
                [-2.0, -16.0, 26.0, 3.0],
                &|snake| Color::SERIES[snake % 6],
            )
            .with(wall(
                lean.rotate(DVec2::new(-2.0, 0.0)),
                lean.rotate(DVec2::new(30.0, 0.0)),
            )),
        );
    }
    figure = figure.with(230.0, row);
    let stay = Panel::new(
        "the first ball on 20°",
        Axis::new("t / s", 0.0, 20.0),
        Axis::new("way / px", -0.05, 0.45),
    )
    .with(
        Line::new(record.points("creeping", "t", "x")?, Color::RED)
            .named("friction from slip alone"),
    )
    .with(Line::new(record.points("stuck", "t", "x")?, Color::BLUE).named("friction that sticks"));
    let mut exact = Vec::new();
    for k in 0..=130 {
        let degrees = 0.5 * f64::from(k);
        let angle = degrees.to_radians();
        exact.push((degrees, (G * (angle.sin() - ETA * angle.cos())).max(0.0)));
    }
    let slide = Panel::new(
        "acceleration down the slope",
        Axis::new("angle / °", 0.0, 65.0),
        Axis::new("px/s²", -0.2, 4.2),
    )
    .with(Line::new(exact, Color::GREEN).named("g (sin α − η cos α)"))
    .with(Layer::Dots {
        points: record.points("angles", "angle", "acceleration")?,
        radius: 3.0,
        color: Color::INK,
        label: "twenty balls".to_owned(),
    });
    Ok(vec![Artefact::figure(
        "Above: the first eight of twenty balls on a slope steeper than friction holds. Below: on a flatter one they stay, and \
         creep if friction cannot stick; and how fast they slide on any.",
        figure.with(270.0, vec![stay, slide]),
    )])
}
