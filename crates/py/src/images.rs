//! Arrays as images, read where they are.

use std::fmt;
use std::sync::{Arc, OnceLock};

use ndarray::{Array2, ArrayView, ArrayView3, Dimension, Ix2, Ix3};
use numpy::{Element, PyReadonlyArray, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use snakes::{Grid, Pixels};

use crate::errors::value;
use crate::waiting::attended;

/// A number that a pixel may be.
pub(crate) trait Sample: Element + Copy + Send + Sync + fmt::Debug + 'static {
    /// Whether it may be no finite number.
    const FLOAT: bool;
    fn number(self) -> f64;
}

macro_rules! samples {
    ($($kind:ty: $float:literal),*) => {
        $(impl Sample for $kind {
            const FLOAT: bool = $float;
            fn number(self) -> f64 {
                self.into()
            }
        })*
    };
}
samples!(u8: false, u16: false, f32: true, f64: true);

/// The memory of an array of Python, for as long as `owner` is kept beside it.
///
/// Another thread of Python may write into the array meanwhile, as with any library that releases the lock; then
/// numbers are read that nobody meant, and nothing worse: any bits are a number of each kind. Truth values come as
/// bytes.
fn lent<T: Element, D: Dimension>(array: &PyReadonlyArray<'_, T, D>) -> ArrayView<'static, T, D> {
    #[allow(
        unsafe_code,
        reason = "the array is kept alive by the owner beside the view"
    )]
    // SAFETY: `Lent`, and `active_contour` for as long as it runs, keep a reference to the array, which numpy does not
    // resize while it has more than one; the package passes aligned arrays with strides of whole items only
    unsafe {
        array.as_array().raw_view().deref_into_view()
    }
}

/// An array as an image: of two axes one of grey levels, of three one of colors with the channels last: three, or four
/// of which the last says how opaque a pixel is and is passed over.
struct Lent<T: Sample, D: Dimension> {
    view: ArrayView<'static, T, D>,
    _owner: Py<PyAny>,
    /// The level of a pixel of 1.
    unit: f64,
    levels: OnceLock<Grid>,
}

impl<T: Sample, D: Dimension> fmt::Debug for Lent<T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "pixels of Python, {:?}", self.view.shape())
    }
}

/// 0 where it is no finite number: such pixels are masked.
fn finite(level: f64) -> f64 {
    if level.is_finite() { level } else { 0.0 }
}

impl<T: Sample> Pixels for Lent<T, Ix2> {
    fn size(&self) -> (usize, usize) {
        let (height, width) = self.view.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        let made = || self.view.map(|pixel| finite(self.unit * pixel.number()));
        self.levels.get_or_init(made)
    }

    fn level(&self, x: usize, y: usize) -> f64 {
        finite(self.unit * self.view[[y, x]].number())
    }

    fn is_checked(&self) -> bool {
        !T::FLOAT
    }
}

impl<T: Sample> Pixels for Lent<T, Ix3> {
    fn size(&self) -> (usize, usize) {
        let (height, width, _) = self.view.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        let (width, height) = self.size();
        let level = |(y, x)| self.level(x, y);
        self.levels
            .get_or_init(|| Grid::from_shape_fn((height, width), level))
    }

    fn level(&self, x: usize, y: usize) -> f64 {
        let [r, g, b] = self.color(x, y);
        0.299 * r + 0.587 * g + 0.114 * b
    }

    fn color(&self, x: usize, y: usize) -> [f64; 3] {
        [0, 1, 2].map(|channel| finite(self.unit * self.view[[y, x, channel]].number()))
    }

    fn channels(&self) -> Vec<Grid> {
        let (width, height) = self.size();
        let channel = |k: usize| Grid::from_shape_fn((height, width), |(y, x)| self.color(x, y)[k]);
        (0..3).map(channel).collect()
    }

    fn is_color(&self) -> bool {
        true
    }

    fn is_checked(&self) -> bool {
        !T::FLOAT
    }
}

/// An image made of an array without a copy.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Image {
    pub(crate) image: snakes::Image,
    address: usize,
}

