//! The built program, run in a fresh folder: what it writes, says and returns.

#![allow(clippy::unwrap_used, reason = "a test may stop the process")]

use std::path::Path;
use std::process::{Command, Output};

fn sandbox(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sandbox"))
        .args(arguments)
        .current_dir(folder)
        .env_remove("REGENERATE")
        .output()
        .unwrap()
}

fn words(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn list_names_every_experiment_once_and_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let output = sandbox(folder.path(), &["list"]);
    assert!(output.status.success());
    let listed: Vec<String> = words(&output.stdout)
        .lines()
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .collect();
    let known: Vec<&str> = sandbox::EXPERIMENTS.iter().map(|one| one.id).collect();
    assert_eq!(listed, known);
}

#[test]
fn run_tells_claims_and_numbers_and_writes_nothing_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let output = sandbox(folder.path(), &["run", "fig-4-3"]);
    assert!(output.status.success());
    let told = words(&output.stdout);
    assert!(
        told.contains("holds: turned round at the falling edge"),
        "{told}"
    );
    assert!(told.contains("quantity,value,unit,tolerance"), "{told}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn figures_writes_a_folder_to_look_through() {
    let folder = tempfile::tempdir().unwrap();
    let output = sandbox(folder.path(), &["figures", "--only", "fig-4-2"]);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let found = names(&folder.path().join("figures"));
    let expected = [
        "fig-4-2.csv",
        "fig-4-2.signal.csv",
        "fig-4-2.svg",
        "index.html",
    ];
    assert_eq!(found, expected);
    let page = std::fs::read_to_string(folder.path().join("figures/index.html")).unwrap();
    assert!(page.contains("fig-4-2.svg") && page.contains("fig-4-2.signal.csv"));
}

#[test]
fn check_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = sandbox(folder.path(), &["figures", "--check", "--only", "fig-4-2"]);
    assert!(
        output.status.code().is_some_and(|code| code < 2),
        "{}",
        words(&output.stderr)
    );
    assert!(names(folder.path()).is_empty());
}

#[test]
fn an_unknown_experiment_is_refused_with_the_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["run", "fig-4-33"][..],
        &["figures", "--only", "fig-4-33"][..],
    ] {
        let output = sandbox(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            words(&output.stderr).contains("fig-4-3"),
            "{}",
            words(&output.stderr)
        );
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("taken"), b"a file").unwrap();
    for arguments in [
        &["figures", "--out", "taken"][..],
        &["figures", "--out", "taken/below"][..],
        &["run", "fig-4-2", "--out", "taken"][..],
    ] {
        let output = sandbox(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2));
        let told = words(&output.stderr);
        assert!(told.starts_with("error: cannot write into taken"), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
        assert!(output.stdout.is_empty());
    }
    assert_eq!(names(folder.path()), ["taken"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_and_a_reader_that_left_is_none() {
    use std::process::Stdio;
    for arguments in [&["list"][..], &["run", "fig-4-2"], &["--help"]] {
        let command = || {
            let mut command = Command::new(env!("CARGO_BIN_EXE_sandbox"));
            command.args(arguments).stderr(Stdio::piped());
            command
        };
        let full = std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = command().stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
        let mut child = command().stdout(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {output:?}");
    }
}

#[test]
fn an_unknown_experiment_of_the_atlas_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = sandbox(folder.path(), &["atlas", "--only", "typo"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(words(&output.stderr).contains("typo"), "{output:?}");
    assert!(names(folder.path()).is_empty());
}
