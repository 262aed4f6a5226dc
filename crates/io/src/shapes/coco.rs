//! COCO JSON: outlines of objects as polygons from the corner of the first pixel, or as runs of
//! pixels.
//!
//! Polygons of one annotation are parts of one outline. What has holes is written as runs down the
//! columns of the picture, to whole pixels, as polygons cannot have any.

use std::collections::BTreeMap;

use glam::DVec2;
use serde_json::{Value as Out, json};

use super::budget::{Budget, cannot, point, unrepeated};
use super::format::{Context, Origin, Reading};
use super::geojson::shift;
use super::json::{At, Json, number_of, table_of};
use super::rings::{bounds, even_odd_area, parts};
use super::{Shape, Shapes, raster, runs};
use crate::IoError;
use crate::text::clip_to;

/// Members of an annotation that are no properties.
const OWN: [&str; 7] = [
    "id",
    "image_id",
    "category_id",
    "segmentation",
    "bbox",
    "area",
    "iscrowd",
];

pub(super) fn read(json: &Json, reading: &Reading) -> Result<Shapes, IoError> {
    let root = At::ROOT;
    let (list, at) = match json.list() {
        Some(list) => (list, root),
        None => {
            let at = root.key("annotations");
            let list = json.get("annotations").and_then(Json::list);
            (list.ok_or_else(|| at.refuse("a list is needed"))?, at)
        }
    };
    let images = names(json, "images", "file_name");
    let labels = names(json, "categories", "name");
    let wanted = wanted(list, &images, reading)?;
    let mut budget = Budget::default();
    let mut shapes = Shapes::new();
    for (index, one) in list.iter().enumerate() {
        let image = one.get("image_id").and_then(Json::name);
        if wanted.is_some() && image != wanted {
            continue;
        }
        let at = at.index(index);
        let rings = segmentation(one, &at, reading, &mut budget)?;
        if rings.is_empty() {
            continue;
        }
        let category = one.get("category_id").and_then(Json::name);
        let label = category.map(|id| labels.get(&id).cloned().unwrap_or(id));
        budget.shape().map_err(|what| at.refuse(what))?;
        let weight = label.as_ref().map_or(0, String::len) / 16;
        budget.points(weight).map_err(|what| at.refuse(what))?;
        shapes.push(Shape {
            id: one.get("id").and_then(Json::name),
            label,
            closed: Some(true),
            rings,
            properties: one.values(&OWN),
        });
    }
    if shapes.is_empty() {
        return Err(root.refuse("no outline; annotations with a segmentation are needed"));
    }
    Ok(shapes)
}

/// What ids stand for.
fn names(json: &Json, list: &str, name: &str) -> BTreeMap<String, String> {
    let entries = json.get(list).and_then(Json::list).unwrap_or(&[]).iter();
    let pair = |one: &Json| Some((one.get("id")?.name()?, one.get(name)?.name()?));
    entries.filter_map(pair).collect()
}

/// The id of the picture that is meant; None if all annotations are of one.
fn wanted(
    list: &[Json],
    images: &BTreeMap<String, String>,
    reading: &Reading,
) -> Result<Option<String>, IoError> {
    let at = At::ROOT.key("images");
    if let Some(wanted) = &reading.picture {
        let by_name = images.iter().find(|(_, name)| {
            let end = name.rsplit(['/', '\\']).next();
            *name == wanted || end == Some(wanted)
        });
        if let Some((id, _)) = by_name {
            return Ok(Some(id.clone()));
        }
        let known = |id: &String| id == wanted;
        let used = list.iter().filter_map(|one| one.get("image_id")?.name());
        if images.keys().any(known) || used.into_iter().any(|id| known(&id)) {
            return Ok(Some(wanted.clone()));
        }
        return Err(at.refuse(format!(
            "no picture is called {}; one of its {} is needed, by file name or id",
            clip_to(wanted, 60),
            images.len()
        )));
    }
    let all = images.values().map(String::as_str);
    if let (true, Some(name)) = (images.len() > 1, reading.own(all.clone())) {
        let own = images.iter().find(|(_, known)| *known == name);
        return Ok(own.map(|(id, _)| id.clone()));
    }
    let mut used = list.iter().filter_map(|one| one.get("image_id")?.name());
    let Some(first) = used.next() else {
        return Ok(None);
    };
    if !used.any(|id| id != first) {
        return Ok(None);
    }
    Err(at.refuse(match &reading.beside {
        Some(own) if !images.is_empty() => format!(
            "outlines of several pictures, and none is called {}; needed: the name of one of {}",
            clip_to(own, 60),
            several(all)
        ),
        _ => format!(
            "outlines of several pictures, {} in all; one is needed, by file name or id",
            images.len()
        ),
    }))
}

