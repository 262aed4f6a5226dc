//! A folder of results: one file for each picture, and one of several joined.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

use parquet::errors::ParquetError;
use sha2::{Digest as _, Sha256};

use crate::read::{StoreError, rows};
use crate::table::{self, Row};

/// Digits of a name: enough that of 10¹² pictures no two have the same.
const DIGITS: usize = 20;

/// The file that parts are joined into.
const JOINED: &str = "joined.parquet";

/// A picture's name, short.
type Key = [u8; DIGITS / 2];

/// The name of a picture in the table: its path as given, with `/` between its parts, without `.` and doubled bars.
///
/// ```
/// assert_eq!(store::name_of("./images//a.png".as_ref()), "images/a.png");
/// ```
#[must_use]
pub fn name_of(path: &Path) -> String {
    let mut name = String::new();
    for part in path.components() {
        match part {
            Component::CurDir => continue,
            Component::RootDir => name.push('/'),
            Component::Prefix(_) | Component::ParentDir | Component::Normal(_) => {
                if !name.is_empty() && !name.ends_with('/') {
                    name.push('/');
                }
                name.push_str(&part.as_os_str().to_string_lossy());
            }
        }
    }
    name
}

/// The name of the file that holds what a picture of that name gave: `part-` and the first 20 digits of the SHA-256
/// of the picture's name.
///
/// ```
/// assert_eq!(store::part_name("a.png"), "part-7f071235805fbf58a252.parquet");
/// ```
#[must_use]
pub fn part_name(image: &str) -> String {
    let mut name = "part-".to_owned();
    for byte in key(image) {
        let _ = write!(name, "{byte:02x}");
    }
    name + ".parquet"
}

fn key(image: &str) -> Key {
    let mut key = Key::default();
    let digest = Sha256::digest(image.as_bytes());
    key.copy_from_slice(&digest[..DIGITS / 2]);
    key
}

/// A folder of results.
#[derive(Debug, Clone)]
pub struct Results {
    folder: PathBuf,
    /// Rows of the pictures in the joined file that are no sure outlines.
    joined: HashMap<Key, usize>,
}

impl Results {
    /// Open a folder, which is made if it is not there.
    ///
    /// # Errors
    ///
    /// A folder that cannot be made or written; a joined file that is no table of results.
    pub fn open(folder: &Path) -> Result<Self, StoreError> {
        io::ready_folder(folder)?;
        let (path, mut joined) = (folder.join(JOINED), HashMap::new());
        if path.exists() {
            for (image, good) in rows(&path)? {
                *joined.entry(key(&image)).or_default() += usize::from(!good);
            }
        }
        let folder = folder.to_owned();
        Ok(Self { folder, joined })
    }

    /// Where what a picture gave is written.
    #[must_use]
    pub fn part(&self, image: &str) -> PathBuf {
        self.folder.join(part_name(image))
    }

    /// Whether what a picture gave is there, alone or in the joined file as it was when the folder was opened.
    #[must_use]
    pub fn is_finished(&self, image: &str) -> bool {
        self.joined.contains_key(&key(image)) || self.part(image).exists()
    }

    /// How many rows of a finished picture are no sure outlines, a refusal among them; None if it is not finished.
    ///
    /// # Errors
    ///
    /// A file that is no table of results.
    pub fn doubtful(&self, image: &str) -> Result<Option<usize>, StoreError> {
        if let Some(count) = self.joined.get(&key(image)) {
            return Ok(Some(*count));
        }
        let part = self.part(image);
        if !part.exists() {
            return Ok(None);
        }
        Ok(Some(rows(&part)?.iter().filter(|(_, good)| !good).count()))
    }

    /// Write what a picture gave, and say where.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self, image: &str, rows: &[Row<'_>]) -> Result<PathBuf, StoreError> {
        self.put(image, table::written(image, rows))
    }

    /// Write that a picture was refused, and why, so that it is not tried again.
    ///
    /// # Errors
    ///
    /// As [`Results::write`].
    pub fn refuse(&self, image: &str, reason: &str) -> Result<PathBuf, StoreError> {
        self.put(image, table::refused(image, reason))
    }

    fn put(
        &self,
        image: &str,
        bytes: Result<Vec<u8>, ParquetError>,
    ) -> Result<PathBuf, StoreError> {
        let bytes = bytes.map_err(|error| StoreError::Table {
            image: image.to_owned(),
            problem: error.to_string(),
        })?;
        let path = self.part(image);
        io::write_whole(&path, &bytes)?;
        Ok(path)
    }
}
