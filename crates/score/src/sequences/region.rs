//! The regions of drawn sequences: what they hold, and their outlines.

use std::f64::consts::TAU;

use glam::DVec2;

/// Nodes of a true outline that is curved: those of a circle of radius 50 are within 3e-4 pixels of it.
const NODES: u32 = 1024;

/// Half the diagonal of a pixel, a little rounded up.
const REACH: f64 = 0.7072;

/// One wave of a radius that depends on the polar angle `a`: `size · cos(count · a + phase)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wave {
    pub(super) count: u32,
    pub(super) size: f64,
    pub(super) phase: f64,
}

/// A region about its center.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    /// By its radius.
    Disc(f64),
    /// By its half axes, the first turned by an angle from +x towards +y.
    Ellipse { half: DVec2, angle: f64 },
    /// `r(a) = base + Σ waves`.
    Waves { base: f64, waves: Vec<Wave> },
    /// The ovals of Cassini: places whose distances from two foci at `±focus` have a product of at most
    /// `product`. One region if `product ≥ |focus|²`, otherwise two.
    Oval { focus: DVec2, product: f64 },
    /// The one of two ovals that lies on the side of `+focus`.
    Lobe { focus: DVec2, product: f64 },
    /// By half its width and height.
    Box(DVec2),
}

/// A region of a picture: a form at a place, less what lies beyond some lines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    pub(super) form: Form,
    pub(super) center: DVec2,
    /// Unit normals and offsets: a place `p` belongs to it if `normal · p ≤ offset`.
    pub(super) cuts: Vec<(DVec2, f64)>,
}

impl Region {
    pub(super) const fn new(form: Form, center: DVec2) -> Self {
        let cuts = Vec::new();
        Self { form, center, cuts }
    }

    pub(super) fn holds(&self, p: DVec2) -> bool {
        self.form.holds(p - self.center) && self.cuts.iter().all(|(n, offset)| n.dot(p) <= *offset)
    }

    /// Whether the square of a pixel about a place is wholly inside or wholly outside; None where that is not known.
    pub(super) fn whole(&self, p: DVec2) -> Option<bool> {
        let mut inside = self.form.whole(p - self.center);
        for (n, offset) in &self.cuts {
            let beyond = n.dot(p) - offset;
            if beyond > REACH {
                return Some(false);
            }
            if beyond > -REACH && inside == Some(true) {
                inside = None;
            }
        }
        inside
    }

    /// Its outline, cut.
    pub(super) fn outline(&self) -> Vec<DVec2> {
        let mut ring = self.form.outline();
        ring.iter_mut().for_each(|p| *p += self.center);
        for (normal, offset) in &self.cuts {
            ring = cut(&ring, *normal, *offset);
        }
        ring
    }

    /// No point of it is farther from its center than this.
    pub(super) fn reach(&self) -> f64 {
        match &self.form {
            Form::Disc(radius) => *radius,
            Form::Ellipse { half, .. } => half.max_element(),
            Form::Waves { base, waves } => base + waves.iter().map(|w| w.size.abs()).sum::<f64>(),
            // on the axis, where r² = |focus|² + product
            Form::Oval { focus, product } | Form::Lobe { focus, product } => {
                (focus.length_squared() + product).sqrt()
            }
            Form::Box(half) => half.length(),
        }
    }

    /// The place in the object at rest that is at `p` now: turned back, and for waves with its radius made even.
    pub(super) fn material(&self, p: DVec2) -> DVec2 {
        let p = p - self.center;
        match &self.form {
            Form::Ellipse { angle, .. } => DVec2::from_angle(-angle).rotate(p),
            Form::Waves { base, waves } => p * (base / radius(*base, waves, p.to_angle())),
            _ => p,
        }
    }
}

fn radius(base: f64, waves: &[Wave], a: f64) -> f64 {
    let wave = |w: &Wave| w.size * (f64::from(w.count) * a + w.phase).cos();
    base + waves.iter().map(wave).sum::<f64>()
}

impl Form {
    fn holds(&self, p: DVec2) -> bool {
        match self {
            Self::Disc(radius) => p.length_squared() <= radius * radius,
            Self::Ellipse { half, angle } => {
                (DVec2::from_angle(-angle).rotate(p) / *half).length_squared() <= 1.0
            }
            Self::Waves { base, waves } => p.length() <= radius(*base, waves, p.to_angle()),
            Self::Oval { focus, product } => p.distance(*focus) * p.distance(-*focus) <= *product,
            Self::Lobe { focus, product } => {
                p.dot(*focus) >= 0.0 && p.distance(*focus) * p.distance(-*focus) <= *product
            }
            Self::Box(half) => p.abs().cmple(*half).all(),
        }
    }

