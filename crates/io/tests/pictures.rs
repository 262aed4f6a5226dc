//! The same picture in every format and depth gives the same grey levels.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: numbers in the range of their depth"
)]

use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, Rgba};
use io::Picture;
use tiff::encoder::{TiffEncoder, colortype};

const WIDTH: u32 = 17;
const HEIGHT: u32 = 11;

/// A level of 16 bits at each pixel: a slope with a step in it, using the whole range.
fn deep(x: u32, y: u32) -> u16 {
    let slope = (x * 65535 / (WIDTH - 1) + y * 977) % 65536;
    slope as u16
}

/// The same in 8 bits.
fn flat(x: u32, y: u32) -> u8 {
    (deep(x, y) / 257) as u8
}

/// An alpha that must not matter.
fn alpha(x: u32, y: u32) -> u16 {
    ((x + y) * 2000) as u16
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// Largest difference of a picture's levels from those of `level`.
fn off(what: &str, bytes: &[u8], level: impl Fn(u32, u32) -> f64) -> f64 {
    let picture = Picture::decode(bytes).unwrap_or_else(|error| unreachable!("{what}: {error}"));
    assert_eq!(picture.size(), (WIDTH as usize, HEIGHT as usize), "{what}");
    assert_eq!(picture.display().dimensions(), (WIDTH, HEIGHT), "{what}");
    let mut worst = 0.0_f64;
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            worst = worst.max((picture.levels()[[y as usize, x as usize]] - level(x, y)).abs());
        }
    }
    worst
}

fn pixels<P: image::Pixel>(pixel: impl Fn(u32, u32) -> P) -> ImageBuffer<P, Vec<P::Subpixel>> {
    ImageBuffer::from_fn(WIDTH, HEIGHT, pixel)
}

#[test]
fn grey_of_eight_bits_is_the_same_in_every_form() {
    let level = |x, y| f64::from(flat(x, y));
    let a = |x, y| alpha(x, y) as u8;
    let forms: [(&str, DynamicImage); 4] = [
        ("grey", pixels(|x, y| Luma([flat(x, y)])).into()),
        (
            "grey with alpha",
            pixels(|x, y| LumaA([flat(x, y), a(x, y)])).into(),
        ),
        ("colour", pixels(|x, y| Rgb([flat(x, y); 3])).into()),
        (
            "colour with alpha",
            pixels(|x, y| {
                let v = flat(x, y);
                Rgba([v, v, v, a(x, y)])
            })
            .into(),
        ),
    ];
    for (what, image) in &forms {
        for format in [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Pnm] {
            if format == ImageFormat::Tiff && *what == "grey with alpha" {
                continue; // nothing here writes those
            }
            let off = off(
                &format!("{what} {format:?}"),
                &encoded(image, format),
                level,
            );
            assert!(off == 0.0, "{what} {format:?} is off by {off}");
        }
    }
    for (what, image) in [&forms[0], &forms[2]] {
        let mut bytes = Vec::new();
        let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 100);
        image.write_with_encoder(encoder).unwrap();
        // lossy: at the best quality each of 64 coefficients is off by half at most, 4 in all
        let off = off(&format!("{what} JPEG"), &bytes, level);
        assert!(off <= 4.0, "{what} JPEG is off by {off}");
    }
}

#[test]
fn grey_of_sixteen_bits_and_floats_is_the_same_in_every_form() {
    let level = |x, y| f64::from(deep(x, y)) / 257.0;
    let float = |x, y| f32::from(deep(x, y)) / 65535.0;
    let forms: [(&str, DynamicImage, &[ImageFormat]); 6] = [
        (
            "grey",
            pixels(|x, y| Luma([deep(x, y)])).into(),
            &[ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Pnm],
        ),
        (
            "grey with alpha",
            pixels(|x, y| LumaA([deep(x, y), alpha(x, y)])).into(),
            &[ImageFormat::Png],
        ),
        (
            "colour",
            pixels(|x, y| Rgb([deep(x, y); 3])).into(),
            &[ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Pnm],
        ),
        (
            "colour with alpha",
            pixels(|x, y| {
                let v = deep(x, y);
                Rgba([v, v, v, alpha(x, y)])
            })
            .into(),
            &[ImageFormat::Png, ImageFormat::Tiff],
        ),
        (
            "colour of floats",
            pixels(|x, y| Rgb([float(x, y); 3])).into(),
            &[ImageFormat::Tiff],
        ),
        (
            "colour of floats with alpha",
            pixels(|x, y| {
                let v = float(x, y);
                Rgba([v, v, v, 0.5])
            })
            .into(),
            &[ImageFormat::Tiff],
        ),
    ];
    for (what, image, formats) in &forms {
        for format in *formats {
            let off = off(
                &format!("{what} {format:?}"),
                &encoded(image, *format),
                level,
            );
            // half a step of 16 bits
            assert!(off <= 0.5 / 257.0, "{what} {format:?} is off by {off}");
        }
    }
}

