//! Figures 2.5 and 2.6: a hard ball against the rigid one, a very hard one against itself in a
//! thicker medium.

use super::course::{self, Course, STEPS};
use super::draw;
use crate::draw::{Color, Line};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};

/// Runs a ball, and beside it another one whose numbers and course carry a prefix.
fn beside(
    id: &'static str,
    scene: &str,
    other: (&str, &str, &[(&str, &str)]),
) -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let (own, run) = course::follow(id, &mut changed_scene(id, scene, &[])?)?;
    course::sum_up(&mut record, "", &own);
    course::keep(&mut record, &own, &run);
    let (prefix, name, changes) = other;
    let (second, _) = course::follow(id, &mut changed_scene(id, name, changes)?)?;
    course::sum_up(&mut record, prefix, &second);
    let apart = |i: usize| own.center[i].distance(second.center[i]);
    let furthest = (0..own.t.len()).map(apart).fold(0.0_f64, f64::max);
    record.note("centers apart at most", furthest, "", STEPS);
    record.note(
        "stiffness of the first mode by the other's",
        own.mode_stiffness / second.mode_stiffness,
        "",
        Tolerance::ROUNDING,
    );
    keep_other(&mut record, &second);
    Ok(record)
}

fn keep_other(record: &mut Record, other: &Course) {
    let rows: Vec<usize> = (0..other.t.len()).step_by(20).collect();
    let pick = |values: &dyn Fn(usize) -> f64| rows.iter().map(|&i| values(i)).collect();
    record.keep(
        Table::raw("other")
            .with("t", "s", Tolerance::ROUNDING, pick(&|i| other.t[i]))
            .with("center x", "", STEPS, pick(&|i| other.center[i].x))
            .with("center y", "", STEPS, pick(&|i| other.center[i].y))
            .with("deformation", "", STEPS, pick(&|i| other.rms[i])),
    );
}

/// The usual figure with the other ball's way and deformation, dashed.
fn figure_beside(
    record: &Record,
    title: &str,
    own: &str,
    other: &str,
    caption: &'static str,
) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = draw::figure(record, title)?;
    let way = Line::new(
        record.points("other", "center x", "center y")?,
        Color::GREEN,
    );
    let shape = Line::new(record.points("other", "t", "deformation")?, Color::GREEN);
    let largest = record.column("other", "deformation")?;
    let largest = largest.iter().fold(0.0_f64, |a, &b| a.max(b));
    if let Some(panel) = figure.rows[0].panels.first_mut() {
        panel
            .layers
            .push(way.dashed().weighing(0.7).named(other).into());
        let right = record.column("other", "center x")?;
        panel.x.to = right.iter().fold(panel.x.to, |a, &b| a.max(b));
    }
    if let Some(panel) = figure.rows[1].panels.first_mut() {
        if let Some(crate::draw::Layer::Line(line)) = panel.layers.first_mut() {
            line.label = own.to_owned();
        }
        panel.layers.push(shape.weighing(0.7).named(other).into());
        panel.y.to = panel.y.to.max(1.08 * largest) * 1.3;
    }
    Ok(vec![
        Artefact::figure(caption, figure),
        Artefact::further(
            "moving",
            "The same in motion, in real time.",
            crate::Body::Animation(draw::animation(record)?),
        ),
    ])
}

