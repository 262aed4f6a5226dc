//! Scenes whose numbers make no sense: one line with the key and what is needed, code 2, nothing written.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{CIRCLE, Folder, changed, refused, scene};

#[test]
fn a_number_that_is_none_is_refused_by_its_key() {
    for bad in ["nan", "inf", "-inf", "-1.0", "1e300"] {
        for (line, key) in [
            ("radius = 5.0", "radius"),
            ("tether = 0.1", "material.tether"),
            ("tension = 1.0", "material.tension"),
            ("rigidity = 1.0", "material.rigidity"),
            ("mass = 1.0", "densities.mass"),
            ("damping = 0.1", "densities.damping"),
            ("dt = 0.01", "run.dt"),
            ("steps = 5", "run.time"),
        ] {
            let name = if key == "run.time" {
                "time"
            } else {
                line.split(' ').next().unwrap()
            };
            let text = scene(&[(line, &format!("{name} = {bad}"))]);
            // large parameters are numbers: refused for the step they would need, or not at all
            let huge = bad == "1e300" && (key.starts_with("material") || key.starts_with("dens"));
            if huge {
                let folder = Folder::new();
                folder.write("s.toml", text);
                let answer = folder.snake(&["run", "s.toml"]);
                assert!(matches!(answer.code, Some(0..=2)), "{line}: {answer:?}");
                assert!(!answer.err.contains("panic"), "{line}: {answer:?}");
            } else {
                refused(
                    text,
                    &[key, bad.trim_end_matches(".0").trim_end_matches("e300")]
                        .map(|s| if s == "nan" { "NaN" } else { s }),
                );
            }
        }
    }
    for bad in ["nan", "inf", "1e300"] {
        for (line, instead, key) in [
            (
                "center = [30.0,",
                "center = [X,",
                "snake.start.circle.center",
            ),
            (
                "velocity = [1.0, 0.0]",
                "velocity = [X, 0.0]",
                "snake.velocity",
            ),
            ("velocity = [1.0, 0.0]", "spin = X", "snake.spin"),
            (
                "[run]",
                "[world]\ngravity = [0.0, X]\n[run]",
                "world.gravity",
            ),
            (
                "[run]",
                "[[world.wall]]\npoint = [X, 0.0]\nnormal = [1.0, 0.0]\nlaw = \"clamp\"\n[run]",
                "world.wall 0: point",
            ),
            (
                "[run]",
                "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [X, 0.0]\nlaw = \"clamp\"\n[run]",
                "world.wall 0: normal",
            ),
            (
                "[run]",
                "[view]\nwindow = [0.0, 0.0, X, 1.0]\n[run]",
                "view.window",
            ),
            (
                CIRCLE,
                "start = { points = [[0.0, 0.0], [1.0, X], [5.0, 5.0]] }",
                "snake.start.points",
            ),
            (
                CIRCLE,
                "start = { nodes = [[0.0, 0.0], [1.0, X], [5.0, 5.0]] }",
                "snake.start.nodes",
            ),
            (
                CIRCLE,
                "start = { ellipse = { center = [0.0, 0.0], axes = [2.0, X] } }",
                "axes",
            ),
            (
                "\"closed\"\n",
                "\"open\"\nrest = { segment = { from = [0.0, X], to = [1.0, 0.0] } }\n",
                "snake.rest.segment.from",
            ),
            (
                "[snake]",
                "[picture.drawn]\nsize = [9, 9]\nnoise = X\nregion = { right-of = 4.0 }\n[snake]",
                "noise",
            ),
            (
                "[snake]",
                "[picture.drawn]\nsize = [9, 9]\nbackground = X\nregion = { right-of = 4.0 }\n[snake]",
                "background",
            ),
            (
                "[snake]",
                "[picture.drawn]\nsize = [9, 9]\nregion = { right-of = X }\n[snake]",
                "right-of",
            ),
        ] {
            changed(line, &instead.replace('X', bad), &[key]);
        }
    }
    for bad in ["nan", "inf", "-1.0"] {
        for (line, instead, key) in [
            (
                "[run]",
                "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\nlaw = { penalty = { stiffness = X } }\n[run]",
                "world.wall 0",
            ),
            (
                "[run]",
                "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\nlaw = { impact = { friction = X } }\n[run]",
                "world.wall 0",
            ),
            (
                "[run]",
                "[schedule]\nmass = [[0.0, X]]\n[run]",
                "schedule.mass",
            ),
            (
                "[run]",
                "[schedule]\ndamping = [[0.0, 1.0], [1.0, X]]\n[run]",
                "schedule.damping",
            ),
            (
                "tether = 0.1",
                "tether = { along = [[0.0, X]] }",
                "material.tether.along",
            ),
            (
                "steps = 5",
                "steps = 5\nrest = { balance = X, travel = 1.0 }",
                "run.rest.balance",
            ),
            (
                "[snake]",
                "[picture]\nshipped = \"disturbing-edge\"\n[field]\nsigma = X\n[snake]",
                "field.sigma",
            ),
            (
                "[snake]",
                "[picture]\nshipped = \"disturbing-edge\"\n[field]\ngain = X\n[snake]",
                "field.gain",
            ),
            (
                "[snake]",
                "[picture]\nshipped = \"disturbing-edge\"\n[field]\nweight = X\n[snake]",
                "field.weight",
            ),
        ] {
            changed(line, &instead.replace('X', bad), &[key]);
        }
    }
}

