//! One object followed through a sequence.

use glam::DVec2;
use ndarray::Array2;

use super::davis::boundary_f;
use crate::{Agreement, ScoreError, filled, iou};

/// What lies so near is the same boundary. Pixels.
const TOLERANCE: f64 = 2.0;

/// Below this intersection over union an object is lost.
const LOST: f64 = 0.3;

/// How well one object was followed, fed frame by frame; the first frame is where it was told.
///
/// ```
/// use glam::DVec2;
/// use score::tracking::Following;
///
/// let square = |x: f64| [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]
///     .map(|corner| DVec2::from(corner) + DVec2::new(x + 0.5, 0.5));
/// let mut following = Following::new((12, 30));
/// following.add(&[square(0.0)], &[square(0.0)], true)?;
/// let frame = following.add(&[square(3.0)], &[square(6.0)], true)?; // 6 columns of 12
/// assert_eq!(frame.iou, 0.5);
/// following.add::<[DVec2; 4], _>(&[], &[square(9.0)], false)?;
/// let followed = following.finish().unwrap();
/// assert_eq!((followed.iou, followed.last, followed.lost, followed.sure_and_lost), (0.25, 0.0, 0.5, 0.0));
/// # Ok::<(), score::ScoreError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Following {
    size: (usize, usize),
    frames: usize,
    /// All frames but the first.
    all: Sums,
    /// Those without the last, as the DAVIS challenge takes them.
    inner: Sums,
    worst: f64,
    last: Option<FollowedFrame>,
}

/// Sums over frames.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    frames: usize,
    iou: f64,
    f: f64,
    davis: f64,
    distance: f64,
    distances: usize,
    lost: usize,
    sure_and_lost: usize,
}

/// One frame. Lengths in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowedFrame {
    /// Intersection over union of the masks; 1 if both are empty.
    pub iou: f64,
    /// Boundary F at 2 pixels, along the curves ([`Agreement::f`]); 1 if neither has a pixel, 0 if one has none.
    pub f: f64,
    /// The boundary F of the DAVIS challenge ([`boundary_f`]).
    pub davis: f64,
    /// Mean distance of the two curves ([`Agreement::mean`]); None if one has no pixel.
    pub distance: Option<f64>,
    /// Whether the outline was said to be sure.
    pub sure: bool,
}

/// How well one object was followed: means over the frames after the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// How many frames were counted.
    pub frames: usize,
    /// Mean intersection over union.
    pub iou: f64,
    /// That of the last frame.
    pub last: f64,
    /// The least.
    pub worst: f64,
    /// Mean boundary F at 2 pixels.
    pub f: f64,
    /// Mean over the frames with both curves of their mean distance; None without such a frame. Pixels.
    pub distance: Option<f64>,
    /// The share of frames with an intersection over union below 0.3.
    pub lost: f64,
    /// The share of frames that are lost and were said to be sure.
    pub sure_and_lost: f64,
    /// J of the DAVIS challenge: as `iou` without the last frame; None if that leaves none.
    pub j: Option<f64>,
    /// F of the DAVIS challenge, over the same frames.
    pub davis: Option<f64>,
}

impl Followed {
    /// The mean of J and F of the DAVIS challenge `[perazzi16]`.
    #[must_use]
    pub fn j_and_f(&self) -> Option<f64> {
        Some(0.5 * (self.j? + self.davis?))
    }
}

impl Following {
    /// For pictures of so many rows and columns.
    #[must_use]
    pub fn new(size: (usize, usize)) -> Self {
        Self {
            size,
            frames: 0,
            all: Sums::default(),
            inner: Sums::default(),
            worst: f64::INFINITY,
            last: None,
        }
    }

    /// The next frame: what was found, what is true (either may be nothing), and whether what was found was said to be
    /// sure. O(pixels + length).
    ///
    /// # Errors
    ///
    /// An outline that is not finite, or too long.
    pub fn add<F: AsRef<[DVec2]>, T: AsRef<[DVec2]>>(
        &mut self,
        found: &[F],
        truth: &[T],
        sure: bool,
    ) -> Result<FollowedFrame, ScoreError> {
        let mask = filled(truth, self.size);
        self.add_to(found, truth, &mask, sure)
    }

    /// The same with a mask as truth: what its outlines are is `truth`.
    ///
    /// # Errors
    ///
    /// The same, and a mask of another size.
    pub fn add_to<F: AsRef<[DVec2]>, T: AsRef<[DVec2]>>(
        &mut self,
        found: &[F],
        truth: &[T],
        mask: &Array2<bool>,
        sure: bool,
    ) -> Result<FollowedFrame, ScoreError> {
        let covered = filled(found, self.size);
        // what lies outside of the picture is nothing in it
        let none = |mask: &Array2<bool>| mask.iter().all(|inside| !inside);
        let (f, distance) = match (none(&covered), none(mask)) {
            (true, true) => (1.0, None),
            (true, false) | (false, true) => (0.0, None),
            (false, false) => {
                let agreement = Agreement::of(found, truth, TOLERANCE)?;
                (agreement.f(), Some(agreement.mean))
            }
        };
        let frame = FollowedFrame {
            iou: iou(&covered, mask)?,
            f,
            davis: boundary_f(&covered, mask)?,
            distance,
            sure,
        };
        if self.frames > 0 {
            self.all.add(&frame);
            self.worst = self.worst.min(frame.iou);
            if let Some(before) = self.last.replace(frame) {
                self.inner.add(&before);
            }
        }
        self.frames += 1;
        Ok(frame)
    }

    /// The means; None if there is no frame after the first.
    #[must_use]
    pub fn finish(self) -> Option<Followed> {
        let last = self.last?;
        let count = self.all.frames as f64;
        let inner = self.inner.frames as f64;
        let distances = self.all.distances;
        let of_inner = |sum: f64| (inner > 0.0).then(|| sum / inner);
        Some(Followed {
            frames: self.all.frames,
            iou: self.all.iou / count,
            last: last.iou,
            worst: self.worst,
            f: self.all.f / count,
            distance: (distances > 0).then(|| self.all.distance / distances as f64),
            lost: self.all.lost as f64 / count,
            sure_and_lost: self.all.sure_and_lost as f64 / count,
            j: of_inner(self.inner.iou),
            davis: of_inner(self.inner.davis),
        })
    }
}

impl Sums {
    fn add(&mut self, frame: &FollowedFrame) {
        let lost = frame.iou < LOST;
        self.frames += 1;
        self.iou += frame.iou;
        self.f += frame.f;
        self.davis += frame.davis;
        self.distance += frame.distance.unwrap_or(0.0);
        self.distances += usize::from(frame.distance.is_some());
        self.lost += usize::from(lost);
        self.sure_and_lost += usize::from(lost && frame.sure);
    }
}
