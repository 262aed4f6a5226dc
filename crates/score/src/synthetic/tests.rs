//! What is drawn is what the formulas say.

use super::*;
use crate::{Measures, border, filled};

#[test]
fn truths_have_the_measures_of_their_formulas() {
    let of = |name: &str| {
        let all = cases();
        let case = all.iter().find(|case| case.name == name).unwrap();
        (Measures::of(&[case.truth()]).unwrap(), case.radius())
    };
    let (disk, radius) = of("disk");
    assert!((disk.area - 11309.73).abs() < 0.01 && (disk.perimeter - 376.99).abs() < 0.01);
    assert!((radius - 60.0).abs() < 1e-4);
    // ½ ∫ r² dt = π R² (1 + d² / 2)
    let (star, _) = of("star");
    let exact = std::f64::consts::PI * 4900.0 * (1.0 + 0.045);
    assert!((star.area - exact).abs() < 1e-5 * exact);
    assert_eq!(of("u_shape").0.area, 140.0 * 140.0 - 50.0 * 92.0);
    assert_eq!(of("box").0.area, 128.0 * 128.0);
}

#[test]
fn half_way_between_the_levels_lies_the_truth() {
    for case in cases() {
        if case.noise + case.salt_and_pepper + case.shade.abs() > 0.0 || case.distractor.is_some() {
            continue;
        }
        let half = 0.5 * (case.bright + case.dark);
        let picture = case.picture();
        let bright = picture.mapv(|level| (level >= half) == (case.bright > case.dark));
        let [width, height] = case.size;
        let truth = filled(&[case.truth()], (height, width));
        // a pixel whose center is within half a pixel of the outline may fall to either side
        let (curve, rings) = (case.truth(), border(&bright));
        for ((y, x), here) in bright.indexed_iter() {
            let p = DVec2::new(x as f64, y as f64);
            if *here != truth[[y, x]] {
                let far = outline::distance(&curve, true, p);
                // at a corner, and at a thin end, blur takes more
                let most = if matches!(case.shape, Shape::Polygon(_)) || case.name == "ellipse_thin"
                {
                    1.5
                } else {
                    0.5
                };
                assert!(far <= most, "{}: {p} {far}", case.name);
            }
        }
        assert_eq!(rings.len(), 1, "{}", case.name);
    }
}

#[test]
fn noise_has_its_deviation_and_its_seed() {
    let flat = |seed: u64| Case {
        bright: 128.0,
        dark: 128.0,
        noise: 20.0,
        seed,
        ..Case::default()
    };
    let picture = flat(3).picture();
    let count = picture.len() as f64;
    let mean = picture.sum() / count;
    let spread = (picture.mapv(|v| (v - mean).powi(2)).sum() / count).sqrt();
    // four standard errors of 40 000 pixels; rounding adds 1/12 to the variance
    assert!(
        (mean - 128.0).abs() < 0.4 && (spread - 20.0).abs() < 0.3,
        "{mean} {spread}"
    );
    assert_eq!(picture, flat(3).picture());
    assert_ne!(picture, flat(4).picture());
    let salted = Case {
        noise: 0.0,
        salt_and_pepper: 0.1,
        ..flat(7)
    }
    .picture();
    let share = |v: f64| salted.iter().filter(|p| **p == v).count() as f64 / count;
    assert!((share(0.0) - 0.05).abs() < 0.005 && (share(255.0) - 0.05).abs() < 0.005);
}

#[test]
fn numbers_are_those_of_splitmix64() {
    // the first three of the generator's reference sequence from 0 are of 0, 1 and 2 steps of its constant
    let first = 0xE220_A839_7B1D_CDAF_u64;
    assert_eq!(
        field::drawn::uniform(0, 0),
        (first >> 11) as f64 / 2.0_f64.powi(53)
    );
}

#[test]
fn the_blur_of_a_step_is_the_sum_of_its_weights() {
    let step = Grid::from_shape_fn((3, 21), |(_, x)| if x >= 10 { 1.0 } else { 0.0 });
    let got = blurred(&step, 1.0);
    let weight = |k: i32| (-0.5 * f64::from(k * k)).exp();
    let sum: f64 = (-4..=4).map(weight).sum();
    for x in 0..21_i32 {
        let exact: f64 = (-4..=4).filter(|k| x + k >= 10).map(weight).sum::<f64>() / sum;
        assert!((got[[1, x as usize]] - exact).abs() < 1e-15, "{x}");
    }
}
