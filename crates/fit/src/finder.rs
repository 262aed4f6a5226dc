//! The method of searches: from a start to an outline on its edge, and what speaks for it.

use glam::DVec2;
use search::along::Polygon;
use search::{Rules, Support};
use snake::Outcome;

use crate::evidence::LEAST_AREA;
use crate::{
    Choices, Contour, Doubt, Evidence, Fit, FitError, NodeEvidence, Nodes, OptionKey, Prepared,
    Problem, Searched,
};

/// The last stage may move an outline by so many pixels of the search, and at least by so many of the image.
const REACH: f64 = 1.5;

/// The last stage may lose so much of the mean strength of the edge.
const LOST: f64 = 0.05;

/// Outlines from clicks side by side must overlap so much, in the mean, to be those of one object.
const STEADY: f64 = 0.65;

/// Nodes of an outline, one a pixel.
const SPACING: f64 = 1.0;

/// Rounds of the last stage.
const ROUNDS: u64 = 5;

/// A start, or a part of one that crosses itself, counts from this area on. Square pixels.
const LEAST_PART: f64 = 1.0;

/// Find the outline about a start; None where `asked` has ended it before.
pub(crate) fn found(
    prepared: &Prepared,
    start: &Contour,
    asked: &dyn Fn() -> bool,
) -> Result<Option<Fit>, FitError> {
    let pixels = prepared.image().pixels();
    let rules = &prepared.options().search;
    prepared.options().nodes.check(start.closed)?;
    let begun = begin(prepared, start)?;
    let searched = match &begun {
        Begun::Click(place) => search::find_around_unless(pixels, *place, rules, asked),
        Begun::Curve { curve, .. } if curve.closed && curve.area() < LEAST_PART => Ok(None),
        Begun::Curve { curve, .. } => search::find_unless(pixels, curve, rules, asked),
    };
    let Ok(searched) = searched else {
        return Ok(None);
    };
    let Some(searched) = searched else {
        let message = "encloses nothing; a start with an area or a length is needed";
        return Err(FitError::new(
            OptionKey::Start,
            Problem::Other(message.to_owned()),
        ));
    };
    let (start_curve, repaired) = match begun {
        Begun::Click(_) => (None, false),
        Begun::Curve { curve, repaired } => (Some(curve), repaired),
    };
    let least = start_curve
        .as_ref()
        .map_or(0.0, |curve| LEAST_AREA * curve.area());
    let (taken, instead, curve) = valid(&searched, least, start_curve.as_ref());
    let curve = clipped(curve, prepared.image().size());
    if asked() {
        return Ok(None);
    }
    let precise = precise(prepared, &searched, &curve, least);
    let (points, normals, edge) = (precise.points, precise.normals, precise.edge);
    let outline = Polygon {
        points,
        closed: curve.closed,
    };
    let support = searched.support(&outline);
    let unsteady = searched.steady.filter(|overlap| *overlap < STEADY);
    let doubt = doubt(&support, taken, edge.is_some(), rules).or_else(|| {
        unsteady.map(|overlap| Doubt::Unsteady {
            overlap,
            needed: STEADY,
        })
    });
    let strengths = searched.strengths(&outline);
    let blur = edge.map_or(1.0, |edge| edge.blur);
    let node = |i: usize| {
        let strength = strengths[i].unwrap_or(0.0);
        NodeEvidence {
            normal: normals[i],
            // that of a step that a Gaussian has blurred, at its middle
            slope: -precise.heights[i] / (std::f64::consts::TAU.sqrt() * blur),
            strength,
            offset: precise.errors[i].map(|_| 0.0),
            held: strength >= rules.unsure,
            error: precise.errors[i],
        }
    };
    let nodes: Vec<NodeEvidence> = (0..outline.points.len()).map(node).collect();
    let held = nodes.iter().filter(|node| node.held).count() as f64 / nodes.len().max(1) as f64;
    let chosen = Searched {
        seen: searched.seen,
        found: searched
            .found
            .iter()
            .map(|found| (found.search, found.support))
            .collect(),
        curves: searched
            .found
            .iter()
            .map(|found| found.points.clone())
            .collect(),
        taken,
        instead,
        around: searched.around,
        repaired,
        pixel: searched.pixel,
        support,
        edge,
        nodes: nodes.len(),
    };
    let area = outline.closed.then(|| {
        let end = elastic::signed_area(&outline.points);
        (
            start_curve
                .as_ref()
                .map_or(end, |curve| elastic::signed_area(&curve.points)),
            end,
        )
    });
    let crossings =
        outline::crossings(&outline.points, outline.closed).map_or(0, |found| found.len());
    let quality = Evidence {
        held,
        crossings,
        area,
        doubt,
        narrow: None,
    };
    let wound = start.closed && elastic::signed_area(&start.clicks()) < 0.0;
    let (mut points, mut nodes) = thinned(prepared.options().nodes, outline.points, nodes);
    if wound {
        points.reverse();
        nodes.reverse();
    }
    Ok(Some(Fit {
        contour: Contour {
            points,
            closed: outline.closed,
        },
        nodes,
        quality: Some(quality),
        outcome: Outcome::Settled { step: ROUNDS },
        steps: ROUNDS,
        chosen: Choices::Search(chosen),
    }))
}

