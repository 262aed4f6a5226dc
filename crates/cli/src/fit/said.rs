//! What is said of outlines: to people, and as JSON.

use scene::fit::Plucked;
use scene::snake::Outcome;
use serde_json::{Value, json};

use super::TITLE;
use super::one::{Found, mean_error};
use crate::args::Words;
use crate::commands::{objects, told};

/// One fit as JSON.
fn outline(found: &Found, evidence: bool) -> Value {
    let Some(fit) = &found.fit else {
        let mut value = json!({
            "good": found.unsure.is_none(),
            "unsure": found.unsure,
            "closed_edge": found.measured.closed,
        });
        add(&mut value, found.plucked.as_ref());
        return value;
    };
    let quality = fit.quality.as_ref();
    let strength = fit
        .nodes
        .iter()
        .map(|node| node.strength)
        .fold(f64::INFINITY, f64::min);
    let mut value = json!({
        "outcome": fit.outcome.name(),
        "message": fit.outcome.to_string(),
        "steps": fit.steps,
        "good": found.unsure.is_none(),
        "unsure": found.unsure,
        "nodes": fit.nodes.len(),
        "least_strength": strength.is_finite().then_some(strength),
        "standard_error": mean_error(fit),
        "held": quality.map(|quality| quality.held),
        "crossings": quality.map(|quality| quality.crossings),
        "area": quality.and_then(|quality| quality.area).map(|(_, end)| end.abs()),
        "chosen": fit.chosen.to_string().lines().collect::<Vec<_>>(),
    });
    add(&mut value, found.plucked.as_ref());
    if evidence {
        let points = fit.contour.points.iter().zip(&fit.nodes);
        let node = |(p, node): (&glam::DVec2, &scene::fit::NodeEvidence)| json!({"x": p.x, "y": p.y, "error": node.error, "edge": node.strength});
        value["evidence"] = points.map(node).collect();
    }
    value
}

/// Add what came back when it was plucked.
fn add(value: &mut Value, plucked: Option<&Plucked>) {
    let Some(plucked) = plucked else { return };
    let stretch = |stretch: &scene::fit::Stretch| {
        json!({
            "x": stretch.at.x,
            "y": stretch.at.y,
            "outward": stretch.outward,
            "inward": stretch.inward,
            "firmness": stretch.firmness(),
        })
    };
    value["pluck"] = json!({
        "kick": plucked.kick,
        "firm": plucked.firm(),
        "stretches": plucked.stretches.iter().map(stretch).collect::<Vec<_>>(),
    });
}

/// So many of something, in words.
pub(crate) fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// Say how each outline ended; whether all are good.
pub(super) fn said(found: &[Found], words: Words) -> bool {
    let mut good = true;
    for (index, one) in found.iter().enumerate() {
        let title = match found.len() {
            1 => TITLE.to_owned(),
            count => format!("outline {} of {count}", index + 1),
        };
        let Some(fit) = &one.fit else {
            if let Some(why) = &one.unsure {
                words.say(&format!("{title}: {why}"));
            }
            plucked(&title, one, words);
            good &= one.unsure.is_none();
            continue;
        };
        for line in fit.chosen.to_string().lines() {
            words.detail(&if found.len() > 1 {
                format!("{title}: {line}")
            } else {
                line.to_owned()
            });
        }
        words.say(&format!("{title}: {}", fit.outcome));
        if matches!(fit.outcome, Outcome::Finished { .. }) {
            words.say("it was to come to rest and has not: allow more steps");
        }
        if let Some(quality) = &fit.quality {
            objects(&title, quality, words);
        }
        plucked(&title, one, words);
        good &= one.unsure.is_none();
    }
    if found.iter().any(|one| one.fit.is_none()) {
        words.say(&format!("{} found", counted(found.len(), "object")));
    }
    good
}

/// Say how firmly the picture holds it, if it was plucked.
fn plucked(title: &str, one: &Found, words: Words) {
    let Some(plucked) = &one.plucked else { return };
    for line in plucked.to_string().lines() {
        words.detail(&format!("{title}: {line}"));
    }
    let mut text = format!(
        "{title}: plucked by {} pixels: {:.0} % firm",
        plucked.kick,
        100.0 * plucked.firm()
    );
    if let Some(loosest) = plucked.loosest() {
        let back = loosest.firmness();
        let back = back.map_or_else(
            || "it is not known what".to_owned(),
            |back| format!("{:.2}", (100.0 * back).round() / 100.0 + 0.0),
        );
        text.push_str(&format!(
            ", least near ({:.0}, {:.0}), of which {back} comes back",
            loosest.at.x, loosest.at.y
        ));
    }
    words.say(&text);
}

/// How it ended, as JSON: of one outline its own words, of several a list.
pub(super) fn summary(found: &[Found], good: bool, evidence: bool) -> Value {
    if let [one] = found
        && let Some(fit) = &one.fit
    {
        let mut value = outline(one, evidence);
        value["title"] = json!(TITLE);
        value["good"] = json!(good);
        value["curves"] = fit.quality.as_ref().map(told).into_iter().collect();
        return value;
    }
    let outlines: Vec<Value> = found.iter().map(|one| outline(one, evidence)).collect();
    json!({ "title": TITLE, "good": good, "outlines": outlines })
}
