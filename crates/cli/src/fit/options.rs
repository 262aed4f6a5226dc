//! Flags become the options of a fit, and its errors those of the flags.

use scene::field::Polarity;
use scene::fit::search::{Rules, Sign};
use scene::fit::{self, FitError, Nodes, OptionKey, Options, Step};
use scene::{Computing, SceneError};

use super::flags::{Flags, Method};
use crate::args::{self, Change};
use crate::commands::{choices, key};

/// The options that flags stand for.
pub(super) fn options(flags: &Flags) -> Result<Options, SceneError> {
    let method = flags
        .method()
        .map_err(|(flag, message)| key(flag, message))?;
    let usual = Options::default();
    let options = Options {
        search: rules(&flags.set, flags.polarity)?,
        nodes: flags.nodes.map_or(usual.nodes, Nodes::Count),
        ..usual
    };
    if method == Method::Search {
        return Ok(options);
    }
    let polarity = match flags.polarity {
        None | Some(args::Polarity::Either) => Polarity::Either,
        Some(args::Polarity::DarkToBright) => Polarity::DarkToBright,
        Some(args::Polarity::BrightToDark) => Polarity::BrightToDark,
    };
    let forces = choices("--force", &flags.force)?;
    let forces = forces.into_iter().map(|c| c.with_polarity(polarity));
    Ok(Options {
        method: fit::Method::Motion,
        tether: flags.tether.unwrap_or(options.tether),
        tension: flags.tension.unwrap_or(options.tension),
        rigidity: flags.rigidity.unwrap_or(options.rigidity),
        damping: flags.damping.unwrap_or(options.damping),
        sigma: flags.sigma.unwrap_or(options.sigma),
        strength: flags.strength.unwrap_or(options.strength),
        forces: forces.map(scene::ForceChoice::for_fit).collect(),
        polarity,
        balloon: flags.balloon.unwrap_or(options.balloon),
        computing: match flags.computed {
            None | Some(args::Computed::Auto) => Computing::Auto,
            Some(args::Computed::Lazy) => Computing::Lazy,
            Some(args::Computed::Whole) => Computing::Whole,
        },
        step: flags.dt.map_or(options.step, Step::Equal),
        steps: flags.steps.unwrap_or(options.steps),
        ..options
    })
}

/// The rules of the search with these changes.
pub(crate) fn rules(
    changes: &[Change],
    polarity: Option<args::Polarity>,
) -> Result<Rules, SceneError> {
    let mut rules = Rules {
        sign: match polarity {
            None => Sign::Learnt,
            Some(args::Polarity::Either) => Sign::Either,
            Some(args::Polarity::DarkToBright) => Sign::Darker,
            Some(args::Polarity::BrightToDark) => Sign::Brighter,
        },
        ..Rules::default()
    };
    for change in changes {
        let flag = format!("--set {}", change.key);
        let value: f64 = change
            .value
            .parse()
            .map_err(|_| key(&flag, format!("must be a number, got {}", change.value)))?;
        let rule = match change.key.as_str() {
            "tether" => &mut rules.tether,
            "region" => &mut rules.region,
            "inward" => &mut rules.inward,
            "outward" => &mut rules.outward,
            "outer" => &mut rules.outer,
            "sure" => &mut rules.sure,
            "unsure" => &mut rules.unsure,
            "pure" => &mut rules.pure,
            "around" => &mut rules.around,
            _ => {
                let names = "tether, region, inward, outward, outer, sure, unsure, pure, around";
                return Err(key(
                    &flag,
                    format!("is no rule of a search; the rules are {names}"),
                ));
            }
        };
        *rule = value;
    }
    Ok(rules)
}

/// An error under the flag that stands for its option.
pub(super) fn by_flag(error: &FitError) -> SceneError {
    let flag = match error.key {
        OptionKey::Image => "picture",
        OptionKey::Start => "--from",
        OptionKey::Nodes => "--nodes",
        OptionKey::Tether => "--tether",
        OptionKey::Tension => "--tension",
        OptionKey::Rigidity => "--rigidity",
        OptionKey::Damping => "--damping",
        OptionKey::Sigma => "--sigma",
        OptionKey::Strength => "--strength",
        OptionKey::Computing => "--computed",
        OptionKey::Balloon => "--balloon",
        OptionKey::Step => "--dt",
        OptionKey::Steps => "--steps",
        OptionKey::Kick => "--pluck",
        OptionKey::Search(rule) => return key(&format!("--set {rule}"), &error.problem),
        OptionKey::Force(..) => {
            // it begins with the name of the kind
            let message = error.problem.to_string();
            return match message.split_once(": ") {
                Some((kind, rest)) => key(&format!("--force {kind}"), rest),
                None => key("--force", message),
            };
        }
        _ => "fit",
    };
    key(flag, &error.problem)
}
