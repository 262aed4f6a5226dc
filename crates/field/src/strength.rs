//! Grids of how much each pixel attracts: edges in color or at several scales, lines, ends and corners.
//!
//! Each of these is a strength P, large where a snake should rest; [`gradient_force`](crate::gradient_force) makes
//! the force `gain · ∇P` of it, whose energy is −`gain` · P.

use crate::edge::gradient;
use crate::error::{FieldError, positive};
use crate::grid::{Grid, admit};
use crate::smooth::Smoothing;

/// Edge strength of a picture of any number of channels, by the structure tensor they share.
///
/// ```text
/// J = Σ_channels ∇(G ∗ I) ∇(G ∗ I)ᵀ        P = √(λ₁ − λ₂)
/// ```
///
/// λ₁ ≥ λ₂ are J's eigenvalues. For one channel this is the corrected edge force's |∇(G ∗ I)|; n equal channels give √n times it. An
/// edge between two colors of equal grey is seen; where channels disagree about the direction it counts for less.
/// O(channels · pixels · passes).
///
/// \[dizenzo86\], \[sapiro96\]
///
/// # Errors
/// No channels, channels of different shapes, what [`edge_force`](crate::edge_force) refuses.
pub fn color_edge_strength(channels: &[Grid], smoothing: Smoothing) -> Result<Grid, FieldError> {
    smoothing.validate()?;
    let first = channels
        .first()
        .ok_or(FieldError::Empty {
            width: 0,
            height: 0,
        })?
        .dim();
    let (mut xx, mut xy, mut yy) = (Grid::zeros(first), Grid::zeros(first), Grid::zeros(first));
    for channel in channels {
        if channel.dim() != first {
            return Err(FieldError::ShapesDiffer {
                first,
                second: channel.dim(),
            });
        }
        let (x, y) = gradient(&smoothing.apply(&admit(channel, 1.0)?));
        xx = xx + &x * &x;
        xy = xy + &x * &y;
        yy = yy + &y * &y;
    }
    // λ₁ − λ₂ = √((xx − yy)² + 4 xy²)
    Ok(Grid::from_shape_fn(first, |at| {
        (xx[at] - yy[at]).hypot(2.0 * xy[at]).sqrt()
    }))
}

/// Edge strength from several scales: the largest of `σ^½ · |∇(G_σ ∗ I)|` at each pixel.
///
/// Large scales reach far, small ones are exact; the factor keeps a step edge's own scale from always being the
/// smallest. Give one σ at a time, coarse first, for a schedule.
///
/// \[lindeberg98\]
///
/// # Errors
/// No scales, what [`edge_force`](crate::edge_force) refuses.
pub fn multiscale_edge_strength(image: &Grid, sigmas: &[f64]) -> Result<Grid, FieldError> {
    let image = admit(image, 1.0)?;
    if sigmas.is_empty() {
        return Err(FieldError::NotPositive {
            name: "number of scales",
            value: 0.0,
        });
    }
    let mut strength = Grid::zeros(image.dim());
    for &sigma in sigmas {
        let smoothing = Smoothing::Gaussian(sigma);
        smoothing.validate()?;
        let (x, y) = gradient(&smoothing.apply(&image));
        let factor = sigma.sqrt();
        strength.zip_mut_with(
            &Grid::from_shape_fn(image.dim(), |at| factor * x[at].hypot(y[at])),
            |p, &q| {
                *p = p.max(q);
            },
        );
    }
    Ok(strength)
}

/// What a line is brighter or darker than.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// Bright lines attract.
    Bright,
    /// Dark lines attract.
    Dark,
}

/// Line strength: the smoothed picture itself, or its negative.
///
/// The simplest of the classical image forces: a snake slides to the brightest (darkest) place.
///
/// \[kass88\]
///
/// # Errors
/// What [`edge_force`](crate::edge_force) refuses.
pub fn line_strength(image: &Grid, smoothing: Smoothing, line: Line) -> Result<Grid, FieldError> {
    smoothing.validate()?;
    let smoothed = smoothing.apply(&admit(image, 1.0)?);
    Ok(match line {
        Line::Bright => smoothed,
        Line::Dark => -smoothed,
    })
}

