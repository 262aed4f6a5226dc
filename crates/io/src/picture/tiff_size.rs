//! What a TIFF says about its pixels' size and its channels: by its resolution, `ImageJ` or OME.

use std::io::{BufRead, Seek};

use roxmltree::Document;
use tiff::decoder::{Decoder, ifd::Value};
use tiff::tags::Tag;

use super::PixelSize;
use super::source::MOST_DESCRIPTION;

/// What is said.
#[derive(Debug, Default)]
pub(super) struct Said {
    pub pixel_size: Option<PixelSize>,
    /// Names of channels that are pages, which come one after another; none if there is but one.
    pub channels: Vec<String>,
    /// How many slices there are at each moment, and how many moments.
    pub stack: (usize, usize),
    /// How many pages `ImageJ` says there are.
    pub images: usize,
}

/// Channels that are believed.
const MOST_CHANNELS: usize = 1000;

/// What the first page says.
pub(super) fn said<R: BufRead + Seek>(decoder: &mut Decoder<R>) -> Said {
    let description = decoder
        .get_tag_ascii_string(Tag::ImageDescription)
        .unwrap_or_default();
    if description.len() > MOST_DESCRIPTION {
        return Said::default();
    }
    if description.contains("<OME")
        && let Some(said) = ome(&description)
    {
        return said;
    }
    let mut said = Said::default();
    let mut unit = match decoder.find_tag_unsigned::<u64>(Tag::ResolutionUnit) {
        Ok(Some(3)) => "cm",
        Ok(Some(2) | None) => "inch",
        _ => "",
    };
    if description.starts_with("ImageJ=") {
        let value = |name: &str| {
            description
                .lines()
                .find_map(|line| line.strip_prefix(name)?.strip_prefix('='))
        };
        if let Some(given) = value("unit") {
            // escaped where it is no ASCII
            unit = if given.starts_with("\\u00B5m") {
                "micron"
            } else {
                given
            };
        }
        let count = value("channels")
            .and_then(|count| count.parse::<usize>().ok())
            .unwrap_or(1);
        if (2..=MOST_CHANNELS).contains(&count) {
            said.channels = (1..=count).map(|number| number.to_string()).collect();
        }
        let many = |name: &str| {
            value(name)
                .and_then(|count| count.parse().ok())
                .unwrap_or(1)
        };
        said.stack = (many("slices"), many("frames"));
        said.images = many("images");
    }
    let mut each = |tag: Tag| 1.0 / ratio(decoder.find_tag(tag).ok().flatten());
    let (x, y) = (each(Tag::XResolution), each(Tag::YResolution));
    if !unit.is_empty() {
        said.pixel_size = PixelSize::new(x, y, unit);
    }
    said
}

fn ratio(value: Option<Value>) -> f64 {
    match value {
        Some(Value::Rational(a, b)) => f64::from(a) / f64::from(b),
        Some(Value::List(list)) => ratio(list.into_iter().next()),
        _ => f64::NAN,
    }
}

/// What the XML of the Open Microscopy Environment says.
fn ome(description: &str) -> Option<Said> {
    let document = Document::parse(description).ok()?;
    let mut nodes = document.descendants();
    let pixels = nodes.find(|node| node.tag_name().name() == "Pixels")?;
    let number = |name: &str| pixels.attribute(name)?.parse::<f64>().ok();
    let size = number("PhysicalSizeX").zip(number("PhysicalSizeY"));
    let unit = pixels.attribute("PhysicalSizeXUnit").unwrap_or("micron");
    let unit = if matches!(unit, "\u{b5}m" | "\u{3bc}m") {
        "micron"
    } else {
        unit
    };
    let order = pixels.attribute("DimensionOrder").unwrap_or("XYCZT");
    let channels = pixels
        .children()
        .filter(|node| node.tag_name().name() == "Channel");
    let one = |(number, node): (usize, roxmltree::Node<'_, '_>)| {
        let name = node.attribute("Name").map(str::to_owned);
        name.unwrap_or_else(|| number.to_string())
    };
    let samples =
        |node: &roxmltree::Node<'_, '_>| node.attribute("SamplesPerPixel").unwrap_or("1") == "1";
    let many = |name: &str| pixels.attribute(name).and_then(|count| count.parse().ok());
    let stack = (many("SizeZ").unwrap_or(1), many("SizeT").unwrap_or(1));
    let pages = order.starts_with("XYC") && channels.clone().all(|node| samples(&node));
    let names: Vec<String> = (1..).zip(channels).map(one).take(MOST_CHANNELS).collect();
    Some(Said {
        pixel_size: size.and_then(|(x, y)| PixelSize::new(x, y, unit)),
        channels: if pages && names.len() > 1 {
            names
        } else {
            Vec::new()
        },
        stack,
        images: 1,
    })
}
