//! Figures 2.5 and 2.6: a hard ball against the rigid one, a very hard one against itself in a
//! thicker medium.

use super::course::{self, STEPS};
use super::draw;
use crate::prelude::*;

/// Runs a ball, and beside it another one whose numbers and course carry a prefix.
fn beside(scene: &str, prefix: &str, other: (&str, &[(&str, &str)])) -> Result {
    let mut record = Record::default();
    let (own, run) = course::follow(scene, &[])?;
    course::sum_up(&mut record, "", &own);
    course::keep(&mut record, &own, &run);
    let (second, _) = course::follow(other.0, other.1)?;
    course::sum_up(&mut record, prefix, &second);
    let apart = (0..own.t.len()).map(|i| own.center[i].distance(second.center[i]));
    record.note("centers apart at most", most(apart), STEPS);
    let stiffness = own.mode_stiffness / second.mode_stiffness;
    record.note(
        "stiffness of the first mode by the other's",
        stiffness,
        ROUNDING,
    );
    let rows = || (0..second.t.len()).step_by(20);
    record.keep(
        Table::raw("other")
            .exact("t [s]", rows().map(|i| second.t[i]))
            .exact("center x", rows().map(|i| second.center[i].x))
            .exact("center y", rows().map(|i| second.center[i].y))
            .exact("deformation", rows().map(|i| second.rms[i])),
    );
    Ok(record)
}

/// The usual figure with the other ball's way and deformation, dashed.
fn figure_beside(
    record: &Record,
    title: &str,
    (own, other): (&str, &str),
    caption: &'static str,
) -> Drawn {
    let mut figure = draw::figure(record, title)?;
    let way = line(
        record.points("other", "center x", "center y")?,
        Color::GREEN,
    );
    let shape = line(record.points("other", "t", "deformation")?, Color::GREEN);
    let largest = most(shape.points.iter().map(|p| p.1));
    if let Some(panel) = figure.rows[0].panels.first_mut() {
        panel.x.to = way.points.iter().fold(panel.x.to, |a, p| a.max(p.0));
        panel
            .layers
            .push(way.dashed().weighing(0.7).named(other).into());
    }
    if let Some(panel) = figure.rows[1].panels.first_mut() {
        if let Some(Layer::Line(line)) = panel.layers.first_mut() {
            line.label = own.to_owned();
        }
        panel.layers.push(shape.weighing(0.7).named(other).into());
        panel.y.to = panel.y.to.max(1.08 * largest) * 1.3;
    }
    draw::with_motion(record, figure, caption)
}

/// Figure 2.5: the same way, the shape back sooner.
pub(crate) const HARD: Experiment = Experiment {
    id: "fig-2-5",
    title: "A hard ball",
    place: "Figure 2.5",
    question: "How does the hard ball's motion differ from that of the rigid ball of Figure 2.4?",
    claims: &[
        claim("there is not a great difference between the translational motions [report §2.5]")
            .when(&[below("centers apart at most", 1.0)]),
        claim("except that the harder ball recovers its shape more quickly [report §2.5]").when(&[
            less("out of shape until", 0.7, "rigid ball: out of shape until"),
            less("out of shape until", 1.0, "last contact"),
        ]),
        claim("not because its ringing dies away faster: that rate is γ/2μ for both [D27, D68]")
            .when(&[like(
                "*ringing dies away: measured",
                "ringing dies away: predicted",
                0.02,
            )]),
        claim(
            "but because it is deformed less, as the root of its stiffness, and rings faster [D68]",
        )
        .judged(|r| {
            let own = r.number("largest deformation (rms)")?;
            let other = r.number("rigid ball: largest deformation (rms)")?;
            let ratio = r.number("stiffness of the first mode by the other's")?;
            let fast = r.number("ringing: measured")?;
            let slow = r.number("rigid ball: ringing: measured")?;
            let (times, root) = (other / own, ratio.sqrt());
            Ok(Finding::new(
                (times / root - 1.0).abs() < 0.1 && fast > 2.0 * slow,
                format!(
                    "{times:.2} times less deformed, root of the stiffness ratio {root:.2}; \
                         {fast:.1} against {slow:.1} rad/s"
                ),
            ))
        }),
    ],
    run: || beside("hard-ball", "rigid ball: ", ("rigid-ball", &[])),
    draw: |r| {
        figure_beside(
            r,
            "Figure 2.5  A hard ball",
            ("hard ball", "rigid ball, Figure 2.4"),
            "As Figure 2.2, hard; green: way and deformation of the rigid ball of Figure 2.4.",
        )
    },
};

/// Figure 2.6: mass and damping matter too.
pub(crate) const VERY_HARD: Experiment = Experiment {
    id: "fig-2-6",
    title: "A very hard ball",
    place: "Figure 2.6",
    question: "More than the elastic parameters was changed: lighter, and in a thinner medium. Do the elastic \
               parameters alone make the figure?",
    claims: &[
        claim("not only the elastic parameters are important: with the mass and drag of Figure 2.5, \
               the same ω's fly another way [report §2.5]")
            .when(&[above("centers apart at most", 3.0)]),
        claim("drag slows a ball long before the wall: without, it comes and goes faster [errata §6, D27]")
            .judged(|r| {
                let towards = r.number("speed towards the wall")?;
                let slow = r.number("same elasticity: speed towards the wall")?;
                let away = r.number("speed away from it")?;
                let slower = r.number("same elasticity: speed away from it")?;
                Ok(Finding::new(
                    towards > 2.2 && slow < 1.9 && away > slower + 0.4,
                    format!(
                        "{towards:.2} in and {away:.2} /s out, with the drag of the others \
                         {slow:.2} and {slower:.2}"
                    ),
                ))
            }),
        claim("it is the least deformed of all [errata §6]")
            .when(&[below("largest deformation (rms)", 0.1), below("out of shape until", 1.7)]),
    ],
    run: || {
        let changes = [("mass = 0.4", "mass = 1.0"),
                    ("damping = 0.02", "damping = 0.2"),];
        beside("very-hard-ball", "same elasticity: ", ("very-hard-ball", &changes))
    },
    draw: |r| {
        figure_beside(
            r,
            "Figure 2.6  A very hard ball",
            ("as shown", "same ω's, mass 1, drag 0.2"),
            "As Figure 2.2, very hard, light and in a thin medium; green: the same elasticity with mass and drag of the others.",
        )
    },
};
