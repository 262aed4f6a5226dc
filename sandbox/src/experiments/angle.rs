//! Figure 5.1: the difference in direction of two vectors (report §5.3).

use crate::prelude::*;
use elastic::{Estimate, turning_angle};

const EDGE: f64 = 1.0;
/// The angle that is drawn.
const SHOWN: f64 = 50.0;

/// Figure 5.1: 2 sin(θ/2), drawn and checked.
pub(crate) const ANGLE: Experiment = Experiment {
    id: "fig-5-1",
    title: "Difference in direction of two vectors",
    place: "Figure 5.1",
    question: "Two edges of the snake meet at a node and differ in direction by θ. Is the difference of their unit \
               vectors 2 sin(θ/2) long, and does the arc cosine of §5.3, as printed, give θ?",
    claims: &[
        claim("the length of u₂/|u₂| − u₁/|u₁| is 2 sin(θ/2) [report §5.3, D79]")
            .when(&[below("unit vectors against 2 sin(θ/2)", 1e-14)]),
        claim("it is θ for small angles, and less for sharp ones [report §5.3]").when(&[
            above("2 sin(θ/2) over θ at 10°", 0.998),
            below("2 sin(θ/2) over θ at 90°", 0.91),
        ]),
        claim("the printed arc cosine, with a minus in the dot product, depends on the axes [D71]")
            .judged(|r| {
                let least = r.number("printed arc cosine of 50°: least")?;
                let most = r.number("printed arc cosine of 50°: largest")?;
                let right = r.number("turning angle of 50°: spread over directions")?;
                Ok(Finding::new(
                    most - least > 90.0 && right < 1e-12,
                    format!("{least:.0}° … {most:.0}° for the same 50°; with a plus always 50°"),
                ))
            }),
        claim("an arc cosine has no sign; the arc tangent of cross over dot has [D73]").when(&[
            near("turn by −50°", -50.0, 1e-9),
            near("turn by 50°", 50.0, 1e-9),
            near("arc cosine of a turn by *", 50.0, 1e-9),
        ]),
    ],
    run,
    draw,
};

/// The arc cosine as §5.3 prints it, with a minus between the products. Degrees.
fn as_printed(u: DVec2, w: DVec2) -> f64 {
    let cosine = (u.x * w.x - u.y * w.y) / (u.length() * w.length());
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

fn run() -> Result {
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=180).map(real).collect();
    let length = |degree: &f64| {
        let theta = degree.to_radians();
        let (u1, u2) = (DVec2::X * 3.0, DVec2::from_angle(theta) * 0.7);
        (u2 / u2.length() - u1 / u1.length()).length()
    };
    let lengths: Vec<f64> = degrees.iter().map(length).collect();
    let exact = degrees
        .iter()
        .map(|degree| 2.0 * (degree.to_radians() / 2.0).sin());
    let off = most(
        lengths
            .iter()
            .zip(exact)
            .map(|(length, exact)| (length - exact).abs()),
    );
    record.note("unit vectors against 2 sin(θ/2)", off, ROUNDING);
    for degree in [10_usize, 90] {
        let share = lengths[degree] / real(degree).to_radians();
        record.note(format!("2 sin(θ/2) over θ at {degree}°"), share, ROUNDING);
    }
    // what the estimates built on the two make of it: edges of length 1, so curvature is per edge
    let by = |which: Estimate| {
        let at = move |degree: &f64| DVec2::from_angle(degree.to_radians()) * EDGE;
        let estimate = move |degree| which.at(-DVec2::X * EDGE, DVec2::ZERO, at(degree), EDGE);
        degrees.iter().map(estimate)
    };
    record.keep(
        Table::new("angle")
            .exact("theta [°]", degrees.clone())
            .with("difference of unit vectors", ROUNDING, lengths)
            .with("turning angle [rad]", ROUNDING, by(Estimate::Turn))
            .with(
                "curvature by direction [1/px]",
                ROUNDING,
                by(Estimate::Direction),
            ),
    );

    let directions: Vec<f64> = (0..=72).map(|i| real(i) * 5.0).collect();
    let both = |direction: &f64| {
        let second = DVec2::from_angle((direction + SHOWN).to_radians()) * 1.3;
        (DVec2::from_angle(direction.to_radians()), second)
    };
    let printed = || directions.iter().map(both).map(|(u, w)| as_printed(u, w));
    let right = || {
        directions
            .iter()
            .map(both)
            .map(|(u, w)| turning_angle(u, w).to_degrees())
    };
    record.note(
        "printed arc cosine of 50°: least [°]",
        least(printed()),
        1e-5,
    );
    record.note(
        "printed arc cosine of 50°: largest [°]",
        most(printed()),
        1e-5,
    );
    let spread = most(right().map(|angle| (angle - SHOWN).abs()));
    record.note(
        "turning angle of 50°: spread over directions [°]",
        spread,
        ROUNDING,
    );
    for (name, turn) in [("turn by −50°", -SHOWN), ("turn by 50°", SHOWN)] {
        let other = DVec2::from_angle(turn.to_radians());
        let found = turning_angle(DVec2::X, other).to_degrees();
        record.note(format!("{name} [°]"), found, ROUNDING);
        // the formula of §5.3 with the plus that a dot product has (D71)
        let cosine = DVec2::X.dot(other).acos().to_degrees();
        record.note(format!("arc cosine of a {name} [°]"), cosine, ROUNDING);
    }
    record.keep(
        Table::new("direction")
            .exact("direction of the first edge [°]", directions.clone())
            .with("as printed [°]", 1e-5, printed())
            .with("turning angle [°]", ROUNDING, right()),
    );
    Ok(record)
}

