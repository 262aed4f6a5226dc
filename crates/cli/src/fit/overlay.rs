//! A picture with what was found over it: outlines, how sure each node is, how firmly each stretch is held.

use glam::DVec2;
use io::shapes::Shape;
use io::{Picture, RgbImage, paint};
use scene::fit::NodeEvidence;

use super::flags::Flags;
use super::one::Found;

/// Colors over a picture: of the start, of an outline, and of one that is not sure.
pub(super) const START: [u8; 3] = [86, 180, 233];
pub(super) const FOUND: [u8; 3] = [230, 97, 1];
pub(super) const UNSURE: [u8; 3] = [204, 121, 167];

/// Of a share of nothing, of one half and of one: told apart by every eye, and in grey by their brightness.
const SHARES: [[f64; 3]; 3] = [
    [255.0, 232.0, 60.0],
    [122.0, 160.0, 160.0],
    [0.0, 70.0, 190.0],
];

/// Of what ran away when it was plucked.
const AWAY: [u8; 3] = [170, 20, 20];

/// Under what is drawn in many colors, so that each is seen on any ground.
const CASING: [u8; 3] = [0, 0, 0];

/// Half width of the band in which an edge lies 95 times of 100, in standard errors; a wider one than so many pixels
/// says nothing and is not drawn.
const SURE: f64 = 1.96;
const WIDEST: f64 = 10.0;

/// A picture is enlarged to so many pixels for its bands to be seen, at most so much.
const SEEN: f64 = 1200.0;
const MOST_ZOOM: f64 = 8.0;

/// The color of an outline.
pub(super) const fn color(found: &Found) -> [u8; 3] {
    if found.unsure.is_some() {
        UNSURE
    } else {
        FOUND
    }
}

/// The picture with starts and outlines over it.
pub(super) fn overlay(picture: &Picture, found: &[Found], flags: &Flags) -> RgbImage {
    if !flags.evidence && flags.pluck.is_none() {
        return plain(picture, found);
    }
    let (width, height) = picture.size();
    let zoom = (SEEN / width.max(height) as f64)
        .floor()
        .clamp(1.0, MOST_ZOOM);
    let mut image = paint::enlarged(picture.display(), zoom);
    let wide = (f64::from(image.width().max(image.height())) / 300.0).clamp(2.0, 6.0);
    let placed = |points: &[DVec2]| points.iter().map(|p| *p * zoom).collect::<Vec<DVec2>>();
    for one in found {
        let start = placed(one.start.first());
        paint::draw_curve(&mut image, &start, is_closed(&one.start), 1.0, START);
    }
    for one in found {
        let Some(shape) = &one.shape else { continue };
        let (points, closed) = (placed(shape.first()), is_closed(shape));
        if flags.evidence {
            band(&mut image, &points, closed, one, zoom);
        }
        let shares = shares(one, points.len(), flags);
        paint::draw_curve(&mut image, &points, closed, wide + 1.5, CASING);
        let edges = points.len() - usize::from(!closed && !points.is_empty());
        for i in 0..edges {
            let edge = [points[i], points[(i + 1) % points.len()]];
            let color = shares[i].map_or(color(one), of_share);
            paint::draw_curve(&mut image, &edge, false, wide, color);
        }
    }
    image
}

fn is_closed(shape: &Shape) -> bool {
    shape.closed == Some(true)
}

fn plain(picture: &Picture, found: &[Found]) -> RgbImage {
    let starts = found.iter().map(|found| (&found.start, START));
    let outlines = found
        .iter()
        .filter_map(|found| Some((found.shape.as_ref()?, color(found))));
    let curves: Vec<_> = starts
        .chain(outlines)
        .map(|(shape, color)| (shape.first(), is_closed(shape), color))
        .collect();
    paint::overlay(picture, &curves)
}

/// The sides of the band of error about an outline, where one was measured.
fn band(image: &mut RgbImage, points: &[DVec2], closed: bool, one: &Found, zoom: f64) {
    let nodes = one.fit.as_ref().map_or(&[][..], |fit| &fit.nodes[..]);
    let half = |node: &NodeEvidence| {
        let half = SURE * node.error?;
        (half <= WIDEST).then_some(half * zoom * node.normal)
    };
    let halves: Vec<Option<DVec2>> = nodes.iter().map(half).collect();
    let n = points.len().min(halves.len());
    for i in 0..n {
        let next = (i + 1) % n;
        if let (Some(a), Some(b)) = (halves[i], halves[next])
            && (closed || next > i)
        {
            for side in [1.0, -1.0] {
                let edge = [points[i] + side * a, points[next] + side * b];
                paint::draw_curve(image, &edge, false, 1.0, FOUND);
            }
        }
    }
}

/// What the color of each node stands for: how firmly it is held, or else how strong its edge is.
fn shares(one: &Found, count: usize, flags: &Flags) -> Vec<Option<f64>> {
    let mut shares = vec![None; count];
    if flags.pluck.is_some() {
        for stretch in one.plucked.iter().flat_map(|plucked| &plucked.stretches) {
            let own = shares.iter_mut().skip(stretch.points.start);
            for share in own.take(stretch.points.len()) {
                *share = stretch.firmness();
            }
        }
        return shares;
    }
    let nodes = one.fit.as_ref().map_or(&[][..], |fit| &fit.nodes[..]);
    for (share, node) in shares.iter_mut().zip(nodes) {
        *share = Some(node.strength);
    }
    shares
}

/// The color of a share.
fn of_share(share: f64) -> [u8; 3] {
    if share < -0.1 {
        return AWAY;
    }
    let way = 2.0 * share.clamp(0.0, 1.0);
    let (from, part) = if way < 1.0 { (0, way) } else { (1, way - 1.0) };
    let mix = |channel: usize| {
        let (a, b) = (SHARES[from][channel], SHARES[from + 1][channel]);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between two levels of 0 to 255"
        )]
        let level = (a + (b - a) * part).round() as u8;
        level
    };
    [mix(0), mix(1), mix(2)]
}
