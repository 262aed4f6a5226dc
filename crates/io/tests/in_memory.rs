//! What lies in memory is read as the same bytes in a file are, messages included.

#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::path::Path;

use io::shapes::{self, Context, Format, Reading, Shape};
use io::{Picture, PictureReading};

/// A triangle, a way that a name may end in, and the bytes of the format.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let points = [(4.5, 3.0), (20.0, 5.0), (11.0, 17.25)];
    let shape = Shape::curve(
        points.map(|(x, y)| glam::DVec2::new(x, y)).to_vec(),
        Some(true),
    );
    let context = Context {
        picture: Some("seen.png".to_owned()),
        width: 24,
        height: 20,
        ..Context::default()
    };
    let formats = [
        ("a.csv", Format::Csv),
        ("a.geojson", Format::GeoJson),
        ("a.coco.json", Format::Coco),
        ("a.zip", Format::ImageJ),
        ("a.roi", Format::ImageJ),
        ("a.svg", Format::Svg),
        ("a.json", Format::Labelme),
        ("a.png", Format::Mask),
        ("b.png", Format::Labels),
        ("b.tif", Format::DeepLabels),
    ];
    let written = formats.map(|(name, format)| {
        (
            name,
            shapes::write(std::slice::from_ref(&shape), format, &context).unwrap(),
        )
    });
    let broken = [
        ("cut.csv", &b"x,y\n1,2\n3\n"[..]),
        ("none.roi", b"x,y\n1,2\n3,4\n"),
        ("empty.json", b""),
        ("cut.png", b"\x89PNG\r\n\x1a\n"),
        ("latin.csv", b"x,y\n1,2\n\xe4,4\n"),
    ];
    let broken = broken.map(|(name, bytes)| (name, bytes.to_vec()));
    written.into_iter().chain(broken).collect()
}

/// What is said of an outcome, with the names of files without their folder.
fn said<T: std::fmt::Debug>(outcome: Result<T, io::IoError>, folder: &Path) -> String {
    match outcome {
        Ok(found) => format!("{found:?}"),
        Err(error) => error
            .to_string()
            .replace(&format!("{}/", folder.display()), ""),
    }
}

#[test]
fn outlines_in_memory_are_those_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut refused = 0;
    for (name, bytes) in files() {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let reading = Reading::default();
        let there = said(shapes::load_noted(&path, &reading), folder.path());
        let here = said(
            shapes::parse_named(&bytes, Path::new(name), &reading),
            folder.path(),
        );
        assert_eq!(here, there, "{name}");
        let there = said(shapes::load_one(&path), folder.path());
        let here = said(
            shapes::parse_one_named(&bytes, Path::new(name)),
            folder.path(),
        );
        assert_eq!(here, there, "{name}");
        refused += usize::from(here.starts_with(&format!("{name}: ")));
    }
    assert_eq!(refused, 5, "those that are broken, by their names");
}

#[test]
fn pictures_in_memory_are_those_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut read = 0;
    for (name, bytes) in files() {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let rule = PictureReading::default();
        let levels = |picture: Picture| picture.levels().clone();
        let there = Picture::load_as(&path, &rule).map(levels);
        read += usize::from(there.is_ok());
        let here = Picture::decode_named(&bytes, Path::new(name), &rule).map(levels);
        assert_eq!(
            said(here, folder.path()),
            said(there, folder.path()),
            "{name}"
        );
        let there = said(Picture::pages(&path, None), folder.path());
        let here = said(
            Picture::pages_named(&bytes, Path::new(name), None),
            folder.path(),
        );
        assert_eq!(here, there, "{name}");
    }
    assert_eq!(read, 3, "a mask and two pictures of labels");
}