#[test]
fn grey_tiffs_of_floats_are_read_as_well() {
    let level = |x, y| f64::from(deep(x, y)) / 257.0;
    let all = || (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| f64::from(deep(x, y)) / 65535.0));
    let mut bytes = Cursor::new(Vec::new());
    let single: Vec<f32> = all().map(|v| v as f32).collect();
    TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<colortype::Gray32Float>(WIDTH, HEIGHT, &single)
        .unwrap();
    let off32 = off("floats of 32 bits", bytes.get_ref(), level);
    assert!(off32 <= 0.5 / 257.0, "off by {off32}");
    let mut bytes = Cursor::new(Vec::new());
    let double: Vec<f64> = all().collect();
    TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<colortype::Gray64Float>(WIDTH, HEIGHT, &double)
        .unwrap();
    let off64 = off("floats of 64 bits", bytes.get_ref(), level);
    assert!(off64 <= 1e-12, "off by {off64}");
    let mut bytes = Cursor::new(Vec::new());
    let whole: Vec<u32> = single.iter().map(|v| (v * 4e9) as u32).collect();
    TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<colortype::Gray32>(WIDTH, HEIGHT, &whole)
        .unwrap();
    let level = |x, y| f64::from(whole[(y * WIDTH + x) as usize]) / 16_843_009.0;
    let off32 = off("whole numbers of 32 bits", bytes.get_ref(), level);
    assert!(off32 <= 1e-12, "off by {off32}");
    let mut bytes = Cursor::new(Vec::new());
    TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<colortype::Gray64>(WIDTH, HEIGHT, &vec![1; single.len()])
        .unwrap();
    let refused = Picture::decode(bytes.get_ref()).unwrap_err();
    assert!(refused.contains("whole numbers of 64 bits"), "{refused}");
}

#[test]
fn portable_maps_are_read_by_hand_written_text_and_any_largest_value() {
    let text = |head: &str, each: &dyn Fn(u32, u32) -> String| {
        let mut text = format!("{head}\n# a comment\n{WIDTH} {HEIGHT}\n");
        text.push_str(if head == "P1" { "" } else { "15\n" });
        for y in 0..HEIGHT {
            let line: Vec<String> = (0..WIDTH).map(|x| each(x, y)).collect();
            text.push_str(&line.join(" "));
            text.push('\n');
        }
        text.into_bytes()
    };
    let level = |x: u32, y: u32| f64::from((x + y) % 16) * 17.0;
    let grey = text("P2", &|x, y| ((x + y) % 16).to_string());
    assert!(off("P2", &grey, level) == 0.0);
    let colour = text("P3", &|x, y| {
        let v = (x + y) % 16;
        format!("{v} {v} {v}")
    });
    assert!(off("P3", &colour, level) == 0.0);
    let bits = text("P1", &|x, y| ((x + y) % 2).to_string());
    // one is black
    assert!(off("P1", &bits, |x, y| f64::from(1 - (x + y) % 2) * 255.0) == 0.0);
}

#[test]
fn colour_becomes_grey_by_the_usual_weights_at_any_depth() {
    let level = |x: u32, y: u32| {
        0.299 * f64::from(flat(x, y))
            + 0.587 * f64::from(flat(y, x))
            + 0.114 * f64::from(255 - flat(x, y))
    };
    let rgb = |x, y| [flat(x, y), flat(y, x), 255 - flat(x, y)];
    let shallow: DynamicImage = pixels(|x, y| Rgb(rgb(x, y))).into();
    let deep: DynamicImage = pixels(|x, y| Rgb(rgb(x, y).map(|v| u16::from(v) * 257))).into();
    let float: DynamicImage = pixels(|x, y| Rgb(rgb(x, y).map(|v| f32::from(v) / 255.0))).into();
    for (what, image, format, most) in [
        ("8 bits", &shallow, ImageFormat::Png, 1e-12),
        ("8 bits", &shallow, ImageFormat::Tiff, 1e-12),
        ("8 bits", &shallow, ImageFormat::Pnm, 1e-12),
        ("16 bits", &deep, ImageFormat::Png, 1e-12),
        ("16 bits", &deep, ImageFormat::Tiff, 1e-12),
        // a float has 24 bits
        ("floats", &float, ImageFormat::Tiff, 255.0 * 6e-8),
    ] {
        let off = off(what, &encoded(image, format), level);
        assert!(off <= most, "{what} {format:?} is off by {off}");
    }
}
