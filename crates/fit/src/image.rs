//! What a fit is done on: levels of grey, colors if there are, and which pixels count.

use std::sync::{Arc, OnceLock};

use field::{EdgeForce, FieldError, ForceField, Grid, MaskedImage, Pixel, Pixels, Recipe};
use field::{counted_limits, lazy_force, level_limits, level_spread};
use ndarray::{ArcArray2, Array2};

/// Probabilities nearer to 0 and 1 than this are as sure.
const SMALL: f64 = 1e-4;

/// An image. A clone shares the pixels and costs nothing.
#[derive(Debug, Clone)]
pub struct Image(Arc<dyn Pixels>);

impl Image {
    /// An image of grey levels.
    #[must_use]
    pub fn grey(levels: Grid) -> Self {
        Self(Arc::new(Levels { levels }))
    }

    /// An image of grey bytes, kept as they are: levels from 0 to 255.
    #[must_use]
    pub fn bytes(pixels: ArcArray2<u8>) -> Self {
        Self(Arc::new(Kept::new(pixels, 1.0, true)))
    }

    /// An image of grey words of 16 bits, kept as they are: levels from 0 to 255.
    #[must_use]
    pub fn words(pixels: ArcArray2<u16>) -> Self {
        Self(Arc::new(Kept::new(pixels, 1.0 / 257.0, true)))
    }

    /// An image of grey floats, kept as they are; from 0 to 1 they are levels from 0 to 255.
    #[must_use]
    pub fn floats(pixels: ArcArray2<f32>) -> Self {
        Self(Arc::new(Kept::new(pixels, 255.0, false)))
    }

    /// An image of red, green and blue; its grey is `0.299 R + 0.587 G + 0.114 B`.
    ///
    /// # Errors
    ///
    /// Channels of different sizes.
    pub fn color(channels: [Grid; 3]) -> Result<Self, FieldError> {
        let [red, green, blue] = &channels;
        for other in [green, blue] {
            if other.dim() != red.dim() {
                let (first, second) = (red.dim(), other.dim());
                return Err(FieldError::ShapesDiffer { first, second });
            }
        }
        let mut levels = Grid::zeros(red.dim());
        ndarray::Zip::from(&mut levels)
            .and(red)
            .and(green)
            .and(blue)
            .for_each(|level, r, g, b| *level = 0.299 * r + 0.587 * g + 0.114 * b);
        Ok(Self(Arc::new(Colors { levels, channels })))
    }

    /// An image of pixels kept by someone else.
    #[must_use]
    pub fn of(pixels: Arc<dyn Pixels>) -> Self {
        Self(pixels)
    }

    /// The same image of which only the pixels count that are true in `valid`.
    ///
    /// # Errors
    ///
    /// A mask of another size, or one that leaves no pixel.
    pub fn with_mask(self, valid: Array2<bool>) -> Result<Self, FieldError> {
        let (width, height) = self.size();
        MaskedImage::new(&Grid::zeros((height, width)), &valid)?;
        Ok(Self(Arc::new(Told {
            image: self,
            valid: Some(valid),
            prior: None,
        })))
    }

    /// The same image with what is known of its pixels before: how probable it is, 0 … 1, that each is one of the
    /// object, as a network says. A search weighs that like what it learns itself of the inside and the outside.
    ///
    /// # Errors
    ///
    /// Probabilities of another size, or one that is no finite number. What is below 0 or above 1 is cut.
    pub fn with_prior(self, probabilities: &Grid) -> Result<Self, FieldError> {
        let (width, height) = self.size();
        if probabilities.dim() != (height, width) {
            return Err(FieldError::ShapesDiffer {
                first: (height, width),
                second: probabilities.dim(),
            });
        }
        let mut wrong = probabilities.indexed_iter().filter(|(_, p)| !p.is_finite());
        if let Some(((row, column), &value)) = wrong.next() {
            return Err(FieldError::NotFinite { column, row, value });
        }
        let odds = |p: f64| {
            let p = p.clamp(SMALL, 1.0 - SMALL);
            (p / (1.0 - p)).ln()
        };
        Ok(Self(Arc::new(Told {
            valid: None,
            prior: Some(probabilities.mapv(odds)),
            image: self,
        })))
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        self.0.size()
    }

