//! The files that the text of a scene names.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use io::shapes::{self, Shape};
use io::{Invalid, IoError, Picture, PictureReading};

use crate::SceneError;
use crate::file::{DampingText, ParameterText, SceneText, ShapeText, SourceText};

/// What files hold that lie in memory, by the names in the text.
pub(crate) type Held = BTreeMap<String, Vec<u8>>;

/// The files beside a scene, each read once: a pipe can be read no second time, and a hundred snakes may begin alike.
pub(super) struct Files<'a> {
    folder: &'a Path,
    held: &'a Held,
    contours: RefCell<BTreeMap<String, Rc<Shape>>>,
    pictures: RefCell<BTreeMap<String, Rc<Picture>>>,
}

impl<'a> Files<'a> {
    /// Those in memory, and for all others those of a folder.
    pub(super) fn of(folder: &'a Path, held: &'a Held) -> Self {
        Self {
            folder,
            held,
            contours: RefCell::default(),
            pictures: RefCell::default(),
        }
    }

    pub(super) fn contour(&self, name: &str) -> Result<Rc<Shape>, SceneError> {
        once(&self.contours, name, || match self.held.get(name) {
            Some(bytes) => shapes::parse_one_named(bytes, Path::new(name)),
            None => shapes::load_one(&self.folder.join(name)),
        })
    }

    /// A picture of which every pixel counts.
    pub(super) fn picture(&self, name: &str) -> Result<Rc<Picture>, SceneError> {
        once(&self.pictures, name, || {
            self.picture_with(name, Invalid::Refuse)
        })
    }

    /// A picture with a word on pixels that are no finite numbers; read anew each time.
    pub(super) fn picture_with(&self, name: &str, invalid: Invalid) -> Result<Picture, IoError> {
        let rule = PictureReading {
            invalid,
            ..PictureReading::default()
        };
        match self.held.get(name) {
            Some(bytes) => Picture::decode_named(bytes, Path::new(name), &rule),
            None => Picture::load_as(&self.folder.join(name), &rule),
        }
    }
}

fn once<T>(
    known: &RefCell<BTreeMap<String, Rc<T>>>,
    name: &str,
    load: impl FnOnce() -> Result<T, IoError>,
) -> Result<Rc<T>, SceneError> {
    if let Some(there) = known.borrow().get(name) {
        return Ok(Rc::clone(there));
    }
    let there = Rc::new(load()?);
    known
        .borrow_mut()
        .insert(name.to_owned(), Rc::clone(&there));
    Ok(there)
}

/// Every file that is read besides the text itself.
pub(super) fn named(text: &SceneText, folder: &Path) -> Vec<PathBuf> {
    let names = names(text).into_iter();
    names.map(|name| folder.join(name)).collect()
}

/// Their names as the text has them.
pub(crate) fn names(text: &SceneText) -> Vec<&String> {
    let picture = text.picture.iter();
    let pictures = picture.flat_map(|picture| [&picture.file, &picture.mask]);
    let mut names: Vec<&String> = pictures.flatten().collect();
    let snake = &text.snake;
    let others = text.also.iter().flat_map(|also| [&also.start, &also.rest]);
    let shapes = [Some(&snake.start), snake.rest.as_ref()].into_iter();
    for shape in shapes.flatten().chain(others.flatten()) {
        if let ShapeText::File(file) = shape {
            names.push(file);
        }
    }
    let materials = text.also.iter().filter_map(|also| also.material.as_ref());
    for material in std::iter::once(&text.material).chain(materials) {
        let parameters = [&material.tether, &material.tension, &material.rigidity];
        names.extend(parameters.into_iter().filter_map(map));
    }
    let densities = text.also.iter().filter_map(|also| also.densities.as_ref());
    for densities in std::iter::once(&text.densities).chain(densities) {
        names.extend(map(&densities.mass));
        if let DampingText::Given(damping) = &densities.damping {
            names.extend(map(damping));
        }
    }
    names
}

/// The file of a parameter's map.
fn map(parameter: &ParameterText) -> Option<&String> {
    match parameter.map.as_ref()?.map {
        SourceText::File(ref file) => Some(file),
        _ => None,
    }
}
