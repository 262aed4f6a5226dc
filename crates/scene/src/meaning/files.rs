//! The files that the text of a scene names.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use io::shapes::{self, Shape};
use io::{IoError, Picture};

use crate::SceneError;
use crate::file::{DampingText, ParameterText, SceneText, ShapeText, SourceText};

/// The files beside a scene, each read once: a pipe can be read no second time, and a hundred snakes may begin alike.
pub(super) struct Files<'a> {
    folder: &'a Path,
    contours: RefCell<BTreeMap<PathBuf, Rc<Shape>>>,
    pictures: RefCell<BTreeMap<PathBuf, Rc<Picture>>>,
}

impl<'a> Files<'a> {
    pub(super) fn of(folder: &'a Path) -> Self {
        Self {
            folder,
            contours: RefCell::default(),
            pictures: RefCell::default(),
        }
    }

    /// Where a file lies.
    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub(super) fn contour(&self, name: &str) -> Result<Rc<Shape>, SceneError> {
        once(&self.contours, self.path(name), shapes::load_one)
    }

    /// A picture of which every pixel counts.
    pub(super) fn picture(&self, name: &str) -> Result<Rc<Picture>, SceneError> {
        once(&self.pictures, self.path(name), Picture::load)
    }
}

fn once<T>(
    known: &RefCell<BTreeMap<PathBuf, Rc<T>>>,
    path: PathBuf,
    load: fn(&Path) -> Result<T, IoError>,
) -> Result<Rc<T>, SceneError> {
    if let Some(there) = known.borrow().get(&path) {
        return Ok(Rc::clone(there));
    }
    let there = Rc::new(load(&path)?);
    known.borrow_mut().insert(path, Rc::clone(&there));
    Ok(there)
}

/// Every file that is read besides the text itself.
pub(super) fn named(text: &SceneText, folder: &Path) -> Vec<PathBuf> {
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
    names.into_iter().map(|name| folder.join(name)).collect()
}

/// The file of a parameter's map.
fn map(parameter: &ParameterText) -> Option<&String> {
    match parameter.map.as_ref()?.map {
        SourceText::File(ref file) => Some(file),
        _ => None,
    }
}
