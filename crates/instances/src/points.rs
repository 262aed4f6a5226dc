//! Objects of which a place inside is known: an outline of each size is tried, and the best is taken.

use field::Pixels;
use glam::DVec2;

use crate::auto::{Candidate, main_color, octaves, outline, sizes};
use crate::model::{Model, Seed};
use crate::rules::Rules;

/// The outline about each point that is worth most, of the polarity that is worth more for all together; None where
/// none is worth anything.
pub(crate) fn about_points(
    pixels: &dyn Pixels,
    points: &[DVec2],
    rules: &Rules,
) -> Vec<Option<Candidate>> {
    let levels = octaves(pixels);
    let mut best = (0.0, vec![None; points.len()]);
    for sign in [1.0, -1.0] {
        let mut own: Vec<Option<Candidate>> = vec![None; points.len()];
        for (at, whole) in levels.iter().enumerate() {
            let model = Model {
                whole,
                likelihood: None,
                polarity: Some(main_color(whole).map(|v| sign * v)),
            };
            let places: Vec<DVec2> = points.iter().map(|p| whole.inward(*p)).collect();
            for radius in sizes(whole, at) {
                for (i, &center) in places.iter().enumerate() {
                    let near = |p: &&DVec2| p.distance(center) < 3.2 * radius && **p != center;
                    let seed = Seed {
                        center,
                        inner: 0.5 * radius,
                        rivals: places.iter().filter(near).map(|p| (*p, 1.0)).collect(),
                    };
                    let found = outline(&model, &seed, rules).filter(|one| {
                        let holds = |p: &DVec2| outline::winding(&one.curve, *p) != Some(0);
                        one.value > 0.0
                            && points.iter().filter(|p| holds(p)).count() == 1
                            && holds(&points[i])
                    });
                    if let Some(found) = found
                        && own[i]
                            .as_ref()
                            .is_none_or(|known| found.value > known.value)
                    {
                        own[i] = Some(found);
                    }
                }
            }
        }
        let sum: f64 = own.iter().flatten().map(|one| one.value).sum();
        if sum > best.0 {
            best = (sum, own);
        }
    }
    best.1
}
