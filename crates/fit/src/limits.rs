//! How much work and memory one image may ask for, each with its reason.

use field::Smoothing;

use crate::Problem;

/// Nodes of a curve: more than twenty for every pixel of the outline of the largest image.
pub(crate) const MOST_NODES: usize = 1 << 20;

/// Pixels of all force fields of an image together, 16 bytes each: 2 GiB. One field is always made.
pub(crate) const MOST_FIELDS: u64 = 1 << 27;

/// Pixels an image may have to be worked on as a whole, 11585 × 11585: all stages of a force
/// together hold about a hundred bytes a pixel, so some 13 GB.
pub(crate) const MOST_WHOLE: u64 = 1 << 27;

/// Pixels times taps of a smoothing along one axis: about half a minute of work.
pub(crate) const MOST_SMOOTHING: f64 = 1.7e10;

/// Points of the transform behind vector field convolution: 16 bytes each, three times.
pub(crate) const MOST_CONVOLUTION: f64 = 2.7e8;

/// Steps of a fit: days of work for the smallest curve.
pub(crate) const MOST_STEPS: u64 = 1_000_000_000;

/// Bytes a pixel that all stages of a force take together.
const WORK: u64 = 100;

/// Refuse what there is no memory for, before any is filled: so many bytes are asked for and given
/// back.
fn room(bytes: u64) -> Result<(), String> {
    let there = usize::try_from(bytes).is_ok_and(|bytes| {
        let mut list: Vec<u8> = Vec::new();
        list.try_reserve_exact(bytes).is_ok() && list.capacity() >= bytes
    });
    if there {
        return Ok(());
    }
    Err(format!(
        "takes {} MiB, more than there is room for",
        bytes >> 20
    ))
}

/// Refuse a smoothing that takes minutes on an image of this width and height, or that makes no
/// sense.
///
/// # Errors
///
/// Whatever [`Smoothing::validate`] refuses; too much work or memory.
pub fn check_smoothing(
    smoothing: Smoothing,
    (width, height): (usize, usize),
) -> Result<Smoothing, Problem> {
    smoothing.validate()?;
    if (width * height) as u64 > MOST_WHOLE {
        return Err(Problem::Other(format!(
            "asks for work on all {width}×{height} pixels, of which there may be {MOST_WHOLE}; the plain edge force is \
             found where it is needed (computed = \"lazy\"), without a mask and up to σ = 18"
        )));
    }
    check_work((width, height), WORK)?;
    let pixels = (width * height) as f64;
    // a Gaussian is cut at 8.6 σ on both sides
    let (value, taps) = match smoothing {
        Smoothing::Binomial(passes) => (f64::from(passes), 1.0),
        Smoothing::Gaussian(sigma) => (sigma, 17.2),
    };
    if pixels * value * taps <= MOST_SMOOTHING {
        return Ok(smoothing);
    }
    let most = (MOST_SMOOTHING / (pixels * taps)).floor();
    Err(Problem::Other(format!(
        "{value} on {width}×{height} pixels takes too long; must be at most {most}"
    )))
}

/// Refuse work on a whole image, of so many bytes a pixel, that there is no memory for.
pub(crate) fn check_work((width, height): (usize, usize), bytes: u64) -> Result<(), Problem> {
    let pixels = (width * height) as u64;
    let refuse = |message: String| {
        let message =
            format!("work on all {width}×{height} pixels {message}; a smaller picture is needed");
        Err(Problem::Other(message))
    };
    let most = MOST_WHOLE * WORK / bytes;
    if pixels > most {
        return refuse(format!(
            "takes {bytes} bytes each, for which at most {most} are allowed"
        ));
    }
    room(pixels * bytes).or_else(refuse)
}
