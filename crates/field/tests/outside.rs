//! What scipy, scikit-image and `OpenCV` say about the parts they share with this crate.
#![allow(clippy::unwrap_used, reason = "a test may stop")]

use crate::common::{outside, within};
use field::{
    Across, Canny, EdgeForce, FlowRule, Smoothing, VectorFlow, edge_points, edge_stages, mask_x,
    mask_y, squared_distance, vector_flow,
};
use glam::DVec2;

#[test]
fn gaussians_are_scipys_and_opencvs() {
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(1.5),
        gain: 1.0,
    };
    let smoothed = edge_stages(&outside("image"), &rule).unwrap().smoothed;
    // the same sampled weights; scipy cuts at 8.7 σ, OpenCV at 13 pixels, where they are below 1e-16
    within("scipy", 1e-11, &smoothed, &outside("gaussian_1.5"));
    within("opencv", 1e-11, &smoothed, &outside("gaussian_1.5_cv"));
}

#[test]
fn derivatives_are_scipys_and_opencvs() {
    let image = outside("image");
    // whole numbers over 8: exact
    let (x, y) = (
        mask_x(&image, Across::Mirror),
        mask_y(&image, Across::Mirror),
    );
    within("scipy", 0.0, &(x * 0.5), &outside("sobel_x"));
    within("opencv", 0.0, &(y * 0.5), &outside("sobel_y_cv"));
}

#[test]
fn distances_are_scipys_exactly_and_opencvs_to_its_single_precision() {
    let distance = squared_distance(&outside("edges").mapv(|e| e > 0.5)).mapv(f64::sqrt);
    within("scipy", 1e-14, &distance, &outside("distance"));
    // f32 of distances below 16
    within("opencv", 2e-6, &distance, &outside("distance_cv"));
}

#[test]
fn gradient_vector_flow_solves_its_equation() {
    let rule = FlowRule::Plain { smoothness: 0.02 };
    let flow = VectorFlow {
        rule,
        residual: 1e-12,
    };
    let (x, y) = vector_flow(&outside("flow_strength"), &flow)
        .unwrap()
        .field
        .components();
    // forces of some tenths; the residual is amplified by the range over which the flow is carried
    within("x", 1e-10, &x, &outside("flow_x"));
    within("y", 1e-10, &y, &outside("flow_y"));
}

#[test]
fn edges_run_through_the_pixels_that_scikit_image_marks() {
    let marked = outside("canny");
    let rule = Canny {
        sigma: 2.0,
        high: 10.0,
        low: 4.0,
    };
    let points = edge_points(&outside("ellipse"), &rule).unwrap();
    let near = |p: DVec2, q: DVec2| p.distance(q) <= 1.0;
    let pixels: Vec<DVec2> = marked
        .indexed_iter()
        .filter(|(_, mark)| **mark > 0.5)
        .map(|((y, x), _)| DVec2::new(x as f64, y as f64))
        .collect();
    assert!(pixels.len() > 80 && points.len() > 80);
    for p in &points {
        // to the pixel: theirs are not placed between
        assert!(pixels.iter().any(|&q| near(p.position, q)), "{p:?}");
    }
    for &q in &pixels {
        assert!(points.iter().any(|p| near(p.position, q)), "{q}");
    }
    // and through the ellipse that was drawn: noise of 3 in a contrast of 140, a pixel at a time; less the pull of blur inwards
    for p in &points {
        let d = p.position - DVec2::new(31.3, 30.6);
        let (u, v) = (d.x / 22.0, d.y / 14.0);
        // first-order distance from the curve u² + v² = 1
        let level = (u * u + v * v - 1.0) / (2.0 * (u / 22.0).hypot(v / 14.0));
        assert!((level + 0.1).abs() < 0.4, "{p:?}: {level}");
    }
}