/// Termination strength: how sharply the contour lines of the smoothed picture C turn.
///
/// ```text
/// P = |C_yy C_x² − 2 C_xy C_x C_y + C_xx C_y²| / (C_x² + C_y² + ε²)^(3/2)
/// ```
///
/// The curvature of the level line through a pixel, 1/px: large at the ends of lines and at corners. `floor` is
/// ε, a gradient in grey levels per pixel below which a pixel is not trusted to have a direction.
///
/// \[kass88\], with ε of ours: without it flat regions are all noise.
///
/// # Errors
/// A `floor` that is not above 0, what [`edge_force`](crate::edge_force) refuses.
pub fn termination_strength(
    image: &Grid,
    smoothing: Smoothing,
    floor: f64,
) -> Result<Grid, FieldError> {
    positive("floor", floor)?;
    smoothing.validate()?;
    let smoothed = smoothing.apply(&admit(image, 1.0)?);
    let (x, y) = gradient(&smoothed);
    let ((xx, xy), (_, yy)) = (gradient(&x), gradient(&y));
    Ok(Grid::from_shape_fn(smoothed.dim(), |at| {
        let (x, y) = (x[at], y[at]);
        let turn = yy[at] * x * x - 2.0 * xy[at] * x * y + xx[at] * y * y;
        turn.abs() / (x * x + y * y + floor * floor).powf(1.5)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EdgeForce, edge_stages};

    const SMOOTHING: Smoothing = Smoothing::Gaussian(1.5);

    fn disk(side: usize, radius: f64) -> Grid {
        let c = (side as f64 - 1.0) / 2.0;
        Grid::from_shape_fn((side, side), |(y, x)| {
            // one pixel of ramp instead of stairs
            100.0 * (radius - (x as f64 - c).hypot(y as f64 - c) + 0.5).clamp(0.0, 1.0)
        })
    }

    fn largest_at(grid: &Grid) -> (usize, usize) {
        let best = grid
            .indexed_iter()
            .max_by(|a, b| a.1.total_cmp(b.1))
            .unwrap();
        best.0
    }

    #[test]
    fn one_channel_is_the_grey_edge_strength_and_equal_ones_add_up() {
        let image = disk(30, 9.0);
        let grey = edge_stages(
            &image,
            &EdgeForce {
                smoothing: SMOOTHING,
                gain: 1.0,
            },
        )
        .unwrap()
        .strength;
        let one = color_edge_strength(std::slice::from_ref(&image), SMOOTHING).unwrap();
        let three = color_edge_strength(&[image.clone(), image.clone(), image], SMOOTHING).unwrap();
        for ((a, b), c) in grey.iter().zip(&one).zip(&three) {
            assert!((a - b).abs() < 1e-10 && (3.0_f64.sqrt() * a - c).abs() < 1e-10);
        }
    }

    #[test]
    fn an_edge_between_colors_of_equal_grey_is_seen() {
        let red = Grid::from_shape_fn((20, 20), |(_, x)| if x >= 10 { 200.0 } else { 50.0 });
        let green = red.mapv(|v| 250.0 - v);
        let grey = (&red + &green) / 2.0;
        let smoothing = Smoothing::Binomial(4);
        let blind = color_edge_strength(&[grey], smoothing).unwrap();
        let seen = color_edge_strength(&[red, green], smoothing).unwrap();
        assert!(blind.iter().all(|&p| p == 0.0));
        assert!(seen[[10, 9]] > 30.0 && largest_at(&seen).1.abs_diff(9) <= 1);
    }

    #[test]
    fn many_scales_reach_as_far_as_the_coarsest_and_are_as_sharp_as_the_finest() {
        let image = Grid::from_shape_fn((9, 80), |(_, x)| if x >= 40 { 100.0 } else { 0.0 });
        let fine = multiscale_edge_strength(&image, &[1.0]).unwrap();
        let both = multiscale_edge_strength(&image, &[8.0, 1.0]).unwrap();
        assert!(fine[[4, 22]] < 1e-12 && both[[4, 22]] > 0.1);
        // the step's own factor: σ^½ / σ falls, so the finest wins at the edge
        assert_eq!(both[[4, 40]].to_bits(), fine[[4, 40]].to_bits());
        assert!(multiscale_edge_strength(&image, &[]).is_err());
        assert!(multiscale_edge_strength(&image, &[1.0, 0.0]).is_err());
    }

    #[test]
    fn lines_attract_where_they_are() {
        let image = Grid::from_shape_fn((15, 15), |(y, _)| if y == 6 { 90.0 } else { 10.0 });
        assert_eq!(
            largest_at(&line_strength(&image, SMOOTHING, Line::Bright).unwrap()).0,
            6
        );
        let dark = line_strength(&image, SMOOTHING, Line::Dark).unwrap();
        assert_eq!(largest_at(&-dark).0, 6);
    }

    #[test]
    fn terminations_measure_the_turn_of_level_lines() {
        // cones have circles as level lines: curvature one over the distance
        let cone = Grid::from_shape_fn((61, 61), |(y, x)| (x as f64 - 30.0).hypot(y as f64 - 30.0));
        let turn = termination_strength(&cone, Smoothing::Binomial(1), 1e-6).unwrap();
        for r in [10_usize, 15, 20] {
            let p = turn[[30, 30 + r]];
            assert!((p * r as f64 - 1.0).abs() < 0.02, "{r}: {p}");
        }
        // a straight edge does not turn
        let edge = Grid::from_shape_fn((30, 30), |(_, x)| if x >= 15 { 100.0 } else { 0.0 });
        let turn = termination_strength(&edge, SMOOTHING, 1.0).unwrap();
        assert!(turn.iter().all(|&p| p < 1e-12));
        // a corner turns most near the corner, within the two σ that round it
        let corner = Grid::from_shape_fn(
            (40, 40),
            |(y, x)| if x >= 20 && y >= 20 { 100.0 } else { 0.0 },
        );
        let (y, x) = largest_at(&termination_strength(&corner, SMOOTHING, 1.0).unwrap());
        assert!(x.abs_diff(20) <= 3 && y.abs_diff(20) <= 3, "{x}, {y}");
    }

    #[test]
    fn bad_input_is_refused() {
        assert!(color_edge_strength(&[], SMOOTHING).is_err());
        assert!(
            color_edge_strength(&[Grid::zeros((2, 2)), Grid::zeros((2, 3))], SMOOTHING).is_err()
        );
        assert!(termination_strength(&Grid::zeros((3, 3)), SMOOTHING, 0.0).is_err());
        assert!(line_strength(&Grid::zeros((0, 3)), SMOOTHING, Line::Dark).is_err());
    }
}