#[test]
fn a_body_without_mass_is_refused_unless_the_scheme_needs_none() {
    changed(
        "mass = 1.0",
        "mass = 0.0",
        &["densities.mass", "above 0", "gradient-flow"],
    );
    changed(
        "mass = 1.0",
        "mass = -2.0",
        &["densities.mass", "at least 0, got -2"],
    );
    let mut list = vec!["1.0"; 20];
    list[7] = "0.0";
    changed(
        "mass = 1.0",
        &format!("mass = [{}]", list.join(", ")),
        &["densities.mass", "node 7"],
    );
    list.pop();
    changed(
        "mass = 1.0",
        &format!("mass = [{}]", list.join(", ")),
        &["densities.mass", "19 numbers for 20"],
    );
    let folder = Folder::new();
    folder.write("s.toml", scene(&[("mass = 1.0", "mass = 0.0")]));
    let answer = folder.snake(&["run", "s.toml", "--scheme", "gradient-flow"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    changed("mass = 1.0", "mass = 0.0\ndamping = 0.0 #", &["duplicate"]);
}

#[test]
fn fewer_nodes_than_the_stencil_are_refused() {
    for n in ["0", "1", "4"] {
        changed(
            "nodes = 20",
            &format!("nodes = {n}"),
            &["snake.nodes", "at least 5", &format!("got {n}")],
        );
    }
    let open = |n: &str| {
        scene(&[
            ("nodes = 20", &format!("nodes = {n}")),
            ("\"closed\"", "\"open\""),
            (CIRCLE, "start = { points = [[0.0, 0.0], [9.0, 0.0]] }"),
        ])
    };
    refused(open("2"), &["snake.nodes", "at least 3", "got 2"]);
    refused(open("0"), &["snake.nodes", "at least 3"]);
    refused(open("10000000"), &["snake.nodes", "at most 1048576"]);
    refused(open("99999999999999999999"), &["nodes", "line 4"]);
    refused(open("-3"), &["nodes = -3", "line 4"]);
    refused(open("2.5"), &["nodes = 2.5", "line 4"]);
    changed("nodes = 20\n", "", &["snake.nodes", "missing"]);
    changed(
        CIRCLE,
        "start = { points = [] }",
        &["snake.start.points", "at least 3 points"],
    );
    changed(
        CIRCLE,
        "start = { nodes = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] }",
        &["snake.nodes", "at least 5"],
    );
}

#[test]
fn coincident_points_are_refused() {
    changed("radius = 5.0", "radius = 0.0", &["radius", "above 0"]);
    let same = "[3.0, 4.0], [3.0, 4.0], [3.0, 4.0], [3.0, 4.0], [3.0, 4.0]";
    changed(
        CIRCLE,
        &format!("start = {{ points = [{same}] }}"),
        &["snake.start", "(3, 4)", "move one"],
    );
    changed(
        CIRCLE,
        &format!("start = {{ nodes = [{same}] }}"),
        &["snake.start", "(3, 4)"],
    );
    changed(
        CIRCLE,
        "start = { points = [[0.0, 0.0], [1e-200, 0.0], [0.0, 1e-200]] }",
        &["snake.start"],
    );
    let text = scene(&[
        ("\"closed\"", "\"open\""),
        (
            CIRCLE,
            "start = { segment = { from = [3.0, 4.0], to = [3.0, 4.0] } }",
        ),
    ]);
    refused(text, &["snake.start", "(3, 4)"]);
}

#[test]
fn a_step_beyond_the_limit_is_refused_with_the_limit_and_runs_when_forced() {
    changed(
        "dt = 0.01",
        "dt = 100.0",
        &["run.dt", "a step of 100", "largest stable step"],
    );
    let folder = Folder::new();
    folder.write("s.toml", scene(&[("steps = 5", "steps = 5000")]));
    let args = [
        "run", "s.toml", "--dt", "9.0", "--steps", "5000", "--out", "o.csv", "--record", "r.jsonl",
    ];
    folder.refused(
        &args,
        &[
            "--dt",
            "a step of 9 is too large for leapfrog",
            "largest stable step",
        ],
    );
    let answer = folder.snake(&[&args[..], &["--force"]].concat());
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert_eq!(answer.err.lines().count(), 1, "{answer:?}");
    assert!(
        answer.err.contains("blew up after") && answer.err.contains("at node"),
        "{answer:?}"
    );
    assert!(
        !folder.path("o.csv").exists(),
        "a run that blew up has no contour"
    );
    let record = std::fs::read_to_string(folder.path("r.jsonl")).unwrap();
    let last = record.lines().last().unwrap();
    assert!(
        last.starts_with("{\"outcome\":\"diverged\",\"step\":") && last.contains("\"node\":"),
        "{last}"
    );
}

#[test]
fn a_run_of_absurd_length_is_refused_and_one_of_no_step_is_a_run() {
    for steps in [
        "steps = 10000000000",
        "time = 1e30",
        "time = 1e9",
        "time = -1.0",
    ] {
        changed(
            "steps = 5",
            steps,
            &["run.", steps.split(' ').next().unwrap()],
        );
    }
    changed("steps = 5", "steps = 99999999999999999999", &["line 20"]);
    changed("steps = 5", "steps = -1", &["steps = -1", "line 20"]);
    changed("steps = 5", "steps = 5\ntime = 1.0", &["run", "both"]);
    changed(
        "steps = 5",
        "steps = 1000000000\n[record]\nevery = 1",
        &["record.every", "would keep"],
    );
    changed(
        "steps = 5",
        "steps = 5\n[record]\nevery = 0",
        &["record.every", "at least 1"],
    );
    changed(
        "steps = 5",
        "steps = 5\nrest = { travel = 0 }",
        &["run.rest.travel"],
    );
    changed(
        "dt = 0.01\nsteps = 5",
        "dt = 1e-300\ntime = 1.0",
        &["run.time"],
    );
    changed("dt = 0.01", "dt = 0.0", &["run.dt", "above 0"]);
    for none in ["steps = 0", "time = 0.0"] {
        let folder = Folder::new();
        folder.write("s.toml", scene(&[("steps = 5", none)]));
        let answer = folder.snake(&["run", "s.toml", "--record", "-"]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        assert_eq!(answer.out.lines().count(), 3, "{answer:?}");
        assert!(
            answer
                .out
                .ends_with("{\"outcome\":\"finished\",\"step\":0}\n"),
            "{answer:?}"
        );
    }
}

#[test]
fn sizes_that_would_take_hours_or_gigabytes_are_refused() {
    let drawn = |size: &str, more: &str| {
        let table = format!(
            "[picture.drawn]\nsize = {size}\nregion = {{ right-of = 4.0 }}\n{more}\n[snake]"
        );
        scene(&[("[snake]", &table)])
    };
    refused(
        drawn("[30000, 30000]", ""),
        &["picture.drawn.size", "4194304 pixels"],
    );
    refused(drawn("[0, 1]", ""), &["picture.drawn.size", "1 × 1"]);
    refused(
        drawn("[9223372036854775807, 9223372036854775807]", ""),
        &["picture.drawn.size"],
    );
    refused(
        drawn("[2000, 2000]", "blur = 900.0"),
        &["picture.drawn.blur", "takes too long"],
    );
    refused(
        drawn("[2000, 2000]", "[field]\nsigma = 9000.0"),
        &["field.sigma", "takes too long"],
    );
    refused(
        drawn("[64, 64]", "[field]\nsigma = 2.0\npasses = 3"),
        &["field.sigma", "not both"],
    );
    refused(
        drawn("[64, 64]", "[field]\npasses = 1000000"),
        &["field.passes", "at most"],
    );
}

#[test]
fn places_along_the_body_that_are_not_there_are_refused() {
    changed(
        "rigidity = 1.0",
        "rigidity = 1.0\ncorners = [20]",
        &["material.corners", "no node 20; needed: 0 to 19"],
    );
    changed(
        "rigidity = 1.0",
        "rigidity = 1.0\nbreaks = [99]",
        &["material.breaks", "no node 99"],
    );
    changed(
        "tether = 0.1",
        "tether = { along = [] }",
        &["material.tether.along", "no entry"],
    );
    changed(
        "tether = 0.1",
        "tether = { along = [[0.0, 1.0], [2.0, 1.0]] }",
        &["material.tether.along", "from 0 to 1"],
    );
    changed(
        "tether = 0.1",
        "tether = { along = [[0.5, 1.0], [0.5, 2.0]] }",
        &["material.tether.along", "ascend"],
    );
    changed("tether = 0.1", "tether = \"soft\"", &["tether", "a number"]);
    changed(
        "[run]",
        "[schedule]\nmass = []\n[run]",
        &["schedule.mass", "no entry"],
    );
    changed(
        "[run]",
        "[schedule]\nmass = [[0.0, 1.0], [1.0, 0.0]]\n[run]",
        &["schedule.mass", "above 0"],
    );
    changed(
        "[run]",
        "[schedule]\ntether = [[1.0, 1.0], [0.0, 1.0]]\n[run]",
        &["schedule.tether", "ascend"],
    );
    changed(
        "[run]",
        "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [0.0, 0.0]\nlaw = \"clamp\"\n[run]",
        &["world.wall", "nonzero"],
    );
    changed(
        "title",
        "version = 2\ntitle",
        &["version", "reads 1, got 2"],
    );
}
