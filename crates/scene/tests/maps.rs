//! Parameters from the picture, as scenes say them.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use image::{GrayImage, ImageBuffer, Luma};
use scene::Scene;
use scene::integrator::{Scheme, System as _};

/// A picture bright from x = 32 on, these lines after its table, and these values of tension and mass.
fn text(picture: &str, tension: &str, mass: &str, rest: &str) -> String {
    format!(
        "title = \"t\"\n{picture}\n[snake]\nnodes = 8\ntopology = \"open\"\n\
         start = {{ segment = {{ from = [20.0, 8.0], to = [20.0, 22.0] }} }}\n\
         [material]\ntether = 0.0\ntension = {tension}\nrigidity = 1.0\n\
         [densities]\nmass = {mass}\ndamping = 1.0\n[run]\ndt = 0.01\nsteps = 20\n{rest}"
    )
}

const STEP: &str = "[picture.drawn]\nsize = [64, 40]\nregion = { right-of = 31.5 }";

fn scene(tension: &str) -> Scene {
    Scene::parse("t", &text(STEP, tension, "1.0", ""), Path::new(".")).unwrap()
}

/// The tension of the first edge once the nodes are at their start.
fn tension(scene: &mut Scene) -> f64 {
    let x = scene.start.x.clone();
    scene.snake.advance(0.0, &x);
    -scene.snake.stiffness().dense()[(0, 1)] * scene.snake.body().spacing.powi(2)
        - 2.0 * bends(scene)
}

/// What the rigidity adds to that entry, in units of a tension: 2 ω₂/h² a bend, and there is one over the first edge.
fn bends(scene: &Scene) -> f64 {
    1.0 / scene.snake.body().spacing.powi(2)
}

fn refused(text: &str, folder: &Path, says: &[&str]) {
    let scene = Scene::parse("t", text, folder);
    let error = scene
        .and_then(|scene| scene.check())
        .unwrap_err()
        .to_string();
    for part in says {
        assert!(error.contains(part), "{error}");
    }
    assert_eq!(error.lines().count(), 1, "{error}");
}

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("scene-maps-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_map_multiplies_what_it_stands_beside() {
    // dark at x = 20, and eleven pixels from the edge
    for (written, factor) in [
        ("3.0", 1.0),
        (
            "{ value = 3.0, map = \"grey\", low = 0.5, high = 2.0 }",
            0.5,
        ),
        (
            "{ value = 3.0, map = \"edge\", low = 0.25, high = 2.0, range = [0.1, 0.9] }",
            0.25,
        ),
        (
            "{ value = 3.0, map = { contrast = { sigma = 1.0 } }, low = 0.75, high = 2.0 }",
            0.75,
        ),
        (
            "{ value = 3.0, map = { distance = { sigma = 1.0, reach = 8.0 } }, low = 1.0, high = 0.125 }",
            0.125,
        ),
        (
            "{ along = [[0.0, 3.0], [1.0, 3.0]], map = \"grey\", low = 1.5, high = 2.0 }",
            1.5,
        ),
    ] {
        let found = tension(&mut scene(written));
        // a contrast of 0 is the root of what rounding leaves of 1e-16
        assert!((found - 3.0 * factor).abs() < 1e-6, "{written}: {found}");
    }
}

