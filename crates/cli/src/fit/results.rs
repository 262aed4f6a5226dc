//! What a fit leaves behind: outlines in the formats asked for, the picture with them over it, a table of measures.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use io::shapes::{self, Context, Format, Shape};
use io::{Claims, Picture, is_standard, paint, write_whole};
use scene::SceneError;
use score::{GreyMeans, Measures, curvature_extremes};

use super::flags::Flags;
use super::one::Found;
use crate::commands::key;

/// Colors over a picture: of the start, of an outline, and of one that is not sure.
const START: [u8; 3] = [86, 180, 233];
const FOUND: [u8; 3] = [230, 97, 1];
const UNSURE: [u8; 3] = [204, 121, 167];

/// σ over which curvature is smoothed, and width of the ring around an outline whose grey is measured. Pixels.
const CURVATURE: f64 = 3.0;
const RING: f64 = 5.0;

/// The name of the format that is a picture with the outlines over it.
const OVERLAY: &str = "overlay";

/// A result: what it holds, and where it goes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wanted {
    /// Outlines of that format.
    Outlines(Format, PathBuf),
    /// The picture with the outlines over it.
    Overlay(PathBuf),
}

impl Wanted {
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Outlines(_, path) | Self::Overlay(path) => path,
        }
    }
}

/// What is asked for by `--out`, `--overlay` and `--as`.
pub(super) fn of_files(flags: &Flags) -> Result<Vec<(&'static str, Wanted)>, SceneError> {
    let out = flags.out.clone().unwrap_or_else(|| PathBuf::from("-"));
    let format = match &flags.formats[..] {
        [] => Format::by_ending(&out).unwrap_or(Format::Csv),
        [name] => named(name)?,
        list => {
            let message = format!("must be one format for --out, got {}", list.join(","));
            return Err(key("--as", message));
        }
    };
    if flags.formats.is_empty()
        && out
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
    {
        let message =
            "ends in .json, which several formats do; needed: --as geojson, coco or labelme";
        return Err(key("--out", message));
    }
    let mut wanted = vec![("--out", Wanted::Outlines(format, out))];
    if let Some(path) = &flags.overlay {
        let png = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        if !png {
            let message = format!(
                "writes PNG; the name must end in .png, got {}",
                path.display()
            );
            return Err(key("--overlay", message));
        }
        wanted.push(("--overlay", Wanted::Overlay(path.clone())));
    }
    Ok(wanted)
}

/// What is asked for in a folder, for a picture of that name.
pub(super) fn of_folder(
    flags: &Flags,
    folder: &Path,
    stem: &str,
) -> Result<Vec<Wanted>, SceneError> {
    let usual = ["csv".to_owned()];
    let names = if flags.formats.is_empty() {
        &usual[..]
    } else {
        &flags.formats[..]
    };
    let wanted = |name: &String| {
        if name == OVERLAY {
            return Ok(Wanted::Overlay(folder.join(format!("{stem}_overlay.png"))));
        }
        let format = named(name)?;
        Ok(Wanted::Outlines(
            format,
            folder.join(format!("{stem}{}", ending(format))),
        ))
    };
    names.iter().map(wanted).collect()
}

fn named(name: &str) -> Result<Format, SceneError> {
    let format =
        Format::named(name).filter(|format| !matches!(format, Format::Cvat | Format::Soft));
    format.ok_or_else(|| {
        let names = "csv, geojson, coco, imagej, svg, labelme, mask, labels, deep-labels, overlay";
        key("--as", format!("must be one of {names}, got {name}"))
    })
}

/// How the name of a file of a format ends, behind that of its picture: no two formats alike.
const fn ending(format: Format) -> &'static str {
    match format {
        Format::GeoJson => ".geojson",
        Format::Coco => "_coco.json",
        Format::ImageJ => ".zip",
        Format::Svg => ".svg",
        Format::Labelme => "_labelme.json",
        Format::Mask => "_mask.png",
        Format::Labels => "_labels.png",
        Format::DeepLabels => "_labels.tif",
        _ => ".csv",
    }
}