/// Where a search begins.
enum Begun {
    /// A place inside.
    Click(DVec2),
    /// A curve, closed ones clockwise on the screen.
    Curve { curve: Polygon, repaired: bool },
}

/// The start as it is searched from.
fn begin(prepared: &Prepared, start: &Contour) -> Result<Begun, FitError> {
    let refuse = |problem| Err(FitError::new(OptionKey::Start, problem));
    let clicks = start.clicks();
    if let Some(index) = clicks.iter().position(|p| !p.is_finite()) {
        return refuse(Problem::Other(format!(
            "point {index} must be finite, got {}",
            clicks[index]
        )));
    }
    let (width, height) = prepared.image().size();
    let last = DVec2::new(width as f64, height as f64) - 0.5;
    let inside = |p: &DVec2| p.cmpge(DVec2::splat(-0.5)).all() && p.cmple(last).all();
    if let [place] = clicks[..] {
        if inside(&place) {
            return Ok(Begun::Click(place));
        }
        let DVec2 { x, y } = place;
        return refuse(Problem::Outside {
            index: 0,
            x,
            y,
            width,
            height,
        });
    }
    let least = if start.closed { 3 } else { 2 };
    if clicks.len() < least {
        let got = clicks.len() as u64;
        let problem = Problem::Count {
            least: least as u64,
            most: u64::MAX,
            got,
        };
        return refuse(problem);
    }
    let low = clicks.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = clicks.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    if high.cmplt(DVec2::splat(-0.5)).any() || low.cmpgt(last).any() {
        let DVec2 { x, y } = clicks[0];
        return refuse(Problem::Outside {
            index: 0,
            x,
            y,
            width,
            height,
        });
    }
    let mut curve = Polygon {
        points: clicks,
        closed: start.closed,
    };
    let mut repaired = false;
    if start.closed {
        let simple = outline::crossings(&curve.points, true).is_ok_and(|found| found.is_empty());
        if !simple && let Some(part) = largest(&curve.points) {
            curve.points = part;
            repaired = true;
        }
        curve = curve.outwards();
    }
    Ok(Begun::Curve { curve, repaired })
}

/// The largest part of a curve that crosses itself, whichever way it runs.
fn largest(points: &[DVec2]) -> Option<Vec<DVec2>> {
    let turned: Vec<DVec2> = points.iter().rev().copied().collect();
    let parts = [points, &turned].into_iter().filter_map(|points| {
        let resolved = outline::resolve(points, LEAST_PART).ok()?;
        resolved
            .pieces
            .into_iter()
            .max_by(|a, b| a.area.total_cmp(&b.area))
    });
    let largest = parts.max_by(|a, b| a.area.total_cmp(&b.area))?;
    Some(largest.nodes)
}

/// The curve that was taken, or the next best one, or the start: without crossings and not collapsed.
fn valid(
    searched: &search::Searched,
    least: f64,
    start: Option<&Polygon>,
) -> (Option<usize>, bool, Polygon) {
    let mut order: Vec<usize> = (0..searched.found.len()).collect();
    order.sort_by(|&a, &b| {
        let closed = |i: usize| searched.found[i].support.closed;
        (b == searched.taken)
            .cmp(&(a == searched.taken))
            .then(closed(b).total_cmp(&closed(a)))
    });
    for (rank, &index) in order.iter().enumerate() {
        let points = &searched.found[index].points;
        let closed = start.is_none_or(|start| start.closed);
        let mut curve = Polygon {
            points: points.clone(),
            closed,
        };
        if closed {
            if outline::crossings(points, true).is_ok_and(|found| !found.is_empty()) {
                let Some(part) = largest(points) else {
                    continue;
                };
                curve.points = part;
            }
            if curve.area() < least || curve.area() <= 0.0 {
                continue;
            }
        }
        return (Some(index), rank > 0, curve);
    }
    let start = start.cloned();
    let start = start.unwrap_or_else(|| Polygon {
        points: searched.taken().points.clone(),
        closed: true,
    });
    (None, true, start)
}

