//! Messages by chance: no panic, every refusal in a sentence, and all can be taken back.

#![allow(clippy::unwrap_used, reason = "a test may stop the process")]

use live::{Action, Body, Drawn, Engine, Outline};
use proptest::prelude::*;

/// A scene small enough for thousands of runs.
pub(crate) const SCENE: &str = r#"
title = "Two rings"
rules = { all = "report", spacing = "corrected" }

[snake]
nodes = 12
topology = "closed"
start = { circle = { center = [2.0, 3.0], radius = 1.0 } }

[material]
tether = 1.0
tension = 4.0
rigidity = 0.5

[densities]
mass = 1.0
damping = 0.3

[world]
gravity = [0.0, -1.0]

[[world.wall]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
law = "clamp"

[run]
dt = 0.01
steps = 400
"#;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -3.0..9.0_f64,
        1 => Just(0.0),
        1 => Just(1e12),
        1 => Just(f64::NAN),
        1 => Just(-1e-300),
    ]
}

fn pair() -> impl Strategy<Value = [f64; 2]> {
    [number(), number()]
}

fn body() -> impl Strategy<Value = Action> {
    let (snake, node) = (0..4_usize, 0..16_usize);
    let keys = prop_oneof![
        Just("tether"),
        Just("tension"),
        Just("rigidity"),
        Just("mass"),
        Just("damping"),
        Just("internal"),
        Just("no")
    ];
    let change = prop_oneof![
        (snake.clone(), node.clone(), pair()).prop_map(|(snake, node, to)| Body::Drag {
            snake,
            node,
            to
        }),
        Just(Body::Drop),
        (snake.clone(), node.clone()).prop_map(|(snake, node)| Body::Pin { snake, node }),
        (snake.clone(), node).prop_map(|(snake, node)| Body::Unpin { snake, node }),
        (pair(), number()).prop_map(|(at, reach)| Body::Push { at, reach }),
        Just(Body::Leave),
        (snake.clone(), pair()).prop_map(|(snake, velocity)| Body::Throw { snake, velocity }),
        prop::collection::vec(pair(), 0..9).prop_map(|points| Body::Ball { points }),
        snake.clone().prop_map(|snake| Body::Delete { snake }),
        pair().prop_map(|g| Body::Gravity { g }),
        (prop::option::of(0..3_usize), pair(), pair()).prop_map(|(index, point, normal)| {
            Body::Wall {
                index,
                point,
                normal,
            }
        }),
        (0..3_usize).prop_map(|index| Body::NoWall { index }),
        (keys, number(), prop::option::of(snake)).prop_map(|(key, value, snake)| Body::Set {
            key: key.to_owned(),
            value,
            snake
        }),
        prop::option::of(prop_oneof![
            Just("imex"),
            Just("newmark"),
            Just("rk4"),
            Just("no")
        ])
        .prop_flat_map(
            |scheme| prop::option::of(1e-4..0.5_f64).prop_map(move |dt| Body::Stepping {
                scheme: scheme.map(str::to_owned),
                dt
            })
        ),
        any::<bool>().prop_map(|on| Body::Contact { on }),
    ];
    change.prop_map(Action::Body)
}

fn run() -> impl Strategy<Value = Action> {
    prop_oneof![
        (0..30_u32).prop_map(|steps| Action::Step { steps }),
        (0..9_u32).prop_map(|steps| Action::Back { steps }),
        Just(Action::Undo),
        Just(Action::Redo),
        Just(Action::Play),
        Just(Action::Pause),
        Just(Action::Reset),
    ]
}