/// Some of these names, and how many more there are.
pub(super) fn several<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let shown = names.iter().take(5).map(|name| clip_to(name, 40));
    let shown = shown.collect::<Vec<_>>().join(", ");
    match names.len() {
        0..=5 => shown,
        all => format!("{shown} and {} more", all - 5),
    }
}

fn segmentation(
    one: &Json,
    at: &At<'_>,
    reading: &Reading,
    budget: &mut Budget,
) -> Result<Vec<Vec<DVec2>>, IoError> {
    let shift = shift(reading.origin.unwrap_or(Origin::Corner));
    let here = at.key("segmentation");
    let given = one.get("segmentation");
    match given {
        Some(json) if json.get("counts").is_some() => mask(json, &here, reading, budget),
        Some(json) if json.list().is_some_and(|list| !list.is_empty()) => {
            let list = json.list().unwrap_or(&[]);
            let mut rings = Vec::new();
            for (index, part) in list.iter().enumerate() {
                let at = here.index(index);
                let numbers = part
                    .numbers()
                    .ok_or_else(|| at.refuse("a list of numbers is needed"))?;
                rings.push(ring(numbers, &at, shift, budget)?);
            }
            Ok(rings)
        }
        // one polygon that is not in a list of its own
        Some(json) if json.numbers().is_some_and(|list| !list.is_empty()) => Ok(vec![ring(
            json.numbers().unwrap_or(&[]),
            &here,
            shift,
            budget,
        )?]),
        Some(Json::List(_) | Json::Numbers(_)) | None => {
            let at = at.key("bbox");
            match one.get("bbox").map(Json::numbers) {
                None => Ok(Vec::new()),
                Some(Some(&[x, y, w, h])) if w > 0.0 && h > 0.0 => {
                    let corners = [x, y, x + w, y, x + w, y + h, x, y + h];
                    Ok(vec![ring(&corners, &at, shift, budget)?])
                }
                Some(_) => Err(at.refuse("four numbers x, y, width, height are needed")),
            }
        }
        Some(_) => Err(here.refuse("a list of polygons, or counts and size, are needed")),
    }
}

fn ring(
    numbers: &[f64],
    at: &At<'_>,
    shift: DVec2,
    budget: &mut Budget,
) -> Result<Vec<DVec2>, IoError> {
    if !numbers.len().is_multiple_of(2) {
        return Err(at.refuse(format!(
            "{} numbers; pairs of x, y are needed",
            numbers.len()
        )));
    }
    budget
        .ring(numbers.len() / 2)
        .map_err(|what| at.refuse(what))?;
    let pairs = numbers.chunks_exact(2);
    let points = pairs.map(|pair| point(pair[0], pair[1]).map(|p| p + shift));
    let points: Result<Vec<DVec2>, String> = points.collect();
    let points = unrepeated(points.map_err(|what| at.refuse(what))?);
    if points.len() < 3 {
        return Err(at.refuse(format!(
            "{} different points; at least 3 are needed",
            points.len()
        )));
    }
    Ok(points)
}

fn mask(
    json: &Json,
    at: &At<'_>,
    reading: &Reading,
    budget: &mut Budget,
) -> Result<Vec<Vec<DVec2>>, IoError> {
    let size = match json.get("size").and_then(Json::numbers) {
        Some(&[height, width]) => runs::count(height).zip(runs::count(width)),
        _ => None,
    };
    let (height, width) = size.ok_or_else(|| {
        at.key("size")
            .refuse("two whole numbers height, width are needed")
    })?;
    reading
        .check_size(width, height)
        .map_err(|what| at.key("size").refuse(what))?;
    let at = at.key("counts");
    let refuse = |what: String| at.refuse(what);
    let unpacked = match json.get("counts") {
        Some(Json::Text(text)) => runs::unpacked(text).map_err(refuse)?,
        Some(Json::Numbers(list)) => list.clone(),
        _ => return Err(at.refuse("a text or a list of numbers is needed")),
    };
    let sum: f64 = unpacked.iter().sum();
    // whole numbers, of which each is checked when it is drawn
    if (sum - height as f64 * width as f64).abs() > 0.5 {
        return Err(at.refuse(format!(
            "the runs have {sum} pixels; {height}×{width} are needed"
        )));
    }
    runs::rings(&unpacked, [height, width], true, budget).map_err(refuse)
}

