//! The best curve of all in a band around a start: exact, by dynamic programming.
//!
//! The curve is a snake whose nodes may only slide along given directions. Its energy is that of its edge, of the
//! region it takes in, of its bends, and of a tether to the start; the least of all curves is found without a step
//! size, and without a local minimum within the band ([`path`], after \[amini90\]).
//!
//! 1. **Window.** The start's surroundings are resampled so that the object has a radius of 64 pixels; color becomes
//!    CIE L\*a\*b\*, grey is brought to 0 … 100. All that follows looks at this window only.
//! 2. **Edge.** Slopes of the smoothed channels, s = x / (x + x₀): x₀ is the slope that three quarters of
//!    the window
//!    do not reach, and at least six times what noise alone gives. So nothing depends on the picture's contrast.
//! 3. **Polarity.** The difference of the median colors in the middle of the start and around it.
//! 4. **Region.** Pixels are sorted into 24 classes of color and texture; each class has a likelihood inside and
//!    outside, learnt from what is inside now.
//! 5. **Near.** A band about the start, tethered to it.
//! 6. **Within.** Rays from the start's middle, without a tether, and then bands about the result, unrolled again and
//!    again, so that what no ray can reach is entered.
//! 7. **Evidence.** How closed a curve is (the edge that four fifths of it have), how strong, how much of one polarity.
//!    A closed edge near the start is kept; otherwise the curve from within is taken if it is closed better.
//! 8. **Around.** If neither is, the start may lie inside: rays outwards give another start for 5 to 7.
//!
//! Units: pixels, x to the right and y down, the first pixel's center at (0, 0).

pub mod along;
mod around;
mod band;
mod choice;
mod click;
mod codebook;
mod edges;
mod evidence;
mod find;
mod flood;
mod frame;
mod lab;
mod line;
mod near;
pub mod path;
mod rules;
pub mod smooth;
mod view;
mod walk;
pub mod whole;
mod within;

pub use click::{find_around, find_around_unless};
pub use evidence::{SLOPE, Support};
pub use find::{Found, Search, Searched, Stopped, find, find_unless};
pub use lab::lab;
pub use rules::{Rules, Sign};
pub use view::Seen;
