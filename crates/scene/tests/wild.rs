//! One number of a scene gone wild, each in its turn: it runs, or is refused by its key or line.
//!
//! The fuzz targets (`fuzz/`) look farther and cost a minute; this looks at every number, each time.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use io::Picture;
use scene::Scene;

const BALL: &str = r#"
title = "Everything but a picture"
rules = { frame = "corrected" }
[view]
window = [-1.0, -2.0, 12.0, 13.0]
[snake]
nodes = 12
topology = "closed"
start = { ellipse = { center = [5.0, 8.0], axes = [1.5, 1.0], angle = 0.3 } }
rest = { circle = { center = [0.0, 0.0], radius = 1.2 } }
velocity = [-2.5, 0.1]
spin = 0.5
[material]
tether = { along = [[0.0, 1.0], [0.5, 2.0], [1.0, 1.0]] }
tension = 60.0
rigidity = [4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0]
corners = [3]
breaks = [7]
[densities]
mass = { along = [[0.0, 1.0], [1.0, 2.0]] }
damping = 0.2
[schedule]
tension = [[0.0, 1.0], [0.01, 2.0]]
mass = [[0.0, 1.0], [0.01, 2.0]]
[world]
gravity = [0.1, -0.4]
[[world.wall]]
point = [4.0, 0.0]
normal = [1.0, 0.1]
law = { penalty = { stiffness = 2000.0, damping = 10.0 } }
[[world.wall]]
point = [0.0, 7.5]
normal = [0.0, 1.0]
law = { impact = { restitution = 0.5, friction = 0.3 } }
[run]
dt = 0.001
steps = 4
rest = { balance = 1e-2 }
[record]
every = 2
steps = [1]
velocities = true
energies = true
"#;

const PICTURE: &str = r#"
title = "Everything in a picture"
rules = { sampling = "report", clock = "report" }
[picture.drawn]
size = [24, 20]
region = { ellipse = { center = [12.0, 10.0], axes = [7.0, 5.0], angle = 0.2 } }
background = 60.0
foreground = 180.0
blur = 0.7
noise = 3.0
seed = 5
[field]
passes = 6
gain = 6.0
scale = 1.0
weight = { along = [[0.0, 1.0], [1.0, 0.2]] }
[snake]
nodes = 9
topology = { head = "free", tail = "pinned" }
start = { points = [[3.0, 5.0], [12.0, 2.0], [20.0, 5.0]] }
rest = { segment = { from = [0.0, 0.0], to = [17.0, 1.0] } }
[material]
tether = 0.05
tension = 20.0
rigidity = 50.0
[densities]
mass = 1.0
damping = 4.0
[run]
dt = 0.05
time = 0.2
"#;

const FORCES: &str = r#"
title = "Every kind of force"
[picture.drawn]
size = [16, 14]
region = { circle = { center = [8.0, 7.0], radius = 4.0 } }
noise = 3.0
[[force]]
kind = "edge"
sigma = 1.5
strength = 1.0
weight = { along = [[0.0, 1.0], [1.0, 0.2]] }
schedule = [[0.0, 1.0], [0.1, 0.5]]
[[force]]
kind = "color-edge"
sigma = 1.5
strength = 0.1
[[force]]
kind = "scales"
sigmas = [2.0, 1.0]
strength = 0.1
[[force]]
kind = "line"
sigma = 1.5
strength = 0.1
[[force]]
kind = "termination"
sigma = 1.5
strength = 0.1
floor = 0.1
[[force]]
kind = "distance"
sigma = 1.5
strength = 0.1
threshold = 0.2
reach = 5.0
[[force]]
kind = "gvf"
sigma = 1.5
strength = 0.1
smoothness = 0.2
knee = 0.1
[[force]]
kind = "gvf"
spread = 0.1
[[force]]
kind = "vfc"
sigma = 1.5
strength = 0.1
exponent = 2.0
reach = 9.0
knee = 0.1
[[force]]
kind = "vfc"
width = 3.0
[[force]]
kind = "edge"
sigma = 1.5
polarity = "bright-to-dark"
[[force]]
kind = "regions"
sigma = 1.0
strength = 0.1
[[force]]
kind = "local-regions"
strength = 0.1
radius = 4.0
[[force]]
kind = "likelihood"
strength = 0.1
classes = 16
bandwidth = 5.0
[[force]]
kind = "likelihood"
density = "mixture"
components = 2
[[force]]
kind = "texture"
sigmas = [1.0]
classes = 8
[[force]]
kind = "pressure"
pressure = 0.1
[[force]]
kind = "gas"
pressure = 0.1
area = 70.0
[[force]]
kind = "area"
pressure = 0.1
area = 70.0
[[force]]
kind = "spring"
node = 3
to = [1.0, 2.0]
stiffness = 0.1
damping = 0.1
[[force]]
kind = "spring"
from = [9.0, 9.0]
path = [[0.0, 1.0, 2.0], [0.1, 2.0, 3.0]]
stiffness = 0.1
[[force]]
kind = "repulsor"
at = [8.0, 7.0]
reach = 3.0
push = 0.1
[[force]]
kind = "freeze"
stretch = [7, 1]
stiffness = 0.1
damping = 0.1
[[force]]
kind = "gravity"
acceleration = [0.0, 0.1]
[snake]
nodes = 9
topology = "closed"
start = { circle = { center = [8.0, 7.0], radius = 5.0 } }
[material]
tether = 0.05
tension = 20.0
rigidity = 50.0
[densities]
mass = 1.0
damping = 4.0
[run]
dt = 0.05
time = 0.2
"#;

