//! Forces by their kind: in units a person can set, refused by their key, on what counts.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(clippy::float_cmp, reason = "a test: equal means equal")]

use std::io::Cursor;
use std::path::Path;

use glam::DVec2;
use image::{DynamicImage, ImageFormat, RgbImage};
use scene::snake::{Curve, ImageForce, World};
use scene::{Picture, Scene};

/// A picture bright from x = 32 on, with these lines after its table.
fn text(foreground: f64, lines: &str) -> String {
    format!(
        "title = \"t\"\n[picture.drawn]\nsize = [64, 40]\nregion = {{ right-of = 31.5 }}\n\
         background = 20.0\nforeground = {foreground}\n{lines}\n[snake]\nnodes = 5\ntopology = \"open\"\n\
         start = {{ segment = {{ from = [20.0, 10.0], to = [20.0, 30.0] }} }}\n\
         [material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
         [densities]\nmass = 1.0\ndamping = 1.0\n[run]\ndt = 0.01\nsteps = 1\n"
    )
}

fn scene(foreground: f64, lines: &str) -> Scene {
    Scene::parse("t", &text(foreground, lines), Path::new(".")).unwrap()
}

fn refused(lines: &str, says: &[&str]) {
    let error = Scene::parse("t", &text(200.0, lines), Path::new("."))
        .unwrap_err()
        .to_string();
    for part in says {
        assert!(error.contains(part), "{error}");
    }
    assert_eq!(error.lines().count(), 1, "{error}");
}

/// The sum of all forces of a world at a point.
fn force(world: &World, at: DVec2) -> DVec2 {
    let mut sum = [DVec2::ZERO];
    let curve = Curve {
        t: 0.0,
        x: &[at],
        v: &[DVec2::ZERO],
        mass: &[1.0],
        closed: false,
        spacing: 1.0,
    };
    for acting in &world.forces {
        acting.clone().add(&curve, &mut sum).unwrap();
    }
    sum[0]
}

/// The strongest pull on a row across the edge.
fn strongest(scene: &Scene) -> f64 {
    (0..64)
        .map(|x| force(scene.snake.world(), DVec2::new(f64::from(x), 20.0)).length())
        .fold(0.0, f64::max)
}

#[test]
fn strength_one_is_one_pull_for_every_kind_and_exposure_and_sigma() {
    let pull = 72.0 * 0.241_970_724_519;
    for (keys, within) in [
        // pixels and stencils flatten a peak of this width
        ("kind = \"edge\"", 0.08),
        ("kind = \"edge\"\nsigma = 6.0", 0.03),
        ("kind = \"color-edge\"", 0.08),
        ("kind = \"scales\"\nsigmas = [4.0]", 0.05),
        ("kind = \"line\"\nsigma = 4.0", 0.05),
        ("kind = \"distance\"", 0.01),
        // the knee takes off what is weaker than the strongest
        ("kind = \"gvf\"", 0.05),
        ("kind = \"vfc\"", 0.05),
    ] {
        for foreground in [40.0, 250.0] {
            let one = strongest(&scene(foreground, &format!("[[force]]\n{keys}")));
            let share = one / pull;
            assert!(
                (share - 1.0).abs() < within,
                "{keys}, {foreground}: {share}"
            );
            let half = strongest(&scene(
                foreground,
                &format!("[[force]]\n{keys}\nweight = 0.5"),
            ));
            assert!((half / one - 0.5).abs() < 1e-12, "{keys}");
        }
    }
}

#[test]
fn every_kind_pulls_towards_the_edge_and_the_far_ones_from_afar() {
    for (kind, from) in [
        ("edge", 26.0),
        ("color-edge", 26.0),
        ("scales", 20.0),
        ("distance", 3.0),
        ("gvf", 3.0),
        ("vfc", 3.0),
    ] {
        let scene = scene(200.0, &format!("[[force]]\nkind = \"{kind}\""));
        let [left, right] =
            [from, 63.0 - from].map(|x| force(scene.snake.world(), DVec2::new(x, 20.0)));
        assert!(left.x > 0.5 && right.x < -0.5, "{kind}: {left} {right}");
        assert!(
            left.y.abs() < 0.02 * left.x && right.y.abs() < 0.02 * left.x,
            "{kind}: {left} {right}"
        );
    }
}

