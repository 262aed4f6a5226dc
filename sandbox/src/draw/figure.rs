//! A page of panels, and how it becomes an SVG text.

use super::chart;
use super::embed;
use super::palette::Color;
use super::panel::{Panel, Picture};
use plotters::prelude::{DrawingAreaErrorKind, IntoDrawingArea, SVGBackend, WHITE};

/// Drawing units in one pixel of the page: plotters counts in whole units, and a curve of whole
/// pixels would look like a staircase.
pub(crate) const UNITS: f64 = 8.0;
/// The one line weight, in drawing units.
pub(crate) const LINE: f64 = 1.6 * UNITS;

/// The drawing library refused something.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw: {0}")]
pub struct DrawError(String);

impl DrawError {
    pub(crate) fn because(why: &str) -> Self {
        Self(why.to_owned())
    }
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for DrawError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self(error.to_string())
    }
}

/// Panels beside each other.
#[derive(Debug, Clone)]
pub struct Row {
    /// Height in page pixels, labels included.
    pub height: f64,
    /// From left to right, as wide as their shares.
    pub panels: Vec<Panel>,
}

impl Row {
    /// A row of panels.
    #[must_use]
    pub fn new(height: f64, panels: Vec<Panel>) -> Self {
        Self { height, panels }
    }
}

/// A whole figure.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Stands above, with the report's figure number.
    pub title: String,
    /// Width in page pixels.
    pub width: f64,
    /// From top to bottom.
    pub rows: Vec<Row>,
}

/// What the panels leave to the page.
#[derive(Debug, Default)]
pub(crate) struct Page {
    /// Each with its rectangle in drawing units.
    pub(crate) pictures: Vec<(Picture, [f64; 4])>,
}

impl Figure {
    /// A figure without rows.
    pub fn new(title: impl Into<String>, width: f64) -> Self {
        Self {
            title: title.into(),
            width,
            rows: Vec::new(),
        }
    }

    /// The same figure with one more row below.
    #[must_use]
    pub fn with(mut self, height: f64, panels: Vec<Panel>) -> Self {
        self.rows.push(Row::new(height, panels));
        self
    }

    /// The figure as SVG: text stays text, pictures are embedded, the same bytes every time.
    ///
    /// # Errors
    ///
    /// When the drawing library refuses, which a range of no length can bring about.
    pub fn svg(&self) -> Result<String, DrawError> {
        let head = if self.title.is_empty() { 0.0 } else { 30.0 };
        let height = head + self.rows.iter().map(|row| row.height).sum::<f64>();
        let size = (
            chart::units(self.width).unsigned_abs(),
            chart::units(height).unsigned_abs(),
        );
        let mut text = String::new();
        let mut page = Page::default();
        {
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&WHITE)?;
            if !self.title.is_empty() {
                let style = chart::text_style(14.0, Color::INK);
                root.draw_text(&self.title, &style, (chart::units(10.0), chart::units(8.0)))?;
            }
            let mut top = head;
            for row in &self.rows {
                let shares: f64 = row.panels.iter().map(|panel| panel.share).sum();
                let mut left = 0.0;
                for panel in &row.panels {
                    let width = self.width * panel.share / shares;
                    let area = root.clone().shrink(
                        (chart::units(left), chart::units(top)),
                        (chart::units(width), chart::units(row.height)),
                    );
                    chart::draw(&area, panel, &mut page)?;
                    left += width;
                }
                top += row.height;
            }
            root.present()?;
        }
        finish(&text, size, (self.width, height), &page)
    }
}

/// Sets the page's size in pixels, rounds the joints, and lays the pictures on the ground.
fn finish(
    text: &str,
    units: (u32, u32),
    pixels: (f64, f64),
    page: &Page,
) -> Result<String, DrawError> {
    let mut lines = text.lines();
    let mut out = format!(
        "<svg width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n\
         <style>polyline,line{{stroke-linejoin:round;stroke-linecap:round}}\
         text{{font-family:sans-serif}}</style>\n",
        pixels.0.round(),
        pixels.1.round(),
        units.0,
        units.1
    );
    lines.next(); // the opening tag just replaced
    for ground in lines.by_ref().take(1) {
        out.push_str(ground);
        out.push('\n');
    }
    for picture in embed::all(&page.pictures)? {
        out.push_str(&picture);
    }
    for line in lines {
        out.push_str(line);
        out.push('\n');
    }
    Ok(out
        .replace(" font-family=\"sans-serif\"", "")
        .replace(" opacity=\"1\"", ""))
}

#[cfg(test)]
mod tests {
    use super::super::panel::{Axis, Line};
    use super::*;

    fn figure() -> Figure {
        let points = (0..20).map(|i| (f64::from(i), f64::from(i * i))).collect();
        let panel = Panel::new(
            "squares",
            Axis::new("x / px", 0.0, 20.0),
            Axis::new("x²", 0.0, 400.0),
        )
        .with(Line::new(points, Color::BLUE).named("x² & more"));
        Figure::new("Figure 0", 400.0).with(300.0, vec![panel])
    }

    #[test]
    fn the_same_figure_gives_the_same_bytes() {
        assert_eq!(figure().svg(), figure().svg());
    }

    #[test]
    fn text_stays_text_and_is_escaped() {
        let svg = figure().svg().unwrap();
        assert!(svg.starts_with("<svg width=\"400\" height=\"330\""));
        assert!(svg.contains("Figure 0") && svg.contains("x² &amp; more"));
        assert!(svg.trim_end().ends_with("</svg>"));
    }
}