const WILD: [&str; 15] = [
    "nan",
    "inf",
    "-inf",
    "0.0",
    "-0.0",
    "-1.0",
    "1e-300",
    "5e-324",
    "1e-9",
    "1e9",
    "1e300",
    "0",
    "1",
    "-1",
    "9223372036854775807",
];

/// Where the numbers of a text stand.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    let mut all = Vec::new();
    let mut start = None;
    for (i, c) in text.char_indices() {
        match (part(c), start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                let word = &text[from..i];
                if word.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
                    all.push(from..i);
                }
                start = None;
            }
            _ => {}
        }
    }
    all
}

/// Build and, if it is small, run; whatever comes of it must be an answer.
fn answer(text: &str) -> bool {
    match Scene::parse("wild", text, Path::new("/nowhere")) {
        Ok(mut scene) => {
            scene.plan.force = true;
            let mut steps = 0;
            let record = scene.run(&mut |_| {
                steps += 1;
                if steps < 6 {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            });
            match record {
                Ok(record) => {
                    assert!(
                        record
                            .frames
                            .iter()
                            .all(|f| f.nodes().iter().all(|p| p.is_finite()))
                    );
                    assert!(record.written().to_json_lines().is_ok(), "{text}");
                    true
                }
                Err(error) => said(&error.to_string(), text),
            }
        }
        Err(error) => said(&error.to_string(), text),
    }
}

fn said(error: &str, text: &str) -> bool {
    assert!(
        error.contains(": ") && error.lines().count() == 1 && error.len() < 500,
        "{error}\n{text}"
    );
    false
}

fn one_at_a_time(text: &str) {
    assert!(answer(text), "as it is, it runs");
    let places = numbers(text);
    assert!(places.len() > 30, "{}", places.len());
    let (mut ran, mut refused) = (0, 0);
    for place in places {
        for wild in WILD {
            let mut changed = text.to_owned();
            changed.replace_range(place.clone(), wild);
            if answer(&changed) {
                ran += 1;
            } else {
                refused += 1;
            }
        }
    }
    assert!(
        ran > 100 && refused > 100,
        "{ran} ran, {refused} were refused"
    );
}

#[test]
fn a_ball_with_one_number_gone_wild_runs_or_is_refused() {
    one_at_a_time(BALL);
}

#[test]
fn a_line_in_a_picture_with_one_number_gone_wild_runs_or_is_refused() {
    one_at_a_time(PICTURE);
}

#[test]
fn a_force_with_one_number_gone_wild_runs_or_is_refused() {
    one_at_a_time(FORCES);
}

#[test]
fn a_scene_cut_anywhere_is_refused_or_runs() {
    for text in [BALL, PICTURE, FORCES] {
        for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
            answer(&text[..end]);
        }
    }
}

#[test]
fn a_picture_with_one_byte_gone_wild_is_read_or_refused() {
    let whole = io::paint::png(&io::RgbImage::from_fn(9, 7, |x, y| {
        image::Rgb([x.to_le_bytes()[0] * 20, y.to_le_bytes()[0] * 30, 7])
    }))
    .unwrap();
    for at in 0..whole.len() {
        for wild in [0, 1, 0x7F, 0x80, 0xFF] {
            let mut bytes = whole.clone();
            bytes[at] = wild;
            if let Err(said) = Picture::decode_small(&bytes, 1 << 16) {
                assert!(said.len() < 300 && said.contains("picture"), "{said}");
            }
        }
        // the last chunk and the check sum before it hold no pixel
        let cut = Picture::decode_small(&whole[..at], 1 << 16);
        assert!(cut.is_err() || at + 20 > whole.len(), "cut at {at}");
    }
}
