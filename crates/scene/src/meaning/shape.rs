//! Curves: topology, and a shape's nodes.

use elastic::{ElasticError, End, Parameter, Topology};
use glam::DVec2;

use super::files::Files;
use super::{Rules, number, points};
use crate::file::{
    EndText, EndWord, NodesText, OpenClosed, Rule, SceneText, ShapeText, TopologyText,
};
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
    let topology = topology(&text.snake.topology, rules);
    let maker = Maker {
        closed: topology.is_closed(),
        parameter: match rules.spline {
            Rule::Report => Parameter::PointIndex,
            Rule::Corrected => Parameter::ArcLength,
        },
        files,
    };
    maker.nodes(shape, key, &|_| match text.snake.nodes {
        None => Err(SceneError::key(
            NODES,
            "is missing; needed: the number of nodes",
        )),
        Some(NodesText::Count(n)) => few_enough(NODES, n),
        Some(NodesText::Apart(distance)) => {
            number::length(NODES, distance)?;
            let start = maker.nodes(&text.snake.start, "snake.start", &finely)?;
            spaced(distance, elastic::length(&start, maker.closed), topology)
        }
    })
}

const NODES: &str = "snake.nodes";

/// Nodes by which a curve through so many points is measured.
fn finely(points: usize) -> Result<usize, SceneError> {
    Ok(points.saturating_mul(4).clamp(4096, MOST_NODES))
}

/// How many nodes lie this far apart on a curve of that length.
fn spaced(distance: f64, along: f64, topology: Topology) -> Result<usize, SceneError> {
    let gaps = (along / distance).round();
    let refuse = |bound: String, got: f64| {
        let message = format!(
            "\"{distance} px\" on a curve {along:.2} pixels long: must be {bound} nodes, got {got}"
        );
        Err(SceneError::key(NODES, message))
    };
    // an open curve has a node at either end
    let ends = if topology.is_closed() { 0.0 } else { 1.0 };
    let (count, least) = (gaps + ends, topology.least_nodes());
    if count < least as f64 {
        return refuse(format!("at least {least}"), count);
    }
    if count > MOST_NODES as f64 || count.is_nan() {
        return refuse(format!("at most {MOST_NODES}"), count);
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number within bounds that were checked"
    )]
    Ok(count as usize)
}

/// How many nodes a curve through so many points is to have.
type Count<'a> = &'a dyn Fn(usize) -> Result<usize, SceneError>;

/// What turns shapes into nodes.
struct Maker<'a> {
    closed: bool,
    parameter: Parameter,
    files: &'a Files<'a>,
}

impl Maker<'_> {
    fn nodes(
        &self,
        shape: &ShapeText,
        key: &str,
        count: Count<'_>,
    ) -> Result<Vec<DVec2>, SceneError> {
        let at = |name: &str| format!("{key}.{name}");
        let through = |key: &str, clicks: &[DVec2]| {
            number::places(key, clicks)?;
            few_enough(key, clicks.len())?;
            let n = count(clicks.len())?;
            elastic::spline(clicks, n, self.parameter, self.closed).map_err(|e| refused(key, &e))
        };
        match shape {
            ShapeText::Circle(c) => Ok(elastic::circle(
                number::place(&at("circle.center"), c.center)?,
                number::length(&at("circle.radius"), c.radius)?,
                count(0)?,
            )),
            ShapeText::Ellipse(e) => Ok(elastic::ellipse(
                number::place(&at("ellipse.center"), e.center)?,
                DVec2::new(
                    number::length(&at("ellipse.axes"), e.axes[0])?,
                    number::length(&at("ellipse.axes"), e.axes[1])?,
                ),
                number::finite(&at("ellipse.angle"), e.angle)?,
                count(0)?,
            )),
            ShapeText::Segment(s) => Ok(elastic::segment(
                number::place(&at("segment.from"), s.from)?,
                number::place(&at("segment.to"), s.to)?,
                count(0)?,
            )),
            ShapeText::Points(list) => through(&at("points"), &points(list)),
            ShapeText::Nodes(list) => {
                few_enough(&at("nodes"), list.len())?;
                let nodes = points(list);
                number::places(&at("nodes"), &nodes)?;
                Ok(nodes)
            }
            ShapeText::File(file) => through(&at("file"), self.files.contour(file)?.first()),
            ShapeText::Shipped(name) => through(&at("shipped"), catalogue::contour(name)?.first()),
        }
    }
}

fn few_enough(key: &str, n: usize) -> Result<usize, SceneError> {
    if n <= MOST_NODES {
        Ok(n)
    } else {
        let message = format!("got {n}; needed: at most {MOST_NODES}");
        Err(SceneError::key(key, message))
    }
}
