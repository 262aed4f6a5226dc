//! Sequences as they lie about: with gaps, breaks, other sizes, masks beside, in pages, as videos.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]

use std::path::PathBuf;

use super::*;
use tiff::encoder::{TiffEncoder, colortype};

fn open(inputs: &[PathBuf]) -> Result<Frames, String> {
    Frames::open(inputs, &PictureReading::default()).map_err(|error| error.to_string())
}

/// A grey picture all of one level.
fn grey(level: u8, width: usize) -> Vec<u8> {
    let mut bytes = format!("P5\n{width} 2\n255\n").into_bytes();
    bytes.extend(vec![level; 2 * width]);
    bytes
}

/// The level of a frame at its first pixel.
fn level(frame: &Frame) -> f64 {
    match frame {
        Frame::Picture(picture) => picture.level_at(0, 0),
        Frame::Broken(_) => f64::NAN,
    }
}

fn levels(frames: Frames) -> Vec<f64> {
    frames.map(|one| level(&one.frame).round()).collect()
}

#[test]
fn a_folder_is_read_by_number_without_what_lies_beside() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    for number in [1, 2, 3, 9, 10, 11] {
        write(&format!("f{number}.pgm"), &grey(number, 3));
        write(&format!("f{number}_mask.pgm"), &grey(255, 3));
    }
    write("notes.txt", b"x");
    write(".hidden7.pgm", &grey(7, 3));
    let mut frames = open(&[folder.path().to_owned()]).unwrap();
    let notes = frames.take_notes();
    assert!(
        notes.iter().any(|note| note.contains("6 files are masks")),
        "{notes:?}"
    );
    assert!(
        notes
            .iter()
            .any(|note| note == "missing in the sequence: 4 to 8"),
        "{notes:?}"
    );
    let all: Vec<Numbered> = frames.collect();
    assert_eq!(
        all.iter().map(|one| level(&one.frame)).collect::<Vec<_>>(),
        [1.0, 2.0, 3.0, 9.0, 10.0, 11.0]
    );
    assert_eq!(
        all.iter().map(|one| one.missing).collect::<Vec<_>>(),
        [0, 0, 0, 5, 0, 0]
    );
    assert_eq!((all[3].index, all[3].name.as_str()), (3, "f9.pgm"));
}

#[test]
fn folders_without_a_sequence_and_with_two_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    let error = open(std::slice::from_ref(&path)).unwrap_err();
    assert!(
        error.starts_with(&path.display().to_string()) && error.contains("holds no picture"),
        "{error}"
    );
    std::fs::write(path.join("a.mp4"), b"x").unwrap();
    assert!(
        open(std::slice::from_ref(&path))
            .unwrap_err()
            .contains("a.mp4")
    );
    for name in ["a1", "a2", "b1", "b2"] {
        std::fs::write(path.join(format!("{name}.pgm")), grey(1, 3)).unwrap();
    }
    let error = open(&[path]).unwrap_err();
    assert!(
        error.contains("a1.pgm to a2.pgm (2 files) and b1.pgm to b2.pgm (2 files); needed: "),
        "{error}"
    );
    let error = open(&["no-such-file.png".into()]).unwrap_err();
    assert!(
        error.starts_with("no-such-file.png: cannot be read"),
        "{error}"
    );
}

#[test]
fn a_frame_that_is_broken_or_of_another_size_is_no_end() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("f1.pgm", &grey(1, 3));
    write("f2.pgm", &grey(2, 3)[..12]);
    write("f3.pgm", &grey(3, 4));
    write("f4.pgm", b"");
    write("f5.pgm", &grey(5, 3));
    let all: Vec<Numbered> = open(&[folder.path().to_owned()]).unwrap().collect();
    let said = |at: usize| match &all[at].frame {
        Frame::Broken(reason) => reason.clone(),
        Frame::Picture(_) => "a picture".to_owned(),
    };
    assert!(
        said(1).contains("bytes cannot hold its 3×2 pixels"),
        "{}",
        said(1)
    );
    assert_eq!(
        said(2),
        "has 4×2 pixels and the first frame 3×2; one of the same size is needed"
    );
    assert!(said(3).contains("empty"), "{}", said(3));
    assert!(said(0) == said(4) && (level(&all[4].frame) - 5.0).abs() < 1e-9);
}

