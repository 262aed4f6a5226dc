//! Pictures as they are stored: turned, cut, in pages, claiming more than they hold.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common;

use crate::common::{Folder, disc, float_tiff};

const WIDTH: usize = 24;
const HEIGHT: usize = 16;

/// A contour within the picture.
const AROUND: &str = "4,8\n12,3\n20,8\n12,13\n";

/// A level that no turn or mirror image of the picture has at the same place.
fn level(x: usize, y: usize) -> u8 {
    (10 * x + 3 * y + if x > 8 && y < 5 { 60 } else { 0 }) as u8 & 0x7F
}

/// The same as stored under an orientation of EXIF: what is read there must be turned back.
fn stored(orientation: u16) -> (usize, usize, Vec<u8>) {
    let (w, h) = if orientation > 4 {
        (HEIGHT, WIDTH)
    } else {
        (WIDTH, HEIGHT)
    };
    let mut pixels = Vec::new();
    for row in 0..h {
        for column in 0..w {
            // by the table of TIFF 6.0: where the 0th row and the 0th column are seen
            let (x, y) = match orientation {
                1 => (column, row),
                2 => (w - 1 - column, row),
                3 => (w - 1 - column, h - 1 - row),
                4 => (column, h - 1 - row),
                5 => (row, column),
                6 => (h - 1 - row, column),
                7 => (h - 1 - row, w - 1 - column),
                _ => (row, w - 1 - column),
            };
            pixels.push(level(x, y));
        }
    }
    (w, h, pixels)
}

/// Bytes of EXIF that say an orientation.
fn exif(orientation: u16) -> Vec<u8> {
    let mut bytes = b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01".to_vec();
    bytes.extend(orientation.to_be_bytes());
    bytes.extend([0; 6]);
    bytes
}

/// A grey TIFF of eight bits.
fn tiff(orientation: u16) -> Vec<u8> {
    let (w, h, pixels) = stored(orientation);
    let entries: [(u16, u16, u32); 9] = [
        (256, 4, w as u32),
        (257, 4, h as u32),
        (258, 3, 8),
        (259, 3, 1),
        (262, 3, 1),
        (273, 4, 8 + 2 + 9 * 12 + 4),
        (274, 3, u32::from(orientation)),
        (278, 4, h as u32),
        (279, 4, (w * h) as u32),
    ];
    let mut bytes = b"II*\0\x08\0\0\0".to_vec();
    bytes.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, value) in entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(0_u32.to_le_bytes());
    bytes.extend(pixels);
    bytes
}

fn chunk(name: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let mut bytes = (body.len() as u32).to_be_bytes().to_vec();
    let named = [&name[..], body].concat();
    bytes.extend(&named);
    bytes.extend(common::crc(&named).to_be_bytes());
    bytes
}

/// A grey PNG of eight bits, its pixels stored as they are.
fn png(w: usize, h: usize, pixels: &[u8], more: &[u8]) -> Vec<u8> {
    let mut head = (w as u32).to_be_bytes().to_vec();
    head.extend((h as u32).to_be_bytes());
    head.extend([8, 0, 0, 0, 0]);
    let rows = pixels.chunks(w).flat_map(|row| [&[0][..], row].concat());
    let rows: Vec<u8> = rows.collect();
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in &rows {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    let length = rows.len() as u16;
    let mut data = vec![0x78, 0x01, 0x01];
    data.extend(length.to_le_bytes());
    data.extend((!length).to_le_bytes());
    data.extend(rows);
    data.extend(((b << 16) | a).to_be_bytes());
    let parts = [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &head),
        more.to_vec(),
        chunk(b"IDAT", &data),
        chunk(b"IEND", b""),
    ];
    parts.concat()
}

/// Fit in the picture; the contour found and what was said.
fn fit(name: &str, bytes: &[u8]) -> common::Answer {
    let folder = Folder::new();
    folder.write(name, bytes);
    folder.write("c.csv", AROUND);
    folder.snake(&["fit", name, "--from", "c.csv", "--steps", "20"])
}

#[test]
fn a_picture_that_is_stored_turned_is_seen_upright() {
    let (w, h, pixels) = stored(1);
    let plain = fit("a.png", &png(w, h, &pixels, b""));
    assert!(plain.out.contains("# contour 1"), "{plain:?}");
    assert!(!plain.err.contains("turned"), "{plain:?}");
    for orientation in 1..=8 {
        let (w, h, pixels) = stored(orientation);
        let exif = chunk(b"eXIf", &exif(orientation));
        for (name, bytes) in [
            ("a.png", png(w, h, &pixels, &exif)),
            ("a.tif", tiff(orientation)),
        ] {
            let answer = fit(name, &bytes);
            assert_eq!(answer.out, plain.out, "{name} of orientation {orientation}");
            let said = answer
                .err
                .contains(&format!("turned (orientation {orientation})"));
            assert_eq!(said, orientation > 1, "{answer:?}");
        }
    }
}

