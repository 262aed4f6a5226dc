//! Fast fields against slow ones.
//! Long because every way through the tiles is held against the same slow sums.

use super::*;
use crate::{Grid, Interpolation, edge_force, report_force};
use glam::{DMat2, DVec2};
use ndarray::s;
use proptest::prelude::*;

const REPORT: Recipe = Recipe::Report {
    passes: 20,
    scale: 0.15,
    gain: 10.0,
};
const EDGE: Recipe = Recipe::Edge(EdgeForce {
    smoothing: Smoothing::Binomial(20),
    gain: 6.0,
});

/// The `f64` pipeline.
fn slow_force<P: Pixel>(
    image: ArrayView2<'_, P>,
    recipe: &Recipe,
) -> Result<ForceField, FieldError> {
    let image: Grid = image.mapv(|pixel| f64::from(pixel.level()));
    match recipe {
        Recipe::Report {
            passes,
            scale,
            gain,
        } => report_force(&image, *passes, *scale, *gain),
        Recipe::Edge(rule) => edge_force(&image, rule),
    }
}

/// Pixels without any pattern a filter could profit from.
fn noise(height: usize, width: usize) -> Array2<u8> {
    let mut state = 0x9e37_79b9_u32;
    Array2::from_shape_simple_fn((height, width), || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    })
}