#[test]
fn the_first_frame_says_whether_the_sequence_is_in_color() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("g.pgm"), b"P5 1 1 255 \x20").unwrap();
    std::fs::write(at("c.ppm"), b"P6 1 1 255 \x10\x20\x30").unwrap();
    let colors = |names: [&str; 2]| {
        let mut frames = open(&names.map(at)).unwrap();
        let colors: Vec<usize> = frames
            .by_ref()
            .map(|one| match one.frame {
                Frame::Picture(picture) => picture.channels().len(),
                Frame::Broken(reason) => panic!("{reason}"),
            })
            .collect();
        (colors, frames.take_notes().len())
    };
    assert_eq!(colors(["c.ppm", "g.pgm"]), (vec![3, 3], 0));
    assert_eq!(colors(["g.pgm", "c.ppm"]), (vec![1, 1], 1));
}

#[test]
fn files_of_a_shell_are_taken_by_number_and_others_as_they_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = |number: u8| {
        let path = folder.path().join(format!("f{number}.pgm"));
        std::fs::write(&path, grey(number, 3)).unwrap();
        path
    };
    let listed = [file(1), file(10), file(2)];
    assert_eq!(levels(open(&listed).unwrap()), [1.0, 2.0, 10.0]);
    let given = [file(2), file(1), file(10)];
    assert_eq!(levels(open(&given).unwrap()), [2.0, 1.0, 10.0]);
    let mut frames = open(&given[..1]).unwrap();
    assert_eq!(frames.take_notes(), ["the sequence has a single frame"]);
    let mut frames = open(&listed).unwrap();
    frames.pass(2);
    assert_eq!(
        frames.next().map(|one| (one.index, one.name)),
        Some((2, "f10.pgm".to_owned()))
    );
    frames.pass(5);
    assert!(frames.next().is_none());
}

#[test]
fn pages_are_read_one_by_one_whatever_they_hold() {
    let folder = tempfile::tempdir().unwrap();
    for big in [false, true] {
        let path = folder.path().join("stack.tif");
        let mut bytes = std::io::Cursor::new(Vec::new());
        let pages = |page: u16| (0..6).map(|at| 257 * (page + at)).collect::<Vec<u16>>();
        if big {
            let mut encoder = TiffEncoder::new_big(&mut bytes).unwrap();
            for page in 0..20 {
                encoder
                    .write_image::<colortype::Gray16>(3, 2, &pages(page))
                    .unwrap();
            }
        } else {
            let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
            for page in 0..20 {
                encoder
                    .write_image::<colortype::Gray16>(3, 2, &pages(page))
                    .unwrap();
            }
        }
        std::fs::write(&path, bytes.get_ref()).unwrap();
        let mut frames = open(std::slice::from_ref(&path)).unwrap();
        assert_eq!(frames.total(), Some(20));
        frames.pass(3);
        let all: Vec<Numbered> = frames.collect();
        assert_eq!(all.len(), 17);
        for one in &all {
            assert!(
                (level(&one.frame) - one.index as f64).abs() < 1e-9,
                "{one:?}"
            );
        }
        assert_eq!(all[0].name, "stack.tif page 4");
        // several stacks are one after the other
        let twice = open(&[path.clone(), path.clone()]).unwrap();
        assert_eq!((twice.total(), levels(twice).len()), (Some(40), 40));
        // a file that is cut keeps the pages that it has
        std::fs::write(&path, &bytes.get_ref()[..bytes.get_ref().len() / 2]).unwrap();
        if let Ok(cut) = open(&[path]) {
            assert!(cut.take(40).count() <= 20);
        }
    }
}

#[test]
fn pages_in_color_and_in_several_kinds_are_those_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stack.tif");
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for page in 0..4_u8 {
        let pixels: Vec<u8> = (0..2)
            .flat_map(|at| [10 * page, 10 * page + at, 255])
            .collect();
        encoder
            .write_image::<colortype::RGB8>(2, 1, &pixels)
            .unwrap();
    }
    std::fs::write(&path, bytes.get_ref()).unwrap();
    for (k, one) in open(&[path]).unwrap().enumerate() {
        let Frame::Picture(picture) = one.frame else {
            panic!("{one:?}")
        };
        let red = 10.0 * k as f64;
        let own = picture.color_at(1, 0);
        assert!(
            (own[0] - red).abs() < 1e-9 && (own[1] - red - 1.0).abs() < 1e-9,
            "{own:?}"
        );
    }
}

/// A video without loss: grey frames, one behind the other.
fn video(levels: &[u8]) -> Vec<u8> {
    let mut bytes = b"YUV4MPEG2 W16 H8 F25:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n".to_vec();
    for &level in levels {
        bytes.extend(b"FRAME\n");
        bytes.extend([level; 128]);
    }
    bytes
}

