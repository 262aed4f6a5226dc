//! Edge forces computed where a curve goes: how near they are to whole ones, and when they are refused.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(clippy::float_cmp, reason = "a test: equal means equal")]

use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use field::{EdgeForce, Grid, Smoothing};
use glam::DVec2;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb};
use io::Picture;
use scene::fit::force::{Edge, ImageForceKind};
use scene::fit::{Contour, FitError, Image, OptionKey, Options, Prepared};
use scene::snake::ImageForce;
use scene::{Computing, ForceChoice, Scene};

const SIZE: (u32, u32) = (300, 200);

/// A disc with a slanting light over it, from 0 to 1.
fn level(x: u32, y: u32) -> f64 {
    let r = (f64::from(x) - 150.0).hypot(f64::from(y) - 100.0);
    let disc = 1.0 / (1.0 + (r - 40.0).exp());
    0.1 + 0.6 * disc + 0.0007 * f64::from(x + y)
}

fn picture(image: &DynamicImage) -> Picture {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).unwrap();
    Picture::decode(&bytes.into_inner()).unwrap()
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "levels lie between 0 and 1"
)]
fn pictures() -> [(&'static str, Picture); 4] {
    let (width, height) = SIZE;
    let bytes = ImageBuffer::from_fn(width, height, |x, y| Luma([(255.0 * level(x, y)) as u8]));
    let words = ImageBuffer::from_fn(width, height, |x, y| Luma([(65535.0 * level(x, y)) as u16]));
    let colors = ImageBuffer::from_fn(width, height, |x, y| {
        Rgb([1.0, 0.5, 0.8].map(|c| (255.0 * c * level(x, y)) as u8))
    });
    let levels = Grid::from_shape_fn((height as usize, width as usize), |(y, x)| {
        255.0 * level(x as u32, y as u32)
    });
    [
        ("8 bits", picture(&DynamicImage::ImageLuma8(bytes))),
        ("16 bits", picture(&DynamicImage::ImageLuma16(words))),
        ("colors", picture(&DynamicImage::ImageRgb8(colors))),
        ("doubles", Picture::from_levels(levels)),
    ]
}

fn prepared(picture: &Picture, options: &Options) -> Result<Prepared, FitError> {
    Prepared::of(&Image::of(Arc::new(picture.clone())), options)
}

fn usual(computing: Computing, sigma: f64) -> Options {
    Options {
        computing,
        sigma,
        ..Options::motion()
    }
}

#[test]
fn a_lazy_field_is_within_its_bound_of_the_whole_one_whatever_the_pixels() {
    for (what, picture) in pictures() {
        for sigma in [1.0, 10.0_f64.sqrt(), 8.0] {
            let made = |computing| prepared(&picture, &usual(computing, sigma)).unwrap();
            let (lazy, whole) = (made(Computing::Lazy), made(Computing::Whole));
            let (lazy, whole) = (lazy.field().unwrap(), whole.field().unwrap());
            assert!(lazy.tiles_computed().is_some() && whole.tiles_computed().is_none());
            // the gain of a fit: 6 on 120 levels; contrasts here are above 100
            let bound = 1e-6 * 6.0 * 120.0 / 100.0 * 255.0;
            let mut worst = 0.0_f64;
            for (x, y) in (0..200).flat_map(|y| (0..300).map(move |x| (x, y))) {
                let off = lazy.pixel(x, y).unwrap() - whole.pixel(x, y).unwrap();
                worst = worst.max(off.abs().max_element());
            }
            assert!(worst > 0.0 && worst < bound, "{what}, {sigma}: {worst}");
        }
    }
}

#[test]
fn a_lazy_fit_ends_where_a_whole_one_does_and_looks_at_a_few_tiles() {
    let around = Contour::circle(DVec2::new(147.0, 102.0), 44.0);
    for (what, picture) in pictures() {
        let run = |computing| {
            let prepared = prepared(&picture, &usual(computing, 3.0)).unwrap();
            let end = prepared.fit(&around).unwrap().contour.points;
            (end, prepared.field().unwrap().tiles_computed())
        };
        let ((lazy, tiles), (whole, none)) = (run(Computing::Auto), run(Computing::Whole));
        assert!(matches!(tiles, Some(1..=6)) && none.is_none(), "{tiles:?}");
        // forces differ by 1e-4 of the pull, which turns round within 3 pixels; a stop a step earlier or later adds some
        let off = lazy.iter().zip(&whole).map(|(a, b)| a.distance(*b));
        let off = off.fold(0.0, f64::max);
        assert!(off < 3e-3, "{what}: {off}");
        // and it is the disc's edge, with the light's slant
        for p in &lazy {
            let r = p.distance(DVec2::new(150.0, 100.0));
            assert!((r - 40.0).abs() < 0.5, "{what}: {r}");
        }
    }
}

#[test]
fn the_contrast_of_kept_pixels_is_that_of_their_levels() {
    for (what, picture) in pictures() {
        let (levels, kept) = (Picture::from_levels(picture.levels().clone()), picture);
        let largest = |picture: &Picture| {
            let prepared = prepared(picture, &usual(Computing::Whole, 3.0)).unwrap();
            prepared.field().unwrap().largest()
        };
        // the gain is made of it
        assert_eq!(largest(&levels), largest(&kept), "{what}");
        assert_eq!(kept.size(), (300, 200));
        assert_eq!(kept.display().dimensions(), SIZE);
    }
}

#[test]
fn lazy_is_refused_by_name_where_it_will_not_do_and_left_alone_otherwise() {
    let [(_, picture), ..] = pictures();
    let mask = Picture::from_levels(Grid::from_shape_fn((200, 300), |(_, x)| x as f64));
    let masked = picture.clone().with_mask(&mask).unwrap();
    // a tenth of a level on a ground of 200
    let faint = Picture::from_levels(picture.levels().mapv(|v| 200.0 + v / 1500.0));
    for (picture, sigma, says) in [
        (&masked, 3.0, "do not count"),
        (&faint, 3.0, "contrast"),
        (&picture, 30.0, "18"),
    ] {
        let error = prepared(picture, &usual(Computing::Lazy, sigma)).unwrap_err();
        assert_eq!(error.key, OptionKey::Computing);
        assert!(error.to_string().contains(says), "{error}");
        let made = prepared(picture, &usual(Computing::Auto, sigma)).unwrap();
        assert_eq!(made.field().unwrap().tiles_computed(), None);
    }
    // the same for an edge force by its kind
    let forces = vec![ForceChoice::parse("edge").unwrap().for_fit()];
    let by_kind = Options {
        forces,
        ..usual(Computing::Auto, 3.0)
    };
    let prepared = prepared(&picture, &by_kind).unwrap();
    let kind = ImageForceKind::Edge(Edge::default());
    let made = prepared.sight().unwrap().forces(&kind).unwrap();
    let field = made[0].downcast::<ImageForce>().unwrap();
    assert!(field.field().tiles_computed().is_some());
}

#[test]
fn a_scene_says_how_its_field_is_computed() {
    let scene = |lines: &str| {
        let text = format!(
            "title = \"t\"\n{lines}\n[picture.drawn]\nsize = [64, 40]\nregion = {{ right-of = 31.5 }}\n\
             [snake]\nnodes = 5\ntopology = \"open\"\n\
             start = {{ segment = {{ from = [20.0, 10.0], to = [20.0, 30.0] }} }}\n\
             [material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
             [densities]\nmass = 1.0\ndamping = 1.0\n[run]\ndt = 0.01\nsteps = 1\n"
        );
        Scene::parse("t", &text, Path::new("."))
    };
    let tiles = |lines: &str| scene(lines).unwrap().field.unwrap().tiles_computed();
    assert_eq!(tiles(""), None);
    assert_eq!(tiles("[field]\ncomputed = \"whole\""), None);
    assert!(tiles("[field]\ncomputed = \"lazy\"").is_some());
    for (lines, says) in [
        ("[field]\ncomputed = \"lasy\"", "lazy"),
        (
            "[field]\ncomputed = \"lazy\"\nsigma = 20.0",
            "field.computed",
        ),
        (
            "rules = \"report\"\n[field]\ncomputed = \"lazy\"",
            "field.computed",
        ),
        ("[field]\ncomputed = \"lazy\"\nsigma = -1.0", "field.sigma"),
    ] {
        let error = scene(lines).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    // twenty passes are a Gaussian's width
    let field = scene("[field]\ncomputed = \"lazy\"")
        .unwrap()
        .field
        .unwrap();
    let picture = scene("").unwrap().picture.unwrap();
    let rule = EdgeForce {
        smoothing: Smoothing::Binomial(20),
        ..EdgeForce::as_strong_as_the_report()
    };
    let whole = field::edge_force(picture.levels(), &rule).unwrap();
    let at = DVec2::new(29.3, 20.0);
    // 5e-7 of gain times level
    assert!((field.at(at) - whole.at(at)).length() < 5e-7 * 6.0 * 255.0);
}

#[test]
fn from_coarse_to_fine_a_fit_arrives_from_where_one_scale_does_not() {
    let [(_, picture), ..] = pictures();
    // 40 pixels is the disc; the edge force reaches about ten
    let far = Contour::circle(DVec2::new(140.0, 104.0), 66.0);
    let end = |forces: &[&str]| {
        let forces = forces
            .iter()
            .map(|f| ForceChoice::parse(f).unwrap().for_fit());
        let options = Options {
            forces: forces.collect(),
            tension: 5.0,
            rigidity: 20.0,
            ..Options::motion()
        };
        let found = prepared(&picture, &options).unwrap().fit(&far).unwrap();
        let off = |p: &DVec2| (p.distance(DVec2::new(150.0, 100.0)) - 40.0).abs();
        let nodes = found.contour.points.iter();
        let fit::Choices::Motion(moved) = &found.chosen else {
            panic!("a motion was asked for")
        };
        let time = found.steps as f64 * moved.step;
        (nodes.map(off).fold(0.0, f64::max), time)
    };
    let ((one, _), (all, t)) = (end(&[]), end(&["coarse-to-fine"]));
    assert!(one > 10.0 && all < 0.5, "{one}, {all}");
    // rest is looked for after the last scale has come in
    assert!(t >= 30.0, "{t}");
}

#[test]
fn a_schedule_of_scales_is_one_force_a_scale_and_refused_by_its_keys() {
    let scene = |lines: &str| {
        let text = format!(
            "title = \"t\"\n[picture.drawn]\nsize = [64, 40]\nregion = {{ right-of = 31.5 }}\n\
             [[force]]\nkind = \"coarse-to-fine\"\n{lines}\n\
             [snake]\nnodes = 5\ntopology = \"open\"\n\
             start = {{ segment = {{ from = [20.0, 10.0], to = [20.0, 30.0] }} }}\n\
             [material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
             [densities]\nmass = 1.0\ndamping = 1.0\n[run]\ndt = 0.01\nsteps = 1\n"
        );
        Scene::parse("t", &text, Path::new("."))
    };
    let names = |lines: &str| {
        let world = scene(lines).unwrap();
        let names = world.snake.world().names().map(str::to_owned);
        names.collect::<Vec<_>>()
    };
    let usual = ["", "-2", "-3", "-4"].map(|n| format!("coarse-to-fine{n}"));
    assert_eq!(names("")[..4], usual);
    assert_eq!(
        names("sigmas = [6.0, 3.0]\nname = \"far\"")[..2],
        ["far", "far-2"]
    );
    assert_eq!(names("sigmas = [6.0]")[..1], ["coarse-to-fine"]);
    for (lines, says) in [
        ("sigmas = []", "sigmas"),
        ("sigmas = [2.0, 4.0]", "must fall"),
        ("sigmas = [2.0, -4.0]", "sigma"),
        ("hold = 0.0", "hold"),
        ("blur = -1.0", "blur"),
        ("strength = 0.0", "strength"),
        ("schedule = [[0.0, 1.0], [1.0, 0.0]]", "one of its own"),
    ] {
        let error = scene(lines).unwrap_err().to_string();
        assert!(error.contains(says), "{lines}: {error}");
    }
}
