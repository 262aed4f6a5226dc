//! Figures 4.6 to 4.8 themselves: fourteen frames in the report's layout.

use super::story::top;
use super::{LETTERS, MOMENTS, PLACE, noted, strip, tell};
use crate::demand::{above, below, judged, less};
use crate::{Claim, Experiment, Finding, SandboxError, Tolerance, real};

/// Figure 4.6: caught.
pub(crate) const FIRST: Experiment = Experiment {
    id: "fig-4-6",
    title: "The snake's motion, a to f",
    place: "Figure 4.6",
    question: "A snake is laid over an apple and its stem. What catches it first, and where?",
    claims: &[
        Claim {
            says: "at the beginning the top is attracted by a disturbing edge at the top of the image: the tip of the stem",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("top: highest from t = 16 to 120", 3.0),
                        below("top: lowest from t = 16 to 120", 12.0),
                    ],
                )
            },
        },
        Claim {
            says: "but the extremities are stuck on the contour of the apple",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("head: nodes stuck in a row at d", 35.0),
                        above("tail: nodes stuck in a row at d", 20.0),
                        below("middle: nodes stuck at d", 0.5),
                    ],
                )
            },
        },
        Claim {
            says: "an external force attracts the middle to the top, and the internal elastic force pushes it towards the contour",
            source: "report §4.3",
            judge: |r| {
                let (image, elastic) = (
                    r.number("force of the picture on the top at e: y")?,
                    r.number("elastic force on the top at e: y")?,
                );
                Ok(Finding::new(
                    image < 0.0 && elastic > 0.0 && (image + elastic).abs() < 0.2 * elastic,
                    format!(
                        "on the nodes above y = 30 at e: picture {image:.2} (up), elastic {elastic:.2} (down): they balance"
                    ),
                ))
            },
        },
    ],
    run: || {
        let story = tell("fig-4-6")?;
        let mut record = noted(&story);
        let heights: Vec<f64> = story
            .run
            .frames
            .iter()
            .filter(|frame| (16.0..=120.0).contains(&frame.t))
            .map(|frame| top(frame.nodes()).y)
            .collect();
        let (low, high) = crate::experiments::motion::range(heights, 0.0);
        record.note("top: highest from t = 16 to 120", low, "px", PLACE);
        record.note("top: lowest from t = 16 to 120", high, "px", PLACE);
        let stuck = story.truth.stuck(story.at(MOMENTS[3]));
        let head = stuck.iter().take_while(|&&s| s).count();
        let tail = stuck.iter().rev().take_while(|&&s| s).count();
        let middle = stuck
            .iter()
            .filter(|&&s| s)
            .count()
            .saturating_sub(head + tail);
        for (name, count) in [
            ("head: nodes stuck in a row at d", head),
            ("tail: nodes stuck in a row at d", tail),
            ("middle: nodes stuck at d", middle),
        ] {
            record.note(name, real(count), "", Tolerance::Absolute(2.0));
        }
        let (image, elastic) = story.forces_above(story.at(MOMENTS[4]), 30.0);
        let force = Tolerance::Absolute(1e-2);
        record.note(
            "force of the picture on the top at e: y",
            image.y,
            "",
            force,
        );
        record.note("elastic force on the top at e: y", elastic.y, "", force);
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        strip(
            r,
            "Figure 4.6  The first six steps of the snake's motion",
            0,
            6,
            "Yellow: the snake; blue: the part within 4 px of the apple's contour. The ends stick at once; the stem holds the top.",
        )
    },
};