#[test]
fn a_video_is_read_by_its_program_or_refused_for_want_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let there = std::process::Command::new(crate::ffmpeg::PROGRAM)
        .arg("-version")
        .output()
        .is_ok();
    // names that could be taken for an option or for a place elsewhere
    for name in ["-i.y4m", "a b;$(x).y4m", "http:x.y4m"] {
        let path = folder.path().join(name);
        std::fs::write(&path, video(&[20, 60, 60, 60, 200])).unwrap();
        match open(std::slice::from_ref(&path)) {
            Ok(frames) => {
                assert!(there && frames.total().is_none());
                let found = levels(frames);
                assert_eq!(found.len(), 5);
                for (found, level) in found.iter().zip([20.0, 60.0, 60.0, 60.0, 200.0]) {
                    assert!((found - level).abs() <= 3.0, "{found} {level}");
                }
            }
            Err(error) => assert!(!there && error.contains("install it"), "{error}"),
        }
    }
    let path = folder.path().join("broken.mp4");
    std::fs::write(&path, b"no video at all").unwrap();
    let error = open(&[path]).unwrap_err();
    let wanted = if there {
        "holds no frame that ffmpeg can read"
    } else {
        "install it"
    };
    assert!(error.contains(wanted), "{error}");
}

#[test]
fn pages_that_are_channels_or_have_no_heads_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stack.tif");
    let write = |said: &str, count: u8| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        for page in 0..count {
            let mut image = encoder.new_image::<colortype::Gray8>(2, 1).unwrap();
            if page == 0 {
                image
                    .encoder()
                    .write_tag(tiff::tags::Tag::ImageDescription, said)
                    .unwrap();
            }
            image.write_data(&[page, page]).unwrap();
        }
        std::fs::write(&path, bytes.get_ref()).unwrap();
    };
    let of = |channel: Option<&str>| {
        let reading = PictureReading {
            channel: channel.map(str::to_owned),
            ..PictureReading::default()
        };
        Frames::open(std::slice::from_ref(&path), &reading).map_err(|error| error.to_string())
    };
    write("ImageJ=1.53\nimages=6\nchannels=2\nframes=3\n", 6);
    let error = of(None).unwrap_err();
    assert!(
        error.contains("holds pages of 2 channels, 1, 2; the name or the number of one is needed"),
        "{error}"
    );
    assert_eq!(levels(of(Some("1")).unwrap()), [0.0, 2.0, 4.0]);
    assert_eq!(levels(of(Some("2")).unwrap()), [1.0, 3.0, 5.0]);
    write("ImageJ=1.53\nimages=6\nslices=2\nframes=3\n", 6);
    assert!(
        of(None)
            .unwrap_err()
            .contains("holds 2 slices at each of 3 moments")
    );
    write("ImageJ=1.53\nimages=6\nslices=6\n", 6);
    assert_eq!(of(None).unwrap().total(), Some(6));
    write("ImageJ=1.53\nimages=900\nframes=900\n", 1);
    assert!(
        of(None)
            .unwrap_err()
            .contains("holds 900 pages behind one head")
    );
}

#[test]
fn files_and_pages_are_read_in_any_order_and_a_stream_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for k in [1_u8, 2, 4] {
        std::fs::write(path(&format!("f{k}.pgm")), grey(10 * k, 3)).unwrap();
    }
    let mut frames = open(&[folder.path().to_owned()]).unwrap();
    for (index, wanted, missing) in [(2, 40.0, 1), (0, 10.0, 0), (1, 20.0, 0), (1, 20.0, 0)] {
        assert!(frames.seek(index));
        let one = frames.next().unwrap();
        assert_eq!(
            (one.index, level(&one.frame).round(), one.missing),
            (index, wanted, missing)
        );
    }
    assert_eq!(frames.next().map(|one| one.index), Some(2));
    assert!(frames.seek(3) && frames.next().is_none());
    let places = ["1", "f4.pgm", "3", "f3.pgm"].map(|text| frames.place_of(text));
    assert_eq!(places, [Some(1), Some(2), None, None]);
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for level in [50_u8, 60, 70] {
        encoder
            .write_image::<colortype::Gray8>(3, 1, &[level; 3])
            .unwrap();
    }
    std::fs::write(path("s.tif"), bytes.into_inner()).unwrap();
    let mut pages = open(&[path("s.tif")]).unwrap();
    for index in [2, 0, 1] {
        assert!(pages.seek(index));
        let one = pages.next().unwrap();
        let wanted = 50.0 + 10.0 * index as f64;
        assert!((level(&one.frame) - wanted).abs() < 0.5);
    }
    let stream = open(&[PathBuf::from("-")]);
    assert!(stream.is_ok_and(|mut stream| !stream.is_seekable() && !stream.seek(1)));
}