/// Largest difference of a component to the `f64` pipeline, over gain · scale · largest pixel.
fn error(image: &Array2<u8>, recipe: Recipe) -> f64 {
    let fast = fast_force(image.view(), &recipe, 1).unwrap();
    let slow = slow_force(image.view(), &recipe).unwrap();
    let factor = match recipe {
        Recipe::Report { scale, gain, .. } => scale * gain,
        Recipe::Edge(rule) => rule.gain,
    };
    assert_eq!((fast.width(), fast.height()), (slow.width(), slow.height()));
    let ((fx, fy), (sx, sy)) = (fast.components(), slow.components());
    let largest = |a: &Grid, b: &Grid| {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    let pixel = image.iter().copied().fold(1, u8::max);
    largest(&fx, &sx).max(largest(&fy, &sy)) / (factor * f64::from(pixel))
}

/// The documented bound.
const BOUND: f64 = 5e-7;

#[test]
fn shapes_of_every_kind_agree_with_the_slow_twin() {
    let shapes = [
        (1, 1),
        (1, 300),
        (300, 1),
        (3, 3),
        (2, 5),
        (130, 17),
        (65, 253),
        (258, 505),
        (600, 3),
    ];
    for (height, width) in shapes {
        for recipe in [REPORT, EDGE] {
            let error = error(&noise(height, width), recipe);
            assert!(error < BOUND, "{height} × {width}, {recipe:?}: {error:e}");
        }
    }
}

#[test]
fn hard_edges_agree_with_the_slow_twin() {
    let image = Array2::from_shape_fn(
        (150, 290),
        |(y, x)| if (x / 40 + y / 30) % 2 == 0 { 255 } else { 0 },
    );
    for recipe in [REPORT, EDGE] {
        let error = error(&image, recipe);
        assert!(error < BOUND, "{recipe:?}: {error:e}");
    }
}

#[test]
fn every_smoothing_agrees_with_the_slow_twin() {
    let image = noise(90, 140);
    for passes in [0, 1, 2, 5, 40, 150, 600, 800, 3000] {
        let rule = EdgeForce {
            smoothing: Smoothing::Binomial(passes),
            gain: 1.0,
        };
        for recipe in [
            Recipe::Report {
                passes,
                scale: 1.0,
                gain: 1.0,
            },
            Recipe::Edge(rule),
        ] {
            let error = error(&image, recipe);
            assert!(error < BOUND, "{recipe:?}: {error:e}");
        }
    }
    for sigma in [0.2, 0.7, 1.5, 4.0, 17.0, 19.0, 40.0, 300.0] {
        let rule = EdgeForce {
            smoothing: Smoothing::Gaussian(sigma),
            gain: 1.0,
        };
        let error = error(&image, Recipe::Edge(rule));
        assert!(error < BOUND, "{sigma}: {error:e}");
    }
}

#[test]
fn pictures_of_every_shape_may_be_smoothed_widely() {
    for (height, width) in [(1, 1), (1, 70), (70, 1), (3, 3), (3, 2000)] {
        let rule = EdgeForce {
            smoothing: Smoothing::Gaussian(25.0),
            gain: 1.0,
        };
        for recipe in [
            Recipe::Edge(rule),
            Recipe::Report {
                passes: 1250,
                scale: 0.15,
                gain: 10.0,
            },
        ] {
            let error = error(&noise(height, width), recipe);
            assert!(error < BOUND, "{height} × {width}, {recipe:?}: {error:e}");
            let flat = Array2::from_elem((height, width), 0.1_f32);
            assert!(fast_force(flat.view(), &recipe, 1).unwrap().largest() <= 0.0);
        }
    }
}

#[test]
fn eight_and_sixteen_bits_and_floats_give_the_same_bytes() {
    let image = noise(140, 270);
    for recipe in [REPORT, EDGE] {
        let bytes = fast_force(image.view(), &recipe, 1).unwrap();
        let words = fast_force(image.mapv(u16::from).view(), &recipe, 1).unwrap();
        let floats = fast_force(image.mapv(f32::from).view(), &recipe, 1).unwrap();
        assert!(bytes == words && bytes == floats);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let image = noise(700, 300);
    for recipe in [REPORT, EDGE] {
        let alone = fast_force(image.view(), &recipe, 0).unwrap();
        for threads in [1, 2, 3, 8, 100] {
            assert!(
                fast_force(image.view(), &recipe, threads).unwrap() == alone,
                "{threads}"
            );
        }
    }
}

#[test]
fn every_kind_of_processor_gives_the_same_bytes() {
    let image = noise(50, 150);
    for recipe in [REPORT, EDGE] {
        let plan = Plan::new(&recipe).unwrap();
        let place = Place {
            x: 0,
            y: 0,
            width: 150,
            height: 50,
        };
        let run = |how: &dyn Fn(Job<'_, u8>)| {
            let mut out = vec![[0.0; 2]; 150 * 50];
            let scratch = &mut Scratch::default();
            how(Job {
                plan: &plan,
                image: image.view(),
                place,
                scratch,
                out: &mut out,
                out_stride: 150,
                many: false,
            });
            out
        };
        let scalar = run(&|job| {
            pulp::WithSimd::with_simd(job, pulp::Scalar);
        });
        assert!(
            scalar
                == run(&|job| {
                    pulp::Arch::new().dispatch(job);
                })
        );
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            assert!(
                scalar
                    == run(&|job| {
                        pulp::Simd::vectorize(avx2, job);
                    })
            );
        }
    }
}

#[test]
fn forces_written_past_the_cache_are_those_written_through_it() {
    let image = noise(70, 150);
    let plan = Plan::new(&REPORT).unwrap();
    // rows that begin anywhere within a line of the cache
    for (x, out_stride) in [(0, 150), (7, 143), (13, 151)] {
        let place = Place {
            x,
            y: 3,
            width: 140 - x,
            height: 60,
        };
        let [through, past] = [false, true].map(|many| {
            let mut out = vec![[0.0; 2]; out_stride * 60];
            lanes::registers().dispatch(Job {
                plan: &plan,
                image: image.view(),
                place,
                scratch: &mut Scratch::default(),
                out: &mut out,
                out_stride,
                many,
            });
            out
        });
        assert!(through == past, "{x}");
        assert!(through.iter().any(|f| f[0].abs() > 0.1));
    }
}

#[test]
fn views_with_gaps_are_pictures_too() {
    let image = noise(40, 120);
    let every_third = image.slice(s![.., ..;3]);
    for recipe in [REPORT, EDGE] {
        let by_view = fast_force(every_third, &recipe, 1).unwrap();
        assert!(by_view == fast_force(every_third.to_owned().view(), &recipe, 1).unwrap());
    }
}

#[test]
fn memory_is_used_again_and_leaves_no_trace() {
    let mut fast = FastForce::new(EDGE, 2).unwrap();
    let (large, small) = (noise(300, 400), noise(20, 31));
    let mut field = fast.field(large.view()).unwrap();
    for image in [&small, &large, &small] {
        fast.field_into(image.view(), &mut field).unwrap();
        assert!(field == fast_force(image.view(), &EDGE, 1).unwrap());
    }
}

#[test]
fn a_constant_picture_has_no_force_at_all() {
    for value in [0.0_f32, 0.1, 255.0, -3e7] {
        let image = Array2::from_elem((70, 300), value);
        for recipe in [REPORT, EDGE] {
            let field = fast_force(image.view(), &recipe, 2).unwrap();
            assert!(field.largest() <= 0.0, "{value}, {recipe:?}");
        }
    }
}

#[test]
fn bad_pixels_are_named_by_their_first_position() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38] {
        let mut image = noise(300, 500).mapv(f32::from);
        (image[[290, 3]], image[[17, 400]]) = (f32::NAN, bad);
        for recipe in [REPORT, EDGE] {
            match fast_force(image.view(), &recipe, 2) {
                Err(FieldError::NotFinite {
                    column: 400,
                    row: 17,
                    ..
                }) => assert!(!bad.is_finite()),
                Err(FieldError::TooLarge {
                    column: 400,
                    row: 17,
                    ..
                }) => assert!(bad.is_finite()),
                other => panic!("{:?}", other.err()),
            }
        }
    }
    let empty = Array2::<u8>::zeros((0, 7));
    assert!(matches!(
        fast_force(empty.view(), &REPORT, 1),
        Err(FieldError::Empty { .. })
    ));
    assert!(matches!(
        lazy_force(empty, &REPORT),
        Err(FieldError::Empty { .. })
    ));
    let recipe = Recipe::Report {
        passes: 20,
        scale: -1.0,
        gain: 10.0,
    };
    assert!(matches!(
        FastForce::new(recipe, 1),
        Err(FieldError::NotPositive { name: "scale", .. })
    ));
}