/// A JPEG of one grey level: a disc does not matter to what it holds.
fn jpeg(w: u16, h: u16, coded: &[u8]) -> Vec<u8> {
    let mut bytes = b"\xff\xd8\xff\xdb\0\x43\0".to_vec();
    bytes.extend([1; 64]);
    bytes.extend(b"\xff\xc0\0\x0b\x08");
    bytes.extend(h.to_be_bytes());
    bytes.extend(w.to_be_bytes());
    bytes.extend(b"\x01\x01\x11\0");
    // one code of one bit in each table: no difference, end of block
    for class in [0x00, 0x10] {
        bytes.extend(b"\xff\xc4\0\x14");
        bytes.push(class);
        bytes.push(1);
        bytes.extend([0; 15]);
        bytes.push(0);
    }
    bytes.extend(b"\xff\xda\0\x08\x01\x01\0\0\x3f\0");
    bytes.extend(coded);
    bytes
}

#[test]
fn a_jpeg_that_has_been_cut_or_holds_too_little_is_refused() {
    // 6 blocks of two bits
    let whole = jpeg(24, 16, b"\x00\x0f\xff\xd9");
    let answer = fit("a.jpg", &whole);
    assert!(answer.err.contains("the same everywhere"), "{answer:?}");
    for cut in 4..whole.len() {
        let answer = fit("a.jpg", &whole[..cut]);
        assert_eq!(answer.code, Some(2), "{cut}: {answer:?}");
    }
    let claims = jpeg(20_000, 20_000, b"\x00\x0f\xff\xd9");
    let answer = fit("a.jpg", &claims);
    assert!(
        answer.err.contains("cannot hold its 20000×20000"),
        "{answer:?}"
    );
    let long = [&whole[..], &vec![0x55; 1 << 20]].concat();
    assert_eq!(fit("a.jpg", &long).out, fit("a.jpg", &whole).out);
}

#[test]
fn every_format_that_has_been_cut_or_claims_too_much_is_refused() {
    let (w, h, pixels) = stored(1);
    let grey = disc(24, [12.0, 8.0], 5.0);
    for (name, bytes) in [
        ("a.png", png(w, h, &pixels, b"")),
        ("a.tif", tiff(1)),
        ("a.pgm", grey),
    ] {
        for cut in (8..bytes.len()).step_by(7) {
            let answer = fit(name, &bytes[..cut]);
            assert_eq!(answer.code, Some(2), "{name} cut at {cut}: {answer:?}");
        }
    }
    let mut text = b"P2 20000 20000 255\n".to_vec();
    text.extend(b"1 2 3 4\n");
    for (name, bytes) in [
        ("a.png", png(20_000, 20_000, &[7; 20_000], b"")),
        ("a.pgm", text),
        ("a.pgm", b"P5 20000 20000 255\nxxxx".to_vec()),
        ("a.tif", float_tiff(10_000, 10_000, &[0.5; 9])),
    ] {
        let answer = fit(name, &bytes);
        assert!(answer.err.contains("cannot hold"), "{name}: {answer:?}");
    }
    // text and profiles that inflate are passed over
    let bomb = [
        chunk(b"iCCP", &[b"p\0\0".to_vec(), vec![0; 999]].concat()),
        chunk(b"zTXt", b"a\0\0x"),
    ];
    let answer = fit("a.png", &png(w, h, &pixels, &bomb.concat()));
    assert!(answer.out.contains("# contour 1"), "{answer:?}");
}

#[test]
fn a_picture_comes_through_a_pipe_as_well() {
    let folder = Folder::new();
    folder.write("c.csv", AROUND);
    let (w, h, pixels) = stored(1);
    for bytes in [png(w, h, &pixels, b""), tiff(1)] {
        let args = ["fit", "-", "--from", "c.csv", "--steps", "20"];
        let answer = folder.snake_reading(&args, &bytes);
        assert_eq!(answer.out, fit("a", &bytes).out, "{answer:?}");
    }
    folder.refused(&["fit", "-", "--from", "-"], &["--from", "standard input"]);
}

#[test]
fn levels_of_any_size_are_fitted_alike() {
    let around = "10,30\n30,10\n50,30\n30,50\n";
    let found = |factor: f64| {
        let folder = Folder::new();
        folder.write("c.csv", around);
        let bytes = disc(61, [30.0, 30.0], 12.0);
        let pixels = &bytes[bytes.len() - 61 * 61..];
        let float = |&byte: &u8| (f64::from(byte) / 255.0 * factor) as f32;
        let pixels: Vec<f32> = pixels.iter().map(float).collect();
        folder.write("a.tif", float_tiff(61, 61, &pixels));
        let answer = folder.snake(&["fit", "a.tif", "--from", "c.csv", "--overlay", "o.png"]);
        assert_eq!(answer.code, Some(0), "{factor:e}: {answer:?}");
        let lines = answer.out.lines().skip(2);
        let numbers = lines.flat_map(|line| line.split(',').map(|v| v.parse::<f64>().unwrap()));
        numbers.collect::<Vec<f64>>()
    };
    let usual = found(1.0);
    for factor in [1e38, 1e30, 1e15, 1e-15, 1e-30, 1e-38] {
        let other = found(factor);
        assert_eq!(other.len(), usual.len());
        let off = other.iter().zip(&usual).map(|(a, b)| (a - b).abs());
        // levels are rounded to 24 bits, subnormal ones to fewer
        assert!(off.fold(0.0, f64::max) < 0.02, "{factor:e}");
    }
}
