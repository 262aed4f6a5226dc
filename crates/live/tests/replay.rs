//! What was done replays to the same bytes, and can be taken back to the first state's.
//! Long because each test is a story of its own, from an opened scene or picture to its replay.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may stop the process"
)]

use live::{Action, Body, Drawn, Engine, Outline, Packet, Session};
use serde_json::{Value, json};

fn scene(name: &str) -> Action {
    Action::shipped(name)
}

/// An engine with that open.
fn opened(action: &Action, file: &[u8]) -> Engine {
    let mut engine = Engine::new();
    engine.perform(action, file).unwrap();
    engine
}

/// Run for so many steps.
fn run(engine: &mut Engine, steps: u64) {
    engine.perform(&Action::Play, &[]).unwrap();
    let goal = engine.steps() + steps;
    let mut ticks = 0;
    while engine.steps() < goal && engine.is_playing() {
        engine.tick(4.0, 0.5);
        ticks += 1;
        assert!(ticks < 100_000, "the run does not go on");
    }
    engine.perform(&Action::Pause, &[]).unwrap();
}

/// A session written, read and replayed leads to the same bytes.
fn replays(engine: &Engine) {
    let session = Session::parse(&engine.session().text()).unwrap();
    let mut other = Engine::new();
    other.replay(&session, &mut || true).unwrap();
    assert!(other.bytes() == engine.bytes(), "the replay led elsewhere");
}

/// Take everything back.
fn undo_all(engine: &mut Engine) {
    while engine.perform(&Action::Undo, &[]).is_ok() {}
}

/// A picture of two bright discs that touch, as the bytes of a file.
fn discs() -> Vec<u8> {
    let mut out = b"P5 120 90 255 ".to_vec();
    for y in 0..90 {
        for x in 0..120 {
            let near = |cx: f64, cy: f64, r: f64| {
                let away = (f64::from(x) - cx).hypot(f64::from(y) - cy);
                (r + 0.5 - away).clamp(0.0, 1.0)
            };
            let level = 40.0 + 150.0 * near(40.0, 45.0, 22.0).max(near(95.0, 45.0, 20.0));
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from 40 to 190"
            )]
            out.push(level as u8);
        }
    }
    out
}

fn picture() -> Engine {
    let open = Action::Picture {
        name: "discs.pgm".to_owned(),
        frame: false,
    };
    opened(&open, &discs())
}

/// Carry a message of words out; what it answers.
fn ask(engine: &mut Engine, words: Value) -> Value {
    let answer = engine.call(&Packet::words(words).encode());
    Packet::decode(&answer).unwrap().head
}

#[test]
fn a_ball_is_dragged_thrown_and_pinned_and_the_session_replays() {
    let mut engine = opened(&scene("soft-ball"), &[]);
    let first = engine.bytes();
    run(&mut engine, 300);
    let drag = |to| {
        Action::Body(Body::Drag {
            snake: 0,
            node: 3,
            to,
        })
    };
    for k in 0..20 {
        engine
            .perform(&drag([6.0 + 0.05 * f64::from(k), 9.0]), &[])
            .unwrap();
        run(&mut engine, 11);
    }
    engine.perform(&Action::Body(Body::Drop), &[]).unwrap();
    run(&mut engine, 100);
    engine
        .perform(&Action::Body(Body::Pin { snake: 0, node: 7 }), &[])
        .unwrap();
    run(&mut engine, 50);
    let before = engine.bytes();
    engine
        .perform(&Action::Body(Body::Gravity { g: [0.3, 0.1] }), &[])
        .unwrap();
    engine.perform(&Action::Undo, &[]).unwrap();
    assert!(engine.bytes() == before);
    engine.perform(&Action::Redo, &[]).unwrap();
    assert!(engine.bytes() != before);
    run(&mut engine, 60);
    replays(&engine);
    undo_all(&mut engine);
    assert!(engine.bytes() == first, "not all was taken back");
    replays(&engine);
}

