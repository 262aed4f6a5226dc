//! Which columns of a table hold what, by their headings.

use super::format::Column;

/// Names of a column of x, lower case.
const X: [&str; 10] = [
    "x",
    "position_x",
    "pos_x",
    "x_position",
    "x_coord",
    "x_coordinate",
    "coord_x",
    "col",
    "column",
    "xcoord",
];
/// Names of a column of y.
const Y: [&str; 9] = [
    "y",
    "position_y",
    "pos_y",
    "y_position",
    "y_coord",
    "y_coordinate",
    "coord_y",
    "row",
    "ycoord",
];
/// Names of a column that tells curves apart.
const CURVE: [&str; 14] = [
    "curve",
    "contour",
    "id",
    "label",
    "track",
    "track_id",
    "trackid",
    "object",
    "object_id",
    "cell",
    "roi",
    "polygon",
    "shape",
    "index",
];
/// Names of a column that tells the frames of a sequence apart.
const FRAME: [&str; 2] = ["frame", "frame_index"];
/// Units that are pixels.
const PIXELS: [&str; 5] = ["px", "pixel", "pixels", "pix", ""];
/// Units that are not, where they follow a name without brackets.
const LENGTHS: [&str; 12] = [
    "um", "µm", "μm", "micron", "microns", "nm", "mm", "cm", "m", "in", "inch", "deg",
];

/// The columns of a table by their number from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Columns {
    pub x: usize,
    pub y: usize,
    /// Which curve a point belongs to.
    pub curve: Option<usize>,
    /// In which frame of a sequence it is; the curve too, where nothing else tells curves apart.
    pub frame: Option<usize>,
    /// Whether that curve is closed: 1 or 0.
    pub closed: Option<usize>,
    /// Which ring of its curve a point belongs to.
    pub ring: Option<usize>,
    /// How many there are.
    pub count: usize,
}

impl Columns {
    /// Of a table without a heading.
    pub(super) const TWO: Self = Self {
        x: 0,
        y: 1,
        curve: None,
        frame: None,
        closed: None,
        ring: None,
        count: 2,
    };

    /// Of a table without a heading, of which these columns are asked for.
    ///
    /// # Errors
    /// Columns by name.
    pub(super) fn numbered((x, y): &(Column, Column), count: usize) -> Result<Self, String> {
        let at = |column: &Column| match column {
            Column::Number(number) if (1..=count).contains(number) => Ok(number - 1),
            Column::Number(number) => Err(format!("{count} columns; column {number} is asked for")),
            Column::Name(_) => Err(
                "no heading; one that names the columns that are asked for is needed".to_owned(),
            ),
        };
        Ok(Self {
            x: at(x)?,
            y: at(y)?,
            count,
            ..Self::TWO
        })
    }

    /// By a heading, but for the columns of x and y that are asked for.
    ///
    /// # Errors
    /// A column that is not there.
    pub(super) fn given(words: &[String], (x, y): &(Column, Column)) -> Result<Self, String> {
        let at = |column: &Column| match column {
            Column::Number(number) => Some(number - 1).filter(|at| *at < words.len()),
            Column::Name(wanted) => {
                let wanted = wanted.trim();
                let same = |word: &String| word.trim() == wanted;
                let like = |word: &String| word.trim().to_lowercase() == wanted.to_lowercase();
                words
                    .iter()
                    .position(same)
                    .or_else(|| words.iter().position(like))
            }
        };
        let need = |column| at(column).ok_or("a column that is asked for is not in the heading");
        let (x, y) = (need(x)?, need(y)?);
        Ok(Self {
            x,
            y,
            ..Self::beside(
                &words.iter().map(|word| name(word)).collect::<Vec<_>>(),
                &[x, y],
            )
        })
    }

    /// By a heading.
    ///
    /// # Errors
    /// What is wrong with it: no x or y, more than one, another unit than pixels.
    pub(super) fn of(words: &[String]) -> Result<Self, String> {
        let names: Vec<(String, String)> = words.iter().map(|word| name(word)).collect();
        let (x, y) = match axes(&names) {
            Some(last) => last,
            None => (only(&names, &X, "x")?, only(&names, &Y, "y")?),
        };
        for at in [x, y] {
            let unit = &names[at].1;
            if !PIXELS.contains(&unit.as_str()) {
                return Err(format!(
                    "column {} is in another unit than pixels, which are needed",
                    at + 1
                ));
            }
        }
        Ok(Self {
            x,
            y,
            ..Self::beside(&names, &[])
        })
    }