/// Figure 2.5: the same way, the shape back sooner.
pub(crate) const HARD: Experiment = Experiment {
    id: "fig-2-5",
    title: "A hard ball",
    place: "Figure 2.5",
    question: "How does the hard ball's motion differ from that of the rigid ball of Figure 2.4?",
    claims: &[
        Claim {
            says: "there is not a great difference between the translational motions",
            source: "report §2.5",
            judge: |r| {
                let apart = r.number("centers apart at most")?;
                let (own, other) = (
                    r.told("center at the end: x")?,
                    r.told("rigid ball: center at the end: x")?,
                );
                Ok(Finding::new(
                    apart < 1.0,
                    format!(
                        "at the end at x = {own:.2} and {other:.2}, never more than {apart:.2} apart, a quarter of the ball"
                    ),
                ))
            },
        },
        Claim {
            says: "except that the harder ball recovers its shape more quickly",
            source: "report §2.5",
            judge: |r| {
                let (own, other) = (
                    r.number("out of shape until")?,
                    r.number("rigid ball: out of shape until")?,
                );
                let last = r.number("last contact")?;
                Ok(Finding::new(
                    own < 0.7 * other && own < last,
                    format!(
                        "within 0.04 for good after {own:.2} s, still at the wall; the rigid one after {other:.2} s"
                    ),
                ))
            },
        },
        Claim {
            says: "not because its ringing dies away faster: that rate is γ/2μ for both",
            source: "D27, D68",
            judge: |r| {
                let (own, other) = (
                    r.number("ringing dies away: measured")?,
                    r.number("rigid ball: ringing dies away: measured")?,
                );
                let right = r.number("ringing dies away: predicted")?;
                Ok(Finding::new(
                    (own / right - 1.0).abs() < 0.02 && (other / right - 1.0).abs() < 0.02,
                    format!("{own:.4} /s and {other:.4} /s, γ/2μ = {right} /s"),
                ))
            },
        },
        Claim {
            says: "but because it is deformed less, as the root of its stiffness, and rings faster",
            source: "D68",
            judge: |r| {
                let own = r.number("largest deformation (rms)")?;
                let other = r.number("rigid ball: largest deformation (rms)")?;
                let ratio = r.number("stiffness of the first mode by the other's")?;
                let (fast, slow) = (
                    r.number("ringing: measured")?,
                    r.number("rigid ball: ringing: measured")?,
                );
                Ok(Finding::new(
                    (other / own / ratio.sqrt() - 1.0).abs() < 0.1 && fast > 2.0 * slow,
                    format!(
                        "{:.2} times less deformed, root of the stiffness ratio {:.2}; {fast:.1} against {slow:.1} rad/s",
                        other / own,
                        ratio.sqrt()
                    ),
                ))
            },
        },
    ],
    run: || beside("fig-2-5", "hard-ball", ("rigid ball: ", "rigid-ball", &[])),
    draw: |r| {
        figure_beside(
            r,
            "Figure 2.5  A hard ball",
            "hard ball",
            "rigid ball, Figure 2.4",
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
        Claim {
            says: "not only the elastic parameters are important: with the mass and drag of Figure 2.5, the same \
                   ω's fly another way",
            source: "report §2.5",
            judge: |r| {
                let (own, other) = (
                    r.told("center at the end: x")?,
                    r.told("same elasticity: center at the end: x")?,
                );
                let apart = r.number("centers apart at most")?;
                Ok(Finding::new(
                    apart > 3.0,
                    format!(
                        "at the end at x = {own:.2}, with μ = 1 and γ = 0.2 at {other:.2}; {apart:.1} apart"
                    ),
                ))
            },
        },
        Claim {
            says: "drag slows a ball long before the wall: it comes and goes faster without",
            source: "errata §6, D27",
            judge: |r| {
                let (towards, away) = (
                    r.number("speed towards the wall")?,
                    r.number("speed away from it")?,
                );
                let (slow, slower) = (
                    r.number("same elasticity: speed towards the wall")?,
                    r.number("same elasticity: speed away from it")?,
                );
                Ok(Finding::new(
                    towards > 2.2 && slow < 1.9 && away > slower + 0.4,
                    format!(
                        "{towards:.2} in and {away:.2} /s out, with the drag of the others {slow:.2} and {slower:.2}"
                    ),
                ))
            },
        },
        Claim {
            says: "it is the least deformed of all",
            source: "errata §6",
            judge: |r| {
                let (largest, until) = (
                    r.number("largest deformation (rms)")?,
                    r.number("out of shape until")?,
                );
                Ok(Finding::new(
                    largest < 0.1 && until < 1.7,
                    format!("at most {largest:.3} from its shape, back after {until:.2} s"),
                ))
            },
        },
    ],
    run: || {
        beside(
            "fig-2-6",
            "very-hard-ball",
            (
                "same elasticity: ",
                "very-hard-ball",
                &[
                    ("mass = 0.4", "mass = 1.0"),
                    ("damping = 0.02", "damping = 0.2"),
                ],
            ),
        )
    },
    draw: |r| {
        figure_beside(
            r,
            "Figure 2.6  A very hard ball",
            "as shown",
            "same ω's, mass 1, drag 0.2",
            "As Figure 2.2, very hard, light and in a thin medium; green: the same elasticity with mass and drag of the others.",
        )
    },
};