    /// The same of a pixel, by how fast what [`holds`](Self::holds) compares can change within it.
    fn whole(&self, p: DVec2) -> Option<bool> {
        let (beyond, change) = match self {
            Self::Disc(radius) => (p.length() - radius, REACH),
            Self::Ellipse { half, angle } => {
                let share = (DVec2::from_angle(-angle).rotate(p) / *half).length();
                (share - 1.0, REACH / half.min_element())
            }
            Self::Waves { base, waves } => {
                let far = p.length();
                if far <= 1.0 {
                    return None;
                }
                let slope: f64 = waves
                    .iter()
                    .map(|w| w.size.abs() * f64::from(w.count))
                    .sum();
                let turn = (REACH / far).asin();
                (
                    far - radius(*base, waves, p.to_angle()),
                    REACH + slope * turn,
                )
            }
            Self::Oval { focus, product } | Self::Lobe { focus, product } => {
                let (a, b) = (p.distance(*focus), p.distance(-*focus));
                if matches!(self, Self::Lobe { .. }) {
                    let along = p.dot(focus.normalize_or_zero());
                    if along < -REACH {
                        return Some(false);
                    }
                    if along < REACH {
                        return None;
                    }
                }
                (a * b - product, REACH * (a + b) + REACH * REACH)
            }
            Self::Box(half) => ((p.abs() - *half).max_element(), 0.5 + 1e-9),
        };
        (beyond.abs() > change).then_some(beyond < 0.0)
    }

    fn outline(&self) -> Vec<DVec2> {
        let angles = (0..NODES).map(|i| TAU * f64::from(i) / f64::from(NODES));
        match self {
            Self::Disc(radius) => angles.map(|a| *radius * DVec2::from_angle(a)).collect(),
            Self::Ellipse { half, angle } => {
                let turn = DVec2::from_angle(*angle);
                angles
                    .map(|a| turn.rotate(*half * DVec2::from_angle(a)))
                    .collect()
            }
            Self::Waves { base, waves } => angles
                .map(|a| radius(*base, waves, a) * DVec2::from_angle(a))
                .collect(),
            // r² = f² cos 2a + √(p² − f⁴ sin² 2a) of the polar angle from the axis
            Self::Oval { focus, product } => {
                let (axis, square) = (focus.normalize_or(DVec2::X), focus.length_squared());
                let on = |a: f64| {
                    let (sin, cos) = (2.0 * a).sin_cos();
                    let root = (product * product - (square * sin).powi(2)).max(0.0).sqrt();
                    let far = (square * cos + root).max(0.0).sqrt();
                    axis.rotate(far * DVec2::from_angle(a))
                };
                angles.map(on).collect()
            }
            // the same with sin 2a = p / f² sin u: the root is p cos u, and both its signs are on the oval
            Self::Lobe { focus, product } => {
                let (axis, square) = (focus.normalize_or(DVec2::X), focus.length_squared());
                let on = |u: f64| {
                    let (sin, cos) = u.sin_cos();
                    let twice = (product / square * sin).clamp(-1.0, 1.0).asin();
                    let far = (square * twice.cos() + product * cos).max(0.0).sqrt();
                    axis.rotate(far * DVec2::from_angle(0.5 * twice))
                };
                let mut ring: Vec<DVec2> = angles.map(on).collect();
                // where two lobes touch many nodes are the point in which they do
                ring.dedup();
                ring
            }
            Self::Box(half) => [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|corner| *half * DVec2::from(corner))
                .to_vec(),
        }
    }
}

/// The part of a polygon with `normal · p ≤ offset` (one side of the cut of `[sutherland74]`).
pub(super) fn cut(ring: &[DVec2], normal: DVec2, offset: f64) -> Vec<DVec2> {
    let mut left = Vec::with_capacity(ring.len());
    for (a, b) in crate::mask::edges(ring) {
        let (from, to) = (normal.dot(a) - offset, normal.dot(b) - offset);
        if from <= 0.0 {
            left.push(a);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            left.push(a.lerp(b, from / (from - to)));
        }
    }
    left
}
