//! XML for the formats that are: elements with their attributes and lines.

use std::fmt::Display;

use roxmltree::{Document, Node, ParsingOptions};

use crate::IoError;
use crate::limits::MOST_SHAPES;
use crate::text::clip_to;

/// Bytes of an XML: its elements take some ten times as many.
const MOST_BYTES: usize = 64 << 20;

/// The elements of a text. A document type may be there, entities of its own may not.
pub(super) fn parse(text: &str) -> Result<Document<'_>, IoError> {
    if text.len() > MOST_BYTES {
        let message = format!(
            "an XML of {} bytes; it must have at most {MOST_BYTES}",
            text.len()
        );
        return Err(IoError::text(None, message));
    }
    if let Some(at) = text.find("<!ENTITY") {
        let line = text[..at].matches('\n').count() + 1;
        let message = "an entity of its own; a file that was saved without any is needed";
        return Err(IoError::text(Some(line), message));
    }
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: u32::try_from(4 * MOST_SHAPES).unwrap_or(u32::MAX),
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| {
        let line = usize::try_from(error.pos().row).ok();
        IoError::text(line, "is no whole XML, which is needed".to_owned())
    })
}

/// A refusal of what an element holds.
pub(super) fn refuse(node: Node<'_, '_>, what: impl Display) -> IoError {
    let line = node.document().text_pos_at(node.range().start).row;
    let name = clip_to(node.tag_name().name(), 20);
    IoError::text(usize::try_from(line).ok(), format!("{name}: {what}"))
}

/// A number of an element.
pub(super) fn number(node: Node<'_, '_>, name: &str) -> Result<f64, IoError> {
    let value = node.attribute(name);
    let value = value.ok_or_else(|| refuse(node, format!("has no {name}, which is needed")))?;
    let number = value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    number.ok_or_else(|| refuse(node, format!("{name} must be a number")))
}

/// Text for an attribute or between elements.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