/// Figure 4.7: lets go.
pub(crate) const SECOND: Experiment = Experiment {
    id: "fig-4-7",
    title: "The snake's motion, g to l",
    place: "Figure 4.7",
    question: "How does the snake come off the disturbing edge?",
    claims: &[
        Claim {
            says: "the more we progress in the sequence, the bigger is the part stuck on the apple",
            source: "report §4.3",
            judge: |r| {
                let shares: Vec<f64> = LETTERS
                    .chars()
                    .map(|letter| r.number(&format!("{letter}: stuck")))
                    .collect::<Result<_, _>>()?;
                let percent: Vec<String> =
                    shares.iter().map(|s| format!("{:.0}", 100.0 * s)).collect();
                Ok(Finding::new(
                    shares.windows(2).all(|pair| pair[1] >= pair[0] - 1e-9),
                    format!("a to n: {} %", percent.join(", ")),
                ))
            },
        },
        Claim {
            says: "the almost tangent discontinuity where the stuck part ends increases the internal force",
            source: "report §4.3",
            judge: |r| {
                let mean = r.number("g: internal force; mean over the stuck part")?;
                let at = |side: &str| -> Result<(f64, f64), SandboxError> {
                    Ok((
                        r.number(&format!("g: internal force at the {side} border"))?,
                        r.number(&format!("g: turn at the {side} border"))?,
                    ))
                };
                let ((left, bend), (right, turn)) = (at("left")?, at("right")?);
                Ok(Finding::new(
                    left > 3.0 * mean && right > 3.0 * mean && bend > 20.0 && turn > 20.0,
                    format!(
                        "at g turns of {bend:.0}° and {turn:.0}° at one node each; the internal force there is {:.1} and {:.1} times the mean of the stuck part",
                        left / mean,
                        right / mean
                    ),
                ))
            },
        },
        Claim {
            says: "the middle is extracted from the neighborhood of the disturbing edge",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("e: top", 12.0),
                        above("m: top", 45.0),
                        above("largest fall of the top within 4 units of time", 3.0),
                    ],
                )
            },
        },
    ],
    run: || {
        let story = tell("fig-4-7")?;
        let mut record = noted(&story);
        let nodes = story.at(MOMENTS[6]);
        let stuck = story.truth.stuck(nodes);
        let turn = |i: usize| {
            let angle = elastic::turning_angle(nodes[i] - nodes[i - 1], nodes[i + 1] - nodes[i]);
            angle.to_degrees().abs()
        };
        let (_, force) = story.forces(nodes);
        let held: Vec<f64> = (0..nodes.len())
            .filter(|&i| stuck[i])
            .map(|i| force[i].length())
            .collect();
        let loose = Tolerance::Absolute(0.05);
        let mean = held.iter().sum::<f64>() / real(held.len().max(1));
        record.note(
            "g: internal force; mean over the stuck part",
            mean,
            "",
            loose,
        );
        let head = stuck.iter().take_while(|&&s| s).count();
        let tail = nodes.len() - stuck.iter().rev().take_while(|&&s| s).count();
        for (side, border) in [("left", head), ("right", tail)] {
            let near = border.saturating_sub(2)..=border + 1;
            let most = near.max_by(|&a, &b| force[a].length().total_cmp(&force[b].length()));
            let most = most.unwrap_or(border);
            record.note(
                format!("g: internal force at the {side} border"),
                force[most].length(),
                "",
                loose,
            );
            record.note(
                format!("g: turn at the {side} border"),
                turn(most),
                "°",
                Tolerance::Absolute(0.5),
            );
        }
        let tops: Vec<f64> = story
            .run
            .frames
            .iter()
            .filter(|f| f.t > 30.0)
            .map(|f| top(f.nodes()).y)
            .collect();
        let fall = tops
            .windows(3)
            .map(|three| three[2] - three[0])
            .fold(0.0_f64, f64::max);
        record.note(
            "largest fall of the top within 4 units of time",
            fall,
            "px",
            Tolerance::Absolute(0.01),
        );
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        strip(
            r,
            "Figure 4.7  Steps 7 to 12 in the snake's motion",
            6,
            12,
            "Yellow: the snake; blue: the part within 4 px of the contour. The stuck part has grown to the foot of the stem; the middle slides down the stem and comes off.",
        )
    },
};

/// Figure 4.8: the contour.
pub(crate) const THIRD: Experiment = Experiment {
    id: "fig-4-8",
    title: "The snake's motion, m and n",
    place: "Figure 4.8",
    question: "Where does the snake come to rest?",
    claims: &[
        Claim {
            says: "the snake can reach the apple's contour",
            source: "report §4.3, our aim",
            judge: |r| {
                let (mean, count) = (
                    r.number("mean distance to the contour at n")?,
                    r.told("nodes outside the boxes at n")?,
                );
                Ok(Finding::new(
                    mean < 2.0,
                    format!(
                        "mean distance {mean:.2} px to the contour drawn by hand, over the {count} of 80 nodes outside the boxes of what disturbs"
                    ),
                ))
            },
        },
        Claim {
            says: "with all its nodes",
            source: "report §4.3",
            judge: |r| {
                let (stuck, most) = (
                    r.number("n: stuck")?,
                    r.told("largest distance to the contour at n")?,
                );
                Ok(Finding::new(
                    stuck > 0.98,
                    format!(
                        "{:.0} % within 4 px, the furthest at {most:.2} px",
                        100.0 * stuck
                    ),
                ))
            },
        },
        Claim {
            says: "which is its equilibrium",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        less(
                            "net force at n; mean",
                            0.05,
                            "force of the picture at n; mean",
                        ),
                        below(
                            "largest change of a distance in the last 40 units of time",
                            0.5,
                        ),
                    ],
                )
            },
        },
    ],
    run: || {
        let story = tell("fig-4-8")?;
        let mut record = noted(&story);
        let nodes = story.last();
        let (mean, count) = story.truth.mean_distance(nodes);
        record.note("mean distance to the contour at n", mean, "px", PLACE);
        record.note(
            "nodes outside the boxes at n",
            real(count),
            "",
            Tolerance::EXACT,
        );
        let most = nodes
            .iter()
            .fold(0.0_f64, |a, &p| a.max(story.truth.distance(p)));
        record.note("largest distance to the contour at n", most, "px", PLACE);
        let before = story.at(380.0).iter();
        let change = nodes
            .iter()
            .zip(before)
            .map(|(&p, &q)| (story.truth.distance(p) - story.truth.distance(q)).abs());
        let change = change.fold(0.0_f64, f64::max);
        record.note(
            "largest change of a distance in the last 40 units of time",
            change,
            "px",
            Tolerance::Absolute(0.01),
        );
        let (image, elastic) = story.forces(nodes);
        let mean = |forces: &mut dyn Iterator<Item = f64>| forces.sum::<f64>() / real(nodes.len());
        let force = Tolerance::Absolute(1e-3);
        record.note(
            "force of the picture at n; mean",
            mean(&mut image.iter().map(|f| f.length())),
            "",
            force,
        );
        let net = &mut image.iter().zip(&elastic).map(|(f, g)| (*f + *g).length());
        record.note("net force at n; mean", mean(net), "", force);
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        strip(
            r,
            "Figure 4.8  The final two steps in the snake's motion",
            12,
            14,
            "Blue: within 4 px of the contour, which is all of it. The middle is off the stem; at the top right the end is folded back on itself.",
        )
    },
};
