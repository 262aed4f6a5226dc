//! Report §2.5: five balls, very soft to very hard, against the wall x = 0 (Figures 2.2 to 2.6).

use crate::prelude::*;

mod course;
mod draw;
mod hard;
mod overview;
mod walls;

pub(crate) use course::frequency;
pub(crate) use hard::{HARD, VERY_HARD};
pub(crate) use overview::OVERVIEW;
pub(crate) use walls::{FRICTION, WALLS};

/// Runs one ball and keeps everything of it.
fn measured(scene: &str) -> Result {
    let mut record = Record::default();
    let (course, run) = course::follow(scene, &[])?;
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
        claim("it reacts like a viscous fluid: it flows and never recovers [report §2.5]").when(&[
            above("deformation at the end (rms)", 1.0),
            below("area at the end", 0.03),
        ]),
        claim("it stays at the wall and slides down it [errata §6]").when(&[
            above("last contact", 6.99),
            near("speed away from it", 0.0, 0.05),
            below("center at the end: x", 0.05),
            below("center at the end: y", 2.0),
        ]),
        claim("without friction nothing couples x and y: squeezed in x, no bulging in y [D67]")
            .when(&[below("largest deformation in y", 1e-7)]),
    ],
    run: || measured("very-soft-ball"),
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
        claim("the ball need not have a constant volume; it is compressible [report §2.5]")
            .when(&[below("least area", 0.35)]),
        claim("and swells afterwards [errata §6]").when(&[above("largest area afterwards", 1.1)]),
        claim("it leaves the wall, but is not back in shape after 7 s [errata §6]").when(&[
            below("last contact", 5.0),
            above("deformation at the end (rms)", course::RECOVERED),
        ]),
    ],
    run: || measured("soft-ball"),
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
        claim(
            "upon hitting the wall, the shape oscillates around its original shape [report §2.5]",
        )
        .when(&[
            above("extremes of the area after the contact", 3.5),
            below("least area", 0.8),
            above("largest area afterwards", 1.03),
        ]),
        claim("it rings with the first mode of its own matrix [errata §6, §7]").when(&[like(
            "ringing: measured",
            "ringing: predicted",
            2e-3,
        )]),
        claim("and is in shape again at the end [report §2.5]").when(&[
            below("out of shape until", 4.0),
            below("deformation at the end (rms)", course::RECOVERED),
        ]),
    ],
    run: || measured("rigid-ball"),
    draw: |r| {
        draw::one(
            r,
            "Figure 2.4  A rigid ball",
            "As Figure 2.2, harder: the shape rings about its own while the ball flies away.",
        )
    },
};
