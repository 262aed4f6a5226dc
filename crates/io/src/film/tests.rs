//! Films read back, frame by frame.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]

use super::*;
use crate::frames::{Frame, Frames};
use crate::paint::{OBJECTS, draw_curve};
use image::{AnimationDecoder as _, Rgb};

/// A ground, in grey or in color, with a bar of an object's color that moves.
fn frame(k: u32, color: bool) -> RgbImage {
    let mut image = RgbImage::from_fn(40, 30, |x, y| {
        let level = u8::try_from(5 * x).unwrap();
        Rgb(if color {
            [level, u8::try_from(8 * y).unwrap(), 255 - level]
        } else {
            [level; 3]
        })
    });
    let x = f64::from(5 + 4 * k);
    draw_curve(
        &mut image,
        &[DVec2::new(x, 5.0), DVec2::new(x, 24.0)],
        false,
        3.0,
        OBJECTS[1],
    );
    image
}

fn film(path: &Path, format: FilmFormat, color: bool) -> Result<(), IoError> {
    let mut film = Film::begin(path, format, (40, 30), 8, color)?;
    for k in [0, 1, 1, 5] {
        film.show(&frame(k, color))?;
    }
    film.end()
}

/// The largest difference of two pictures in a channel, but for pixels whose neighbours differ.
fn off(a: &RgbImage, b: &RgbImage) -> i32 {
    let each = a.as_raw().iter().zip(b.as_raw());
    each.map(|(&a, &b)| (i32::from(a) - i32::from(b)).abs())
        .max()
        .unwrap()
}

fn gif_frames(bytes: &[u8]) -> Vec<RgbImage> {
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let (mut canvas, mut all) = (RgbImage::new(40, 30), Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (at, pixel) in frame.buffer.chunks(4).enumerate() {
            let at = u32::try_from(at).unwrap();
            let (x, y) = (at % u32::from(frame.width), at / u32::from(frame.width));
            if pixel[3] > 0 {
                let (x, y) = (x + u32::from(frame.left), y + u32::from(frame.top));
                canvas.put_pixel(x, y, Rgb([pixel[0], pixel[1], pixel[2]]));
            }
        }
        all.push(canvas.clone());
    }
    all
}

#[test]
fn a_gif_has_its_greys_and_the_colors_of_objects() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    film(&path, FilmFormat::Gif, false).unwrap();
    let frames = gif_frames(&std::fs::read(&path).unwrap());
    assert_eq!(frames.len(), 4);
    for (read, k) in frames.iter().zip([0, 1, 1, 5]) {
        let given = frame(k, false);
        assert_eq!(read.get_pixel(5 + 4 * k, 15).0, OBJECTS[1]);
        // greys in steps of 255/199, and half of a color where a line's border covers a share
        let greys = |image: &RgbImage| {
            image
                .enumerate_pixels()
                .filter(|(x, ..)| x.abs_diff(5 + 4 * k) > 3)
                .map(|(.., p)| p.0[0])
                .collect::<Vec<u8>>()
        };
        let most = greys(read)
            .iter()
            .zip(greys(&given))
            .map(|(&a, b)| a.abs_diff(b))
            .max()
            .unwrap();
        assert!(most <= 1, "{most}");
    }
    film(&path, FilmFormat::Gif, true).unwrap();
    let frames = gif_frames(&std::fs::read(&path).unwrap());
    for (read, k) in frames.iter().zip([0, 1, 1, 5]) {
        assert_eq!(read.get_pixel(5 + 4 * k, 15).0, OBJECTS[1]);
        // by steps of 51 each, dithered: the means agree
        let mean = |image: &RgbImage, c: usize| {
            image.pixels().map(|p| f64::from(p.0[c])).sum::<f64>() / 1200.0
        };
        for c in 0..3 {
            assert!((mean(read, c) - mean(&frame(k, true), c)).abs() < 3.0);
        }
        assert!(off(read, &frame(k, true)) <= 52);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn an_animated_png_is_read_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    film(&path, FilmFormat::Apng, true).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(&bytes)).unwrap();
    let frames = decoder
        .apng()
        .unwrap()
        .into_frames()
        .collect_frames()
        .unwrap();
    assert_eq!(frames.len(), 4);
    for (read, k) in frames.iter().zip([0, 1, 1, 5]) {
        let read = image::DynamicImage::ImageRgba8(read.buffer().clone()).into_rgb8();
        assert_eq!(off(&read, &frame(k, true)), 0, "{k}");
    }
    // to those who know nothing of it, its first frame
    let still = crate::Picture::load(&path).unwrap();
    assert_eq!(off(still.display(), &frame(0, true)), 0);
}

