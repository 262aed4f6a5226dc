//! What an experiment is.

use crate::Record;
use crate::demand::{Demand, judged};
use crate::draw::{Animation, Figure};
use crate::error::Result;

/// What a claim turned out to be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The numbers it was judged by, in words.
    pub measured: String,
    /// Whether it holds.
    pub holds: bool,
}

impl Finding {
    /// A finding.
    pub fn new(holds: bool, measured: impl Into<String>) -> Self {
        Self {
            measured: measured.into(),
            holds,
        }
    }
}

/// Something that must be seen in the figure.
#[derive(Debug, Clone, Copy)]
pub struct Claim {
    words: Words,
    judge: Judge,
}

/// How a claim is judged.
#[derive(Debug, Clone, Copy)]
enum Judge {
    /// By demands on numbers, all of which must be met.
    Demands(&'static [Demand]),
    /// By code of its own.
    Own(fn(&Record) -> Result<Finding>),
}

/// A claim in words, not yet with what decides it.
#[derive(Debug, Clone, Copy)]
pub struct Words(&'static str);

/// A claim in words with its source in brackets behind them: a place in the report, or a slip by
/// its number.
#[must_use]
pub const fn claim(words: &'static str) -> Words {
    Words(words)
}

impl Words {
    /// Holds when every demand is met.
    #[must_use]
    pub const fn when(self, demands: &'static [Demand]) -> Claim {
        let judge = Judge::Demands(demands);
        Claim { words: self, judge }
    }

    /// Is judged by code of its own.
    #[must_use]
    pub const fn judged(self, judge: fn(&Record) -> Result<Finding>) -> Claim {
        let judge = Judge::Own(judge);
        Claim { words: self, judge }
    }
}

impl Claim {
    /// In words.
    #[must_use]
    pub fn says(&self) -> &'static str {
        self.parts().0
    }

    /// Who says so: a place in the report, or a slip by its number.
    #[must_use]
    pub fn source(&self) -> &'static str {
        self.parts().1
    }

    /// The words, and what stands in the last brackets behind them, which may have some inside.
    fn parts(&self) -> (&'static str, &'static str) {
        let text = self.words.0;
        let mut depth = 0;
        let open = text.char_indices().rev().find(|(_, c)| {
            depth += i32::from(*c == ']') - i32::from(*c == '[');
            *c == '[' && depth == 0
        });
        match (open, text.strip_suffix(']')) {
            (Some((at, _)), Some(inside)) => (text[..at].trim_end(), &inside[at + 1..]),
            _ => (text, ""),
        }
    }

    /// Reads the record and judges.
    ///
    /// # Errors
    ///
    /// When it asks for what was not recorded.
    pub fn judge(&self, record: &Record) -> Result<Finding> {
        match self.judge {
            Judge::Demands(demands) => judged(record, demands),
            Judge::Own(judge) => judge(record),
        }
    }
}

/// A drawing before it is bytes.
#[derive(Debug, Clone)]
pub enum Body {
    /// Becomes an SVG file.
    Figure(Figure),
    /// Becomes a GIF file.
    Animation(Animation),
}

impl From<Figure> for Body {
    fn from(figure: Figure) -> Self {
        Self::Figure(figure)
    }
}

impl From<Animation> for Body {
    fn from(animation: Animation) -> Self {
        Self::Animation(animation)
    }
}

/// A drawing, its place among those of the same experiment, and what it shows.
#[derive(Debug, Clone)]
pub struct Artefact {
    /// Follows the experiment's id in the file name; empty for the main figure.
    pub suffix: &'static str,
    /// One line under it.
    pub caption: &'static str,
    /// The drawing.
    pub body: Body,
}

/// What drawing an experiment gives.
pub type Drawn = Result<Vec<Artefact>>;

impl Artefact {
    /// The main figure.
    #[must_use]
    pub fn figure(caption: &'static str, figure: Figure) -> Self {
        Self::further("", caption, figure)
    }

    /// A further drawing.
    #[must_use]
    pub fn further(suffix: &'static str, caption: &'static str, body: impl Into<Body>) -> Self {
        let body = body.into();
        Self {
            suffix,
            caption,
            body,
        }
    }

    /// The main figure, and no other.
    ///
    /// # Errors
    ///
    /// None.
    pub fn only(caption: &'static str, figure: Figure) -> Drawn {
        Ok(vec![Self::figure(caption, figure)])
    }
}

/// A question with a picture.
#[derive(Debug, Clone, Copy)]
pub struct Experiment {
    /// Names its files and its flag: `fig-4-1`.
    pub id: &'static str,
    /// A few words.
    pub title: &'static str,
    /// Where it stands in the report: `Figure 4.1`, `§3.4.2`.
    pub place: &'static str,
    /// What is asked, in a sentence or two.
    pub question: &'static str,
    /// What must be seen.
    pub claims: &'static [Claim],
    /// Computes; draws nothing.
    pub run: fn() -> Result,
    /// Draws; computes nothing.
    pub draw: fn(&Record) -> Drawn,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_its_words_and_its_source() {
        for (text, says, source) in [
            ("it holds [report §2.3]", "it holds", "report §2.3"),
            ("it holds [[a], [b]]", "it holds", "[a], [b]"),
            (
                "it holds in [0, 1] [theory]",
                "it holds in [0, 1]",
                "theory",
            ),
            ("it holds", "it holds", ""),
        ] {
            let claim = claim(text).when(&[]);
            assert_eq!((claim.says(), claim.source()), (says, source));
        }
    }
}