/// Make sure before the work that everything can be written after it, and takes the place of nothing that is read.
pub(super) fn check(
    flags: &Flags,
    wanted: &[(&'static str, Wanted)],
    inputs: &[PathBuf],
) -> Result<(), SceneError> {
    let mut claims = Claims::default();
    for path in inputs {
        claims.reads(path);
    }
    let table = flags
        .measure
        .iter()
        .map(|path| ("--measure", path.as_path()));
    for (flag, path) in wanted
        .iter()
        .map(|(flag, wanted)| (*flag, wanted.path()))
        .chain(table)
    {
        if flags.no_clobber && !is_standard(path) && path.exists() {
            let message = format!("{} is there already; needed: another name", path.display());
            return Err(key(flag, message));
        }
        claims.writes(flag, path)?;
    }
    Ok(())
}

/// Write one result; what goes to standard output is given back.
pub(super) fn write(
    wanted: &Wanted,
    picture: &Picture,
    name: &Path,
    found: &[Found],
) -> Result<Option<Vec<u8>>, SceneError> {
    let bytes = match wanted {
        Wanted::Outlines(format, _) => outlines(*format, picture, name, found)?,
        Wanted::Overlay(_) => paint::png(&overlay(picture, found))?,
    };
    if is_standard(wanted.path()) {
        return Ok(Some(bytes));
    }
    write_whole(wanted.path(), &bytes)?;
    Ok(None)
}

fn outlines(
    format: Format,
    picture: &Picture,
    name: &Path,
    found: &[Found],
) -> Result<Vec<u8>, SceneError> {
    let list: Vec<Shape> = found
        .iter()
        .filter_map(|found| found.shape.clone())
        .collect();
    if format == Format::Csv {
        let mut text = String::new();
        for (index, found) in found.iter().enumerate() {
            if let Some(why) = &found.unsure
                && found.measured.closed.is_some()
            {
                let _ = writeln!(text, "# outline {}: {}", index + 1, io::text::plain(why));
            }
        }
        text.push_str(&shapes::to_text(&list));
        return Ok(text.into_bytes());
    }
    let (width, height) = picture.size();
    let context = Context {
        picture: name
            .file_name()
            .map(|name| name.to_string_lossy().into_owned()),
        width,
        height,
        pixel: picture.pixel_size().cloned(),
    };
    Ok(shapes::write(&list, format, &context)?)
}

/// The picture with starts and outlines over it.
pub(super) fn overlay(picture: &Picture, found: &[Found]) -> io::RgbImage {
    let starts = found.iter().map(|found| (&found.start, START));
    let outlines = found.iter().filter_map(|found| {
        let color = if found.unsure.is_some() {
            UNSURE
        } else {
            FOUND
        };
        found.shape.as_ref().map(|shape| (shape, color))
    });
    let curves: Vec<_> = starts
        .chain(outlines)
        .map(|(shape, color)| (shape.first(), shape.closed == Some(true), color))
        .collect();
    paint::overlay(picture, &curves)
}

/// Headings of the table of measures; lengths in pixels but for the last two, which are in units of the picture.
pub(super) const HEADINGS: &str = "picture,outline,label,outcome,area_px2,perimeter_px,centroid_x_px,centroid_y_px,\
    major_axis_px,minor_axis_px,angle_deg,circularity,solidity,equivalent_diameter_px,left_px,top_px,right_px,bottom_px,\
    least_curvature_per_px,largest_curvature_per_px,mean_inside,mean_outside,held,closed_edge,standard_error_px,\
    pixel_width,pixel_height,unit,area_unit2,perimeter_unit";

/// The rows of a picture in the table of measures.
pub(super) fn rows(picture: &Picture, name: &Path, found: &[Found]) -> String {
    let mut text = String::new();
    for (index, found) in found.iter().enumerate() {
        let _ = writeln!(text, "{}", row(picture, name, index + 1, found).join(","));
    }
    text
}

fn row(picture: &Picture, name: &Path, number: usize, found: &Found) -> Vec<String> {
    let shape = found.shape.as_ref();
    let rings = shape.map_or(&[][..], |shape| &shape.rings[..]);
    let closed = shape.is_some_and(|shape| shape.closed == Some(true));
    let measures = Measures::of(rings).ok().filter(|_| closed);
    let bends = rings
        .first()
        .and_then(|ring| curvature_extremes(ring, CURVATURE).ok())
        .filter(|_| closed);
    let grey = GreyMeans::of(rings, picture.levels(), RING)
        .ok()
        .filter(|_| closed);
    let number_of = |value: Option<f64>| {
        value
            .filter(|value| value.is_finite())
            .map_or_else(String::new, |value| format!("{value:.6}"))
    };
    let of = |value: fn(&Measures) -> f64| number_of(measures.as_ref().map(value));
    let label = shape
        .and_then(|shape| shape.label.as_deref())
        .unwrap_or_default();
    let pixel = picture.pixel_size();
    let perimeter = |scale: (f64, f64)| {
        let length = |ring: &Vec<glam::DVec2>| {
            let next = ring.iter().cycle().skip(1);
            let edges =
                ring.iter()
                    .zip(next)
                    .take(if closed { ring.len() } else { ring.len() - 1 });
            edges
                .map(|(a, b)| (scale.0 * (b.x - a.x)).hypot(scale.1 * (b.y - a.y)))
                .sum::<f64>()
        };
        rings
            .iter()
            .filter(|ring| !ring.is_empty())
            .map(length)
            .sum::<f64>()
    };
    vec![
        quoted(&name.file_name().unwrap_or_default().to_string_lossy()),
        shape
            .and_then(|shape| shape.id.as_deref())
            .map_or_else(|| number.to_string(), quoted),
        quoted(label),
        (if found.unsure.is_some() {
            "unsure"
        } else {
            "found"
        })
        .to_owned(),
        of(|m| m.area),
        number_of(shape.map(|_| perimeter((1.0, 1.0)))),
        of(|m| m.centroid.x),
        of(|m| m.centroid.y),
        of(|m| m.major_axis),
        of(|m| m.minor_axis),
        of(|m| m.angle.to_degrees()),
        of(|m| m.circularity),
        of(|m| m.solidity),
        of(|m| m.equivalent_diameter),
        of(|m| m.low.x),
        of(|m| m.low.y),
        of(|m| m.high.x),
        of(|m| m.high.y),
        number_of(bends.map(|bends| bends[0])),
        number_of(bends.map(|bends| bends[1])),
        number_of(grey.as_ref().and_then(|grey| grey.inside)),
        number_of(grey.as_ref().and_then(|grey| grey.outside)),
        number_of(found.measured.held),
        number_of(found.measured.closed),
        number_of(found.measured.error),
        number_of(pixel.map(|pixel| pixel.x)),
        number_of(pixel.map(|pixel| pixel.y)),
        pixel.map_or_else(String::new, |pixel| quoted(&pixel.unit)),
        number_of(pixel.and_then(|pixel| measures.as_ref().map(|m| m.area * pixel.x * pixel.y))),
        number_of(
            pixel
                .filter(|_| shape.is_some())
                .map(|pixel| perimeter((pixel.x, pixel.y))),
        ),
    ]
}

/// A text as a field of a table.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