#[test]
fn the_hand_pulls_a_whole_ball_to_where_it_is() {
    let mut engine = opened(&scene("rigid-ball"), &[]);
    for k in 0..400 {
        let drag = Body::Drag {
            snake: 0,
            node: 0,
            to: [9.0, 12.0],
        };
        engine.perform(&Action::Body(drag), &[]).unwrap();
        run(&mut engine, 12);
        assert!(k < 400);
    }
    let shapes = engine.shapes();
    let node = shapes[0].first()[0];
    // gravity stretches the spring a little
    assert!(
        (node.x - 9.0).abs() < 0.5 && (node.y - 12.0).abs() < 0.8,
        "{node}"
    );
}

#[test]
fn steps_back_lead_to_the_bytes_that_were() {
    let mut engine = opened(&scene("very-soft-ball"), &[]);
    let mut states = Vec::new();
    for _ in 0..400 {
        states.push(engine.bytes());
        engine.perform(&Action::Step { steps: 1 }, &[]).unwrap();
    }
    for back in [1, 1, 2, 7, 100] {
        engine.perform(&Action::Back { steps: back }, &[]).unwrap();
        let now = ask(&mut engine, json!({"ask": {"kind": "about"}}));
        assert!(now["error"].is_null());
        let at = states.iter().position(|state| *state == engine.bytes());
        assert!(at.is_some(), "back by {back}");
        states.truncate(at.unwrap() + 1);
    }
    assert_eq!(states.len(), 400 - 110);
    replays(&engine);
}

#[test]
fn a_step_beyond_the_limit_blows_up_where_it_says_and_can_be_taken_back() {
    let mut engine = opened(&scene("hard-ball"), &[]);
    let stepping = Body::Stepping {
        scheme: None,
        dt: Some(0.5),
    };
    engine.perform(&Action::Body(stepping), &[]).unwrap();
    let values = ask(&mut engine, json!({"ask": {"kind": "values"}}));
    let limit = values["ok"]["dt-limit"].as_f64().unwrap();
    assert!(limit < 0.5, "{limit}");
    engine.perform(&Action::Step { steps: 5000 }, &[]).unwrap();
    let frame = Packet::decode(&engine.frame()).unwrap();
    let end = &frame.head["frame"]["end"];
    assert!(end["words"].as_str().unwrap().contains("blew up"), "{end}");
    assert!(end["node"].is_array(), "{end}");
    engine.perform(&Action::Back { steps: 3 }, &[]).unwrap();
    let frame = Packet::decode(&engine.frame()).unwrap();
    assert!(frame.head["frame"]["end"].is_null());
}

#[test]
fn a_drawn_ball_joins_the_others_and_they_push_each_other() {
    let mut engine = opened(&scene("soft-ball"), &[]);
    let circle: Vec<[f64; 2]> = (0..40)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / 40.0;
            [5.0 + 0.8 * angle.cos(), 12.0 + 0.8 * angle.sin()]
        })
        .collect();
    engine
        .perform(
            &Action::Body(Body::Ball {
                points: circle.clone(),
            }),
            &[],
        )
        .unwrap();
    let values = ask(&mut engine, json!({"ask": {"kind": "values"}}));
    assert_eq!(values["ok"]["contact"], json!(true));
    assert_eq!(engine.shapes().len(), 2);
    let mut crossed = circle;
    crossed.swap(3, 20);
    let refused = engine.perform(&Action::Body(Body::Ball { points: crossed }), &[]);
    assert!(
        refused.unwrap_err().to_string().contains("cross"),
        "a crossing ball"
    );
    run(&mut engine, 500);
    replays(&engine);
    engine
        .perform(&Action::Body(Body::Delete { snake: 0 }), &[])
        .unwrap();
    assert!(
        engine
            .perform(&Action::Body(Body::Delete { snake: 1 }), &[])
            .is_err()
    );
}