/// A curve within the image: the side of an object along the border is the border (Sutherland and
/// Hodgman's cutting of a
/// polygon, side by side).
fn clipped(mut curve: Polygon, (width, height): (usize, usize)) -> Polygon {
    let last = DVec2::new(width as f64, height as f64) - 0.5;
    let sides: [(DVec2, DVec2); 4] = [
        (DVec2::splat(-0.5), DVec2::X),
        (DVec2::splat(-0.5), DVec2::Y),
        (last, DVec2::NEG_X),
        (last, DVec2::NEG_Y),
    ];
    for (point, inward) in sides {
        let depth = |p: DVec2| (p - point).dot(inward);
        if curve.points.iter().all(|p| depth(*p) >= 0.0) {
            continue;
        }
        let n = curve.points.len();
        let mut kept = Vec::with_capacity(n + 4);
        for i in 0..n {
            let (a, b) = (curve.points[i], curve.points[(i + 1) % n]);
            let (from, to) = (depth(a), depth(b));
            if from >= 0.0 {
                kept.push(a);
            }
            let joined = curve.closed || i + 1 < n;
            if joined && (from >= 0.0) != (to >= 0.0) {
                kept.push(a.lerp(b, from / (from - to)));
            }
        }
        if kept.len() >= 3 {
            curve.points = kept;
        }
    }
    for p in &mut curve.points {
        *p = p.clamp(DVec2::splat(-0.5), last);
    }
    curve
}

/// The curve on its edge; as it was found where that would fold it, or where it would lose its edge.
fn precise(
    prepared: &Prepared,
    searched: &search::Searched,
    curve: &Polygon,
    least: f64,
) -> subpixel::Precise {
    let pixel = searched.pixel;
    let spacing = match prepared.options().nodes {
        Nodes::Count(count) => (curve.length() / count.max(1) as f64).min(SPACING),
        Nodes::Every(_) | Nodes::Auto => SPACING,
    };
    let rules = subpixel::Rules {
        reach: REACH * pixel.max(1.0),
        spacing,
        rough: REACH * pixel.max(1.0),
    };
    let found = subpixel::refine(prepared.image().pixels(), curve, rules);
    let before = searched.support(curve);
    let good = found.filter(|found| {
        let crossed = outline::crossings(&found.points, curve.closed);
        let after = Polygon {
            points: found.points.clone(),
            closed: curve.closed,
        };
        crossed.is_ok_and(|crossed| crossed.is_empty())
            && (!curve.closed || elastic::signed_area(&found.points) > least)
            && searched.support(&after).edge > before.edge - LOST
    });
    let mut precise = good.unwrap_or_else(|| subpixel::as_found(curve, rules));
    let last = prepared.image().size();
    let last = DVec2::new(last.0 as f64, last.1 as f64) - 0.5;
    for p in &mut precise.points {
        *p = p.clamp(DVec2::splat(-0.5), last);
    }
    precise
}

/// Why a search is not sure; `stepped`: whether the last stage found a step across the outline.
fn doubt(support: &Support, taken: Option<usize>, stepped: bool, rules: &Rules) -> Option<Doubt> {
    if taken.is_none() {
        return Some(Doubt::Folded);
    }
    let (closed, needed) = (support.closed, rules.unsure);
    if closed < needed {
        return Some(Doubt::NoEdge { closed, needed });
    }
    let (beside, most) = (support.beside, search::SLOPE);
    (!stepped && support.is_slope()).then_some(Doubt::Slope { beside, most })
}

/// The number of nodes that was asked for.
fn thinned(
    nodes: Nodes,
    points: Vec<DVec2>,
    evidence: Vec<NodeEvidence>,
) -> (Vec<DVec2>, Vec<NodeEvidence>) {
    let count = match nodes {
        Nodes::Auto => return (points, evidence),
        Nodes::Count(count) => count,
        Nodes::Every(spacing) => Nodes::Every(spacing).along(SPACING * points.len() as f64),
    };
    if count >= points.len() {
        return (points, evidence);
    }
    let pick = |i: usize| i * points.len() / count;
    let kept = (0..count).map(pick);
    kept.map(|i| (points[i], evidence[i])).unzip()
}
