//! A fresh folder with the built program in it, and what may be asked of an answer.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: levels from 0 to 255"
)]

pub(crate) mod discs;
pub(crate) mod fits;
pub(crate) mod moving;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub(crate) struct Folder(tempfile::TempDir);

/// What the program said.
#[derive(Debug, PartialEq)]
pub(crate) struct Answer {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Every file and folder below, with its size.
    pub(crate) fn listing(&self) -> Vec<(PathBuf, u64)> {
        fn walk(folder: &Path, all: &mut Vec<(PathBuf, u64)>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let data = std::fs::symlink_metadata(&path).unwrap();
                all.push((path.clone(), if data.is_dir() { 0 } else { data.len() }));
                if data.is_dir() {
                    walk(&path, all);
                }
            }
        }
        let mut all = Vec::new();
        walk(self.0.path(), &mut all);
        all.sort();
        all
    }

    /// Run the program in this folder.
    pub(crate) fn snake(&self, args: &[&str]) -> Answer {
        self.snake_reading(args, "")
    }

    pub(crate) fn snake_reading(&self, args: &[&str], input: impl AsRef<[u8]>) -> Answer {
        let mut child = Command::new(env!("CARGO_BIN_EXE_snake"))
            .args(args)
            .current_dir(self.0.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // a program that refuses before it has read all closes the pipe
        let _ = child.stdin.take().unwrap().write_all(input.as_ref());
        let output = child.wait_with_output().unwrap();
        Answer {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Run it and expect a refusal: code 2, one line that holds each of `says`, nothing written.
    pub(crate) fn refused(&self, args: &[&str], says: &[&str]) {
        self.refused_reading(args, "", says);
    }

    pub(crate) fn refused_reading(&self, args: &[&str], input: impl AsRef<[u8]>, says: &[&str]) {
        let before = self.listing();
        let answer = self.snake_reading(args, input);
        let about = format!("snake {}: {answer:?}", args.join(" "));
        assert_eq!(answer.code, Some(2), "{about}");
        assert_eq!(answer.out, "", "{about}");
        assert_eq!(answer.err.lines().count(), 1, "{about}");
        assert!(answer.err.len() < 600, "{about}");
        for part in says {
            assert!(answer.err.contains(part), "should say \"{part}\": {about}");
        }
        assert_eq!(self.listing(), before, "{about}");
    }
}

/// A scene of a circle flying through nothing, with each `(line, instead)` replaced.
pub(crate) fn scene(changes: &[(&str, &str)]) -> String {
    let mut text = String::from(
        r#"title = "A test"

[snake]
nodes = 20
topology = "closed"
start = { circle = { center = [30.0, 30.0], radius = 5.0 } }
velocity = [1.0, 0.0]

[material]
tether = 0.1
tension = 1.0
rigidity = 1.0

[densities]
mass = 1.0
damping = 0.1

[run]
dt = 0.01
steps = 5
"#,
    );
    for (line, instead) in changes {
        assert!(text.contains(line), "the scene has no {line}");
        text = text.replace(line, instead);
    }
    text
}

/// A binary PGM of a bright disc on a dark ground, its border softened over a pixel.
pub(crate) fn disc(size: usize, center: [f64; 2], radius: f64) -> Vec<u8> {
    let mut bytes = format!("P5 {size} {size} 255\n").into_bytes();
    for y in 0..size {
        for x in 0..size {
            let (dx, dy) = (x as f64 - center[0], y as f64 - center[1]);
            let share = (radius - dx.hypot(dy) + 0.5).clamp(0.0, 1.0);
            bytes.push((60.0 + 140.0 * share).round() as u8);
        }
    }
    bytes
}

/// A grey TIFF of 32-bit floats, little-endian, one strip.
pub(crate) fn float_tiff(width: u32, height: u32, pixels: &[f32]) -> Vec<u8> {
    let mut bytes = b"II*\0\x08\0\0\0".to_vec();
    let entries: [(u16, u16, u32); 10] = [
        (256, 4, width),
        (257, 4, height),
        (258, 3, 32),
        (259, 3, 1),
        (262, 3, 1),
        (273, 4, 8 + 2 + 10 * 12 + 4),
        (277, 3, 1),
        (278, 4, height),
        (279, 4, width.wrapping_mul(height).wrapping_mul(4)),
        (339, 3, 3),
    ];
    bytes.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, value) in entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(0_u32.to_le_bytes());
    for pixel in pixels {
        bytes.extend(pixel.to_le_bytes());
    }
    bytes
}

/// The head of a PNG that claims a size, and of its pixels, with none behind it.
pub(crate) fn png_head(width: u32, height: u32) -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(width.to_be_bytes());
    chunk.extend(height.to_be_bytes());
    chunk.extend([8, 0, 0, 0, 0]);
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
    bytes.extend(&chunk);
    bytes.extend(crc(&chunk).to_be_bytes());
    bytes.extend(b"\0\0\x40\0IDAT\x78\x9c");
    bytes
}

pub(crate) fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            if c & 1 == 1 {
                (c >> 1) ^ 0xEDB8_8320
            } else {
                c >> 1
            }
        })
    })
}

/// Run a scene of this text, from a file and from standard input.
pub(crate) fn refused(text: impl AsRef<[u8]>, says: &[&str]) {
    let folder = Folder::new();
    folder.write("s.toml", text.as_ref());
    let outputs = ["--record", "r.jsonl", "--out", "o.csv"];
    folder.refused(&[&["run", "s.toml"][..], &outputs].concat(), says);
    folder.refused_reading(&[&["run", "-"][..], &outputs].concat(), text, says);
}

/// The common scene with one line changed is refused.
pub(crate) fn changed(line: &str, instead: &str, says: &[&str]) {
    refused(scene(&[(line, instead)]), says);
}

/// The line of the common scene that gives its start.
pub(crate) const CIRCLE: &str = "start = { circle = { center = [30.0, 30.0], radius = 5.0 } }";
