//! The search around a start that lies wholly inside its object.

use field::Pixels;
use glam::DVec2;

use crate::along::Polygon;
use crate::edges::size;
use crate::path::Steps;
use crate::rules::Rules;
use crate::view::View;
use crate::within::rays;

/// Where the rays begin, in radii of the start.
const FROM: f64 = 0.7;

const STEPS: Steps = Steps {
    bend: 0.03,
    reach: 3,
};

/// The best curve around a start, in the picture: a start for the other searches.
pub(crate) fn around(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Option<Vec<DVec2>> {
    if rules.around <= 1.0 {
        return None;
    }
    let view = View::beyond(pixels, start, rules);
    let band = rays(&view, (FROM, rules.around))?;
    let likelihood = view.first_likelihood(rules.around);
    let costs = band.costs(&view, &likelihood, rules.region, |_, _, p, normal| {
        let across = view.edges.across(p, normal);
        let slope = if view.has_sign() {
            view.signed(across).max(0.0)
        } else {
            size(across)
        };
        -view.edges.strength(slope)
    });
    let curve = band.curve(&costs.closed_path(STEPS)?);
    Some(curve.iter().map(|p| view.frame.to_picture(*p)).collect())
}