    /// The pixels.
    #[must_use]
    pub fn pixels(&self) -> &dyn Pixels {
        &*self.0
    }

    /// A grid of this image's size with the word on which of its pixels count.
    pub(crate) fn masked(&self, grid: &Grid) -> Result<MaskedImage, FieldError> {
        match self.0.valid() {
            Some(valid) => MaskedImage::new(grid, valid),
            None => MaskedImage::whole(grid),
        }
    }

    /// Spread of a grid of this image's size over the pixels that count; 0 for a constant.
    pub(crate) fn spread(&self, grid: &Grid) -> f64 {
        level_spread(counted_limits(grid, self.0.valid()))
    }
}

/// Grey levels in doubles.
#[derive(Debug)]
struct Levels {
    levels: Grid,
}

impl Pixels for Levels {
    fn size(&self) -> (usize, usize) {
        let (height, width) = self.levels.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        &self.levels
    }
}

/// Grey of some other depth.
#[derive(Debug)]
struct Kept<P> {
    pixels: ArcArray2<P>,
    /// The level of a pixel of 1.
    unit: f64,
    checked: bool,
    levels: OnceLock<Grid>,
}

impl<P: Pixel> Kept<P> {
    const fn new(pixels: ArcArray2<P>, unit: f64, checked: bool) -> Self {
        Self {
            pixels,
            unit,
            checked,
            levels: OnceLock::new(),
        }
    }

    fn level_of(&self, pixel: P) -> f64 {
        self.unit * f64::from(pixel.level())
    }
}

impl<P: Pixel> Pixels for Kept<P> {
    fn size(&self) -> (usize, usize) {
        let (height, width) = self.pixels.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        let made = || self.pixels.map(|&pixel| self.level_of(pixel));
        self.levels.get_or_init(made)
    }

    fn level(&self, x: usize, y: usize) -> f64 {
        self.level_of(self.pixels[[y, x]])
    }

    fn is_checked(&self) -> bool {
        self.checked
    }

    fn limits(&self) -> [f64; 4] {
        level_limits(|| self.pixels.iter().map(|&pixel| self.level_of(pixel)))
    }

    fn largest(&self) -> f64 {
        let levels = self.pixels.iter().map(|&pixel| self.level_of(pixel));
        levels.fold(0.0, |most: f64, level| most.max(level.abs()))
    }

    fn lazy_edge_force(&self, rule: &EdgeForce) -> Result<Option<ForceField>, FieldError> {
        let gain = rule.gain * self.unit;
        let rule = EdgeForce { gain, ..*rule };
        lazy_force(self.pixels.clone(), &Recipe::Edge(rule)).map(Some)
    }
}

/// Red, green and blue.
#[derive(Debug)]
struct Colors {
    levels: Grid,
    channels: [Grid; 3],
}

impl Pixels for Colors {
    fn size(&self) -> (usize, usize) {
        let (height, width) = self.levels.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        &self.levels
    }

    fn color(&self, x: usize, y: usize) -> [f64; 3] {
        self.channels.each_ref().map(|channel| channel[[y, x]])
    }

    fn channels(&self) -> Vec<Grid> {
        self.channels.to_vec()
    }

    fn is_color(&self) -> bool {
        true
    }
}

/// An image with more that is known of its pixels.
#[derive(Debug)]
struct Told {
    image: Image,
    /// Which pixels count, and what is known of them before, where that is not what the image says.
    valid: Option<Array2<bool>>,
    prior: Option<Grid>,
}

impl Pixels for Told {
    fn size(&self) -> (usize, usize) {
        self.image.size()
    }

    fn levels(&self) -> &Grid {
        self.image.0.levels()
    }

    fn level(&self, x: usize, y: usize) -> f64 {
        self.image.0.level(x, y)
    }

    fn color(&self, x: usize, y: usize) -> [f64; 3] {
        self.image.0.color(x, y)
    }

    fn channels(&self) -> Vec<Grid> {
        self.image.0.channels()
    }

    fn is_color(&self) -> bool {
        self.image.0.is_color()
    }

    fn valid(&self) -> Option<&Array2<bool>> {
        self.valid.as_ref().or_else(|| self.image.0.valid())
    }

    fn prior(&self) -> Option<&Grid> {
        self.prior.as_ref().or_else(|| self.image.0.prior())
    }
}
