//! What of a picture file is read, as asked for: pages, channels, turns, what counts, how large.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    reason = "a test: numbers in the range of their depth"
)]

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use io::{Picture, PictureReading, PixelSize};
use tiff::encoder::{Rational, TiffEncoder, colortype};
use tiff::tags::{ResolutionUnit, Tag};

const WIDTH: u32 = 9;
const HEIGHT: u32 = 5;

fn page(number: u32) -> PictureReading {
    PictureReading {
        page: Some(number as usize),
        ..PictureReading::default()
    }
}

fn channel(name: &str) -> PictureReading {
    PictureReading {
        channel: Some(name.to_owned()),
        ..PictureReading::default()
    }
}

/// Several grey pages, each of one level, with a description on the first.
fn pages(count: u8, description: &str) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new_big(&mut bytes).unwrap();
    for number in 1..=count {
        let mut image = encoder
            .new_image::<colortype::Gray8>(WIDTH, HEIGHT)
            .unwrap();
        if number == 1 {
            let tags = image.encoder();
            tags.write_tag(Tag::ImageDescription, description).unwrap();
        }
        image.x_resolution(Rational { n: 4, d: 1 });
        image.y_resolution(Rational { n: 2, d: 1 });
        image.resolution_unit(ResolutionUnit::None);
        let list = vec![number * 10; (WIDTH * HEIGHT) as usize];
        image.write_data(&list).unwrap();
    }
    bytes.into_inner()
}

fn level(bytes: &[u8], rule: &PictureReading) -> f64 {
    let picture = Picture::decode_as(bytes, rule).unwrap();
    assert_eq!(picture.size(), (WIDTH as usize, HEIGHT as usize));
    picture.level_at(3, 2)
}

#[test]
#[allow(clippy::float_cmp, reason = "levels of eight bits are exact")]
fn pages_and_channels_that_are_pages_are_found() {
    let plain = pages(6, "nothing");
    for number in 1..=6 {
        assert_eq!(level(&plain, &page(number)), f64::from(number * 10));
    }
    for number in [0, 7] {
        let refused = Picture::decode_as(&plain, &page(number)).unwrap_err();
        assert!(
            refused.contains(&format!("page {number} is asked for")),
            "{refused}"
        );
    }
    let imagej = pages(
        6,
        "ImageJ=1.54f\nimages=6\nchannels=3\nslices=2\nunit=micron\n",
    );
    let ome = pages(
        6,
        r#"<?xml version="1.0"?><OME><Image><Pixels DimensionOrder="XYCZT" SizeC="3" PhysicalSizeX="0.25" PhysicalSizeY="0.5">
        <Channel Name="DAPI"/><Channel Name="GFP"/><Channel Name="RFP"/></Pixels></Image></OME>"#,
    );
    for (bytes, name) in [(&imagej, "2"), (&ome, "2"), (&ome, "gfp")] {
        assert_eq!(level(bytes, &channel(name)), 20.0);
        let second = PictureReading {
            page: Some(2),
            ..channel(name)
        };
        assert_eq!(level(bytes, &second), 50.0);
        let size = Picture::decode(bytes).unwrap().pixel_size().cloned();
        let unit = "micron".to_owned();
        assert_eq!(
            size,
            Some(PixelSize {
                x: 0.25,
                y: 0.5,
                unit
            })
        );
    }
    let refused = Picture::decode_as(&ome, &channel("Cy5")).unwrap_err();
    assert!(
        refused.contains("the channels are DAPI, GFP, RFP (3)"),
        "{refused}"
    );
}

/// Colors with an alpha of 0 at (1, 0), 1 at (2, 0) and 255 elsewhere.
fn colors() -> RgbaImage {
    RgbaImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let alpha = if y == 0 && x == 1 {
            0
        } else if y == 0 && x == 2 {
            1
        } else {
            255
        };
        Rgba([10 * x as u8, 20 * y as u8, 7, alpha])
    })
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