#[test]
fn a_click_finds_a_disc_and_mending_changes_the_stretch_alone() {
    let mut engine = picture();
    let first = engine.bytes();
    let click = Outline::Start {
        drawn: Drawn::Click,
        points: vec![[38.0, 44.0]],
        closed: true,
    };
    engine.perform(&Action::Outline(click), &[]).unwrap();
    run(&mut engine, 200);
    let found = engine.shapes();
    let radii = found[0]
        .first()
        .iter()
        .map(|p| (p.x - 40.0).hypot(p.y - 45.0));
    assert!(
        radii.clone().all(|r| (r - 22.0).abs() < 0.6),
        "{:?}",
        radii.collect::<Vec<_>>()
    );
    // pull the leftmost node away and let go where there is no edge
    let left = |shape: &io::shapes::Shape| {
        let nodes = shape.first().iter().enumerate();
        nodes
            .min_by(|a, b| a.1.x.total_cmp(&b.1.x))
            .map(|(i, _)| i)
            .unwrap()
    };
    let node = left(&found[0]);
    let drag = Outline::Drag {
        id: 1,
        node,
        to: [10.0, 45.0],
        reach: 12.0,
    };
    engine.perform(&Action::Outline(drag), &[]).unwrap();
    run(&mut engine, 60);
    let pulled = engine.bytes();
    engine
        .perform(&Action::Outline(Outline::Drop), &[])
        .unwrap();
    run(&mut engine, 400);
    assert!(engine.bytes() != pulled);
    let mended = engine.shapes();
    let (before, after) = (found[0].first(), mended[0].first());
    assert_eq!(before.len(), after.len());
    let moved = before
        .iter()
        .zip(after)
        .filter(|(a, b)| a.distance(**b) > 1e-9)
        .count();
    assert!(
        (3..before.len() / 2).contains(&moved),
        "{moved} of {}",
        before.len()
    );
    replays(&engine);
    undo_all(&mut engine);
    assert!(engine.bytes() == first, "not all was taken back");
}

#[test]
fn outlines_are_cut_joined_named_and_read_back() {
    let mut engine = picture();
    let circle = |cx: f64, r: f64| {
        let place = move |i: i32| {
            let angle = std::f64::consts::TAU * f64::from(i) / 30.0;
            [cx + r * angle.cos(), 45.0 + r * angle.sin()]
        };
        Outline::Start {
            drawn: Drawn::Line,
            points: (0..30).map(place).collect(),
            closed: true,
        }
    };
    engine
        .perform(&Action::Outline(circle(40.0, 24.0)), &[])
        .unwrap();
    engine
        .perform(&Action::Outline(circle(95.0, 22.0)), &[])
        .unwrap();
    let n = engine.shapes()[0].first().len();
    let cut = Outline::Cut {
        id: 1,
        from: 0,
        to: n / 2,
    };
    engine.perform(&Action::Outline(cut), &[]).unwrap();
    assert_eq!(engine.shapes().len(), 3);
    engine.perform(&Action::Undo, &[]).unwrap();
    let name = Outline::Name {
        id: 2,
        label: "right, \"the\" disc".to_owned(),
        class: "disc".to_owned(),
    };
    engine.perform(&Action::Outline(name), &[]).unwrap();
    for (format, ..) in [
        ("geojson", 0),
        ("csv", 0),
        ("imagej", 0),
        ("labelme", 0),
        ("coco", 0),
        ("svg", 0),
    ] {
        let (file, bytes) = engine.export(format).unwrap();
        let mut other = picture();
        let read = Outline::File {
            name: file.clone(),
            search: false,
        };
        other
            .perform(&Action::Outline(read), &bytes)
            .unwrap_or_else(|e| panic!("{file}: {e}"));
        let (one, two) = (engine.shapes(), other.shapes());
        assert_eq!(one.len(), two.len(), "{format}");
        for (one, two) in one.iter().zip(&two) {
            let far = one.first().iter().map(|p| {
                let away = two.first().iter().map(|q| p.distance(*q));
                away.fold(f64::INFINITY, f64::min)
            });
            // ImageJ has floats of 32 bits
            assert!(far.fold(0.0, f64::max) < 0.01, "{format}");
        }
    }
    let (_, measures) = engine.export("measures").unwrap();
    let text = String::from_utf8(measures).unwrap();
    assert!(text.contains("\"right, \"\"the\"\" disc\",disc"), "{text}");
    assert!(engine.export("nothing").is_err());
}

