//! What a fit is done on: levels of grey, colors if there are, and which pixels count.

use std::sync::{Arc, OnceLock};

use field::{EdgeForce, FieldError, ForceField, Grid, MaskedImage, Pixel, Pixels, Recipe};
use field::{counted_limits, lazy_force, level_limits, level_spread};
use ndarray::{ArcArray2, Array2};

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
        Ok(Self(Arc::new(Masked { image: self, valid })))
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

/// An image of which some pixels do not count.
#[derive(Debug)]
struct Masked {
    image: Image,
    valid: Array2<bool>,
}

impl Pixels for Masked {
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
        Some(&self.valid)
    }
}