#[test]
fn the_depth_of_a_picture_changes_nothing() {
    let folder = folder("depth");
    let level = |x: u32, y: u32| u8::try_from(40 + 3 * x + y).unwrap();
    let bytes = GrayImage::from_fn(48, 40, |x, y| Luma([level(x, y)]));
    bytes.save(folder.join("eight.png")).unwrap();
    let words: ImageBuffer<Luma<u16>, Vec<u16>> =
        ImageBuffer::from_fn(48, 40, |x, y| Luma([257 * u16::from(level(x, y))]));
    words.save(folder.join("sixteen.png")).unwrap();
    let last = |file: &str, map: &str| {
        let picture = format!("[picture]\nfile = \"{file}\"");
        let map = format!("{{ value = 3.0, map = {map}, low = 0.5, high = 2.0 }}");
        let scene = Scene::parse("t", &text(&picture, &map, "1.0", ""), &folder).unwrap();
        let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
        record.last().unwrap().nodes().to_vec()
    };
    for map in [
        "\"grey\"",
        "\"edge\"",
        "\"contrast\"",
        "{ file = \"eight.png\" }",
    ] {
        for (a, b) in last("eight.png", map).iter().zip(last("sixteen.png", map)) {
            assert!(a.distance(b) < 1e-9, "{map}");
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_file_is_a_map_with_or_without_a_picture() {
    let folder = folder("file");
    let bytes = GrayImage::from_fn(64, 40, |x, _| Luma([if x < 32 { 51 } else { 255 }]));
    bytes.save(folder.join("map.png")).unwrap();
    for picture in [STEP, ""] {
        let map = "{ value = 3.0, map = { file = \"map.png\" } }";
        let mut scene = Scene::parse("t", &text(picture, map, "1.0", ""), &folder).unwrap();
        assert!((tension(&mut scene) - 0.6).abs() < 1e-9);
    }
    let small = STEP.replace("[64, 40]", "[64, 41]");
    let map = "{ value = 3.0, map = { file = \"map.png\" } }";
    refused(
        &text(&small, map, "1.0", ""),
        &folder,
        &["material.tension.map.file", "64×40", "64×41"],
    );
    let missing = "{ value = 3.0, map = { file = \"none.png\" } }";
    refused(&text(STEP, missing, "1.0", ""), &folder, &["none.png"]);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_makes_no_map_is_refused_by_its_key() {
    let here = Path::new(".");
    let tension = |map: &str, says: &[&str]| refused(&text(STEP, map, "1.0", ""), here, says);
    let grey = "{ value = 1.0, map = \"grey\", low = 0.5, high = 1.0 }";
    tension(
        "{ value = 1.0, map = \"edgy\", low = 1.0, high = 1.0 }",
        &["edgy", "edge"],
    );
    tension(
        "{ value = 1.0, map = \"edge\", low = 1.0 }",
        &["material.tension.high"],
    );
    tension("{ value = 1.0, low = 1.0, high = 2.0 }", &["map"]);
    tension("{ map = \"edge\", low = 1.0, high = 2.0 }", &["along"]);
    tension(
        "{ value = 1.0, map = \"edge\", low = -1.0, high = 2.0 }",
        &["material.tension.low", "-1"],
    );
    tension(
        "{ value = 1.0, map = \"edge\", low = 1.0, high = nan }",
        &["material.tension.high", "NaN"],
    );
    tension(
        "{ value = 1.0, map = \"edge\", low = 1.0, high = 2.0, range = [0.5, 0.5] }",
        &["material.tension.range", "0.5"],
    );
    tension(
        "{ value = 1.0, map = { edge = { sigma = 0.0 } }, low = 1.0, high = 2.0 }",
        &["material.tension.map.edge.sigma"],
    );
    refused(
        &text("", grey, "1.0", ""),
        here,
        &["material.tension.map", "[picture]"],
    );
    refused(
        &text(
            STEP,
            "1.0",
            "{ value = 1.0, map = \"grey\", low = 0.0, high = 1.0 }",
            "",
        ),
        here,
        &["densities.mass", "above 0"],
    );
    let upkeep = "[upkeep]\nstretch = 2.0\n";
    let heavy = "{ value = 1.0, map = \"grey\", low = 0.5, high = 1.0 }";
    refused(
        &text(STEP, "1.0", heavy, upkeep),
        here,
        &["densities.mass.map", "upkeep"],
    );
    refused(
        &text(STEP, grey, "1.0", "[maps]\nevery = -1.0\n"),
        here,
        &["maps.every"],
    );
    let with = |from: &str, to: &str, rest: &str| text(STEP, grey, "1.0", rest).replace(from, to);
    refused(
        &with("dt = 0.01", "dt = 0.01\nscheme = \"exact\"", ""),
        here,
        &["run.scheme", "leapfrog"],
    );
    let auto = with(
        "dt = 0.01\nsteps = 20",
        "dt = \"auto\"\noutput = 0.1\ntime = 1.0",
        "[maps]\nevery = 0.5\n",
    );
    refused(&auto, here, &["maps.every"]);
}

#[test]
fn a_step_too_long_for_the_stiffest_place_is_refused_before_the_run() {
    // soft where the curve starts; a hundred times as stiff where the picture is bright
    let stiff = "{ value = 100.0, map = \"grey\", low = 1.0, high = 100.0 }";
    let scene = |dt: &str| {
        let text = text(STEP, stiff, "1.0", "").replace("dt = 0.01", dt);
        Scene::parse("t", &text, Path::new(".")).unwrap()
    };
    let limit = scene("dt = 0.01").step_limit().unwrap();
    assert!((0.01..0.03).contains(&limit), "{limit}");
    let error = scene("dt = 0.05").check().unwrap_err().to_string();
    assert!(error.contains("run.dt"), "{error}");
    assert!(
        Scheme::Leapfrog
            .step_limit(&scene("dt = 0.01").snake)
            .unwrap()
            > 0.0
    );
}

#[test]
fn every_scheme_but_those_of_modes_runs_the_map() {
    let grey = "{ value = 3.0, map = \"grey\", low = 0.5, high = 2.0 }";
    for scheme in Scheme::ALL {
        if matches!(scheme, Scheme::Exact | Scheme::Etd2) {
            continue;
        }
        let named = format!("dt = 0.01\nscheme = \"{}\"", scheme.name());
        let text = text(STEP, grey, "1.0", "").replace("dt = 0.01", &named);
        let scene = Scene::parse("t", &text, Path::new(".")).unwrap();
        let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
        assert!(record.outcome.is_good(), "{scheme}");
    }
}
