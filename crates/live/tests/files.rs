//! What comes in files: pages of a stack as frames, all objects of a picture, scenes with the files that they name.

#![allow(clippy::unwrap_used, reason = "a test may stop the process")]

use crate::chance::SCENE;
use live::{Action, Engine, Frames, Outline, Packet, Session};
use ndarray::Array2;
use serde_json::{Value, json};

/// A disc of radius 14 about a place.
fn disc(x: f64, y: f64) -> Array2<f64> {
    Array2::from_shape_fn((80, 120), |(row, column)| {
        let away = (column as f64 - x).hypot(row as f64 - y);
        40.0 + 150.0 * (14.5 - away).clamp(0.0, 1.0)
    })
}

fn stack(grids: &[Array2<f64>]) -> Vec<u8> {
    io::numbers::float_tiff(&grids.iter().collect::<Vec<_>>()).unwrap()
}

fn open(name: &str, frame: bool) -> Action {
    Action::Picture {
        name: name.to_owned(),
        frame,
    }
}

fn frame(engine: &mut Engine) -> Value {
    Packet::decode(&engine.frame()).unwrap().head["frame"].clone()
}

fn replays(engine: &Engine) {
    let session = Session::parse(&engine.session().text()).unwrap();
    let mut other = Engine::new();
    other.replay(&session, &mut || true).unwrap();
    assert!(other.bytes() == engine.bytes(), "the replay led elsewhere");
}

#[test]
fn the_pages_of_a_stack_are_frames_and_an_outline_is_followed_through_them() {
    let pages: Vec<Array2<f64>> = (0..4)
        .map(|k| disc(40.0 + 3.0 * f64::from(k), 40.0))
        .collect();
    let mut engine = Engine::new();
    engine
        .perform(&open("s.tif", false), &stack(&pages))
        .unwrap();
    let click = json!({"do": {"kind": "outline", "do": "start", "drawn": "click", "points": [[40.0, 40.0]]}});
    engine.call(&Packet::words(click).encode());
    engine
        .perform(&Action::Frames(Frames::Track { births: false }), &[])
        .unwrap();
    for _ in 0..100 {
        engine.tick(100.0, 1.0);
    }
    let now = frame(&mut engine);
    assert_eq!(now["frame"], 3, "{now}");
    assert_eq!(now["with-outlines"], json!([0, 1, 2, 3]));
    let shapes = engine.shapes();
    let points = shapes[0].first();
    let middle = points.iter().map(|p| p.x).sum::<f64>() / points.len() as f64;
    assert!((middle - 49.0).abs() < 0.2, "x {middle}, by the drawing 49");
    replays(&engine);

    // a page of another size is refused where it is looked at, and the others stay
    let mut engine = Engine::new();
    let odd = [disc(40.0, 40.0), Array2::zeros((20, 20)), disc(46.0, 40.0)];
    engine.perform(&open("s.tif", false), &stack(&odd)).unwrap();
    let go = |frame| Action::Frames(Frames::Go { frame });
    let said = engine.perform(&go(1), &[]).unwrap_err().to_string();
    assert!(said.contains("page 2") && said.contains("120×80"), "{said}");
    engine.perform(&go(2), &[]).unwrap();
    assert_eq!(frame(&mut engine)["frame"], 2);
}

#[test]
fn all_objects_are_found_once() {
    let mut both = disc(30.0, 40.0);
    both.zip_mut_with(&disc(85.0, 40.0), |a, b| *a = a.max(*b));
    let mut engine = Engine::new();
    engine
        .perform(&open("two.tif", false), &stack(&[both]))
        .unwrap();
    engine.perform(&Action::Outline(Outline::All), &[]).unwrap();
    let outlines = frame(&mut engine)["outlines"].as_array().unwrap().clone();
    let exact = std::f64::consts::PI * 14.0_f64.powi(2);
    assert_eq!(outlines.len(), 2);
    assert!(outlines.iter().all(|one| one["sure"] == true));
    for shape in engine.shapes() {
        let area = scene::elastic::signed_area(shape.first()).abs();
        // the edge of half a step lies at 14
        assert!((area / exact - 1.0).abs() < 0.03, "{area}, exact {exact}");
    }
    let said = engine.perform(&Action::Outline(Outline::All), &[]);
    assert!(said.unwrap_err().to_string().contains("no further object"));
    let measures = String::from_utf8(engine.export("measures").unwrap().1).unwrap();
    assert!(measures.starts_with("picture,outline,label,class,outcome,area_px2,"));
    assert_eq!(measures.lines().count(), 3);
    replays(&engine);
}

#[test]
fn a_scene_brings_the_files_that_it_names() {
    let circle = "start = { circle = { center = [2.0, 3.0], radius = 1.0 } }";
    let text = SCENE.replace(circle, "start = { file = \"own/ring.csv\" }");
    let ring = b"x,y\n4,8\n6,8\n6,9\n4,9\n";
    let scene = |length: usize, files: bool| Action::Scene {
        name: "own".to_owned(),
        text: Some(text.clone()),
        files: if files {
            vec![("own/ring.csv".to_owned(), length)]
        } else {
            Vec::new()
        },
    };
    let mut engine = Engine::new();
    engine.perform(&scene(ring.len(), true), ring).unwrap();
    assert_eq!(engine.shapes()[0].first().len(), 12);
    replays(&engine);
    let before = engine.bytes();
    for (action, bytes, says) in [
        (scene(ring.len() + 1, true), &ring[..], "must be"),
        (scene(3, true), &ring[..], "without"),
        (scene(0, false), &[][..], "own/ring.csv"),
    ] {
        let said = engine.perform(&action, bytes).unwrap_err().to_string();
        assert!(said.contains(says), "{said}");
        assert!(engine.bytes() == before, "a refused scene changes nothing");
    }
}
