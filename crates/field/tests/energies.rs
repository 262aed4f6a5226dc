//! Which forces have an energy: the work along every closed way is nothing.
#![allow(clippy::unwrap_used, reason = "a test may stop")]
#![allow(
    clippy::cast_possible_truncation,
    reason = "pictures in single precision"
)]

use field::{
    Across, EdgeForce, Falloff, FlowRule, ForceField, Grid, Line, Recipe, Smoothing, VectorFlow,
    color_edge_strength, edge_force, fast_force, gradient_force, line_strength, mask_x, mask_y,
    multiscale_edge_strength, point_distance_force, report_force, termination_strength,
    vector_convolution, vector_flow,
};
use glam::DVec2;
use proptest::prelude::*;

const SMOOTHING: Smoothing = Smoothing::Gaussian(1.5);

/// Grey blobs over a slope, so that nothing is flat and nothing symmetric.
fn picture(blobs: &[(f64, f64, f64)]) -> Grid {
    Grid::from_shape_fn((40, 48), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64);
        let blob = |&(x, y, size): &(f64, f64, f64)| {
            let d = p.distance(DVec2::new(x, y));
            90.0 / (1.0 + (d - size).exp())
        };
        0.2 * p.x + 0.1 * p.y + blobs.iter().map(blob).sum::<f64>()
    })
}

fn blobs() -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    proptest::collection::vec((5.0..43.0, 5.0..35.0, 2.0..9.0), 2..5)
}

/// The largest curl away from the border, by the masks of the gradient itself, as a share of the largest
/// change of the force from pixel to pixel.
///
/// The masks commute, so what is a gradient by them has none but for rounding.
fn curl(field: &ForceField) -> f64 {
    let (x, y) = field.components();
    let parts = [
        mask_y(&x, Across::Mirror),
        mask_x(&y, Across::Mirror),
        mask_x(&x, Across::Mirror),
        mask_y(&y, Across::Mirror),
    ];
    let (height, width) = x.dim();
    let (mut turn, mut change) = (0.0_f64, 0.0_f64);
    for at in (4..height - 4).flat_map(|y| (4..width - 4).map(move |x| [y, x])) {
        turn = turn.max((parts[0][at] - parts[1][at]).abs());
        change = parts.iter().map(|p| p[at].abs()).fold(change, f64::max);
    }
    turn / change
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_force_that_states_an_energy_has_no_curl(blobs in blobs()) {
        let image = picture(&blobs);
        let rule = EdgeForce { smoothing: SMOOTHING, gain: 3.0 };
        let colors = [image.clone(), image.mapv(|v| (v * 0.7 + 3.0).sqrt())];
        let points: Vec<DVec2> = blobs.iter().map(|&(x, y, _)| DVec2::new(x, y)).collect();
        let of = |strength: Grid| gradient_force(&strength, 2.0).unwrap();
        let kinds = [
            ("edge", edge_force(&image, &rule).unwrap()),
            ("scales", of(multiscale_edge_strength(&image, &[1.0, 2.0, 4.0]).unwrap())),
            ("color", of(color_edge_strength(&colors, SMOOTHING).unwrap())),
            ("line", of(line_strength(&image, SMOOTHING, Line::Dark).unwrap())),
            ("termination", of(termination_strength(&image, SMOOTHING, 0.5).unwrap())),
            ("distance", point_distance_force(&points, image.dim(), 1.0, 20.0).unwrap()),
        ];
        for (name, field) in kinds {
            // a few hundred roundings of numbers up to a few hundred times the smallest change
            prop_assert!(curl(&field) < 1e-10, "{}: {}", name, curl(&field));
        }
        // in single precision: rounding of the forces, which change by some percent of themselves a pixel
        let single = fast_force(image.mapv(|v| v as f32).view(), &Recipe::Edge(rule), 1).unwrap();
        prop_assert!(curl(&single) < 1e-4, "single precision: {}", curl(&single));
    }

    #[test]
    fn the_forces_that_state_none_have_a_curl(blobs in blobs()) {
        let image = picture(&blobs);
        let map = field::edge_stages(&image, &EdgeForce { smoothing: SMOOTHING, gain: 1.0 }).unwrap().strength;
        let flow = VectorFlow { rule: FlowRule::Plain { smoothness: 0.2 }, residual: 1e-8 };
        let kinds = [
            ("report", report_force(&image, 3, 1.0, 1.0).unwrap()),
            ("GVF", vector_flow(&map, &flow).unwrap().field),
            ("VFC", vector_convolution(&map, Falloff::Power { exponent: 2.0 }, 12.0).unwrap()),
        ];
        for (name, field) in kinds {
            prop_assert!(curl(&field) > 1e-6, "{}: {}", name, curl(&field));
        }
    }
}