#[test]
#[allow(clippy::float_cmp, reason = "levels of eight bits are exact")]
fn channels_of_colors_are_read_alone_and_what_is_transparent_does_not_count() {
    let image = DynamicImage::ImageRgba8(colors());
    for format in [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::WebP] {
        let bytes = encoded(&image, format);
        let picture = Picture::decode(&bytes).unwrap();
        assert!(picture.is_color(), "{format:?}");
        let valid = picture.valid().unwrap();
        let out: Vec<_> = valid
            .indexed_iter()
            .filter(|(_, ok)| !**ok)
            .map(|(at, _)| at)
            .collect();
        assert_eq!(out, [(0, 1)], "{format:?}");
        for (name, value) in [("red", 30.0), ("2", 40.0), ("Blue", 7.0)] {
            let one = Picture::decode_as(&bytes, &channel(name)).unwrap();
            assert!(!one.is_color());
            assert_eq!(one.level_at(3, 2), value, "{format:?} {name}");
        }
        assert!(Picture::decode_as(&bytes, &channel("infrared")).is_err());
    }
    let clear = RgbaImage::from_pixel(WIDTH, HEIGHT, Rgba([1, 2, 3, 0]));
    let picture =
        Picture::decode(&encoded(&DynamicImage::ImageRgba8(clear), ImageFormat::Png)).unwrap();
    assert!(picture.valid().is_none());
    assert!(
        picture
            .notes()
            .iter()
            .any(|note| note.contains("all pixels are transparent"))
    );
}

#[test]
#[allow(clippy::float_cmp, reason = "levels of eight bits are exact")]
fn a_later_page_in_color_and_a_palette_are_read() {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for page in 1..=2_u8 {
        let list: Vec<u8> = (0..WIDTH * HEIGHT)
            .flat_map(|i| [page, i as u8, 9])
            .collect();
        encoder
            .write_image::<colortype::RGB8>(WIDTH, HEIGHT, &list)
            .unwrap();
    }
    let bytes = bytes.into_inner();
    let picture = Picture::decode_as(&bytes, &page(2)).unwrap();
    let grid = picture.channels();
    assert_eq!(
        (grid[0][[2, 3]], grid[1][[2, 3]], grid[2][[2, 3]]),
        (2.0, 21.0, 9.0)
    );

    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder
        .new_image::<colortype::Gray8>(WIDTH, HEIGHT)
        .unwrap();
    let map: Vec<u16> = (0..3_u16)
        .flat_map(|c| (0..256_u16).map(move |i| 257 * (i * (c + 1) % 256)))
        .collect();
    let tags = image.encoder();
    tags.write_tag(Tag::ColorMap, &map[..]).unwrap();
    tags.write_tag(Tag::PhotometricInterpretation, 3_u16)
        .unwrap();
    let list: Vec<u8> = (0..WIDTH * HEIGHT).map(|i| i as u8).collect();
    image.write_data(&list).unwrap();
    let picture = Picture::decode(&bytes.into_inner()).unwrap();
    let grid = picture.channels();
    assert_eq!(
        (grid[0][[2, 3]], grid[1][[2, 3]], grid[2][[2, 3]]),
        (21.0, 42.0, 63.0)
    );
}

#[test]
#[allow(clippy::float_cmp, reason = "levels of eight bits are exact")]
fn floats_of_a_portable_map_come_in_either_order_from_the_lowest_row_on() {
    let value = |x: u32, y: u32| (x + 10 * y) as f32 / 64.0;
    for (scale, little) in [("-1.0", true), ("1", false)] {
        let mut bytes = format!("Pf\n{WIDTH} {HEIGHT}\n{scale}\n").into_bytes();
        for y in (0..HEIGHT).rev() {
            for x in 0..WIDTH {
                let v = value(x, y);
                bytes.extend(if little {
                    v.to_le_bytes()
                } else {
                    v.to_be_bytes()
                });
            }
        }
        let picture = Picture::decode(&bytes).unwrap();
        assert_eq!(picture.level_at(3, 2), f64::from(value(3, 2)) * 255.0);
        assert!(Picture::decode(&bytes[..bytes.len() - 1]).is_err());
    }
}

