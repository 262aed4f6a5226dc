//! The data of a path: `M 1,2 L 3,4 Z` and all other steps, in either case.

use glam::DVec2;
use svgtypes::{PathParser, PathSegment};

use super::Ring;
use crate::shapes::budget::{Budget, point};
use crate::shapes::flatten;

/// Where a pen is on its way.
#[derive(Default)]
struct Pen {
    at: DVec2,
    /// Where its part began.
    begin: DVec2,
    /// The last corner of the curve before, mirrored at its end, by the number of its corners.
    mirrored: Option<(u8, DVec2)>,
}

pub(super) fn rings(data: &str, flat: f64, budget: &mut Budget) -> Result<Vec<Ring>, String> {
    let mut rings: Vec<Ring> = Vec::new();
    let mut pen = Pen::default();
    let mut down = false;
    for (number, segment) in (1..).zip(PathParser::from(data)) {
        let segment = segment.map_err(|_| format!("step {number} of its path cannot be read"))?;
        let within = |what: String| format!("step {number} of its path: {what}");
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                pen.at = pen.place(abs, x, y);
                (pen.begin, pen.mirrored) = (pen.at, None);
                budget.ring(1)?;
                rings.push(Ring {
                    points: vec![pen.at],
                    closed: false,
                });
                down = true;
            }
            PathSegment::ClosePath { .. } => {
                if let Some(ring) = rings.last_mut() {
                    ring.closed = true;
                }
                (pen.at, pen.mirrored) = (pen.begin, None);
                down = false;
            }
            other => {
                if !down {
                    // behind the end of a part, the next begins where it did
                    budget.ring(1)?;
                    rings.push(Ring {
                        points: vec![pen.at],
                        closed: false,
                    });
                    down = true;
                }
                let points = pen.draw(other, flat);
                point(pen.at.x, pen.at.y).map_err(within)?;
                budget.points(points.len()).map_err(within)?;
                if let Some(ring) = rings.last_mut() {
                    ring.points.extend(points);
                }
            }
        }
    }
    Ok(rings)
}

impl Pen {
    fn place(&self, abs: bool, x: f64, y: f64) -> DVec2 {
        let p = DVec2::new(x, y);
        if abs { p } else { self.at + p }
    }

    /// The points behind the pen of a step that draws, which it goes.
    fn draw(&mut self, segment: PathSegment, flat: f64) -> Vec<DVec2> {
        let from = self.at;
        // the corner that goes on as the curve before did
        let smooth = |pen: &Self, kind: u8| match pen.mirrored {
            Some((known, corner)) if known == kind => corner,
            _ => from,
        };
        let mut mirrored = None;
        let points = match segment {
            PathSegment::LineTo { abs, x, y } => vec![self.place(abs, x, y)],
            PathSegment::HorizontalLineTo { abs, x } => {
                let x = if abs { x } else { from.x + x };
                vec![DVec2::new(x, from.y)]
            }
            PathSegment::VerticalLineTo { abs, y } => {
                let y = if abs { y } else { from.y + y };
                vec![DVec2::new(from.x, y)]
            }
            PathSegment::CurveTo {
                abs,
                x1,
                y1,
                x2,
                y2,
                x,
                y,
            } => {
                let [b, c, d] = [(x1, y1), (x2, y2), (x, y)].map(|(x, y)| self.place(abs, x, y));
                mirrored = Some((3, 2.0 * d - c));
                flatten::cubic([from, b, c, d], flat)
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let b = smooth(self, 3);
                let [c, d] = [(x2, y2), (x, y)].map(|(x, y)| self.place(abs, x, y));
                mirrored = Some((3, 2.0 * d - c));
                flatten::cubic([from, b, c, d], flat)
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let [b, c] = [(x1, y1), (x, y)].map(|(x, y)| self.place(abs, x, y));
                mirrored = Some((2, 2.0 * c - b));
                flatten::quadratic([from, b, c], flat)
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let b = smooth(self, 2);
                let c = self.place(abs, x, y);
                mirrored = Some((2, 2.0 * c - b));
                flatten::quadratic([from, b, c], flat)
            }
            PathSegment::EllipticalArc {
                abs,
                rx,
                ry,
                x_axis_rotation,
                large_arc,
                sweep,
                x,
                y,
            } => {
                let to = self.place(abs, x, y);
                let radii = DVec2::new(rx, ry);
                let turned = x_axis_rotation.to_radians();
                flatten::svg_arc([from, to], radii, turned, [large_arc, sweep], flat)
            }
            PathSegment::MoveTo { .. } | PathSegment::ClosePath { .. } => Vec::new(),
        };
        self.at = points.last().copied().unwrap_or(from);
        self.mirrored = mirrored;
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::rings::area;

    fn ends(data: &str) -> Vec<(f64, f64)> {
        let rings = rings(data, 1e3, &mut Budget::default()).unwrap();
        rings
            .iter()
            .flat_map(|ring| &ring.points)
            .map(|p| (p.x, p.y))
            .collect()
    }

    #[test]
    fn steps_of_either_case_go_where_they_should() {
        let square = [(1.0, 1.0), (5.0, 1.0), (5.0, 4.0), (1.0, 4.0)];
        for data in [
            "M1,1 L5,1 L5,4 L1,4 Z",
            "m1 1 4 0 0 3-4 0z",
            "M1 1H5V4H1Z",
            "m1,1h4v3h-4z",
            "M1 1C2 1 4 1 5 1s0 2 0 3Q3 4 1 4Z",
            "M1 1A9 9 0 0 1 5 1a9 9 0 015 3M5 4",
        ] {
            let found = ends(data);
            assert_eq!(found[..2], square[..2], "{data}");
            if !data.contains('a') {
                assert_eq!(found.len(), 4, "{data}");
                assert_eq!(found, square, "{data}");
            }
        }
        // behind an end, relative steps go on from the part's beginning
        assert_eq!(
            ends("M1 1h1v1zl3 0 0 3"),
            [
                (1.0, 1.0),
                (2.0, 1.0),
                (2.0, 2.0),
                (1.0, 1.0),
                (4.0, 1.0),
                (4.0, 4.0)
            ]
        );
    }

    #[test]
    fn a_circle_of_arcs_or_curves_has_its_area() {
        let whole = std::f64::consts::PI * 2500.0;
        for (data, off) in [
            ("M50 0A50 50 0 1 1 -50 0A50 50 0 1 1 50 0Z", 2.2),
            ("M50 0a50 50 0 11-100 0a50 50 0 11100 0z", 2.2),
            // the usual curves for a quarter are off by 3 in 10 000
            (
                "M50 0C50 27.614237 27.614237 50 0 50S-50 27.614237 -50 0-27.614237-50 0-50 50-27.614237 50 0Z",
                4.0,
            ),
        ] {
            let rings = rings(data, 0.01, &mut Budget::default()).unwrap();
            let found = area(&rings[0].points);
            assert!((found - whole).abs() < off, "{data}: {found}");
        }
    }
}
