//! `docs/formats.md` is true: it names every key, and its examples are what the program reads and writes.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;

use io::shapes;
use scene::{Record, Scene};

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
    std::fs::read_to_string(path).unwrap()
}

/// The fenced blocks of a language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(fence.as_str())
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap().to_owned())
        .collect()
}

fn scene(text: &str) -> Scene {
    Scene::parse("rod", text, Path::new(".")).unwrap()
}

fn run(scene: &mut Scene) -> Record {
    scene.run(&mut |_| ControlFlow::Continue(())).unwrap()
}

/// A scene that uses every table, once with an unknown key (or word) in each of the places marked.
const EVERYTHING: &str = r#"
title = "Everything"
§root§
rules = { §rules§ all = §rule§"corrected" }
[view]
§view§
y = §up§"up"
[picture]
§picture§
[picture.drawn]
§drawn§
size = [64, 64]
region = { §region§ §road§ circle = { §circle§ center = [32.0, 32.0], radius = 9.0 } }
[field]
§field§
weight = { §along§ along = [[0.0, 1.0]] }
[[force]]
kind = "edge"
weight = 0.0
[[force]]
kind = §kind§"gravity"
acceleration = [0.0, 0.0]
§hand§
[snake]
§snake§
nodes = 20
topology = §topology§{ §ends§ head = §end§§rail§"free", tail = "free" }
frame = §frame§§terms§§term§"turning"
start = { §shape§ ellipse = { §ellipse§ center = [32.0, 32.0], axes = [9.0, 8.0] } }
rest = { segment = { §segment§ from = [0.0, 0.0], to = [9.0, 0.0] } }
§tips§
§tip-ends§
[[also]]
§also§
velocity = [0.0, 0.0]
[contact]
§contact§
stiffness = 1.0
stop = 0.5
[upkeep]
§upkeep§
plastic = { §plastic§ yields-at = 0.1, rate = 1.0 }
[material]
§material§
tether = 0.1
tension = { value = 1.0, low = 1.0, high = 0.5, map = §source§"edge" }
rigidity = { §mapped§ value = 1.0, low = 1.0, high = 0.5, map = { §sources§ distance = { §away§ reach = 3.0 } } }
[densities]
§densities§
mass = 1.0
damping = 0.1
[schedule]
§schedule§
mass = [[0.0, 1.0]]
[maps]
§maps§
[world]
§world§
border = §border§"stop"
[[world.wall]]
§wall§
point = [0.0, 0.0]
normal = [1.0, 0.0]
law = { §law§ penalty = { §penalty§ stiffness = 1.0 } }
[[world.wall]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
law = { impact = { §impact§ friction = 1.0 } }
[run]
§run§
dt = 0.01
steps = 5
rest = { §stop§ balance = 1e-3, travel = 1e-4 }
[record]
§record§
every = 1
"#;

/// The text with the mark `place` replaced by `by`, and every other mark taken out.
fn marked(place: &str, by: &str) -> String {
    EVERYTHING
        .split('§')
        .enumerate()
        .map(|(i, part)| match i % 2 {
            0 => part,
            _ if part == place => by,
            _ => "",
        })
        .collect()
}

/// The keys known at a place, out of the refusal of one that is not.
fn known(place: &str) -> Vec<String> {
    // a word of the wrong spelling before the right one, a key before the others
    let wrong = match place {
        "rule" | "up" | "end" | "border" | "kind" | "source" => "\"zzz\" #",
        "topology" | "frame" => "\"zzz\" #",
        "rail" => "{ zzz = 1 } } #",
        "road" => "road = { zzz = 1 } } #",
        "hand" => "[[hand]]\nzzz = 1",
        "tips" => "[tips]\nzzz = 1",
        "tip-ends" => "[tips]\nends = \"zzz\"",
        "terms" => "{ zzz = 1 } #",
        "term" => "{ terms = [\"zzz\"] } #",
        "root" | "view" | "picture" | "drawn" | "field" | "snake" | "material" | "densities"
        | "schedule" | "maps" | "world" | "wall" | "run" | "record" | "also" | "contact"
        | "upkeep" => "zzz = 1",
        "region" | "shape" | "law" => "zzz = 1 } #",
        "sources" => "zzz = 1 } } #",
        _ => "zzz = 1,",
    };
    // within an inline table the rest of the line has to go with its end put back
    let wrong = match place {
        "rule" | "end" | "source" => wrong.replace(" #", " } #"),
        _ => wrong.to_owned(),
    };
    let text = marked(place, &wrong);
    let error = Scene::parse("x", &text, Path::new("."))
        .unwrap_err()
        .to_string();
    let list = error
        .split_once("(known: ")
        .unwrap_or_else(|| unreachable!("{place}: {error}"))
        .1;
    assert!(error.contains("\"zzz\" (known: "), "{error}");
    let list = list.split_once(')').unwrap().0;
    list.split(", ").map(str::to_owned).collect()
}

/// The keys of a kind of force.
fn known_of(kind: &str) -> Vec<String> {
    let text = marked("", "").replace(
        "kind = \"gravity\"\nacceleration = [0.0, 0.0]",
        &format!("kind = \"{kind}\"\nzzz = 1"),
    );
    let error = Scene::parse("x", &text, Path::new("."))
        .unwrap_err()
        .to_string();
    assert!(error.contains("unknown key \"zzz\" (known: "), "{error}");
    let list = error.split_once("(known: ").unwrap().1;
    let list = list.split_once(')').unwrap().0;
    list.split(", ").map(str::to_owned).collect()
}

const PLACES: [&str; 48] = [
    "mapped",
    "hand",
    "maps",
    "source",
    "sources",
    "away",
    "tips",
    "tip-ends",
    "road",
    "rail",
    "frame",
    "terms",
    "term",
    "also",
    "contact",
    "upkeep",
    "plastic",
    "root",
    "rules",
    "rule",
    "view",
    "up",
    "drawn",
    "region",
    "circle",
    "field",
    "along",
    "snake",
    "topology",
    "ends",
    "end",
    "shape",
    "ellipse",
    "segment",
    "material",
    "densities",
    "schedule",
    "world",
    "border",
    "wall",
    "law",
    "penalty",
    "impact",
    "run",
    "stop",
    "record",
    "picture",
    "kind",
];

#[test]
fn the_scene_with_everything_is_one() {
    let text = marked("", "");
    scene(&text);
}

#[test]
fn every_key_and_word_of_a_scene_is_on_the_page() {
    let page = page();
    let mut all: BTreeSet<String> = BTreeSet::new();
    for place in PLACES {
        all.extend(known(place));
    }
    for kind in scene::FORCES {
        all.extend(known_of(kind.name));
    }
    for key in &all {
        let named = [
            format!("`{key}`"),
            format!("`\"{key}\"`"),
            format!("{{ {key} ="),
        ];
        assert!(
            named.iter().any(|name| page.contains(name)),
            "`{key}` is not on the page"
        );
    }
    assert!(all.len() > 80, "only {} keys were found", all.len());
    // and the other way round: what a table of the page calls a key is one
    let scene_part = page.split("## Contour").next().unwrap();
    for line in scene_part.lines().filter(|line| line.starts_with("| `")) {
        for key in line
            .split('|')
            .nth(1)
            .unwrap()
            .split('`')
            .skip(1)
            .step_by(2)
        {
            let kind = scene::FORCES.iter().any(|kind| kind.name == key);
            assert!(kind || all.contains(key), "there is no key `{key}`");
        }
    }
}

#[test]
fn every_scene_on_the_page_is_one() {
    let scenes = blocks(&page(), "toml");
    assert_eq!(scenes.len(), 5);
    for text in &scenes {
        let mut scene = scene(text);
        scene.plan.until.steps = 10;
        run(&mut scene);
    }
}

#[test]
fn the_records_on_the_page_are_what_the_scene_on_it_leaves() {
    let page = page();
    let mut rod = scene(&blocks(&page, "toml")[0]);
    assert_eq!(
        run(&mut rod).written().to_json_lines().unwrap(),
        blocks(&page, "jsonl")[0]
    );
    rod.plan.recording.energies = true;
    assert_eq!(run(&mut rod).written().to_csv(), blocks(&page, "csv")[1]);
}

#[test]
fn the_contour_on_the_page_is_read_and_written_as_it_stands() {
    let text = &blocks(&page(), "csv")[0];
    let contours = shapes::parse(text).unwrap();
    assert_eq!(contours.len(), 1);
    assert_eq!(
        (contours[0].closed, contours[0].first().len()),
        (Some(true), 3)
    );
    assert_eq!(shapes::to_text(&contours), *text);
}

#[test]
fn every_shipped_name_is_on_the_page() {
    let page = page();
    for name in [
        "apple-report-start",
        "apple-over-the-stem",
        "apple-without-the-stem",
        "apple-whole-without-the-stem",
        "apple-truth",
    ] {
        scene::contour(name).unwrap();
        assert!(page.contains(&format!("`\"{name}\"`")), "{name}");
    }
    for name in ["apple", "disturbing-edge"] {
        scene::picture(name).unwrap();
        assert!(page.contains(&format!("`\"{name}\"`")), "{name}");
    }
}
