//! Curves: topology, and a shape's nodes.

use elastic::{ElasticError, End, Parameter, Topology};
use glam::DVec2;

use super::files::Files;
use super::{Rules, number, points};
use crate::file::{EndText, EndWord, OpenClosed, Rule, SceneText, ShapeText, TopologyText};
use crate::limits::MOST_NODES;
use crate::{SceneError, catalogue};

pub(super) fn topology(text: &TopologyText, rules: Rules) -> Topology {
    let end = |end: &EndText| match end {
        EndText::Word(EndWord::Free | EndWord::Border) | EndText::Rail(_) => End::Free,
        EndText::Word(EndWord::Anchored) => End::Anchored,
        EndText::Word(EndWord::Pinned) => End::Pinned,
        EndText::Word(EndWord::Clamped) => End::Clamped,
    };
    match text {
        TopologyText::Word(OpenClosed::Closed) => Topology::Closed,
        TopologyText::Word(OpenClosed::Open) => Topology::open(if rules.ends == Rule::Report {
            End::Anchored
        } else {
            End::Free
        }),
        TopologyText::Ends(ends) => Topology::Open {
            head: end(&ends.head),
            tail: end(&ends.tail),
        },
    }
}

/// An error of a curve, under `snake.nodes` if it is about their number and else under `key`.
pub(super) fn refused(key: &str, error: &ElasticError) -> SceneError {
    let few = matches!(error, ElasticError::TooFewNodes { .. });
    SceneError::key(if few { "snake.nodes" } else { key }, error)
}

/// The nodes of a shape; `key` is where it stands.
pub(super) fn nodes(
    text: &SceneText,
    shape: &ShapeText,
    key: &str,
    rules: Rules,
    files: &Files<'_>,
) -> Result<Vec<DVec2>, SceneError> {
    let closed = topology(&text.snake.topology, rules).is_closed();
    let parameter = match rules.spline {
        Rule::Report => Parameter::PointIndex,
        Rule::Corrected => Parameter::ArcLength,
    };
    let count = || match text.snake.nodes {
        None => Err(SceneError::key(
            "snake.nodes",
            "is missing; the number of nodes would do",
        )),
        Some(n) => few_enough("snake.nodes", n),
    };
    let through = |key: &str, clicks: &[DVec2]| {
        number::places(key, clicks)?;
        few_enough(key, clicks.len())?;
        elastic::spline(clicks, count()?, parameter, closed).map_err(|e| refused(key, &e))
    };
    let at = |name: &str| format!("{key}.{name}");
    match shape {
        ShapeText::Circle(c) => Ok(elastic::circle(
            number::place(&at("circle.center"), c.center)?,
            number::length(&at("circle.radius"), c.radius)?,
            count()?,
        )),
        ShapeText::Ellipse(e) => Ok(elastic::ellipse(
            number::place(&at("ellipse.center"), e.center)?,
            DVec2::new(
                number::length(&at("ellipse.axes"), e.axes[0])?,
                number::length(&at("ellipse.axes"), e.axes[1])?,
            ),
            number::finite(&at("ellipse.angle"), e.angle)?,
            count()?,
        )),
        ShapeText::Segment(s) => Ok(elastic::segment(
            number::place(&at("segment.from"), s.from)?,
            number::place(&at("segment.to"), s.to)?,
            count()?,
        )),
        ShapeText::Points(list) => through(&at("points"), &points(list)),
        ShapeText::Nodes(list) => {
            few_enough(&at("nodes"), list.len())?;
            let nodes = points(list);
            number::places(&at("nodes"), &nodes)?;
            Ok(nodes)
        }
        ShapeText::File(file) => through(&at("file"), files.contour(file)?.outer()),
        ShapeText::Shipped(name) => through(&at("shipped"), catalogue::contour(name)?.outer()),
    }
}

fn few_enough(key: &str, n: usize) -> Result<usize, SceneError> {
    if n <= MOST_NODES {
        Ok(n)
    } else {
        let message = format!("got {n}; at most {MOST_NODES} would do");
        Err(SceneError::key(key, message))
    }
}
