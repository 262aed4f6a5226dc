//! Forces by their kind: in units a person can set, refused by their key, on what counts.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(clippy::float_cmp, reason = "a test: equal means equal")]

use std::io::Cursor;
use std::path::Path;

use glam::DVec2;
use image::{DynamicImage, ImageFormat, RgbImage};
use io::Picture;
use scene::Scene;
use scene::snake::{Curve, ImageForce, World};

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

/// A bright disc of radius 12 about (32, 30), and a curve of radius `radius` about (31, 30).
fn disc(radius: f64, rest: f64, lines: &str) -> String {
    format!(
        "title = \"t\"\n[picture.drawn]\nsize = [64, 60]\nnoise = 4.0\n\
         region = {{ circle = {{ center = [32.0, 30.0], radius = 12.0 }} }}\n{lines}\n\
         [snake]\nnodes = 40\ntopology = \"closed\"\n\
         start = {{ circle = {{ center = [31.0, 30.0], radius = {radius:?} }} }}\n\
         rest = {{ circle = {{ center = [31.0, 30.0], radius = {rest:?} }} }}\n\
         [material]\ntether = 0.0\ntension = 2.0\nrigidity = 2.0\n\
         [densities]\nmass = 1.0\ndamping = 4.0\n[run]\ndt = 0.02\nsteps = 4000\nrest = {{}}\n"
    )
}

fn ends_at(radius: f64, rest: f64, lines: &str) -> Vec<f64> {
    let scene = Scene::parse("t", &disc(radius, rest, lines), Path::new(".")).unwrap();
    let record = scene
        .run(&mut |_| std::ops::ControlFlow::Continue(()))
        .unwrap();
    let nodes = record.last().unwrap().nodes();
    nodes
        .iter()
        .map(|p| p.distance(DVec2::new(32.0, 30.0)))
        .collect()
}

#[test]
fn regions_find_a_disc_from_inside_and_from_far_outside() {
    for (kind, from) in [
        ("regions", 5.0),
        ("regions", 24.0),
        ("likelihood", 6.0),
        ("likelihood", 20.0),
        ("local-regions", 18.0),
    ] {
        let lines = format!("[[force]]\nkind = \"{kind}\"\nstrength = 1.0");
        for r in ends_at(from, 12.0, &lines) {
            // noise; and levels in between, two pixels wide, are anybody's
            assert!((r - 12.0).abs() < 1.5, "{kind} from {from}: {r}");
        }
    }
}

#[test]
fn a_polarity_takes_its_own_edges_only() {
    let edge = |polarity: &str| {
        format!("[[force]]\nkind = \"edge\"\nsigma = 2.0\npolarity = \"{polarity}\"")
    };
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    assert!((mean(&ends_at(15.0, 15.0, &edge("bright-to-dark"))) - 12.0).abs() < 0.5);
    assert!((mean(&ends_at(15.0, 15.0, &edge("either"))) - 12.0).abs() < 0.5);
    // nobody pulls; the start is at rest
    assert!((mean(&ends_at(15.0, 15.0, &edge("dark-to-bright"))) - 15.0).abs() < 1.0);
}

#[test]
fn pressures_and_springs_do_what_they_are_called() {
    let blind = "[field]\ngain = 1e-9\n";
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let start = mean(&ends_at(14.0, 14.0, blind));
    let with = |force: &str| ends_at(14.0, 14.0, &format!("{blind}[[force]]\n{force}"));
    assert!(mean(&with("kind = \"pressure\"\npressure = 0.2")) > start + 0.5);
    assert!(mean(&with("kind = \"pressure\"\npressure = -0.1")) < start - 0.3);
    // bright inside a curve larger than the disc: what differs wants out
    let judged = "kind = \"pressure\"\npressure = 0.1\ndirection = \"picture\"";
    assert!(mean(&with(judged)) < start - 0.3);
    // the area of the start: nothing to do
    let same = with("kind = \"area\"\npressure = 5.0");
    assert!((mean(&same) - start).abs() < 0.05);
    let small = mean(&with("kind = \"area\"\npressure = 50.0\narea = 400.0"));
    assert!(
        (small - (400.0 / std::f64::consts::PI).sqrt()).abs() < 1.0,
        "{small}"
    );
    let pulled = with("kind = \"spring\"\nnode = 0\nto = [60.0, 30.0]\nstiffness = 5.0");
    assert!(pulled[0] > 16.0 && pulled[20] < 16.0, "{pulled:?}");
    let pushed = with("kind = \"repulsor\"\nat = [40.0, 30.0]\nreach = 9.0\npush = 5.0");
    assert!(pushed[0] > start + 1.0, "{pushed:?}");
}

#[test]
fn curves_that_a_kind_cannot_act_on_are_refused() {
    for (keys, says) in [
        ("kind = \"regions\"", "closed curve"),
        ("kind = \"pressure\"\npressure = 1.0", "closed curve"),
        ("kind = \"pressure\"", "missing field"),
        (
            "kind = \"spring\"\nnode = 5\nto = [0.0, 0.0]\nstiffness = 1.0",
            "force 0: node",
        ),
        (
            "kind = \"spring\"\nnode = 1\nstiffness = 1.0",
            "force 0: to",
        ),
        (
            "kind = \"spring\"\nto = [0.0, 0.0]\nstiffness = 1.0",
            "force 0: node",
        ),
        (
            "kind = \"spring\"\nnode = 1\npath = []\nstiffness = 1.0",
            "force 0: path",
        ),
        (
            "kind = \"repulsor\"\nat = [0.0, 0.0]\nreach = 0.0\npush = 1.0",
            "force 0: reach",
        ),
        (
            "kind = \"freeze\"\nstretch = [3, 2]\nstiffness = 1.0",
            "force 0: stretch",
        ),
        (
            "kind = \"freeze\"\nstretch = [3, 4]\nstiffness = 0.0",
            "force 0: stiffness",
        ),
        ("kind = \"likelihood\"\nclasses = 0", "closed curve"),
    ] {
        refused(&format!("[[force]]\n{keys}"), &[says]);
    }
    for (keys, says) in [
        ("kind = \"likelihood\"\nclasses = 0", "force 0: classes"),
        (
            "kind = \"likelihood\"\ndensity = \"mixture\"\ncomponents = 1",
            "force 0: components",
        ),
        (
            "kind = \"likelihood\"\nbandwidth = 0.0",
            "force 0: bandwidth",
        ),
        ("kind = \"texture\"\nsigmas = [0.0]", "force 0: sigmas"),
        ("kind = \"local-regions\"\nradius = -1.0", "force 0: radius"),
        (
            "kind = \"gas\"\npressure = 1.0\narea = 0.0",
            "force 0: area",
        ),
    ] {
        let text = disc(14.0, 14.0, &format!("[[force]]\n{keys}"));
        let error = Scene::parse("t", &text, Path::new("."))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{error}");
    }
}
