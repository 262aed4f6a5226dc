//! Force fields of an image.

use fit::force::{
    ColorEdge, Computing, Distance, Edge, Gvf, ImageForceKind, Line, Scales, Sight, Termination,
    Vfc,
};
use numpy::{IntoPyArray, PyArray2, PyArray3};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use snakes::field::{Falloff, FlowRule, Line as Shade};

use crate::errors::value;
use crate::images::Image;
use crate::waiting::attended;

type Made<'py> = (Bound<'py, PyArray3<f64>>, Option<Bound<'py, PyArray2<f64>>>);

/// The force at every pixel, and the energy it is minus the gradient of, if there is one.
#[pyfunction]
pub(crate) fn force_field<'py>(
    py: Python<'py>,
    image: &Image,
    kind: &str,
    keywords: &Bound<'py, PyDict>,
) -> PyResult<Made<'py>> {
    let (kind, image) = (chosen(kind, keywords)?, image.image.clone());
    let made = attended(py, move |_| {
        let sight = Sight::of(image, Computing::Whole, 0).map_err(value)?;
        sight.field(&kind).map_err(value)
    })??;
    let made = made.ok_or_else(|| value("kind: this force is no field of the image alone"))?;
    let (x, y) = made.field.components();
    let both = ndarray::stack(ndarray::Axis(2), &[x.view(), y.view()]).map_err(value)?;
    Ok((
        both.into_pyarray(py),
        made.energy.map(|energy| energy.into_pyarray(py)),
    ))
}

/// What of the keywords has been read.
struct Keywords<'a, 'py> {
    kind: &'a str,
    given: &'a Bound<'py, PyDict>,
    known: Vec<&'static str>,
}

impl Keywords<'_, '_> {
    fn get<T>(&mut self, name: &'static str, usual: T) -> PyResult<T>
    where
        T: for<'a, 'py> FromPyObject<'a, 'py>,
    {
        self.known.push(name);
        match self.given.get_item(name)? {
            None => Ok(usual),
            Some(given) => given
                .extract()
                .map_err(|_| PyTypeError::new_err(format!("{name} must be a number, got {given}"))),
        }
    }

    /// Refuse what has not been asked for.
    fn end(self) -> PyResult<()> {
        for key in self.given.keys() {
            let key: String = key.extract()?;
            if !self.known.contains(&key.as_str()) {
                let known = self.known.join(", ");
                let message = format!(
                    "{key} is no keyword of kind {:?}; there are {known}",
                    self.kind
                );
                return Err(PyTypeError::new_err(message));
            }
        }
        Ok(())
    }
}

fn chosen(kind: &str, given: &Bound<'_, PyDict>) -> PyResult<ImageForceKind> {
    let mut from = Keywords {
        kind,
        given,
        known: Vec::new(),
    };
    let chosen = match kind {
        "edge" => {
            let usual = Edge::default();
            ImageForceKind::Edge(Edge {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                ..usual
            })
        }
        "color-edge" => {
            let usual = ColorEdge::default();
            ImageForceKind::ColorEdge(ColorEdge {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
            })
        }
        "scales" => {
            let usual = Scales::default();
            ImageForceKind::Scales(Scales {
                sigmas: from.get("sigmas", usual.sigmas)?,
                strength: from.get("strength", usual.strength)?,
            })
        }
        "line" => {
            let usual = Line::default();
            let shade: String = from.get("shade", "bright".to_owned())?;
            ImageForceKind::Line(Line {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                shade: match shade.as_str() {
                    "bright" => Shade::Bright,
                    "dark" => Shade::Dark,
                    other => {
                        return Err(value(format!(
                            "shade must be 'bright' or 'dark', got {other:?}"
                        )));
                    }
                },
            })
        }
        "termination" => {
            let usual = Termination::default();
            ImageForceKind::Termination(Termination {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                floor: from.get("floor", usual.floor)?,
            })
        }
        "distance" => {
            let usual = Distance::default();
            ImageForceKind::Distance(Distance {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                threshold: from.get("threshold", usual.threshold)?,
                reach: from.get("reach", usual.reach)?,
            })
        }
        "gvf" => {
            let usual = Gvf::default();
            let spread: Option<f64> = from.get("spread", None)?;
            let smoothness = from.get("smoothness", 0.2)?;
            let plain = FlowRule::Plain { smoothness };
            ImageForceKind::Gvf(Gvf {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                threshold: from.get("threshold", usual.threshold)?,
                rule: spread.map_or(plain, |spread| FlowRule::Generalised { spread }),
                knee: from.get("knee", usual.knee)?,
            })
        }
        "vfc" => {
            let usual = Vfc::default();
            let width: Option<f64> = from.get("width", None)?;
            let exponent = from.get("exponent", 2.0)?;
            let power = Falloff::Power { exponent };
            ImageForceKind::Vfc(Vfc {
                sigma: from.get("sigma", usual.sigma)?,
                strength: from.get("strength", usual.strength)?,
                threshold: from.get("threshold", usual.threshold)?,
                falloff: width.map_or(power, |width| Falloff::Gaussian { width }),
                reach: from.get("reach", usual.reach)?,
                knee: from.get("knee", usual.knee)?,
            })
        }
        other => {
            return Err(value(format!(
                "kind must be 'edge', 'color-edge', 'scales', 'line', 'termination', 'distance', 'gvf' or 'vfc', got \
                 {other:?}"
            )));
        }
    };
    from.end()?;
    Ok(chosen)
}
