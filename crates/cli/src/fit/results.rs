//! What a fit leaves behind: outlines in the formats asked for, the picture with them over it, a table of measures.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use io::shapes::{self, Context, Format, NodeColumn, Shape, Value};
use io::{Claims, Picture, is_standard, paint, write_whole};
use scene::SceneError;
use scene::fit::NodeEvidence;

use super::film::film;
use super::flags::Flags;
use super::one::Found;
use super::overlay::overlay;
use super::start::stem;
use super::table;
use crate::commands::key;

/// The name of the format that is a picture with the outlines over it.
const OVERLAY: &str = "overlay";

/// That of the format that shows how they were found.
pub(super) const ANIMATION: &str = "animation";

/// A result: what it holds, and where it goes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wanted {
    /// Outlines of that format.
    Outlines(Format, PathBuf),
    /// The picture with the outlines over it.
    Overlay(PathBuf),
    /// How they were found.
    Animation(PathBuf),
    /// Outlines as a part of a table of many pictures.
    Table(PathBuf),
}

impl Wanted {
    /// Whether it is a picture, as pictures are that outlines are found in.
    pub(super) const fn is_picture(&self) -> bool {
        let format = match self {
            Self::Outlines(format, _) => *format,
            Self::Overlay(_) => return true,
            Self::Animation(_) | Self::Table(_) => return false,
        };
        matches!(format, Format::Mask | Format::Labels | Format::DeepLabels)
    }

    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Outlines(_, path)
            | Self::Overlay(path)
            | Self::Animation(path)
            | Self::Table(path) => path,
        }
    }
}

/// What is asked for by `--out`, `--overlay` and `--as`.
pub(super) fn of_files(flags: &Flags) -> Result<Vec<(&'static str, Wanted)>, SceneError> {
    let out = flags.out.clone().unwrap_or_else(|| PathBuf::from("-"));
    let format = match &flags.formats[..] {
        [] => Format::by_ending(&out).unwrap_or(Format::Csv),
        [name] if name == table::FORMAT => {
            let message = "parquet is a table of many pictures in a folder; needed: --out-dir";
            return Err(key("--as", message));
        }
        [name] if name == OVERLAY || name == ANIMATION => {
            let message = format!(
                "{name} is for --out-dir; needed beside --out: --{name} with the name of a file"
            );
            return Err(key("--as", message));
        }
        [name] => match named(name, "")? {
            // by the ending one ROI, not a file of them
            Format::ImageJ if Format::by_ending(&out) == Some(Format::Roi) => Format::Roi,
            format => format,
        },
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
        ends("--overlay", path, "png")?;
        wanted.push(("--overlay", Wanted::Overlay(path.clone())));
    }
    if let Some(path) = &flags.animation {
        ends("--animation", path, "gif")?;
        wanted.push(("--animation", Wanted::Animation(path.clone())));
    }
    Ok(wanted)
}

/// Refuse the name of a file that does not end as what is written there.
fn ends(flag: &str, path: &Path, ending: &str) -> Result<(), SceneError> {
    let own = path.extension().unwrap_or_default();
    if own.eq_ignore_ascii_case(ending) {
        return Ok(());
    }
    let message = format!(
        "writes {}; the name must end in .{ending}, got {}",
        ending.to_uppercase(),
        path.display()
    );
    Err(key(flag, message))
}

/// What is asked for in a folder, for a picture of that name.
pub(super) fn of_folder(
    flags: &Flags,
    folder: &Path,
    picture: &Path,
) -> Result<Vec<Wanted>, SceneError> {
    let stem = stem(picture);
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
        if name == ANIMATION && flags.seeds.is_some() {
            let message =
                "animation shows the way from a start, and --seeds has none; needed: --from";
            return Err(key("--as", message));
        }
        if name == ANIMATION {
            return Ok(Wanted::Animation(folder.join(format!("{stem}.gif"))));
        }
        if name == table::FORMAT {
            let part = store::part_name(&store::name_of(picture));
            return Ok(Wanted::Table(folder.join(part)));
        }
        let format = named(name, ", overlay, animation, parquet")?;
        Ok(Wanted::Outlines(
            format,
            folder.join(format!("{stem}{}", ending(format))),
        ))
    };
    names.iter().map(wanted).collect()
}