#[test]
fn a_field_larger_than_any_memory_is_refused_with_the_figure() {
    // one pixel seen everywhere: the picture takes no memory, its field would take 2^51 bytes
    let pixel = Array2::from_elem((1, 1), 7_u8);
    let image = pixel.broadcast((1 << 18, 1 << 30)).unwrap();
    let refused = fast_force(image, &EDGE, 1).unwrap_err();
    assert!(matches!(refused, FieldError::NoMemory { bytes, .. } if bytes == 1 << 51));
    assert!(refused.to_string().contains(&(1_u64 << 51).to_string()));
}

#[test]
fn long_and_thin_pictures_agree_with_the_slow_twin() {
    for (height, width) in [(20_000, 3), (3, 20_000)] {
        for recipe in [REPORT, EDGE] {
            let error = error(&noise(height, width), recipe);
            assert!(error < BOUND, "{height} × {width}, {recipe:?}: {error:e}");
        }
    }
    let image = noise(100_000, 3);
    let field = fast_force(image.view(), &EDGE, 2).unwrap();
    assert!(field == fast_force(image.view(), &EDGE, 1).unwrap());
}

#[test]
fn a_lazy_field_is_the_whole_field_where_it_is_looked_at_and_nothing_elsewhere() {
    let image = noise(400, 900);
    for recipe in [REPORT, EDGE] {
        let whole = fast_force(image.view(), &recipe, 1).unwrap();
        let lazy = lazy_force(image.clone(), &recipe).unwrap();
        assert_eq!(lazy.tiles_computed(), Some(0));
        for (x, y) in [(450.3, 200.7), (451.0, 190.2), (460.9, 210.1)] {
            assert_eq!(lazy.at(DVec2::new(x, y)), whole.at(DVec2::new(x, y)));
        }
        let computed = lazy.tiles_computed().unwrap();
        assert!((1..=4).contains(&computed), "{computed} tiles");
        assert!(lazy == whole);
        assert!(lazy.clone().scaled(2.0) == whole.clone().scaled(2.0));
        assert_eq!(lazy.tiles_computed(), Some(8 * 7));
    }
    let wide = Recipe::Edge(EdgeForce {
        smoothing: Smoothing::Gaussian(50.0),
        gain: 1.0,
    });
    assert!(matches!(
        lazy_force(image, &wide),
        Err(FieldError::TooMuch { .. })
    ));
}

#[test]
fn points_across_many_tiles_have_the_digits_of_the_whole_field_by_both_rules() {
    let image = noise(200, 300);
    let whole = fast_force(image.view(), &EDGE, 1).unwrap();
    // to and fro over the borders of tiles and of the picture
    let points: Vec<DVec2> = (0..700_u32)
        .map(|i| {
            let (a, b) = (f64::from(i * 37 % 613), f64::from(i * 61 % 409));
            DVec2::new(a * 0.5 - 3.0, b * 0.5 - 2.0)
        })
        .collect();
    let n = points.len();
    for rule in [Interpolation::Bilinear, Interpolation::Bicubic] {
        let lazy = lazy_force(image.to_shared(), &EDGE).unwrap();
        let [mut a, mut b] = [vec![DVec2::ZERO; n], vec![DVec2::ONE; n]];
        let [mut c, mut d] = [vec![DMat2::ZERO; n], vec![DMat2::IDENTITY; n]];
        lazy.sample_into(&points, rule, &mut a);
        whole.sample_into(&points, rule, &mut b);
        assert_eq!(a, b);
        lazy.sample_with_slope_into(&points, rule, &mut a, &mut c);
        whole.sample_with_slope_into(&points, rule, &mut b, &mut d);
        assert_eq!(a, b);
        assert_eq!(c, d);
    }
}

#[test]
fn a_lazy_field_is_nan_where_a_bad_pixel_reaches_and_fine_elsewhere() {
    let mut image = noise(400, 900).mapv(f32::from);
    image[[200, 450]] = f32::NAN;
    let lazy = lazy_force(image, &EDGE).unwrap();
    assert!(lazy.at(DVec2::new(452.0, 203.0)).is_nan());
    assert!(lazy.at(DVec2::new(800.0, 20.0)).is_finite());
}

proptest! {
    #[test]
    fn small_pictures_agree_with_the_slow_twin(
        (height, width) in (1_usize..40, 1_usize..40), passes in 0_u32..60, seed in 0_u8..=255,
    ) {
        let image = noise(height, width).mapv(|v| v.wrapping_mul(seed | 1));
        let rule = EdgeForce { smoothing: Smoothing::Binomial(passes), gain: 2.0 };
        for recipe in [Recipe::Report { passes, scale: 0.15, gain: 10.0 }, Recipe::Edge(rule)] {
            let error = error(&image, recipe);
            prop_assert!(error < BOUND, "{:?}: {:e}", recipe, error);
        }
    }
}