#[test]
fn the_usual_field_acts_where_it_is_written_or_nobody_else_looks() {
    let names = |lines: &str| {
        let scene = scene(200.0, lines);
        scene
            .snake
            .world()
            .names()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let gravity = "[[force]]\nkind = \"gravity\"\nacceleration = [0.0, 1.0]";
    assert_eq!(names(""), ["image"]);
    assert_eq!(names(gravity), ["image", "gravity"]);
    assert_eq!(names("[[force]]\nkind = \"gvf\""), ["gvf"]);
    assert_eq!(
        names("[field]\nsigma = 2.0\n[[force]]\nkind = \"gvf\"\n[[force]]\nkind = \"gvf\""),
        ["image", "gvf", "gvf-2"]
    );
    assert_eq!(
        names("[[force]]\nkind = \"edge\"\nname = \"fine\"\n[[force]]\nkind = \"edge\""),
        ["fine", "edge"]
    );
}

#[test]
fn what_will_not_do_is_refused_by_its_key() {
    let second = |keys: &str| {
        format!("[[force]]\nkind = \"gravity\"\nacceleration = [0.0, 0.0]\n[[force]]\n{keys}")
    };
    for (keys, says) in [
        ("sigma = 2.0", &["force 1: missing", "kind"][..]),
        ("kind = 3", &["kind", "word"]),
        (
            "kind = \"egde\"",
            &["force 1: unknown word \"egde\"", "did you mean \"edge\""],
        ),
        (
            "kind = \"edge\"\nsgma = 2.0",
            &["unknown key \"sgma\"", "\"sigma\""],
        ),
        (
            "kind = \"edge\"\nweigth = 2.0",
            &["unknown key", "\"weight\""],
        ),
        ("kind = \"edge\"\nsigma = \"wide\"", &["wide"]),
        (
            "kind = \"edge\"\nsigma = 0.0",
            &["force 1: sigma", "above 0"],
        ),
        (
            "kind = \"edge\"\nstrength = -1.0",
            &["force 1: strength", "above 0"],
        ),
        ("kind = \"edge\"\nweight = -1.0", &["force 1: weight", "-1"]),
        (
            "kind = \"edge\"\nweight = [1.0]",
            &["force 1: weight", "5 nodes"],
        ),
        (
            "kind = \"edge\"\nschedule = []",
            &["force 1: schedule", "no entry"],
        ),
        (
            "kind = \"edge\"\nname = \"a b\"",
            &["force 1: name", "letters"],
        ),
        (
            "kind = \"edge\"\nname = \"tension\"",
            &["force 1: name", "taken"],
        ),
        (
            "kind = \"scales\"\nsigmas = []",
            &["force 1: sigmas", "1 to 32"],
        ),
        (
            "kind = \"scales\"\nsigmas = [2.0, -1.0]",
            &["force 1: sigmas"],
        ),
        (
            "kind = \"line\"\nshade = \"grey\"",
            &["unknown word \"grey\"", "bright"],
        ),
        ("kind = \"termination\"\nfloor = 0.0", &["force 1: floor"]),
        ("kind = \"distance\"\nreach = nan", &["force 1: reach"]),
        (
            "kind = \"gvf\"\nspread = 0.1\nsmoothness = 0.1",
            &["force 1: spread", "not both"],
        ),
        ("kind = \"vfc\"\nwidth = 0.0", &["force 1: width"]),
        (
            "kind = \"vfc\"\nwidth = 3.0\nexponent = 2.0",
            &["force 1: width", "not both"],
        ),
        ("kind = \"gravity\"", &["acceleration"]),
        (
            "kind = \"gravity\"\nacceleration = [inf, 0.0]",
            &["force 1: acceleration"],
        ),
    ] {
        refused(&second(keys), says);
    }
    let blind = text(200.0, "[[force]]\nkind = \"gvf\"");
    let (head, rest) = blind.split_once("[picture.drawn]").unwrap();
    let blind = format!("{head}{}", &rest[rest.find("[[force]]").unwrap()..]);
    let error = Scene::parse("t", &blind, Path::new("."))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("force 0: kind") && error.contains("there is none"),
        "{error}"
    );
}