/// The format of that name, of those that can be written and of `more`.
fn named(name: &str, more: &str) -> Result<Format, SceneError> {
    let format =
        Format::named(name).filter(|format| !matches!(format, Format::Cvat | Format::Soft));
    format.ok_or_else(|| {
        let names = "csv, geojson, coco, imagej, svg, labelme, mask, labels, deep-labels";
        key("--as", format!("must be one of {names}{more}, got {name}"))
    })
}

/// How the name of a file of a format ends, behind that of its picture: no two formats alike.
const fn ending(format: Format) -> &'static str {
    match format {
        Format::GeoJson => ".geojson",
        Format::Coco => "_coco.json",
        Format::ImageJ => ".zip",
        Format::Roi => ".roi",
        Format::Svg => ".svg",
        Format::Labelme => "_labelme.json",
        Format::Mask => "_mask.png",
        Format::Labels => "_labels.png",
        Format::DeepLabels => "_labels.tif",
        _ => ".csv",
    }
}

/// Refuse the name of a file of one outline for several.
pub(super) fn check_count(flags: &Flags, count: usize) -> Result<(), SceneError> {
    let roi = |path: &&PathBuf| {
        let ending = path.extension().unwrap_or_default();
        ending.eq_ignore_ascii_case("roi")
    };
    let imagej = flags.formats.is_empty() || flags.formats.iter().any(|name| name == "imagej");
    match flags.out.as_ref().filter(roi) {
        Some(path) if imagej && count > 1 => {
            let message = format!(
                "{} holds one outline, got {count}; needed: a name that ends in .zip, which holds several, or --out-dir",
                path.display()
            );
            Err(key("--out", message))
        }
        _ => Ok(()),
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
    let more = [
        ("--measure", &flags.measure),
        ("--sheet", &flags.sheet),
        ("--record", &flags.record),
    ];
    let more = more
        .into_iter()
        .filter_map(|(flag, path)| Some((flag, path.as_deref()?)));
    for (flag, path) in wanted
        .iter()
        .map(|(flag, wanted)| (*flag, wanted.path()))
        .chain(more)
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
    flags: &Flags,
) -> Result<Option<Vec<u8>>, SceneError> {
    let bytes = match wanted {
        Wanted::Outlines(format, _) => outlines(*format, picture, name, found, flags.evidence)?,
        Wanted::Overlay(_) => paint::png(&overlay(picture, found, flags))?,
        Wanted::Animation(_) => film(picture, found)?,
        Wanted::Table(_) => table::part(name, found)?,
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
    evidence: bool,
) -> Result<Vec<u8>, SceneError> {
    let some = || found.iter().filter(|found| found.shape.is_some());
    let mut list: Vec<Shape> = some().filter_map(|found| found.shape.clone()).collect();
    let nodes = |one: &Found, of: fn(&NodeEvidence) -> Option<f64>| {
        let nodes = one.fit.as_ref().map_or(&[][..], |fit| &fit.nodes[..]);
        nodes.iter().map(of).collect::<Vec<Option<f64>>>()
    };
    let errors: Vec<_> = some().map(|one| nodes(one, |node| node.error)).collect();
    let edges: Vec<_> = some()
        .map(|one| nodes(one, |node| Some(node.strength)))
        .collect();
    let columns = [("error", &errors), ("edge", &edges)];
    if format == Format::Csv {
        let mut text = String::new();
        for (index, found) in found.iter().enumerate() {
            if let Some(why) = &found.unsure {
                let _ = writeln!(text, "# outline {}: {}", index + 1, io::text::plain(why));
            }
        }
        let columns = columns.map(|(name, values)| NodeColumn { name, values });
        let columns = if evidence { &columns[..] } else { &[] };
        text.push_str(&shapes::to_text_with(&list, columns));
        return Ok(text.into_bytes());
    }
    if evidence && matches!(format, Format::GeoJson | Format::Coco | Format::Labelme) {
        for (name, values) in columns {
            for (shape, values) in list.iter_mut().zip(values) {
                let value = |value: &Option<f64>| value.map_or(Value::Nothing, Value::Number);
                // GeoJSON has its rings one way round, and the lists go with them
                let list: Vec<Value> = if format == Format::GeoJson && runs_back(shape) {
                    values.iter().rev().map(value).collect()
                } else {
                    values.iter().map(value).collect()
                };
                shape
                    .properties
                    .insert(format!("node_{name}"), Value::List(list));
            }
        }
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

/// Whether a closed outline runs from y to x.
fn runs_back(shape: &Shape) -> bool {
    shape.closed == Some(true) && scene::elastic::signed_area(shape.first()) <= 0.0
}
