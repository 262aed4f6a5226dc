//! What a panel shows, as data: two axes and layers from the ground up.

use super::palette::Color;
use ndarray::Array2;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    Linear,
    /// Equal steps for equal ratios. Values at or below zero are left out.
    Log,
}

/// One axis: what it measures, in which unit, from where to where.
///
/// `from` may be larger than `to`: rows of a picture grow downwards.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Words with the unit; empty for none.
    pub label: String,
    /// The value at the left or the bottom.
    pub from: f64,
    /// The value at the right or the top.
    pub to: f64,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// At most about so many numbers are written; none draws no numbers.
    pub ticks: usize,
}

impl Axis {
    /// A linear axis.
    pub fn new(label: impl Into<String>, from: f64, to: f64) -> Self {
        Self {
            label: label.into(),
            from,
            to,
            scale: Scale::Linear,
            ticks: 6,
        }
    }

    /// A logarithmic axis. Both ends must be above zero.
    pub fn log(label: impl Into<String>, from: f64, to: f64) -> Self {
        // one number a decade, none between
        let decades = (to / from).log10().abs().round();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a double has some 600 decades"
        )]
        #[expect(clippy::cast_sign_loss, reason = "an absolute value")]
        let ticks = decades as usize + 1;
        Self {
            scale: Scale::Log,
            ticks,
            ..Self::new(label, from, to)
        }
    }

    /// The same axis with at most about so many numbers.
    #[must_use]
    pub fn with_ticks(mut self, ticks: usize) -> Self {
        self.ticks = ticks;
        self
    }

    /// Where a value stands: itself, or its logarithm.
    pub(crate) fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.log10(),
        }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Without gaps.
    Solid,
    /// Dashes, for exact answers and limits.
    Dashed,
}

/// A line through points, in the panel's coordinates.
#[derive(Debug, Clone)]
pub struct Line {
    /// The points in order; points that are not finite break the line.
    pub points: Vec<(f64, f64)>,
    /// Its color.
    pub color: Color,
    /// Solid or dashed.
    pub dash: Dash,
    /// Width in units of the one line weight.
    pub weight: f64,
    /// What the legend calls it; empty for no entry.
    pub label: String,
}

impl Line {
    /// A solid line of weight 1.
    #[must_use]
    pub fn new(points: Vec<(f64, f64)>, color: Color) -> Self {
        Self {
            points,
            color,
            dash: Dash::Solid,
            weight: 1.0,
            label: String::new(),
        }
    }

    /// The same line, named in the legend.
    #[must_use]
    pub fn named(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same line, dashed.
    #[must_use]
    pub fn dashed(mut self) -> Self {
        self.dash = Dash::Dashed;
        self
    }

    /// The same line, thinner or thicker.
    #[must_use]
    pub fn weighing(mut self, weight: f64) -> Self {
        self.weight = weight;
        self
    }

    /// The same line, led back to its first point.
    #[must_use]
    pub fn closed(mut self) -> Self {
        if let Some(&first) = self.points.first() {
            self.points.push(first);
        }
        self
    }
}

/// A grid of colored pixels, laid over a rectangle of the panel.
#[derive(Debug, Clone)]
pub struct Picture {
    /// One color a pixel, `[[row, column]]`, first row on top.
    pub pixels: Array2<Color>,
    /// Left, top, right, bottom in the panel's coordinates: outer borders of the pixels.
    pub extent: [f64; 4],
    /// 1 covers, less lets the white ground through.
    pub opacity: f64,
    /// Whether pixels may run into each other when drawn larger.
    pub smooth: bool,
}

impl Picture {
    /// A picture whose pixel centers lie at whole numbers, the first at (0, 0).
    #[must_use]
    pub fn new(pixels: Array2<Color>) -> Self {
        let (rows, columns) = pixels.dim();
        let extent = [
            -0.5,
            -0.5,
            crate::real(columns) - 0.5,
            crate::real(rows) - 0.5,
        ];
        Self {
            pixels,
            extent,
            opacity: 1.0,
            smooth: false,
        }
    }

