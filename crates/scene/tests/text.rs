//! A scene's text is written as well as read, and changed key by key.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::path::Path;

use scene::{SCENES, Scene, SceneText};

fn parsed(text: &str) -> SceneText {
    SceneText::parse("a", text, Path::new(".")).unwrap()
}

/// Whether two scenes begin alike and are run alike.
fn alike(one: &Scene, other: &Scene) -> bool {
    let starts = |scene: &Scene| {
        let company = scene.company.iter().flat_map(|company| &company.others);
        let others = company.map(|(_, state)| state.clone());
        let all: Vec<_> = std::iter::once(scene.start.clone()).chain(others).collect();
        all
    };
    let (a, b) = (one.snake.body(), other.snake.body());
    starts(one) == starts(other)
        && one.plan == other.plan
        && (&a.rest, &a.material, &a.mass, &a.damping)
            == (&b.rest, &b.material, &b.mass, &b.damping)
        && one.snake.world().names().eq(other.snake.world().names())
}

/// What a text says after it was written and read again.
fn written_and_read(text: &str, builds: bool) {
    let first = parsed(text);
    let written = first.to_string();
    let again = SceneText::parse("a", &written, Path::new("."))
        .unwrap_or_else(|error| unreachable!("{error}\n{written}"));
    assert!(again == first, "{written}");
    assert_eq!(again.to_string(), written);
    if builds {
        let (one, other) = (first.scene().unwrap(), again.scene().unwrap());
        assert!(alike(&one, &other), "{written}");
    }
}

#[test]
fn every_shipped_scene_is_written_as_it_was_read() {
    for (_, text) in SCENES {
        written_and_read(text, true);
    }
}

#[test]
fn every_scene_on_the_page_of_formats_is_written_as_it_was_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
    let page = std::fs::read_to_string(path).unwrap();
    let mut count = 0;
    for rest in page.split("```toml\n").skip(1) {
        written_and_read(rest.split("```").next().unwrap(), true);
        count += 1;
    }
    assert!(count >= 5, "{count}");
}

