//! Results that cannot be written: found out before the run, and nothing else is written either.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, disc, scene};

#[test]
fn a_file_that_cannot_be_written_is_refused_before_the_run() {
    let folder = Folder::new();
    folder.write("file", "here");
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    folder.write("c.csv", "10,30\n30,10\n50,30\n30,50\n");
    folder.write("s.toml", scene(&[]));
    std::fs::create_dir(folder.path("d")).unwrap();
    for bad in ["file/r.csv", "no/such/r.csv", "d", "d/.."] {
        let says = [bad, "cannot be written", "is needed"];
        // a billion steps would be noticed
        let run = [
            "run",
            "s.toml",
            "--steps",
            "1000000000",
            "--every",
            "1000000000",
        ];
        folder.refused(&[&run[..], &["--record", bad]].concat(), &says);
        folder.refused(
            &[&run[..], &["--record", "r.csv", "--out", bad]].concat(),
            &says,
        );
        folder.refused(&["fit", "a.pgm", "--from", "c.csv", "--out", bad], &says);
    }
    let overlay = [
        "fit",
        "a.pgm",
        "--from",
        "c.csv",
        "--out",
        "o.csv",
        "--overlay",
    ];
    folder.refused(
        &[&overlay[..], &["file/o.png"]].concat(),
        &["file/o.png", "cannot be written"],
    );
    folder.refused(
        &[&overlay[..], &["o.jpg"]].concat(),
        &["--overlay", ".png", "o.jpg"],
    );
}

#[test]
fn a_folder_that_cannot_be_made_is_refused() {
    let folder = Folder::new();
    folder.write("file", "here");
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    for bad in ["file", "file/below"] {
        folder.refused(
            &["field", "a.pgm", "--out", bad],
            &[bad, "folder for results"],
        );
    }
    #[cfg(target_os = "linux")]
    folder.refused(
        &["field", "a.pgm", "--out", "/proc/no"],
        &["/proc/no", "folder for results"],
    );
}

#[test]
fn two_results_in_one_place_are_refused() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    let args = ["run", "s.toml", "--record", "a", "--out", "a"];
    folder.refused(&args, &["--out", "taken by --record"]);
    let args = ["run", "s.toml", "--record", "-", "--out", "-"];
    folder.refused(&args, &["--out", "taken by --record"]);
}

#[test]
fn an_overlay_needs_a_picture() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    let args = ["run", "s.toml", "--overlay", "o.png"];
    folder.refused(&args, &["--overlay", "no picture"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_a_reader_that_left_is_not() {
    use std::process::{Command, Stdio};
    let snake = || Command::new(env!("CARGO_BIN_EXE_snake"));
    let full = std::fs::File::options()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = snake().arg("list").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.starts_with("snake: standard output: cannot be written"),
        "{said}"
    );

    let mut child = snake()
        .args([
            "run",
            "soft-ball",
            "--steps",
            "2000",
            "--every",
            "1",
            "--record",
            "-",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        !String::from_utf8_lossy(&output.stderr).contains("panic"),
        "{output:?}"
    );
}

#[cfg(unix)]
#[test]
fn a_device_is_written_to_and_stays_a_device() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    let answer = folder.snake(&["run", "s.toml", "--out", "/dev/null"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        std::fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
}

#[test]
fn what_a_record_keeps_needs_a_record() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    for flag in [&["--energies"][..], &["--velocities"], &["--every", "2"]] {
        let args = [&["run", "s.toml"][..], flag].concat();
        folder.refused(&args, &[flag[0], "needs --record"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn help_for_a_full_device_is_an_error_and_for_a_reader_that_left_is_none() {
    use std::process::{Command, Stdio};
    for args in [
        &["--help"][..],
        &["fit", "--help"],
        &["--version"],
        &["list"],
    ] {
        let snake = || {
            let mut snake = Command::new(env!("CARGO_BIN_EXE_snake"));
            snake.args(args).stderr(Stdio::piped());
            snake
        };
        let full = std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = snake().stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {output:?}");
        let mut child = snake().stdout(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}: {output:?}");
    }
}

#[test]
fn missing_arguments_are_listed_with_the_usage() {
    let answer = Folder::new().snake(&["fit"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    let lines: Vec<&str> = answer.err.lines().collect();
    assert!(lines[0].contains("--from <START>, <IMAGE>"), "{answer:?}");
    assert!(lines[1].starts_with("Usage: snake fit"), "{answer:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_contour_that_is_kept_nowhere_is_told() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    let snake = env!("CARGO_BIN_EXE_snake");
    for output in [">&-", "> /dev/null"] {
        let mut shell = std::process::Command::new("sh");
        let command = format!("'{snake}' run s.toml --out - {output}");
        let shell = shell.args(["-c", &command]).current_dir(folder.path("."));
        let done = shell.output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{done:?}");
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(said.contains("the contour is kept nowhere"), "{said}");
    }
}
