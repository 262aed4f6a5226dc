//! Report §2.5: five balls, very soft to very hard, against the wall x = 0 (Figures 2.2 to 2.6).

mod course;
mod draw;
mod hard;
mod overview;
mod walls;

pub(crate) use hard::{HARD, VERY_HARD};
pub(crate) use overview::OVERVIEW;
pub(crate) use walls::{FRICTION, WALLS};

use crate::experiments::motion::changed_scene;
use crate::{Claim, Experiment, Finding, Record, SandboxError};

/// Runs one ball and keeps everything of it.
fn measured(
    id: &'static str,
    scene: &str,
    changes: &[(&str, &str)],
) -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let (course, run) = course::follow(id, &mut changed_scene(id, scene, changes)?)?;
    course::sum_up(&mut record, "", &course);
    course::keep(&mut record, &course, &run);
    Ok(record)
}

/// Figure 2.2: flows like a viscous fluid.
pub(crate) const VERY_SOFT: Experiment = Experiment {
    id: "fig-2-2",
    title: "A very soft ball",
    place: "Figure 2.2",
    question: "All elastic parameters are nearly zero. What is left of the ball after the wall?",
    claims: &[
        Claim {
            says: "it reacts like a viscous fluid: it flows and never recovers",
            source: "report §2.5",
            judge: |r| {
                let end = r.number("deformation at the end (rms)")?;
                let area = r.number("area at the end")?;
                Ok(Finding::new(
                    end > 1.0 && area < 0.03,
                    format!(
                        "at the end {end:.2} from its shape (half axes 1.5 and 1) with {:.1} % of its area",
                        100.0 * area
                    ),
                ))
            },
        },
        Claim {
            says: "it stays at the wall and slides down it",
            source: "errata §6",
            judge: |r| {
                let (last, away) = (r.number("last contact")?, r.number("speed away from it")?);
                let (x, y) = (
                    r.number("center at the end: x")?,
                    r.number("center at the end: y")?,
                );
                Ok(Finding::new(
                    last > 6.99 && away.abs() < 0.05 && x < 0.05 && y < 2.0,
                    format!(
                        "in contact to the end, {away:.3} /s off the wall, center from y = 8 to {y:.2} at x = {x:.3}"
                    ),
                ))
            },
        },
        Claim {
            says: "without friction nothing couples x and y: squeezed in x only, no bulging in y",
            source: "D67",
            judge: |r| {
                let across = r.number("largest deformation in y")?;
                Ok(Finding::new(
                    across < 1e-7,
                    format!("largest deformation in y: {across:.1e}"),
                ))
            },
        },
    ],
    run: || measured("fig-2-2", "very-soft-ball", &[]),
    draw: |r| {
        draw::one(
            r,
            "Figure 2.2  A very soft ball",
            "Snapshots over each other, the wall, the way of the center of mass; at the wall; deformation, area and energy.",
        )
    },
};

/// Figure 2.3: compressible.
pub(crate) const SOFT: Experiment = Experiment {
    id: "fig-2-3",
    title: "A soft ball",
    place: "Figure 2.3",
    question: "ω₀ = 0, tension and rigidity greater than before. What does the wall do to the ball's volume?",
    claims: &[
        Claim {
            says: "the ball need not have a constant volume; it is compressible",
            source: "report §2.5",
            judge: |r| {
                let (least, at) = (r.number("least area")?, r.told("time of the least area")?);
                Ok(Finding::new(
                    least < 0.35,
                    format!("squeezed to {least:.3} of its area at {at:.2} s"),
                ))
            },
        },
        Claim {
            says: "and swells afterwards",
            source: "errata §6",
            judge: |r| {
                let after = r.number("largest area afterwards")?;
                Ok(Finding::new(
                    after > 1.1,
                    format!("to {after:.3} of its area"),
                ))
            },
        },
        Claim {
            says: "it leaves the wall, but is not back in shape after 7 s",
            source: "errata §6",
            judge: |r| {
                let (last, end) = (
                    r.number("last contact")?,
                    r.number("deformation at the end (rms)")?,
                );
                Ok(Finding::new(
                    last < 5.0 && end > course::RECOVERED,
                    format!("leaves at {last:.2} s, at the end {end:.2} from its shape"),
                ))
            },
        },
    ],
    run: || measured("fig-2-3", "soft-ball", &[]),
    draw: |r| {
        draw::one(
            r,
            "Figure 2.3  A soft ball",
            "As Figure 2.2, for ω₀ = 0: the ball loses more than two thirds of its area, and swells.",
        )
    },
};

/// Figure 2.4: rings about its shape.
pub(crate) const RIGID: Experiment = Experiment {
    id: "fig-2-4",
    title: "A rigid ball",
    place: "Figure 2.4",
    question: "Harder than the previous one. What does the shape do after the hit?",
    claims: &[
        Claim {
            says: "upon hitting the wall, the shape oscillates around its original shape",
            source: "report §2.5",
            judge: |r| {
                let count = r.number("extremes of the area after the contact")?;
                let (least, after) = (
                    r.number("least area")?,
                    r.number("largest area afterwards")?,
                );
                Ok(Finding::new(
                    count > 3.5 && least < 0.8 && after > 1.03,
                    format!(
                        "{count} extremes of the area, between {least:.2} and {after:.2} of the start"
                    ),
                ))
            },
        },
        Claim {
            says: "it rings with the first mode of its own matrix",
            source: "errata §6, §7",
            judge: |r| {
                let (found, right) = (
                    r.number("ringing: measured")?,
                    r.number("ringing: predicted")?,
                );
                Ok(Finding::new(
                    (found / right - 1.0).abs() < 2e-3,
                    format!("{found:.4} rad/s measured, {right:.4} rad/s from the eigenvalue"),
                ))
            },
        },
        Claim {
            says: "and is in shape again at the end",
            source: "report §2.5",
            judge: |r| {
                let (until, end) = (
                    r.number("out of shape until")?,
                    r.number("deformation at the end (rms)")?,
                );
                Ok(Finding::new(
                    until < 4.0 && end < course::RECOVERED,
                    format!(
                        "further than 0.04 from its shape until {until:.2} s, {end:.3} at the end"
                    ),
                ))
            },
        },
    ],
    run: || measured("fig-2-4", "rigid-ball", &[]),
    draw: |r| {
        draw::one(
            r,
            "Figure 2.4  A rigid ball",
            "As Figure 2.2, harder: the shape rings about its own while the ball flies away.",
        )
    },
};