/// The drawing itself: two edges, their unit vectors from one point, the difference.
fn sketch() -> Panel {
    let angle = |share: f64| DVec2::from_angle((12.0 + SHOWN * share).to_radians());
    let (first, second, middle) = (angle(0.0), angle(1.0), angle(0.5));
    let (u1, u2) = (first * 2.3, second * 1.7);
    let a = DVec2::new(-2.4, 0.1);
    let (b, c) = (a + u1, a + u1 + u2);
    let fan = DVec2::new(2.35, 0.15);
    let size = 2.2; // how large a unit vector is drawn
    let (tip1, tip2) = (fan + first * size, fan + second * size);
    let arc = |at: DVec2, radius: f64| {
        let points = (0..=40).map(|i| pair(at + angle(real(i) / 40.0) * radius));
        line(points, Color::GREEN)
    };
    let (right1, right2) = (-first.perp(), -second.perp());
    let (ink, grey, blue, red, green) = (
        Color::INK,
        Color::GREY,
        Color::BLUE,
        Color::RED,
        Color::GREEN,
    );
    let on = line([pair(b), pair(b + first * 1.5)], grey)
        .dashed()
        .weighing(0.6);
    let unit1 = fan + first * size * 0.62 + right1 * 0.28;
    let unit2 = fan + second * size * 0.62 - right2 * 0.55;
    let difference = tip1.lerp(tip2, 0.5) + DVec2::new(0.62, 0.12);
    plot("", ("", -2.8, 5.4), ("", -0.5, 2.75))
        .equal()
        .bare()
        .with(on)
        .with(arrow(a, u1, ink))
        .with(arrow(b, u2, ink))
        .with(arc(b, 0.8))
        .with(text(a + u1 * 0.5 + right1 * 0.25, "uᵢ", ink))
        .with(text(b + u2 * 0.55 - right2 * 0.3, "uᵢ₊₁", ink))
        .with(text(b + middle * 1.02, "θ", green))
        .with(dots([a, b, c].map(pair), 2.4, blue))
        .with(text(a - DVec2::new(0.0, 0.28), "node i−1", grey))
        .with(text(b + DVec2::new(0.1, -0.3), "node i", grey))
        .with(text(c + DVec2::new(-0.55, 0.12), "node i+1", grey))
        .with(arrow(fan, first * size, blue))
        .with(arrow(fan, second * size, blue))
        .with(arrow(tip1, tip2 - tip1, red))
        .with(arc(fan, 0.7))
        .with(text(fan + middle * 0.95, "θ", green))
        .with(text(unit1, "uᵢ/|uᵢ|", blue))
        .with(text(unit2, "uᵢ₊₁/|uᵢ₊₁|", blue))
        .with(text(difference, "2 sin(θ/2)", red))
}

fn draw(record: &Record) -> Drawn {
    let angle = |column: &str, color| -> Result<Line> {
        Ok(line(record.points("angle", "theta", column)?, color))
    };
    let theta = Axis::new("θ / °", 0.0, 180.0).with_ticks(7);
    let measure = plot("what stands in for θ", theta, ("", 0.0, 3.4))
        .legend_at(Corner::TopLeft)
        .with(angle("turning angle", Color::GREEN)?.named("θ in radians"))
        .with(angle("difference of unit vectors", Color::RED)?.named("2 sin(θ/2)"));
    let direction = |column: &str, color| -> Result<Line> {
        let first = "direction of the first edge";
        Ok(line(record.points("direction", first, column)?, color))
    };
    let x = Axis::new("direction of uᵢ / °", 0.0, 360.0).with_ticks(9);
    let printed = plot(
        "θ = 50° in every direction",
        x,
        ("angle found / °", 0.0, 250.0),
    )
    .with(direction("as printed", Color::RED)?.named("arc cosine as printed"))
    .with(direction("turning angle", Color::GREEN)?.named("arc tangent, signed"));
    Artefact::only(
        "Above: two edges meet at a node; their unit vectors from one point, and the difference. Below: what stands \
         in for the angle, and what the printed formula makes of 50°.",
        Figure::new("Figure 5.1  Difference in direction of two vectors", 760.0)
            .with(300.0, vec![sketch()])
            .with(250.0, vec![measure, printed]),
    )
}
