//! Keywords of Python as options of a fit.

use fit::{Method, Nodes, Step};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::ForceChoice;
use snakes::Options;
use snakes::field::Polarity;

use crate::errors::value;

/// Every keyword there is.
const KNOWN: &str = "method, nodes, spacing, tether, tension, rigidity, damping, sigma, strength, forces, polarity, \
                     balloon, step, steps";

/// Options of keywords, all others as usual.
pub(crate) fn options(keywords: &Bound<'_, PyDict>) -> PyResult<Options> {
    let mut options = Options::default();
    let mut chosen = false;
    for (key, given) in keywords {
        let key: String = key.extract()?;
        let number = || {
            given
                .extract::<f64>()
                .map_err(|_| PyTypeError::new_err(format!("{key} must be a number, got {given}")))
        };
        let word = || {
            given
                .extract::<String>()
                .map_err(|_| PyTypeError::new_err(format!("{key} must be a word, got {given}")))
        };
        let count = || {
            given.extract::<u64>().map_err(|_| {
                PyTypeError::new_err(format!(
                    "{key} must be a whole number of at least 0, got {given}"
                ))
            })
        };
        match key.as_str() {
            "method" => {
                options.method = match word()?.as_str() {
                    "search" => Method::Search,
                    "motion" => Method::Motion,
                    other => {
                        return Err(value(format!(
                            "method must be 'search' or 'motion', got {other:?}"
                        )));
                    }
                };
                chosen = true;
            }
            "nodes" => options.nodes = Nodes::Count(usize::try_from(count()?).map_err(value)?),
            "spacing" => options.nodes = Nodes::Every(number()?),
            "tether" => options.tether = number()?,
            "tension" => options.tension = number()?,
            "rigidity" => options.rigidity = number()?,
            "damping" => options.damping = number()?,
            "sigma" => options.sigma = number()?,
            "strength" => options.strength = number()?,
            "balloon" => options.balloon = number()?,
            "step" => options.step = Step::Equal(number()?),
            "steps" => options.steps = count()?,
            "polarity" => options.polarity = polarity(&word()?)?,
            "forces" => {
                let texts: Vec<String> = given.extract().map_err(|_| {
                    PyTypeError::new_err("forces must be a list of words such as 'gvf:0.5'")
                })?;
                for text in &texts {
                    let force = ForceChoice::parse(text)
                        .map_err(|error| value(format!("forces: {error}")))?;
                    options.forces.push(force.for_fit());
                }
            }
            _ => {
                let message = format!("{key} is no option of a fit; there are {KNOWN}");
                return Err(PyTypeError::new_err(message));
            }
        }
    }
    // forces pull a curve that moves
    if !chosen && !options.forces.is_empty() {
        options.method = Method::Motion;
    }
    Ok(options)
}

pub(crate) fn polarity(word: &str) -> PyResult<Polarity> {
    match word {
        "either" => Ok(Polarity::Either),
        "dark-to-bright" => Ok(Polarity::DarkToBright),
        "bright-to-dark" => Ok(Polarity::BrightToDark),
        other => Err(value(format!(
            "polarity must be 'either', 'dark-to-bright' or 'bright-to-dark', going outwards, got {other:?}"
        ))),
    }
}
