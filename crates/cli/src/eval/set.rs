//! A data set in a folder: pictures with masks, and starts for each.

use std::path::{Path, PathBuf};

use glam::DVec2;
use io::IoError;

use super::csv::Table;

/// A picture, its truth and where to start.
#[derive(Debug)]
pub(super) struct Case {
    pub(super) stem: String,
    pub(super) picture: PathBuf,
    pub(super) mask: PathBuf,
    /// An image of labels, where there are many objects.
    pub(super) labels: Option<PathBuf>,
    pub(super) starts: Vec<Start>,
}

/// A start with the name of its kind.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) quality: String,
    pub(super) points: Vec<DVec2>,
    /// The seed's inner circle: center and radius.
    pub(super) circle: Option<(DVec2, f64)>,
}

/// What was read, and what was broken and left out.
#[derive(Debug, Default)]
pub(super) struct Set {
    pub(super) cases: Vec<Case>,
    pub(super) problems: Vec<String>,
    /// All tables that were read.
    pub(super) tables: Vec<PathBuf>,
    /// Whether the starts are seeds of many objects.
    pub(super) many: bool,
}

/// The radius of a start against the seed's inner circle, half the size of its object.
const LARGER: f64 = 1.6;

/// The quality of a seed.
pub(super) const SEED: &str = "seed";

impl Set {
    /// Read the tables of a folder.
    ///
    /// # Errors
    ///
    /// A table that is not there, is none, or lacks a column.
    pub(super) fn load(folder: &Path, inits: &[PathBuf]) -> Result<Self, IoError> {
        let mut set = Self::default();
        set.manifest(folder)?;
        let usual = [PathBuf::from("inits.csv")];
        let inits = if inits.is_empty() { &usual } else { inits };
        for name in inits {
            let within = folder.join(name);
            let path = if within.exists() || !name.exists() {
                within
            } else {
                name.clone()
            };
            set.starts(&path)?;
        }
        set.cases.retain(|case| !case.starts.is_empty());
        Ok(set)
    }

    /// The pictures and their masks.
    fn manifest(&mut self, folder: &Path) -> Result<(), IoError> {
        let path = folder.join("manifest.csv");
        let table = Table::load(&path)?;
        let file = table.needed(&path, "file")?;
        let mask = table.needed(&path, "mask")?;
        let labels = table.column("labels");
        let (sequence, frame) = (table.column("sequence"), table.column("frame"));
        for (line, row) in &table.rows {
            let value = |column: usize| {
                row.get(column)
                    .map(String::as_str)
                    .filter(|v| !v.is_empty())
            };
            let number = frame.and_then(value).map(str::parse::<u64>);
            if !matches!(number, None | Some(Ok(0))) {
                continue; // of a sequence, the start is in the first picture
            }
            let (Some(picture), Some(mask)) = (value(file), value(mask)) else {
                let message = "a picture and its mask are needed; the row is left out";
                self.problems
                    .push(format!("{}: line {line}: {message}", path.display()));
                continue;
            };
            let own = Path::new(picture)
                .file_stem()
                .and_then(|stem| stem.to_str());
            let stem = sequence.and_then(value).or(own).unwrap_or(picture);
            self.cases.push(Case {
                stem: stem.to_owned(),
                picture: folder.join(picture),
                mask: folder.join(mask),
                labels: labels.and_then(value).map(|name| folder.join(name)),
                starts: Vec::new(),
            });
        }
        self.tables.push(path);
        Ok(())
    }

    /// The starts of one file.
    fn starts(&mut self, path: &Path) -> Result<(), IoError> {
        let table = Table::load(path)?;
        let stem = table.needed(path, "stem")?;
        let form = match table.column("inner_r") {
            Some(radius) => {
                self.many = true;
                Form::Seed([table.needed(path, "cx")?, table.needed(path, "cy")?, radius])
            }
            None => Form::Polygon {
                quality: table.needed(path, "quality")?,
                points: table.needed(path, "points")?,
            },
        };
        for (line, row) in &table.rows {
            let value = |column: usize| row.get(column).map_or("", String::as_str);
            let case = self.cases.iter_mut().find(|case| case.stem == value(stem));
            let start = match form {
                Form::Seed(columns) => seed(columns.map(value)),
                Form::Polygon { quality, points } => polygon(value(points)).map(|points| Start {
                    quality: value(quality).to_owned(),
                    points,
                    circle: None,
                }),
            };
            let problem = match (case, start) {
                (Some(case), Ok(start)) => {
                    case.starts.push(start);
                    continue;
                }
                (None, _) => {
                    let name = io::text::clip(value(stem));
                    format!("no picture of the manifest is called \"{name}\"")
                }
                (_, Err(problem)) => problem,
            };
            let place = format!("{}: line {line}", path.display());
            self.problems
                .push(format!("{place}: {problem}; the row is left out"));
        }
        self.tables.push(path.to_owned());
        Ok(())
    }
}

/// How a table of starts gives them: by its columns.
#[derive(Clone, Copy)]
enum Form {
    Seed([usize; 3]),
    Polygon { quality: usize, points: usize },
}

/// A circle about a seed, larger than its inner circle.
fn seed(values: [&str; 3]) -> Result<Start, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let [Some(x), Some(y), Some(radius)] = values.map(number) else {
        return Err("cx, cy and inner_r must be numbers".to_owned());
    };
    if radius <= 0.0 {
        return Err(format!("inner_r must be above 0, got {radius}"));
    }
    let center = DVec2::new(x, y);
    let circle = scene::fit::Contour::circle(center, LARGER * radius);
    Ok(Start {
        quality: SEED.to_owned(),
        points: circle.points,
        circle: Some((center, radius)),
    })
}

/// A polygon as `x y;x y;...`.
pub(super) fn polygon(text: &str) -> Result<Vec<DVec2>, String> {
    let mut points = Vec::new();
    for pair in text.split(';').filter(|pair| !pair.trim().is_empty()) {
        let mut numbers = pair.split_whitespace().map(str::parse::<f64>);
        match (numbers.next(), numbers.next(), numbers.next()) {
            (Some(Ok(x)), Some(Ok(y)), None) if x.is_finite() && y.is_finite() => {
                points.push(DVec2::new(x, y));
            }
            _ => {
                let got = io::text::clip(pair);
                return Err(format!(
                    "points must be pairs of numbers, `x y;x y;...`, got \"{got}\""
                ));
            }
        }
    }
    if points.len() == 2 || points.is_empty() {
        return Err(format!(
            "a polygon must have at least 3 points (or 1, for a click), got {}",
            points.len()
        ));
    }
    Ok(points)
}