#[test]
fn edges_between_colors_of_equal_grey_pull_only_in_color() {
    let folder = tempfile::tempdir().unwrap();
    // 0.299 · 139 − 0.587 · 91 + 0.114 · 104 = 0
    let image = RgbImage::from_fn(64, 40, |x, _| {
        image::Rgb(if x < 32 {
            [10, 140, 20]
        } else {
            [149, 49, 124]
        })
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(image)
        .write_to(&mut bytes, ImageFormat::Png)
        .unwrap();
    std::fs::write(folder.path().join("a.png"), bytes.into_inner()).unwrap();
    let picture = Picture::load(&folder.path().join("a.png")).unwrap();
    assert!(picture.is_color() && picture.channels().len() == 3);
    assert_eq!(picture.channels()[0][[3, 3]], 10.0);
    let at = DVec2::new(28.0, 20.0);
    let pulls = |kind: &str| {
        let text = text(0.0, &format!("[[force]]\nkind = \"{kind}\""));
        let (head, rest) = text.split_once("[picture.drawn]").unwrap();
        let rest = &rest[rest.find("[[force]]").unwrap()..];
        let text = format!("{head}[picture]\nfile = \"a.png\"\n{rest}");
        let scene = Scene::parse("t", &text, folder.path()).unwrap();
        let [acting] = &scene.snake.world().forces[..] else {
            unreachable!("one force");
        };
        let field = acting.downcast::<ImageForce>().unwrap().field().clone();
        (field.at(at).x, scene.notes)
    };
    let ((grey, notes), (color, _)) = (pulls("edge"), pulls("color-edge"));
    assert!(color > 10.0, "{color}");
    // rounding of the grey levels at most
    assert!(grey.abs() < 1e-10, "{grey}");
    assert!(notes[0].contains("only forces in color"), "{notes:?}");
}

#[test]
fn pixels_that_do_not_count_exert_no_force() {
    let folder = tempfile::tempdir().unwrap();
    let mask = |name: &str, size: (u32, u32), from: u32| {
        let image = RgbImage::from_fn(size.0, size.1, |x, _| {
            image::Rgb(if x < from { [255; 3] } else { [0; 3] })
        });
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::ImageRgb8(image)
            .write_to(&mut bytes, ImageFormat::Png)
            .unwrap();
        std::fs::write(folder.path().join(name), bytes.into_inner()).unwrap();
    };
    mask("left.png", (64, 40), 28);
    mask("none.png", (64, 40), 0);
    mask("small.png", (63, 40), 28);
    let parse = |name: &str, lines: &str| {
        let masked = format!("[picture]\nmask = \"{name}\"\n[picture.drawn]");
        let text = text(200.0, lines).replace("[picture.drawn]", &masked);
        Scene::parse("t", &text, folder.path())
    };
    // the edge at 31.5 is masked out, and the border of the mask is none
    for kind in [
        "edge",
        "color-edge",
        "scales",
        "line",
        "termination",
        "distance",
        "gvf",
        "vfc",
    ] {
        let scene = parse("left.png", &format!("[[force]]\nkind = \"{kind}\"")).unwrap();
        assert_eq!(strongest(&scene), 0.0, "{kind}");
        assert_eq!(scene.notes.len(), 1, "{kind}: {:?}", scene.notes);
    }
    assert_eq!(strongest(&parse("left.png", "").unwrap()), 0.0);
    for (name, says) in [
        ("none.png", "picture.mask: leaves no pixel"),
        ("small.png", "picture.mask: the mask has 63×40"),
        ("no-such.png", "cannot be read"),
    ] {
        let error = parse(name, "").unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let report = parse("left.png", "[field]\npasses = 3").unwrap();
    assert_eq!(strongest(&report), 0.0);
}