    /// Those besides x and y, of which none is among some that are taken.
    fn beside(names: &[(String, String)], taken: &[usize]) -> Self {
        let find = |known: &[&str]| {
            // the first name on the list that there is
            let at = |wanted: &&str| {
                let mut all = (0..names.len()).filter(|at| !taken.contains(at));
                all.find(|&at| names[at].0 == *wanted)
            };
            known.iter().find_map(at)
        };
        let frame = find(&FRAME);
        Self {
            x: 0,
            y: 1,
            curve: find(&CURVE).or(frame),
            frame,
            closed: find(&["closed"]),
            ring: find(&["ring"]),
            count: names.len(),
        }
    }
}

/// Axes that are numbered, rows before columns: the last is x and the one before it y.
fn axes(names: &[(String, String)]) -> Option<(usize, usize)> {
    let numbered = |k: usize| {
        names
            .iter()
            .position(|(name, _)| *name == format!("axis-{k}"))
    };
    let last = (0..8).rev().find(|&k| numbered(k).is_some())?;
    Some((numbered(last)?, numbered(last.checked_sub(1)?)?))
}

/// The one column that has one of these names.
fn only(names: &[(String, String)], known: &[&str], axis: &str) -> Result<usize, String> {
    let mut found = (0..names.len()).filter(|&i| known.contains(&names[i].0.as_str()));
    match (found.next(), found.next()) {
        (Some(at), None) => Ok(at),
        (None, _) => Err(format!("the heading must name a column {axis}")),
        (Some(_), Some(_)) => Err(format!("the heading names {axis} more than once")),
    }
}

/// A name in lower case, and its unit: `X (px)`, `x [um]`, `x/px`, `x_mm`.
fn name(word: &str) -> (String, String) {
    let word = word.trim().to_lowercase();
    let bracket = word.find(['(', '[', '/']);
    let (name, unit) = match bracket {
        Some(at) => {
            let inside = |c: char| matches!(c, '(' | '[' | '/' | ')' | ']') || c.is_whitespace();
            (word[..at].trim(), word[at..].trim_matches(inside))
        }
        None => match word.rsplit_once(['_', ' ', '-']) {
            Some((name, unit)) if LENGTHS.contains(&unit) || PIXELS.contains(&unit) => {
                (name.trim(), unit)
            }
            _ => (word.as_str(), ""),
        },
    };
    // "position x" and "position-x" are "position_x"; "axis-0" stays
    let name = if name.starts_with("axis") {
        name.replace([' ', '_'], "-")
    } else {
        name.replace([' ', '-'], "_")
    };
    (name, unit.to_owned())
}

/// Whether words can be a heading: names, some of them perhaps blank, and none of them begun as a number.
pub(super) fn is_heading(words: &[String]) -> bool {
    let begins = |word: &String| word.chars().next().is_none_or(char::is_alphabetic);
    words.iter().all(begins) && words.iter().any(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<(usize, usize), String> {
        let words: Vec<String> = line.split(',').map(str::to_owned).collect();
        Columns::of(&words).map(|columns| (columns.x, columns.y))
    }

    #[test]
    fn columns_are_found_by_the_names_that_programs_give_them() {
        for (line, at) in [
            ("x,y", (0, 1)),
            (" ,X,Y", (1, 2)),
            ("y,x", (1, 0)),
            ("row,col", (1, 0)),
            ("index,axis-0,axis-1", (2, 1)),
            ("index,axis-0,axis-1,axis-2", (3, 2)),
            ("FRAME,POSITION_X,POSITION_Y", (1, 2)),
            ("Position X,Position Y", (0, 1)),
            ("x (px),y (px)", (0, 1)),
            ("x [pixel],y [pixel]", (0, 1)),
            ("x/px,y/px", (0, 1)),
            ("x_px,y_px", (0, 1)),
            ("id,x,y,area", (1, 2)),
        ] {
            assert_eq!(of(line), Ok(at), "{line}");
        }
    }

    #[test]
    fn frames_tell_outlines_apart_where_nothing_else_does() {
        for (line, curve, frame) in [
            ("frame,id,x,y", Some(1), Some(0)),
            ("x,y,frame", Some(2), Some(2)),
            ("x,y,curve", Some(2), None),
        ] {
            let words: Vec<String> = line.split(',').map(str::to_owned).collect();
            let columns = Columns::of(&words).unwrap();
            assert_eq!((columns.curve, columns.frame), (curve, frame), "{line}");
        }
    }

    #[test]
    fn other_names_twice_the_same_and_other_units_are_refused() {
        for (line, says) in [
            ("a,b", "must name a column x"),
            ("x,z", "must name a column y"),
            ("breadth,height", "must name a column x"),
            ("x,y,x", "names x more than once"),
            ("x,col,y", "names x more than once"),
            ("x [um],y [um]", "another unit"),
            ("x (µm),y (µm)", "another unit"),
            ("x,y (in)", "column 2 is in another unit"),
            ("x_mm,y_mm", "another unit"),
            ("axis-0,b", "must name a column x"),
        ] {
            let error = of(line).unwrap_err();
            assert!(error.contains(says), "{line}: {error}");
        }
    }
}
