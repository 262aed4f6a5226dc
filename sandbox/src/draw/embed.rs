//! Pictures inside an SVG: the `<image>` element that the drawing library does not write.

use super::figure::DrawError;
use super::palette::Color;
use super::panel::Picture;
use io::{RgbImage, paint};
use ndarray::Array2;

/// The elements of all pictures. One that appears more than once is stored once.
pub(crate) fn all(pictures: &[(Picture, [f64; 4])]) -> Result<Vec<String>, DrawError> {
    let mut out = Vec::new();
    for (index, (picture, place)) in pictures.iter().enumerate() {
        let twin = pictures[..index]
            .iter()
            .position(|(other, _)| other.pixels == picture.pixels);
        out.push(element(index, twin, picture, *place)?);
    }
    Ok(out)
}

/// One element: the data with a name, or a reference to the twin that has the data.
fn element(
    index: usize,
    twin: Option<usize>,
    picture: &Picture,
    place: [f64; 4],
) -> Result<String, DrawError> {
    let [left, top, right, bottom] = place;
    let (rows, columns) = picture.pixels.dim();
    // the picture is stored one unit a pixel, and stretched over its rectangle
    let across = (right - left) / crate::real(columns);
    let down = (bottom - top) / crate::real(rows);
    let transform = format!("matrix({across:.5} 0 0 {down:.5} {left:.2} {top:.2})");
    let opacity = if picture.opacity < 1.0 {
        format!(" opacity=\"{}\"", picture.opacity)
    } else {
        String::new()
    };
    if let Some(twin) = twin {
        return Ok(format!(
            "<use href=\"#p{twin}\" transform=\"{transform}\"{opacity}/>\n"
        ));
    }
    let rendering = if picture.smooth {
        ""
    } else {
        " style=\"image-rendering:pixelated\""
    };
    let data = base64(&encode(&picture.pixels)?);
    Ok(format!(
        "<g transform=\"{transform}\"{opacity}><image id=\"p{index}\" width=\"{columns}\" \
         height=\"{rows}\"{rendering} href=\"data:image/png;base64,{data}\"/></g>\n"
    ))
}

/// PNG bytes; the door to the encoder is `scene`.
fn encode(pixels: &Array2<Color>) -> Result<Vec<u8>, DrawError> {
    let (rows, columns) = pixels.dim();
    let bytes = pixels
        .iter()
        .flat_map(|color| [color.0, color.1, color.2])
        .collect();
    let size = |count: usize| u32::try_from(count).unwrap_or(0);
    RgbImage::from_raw(size(columns), size(rows), bytes)
        .and_then(|image| paint::png(&image).ok())
        .ok_or_else(|| DrawError::because("a picture is too large for a PNG"))
}

/// Standard base64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let word = group
            .iter()
            .fold(0_u32, |word, &byte| word << 8 | u32::from(byte));
        let word = word << (8 * (3 - group.len()));
        for place in 0..4 {
            let letter = if place <= group.len() {
                let index = (word >> (18 - 6 * place)) & 63;
                char::from(LETTERS[usize::try_from(index).unwrap_or(0)])
            } else {
                '='
            };
            out.push(letter);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_agrees_with_the_examples_of_its_standard() {
        let shown = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|s| base64(s.as_bytes()));
        assert_eq!(
            shown,
            [
                "", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"
            ]
        );
    }

    #[test]
    fn a_picture_shown_twice_is_stored_once() {
        let picture = Picture::new(Array2::from_elem((4, 6), Color::BLUE));
        let place = [0.0, 0.0, 60.0, 40.0];
        let text = all(&[(picture.clone(), place), (picture, place)]).unwrap();
        assert!(text[0].contains("data:image/png;base64,"));
        assert!(text[0].contains("matrix(10.00000 0 0 10.00000 0.00 0.00)"));
        assert!(text[1].starts_with("<use href=\"#p0\""));
    }
}
