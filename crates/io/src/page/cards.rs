//! A page of cards, a small picture and what is said of it on each, in an order that is known only when all are there.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{Error, Read, Seek as _, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use image::RgbImage;

use super::html::{LONGEST, base64, escaped, small};
use crate::write::write_by;
use crate::{IoError, paint};

/// What is said beside a picture.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Card {
    /// Its name.
    pub title: String,
    /// The outcome in a word.
    pub word: String,
    /// Whether that word is a good one.
    pub good: bool,
    /// What is to be seen, for those who do not see it.
    pub seen: String,
    /// Numbers by their names.
    pub facts: Vec<(String, String)>,
    /// What else there is to say, if anything.
    pub note: Option<String>,
}

/// Where a card is kept until the page is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    from: u64,
    bytes: u64,
}

/// A part of the page.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// What is said of it.
    pub note: String,
    /// A list of names and what is said of each.
    pub list: Vec<(String, String)>,
    /// Its cards, in the order they are shown in.
    pub cards: Vec<Kept>,
}

/// Cards as they come, from any thread. They are kept in a file without a name: memory does not grow with them.
///
/// ```
/// use io::page::{Card, Cards, Section};
///
/// let cards = Cards::new()?;
/// let card = Card { title: "a.png".to_owned(), word: "found".to_owned(), ..Card::default() };
/// let kept = cards.keep(&card, &io::RgbImage::new(40, 30))?;
/// let page = std::env::temp_dir().join("snakes-cards-example.html");
/// let all = Section { title: "Pictures".to_owned(), cards: vec![kept], ..Section::default() };
/// cards.write(&page, "Outlines", &[all])?;
/// assert!(std::fs::read_to_string(&page).is_ok_and(|text| text.contains("a.png")));
/// # let _ = std::fs::remove_file(&page);
/// # Ok::<(), io::IoError>(())
/// ```
#[derive(Debug)]
pub struct Cards {
    file: Mutex<(File, u64)>,
}

const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1a1a1a; --soft: #555; --paper: #fff; --line: #ccc; --bad: #9a3412; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #eee; --soft: #b5b5b5; --paper: #161616; --line: #444; --bad: #fdba74; }
}
* { box-sizing: border-box; }
body { font: 1rem/1.45 system-ui, sans-serif; margin: 0 auto; padding: 1rem; max-width: 90rem;
  color: var(--ink); background: var(--paper); overflow-wrap: anywhere; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .3rem; } h3 { font-size: 1rem; margin: .5rem 0 .2rem; }
p { margin: .2rem 0 .6rem; color: var(--soft); }
a { color: inherit; } a:focus-visible { outline: 3px solid currentColor; outline-offset: 2px; }
ol.cards { list-style: none; margin: 0; padding: 0; display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 15rem), 1fr)); }
ol.cards > li { border: 1px solid var(--line); border-radius: .4rem; padding: .6rem; }
img { width: 100%; height: auto; max-height: 24rem; object-fit: contain; display: block; background: #808080; }
dl { display: grid; grid-template-columns: auto auto; gap: 0 .8rem; margin: .3rem 0; font-size: .9rem; }
dt { color: var(--soft); } dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; }
.bad { color: var(--bad); font-weight: 600; }
";

impl Cards {
    /// No cards yet.
    ///
    /// # Errors
    ///
    /// Nowhere to keep them: the folder for temporary files cannot be written.
    pub fn new() -> Result<Self, IoError> {
        let file = tempfile::tempfile().map_err(unkept)?;
        Ok(Self {
            file: Mutex::new((file, 0)),
        })
    }

    /// Keep a card with a small copy of its picture.
    ///
    /// # Errors
    ///
    /// A full disk.
    pub fn keep(&self, card: &Card, image: &RgbImage) -> Result<Kept, IoError> {
        let image = paint::shrunk(image, LONGEST);
        let (kind, bytes) = small(&image)?;
        let mut text = format!(
            "<li><img loading=\"lazy\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/{kind};base64,{}\">\n\
             <h3>{}</h3>\n<p{}>{}</p>\n<dl>",
            image.width(),
            image.height(),
            escaped(&card.seen),
            base64(&bytes),
            escaped(&card.title),
            if card.good { "" } else { " class=\"bad\"" },
            escaped(&card.word),
        );
        for (name, value) in &card.facts {
            // writing to a String cannot fail
            let _ = write!(
                text,
                "<dt>{}</dt><dd>{}</dd>",
                escaped(name),
                escaped(value)
            );
        }
        text.push_str("</dl>\n");
        if let Some(note) = &card.note {
            let _ = writeln!(text, "<p>{}</p>", escaped(note));
        }
        text.push_str("</li>\n");
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let from = file.1;
        file.0.write_all(text.as_bytes()).map_err(unkept)?;
        let bytes = text.len() as u64;
        file.1 += bytes;
        Ok(Kept { from, bytes })
    }