fn outline() -> impl Strategy<Value = Action> {
    let (id, node) = (0..4_u32, 0..80_usize);
    let place = || [-4.0..44.0_f64, -4.0..44.0_f64];
    let drawn = prop_oneof![
        Just(Drawn::Click),
        Just(Drawn::Spline),
        Just(Drawn::Line),
        Just(Drawn::Box),
        Just(Drawn::Ellipse)
    ];
    let change = prop_oneof![
        3 => (drawn, prop::collection::vec(place(), 0..6), any::<bool>())
            .prop_map(|(drawn, points, closed)| Outline::Start { drawn, points, closed }),
        1 => place().prop_map(|p| Outline::Start { drawn: Drawn::Click, points: vec![p], closed: true }),
        2 => (place(), place()).prop_map(|(a, b)| Outline::Start { drawn: Drawn::Box, points: vec![a, b], closed: true }),
        1 => id.clone().prop_map(|id| Outline::Again { id }),
        1 => id.clone().prop_map(|id| Outline::Delete { id }),
        2 => (id.clone(), node.clone(), place(), number())
            .prop_map(|(id, node, to, reach)| Outline::Drag { id, node, to, reach }),
        1 => Just(Outline::Drop),
        1 => (id.clone(), node.clone()).prop_map(|(id, node)| Outline::Pin { id, node }),
        1 => (id.clone(), node.clone(), node.clone()).prop_map(|(id, from, to)| Outline::Freeze { id, from, to }),
        1 => id.clone().prop_map(|id| Outline::Thaw { id }),
        1 => (place(), number()).prop_map(|(at, radius)| Outline::Forbid { at, radius }),
        1 => (place(), number()).prop_map(|(at, reach)| Outline::NotThisEdge { at, reach }),
        1 => (id.clone(), node.clone(), node.clone(), prop::collection::vec(place(), 0..4))
            .prop_map(|(id, from, to, points)| Outline::Redraw { id, from, to, points }),
        1 => (id.clone(), node.clone()).prop_map(|(id, node)| Outline::AddNode { id, node }),
        1 => (id.clone(), node.clone()).prop_map(|(id, node)| Outline::DeleteNode { id, node }),
        1 => (id.clone(), node.clone(), node).prop_map(|(id, from, to)| Outline::Cut { id, from, to }),
        1 => (id.clone(), id).prop_map(|(id, other)| Outline::Join { id, other }),
        1 => Just(Outline::Part),
    ];
    change.prop_map(Action::Outline)
}

/// Carry actions out, and see that all can be taken back.
fn try_all(open: &Action, file: &[u8], actions: &[Action]) -> Result<(), TestCaseError> {
    let mut engine = Engine::new();
    engine.perform(open, file).unwrap();
    let first = engine.bytes();
    for action in actions {
        let before = engine.bytes();
        if let Err(error) = engine.perform(action, &[]) {
            let said = error.to_string();
            prop_assert!(!said.is_empty(), "{action:?}");
            prop_assert!(
                engine.bytes() == before,
                "{action:?} was refused and changed something: {said}"
            );
        }
        for _ in 0..3 {
            engine.tick(16.0, 0.1);
        }
        engine.frame();
    }
    while engine.perform(&Action::Undo, &[]).is_ok() {}
    prop_assert!(engine.bytes() == first, "not all could be taken back");
    Ok(())
}

/// A bright square with a dark hole on a slope.
fn square() -> Vec<u8> {
    let mut out = b"P5 40 40 255 ".to_vec();
    for y in 0..40_u8 {
        for x in 0..40_u8 {
            let inside = (10..30).contains(&x) && (8..28).contains(&y);
            let hole = (16..20).contains(&x) && (14..19).contains(&y);
            out.push(if inside && !hole { 200 } else { 40 + x / 2 });
        }
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(150)))]

    #[test]
    fn a_scene_bears_any_messages(actions in prop::collection::vec(prop_oneof![3 => body(), 2 => run()], 1..24)) {
        let open = Action::Scene { name: "rings".to_owned(), text: Some(SCENE.to_owned()), files: Vec::new() };
        try_all(&open, &[], &actions)?;
    }

    #[test]
    fn a_picture_bears_any_messages(actions in prop::collection::vec(prop_oneof![5 => outline(), 1 => run()], 1..10)) {
        let open = Action::Picture { name: "square.pgm".to_owned(), frame: false };
        try_all(&open, &square(), &actions)?;
    }
}

/// How many sequences are tried; the variable `CHANCES` asks for more.
fn cases(usual: u32) -> u32 {
    let asked = std::env::var("CHANCES").ok();
    asked.and_then(|text| text.parse().ok()).unwrap_or(usual)
}