    /// The same picture, spread over another rectangle.
    #[must_use]
    pub fn over(mut self, extent: [f64; 4]) -> Self {
        self.extent = extent;
        self
    }

    /// The same picture, paler.
    #[must_use]
    pub fn faded(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }
}

/// One thing in a panel.
#[derive(Debug, Clone)]
pub enum Layer {
    /// A line.
    Line(Line),
    /// Small discs at points: position, radius in units of the line weight, color.
    Dots {
        /// Where.
        points: Vec<(f64, f64)>,
        /// Radius in units of the one line weight.
        radius: f64,
        /// Their color.
        color: Color,
        /// What the legend calls them; empty for no entry.
        label: String,
    },
    /// Arrows: start and vector, in the panel's coordinates.
    Arrows {
        /// Start and vector of each.
        arrows: Vec<((f64, f64), (f64, f64))>,
        /// Their color.
        color: Color,
    },
    /// A picture; always below everything else.
    Picture(Picture),
    /// A filled area.
    Area {
        /// Its border.
        points: Vec<(f64, f64)>,
        /// Its color.
        color: Color,
        /// 1 covers.
        opacity: f64,
    },
    /// Words in the panel.
    Text {
        /// Where its left end, or its middle, is.
        at: (f64, f64),
        /// The words.
        words: String,
        /// Their color.
        color: Color,
        /// Whether `at` is the middle.
        centered: bool,
    },
}

/// Where the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Top left.
    TopLeft,
    /// Top right.
    TopRight,
    /// Bottom left.
    BottomLeft,
    /// Bottom right.
    BottomRight,
}

/// Two axes and what is between them.
#[derive(Debug, Clone)]
pub struct Panel {
    /// A short heading; may be empty.
    pub title: String,
    /// From left to right.
    pub x: Axis,
    /// From bottom to top.
    pub y: Axis,
    /// From the ground up.
    pub layers: Vec<Layer>,
    /// Whether one unit is as long in both directions.
    pub equal: bool,
    /// Where the legend stands; entries are the layers' labels.
    pub legend: Corner,
    /// Whether grid lines are drawn.
    pub grid: bool,
    /// Share of the row's width, relative to its neighbours.
    pub share: f64,
}

impl Panel {
    /// An empty panel with grid lines and the legend at the top right.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            layers: Vec::new(),
            equal: false,
            legend: Corner::TopRight,
            grid: true,
            share: 1.0,
        }
    }

    /// A panel for something in a picture of so many pixels: x right, y down, equal units.
    pub fn pixels(title: impl Into<String>, width: usize, height: usize) -> Self {
        let (right, bottom) = (crate::real(width) - 0.5, crate::real(height) - 0.5);
        let mut panel = Self::new(
            title,
            Axis::new("x / px", -0.5, right),
            Axis::new("y / px", bottom, -0.5),
        );
        panel.equal = true;
        panel.grid = false;
        panel
    }

    /// The same panel with one more layer on top.
    #[must_use]
    pub fn with(mut self, layer: impl Into<Layer>) -> Self {
        self.layers.push(layer.into());
        self
    }

    /// The same panel with its legend elsewhere.
    #[must_use]
    pub fn legend_at(mut self, corner: Corner) -> Self {
        self.legend = corner;
        self
    }

    /// The same panel with one unit as long in both directions.
    #[must_use]
    pub fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    /// The same panel without axis numbers, labels and grid: for strips of pictures.
    #[must_use]
    pub fn bare(mut self) -> Self {
        for axis in [&mut self.x, &mut self.y] {
            axis.ticks = 0;
            axis.label.clear();
        }
        self.grid = false;
        self
    }
}

impl From<Line> for Layer {
    fn from(line: Line) -> Self {
        Self::Line(line)
    }
}

impl From<Picture> for Layer {
    fn from(picture: Picture) -> Self {
        Self::Picture(picture)
    }
}