    /// Write the page: one file that needs no other.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(self, path: &Path, title: &str, sections: &[Section]) -> Result<(), IoError> {
        let (mut kept, _) = self
            .file
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        write_by(path, &mut |page| {
            write!(
                page,
                "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">\n\
                 <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
                 <title>{title}</title>\n<style>{STYLE}</style></head>\n<body>\n<main>\n<h1>{title}</h1>\n",
                title = escaped(title)
            )?;
            if sections.len() > 1 {
                writeln!(page, "<nav aria-label=\"Parts of this page\"><ul>")?;
                for (number, section) in sections.iter().enumerate() {
                    writeln!(
                        page,
                        "<li><a href=\"#part{number}\">{}</a></li>",
                        escaped(&section.title)
                    )?;
                }
                writeln!(page, "</ul></nav>")?;
            }
            for (number, section) in sections.iter().enumerate() {
                put(page, number, section, &mut kept)?;
            }
            writeln!(page, "</main>\n</body>\n</html>")
        })
    }
}

/// A part of the page, its cards from where they are kept.
fn put(
    page: &mut dyn Write,
    number: usize,
    section: &Section,
    kept: &mut File,
) -> Result<(), Error> {
    writeln!(
        page,
        "<section aria-labelledby=\"part{number}\">\n<h2 id=\"part{number}\">{}</h2>",
        escaped(&section.title)
    )?;
    if !section.note.is_empty() {
        writeln!(page, "<p>{}</p>", escaped(&section.note))?;
    }
    if !section.list.is_empty() {
        writeln!(page, "<ul>")?;
        for (name, said) in &section.list {
            let dash = if said.is_empty() { "" } else { ": " };
            writeln!(
                page,
                "<li><strong>{}</strong>{dash}{}</li>",
                escaped(name),
                escaped(said)
            )?;
        }
        writeln!(page, "</ul>")?;
    }
    if !section.cards.is_empty() {
        // a list without marks is none to some readers of the screen unless it says that it is one
        writeln!(page, "<ol class=\"cards\" role=\"list\">")?;
        for card in &section.cards {
            kept.seek(SeekFrom::Start(card.from))?;
            std::io::copy(&mut Read::by_ref(kept).take(card.bytes), page)?;
        }
        writeln!(page, "</ol>")?;
    }
    writeln!(page, "</section>")
}

fn unkept(error: Error) -> IoError {
    let message = format!("cannot be written: {error}; a folder with room for them is needed");
    IoError::file(&std::env::temp_dir(), message)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(title: &str) -> Card {
        Card {
            title: title.to_owned(),
            word: "unsure".to_owned(),
            seen: format!("{title} with \"one\" outline"),
            facts: vec![("edge".to_owned(), "0.21".to_owned())],
            note: Some("a < b & c".to_owned()),
            good: false,
        }
    }

    #[test]
    fn cards_stand_in_the_order_asked_for_whatever_order_they_came_in() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("page.html");
        let cards = Cards::new().unwrap();
        let image = RgbImage::new(6, 4);
        let kept = std::thread::scope(|scope| {
            let keep = |name: &'static str| {
                let (cards, image) = (&cards, &image);
                scope.spawn(move || cards.keep(&card(name), image).unwrap())
            };
            ["one", "two", "three"]
                .map(keep)
                .map(|thread| thread.join().unwrap())
        });
        let sections = [
            Section {
                title: "Refused".to_owned(),
                list: vec![("x.png".to_owned(), "is <no> picture".to_owned())],
                ..Section::default()
            },
            Section {
                title: "Pictures".to_owned(),
                cards: vec![kept[2], kept[0], kept[1]],
                ..Section::default()
            },
        ];
        cards.write(&page, "A & B", &sections).unwrap();
        let text = std::fs::read_to_string(&page).unwrap();
        let at = |part: &str| {
            text.find(part)
                .unwrap_or_else(|| unreachable!("{part}: {text}"))
        };
        let order = [
            "<h1>A &amp; B</h1>",
            "is &lt;no> picture",
            "<h3>three<",
            "<h3>one<",
            "<h3>two<",
        ];
        assert!(order.map(at).is_sorted());
        assert!(
            text.contains("alt=\"one with &quot;one&quot; outline\"")
                && text.contains("a &lt; b &amp; c")
        );
        assert!(!text.contains("<script") && !text.contains("http"));
        for tag in ["li", "ol", "ul", "section", "dl", "p", "main", "nav"] {
            let count = |what: String| text.matches(&what).count();
            let open = count(format!("<{tag}>")) + count(format!("<{tag} "));
            assert_eq!(open, count(format!("</{tag}>")), "{tag}");
        }
    }
}
