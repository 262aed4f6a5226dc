//! One page with everything side by side: no script, and small copies of the pictures in it; each leads to the picture itself.

use std::fmt::Write as _;

use image::{RgbImage, codecs::jpeg::JpegEncoder};

use crate::{IoError, paint};

/// The longest side of a picture on the page, in pixels: as wide as it is shown.
pub(super) const LONGEST: u32 = 320;

/// Of 100; what is lost is not seen at that size, and the picture itself stands beside.
const QUALITY: u8 = 85;

/// Pictures under a heading.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub title: String,
    pub note: String,
    figures: Vec<Copy>,
}

/// A small copy of a picture.
#[derive(Debug)]
struct Copy {
    caption: String,
    file: String,
    kind: &'static str,
    bytes: Vec<u8>,
}

impl Part {
    pub(super) fn new(title: &str, note: String) -> Self {
        Self {
            title: title.to_owned(),
            note,
            figures: Vec::new(),
        }
    }

    /// Keep a small copy of the picture in `file`: in whichever format takes fewer bytes.
    pub(super) fn show(
        &mut self,
        file: &str,
        caption: &str,
        image: &RgbImage,
    ) -> Result<(), IoError> {
        let (kind, bytes) = small(&paint::shrunk(image, LONGEST))?;
        self.figures.push(Copy {
            caption: caption.to_owned(),
            file: file.to_owned(),
            kind,
            bytes,
        });
        Ok(())
    }
}

/// A small picture in whichever format takes fewer bytes, and the name of that format.
pub(super) fn small(image: &RgbImage) -> Result<(&'static str, Vec<u8>), IoError> {
    let (png, jpeg) = (paint::png(image)?, jpeg(image)?);
    Ok(if png.len() <= jpeg.len() {
        ("png", png)
    } else {
        ("jpeg", jpeg)
    })
}

fn jpeg(image: &RgbImage) -> Result<Vec<u8>, IoError> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY)
        .encode_image(image)
        .map_err(|error| IoError::Format {
            format: "JPEG",
            message: error.to_string(),
        })?;
    Ok(bytes)
}

const STYLE: &str = "
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem; color: #222; background: #fff; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.1rem; margin: 2rem 0 0; }
p { max-width: 60rem; margin: .3rem 0 .8rem; color: #555; }
div { display: flex; flex-wrap: wrap; gap: 1rem; }
figure { margin: 0; } figcaption { font-size: .85rem; color: #555; }
img { width: 320px; image-rendering: pixelated; border: 1px solid #ddd; display: block; }
";

/// The page.
pub(super) fn page(title: &str, parts: &[Part]) -> String {
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>{STYLE}</style>\n<h1>{title}</h1>\n",
        title = escaped(title)
    );
    for part in parts {
        let (heading, note) = (escaped(&part.title), escaped(&part.note));
        // writing to a String cannot fail
        let _ = writeln!(text, "<h2>{heading}</h2>\n<p>{note}</p>\n<div>");
        for copy in &part.figures {
            let _ = writeln!(
                text,
                "<figure><a href=\"{file}\"><img alt=\"{caption}\" src=\"data:image/{kind};base64,{bytes}\"></a>\
                 <figcaption>{caption}</figcaption></figure>",
                file = escaped(&copy.file),
                caption = escaped(&copy.caption),
                kind = copy.kind,
                bytes = base64(&copy.bytes)
            );
        }
        text.push_str("</div>\n");
    }
    text.push_str("</html>\n");
    text
}

pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

/// Bytes in the letters of RFC 4648.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| usize::from(three.get(i).copied().unwrap_or(0));
        let word = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            if i <= three.len() {
                text.push(char::from(LETTERS[word >> (18 - 6 * i) & 63]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_those_of_the_standard() {
        // the examples of RFC 4648, section 10
        for (bytes, letters) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), letters);
        }
    }

    #[test]
    fn a_page_needs_nothing_beside_it_and_shows_text_as_text() {
        let mut part = Part::new("a < b", "\"q\" & so on".to_owned());
        part.show("x.png", "x", &RgbImage::new(2, 2)).unwrap();
        let text = page("<script>", &[part]);
        assert!(text.contains("<h2>a &lt; b</h2>") && text.contains("&quot;q&quot; &amp; so on"));
        assert!(!text.contains("<script") && !text.contains("http"));
        assert!(text.contains("<a href=\"x.png\"><img"));
        assert!(text.contains("src=\"data:image/png;base64,iVBORw0KGgo"));
    }

    #[test]
    fn a_large_picture_is_a_small_one_on_the_page() {
        let mut part = Part::new("a", String::new());
        // as many colors as a photograph has
        let noisy = RgbImage::from_fn(1500, 900, |x, y| {
            let mixed = x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503);
            image::Rgb([mixed >> 8, mixed >> 16, x + y].map(|v| v.to_le_bytes()[0]))
        });
        part.show("a.png", "a", &noisy).unwrap();
        // 320 × 192 pixels
        assert!(page("a", &[part]).len() < 320 * 192);
    }
}