/// A chunk of a PNG put behind its head.
fn with_chunk(png: &[u8], name: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let mut out = png[..33].to_vec();
    out.extend(u32::try_from(body.len()).unwrap().to_be_bytes());
    out.extend(name);
    out.extend(body);
    out.extend([0; 4]); // its sum, which is not looked at
    out.extend(&png[33..]);
    out
}

#[test]
fn a_png_says_how_large_its_pixels_are_and_is_turned_unless_asked_not_to() {
    let png = encoded(&DynamicImage::new_luma8(WIDTH, HEIGHT), ImageFormat::Png);
    let body = [4000_u32.to_be_bytes(), 8000_u32.to_be_bytes()].concat();
    let png = with_chunk(&png, b"pHYs", &[&body[..], &[1]].concat());
    // turned by a quarter: one entry, tag 274, a short of 6
    let exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let png = with_chunk(&png, b"eXIf", exif);
    let picture = Picture::decode(&png).unwrap();
    assert_eq!(picture.size(), (HEIGHT as usize, WIDTH as usize));
    let size = |x: f64, y: f64| PixelSize {
        x,
        y,
        unit: "m".to_owned(),
    };
    assert_eq!(
        picture.pixel_size(),
        Some(&size(1.0 / 8000.0, 1.0 / 4000.0))
    );
    let as_stored = PictureReading {
        as_stored: true,
        ..PictureReading::default()
    };
    let picture = Picture::decode_as(&png, &as_stored).unwrap();
    assert_eq!(picture.size(), (WIDTH as usize, HEIGHT as usize));
    assert_eq!(
        picture.pixel_size(),
        Some(&size(1.0 / 4000.0, 1.0 / 8000.0))
    );
}

#[test]
fn what_is_cut_or_changed_never_stops_the_program() {
    let image = DynamicImage::ImageRgba8(colors());
    let ome = r#"<OME><Pixels DimensionOrder="XYCZT"><Channel/><Channel/></Pixels></OME>"#;
    let files = [
        encoded(&image, ImageFormat::WebP),
        encoded(&image, ImageFormat::Tiff),
        pages(3, ome),
        [b"PF\n9 5\n-1\n".to_vec(), vec![0; 540]].concat(),
    ];
    for bytes in files {
        for at in 0..bytes.len() {
            let _ = Picture::decode_as(&bytes[..at], &PictureReading::default());
            for flip in [1, 0x80, 0xff] {
                let mut other = bytes.clone();
                other[at] ^= flip;
                let _ = Picture::decode_as(&other, &channel("2"));
                let _ = Picture::decode_as(&other, &page(2));
            }
        }
    }
}

#[test]
fn pages_are_counted_as_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let count = |bytes: &[u8], channel| {
        let path = folder.path().join("stack");
        std::fs::write(&path, bytes).unwrap();
        Picture::pages(&path, channel).unwrap()
    };
    assert_eq!(count(&pages(7, "a stack"), None), 7);
    assert_eq!(count(&pages(1, "a page"), None), 1);
    let stack = pages(
        6,
        "ImageJ=1.54f\nimages=6\nchannels=2\nframes=3\nhyperstack=true\n",
    );
    assert_eq!([count(&stack, None), count(&stack, Some("2"))], [6, 3]);
    let last = PictureReading {
        page: Some(3),
        ..channel("2")
    };
    assert_eq!(level(&stack, &last).to_bits(), 60.0_f64.to_bits());
    assert_eq!(count(b"P2 1 1 255 7", None), 1);
    let mut cut = pages(7, "a stack");
    cut.truncate(cut.len() / 2);
    let path = folder.path().join("cut.tif");
    std::fs::write(&path, cut).unwrap();
    assert!(Picture::pages(&path, None).is_err());
    assert!(Picture::pages(&folder.path().join("none"), None).is_err());
}
