//! Twenty balls on a rough slope: friction that sticks, and Coulomb's number where it slips.

use crate::prelude::*;
use snake::{Edit, Parameter, Snake, World};

const G: f64 = 4.0;
const ETA: f64 = 0.5;
const STEEP: [f64; 7] = [10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0];

/// Below the angle of friction they stay, above it they slide.
pub(crate) const SLOPE: Experiment = Experiment {
    id: "soft-slope",
    title: "Twenty balls on a rough slope",
    place: "beyond",
    question: "Friction of coefficient ½ holds on a slope up to 26.6°. Do balls on a flatter one stay where they are, and \
               on a steeper one slide at g (sin α − η cos α)?",
    claims: &[
        claim("on 20° nobody moves once they stand [Coulomb's friction]")
            .when(&[below("way in 12 s on 20°", 1e-6)]),
        claim("with friction from slip alone they creep [the same run without stick]")
            .when(&[above("the same without stick", 0.01)]),
        claim("above 26.6° they slide at g (sin α − η cos α), to a hundredth [Coulomb's friction, solved]")
            .judged(|r| {
                let found = r.column("angles", "acceleration")?;
                let exact = r.column("angles", "exact")?;
                let both = || found.iter().zip(exact);
                let slide = both().filter(|(_, exact)| **exact > 0.0);
                let off = most(slide.map(|(found, exact)| (found / exact - 1.0).abs()));
                let stay = both().filter(|(_, exact)| **exact <= 0.0);
                let stay = most(stay.map(|(found, _)| found.abs()));
                let percent = 100.0 * off;
                let words = format!("off by at most {percent:.2} %; below it {stay:.0e} px/s²");
                Ok(Finding::new(off < 0.01 && stay < 1e-4, words))
            }),
    ],
    run,
    draw,
};

/// The balls of the scene on a slope of so many degrees.
fn on(degrees: f64, stick: f64) -> Result<Group> {
    let mut scene = scene_with("slope", &[])?;
    let angle = degrees.to_radians();
    let lean = G * DVec2::new(angle.sin(), -angle.cos());
    let turn = |snake: &mut Snake| {
        let mut world = World::default().with_gravity(lean);
        world.walls.clone_from(&snake.world().walls);
        snake.set_world(world)
    };
    turn(&mut scene.snake)?;
    if let Some(company) = &mut scene.company {
        company
            .others
            .iter_mut()
            .try_for_each(|(snake, _)| turn(snake))?;
        if let Some(contact) = &mut company.contact {
            contact.stick = stick;
        }
    }
    // what rings inside a ball has nothing to do with the slope
    let mut group = group(&scene)?;
    for id in 0..group.members().len() {
        group.edit(id, Edit::Set(Parameter::Internal, 0.001))?;
    }
    Ok(group)
}

/// How fast balls slide.
fn slides(degrees: f64) -> f64 {
    let angle = degrees.to_radians();
    (G * (angle.sin() - ETA * angle.cos())).max(0.0)
}

fn centers(group: &Group) -> Vec<DVec2> {
    let each = group.members().iter();
    each.map(|m| elastic::center(&m.state().x, None)).collect()
}

fn run() -> Result {
    let mut record = Record::default();
    let (kept, loose) = (Tolerance::Absolute(1e-6), share(0.05));
    for (name, stick, tolerance, table) in [
        ("way in 12 s on 20° [px]", 1.0, kept, "stuck"),
        ("the same without stick [px]", 0.0, loose, "creeping"),
    ] {
        let mut group = on(20.0, stick)?;
        let start = centers(&group);
        let (mut way, mut settled) = (Vec::new(), start.clone());
        for step in 1..=10_000_u32 {
            advance(&mut group)?;
            if step == 4000 {
                settled = centers(&group);
            }
            if step % 50 == 0 {
                way.push((group.t(), centers(&group)[0].x - start[0].x));
            }
        }
        let ends = centers(&group);
        let far = most(settled.iter().zip(&ends).map(|(a, b)| a.distance(*b)));
        record.note(name, far, tolerance);
        record.keep(Table::raw(table).pairs("t [s]", "x [px]", &way));
    }
    let mut found = Vec::new();
    for degrees in STEEP {
        let mut group = on(degrees, 1.0)?;
        let first = watch(&mut group, 1500, 1500, &[0, 1500])?;
        let (t, then) = (group.t(), group.momentum().x);
        let second = watch(&mut group, 1500, 1500, &[1500])?;
        let mass = group.members().iter().map(|m| {
            let body = m.snake().body();
            body.mass.to_vec(body.len()).iter().sum::<f64>() * body.spacing
        });
        found.push((group.momentum().x - then) / (group.t() - t) / mass.sum::<f64>());
        if (degrees - 30.0).abs() < 1.0 {
            let frames = [first.run.frames, second.run.frames].concat();
            record.keep_run("balls", frames);
        }
    }
    record.keep(
        Table::new("angles")
            .exact("angle [°]", STEEP)
            .with("acceleration [px/s²]", 0.01, found)
            .with("exact [px/s²]", ROUNDING, STEEP.map(slides)),
    );
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    // the picture leans as the slope does
    let lean = DVec2::from_angle(-30_f64.to_radians());
    let row = record.run("balls")?.frames.iter().map(|frame| {
        let mut balls = frame.curves.clone();
        balls.retain(|ball| ball.id < 8);
        balls
            .iter_mut()
            .flat_map(|ball| &mut ball.nodes)
            .for_each(|p| *p = lean.rotate(*p));
        let color = |snake: usize| Color::SERIES[snake % 6];
        let title = format!("30°, t = {:.0} s", frame.t);
        let (from, to) = (DVec2::new(-2.0, 0.0), DVec2::new(30.0, 0.0));
        picture(title, &balls, [-2.0, -16.0, 26.0, 3.0], &color)
            .with(wall(lean.rotate(from), lean.rotate(to)))
    });
    let way =
        |table: &str, color| -> Result<Line> { Ok(line(record.points(table, "t", "x")?, color)) };
    let (time, place) = (("t / s", 0.0, 20.0), ("way / px", -0.05, 0.45));
    let stay = plot("the first ball on 20°", time, place)
        .with(way("creeping", Color::RED)?.named("friction from slip alone"))
        .with(way("stuck", Color::BLUE)?.named("friction that sticks"));
    let exact = (0..=130)
        .map(|k| 0.5 * f64::from(k))
        .map(|degrees| (degrees, slides(degrees)));
    let found = record.points("angles", "angle", "acceleration")?;
    let title = "acceleration down the slope";
    let slide = plot(title, ("angle / °", 0.0, 65.0), ("px/s²", -0.2, 4.2))
        .with(line(exact, Color::GREEN).named("g (sin α − η cos α)"))
        .with(dots(found, 3.0, Color::INK).named("twenty balls"));
    Artefact::only(
        "Above: the first eight of twenty balls on a slope steeper than friction holds. Below: on a flatter one they stay, and \
         creep if friction cannot stick; and how fast they slide on any.",
        Figure::new("Twenty balls on a rough slope", 1000.0)
            .with(230.0, row.collect())
            .with(270.0, vec![stay, slide]),
    )
}
