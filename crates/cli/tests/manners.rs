//! What people and scripts rely on: quiet, verbose, JSON, completions, the manual, an end by Ctrl-C.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Answer, Folder, disc};

/// A folder with a disc of radius 25 at (48, 48).
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(96, [48.0, 48.0], 25.0));
    folder
}

fn fit(folder: &Folder, flags: &[&str]) -> Answer {
    let start = ["fit", "disc.pgm", "--from", "circle:47,49,29"];
    folder.snake(&[&start, flags].concat())
}

#[test]
fn quiet_says_nothing_and_verbose_a_line_for_each_choice() {
    let folder = folder();
    let [plain, quiet, verbose] = [&[][..], &["-q"], &["-v"]].map(|flags| fit(&folder, flags));
    assert_eq!(quiet.code, Some(0), "{quiet:?}");
    assert_eq!(quiet.err, "");
    assert_eq!(quiet.out, plain.out);
    assert_eq!(verbose.out, plain.out);
    for start in ["contrast: ", "edge: ", "near the start: ", "last stage: "] {
        let line = |answer: &Answer| answer.err.lines().any(|line| line.starts_with(start));
        assert!(line(&verbose), "{start}: {verbose:?}");
        assert!(!line(&plain), "{start}: {plain:?}");
    }
    folder.refused(
        &["fit", "disc.pgm", "--from", "circle:47,49,29", "-q", "-v"],
        &["--quiet", "--verbose"],
    );
}

#[test]
fn json_is_one_line_alone_on_standard_output() {
    let folder = folder();
    let answer = fit(&folder, &["--json", "--out", "found.csv"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert_eq!(answer.out.lines().count(), 1, "{answer:?}");
    let told: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!(told["outcome"], "settled");
    assert_eq!(told["good"], true);
    assert!(told["chosen"].as_array().unwrap().len() >= 4);
    let area = told["curves"][0]["area"].as_f64().unwrap();
    let disc = std::f64::consts::PI * 625.0;
    assert!((area / disc - 1.0).abs() < 0.03, "{area}, not {disc}");
    // a contour and a line of JSON in one stream could not be told apart
    folder.refused(
        &["fit", "disc.pgm", "--from", "circle:47,49,29", "--json"],
        &["--json", "--out", "a file"],
    );
    let scene = folder.snake(&["run", "soft-ball", "--steps", "3", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&scene.out).unwrap();
    assert_eq!(
        (&told["outcome"], &told["steps"]),
        (&"finished".into(), &3.into())
    );
}

#[test]
fn a_box_and_a_circle_are_starts_and_what_is_neither_is_refused() {
    let folder = folder();
    for start in ["circle:47,49,29", "box:20,21,54,55"] {
        let answer = folder.snake(&["fit", "disc.pgm", "--from", start]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        assert!(answer.err.contains("100 % held"), "{answer:?}");
    }
    for wrong in [
        "circle:47,49",
        "circle:47,49,-3",
        "circle:47,49,nan",
        "box:1,2,3",
        "box:1,2,0,4",
    ] {
        folder.refused(&["fit", "disc.pgm", "--from", wrong], &["--from"]);
    }
}

#[test]
fn shells_and_manuals_know_every_command_and_flag() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let answer = folder.snake(&["completions", shell]);
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
        for word in ["fit", "polarity", "overlay"] {
            assert!(answer.out.contains(word), "{shell} knows no {word}");
        }
    }
    for page in [
        &["man"][..],
        &["man", "run"],
        &["man", "fit"],
        &["man", "field"],
    ] {
        let answer = folder.snake(page);
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
        assert!(answer.out.contains(".SH NAME"), "{answer:?}");
    }
    folder.refused(&["man", "fitt"], &["fitt"]);
    for command in ["run", "fit"] {
        let answer = folder.snake(&[command, "--help"]);
        for code in ["Exit code 0", "1:", "2:"] {
            assert!(answer.out.contains(code), "{command}: {answer:?}");
        }
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_there_is() {
    use std::process::{Command, Stdio};
    let folder = folder();
    let args = "fit disc.pgm --from circle:47,49,29 --dt 1e-6 --steps 1000000000 --out found.csv";
    let child = Command::new(env!("CARGO_BIN_EXE_snake"))
        .args(args.split(' '))
        .current_dir(folder.path("."))
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // as long as a loaded machine may take to read a small picture
    std::thread::sleep(std::time::Duration::from_secs(2));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("stopped by Ctrl-C"), "{said}");
    let found = io::shapes::parse_one(&std::fs::read_to_string(folder.path("found.csv")).unwrap());
    assert!(found.unwrap().first().len() > 20);
}

/// On another machine the last digits may fall otherwise, so some pixels of the line may.
#[test]
fn the_picture_of_the_readme_is_what_its_command_draws() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = Folder::new();
    for name in ["apple.png", "apple_whole_without_the_stem.csv"] {
        let bytes = std::fs::read(root.join("crates/scene/pictures").join(name));
        folder.write(name, bytes.unwrap());
    }
    let command =
        "fit apple.png --from apple_whole_without_the_stem.csv --out found.csv --overlay seen.png";
    assert!(
        std::fs::read_to_string(root.join("README.md"))
            .unwrap()
            .contains(command)
    );
    let answer = folder.snake(&command.split(' ').collect::<Vec<_>>());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let [seen, shown] = [
        folder.path("seen.png"),
        root.join("docs/apple-before-after.png"),
    ]
    .map(|path| io::Picture::decode(&std::fs::read(path).unwrap()).unwrap());
    let (seen, shown) = (seen.display(), shown.display());
    let other = seen.pixels().zip(shown.pixels()).filter(|(a, b)| a != b);
    let share = other.count() as f64 / f64::from(seen.width() * seen.height());
    assert!(share < 1e-3, "{share}");
}
