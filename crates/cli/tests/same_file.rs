//! A result never takes the place of what is read, nor of another result: by the file, not by its spelling.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common;

use crate::common::{Folder, disc, scene};

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("p.png", png());
    folder.write("c.csv", "15,30\n30,15\n45,30\n30,45\n");
    folder.write("s.toml", scene(&[]));
    std::fs::create_dir(folder.path("d")).unwrap();
    folder
}

/// Whatever has been written, a picture in it is read by its first bytes, not by its name.
fn png() -> Vec<u8> {
    disc(61, [30.0, 30.0], 12.0)
}

/// The bytes of every file, to see that none has changed.
fn contents(folder: &Folder) -> Vec<Option<Vec<u8>>> {
    let files = folder.listing();
    files
        .iter()
        .map(|(path, _)| std::fs::read(path).ok())
        .collect()
}

fn refused(folder: &Folder, args: &[&str], says: &[&str]) {
    let before = contents(folder);
    folder.refused(args, says);
    assert_eq!(contents(folder), before, "{args:?}");
}

#[cfg(unix)]
#[test]
fn no_result_takes_the_place_of_what_is_read() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    symlink("c.csv", folder.path("soft.csv")).unwrap();
    symlink("p.png", folder.path("soft.png")).unwrap();
    symlink(".", folder.path("here")).unwrap();
    std::fs::hard_link(folder.path("c.csv"), folder.path("hard.csv")).unwrap();
    std::fs::hard_link(folder.path("p.png"), folder.path("d/hard.png")).unwrap();
    let fit = ["fit", "p.png", "--from", "c.csv"];
    let whole = folder.path("c.csv");
    let whole = whole.to_str().unwrap();
    for out in [
        "c.csv",
        "./c.csv",
        "d/../c.csv",
        "soft.csv",
        "hard.csv",
        "here/c.csv",
        whole,
        "p.png",
    ] {
        refused(
            &folder,
            &[&fit[..], &["--out", out]].concat(),
            &["--out", out, "is read"],
        );
    }
    for out in ["p.png", "soft.png", "d/hard.png", "here/soft.png"] {
        let args = [&fit[..], &["--out", "o.csv", "--overlay", out]].concat();
        refused(&folder, &args, &["--overlay", out, "is read"]);
    }
    for flag in ["--record", "--out"] {
        refused(
            &folder,
            &["run", "s.toml", flag, "./s.toml"],
            &[flag, "is read"],
        );
    }
}

