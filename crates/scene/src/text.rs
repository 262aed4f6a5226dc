//! The text of a scene as a value: read, changed key by key, built and written.
//! Long because each of these is shown by an example that is a test.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use io::IoError;
use toml::{Table, Value};

use crate::error::clip;
use crate::limits::MOST_SCENE_BYTES;
use crate::scene::Scene;
use crate::{SceneError, catalogue, file, meaning, toml_error};

/// What the text of a scene says, whether it makes sense or not: [`SceneText::scene`] finds out.
///
/// ```
/// let mut text = scene::SceneText::named("soft-ball")?;
/// text.set("material.tension", "30")?;
/// text.set("run.scheme", "newmark")?;
/// assert!(text.to_string().contains("tension = 30"));
/// let again = scene::SceneText::parse("soft-ball", &text.to_string(), std::path::Path::new("."))?;
/// assert!(again == text && again.scene().is_ok());
///
/// let error = text.set("material.tensoin", "30").unwrap_err().to_string();
/// assert!(error.contains("did you mean \"tension\"?"), "{error}");
/// # Ok::<(), scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SceneText {
    name: String,
    folder: PathBuf,
    /// Files in memory, by the names in the text.
    held: Arc<meaning::Held>,
    /// The file it was read from.
    input: Option<PathBuf>,
    /// As it was read, comments and all.
    source: String,
    written: file::SceneText,
}

/// Texts that say the same are equal, wherever they come from and whatever their comments.
impl PartialEq for SceneText {
    fn eq(&self, other: &Self) -> bool {
        self.written == other.written
    }
}

impl SceneText {
    /// The text of a scene that comes with the program.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownScene`] with the nearest name.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        Self::parse(name, catalogue::text(name)?, Path::new("."))
    }

    /// The text of a file, or of standard input for `-`.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or whatever [`SceneText::parse`] refuses, by the file's name.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = io::read_text(path, "a scene in TOML", MOST_SCENE_BYTES)?;
        let name = path
            .file_stem()
            .map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or_else(|| Path::new("."));
        let mut text = Self::parse(&name, &text, folder)
            .map_err(|error| IoError::file(&io::called(path), error))?;
        text.input = Some(path.to_owned());
        Ok(text)
    }

    /// A text; files that it names are looked for in `folder`.
    ///
    /// # Errors
    ///
    /// Text that is no TOML, an unknown key (with the nearest known one), a missing key, a value of
    /// another type; by its line.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self, SceneError> {
        Ok(Self {
            name: name.to_owned(),
            folder: folder.to_owned(),
            held: Arc::default(),
            input: None,
            source: text.to_owned(),
            written: toml_error::parse(text)?,
        })
    }

    /// The same with files in memory, by the names that the text has for them: of those names none is looked for in
    /// the folder. So a scene can be read where there are no files at all.
    ///
    /// ```
    /// let mut text = scene::SceneText::named("soft-ball")?;
    /// text.set("snake.start", "{ file = \"ring.csv\" }")?;
    /// assert!(text.scene().is_err()); // there is no such file
    /// let ring = b"x,y\n4,8\n6,8\n6,9\n4,9\n".to_vec();
    /// let scene = text.with_files([("ring.csv".to_owned(), ring)].into()).scene()?;
    /// assert_eq!(scene.start.len(), 40); // nodes along the ring, as the text asks for
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn with_files(mut self, files: BTreeMap<String, Vec<u8>>) -> Self {
        self.held = Arc::new(files);
        self
    }

    /// Names of the files that the text reads, as it has them: pictures, masks, curves, maps.
    ///
    /// ```
    /// let mut text = scene::SceneText::named("soft-ball")?;
    /// assert!(text.files().is_empty());
    /// text.set("snake.start", "{ file = \"ring.csv\" }")?;
    /// assert_eq!(text.files(), ["ring.csv"]);
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn files(&self) -> Vec<String> {
        let names: BTreeSet<&String> = meaning::names(&self.written).into_iter().collect();
        names.into_iter().cloned().collect()
    }

    /// The text as it was read, with its comments and without any change.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The scene it describes.
    ///
    /// # Errors
    ///
    /// A value that makes no sense, by its key; a file it names that cannot be read.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let built = meaning::build(&self.name, &self.written, &self.folder, &self.held);
        let Some(path) = &self.input else {
            return built;
        };
        let mut scene = built.map_err(|error| IoError::file(&io::called(path), error))?;
        scene.inputs.push(path.clone());
        Ok(scene)
    }

    /// Give a key another value, or one that it had not.
    ///
    /// A key is written with its tables, `material.tension`; an entry of a list by its number from
    /// 0, `also.0.nodes`, and of `[[force]]` also by its name or its kind, `force.edge.strength`.
    /// The number after the last begins a new entry. The value is one of TOML; a word needs no
    /// quotes.
    ///
    /// # Errors
    ///
    /// A key that there is not, a value of another type; by the key. The text stays as it was.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SceneError> {
        let refuse = |message: String| SceneError::key(&clip(key), message);
        let value = value_of(value).map_err(refuse)?;
        let mut table = self.table().map_err(|e| refuse(e.to_string()))?;
        let parts: Vec<&str> = key.split('.').map(str::trim).collect();
        if parts.iter().any(|part| part.is_empty()) {
            return Err(refuse(
                "is no key; a key as material.tension is needed".to_owned(),
            ));
        }
        put(&mut table, &parts, value).map_err(refuse)?;
        self.written = toml_error::from_table(table).map_err(refuse)?;
        Ok(())
    }

    /// All that is given, as TOML has it.
    fn table(&self) -> Result<Table, toml::ser::Error> {
        Table::try_from(&self.written)
    }
}