/// Every value that has more than one form, in each of them.
const FORMS: &str = r#"
title = "All \"forms\" – ü"
note = "two\nlines"
rules = { all = "report", sampling = "corrected" }
[view]
y = "up"
window = [0.0, 0.0, 5.0, 5.0]
[picture]
file = "none.png"
mask = "mask.png"
invalid = "mask"
[field]
computed = "whole"
sigma = 2
weight = { along = [[0.0, 1.0], [1.0, 0.5]] }
[[force]]
kind = "edge"
name = "rim"
weight = [1.0, 2.0]
schedule = [[0.0, 1.0]]
[[force]]
kind = "spring"
from = [1.0, 2.0]
path = [[0.0, 1.0, 2.0]]
stiffness = 3.0
[[hand]]
until = 2.0
hold = [0, 1]
[[hand]]
from = 1.0
force = { kind = "gravity", acceleration = [0.0, 1.0] }
[snake]
nodes = "4.5 px"
topology = { head = "pinned", tail = { rail = [[0.0, 0.0], [1.0, 1.0]] } }
start = { shipped = "apple-truth" }
rest = { nodes = [[0.0, 0.0], [1.0, 0.0]] }
frame = { terms = ["coriolis"] }
[[also]]
at = [[1.0, 2.0]]
force = []
[[also]]
nodes = 7
topology = "closed"
[[also.force]]
kind = "area"
pressure = 0.5
[contact]
stiffness = 1.0
stop = 0.1
own = true
[upkeep]
plastic = { yields-at = 0.1, rate = 2.0 }
[tips]
shade = "dark"
[material]
tether = { value = [1.0, 2.0], map = "grey", low = 1.0, high = 2.0 }
tension = { along = [[0.0, 1.0]], map = { edge = { sigma = 2.0 } }, low = 0.0, high = 1.0, range = [0.1, 0.9] }
rigidity = { value = 1.0, map = { file = "map.png" } }
higher = [1.0, [1.0, 2.0]]
corners = [1]
[densities]
mass = { value = 1.0, map = "distance", low = 1.0, high = 2.0 }
damping = "mode(2)"
internal = "critical"
[schedule]
tension = [[0.0, 1.0], [1.0, 2.0]]
[world]
gravity = [0.0, 9.81]
border = "none"
[[world.wall]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
law = "clamp"
[[world.wall]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
law = { penalty = { stiffness = 1e300 } }
[run]
dt = "auto"
output = "every"
tolerance = 1e-9
time = 3
rest = { shape = true }
[record]
every = 3
steps = [1, 2]
energies = true
"#;

#[test]
fn every_form_of_a_value_is_written_as_it_was_read() {
    written_and_read(FORMS, false);
    // nothing is written that was not given
    let written = parsed(FORMS).to_string();
    for absent in [
        "velocity",
        "spin",
        "version",
        "friction",
        "growth",
        "range = 0",
        "maps",
    ] {
        assert!(!written.contains(absent), "{absent}: {written}");
    }
}

#[test]
fn a_key_is_given_another_value_wherever_it_stands() {
    for (key, value, says) in [
        ("material.corners", "[2, 3]", "corners = [2, 3]"),
        ("title", "Other", "title = \"Other\""),
        ("run.dt", "0.5", "dt = 0.5"),
        ("run.output", "0.5", "output = 0.5"),
        ("run.rest.balance", "0.1", "balance = 0.1"),
        ("maps.every", "2", "every = 2.0"),
        ("force.0.strength", "7", "strength = 7.0"),
        ("force.rim.strength", "8", "strength = 8.0"),
        ("force.spring.stiffness", "9", "stiffness = 9.0"),
        ("force.2.kind", "gvf", "kind = \"gvf\""),
        ("world.wall.1.law", "clamp", "law = \"clamp\""),
        ("also.1.force.area.pressure", "2", "pressure = 2.0"),
        (
            "also.0.force.0.kind",
            "scales",
            "[[also.force]]\nkind = \"scales\"",
        ),
        ("hand.1.force.acceleration", "[1, 0]", "[1.0, 0.0]"),
        ("snake.nodes", "3 pixels", "nodes = \"3 px\""),
        ("snake.topology", "closed", "topology = \"closed\""),
        ("densities.damping", "mode(3)", "damping = \"mode(3)\""),
    ] {
        let mut text = parsed(FORMS);
        let before = text.clone();
        text.set(key, value).unwrap();
        assert!(text != before, "{key}");
        let written = text.to_string();
        assert!(written.contains(says), "{key}: {written}");
        assert!(parsed(&written) == text, "{key}");
    }
}

#[test]
fn a_key_or_value_that_there_is_not_is_refused_as_in_a_file_and_changes_nothing() {
    for (key, value, says) in [
        (
            "material.tensoin",
            "3",
            &["unknown key \"tensoin\"", "\"tension\"?"][..],
        ),
        (
            "materail.tension",
            "3",
            &["unknown key \"materail\"", "\"material\"?"],
        ),
        ("material.tension", "much", &["much"]),
        ("material.tension", "", &["no value"]),
        ("material.tension", "[1, ", &["no value of TOML"]),
        ("material", "3", &["integer `3`, expected a table"]),
        ("snake.start.circle.radius", "3", &["exactly one key"]),
        ("snake.start", "circle", &["needs a value"]),
        ("run.dt", "3\nsteps = 4", &["number above 0 or \"auto\""]),
        ("snake.nodes", "4 mm", &["\"4 px\""]),
        ("snake.nodes", "2.5", &["2.5"]),
        (
            "snake.topology",
            "closd",
            &["unknown word \"closd\"", "\"closed\"?"],
        ),
        (
            "snake.topology.head.rail",
            "3",
            &["head is \"pinned\" and has no keys"],
        ),
        ("force.rmi.strength", "3", &["no entry \"rmi\"", "\"rim\"?"]),
        (
            "force.5.strength",
            "3",
            &["2 entries", "at most 2", "got 5"],
        ),
        ("force.2.strength", "3", &["kind"]),
        (
            "force.rim.strenght",
            "3",
            &["unknown key \"strenght\"", "\"strength\"?"],
        ),
        ("", "3", &["is no key"]),
        ("run..dt", "3", &["is no key"]),
    ] {
        let mut text = parsed(FORMS);
        let error = text.set(key, value).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{key}: ")), "{key}: {error}");
        assert!(error.lines().count() == 1, "{error}");
        for part in says {
            assert!(error.contains(part), "{key}: {error} should say {part}");
        }
        assert!(text == parsed(FORMS), "{key}");
    }
    // two of a kind are told apart by their numbers
    let mut text = parsed(FORMS);
    text.set("force.2.kind", "spring").unwrap_err();
    text.set(
        "force.2",
        "{ kind = \"spring\", stiffness = 1.0, to = [0.0, 0.0] }",
    )
    .unwrap();
    let error = text.set("force.spring.stiffness", "2").unwrap_err();
    assert!(
        error.to_string().contains("2 entries \"spring\""),
        "{error}"
    );
}

/// A body whose start is `shape`, with nodes so far apart.
fn nodes(shape: &str, topology: &str, apart: &str) -> Result<usize, String> {
    let text = format!(
        "title = \"t\"\n[snake]\nnodes = {apart}\ntopology = \"{topology}\"\nstart = {shape}\n\
         [material]\ntether = 0\ntension = 1\nrigidity = 1\n[densities]\nmass = 1\ndamping = 1\n\
         [run]\ndt = 0.01\nsteps = 1\n"
    );
    let scene = Scene::parse("a", &text, Path::new("."));
    let scene = scene.map_err(|error| error.to_string())?;
    Ok(scene.snake.body().len())
}

#[test]
fn nodes_may_be_so_many_pixels_apart() {
    let circle = "{ circle = { center = [0, 0], radius = 10 } }";
    // 62.83 pixels around
    assert_eq!(nodes(circle, "closed", "\"4 px\""), Ok(16));
    assert_eq!(nodes(circle, "closed", "\"4 pixels\""), Ok(16));
    assert_eq!(nodes(circle, "closed", "\"0.5px\""), Ok(126));
    let segment = "{ segment = { from = [0, 0], to = [40, 0] } }";
    assert_eq!(nodes(segment, "open", "\"4 px\""), Ok(11));
    // a spline is measured along the curve, which is longer than the way from click to click
    let corner = "{ points = [[0, 0], [20, 0], [20, 20], [0, 20]] }";
    let around = nodes(corner, "closed", "\"0.1 px\"").unwrap();
    assert!((820..950).contains(&around), "{around}");
    for (shape, topology, apart, says) in [
        (
            circle,
            "closed",
            "\"20 px\"",
            "must be at least 5 nodes, got 3",
        ),
        (
            circle,
            "closed",
            "\"1e-6 px\"",
            "must be at most 1048576 nodes",
        ),
        (
            segment,
            "open",
            "\"30 px\"",
            "must be at least 3 nodes, got 2",
        ),
        (circle, "closed", "\"0 px\"", "must be above 0"),
        (circle, "closed", "\"-4 px\"", "must be above 0"),
        (circle, "closed", "\"NaN px\"", "must be above 0"),
        (
            circle,
            "closed",
            "\"four px\"",
            "a number of nodes, or the distance",
        ),
        (
            circle,
            "closed",
            "\"4\"",
            "a number of nodes, or the distance",
        ),
        (circle, "closed", "-4", "-4"),
    ] {
        let error = nodes(shape, topology, apart).unwrap_err();
        assert!(error.contains(says), "{apart}: {error}");
    }
}
