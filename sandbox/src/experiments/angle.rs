//! Figure 5.1: the difference in direction of two vectors (report §5.3).

use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{Estimate, turning_angle};
use glam::DVec2;

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
        Claim {
            says: "the length of u₂/|u₂| − u₁/|u₁| is 2 sin(θ/2)",
            source: "report §5.3, D79",
            judge: |r| judged(r, &[below("unit vectors against 2 sin(θ/2)", 1e-14)]),
        },
        Claim {
            says: "it is θ for small angles, and less for sharp ones",
            source: "report §5.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("2 sin(θ/2) over θ at 10°", 0.998),
                        below("2 sin(θ/2) over θ at 90°", 0.91),
                    ],
                )
            },
        },
        Claim {
            says: "the printed arc cosine, with a minus in the dot product, depends on the axes",
            source: "D71",
            judge: |r| {
                let (least, most) = (
                    r.number("printed arc cosine of 50°: least")?,
                    r.number("printed arc cosine of 50°: largest")?,
                );
                let right = r.number("turning angle of 50°: spread over directions")?;
                Ok(Finding::new(
                    most - least > 90.0 && right < 1e-12,
                    format!("{least:.0}° … {most:.0}° for the same 50°; with a plus always 50°"),
                ))
            },
        },
        Claim {
            says: "an arc cosine has no sign; the arc tangent of cross over dot has",
            source: "D73",
            judge: |r| {
                let (left, right) = (r.number("turn by −50°")?, r.number("turn by 50°")?);
                let cosines = (
                    r.number("arc cosine of a turn by −50°")?,
                    r.number("arc cosine of a turn by 50°")?,
                );
                let is = |found: f64, turn: f64| (found - turn).abs() < 1e-9;
                Ok(Finding::new(
                    is(left, -50.0)
                        && is(right, 50.0)
                        && is(cosines.0, 50.0)
                        && is(cosines.1, 50.0),
                    format!(
                        "arc cosine {:.0}° and {:.0}°, arc tangent {left:.0}° and {right:.0}°",
                        cosines.0, cosines.1
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The arc cosine as §5.3 prints it, with a minus between the products. Degrees.
fn as_printed(u: DVec2, w: DVec2) -> f64 {
    let cosine = (u.x * w.x - u.y * w.y) / (u.length() * w.length());
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=180).map(real).collect();
    let mut lengths = Vec::new();
    let mut off = 0.0_f64;
    for &degree in &degrees {
        let theta = degree.to_radians();
        let (u1, u2) = (DVec2::X * 3.0, DVec2::from_angle(theta) * 0.7);
        let length = (u2 / u2.length() - u1 / u1.length()).length();
        off = off.max((length - 2.0 * (theta / 2.0).sin()).abs());
        lengths.push(length);
    }
    record.note(
        "unit vectors against 2 sin(θ/2)",
        off,
        "",
        Tolerance::ROUNDING,
    );
    for degree in [10_usize, 90] {
        let share = lengths[degree] / real(degree).to_radians();
        record.note(
            format!("2 sin(θ/2) over θ at {degree}°"),
            share,
            "",
            Tolerance::ROUNDING,
        );
    }
    // what the estimates built on the two make of it: edges of length 1, so curvature is per edge
    let estimate = |which: Estimate, degree: f64| {
        which.at(
            -DVec2::X * EDGE,
            DVec2::ZERO,
            DVec2::from_angle(degree.to_radians()) * EDGE,
            EDGE,
        )
    };
    let by = |which| {
        degrees
            .iter()
            .map(|&degree| estimate(which, degree))
            .collect()
    };
    record.keep(
        Table::new("angle")
            .with("theta", "°", Tolerance::EXACT, degrees.clone())
            .with(
                "difference of unit vectors",
                "",
                Tolerance::ROUNDING,
                lengths,
            )
            .with(
                "turning angle",
                "rad",
                Tolerance::ROUNDING,
                by(Estimate::Turn),
            )
            .with(
                "curvature by direction",
                "1/px",
                Tolerance::ROUNDING,
                by(Estimate::Direction),
            ),
    );

    let directions: Vec<f64> = (0..=72).map(|i| real(i) * 5.0).collect();
    let pair = |direction: f64| {
        let first = DVec2::from_angle(direction.to_radians());
        (
            first,
            DVec2::from_angle((direction + SHOWN).to_radians()) * 1.3,
        )
    };
    let printed: Vec<f64> = directions
        .iter()
        .map(|&d| pair(d))
        .map(|(u, w)| as_printed(u, w))
        .collect();
    let right: Vec<f64> = directions
        .iter()
        .map(|&d| pair(d))
        .map(|(u, w)| turning_angle(u, w).to_degrees())
        .collect();
    let least = printed.iter().copied().fold(f64::INFINITY, f64::min);
    let most = printed.iter().copied().fold(0.0, f64::max);
    record.note(
        "printed arc cosine of 50°: least",
        least,
        "°",
        Tolerance::Absolute(1e-5),
    );
    record.note(
        "printed arc cosine of 50°: largest",
        most,
        "°",
        Tolerance::Absolute(1e-5),
    );
    let spread = right
        .iter()
        .map(|angle| (angle - SHOWN).abs())
        .fold(0.0, f64::max);
    record.note(
        "turning angle of 50°: spread over directions",
        spread,
        "°",
        Tolerance::ROUNDING,
    );
    for sign in [-1.0, 1.0] {
        let turned = turning_angle(DVec2::X, DVec2::from_angle((sign * SHOWN).to_radians()));
        let name = if sign < 0.0 {
            "turn by −50°"
        } else {
            "turn by 50°"
        };
        record.note(name, turned.to_degrees(), "°", Tolerance::ROUNDING);
        // the formula of §5.3 with the plus that a dot product has (D71)
        let other = DVec2::from_angle((sign * SHOWN).to_radians());
        record.note(
            format!("arc cosine of a {name}"),
            DVec2::X.dot(other).acos().to_degrees(),
            "°",
            Tolerance::ROUNDING,
        );
    }
    record.keep(
        Table::new("direction")
            .with(
                "direction of the first edge",
                "°",
                Tolerance::EXACT,
                directions,
            )
            .with("as printed", "°", Tolerance::Absolute(1e-5), printed)
            .with("turning angle", "°", Tolerance::ROUNDING, right),
    );
    Ok(record)
}

fn pair(v: DVec2) -> (f64, f64) {
    (v.x, v.y)
}

/// The drawing itself: two edges, their unit vectors from one point, the difference.
fn sketch() -> Panel {
    let first = DVec2::from_angle(12_f64.to_radians());
    let second = DVec2::from_angle((12.0 + SHOWN).to_radians());
    let (u1, u2) = (first * 2.3, second * 1.7);
    let (a, b) = (DVec2::new(-2.4, 0.1), DVec2::new(-2.4, 0.1) + u1);
    let c = b + u2;
    let fan = DVec2::new(2.35, 0.15);
    let size = 2.2; // how large a unit vector is drawn
    let arc: Vec<(f64, f64)> = (0..=40)
        .map(|i| (12.0 + SHOWN * real(i) / 40.0).to_radians())
        .map(|angle| pair(fan + DVec2::from_angle(angle) * 0.7))
        .collect();
    let turn: Vec<(f64, f64)> = (0..=40)
        .map(|i| (12.0 + SHOWN * real(i) / 40.0).to_radians())
        .map(|angle| pair(b + DVec2::from_angle(angle) * 0.8))
        .collect();
    let arrow = |from: DVec2, vector: DVec2, color| Layer::Arrows {
        arrows: vec![(pair(from), pair(vector))],
        color,
    };
    let words = |at: DVec2, text: &str, color| Layer::Text {
        at: pair(at),
        words: text.to_owned(),
        color,
        centered: true,
    };
    let (tip1, tip2) = (fan + first * size, fan + second * size);
    let side = |v: DVec2| DVec2::new(v.y, -v.x);
    Panel::new("", Axis::new("", -2.8, 5.4), Axis::new("", -0.5, 2.75))
        .equal()
        .bare()
        .with(
            Line::new(vec![pair(b), pair(b + first * 1.5)], Color::GREY)
                .dashed()
                .weighing(0.6),
        )
        .with(arrow(a, u1, Color::INK))
        .with(arrow(b, u2, Color::INK))
        .with(Line::new(turn, Color::GREEN))
        .with(words(a + u1 * 0.5 + side(first) * 0.25, "uᵢ", Color::INK))
        .with(words(
            b + u2 * 0.55 - side(second) * 0.3,
            "uᵢ₊₁",
            Color::INK,
        ))
        .with(words(
            b + DVec2::from_angle((12.0 + SHOWN / 2.0_f64).to_radians()) * 1.02,
            "θ",
            Color::GREEN,
        ))
        .with(Layer::Dots {
            points: vec![pair(a), pair(b), pair(c)],
            radius: 2.4,
            color: Color::BLUE,
            label: String::new(),
        })
        .with(words(a - DVec2::new(0.0, 0.28), "node i−1", Color::GREY))
        .with(words(b + DVec2::new(0.1, -0.3), "node i", Color::GREY))
        .with(words(c + DVec2::new(-0.55, 0.12), "node i+1", Color::GREY))
        .with(arrow(fan, first * size, Color::BLUE))
        .with(arrow(fan, second * size, Color::BLUE))
        .with(arrow(tip1, tip2 - tip1, Color::RED))
        .with(Line::new(arc, Color::GREEN))
        .with(words(
            fan + DVec2::from_angle((12.0 + SHOWN / 2.0_f64).to_radians()) * 0.95,
            "θ",
            Color::GREEN,
        ))
        .with(words(
            fan + first * size * 0.62 + side(first) * 0.28,
            "uᵢ/|uᵢ|",
            Color::BLUE,
        ))
        .with(words(
            fan + second * size * 0.62 - side(second) * 0.55,
            "uᵢ₊₁/|uᵢ₊₁|",
            Color::BLUE,
        ))
        .with(words(
            tip1.lerp(tip2, 0.5) + DVec2::new(0.62, 0.12),
            "2 sin(θ/2)",
            Color::RED,
        ))
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let line = |table: &str, x: &str, y: &str, color: Color| -> Result<Line, SandboxError> {
        Ok(Line::new(record.points(table, x, y)?, color))
    };
    let measure = Panel::new(
        "what stands in for θ",
        Axis::new("θ / °", 0.0, 180.0).with_ticks(7),
        Axis::new("", 0.0, 3.4),
    )
    .legend_at(Corner::TopLeft)
    .with(line("angle", "theta", "turning angle", Color::GREEN)?.named("θ in radians"))
    .with(line("angle", "theta", "difference of unit vectors", Color::RED)?.named("2 sin(θ/2)"));
    let printed = Panel::new(
        "θ = 50° in every direction",
        Axis::new("direction of uᵢ / °", 0.0, 360.0).with_ticks(9),
        Axis::new("angle found / °", 0.0, 250.0),
    )
    .legend_at(Corner::TopRight)
    .with(
        line(
            "direction",
            "direction of the first edge",
            "as printed",
            Color::RED,
        )?
        .named("arc cosine as printed"),
    )
    .with(
        line(
            "direction",
            "direction of the first edge",
            "turning angle",
            Color::GREEN,
        )?
        .named("arc tangent, signed"),
    );
    let figure = Figure::new("Figure 5.1  Difference in direction of two vectors", 760.0)
        .with(300.0, vec![sketch()])
        .with(250.0, vec![measure, printed]);
    Ok(vec![Artefact::figure(
        "Above: two edges meet at a node; their unit vectors from one point, and the difference. Below: what stands \
         in for the angle, and what the printed formula makes of 50°.",
        figure,
    )])
}