/// A value as typed: TOML, or a word.
fn value_of(typed: &str) -> Result<Value, String> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Err("has no value; a value of TOML or a word is needed".to_owned());
    }
    match typed.parse::<Value>() {
        Ok(value) => Ok(value),
        Err(error) if typed.starts_with(['[', '{', '"', '\'']) => {
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            Err(format!("{} is no value of TOML: {message}", clip(typed)))
        }
        Err(_) => Ok(Value::String(typed.to_owned())),
    }
}

/// Put a value where a key of several parts leads, and make the tables on the way.
fn put(table: &mut Table, parts: &[&str], value: Value) -> Result<(), String> {
    let (Some(first), rest) = (parts.first(), parts.get(1..).unwrap_or_default()) else {
        return Ok(());
    };
    if rest.is_empty() {
        table.insert((*first).to_owned(), value);
        return Ok(());
    }
    let is_list = LISTS.contains(first);
    let inner = table
        .entry((*first).to_owned())
        .or_insert_with(|| match is_list {
            true => Value::Array(Vec::new()),
            false => Value::Table(Table::new()),
        });
    put_into(inner, first, rest, value)
}

/// Keys whose values are lists of tables.
const LISTS: [&str; 4] = ["force", "hand", "also", "wall"];

fn put_into(inner: &mut Value, name: &str, rest: &[&str], value: Value) -> Result<(), String> {
    match inner {
        Value::Table(table) => put(table, rest, value),
        Value::Array(list) => {
            let (Some(which), rest) = (rest.first(), rest.get(1..).unwrap_or_default()) else {
                return Ok(());
            };
            let at = place(list, name, which)?;
            if rest.is_empty() {
                match list.get_mut(at) {
                    Some(entry) => *entry = value,
                    None => list.push(value),
                }
                return Ok(());
            }
            if at == list.len() {
                list.push(Value::Table(Table::new()));
            }
            list.get_mut(at)
                .map_or(Ok(()), |entry| put_into(entry, which, rest, value))
        }
        other => Err(format!(
            "{name} is {} and has no keys; the whole value can be given",
            clip(&other.to_string())
        )),
    }
}