#[test]
fn a_video_has_every_frame_or_is_refused_for_want_of_its_program() {
    let folder = tempfile::tempdir().unwrap();
    let there = std::process::Command::new(crate::ffmpeg::PROGRAM)
        .arg("-version")
        .output()
        .is_ok();
    for name in ["a.mp4", "-b c.mkv"] {
        let path = folder.path().join(name);
        match film(&path, FilmFormat::Video, false) {
            Ok(()) => {
                assert!(there);
                let frames = Frames::open(&[path], &crate::PictureReading::default()).unwrap();
                let all: Vec<_> = frames.collect();
                assert_eq!(all.len(), 4);
                for (one, k) in all.iter().zip([0, 1, 1, 5]) {
                    let Frame::Picture(picture) = &one.frame else {
                        panic!("{one:?}")
                    };
                    let mean = |image: &RgbImage| {
                        let column = image
                            .enumerate_pixels()
                            .filter(|(x, y, _)| *x == 5 + 4 * k && (8..20).contains(y));
                        column.map(|(.., p)| f64::from(p.0[2])).sum::<f64>() / 12.0
                    };
                    assert!(
                        (mean(picture.display()) - 233.0).abs() < 40.0,
                        "{}",
                        mean(picture.display())
                    );
                }
            }
            Err(error) => {
                assert!(
                    !there && error.to_string().contains("install it"),
                    "{error}"
                );
                assert!(!path.exists());
            }
        }
    }
}

#[test]
fn what_is_no_film_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format) in [("a.gif", FilmFormat::Gif), ("a.png", FilmFormat::Apng)] {
        let path = folder.path().join(name);
        assert!(Film::begin(&path, format, (0, 3), 8, false).is_err());
        assert!(
            Film::begin(&path, format, (4, 3), 8, false)
                .unwrap()
                .end()
                .is_err()
        );
        let mut film = Film::begin(&path, format, (4, 3), 8, false).unwrap();
        assert!(
            film.show(&RgbImage::new(3, 4))
                .unwrap_err()
                .to_string()
                .contains("3×4")
        );
        drop(film);
        assert!(Film::begin(&folder.path().join("no/such.gif"), format, (4, 3), 8, false).is_err());
    }
    assert!(Film::begin(Path::new("/dev/null"), FilmFormat::Apng, (4, 3), 8, false).is_err());
    assert!(
        Film::begin(
            &folder.path().join("b.gif"),
            FilmFormat::Gif,
            (70_000, 3),
            8,
            false
        )
        .is_err()
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert_eq!(
        FilmFormat::by_ending(Path::new("a.MP4")),
        Some(FilmFormat::Video)
    );
    assert_eq!(FilmFormat::by_ending(Path::new("a.avi")), None);
}

#[test]
fn dashes_are_as_long_as_asked_for() {
    let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from);
    let pieces = dashes(&square, true, 3.0, 2.0);
    assert_eq!(pieces.len(), 8);
    let length = |piece: &Vec<DVec2>| {
        piece
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum::<f64>()
    };
    for piece in &pieces {
        assert!((length(piece) - 3.0).abs() < 1e-9, "{piece:?}");
    }
    assert!(pieces.iter().any(|piece| piece.len() > 2));
    assert!(dashes(&[], true, 3.0, 2.0).is_empty());
    assert!(dashes(&square[..1], true, 3.0, 2.0).is_empty());
}
