//! The head of a PGM, PPM or PAM file, and how much data its picture takes.

use std::io::BufRead;

use super::source::{check_size, exact, too_little};

/// Bytes that a head with its comments may have.
const MOST_HEAD: usize = 1 << 16;

/// What stands before the pixels, and how many bytes they take.
pub(super) struct Head {
    pub bytes: Vec<u8>,
    /// Bytes of the pixels: just so many where they are binary, at most so many where they are text.
    pub data: u64,
}

/// Read the head; `length` is that of the whole file where it is known.
pub(super) fn head(
    input: &mut dyn BufRead,
    length: Option<u64>,
    most: u64,
) -> Result<Head, String> {
    let mut bytes = exact::<2>(input)?.to_vec();
    let kind = bytes[1];
    let (width, height, values, largest) = if kind == b'7' {
        let mut numbers = [0_u64; 4];
        loop {
            let line = line(input, &mut bytes)?;
            let mut words = line.split_whitespace();
            let name = words.next().unwrap_or("");
            let at = ["WIDTH", "HEIGHT", "DEPTH", "MAXVAL"];
            if let Some(at) = at.iter().position(|known| *known == name) {
                numbers[at] = words.next().and_then(|w| w.parse().ok()).unwrap_or(0);
            } else if name == "ENDHDR" {
                break;
            }
        }
        let [width, height, depth, largest] = numbers;
        (width, height, depth, largest)
    } else {
        let width = number(input, &mut bytes)?;
        let height = number(input, &mut bytes)?;
        let bits = matches!(kind, b'1' | b'4');
        let largest = if bits { 1 } else { number(input, &mut bytes)? };
        let values = if matches!(kind, b'3' | b'6') { 3 } else { 1 };
        (width, height, values, largest)
    };
    check_size(width, height, most)?;
    let samples = width.saturating_mul(height).saturating_mul(values);
    let (least, data) = match kind {
        b'1' => (samples, samples.saturating_mul(2)),
        // a digit and a space each
        b'2' | b'3' => (samples.saturating_mul(2) - 1, samples.saturating_mul(8)),
        b'4' => (width.div_ceil(8) * height, width.div_ceil(8) * height),
        _ => {
            let each = if largest > 255 { 2 } else { 1 };
            (samples.saturating_mul(each), samples.saturating_mul(each))
        }
    };
    // text may be set out more widely
    let text = matches!(kind, b'1'..=b'3');
    let data = if text {
        data.saturating_mul(2) + (1 << 16)
    } else {
        data
    };
    if let Some(length) = length {
        let rest = length.saturating_sub(bytes.len() as u64);
        if rest < least {
            return Err(too_little(rest, width, height));
        }
    }
    Ok(Head { bytes, data })
}

fn next(input: &mut dyn BufRead, bytes: &mut Vec<u8>) -> Result<u8, String> {
    let [byte] = exact::<1>(input)?;
    bytes.push(byte);
    if bytes.len() > MOST_HEAD {
        return Err("the picture cannot be decoded: its head does not end".to_owned());
    }
    Ok(byte)
}

/// The next number, past space and comments, with the one space behind it.
fn number(input: &mut dyn BufRead, bytes: &mut Vec<u8>) -> Result<u64, String> {
    let mut value: Option<u64> = None;
    loop {
        let byte = next(input, bytes)?;
        match byte {
            b'#' => while !matches!(next(input, bytes)?, b'\n' | b'\r') {},
            b'0'..=b'9' => {
                let before = value.unwrap_or(0);
                value = Some(
                    before
                        .saturating_mul(10)
                        .saturating_add(u64::from(byte - b'0')),
                );
            }
            _ if byte.is_ascii_whitespace() => {
                if let Some(value) = value {
                    return Ok(value);
                }
            }
            _ => {
                return Err(
                    "the picture cannot be decoded: a number is needed in its head".to_owned(),
                );
            }
        }
    }
}

fn line(input: &mut dyn BufRead, bytes: &mut Vec<u8>) -> Result<String, String> {
    let start = bytes.len();
    while next(input, bytes)? != b'\n' {}
    Ok(String::from_utf8_lossy(&bytes[start..]).into_owned())
}