/// The number of an entry of a list, by its number or its name; that after the last for a new one.
fn place(list: &[Value], name: &str, which: &str) -> Result<usize, String> {
    let count = list.len();
    if let Ok(at) = which.parse::<usize>() {
        return if at <= count {
            Ok(at)
        } else {
            Err(format!(
                "{name} has {count} entries; the number must be at most {count}, which begins a new one, got {at}"
            ))
        };
    }
    let says = |entry: &Value, key: &str| entry.get(key).and_then(Value::as_str) == Some(which);
    let found = |key: &str| -> Vec<usize> {
        let entries = list.iter().enumerate();
        entries
            .filter(|(_, entry)| says(entry, key))
            .map(|(at, _)| at)
            .collect()
    };
    let named = found("name");
    let all = if named.is_empty() {
        found("kind")
    } else {
        named
    };
    match all[..] {
        [at] => Ok(at),
        [] => {
            let words = ["name", "kind"].into_iter().flat_map(|key| {
                list.iter()
                    .filter_map(move |entry| entry.get(key)?.as_str())
            });
            let meant = crate::error::meant(which, words);
            let which = clip(which);
            Err(format!(
                "{name} has no entry \"{which}\"{meant} ({count} entries, by number from 0)"
            ))
        }
        _ => Err(format!(
            "{name} has {} entries \"{}\"; the number of one is needed",
            all.len(),
            clip(which)
        )),
    }
}

/// The keys of all tables in the order in which they are written; others follow.
const ORDER: &[&str] = &[
    "version",
    "title",
    "report",
    "note",
    "rules",
    "view",
    "picture",
    "field",
    "force",
    "hand",
    "snake",
    "also",
    "contact",
    "upkeep",
    "tips",
    "material",
    "densities",
    "schedule",
    "maps",
    "world",
    "run",
    "record",
    "kind",
    "name",
    "at",
    "nodes",
    "topology",
    "start",
    "rest",
    "velocity",
    "spin",
    "frame",
    "tether",
    "tension",
    "rigidity",
    "mass",
    "damping",
    "internal",
    "point",
    "normal",
    "law",
    "scheme",
    "dt",
    "tolerance",
    "output",
    "steps",
    "time",
];

/// Entries in that order.
fn ordered(table: &Table) -> Vec<(&String, &Value)> {
    let mut all: Vec<_> = table.iter().collect();
    let place = |key: &str| ORDER.iter().position(|known| *known == key);
    all.sort_by_key(|(key, _)| place(key).unwrap_or(ORDER.len()));
    all
}

/// Whether a value is a list of tables, each under a heading of its own.
fn is_list(key: &str, value: &Value) -> bool {
    let entries = value.as_array();
    LISTS.contains(&key) && entries.is_some_and(|entries| !entries.is_empty())
}

/// Letters that a table may take within a line.
const INLINE: usize = 90;

/// A table under its heading, with lists of tables and long tables after it.
fn section(out: &mut String, heading: &str, table: &Table) -> fmt::Result {
    let long = |value: &Value| value.is_table() && value.to_string().len() > INLINE;
    let own_heading = |(key, value): &(&String, &Value)| is_list(key, value) || long(value);
    let (below, own): (Vec<_>, Vec<_>) = ordered(table).into_iter().partition(own_heading);
    if !own.is_empty() || below.is_empty() || heading.starts_with("[[") {
        writeln!(out, "\n{heading}")?;
    }
    for (key, value) in own {
        writeln!(out, "{key} = {value}")?;
    }
    let name = heading.trim_matches(['[', ']']);
    for (key, value) in below {
        let name = format!("{name}.{key}");
        match value {
            Value::Table(table) => section(out, &format!("[{name}]"), table)?,
            value => list(out, &name, value)?,
        }
    }
    Ok(())
}

fn list(out: &mut String, name: &str, value: &Value) -> fmt::Result {
    for entry in value.as_array().into_iter().flatten() {
        if let Value::Table(table) = entry {
            section(out, &format!("[[{name}]]"), table)?;
        }
    }
    Ok(())
}

/// As TOML: what is given, and nothing else.
impl fmt::Display for SceneText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let table = self.table().map_err(|_| fmt::Error)?;
        let mut out = String::new();
        let entries = ordered(&table);
        for (key, value) in &entries {
            if !value.is_table() && !is_list(key, value) {
                writeln!(out, "{key} = {value}")?;
            }
        }
        for (key, value) in entries {
            match value {
                Value::Table(table) => section(&mut out, &format!("[{key}]"), table)?,
                value if is_list(key, value) => list(&mut out, key, value)?,
                _ => {}
            }
        }
        f.write_str(&out)
    }
}
