//! One page with everything side by side: no script, no file beside it.

use std::fmt::Write as _;

use image::RgbImage;

use crate::{SceneError, paint};

/// The longest side of a picture on the page, in pixels.
const LONGEST: u32 = 640;

/// Pictures under a heading.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub title: String,
    pub note: String,
    figures: Vec<(String, Vec<u8>)>,
}

impl Part {
    pub(super) fn new(title: &str, note: String) -> Self {
        Self {
            title: title.to_owned(),
            note,
            figures: Vec::new(),
        }
    }

    /// Keep a small copy of a picture.
    pub(super) fn show(&mut self, caption: &str, image: &RgbImage) -> Result<(), SceneError> {
        let small = paint::shrunk(image, LONGEST);
        self.figures.push((caption.to_owned(), paint::png(&small)?));
        Ok(())
    }
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
        for (caption, png) in &part.figures {
            let _ = writeln!(
                text,
                "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>",
                escaped(caption),
                base64(png)
            );
        }
        text.push_str("</div>\n");
    }
    text.push_str("</html>\n");
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

/// Bytes in the letters of RFC 4648.
fn base64(bytes: &[u8]) -> String {
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
        part.show("x", &RgbImage::new(2, 2)).unwrap();
        let text = page("<script>", &[part]);
        assert!(text.contains("<h2>a &lt; b</h2>") && text.contains("&quot;q&quot; &amp; so on"));
        assert!(!text.contains("<script") && !text.contains("http"));
        assert!(text.contains("src=\"data:image/png;base64,iVBORw0KGgo"));
    }
}
