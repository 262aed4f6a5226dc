//! Figures 4.6 to 4.8 themselves: fourteen frames in the report's layout.

use super::story::top;
use super::{LETTERS, MOMENTS, PLACE, noted, strip, tell};
use crate::prelude::*;

/// Figure 4.6: caught.
pub(crate) const FIRST: Experiment = Experiment {
    id: "fig-4-6",
    title: "The snake's motion, a to f",
    place: "Figure 4.6",
    question: "A snake is laid over an apple and its stem. What catches it first, and where?",
    claims: &[
        claim("at the beginning the top is attracted by a disturbing edge at the top of the image: the \
               tip of the stem [report §4.3]")
            .when(&[
                above("top: highest from t = 16 to 120", 3.0),
                below("top: lowest from t = 16 to 120", 12.0),
            ]),
        claim("but the extremities are stuck on the contour of the apple [report §4.3]").when(&[
            above("head: nodes stuck in a row at d", 35.0),
            above("tail: nodes stuck in a row at d", 20.0),
            below("middle: nodes stuck at d", 0.5),
        ]),
        claim("an external force attracts the middle to the top, and the internal elastic force pushes \
               it towards the contour: they balance [report §4.3]")
            .judged(|r| {
                let image = r.number("force of the picture on the top at e: y")?;
                let elastic = r.number("elastic force on the top at e: y")?;
                let balance = (image + elastic).abs() < 0.2 * elastic;
                Ok(Finding::new(
                    image < 0.0 && elastic > 0.0 && balance,
                    format!(
                        "on the nodes above y = 30 at e: picture {image:.2} (up), \
                         elastic {elastic:.2} (down)"
                    ),
                ))
            }),
    ],
    run: || {
        let story = tell()?;
        let mut record = noted(&story);
        let held = story.run.frames.iter().filter(|frame| (16.0..=120.0).contains(&frame.t));
        let (low, high) = range(held.map(|frame| top(frame.nodes()).y), 0.0);
        record.note("top: highest from t = 16 to 120 [px]", low, PLACE);
        record.note("top: lowest from t = 16 to 120 [px]", high, PLACE);
        let stuck = story.truth.stuck(story.at(MOMENTS[3]));
        let (head, tail) = ends(&stuck);
        let all = stuck.iter().filter(|&&stuck| stuck).count();
        let middle = all.saturating_sub(head + tail);
        record.note("head: nodes stuck in a row at d", real(head), 2.0);
        record.note("tail: nodes stuck in a row at d", real(tail), 2.0);
        record.note("middle: nodes stuck at d", real(middle), 2.0);
        let (image, elastic) = story.forces_above(story.at(MOMENTS[4]), 30.0);
        record.note("force of the picture on the top at e: y", image.y, 1e-2);
        record.note("elastic force on the top at e: y", elastic.y, 1e-2);
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        let title = "Figure 4.6  The first six steps of the snake's motion";
        strip(
            r,
            title,
            0..6,
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
        claim("the more we progress in the sequence, the bigger is the part stuck on the apple [report §4.3]")
            .judged(|r| {
                let shares = LETTERS.chars().map(|letter| r.number(&format!("{letter}: stuck")));
                let shares = shares.collect::<Result<Vec<f64>>>()?;
                let grows = shares.windows(2).all(|pair| pair[1] >= pair[0] - 1e-9);
                let percent = shares.iter().map(|s| format!("{:.0}", 100.0 * s));
                let percent = percent.collect::<Vec<_>>().join(", ");
                Ok(Finding::new(grows, format!("a to n: {percent} %")))
            }),
        claim("the almost tangent discontinuity where the stuck part ends increases the internal force \
               [report §4.3]")
            .when(&[
                more(
                    "g: internal force at the *",
                    3.0,
                    "g: internal force; mean over the stuck part",
                ),
                above("g: turn at the *", 20.0),
            ]),
        claim("the middle is extracted from the neighborhood of the disturbing edge [report §4.3]").when(&[
            below("e: top", 12.0),
            above("m: top", 45.0),
            above("largest fall of the top within 4 units of time", 3.0),
        ]),
    ],
    run: || {
        let story = tell()?;
        let mut record = noted(&story);
        let nodes = story.at(MOMENTS[6]);
        let stuck = story.truth.stuck(nodes);
        let turn = |i: usize| {
            let angle = elastic::turning_angle(nodes[i] - nodes[i - 1], nodes[i + 1] - nodes[i]);
            angle.to_degrees().abs()
        };
        let (_, force) = story.forces(nodes);
        let held = force.iter().zip(&stuck).filter(|(_, stuck)| **stuck);
        let mean = mean(held.map(|(force, _)| force.length()));
        record.note("g: internal force; mean over the stuck part", mean, 0.05);
        let (head, tail) = ends(&stuck);
        for (side, border) in [("left", head), ("right", nodes.len() - tail)] {
            let near = border.saturating_sub(2)..=border + 1;
            let most = near.max_by(|&a, &b| force[a].length().total_cmp(&force[b].length()));
            let most = most.unwrap_or(border);
            let name = format!("g: internal force at the {side} border");
            record.note(name, force[most].length(), 0.05);
            record.note(format!("g: turn at the {side} border [°]"), turn(most), 0.5);
        }
        let late = story.run.frames.iter().filter(|frame| frame.t > 30.0);
        let tops: Vec<f64> = late.map(|frame| top(frame.nodes()).y).collect();
        let fall = most(tops.windows(3).map(|three| three[2] - three[0]));
        record.note("largest fall of the top within 4 units of time [px]", fall, 0.01);
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        let title = "Figure 4.7  Steps 7 to 12 in the snake's motion";
        strip(
            r,
            title,
            6..12,
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
        claim("the snake can reach the apple's contour [report §4.3, our aim]")
            .when(&[below("mean distance to the contour at n", 2.0)]),
        claim("with all its nodes [report §4.3]").when(&[above("n: stuck", 0.98)]),
        claim("which is its equilibrium [report §4.3]").when(&[
            less(
                "net force at n; mean",
                0.05,
                "force of the picture at n; mean",
            ),
            below(
                "largest change of a distance in the last 40 units of time",
                0.5,
            ),
        ]),
    ],
    run: || {
        let story = tell()?;
        let mut record = noted(&story);
        let (truth, nodes) = (&story.truth, story.last());
        let (off, count) = truth.mean_distance(nodes);
        record.note("mean distance to the contour at n [px]", off, PLACE);
        record.note("nodes outside the boxes at n", real(count), EXACT);
        let far = most(nodes.iter().map(|&p| truth.distance(p)));
        record.note("largest distance to the contour at n [px]", far, PLACE);
        let before = nodes.iter().zip(story.at(380.0));
        let change = before.map(|(&p, &q)| (truth.distance(p) - truth.distance(q)).abs());
        let name = "largest change of a distance in the last 40 units of time [px]";
        record.note(name, most(change), 0.01);
        let (image, elastic) = story.forces(nodes);
        let picture = mean(image.iter().map(|force| force.length()));
        record.note("force of the picture at n; mean", picture, 1e-3);
        let net = mean(image.iter().zip(&elastic).map(|(f, g)| (*f + *g).length()));
        record.note("net force at n; mean", net, 1e-3);
        story.keep(&mut record, None, PLACE);
        Ok(record)
    },
    draw: |r| {
        let title = "Figure 4.8  The final two steps in the snake's motion";
        strip(
            r,
            title,
            12..14,
            "Blue: within 4 px of the contour, which is all of it. The middle is off the stem; at the top right the end is folded back on itself.",
        )
    },
};

/// How many nodes are stuck in a row from the first on, and from the last.
fn ends(stuck: &[bool]) -> (usize, usize) {
    let head = stuck.iter().take_while(|&&stuck| stuck).count();
    (head, stuck.iter().rev().take_while(|&&stuck| stuck).count())
}