pub(super) fn write(shapes: &[Shape], context: &Context) -> Result<Vec<u8>, IoError> {
    let mut labels: Vec<&str> = shapes
        .iter()
        .map(|shape| shape.label.as_deref().unwrap_or("object"))
        .collect();
    labels.sort_unstable();
    labels.dedup();
    let categories = (1..)
        .zip(&labels)
        .map(|(id, name)| json!({"id": id, "name": name}));
    let ids = ids(shapes);
    let mut annotations: Vec<Out> = Vec::new();
    let mut budget = Budget::default();
    for ((number, shape), id) in (1..).zip(shapes).zip(ids) {
        let label = shape.label.as_deref().unwrap_or("object");
        let category = labels.partition_point(|known| *known < label) + 1;
        let mut one = table_of(&shape.properties);
        for name in OWN {
            one.remove(name);
        }
        one.insert("id".into(), id.into());
        one.insert("image_id".into(), 1.into());
        one.insert("category_id".into(), category.into());
        one.insert("iscrowd".into(), 0.into());
        area(number, shape, context, &mut budget, &mut one)?;
        annotations.push(one.into());
    }
    let name = context.picture.clone().unwrap_or_default();
    let image =
        json!({"id": 1, "file_name": name, "width": context.width, "height": context.height});
    let all = json!({
        "images": [image],
        "categories": categories.collect::<Vec<Out>>(),
        "annotations": annotations,
    });
    let mut text = all.to_string().into_bytes();
    text.push(b'\n');
    Ok(text)
}

/// The ids of outlines if all are whole numbers and different, else their numbers from 1 on.
fn ids(shapes: &[Shape]) -> Vec<u64> {
    let given = shapes
        .iter()
        .map(|shape| shape.id.as_ref()?.parse::<u64>().ok());
    let given: Option<Vec<u64>> = given
        .map(|id| id.filter(|&id| id > 0 && id < 1 << 53))
        .collect();
    if let Some(given) = given {
        let different: std::collections::BTreeSet<_> = given.iter().collect();
        if different.len() == given.len() {
            return given;
        }
    }
    (1..=shapes.len() as u64).collect()
}

/// The segmentation of an outline, its box and its area.
fn area(
    number: usize,
    shape: &Shape,
    context: &Context,
    budget: &mut Budget,
    one: &mut serde_json::Map<String, Out>,
) -> Result<(), IoError> {
    if shape.closed == Some(false) || shape.rings.iter().any(|ring| ring.len() < 3) {
        let message =
            format!("outline {number} is open or has fewer than 3 points; areas are needed");
        return Err(cannot("coco", message));
    }
    let refuse = |what: String| cannot("coco", format!("outline {number} {what}"));
    let holes = parts(&shape.rings)
        .map_err(refuse)?
        .iter()
        .any(|(_, holes)| !holes.is_empty());
    let corner = |p: DVec2| p + 0.5;
    if !holes {
        let flat = |ring: &Vec<DVec2>| -> Out {
            let points = ring.iter().map(|&p| corner(p));
            points
                .flat_map(|p| [number_of(p.x), number_of(p.y)])
                .collect()
        };
        let polygons: Vec<Out> = shape.rings.iter().map(flat).collect();
        one.insert("segmentation".into(), polygons.into());
        one.insert(
            "area".into(),
            number_of(even_odd_area(&shape.rings).map_err(refuse)?),
        );
        if let Some((low, high)) = bounds(shape.rings.iter().flatten()) {
            let (low, size) = (corner(low), high - low);
            let numbers = [low.x, low.y, size.x, size.y].map(number_of);
            one.insert("bbox".into(), numbers.to_vec().into());
        }
        return Ok(());
    }
    let size = [context.width, context.height];
    let part = raster::boxed(shape, size, budget).map_err(refuse)?;
    let Some(part) = part else {
        return Err(refuse(
            "has holes and no pixel in the picture; one at least is needed".to_owned(),
        ));
    };
    let runs = runs::of_columns(&part, size);
    let inside: usize = runs.iter().skip(1).step_by(2).sum();
    let rows = part.mask.len() / part.width;
    one.insert(
        "segmentation".into(),
        json!({"size": [context.height, context.width], "counts": runs}),
    );
    one.insert("area".into(), inside.into());
    one.insert(
        "bbox".into(),
        json!([part.left, part.top, part.width, rows]),
    );
    Ok(())
}