#[test]
fn no_result_takes_the_place_of_a_file_that_the_scene_names() {
    let folder = folder();
    folder.write("mask.png", png());
    folder.write("map.png", png());
    folder.write("rest.csv", "15,30\n30,15\n45,30\n30,45\n");
    let text = scene(&[
        (
            "[snake]",
            "[picture]\nfile = \"p.png\"\nmask = \"mask.png\"\n[snake]\nrest = { file = \"rest.csv\" }",
        ),
        (common::CIRCLE, "start = { file = \"c.csv\" }"),
        (
            "tension = 1.0",
            "tension = { value = 1.0, map = { file = \"map.png\" } }",
        ),
    ]);
    folder.write(
        "d/all.toml",
        text.replace("file = \"", "file = \"../")
            .replace("mask = \"", "mask = \"../"),
    );
    let record = ["run", "d/all.toml", "--record"];
    for out in [
        "p.png",
        "mask.png",
        "map.png",
        "c.csv",
        "rest.csv",
        "d/all.toml",
    ] {
        refused(
            &folder,
            &[&record[..], &[out]].concat(),
            &["--record", out, "is read"],
        );
        refused(
            &folder,
            &["run", "d/all.toml", "--out", out],
            &["--out", out, "is read"],
        );
    }
    let answer = folder.snake(&[&record[..], &["r.csv"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
}

#[cfg(unix)]
#[test]
fn two_results_never_share_a_file() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    folder.write("old", "here");
    std::fs::hard_link(folder.path("old"), folder.path("hard")).unwrap();
    symlink("old", folder.path("soft")).unwrap();
    symlink("new", folder.path("to-new")).unwrap();
    for (record, out) in [
        ("a", "a"),
        ("a", "./a"),
        ("a", "d/../a"),
        ("old", "hard"),
        ("old", "soft"),
        ("soft", "hard"),
        ("new", "to-new"),
        ("-", "-"),
        ("-", "/dev/stdout"),
    ] {
        let args = ["run", "s.toml", "--record", record, "--out", out];
        refused(&folder, &args, &["--out", "taken by --record"]);
    }
    let args = [
        "run",
        "s.toml",
        "--record",
        "/dev/null",
        "--out",
        "/dev/null",
    ];
    assert_eq!(folder.snake(&args).code, Some(0));
}

#[test]
fn a_field_is_not_written_over_its_picture_or_its_curve() {
    let folder = folder();
    for name in [
        "0-picture.png",
        "1-smoothed.png",
        "5-force-x.png",
        "index.html",
    ] {
        folder.write(name, png());
        refused(
            &folder,
            &["field", name, "--out", "."],
            &["--out", name, "is read"],
        );
        refused(
            &folder,
            &["field", name, "--out", "d/.."],
            &["--out", name, "is read"],
        );
        std::fs::remove_file(folder.path(name)).unwrap();
    }
    std::fs::rename(folder.path("c.csv"), folder.path("regions.npy")).unwrap();
    let args = [
        "field",
        "p.png",
        "--kind",
        "regions",
        "--from",
        "regions.npy",
        "--out",
        ".",
    ];
    refused(&folder, &args, &["--out", "regions.npy", "is read"]);
    let answer = folder.snake(&["field", "p.png", "--out", "."]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
}

#[test]
fn every_file_that_a_field_writes_is_one_that_was_foreseen() {
    let folder = folder();
    let answer = folder.snake(&["field", "p.png", "--out", "o", "--all"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    // each of them, as the picture of a second call, is refused
    for (path, _) in folder.listing() {
        if path.parent() == Some(&folder.path("o")) {
            let name = path.to_str().unwrap();
            std::fs::write(&path, png()).unwrap();
            folder.refused(
                &["field", name, "--out", "o", "--all"],
                &["--out", "is read"],
            );
        }
    }
}

#[cfg(unix)]
#[test]
fn modes_and_links_stay_and_read_only_files_are_not_replaced() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = folder();
    let mode = |name: &str| {
        std::fs::metadata(folder.path(name))
            .unwrap()
            .permissions()
            .mode()
            & 0o777
    };
    let set = |name: &str, mode| {
        let bits = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(folder.path(name), bits).unwrap();
    };
    for bits in [0o600, 0o640, 0o664] {
        folder.write("o.csv", "old");
        set("o.csv", bits);
        assert_eq!(
            folder.snake(&["run", "s.toml", "--out", "o.csv"]).code,
            Some(0)
        );
        assert_eq!(mode("o.csv"), bits);
    }
    set("o.csv", 0o444);
    refused(
        &folder,
        &["run", "s.toml", "--out", "o.csv"],
        &["o.csv", "read-only"],
    );
    symlink("made.csv", folder.path("l.csv")).unwrap();
    assert_eq!(
        folder.snake(&["run", "s.toml", "--out", "l.csv"]).code,
        Some(0)
    );
    assert!(folder.path("l.csv").is_symlink() && folder.path("made.csv").is_file());
    // under a mask of one's own
    let snake = env!("CARGO_BIN_EXE_snake");
    let command = format!("umask 077; '{snake}' run s.toml --out m.csv");
    let mut shell = std::process::Command::new("sh");
    let done = shell
        .args(["-c", &command])
        .current_dir(folder.path("."))
        .status()
        .unwrap();
    assert!(done.success());
    assert_eq!(mode("m.csv"), 0o600);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_behind_a_descriptor_grows_and_is_not_replaced() {
    let folder = folder();
    folder.write("log", "before\n");
    let snake = env!("CARGO_BIN_EXE_snake");
    for out in ["/dev/stdout", "/dev/fd/1", "-"] {
        let command = format!("'{snake}' run s.toml --out {out} >> log 2>/dev/null");
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", &command]).current_dir(folder.path("."));
        assert!(shell.status().unwrap().success());
        let log = std::fs::read_to_string(folder.path("log")).unwrap();
        assert!(log.starts_with("before\n# contour 1"), "{out}: {log}");
        folder.write("log", "before\n");
    }
    // and what is read is not written to at its end
    let command = format!("'{snake}' run s.toml --out - >> s.toml");
    let before = std::fs::read(folder.path("s.toml")).unwrap();
    let mut shell = std::process::Command::new("sh");
    let done = shell
        .args(["-c", &command])
        .current_dir(folder.path("."))
        .output()
        .unwrap();
    assert_eq!(done.status.code(), Some(2), "{done:?}");
    assert_eq!(std::fs::read(folder.path("s.toml")).unwrap(), before);
}