/// The first pixel that counts and is no finite number.
fn odd<T: Sample, D: Dimension>(
    view: &ArrayView<'_, T, D>,
    mask: Option<&Array2<bool>>,
) -> Option<(usize, usize, f64)> {
    if !T::FLOAT {
        return None;
    }
    let found = view.indexed_iter().find(|(index, pixel)| {
        !pixel.number().is_finite() && {
            let index = index.clone();
            let at = ndarray::IntoDimension::into_dimension(index);
            let at = at.as_array_view();
            mask.is_none_or(|mask| mask[[at[0], at[1]]])
        }
    });
    found.map(|(index, pixel)| {
        let at = ndarray::IntoDimension::into_dimension(index);
        let at = at.as_array_view();
        (at[0], at[1], pixel.number())
    })
}

fn refused((row, column, got): (usize, usize, f64)) -> PyErr {
    value(format!(
        "image must be finite, got {got} at row {row}, column {column}; pass mask=numpy.isfinite(image) to leave such \
         pixels out"
    ))
}

impl Image {
    /// None for an array of another kind.
    fn made<T: Sample, D: Dimension + 'static>(
        array: &Bound<'_, PyAny>,
        unit: f64,
        mask: Option<Array2<bool>>,
    ) -> PyResult<Option<Self>>
    where
        Lent<T, D>: Pixels,
    {
        let Ok(read) = array.extract::<PyReadonlyArray<'_, T, D>>() else {
            return Ok(None);
        };
        let view = lent(&read);
        let owner = array.clone().unbind();
        let address = view.as_ptr() as usize;
        // the owner goes along: this thread may be interrupted before the other has read all
        let looked = attended(array.py(), move |_| {
            (odd(&view, mask.as_ref()), view, mask, owner)
        })?;
        let (odd, view, mask, _owner) = looked;
        if let Some(odd) = odd {
            return Err(refused(odd));
        }
        let levels = OnceLock::new();
        let pixels = Lent {
            view,
            _owner,
            unit,
            levels,
        };
        Self::of(snakes::Image::of(Arc::new(pixels)), address, mask).map(Some)
    }

    fn of(image: snakes::Image, address: usize, mask: Option<Array2<bool>>) -> PyResult<Self> {
        let image = match mask {
            Some(mask) => image.with_mask(mask).map_err(value)?,
            None => image,
        };
        Ok(Self { image, address })
    }
}

#[pymethods]
impl Image {
    /// An array of two axes, or three with the channels last; `unit`: the level of a pixel of 1.
    #[new]
    #[pyo3(signature = (array, unit, mask = None))]
    fn new(
        array: &Bound<'_, PyAny>,
        unit: f64,
        mask: Option<PyReadonlyArray2<'_, bool>>,
    ) -> PyResult<Self> {
        let mask = mask.map(|mask| mask.as_array().to_owned());
        macro_rules! first_of {
            ($axes:ty: $($kind:ty),*) => {
                $(if let Some(made) = Self::made::<$kind, $axes>(array, unit, mask.clone())? {
                    return Ok(made);
                })*
            };
        }
        first_of!(Ix2: u8, u16, f32, f64);
        first_of!(Ix3: u8, u16, f32, f64);
        Err(PyTypeError::new_err(
            "image must be an array of uint8, uint16, float32 or float64 with 2 or 3 axes",
        ))
    }

    /// Where the pixels are read: the address of the first.
    #[getter]
    fn address(&self) -> usize {
        self.address
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        let (width, height) = self.image.size();
        (height, width)
    }
}

/// Give a view of the memory of an array of the first kind that fits, its channels last.
macro_rules! with_samples {
    ($array:expr, |$view:ident, $owner:ident| $body:expr) => {{
        let array = $array;
        macro_rules! one {
            ($kind:ty) => {
                if let Some(($view, $owner)) = crate::images::channels::<$kind>(array) {
                    return $body;
                }
            };
        }
        one!(u8);
        one!(u16);
        one!(f32);
        one!(f64);
    }};
}
pub(crate) use with_samples;

/// An array of this kind with an axis of channels, and what keeps it alive.
pub(crate) fn channels<T: Sample>(
    array: &Bound<'_, PyAny>,
) -> Option<(ArrayView3<'static, T>, Py<PyAny>)> {
    let owner = array.clone().unbind();
    if let Ok(read) = array.extract::<PyReadonlyArray2<'_, T>>() {
        return Some((lent(&read).insert_axis(ndarray::Axis(2)), owner));
    }
    let read = array.extract::<PyReadonlyArray3<'_, T>>().ok()?;
    Some((lent(&read), owner))
}
