//! Short ways to say what is in a panel.

use super::palette::Color;
use super::panel::{Axis, Layer, Line, Panel};

/// Small discs at points, before they are a layer.
#[derive(Debug, Clone)]
pub struct Dots(Layer);

impl Dots {
    /// The same dots, named in the legend.
    #[must_use]
    pub fn named(mut self, words: impl Into<String>) -> Self {
        if let Layer::Dots { label, .. } = &mut self.0 {
            *label = words.into();
        }
        self
    }
}

impl From<Dots> for Layer {
    fn from(dots: Dots) -> Self {
        dots.0
    }
}

impl<S: Into<String>> From<(S, f64, f64)> for Axis {
    fn from((label, from, to): (S, f64, f64)) -> Self {
        Self::new(label, from, to)
    }
}

/// A solid line.
pub fn line(points: impl IntoIterator<Item = (f64, f64)>, color: Color) -> Line {
    Line::new(points.into_iter().collect(), color)
}

/// Small discs of a radius in units of the one line weight.
pub fn dots(points: impl IntoIterator<Item = (f64, f64)>, radius: f64, color: Color) -> Dots {
    Dots(Layer::Dots {
        points: points.into_iter().collect(),
        radius,
        color,
        label: String::new(),
    })
}

/// A filled area.
pub fn area(points: impl IntoIterator<Item = (f64, f64)>, color: Color, opacity: f64) -> Layer {
    Layer::Area {
        points: points.into_iter().collect(),
        color,
        opacity,
    }
}

/// Words about a point.
pub fn text(at: impl Into<(f64, f64)>, words: impl Into<String>, color: Color) -> Layer {
    Layer::Text {
        at: at.into(),
        words: words.into(),
        color,
        centered: true,
    }
}

/// An arrow from a point by a vector.
pub fn arrow(from: impl Into<(f64, f64)>, by: impl Into<(f64, f64)>, color: Color) -> Layer {
    Layer::Arrows {
        arrows: vec![(from.into(), by.into())],
        color,
    }
}

/// A circle as so many edges.
#[must_use]
pub fn circle(center: (f64, f64), radius: f64, edges: usize) -> Vec<(f64, f64)> {
    let at = |i: usize| {
        let angle = crate::real(i) * std::f64::consts::TAU / crate::real(edges);
        let (sin, cos) = angle.sin_cos();
        (center.0 + cos * radius, center.1 + sin * radius)
    };
    (0..=edges).map(at).collect()
}

/// An empty panel.
pub fn plot(title: impl Into<String>, x: impl Into<Axis>, y: impl Into<Axis>) -> Panel {
    Panel::new(title, x.into(), y.into())
}