#[test]
fn an_edge_that_does_not_count_is_let_go() {
    let mut engine = picture();
    let click = Outline::Start {
        drawn: Drawn::Click,
        points: vec![[40.0, 45.0]],
        closed: true,
    };
    engine.perform(&Action::Outline(click), &[]).unwrap();
    let before = engine.shapes();
    let no = Outline::NotThisEdge {
        at: [18.0, 45.0],
        reach: 15.0,
    };
    engine.perform(&Action::Outline(no), &[]).unwrap();
    assert_ne!(engine.shapes(), before);
    let far = Outline::NotThisEdge {
        at: [5.0, 5.0],
        reach: 15.0,
    };
    let refused = engine
        .perform(&Action::Outline(far), &[])
        .unwrap_err()
        .to_string();
    assert!(refused.contains("no edge"), "{refused}");
}

#[test]
fn what_no_message_may_be_is_refused_in_a_sentence() {
    let mut engine = opened(&scene("soft-ball"), &[]);
    let before = engine.bytes();
    for words in [
        json!({}),
        json!({"do": {"kind": "fly"}}),
        json!({"do": {"kind": "body", "do": "drag", "snake": 99, "node": 0, "to": [0, 0]}}),
        json!({"do": {"kind": "body", "do": "drag", "snake": 0, "node": 4000, "to": [0, 0]}}),
        json!({"do": {"kind": "body", "do": "drag", "snake": 0, "node": 0, "to": [1e300, 0]}}),
        json!({"do": {"kind": "body", "do": "set", "key": "tension", "value": -1}}),
        json!({"do": {"kind": "body", "do": "set", "key": "colour", "value": 1}}),
        json!({"do": {"kind": "body", "do": "stepping", "dt": 0}}),
        json!({"do": {"kind": "body", "do": "wall", "point": [0, 0], "normal": [0, 0]}}),
        json!({"do": {"kind": "body", "do": "no-wall", "index": 7}}),
        json!({"do": {"kind": "body", "do": "push", "at": [0, 0], "reach": 0}}),
        json!({"do": {"kind": "step", "steps": 0}}),
        json!({"do": {"kind": "speed", "factor": 1e9}}),
        json!({"do": {"kind": "scene", "name": "soft-bal"}}),
        json!({"do": {"kind": "scene", "name": "mine", "text": "title = 3"}}),
        json!({"do": {"kind": "outline", "do": "delete", "id": 1}}),
        json!({"do": {"kind": "picture", "name": "no.png"}}),
        json!({"ask": {"kind": "tile", "level": 0, "x": 0, "y": 0, "low": 0, "high": 255, "gamma": 1}}),
        json!({"ask": {"kind": "field", "from": [0, 0], "to": [1, 1], "count": 9}}),
        json!({"ask": {"kind": "thumb", "name": "nothing"}}),
        json!({"ask": {"kind": "export", "format": "nothing"}}),
        json!({"session": true}),
        json!({"ask": {"kind": "menu"}, "do": {"kind": "play"}}),
    ] {
        let answer = ask(&mut engine, words.clone());
        let said = answer["error"]
            .as_str()
            .unwrap_or_else(|| panic!("{words}: {answer}"));
        assert!(!said.is_empty() && !said.contains('\n'), "{words}: {said}");
        assert!(engine.bytes() == before, "{words}");
    }
    let answer = engine.call(b"nonsense");
    assert!(Packet::decode(&answer).unwrap().head["error"].is_string());
}

#[test]
fn every_shipped_scene_opens_runs_and_draws() {
    for (name, _) in scene::SCENES {
        let mut engine = Engine::new();
        match engine.perform(&scene(name), &[]) {
            Ok(()) => {}
            Err(error) => {
                // one run of a single long step has nothing to look at
                assert!(error.to_string().contains("run.dt"), "{name}: {error}");
                continue;
            }
        }
        engine.perform(&Action::Step { steps: 5 }, &[]).unwrap();
        let frame = Packet::decode(&engine.frame()).unwrap();
        let snakes = frame.head["frame"]["snakes"].as_array().unwrap();
        assert!(!snakes.is_empty(), "{name}");
        for question in ["values", "shape", "about", "atlas"] {
            let answer = ask(&mut engine, json!({"ask": {"kind": question}}));
            let none = question == "atlas" && answer["error"].is_string();
            assert!(
                none || !answer["ok"].is_null(),
                "{name}: {question}: {answer}"
            );
        }
    }
}
