//! Outlines drawn anew in part: nodes, stretches, cuts and joins.

use std::sync::Arc;

use glam::DVec2;

use super::mend::{between, check_node, crosses};
use super::{One, Pictures};
use crate::sandbox::place;
use crate::{LiveError, Pair};

/// Fewest nodes of an outline.
const LEAST: usize = 5;

impl Pictures {
    /// Draw the stretch between two nodes anew; what was drawn then settles on the nearest edge.
    pub(super) fn redraw(
        &mut self,
        id: u32,
        from: usize,
        to: usize,
        points: &[Pair],
    ) -> Result<(), LiveError> {
        let one = self.one(id)?;
        check_node(one, from)?;
        check_node(one, to)?;
        let drawn: Vec<DVec2> = points.iter().map(|p| place(*p)).collect::<Result<_, _>>()?;
        if drawn.is_empty() {
            return Err(LiveError::new(
                "a stretch that is drawn anew has at least one point, got none",
            ));
        }
        let n = one.points.len();
        let gone = between(n, one.closed, from, to);
        if gone.len() + LEAST > n {
            return Err(LiveError::new(format!(
                "a stretch may be at most the outline less {LEAST} nodes, got {} of {n}",
                gone.len()
            )));
        }
        // as drawn from the one end to the other, at a node a pixel
        let mut way = vec![one.points[from]];
        way.extend(&drawn);
        way.push(one.points[to]);
        let spacing = super::mend::length(one) / n as f64;
        let new = stepped(&way, spacing);
        let mut made = one.clone();
        let kept: Vec<usize> = (0..n).filter(|i| !gone.contains(i)).collect();
        // the kept nodes in order from behind the stretch
        let behind = kept.iter().position(|i| *i > to).unwrap_or(0);
        let order = kept[behind..].iter().chain(&kept[..behind]);
        let (mut nodes, mut strength, mut error) =
            (new.clone(), vec![0.0; new.len()], vec![None; new.len()]);
        for &i in order {
            nodes.push(one.points[i]);
            strength.push(one.strength.get(i).copied().unwrap_or(0.0));
            error.push(one.error.get(i).copied().flatten());
        }
        if crosses(&nodes, one.closed) {
            return Err(LiveError::new("the stretch as drawn crosses the outline"));
        }
        let pins = one.pins.iter();
        let place_of = |pin: &usize| nodes.iter().position(|p| *p == one.points[*pin]);
        made.pins = pins.filter_map(place_of).collect();
        (made.points, made.strength, made.error) = (nodes, strength, error);
        let free: Vec<usize> = (1..new.len().saturating_sub(1)).collect();
        if let Ok(mut session) = self.session(&made, &made.points, &free) {
            session.step(400);
            let points = session.nodes().to_vec();
            if !crosses(&points, made.closed) {
                made.points = points;
            }
        }
        "a stretch was drawn by hand".clone_into(&mut made.words);
        made.sure = true;
        self.outlines.insert(id, Arc::new(made));
        Ok(())
    }

    /// Put a node in the middle of the edge behind a node.
    pub(super) fn add_node(&mut self, id: u32, node: usize) -> Result<(), LiveError> {
        let one = self.one_mut(id)?;
        check_node(one, node)?;
        let n = one.points.len();
        if !one.closed && node + 1 == n {
            return Err(LiveError::new(
                "there is no edge behind the last node of an open curve",
            ));
        }
        let middle = one.points[node].midpoint(one.points[(node + 1) % n]);
        one.points.insert(node + 1, middle);
        if one.strength.len() == n {
            one.strength.insert(node + 1, one.strength[node]);
        }
        if one.error.len() == n {
            one.error.insert(node + 1, None);
        }
        one.pins = one
            .pins
            .iter()
            .map(|pin| if *pin > node { pin + 1 } else { *pin })
            .collect();
        Ok(())
    }

    /// Take a node out.
    pub(super) fn delete_node(&mut self, id: u32, node: usize) -> Result<(), LiveError> {
        let one = self.one_mut(id)?;
        check_node(one, node)?;
        let n = one.points.len();
        if n <= LEAST {
            return Err(LiveError::new(format!(
                "an outline must keep {LEAST} nodes"
            )));
        }
        let mut points = one.points.clone();
        points.remove(node);
        if crosses(&points, one.closed) {
            return Err(LiveError::new(
                "without that node the outline would cross itself",
            ));
        }
        one.points = points;
        if one.strength.len() == n {
            one.strength.remove(node);
        }
        if one.error.len() == n {
            one.error.remove(node);
        }
        let pins = one.pins.iter().filter(|pin| **pin != node);
        one.pins = pins
            .map(|pin| if *pin > node { pin - 1 } else { *pin })
            .collect();
        Ok(())
    }

    /// Cut an outline in two along the line between two of its nodes.
    pub(super) fn cut(&mut self, id: u32, from: usize, to: usize) -> Result<(), LiveError> {
        let one = self.one(id)?.clone();
        check_node(&one, from)?;
        check_node(&one, to)?;
        if !one.closed {
            return Err(LiveError::new("only a closed outline can be cut in two"));
        }
        let n = one.points.len();
        let parts = [between(n, true, from, to), between(n, true, to, from)];
        let mut made = Vec::new();
        for part in parts {
            if part.len() < LEAST {
                let got = part.len();
                return Err(LiveError::new(format!(
                    "each part of an outline must have at least {LEAST} nodes, got {got}"
                )));
            }
            let points: Vec<DVec2> = part.iter().map(|i| one.points[*i]).collect();
            if crosses(&points, true) {
                return Err(LiveError::new(
                    "the cut would cross the outline; both its ends must see each other",
                ));
            }
            let mut piece = One {
                label: one.label.clone(),
                class: one.class.clone(),
                sure: one.sure,
                words: "cut by hand".to_owned(),
                ..One::as_given(points, true)
            };
            piece.measured_as(&one);
            // the line of the cut lies on no edge
            for end in [0, part.len() - 1] {
                if let Some(strength) = piece.strength.get_mut(end) {
                    *strength = 0.0;
                }
                if let Some(error) = piece.error.get_mut(end) {
                    *error = None;
                }
            }
            let pins = one.pins.iter();
            piece.pins = pins
                .filter_map(|pin| part.iter().position(|i| i == pin))
                .collect();
            made.push(piece);
        }
        let mut pieces = made.into_iter();
        if let (Some(first), Some(mut second)) = (pieces.next(), pieces.next()) {
            self.outlines.insert(id, Arc::new(first));
            second.label = String::new();
            let new = self.admit(second)?;
            self.arriving.remove(&new);
        }
        Ok(())
    }

    /// Make one outline of two that touch.
    pub(super) fn join(&mut self, id: u32, other: u32) -> Result<(), LiveError> {
        if id == other {
            return Err(LiveError::new("two different outlines are needed"));
        }
        let (one, two) = (self.one(id)?.clone(), self.one(other)?.clone());
        if !(one.closed && two.closed) {
            return Err(LiveError::new("only closed outlines can be joined"));
        }
        let positive = |points: &[DVec2]| {
            let mut points = points.to_vec();
            if scene::elastic::signed_area(&points) < 0.0 {
                points.reverse();
            }
            points
        };
        let merged = outline::merge(&positive(&one.points), &positive(&two.points), 0.0);
        let merged = merged.map_err(LiveError::of)?;
        let piece = merged.and_then(|resolved| resolved.pieces.into_iter().next());
        let Some(piece) = piece else {
            return Err(LiveError::new(format!(
                "{} and {} do not overlap; only outlines that do can be joined",
                one.label, two.label
            )));
        };
        let mut made = One {
            label: one.label.clone(),
            class: one.class.clone(),
            words: "joined by hand".to_owned(),
            ..One::as_given(piece.nodes, true)
        };
        made.measured_as(&one);
        self.outlines.remove(&other);
        self.outlines.insert(id, Arc::new(made));
        Ok(())
    }

    /// Give outlines that overlap a border in common.
    pub(super) fn part(&mut self) {
        let ids: Vec<u32> = self.outlines.keys().copied().collect();
        for (k, a) in ids.iter().enumerate() {
            for b in &ids[k + 1..] {
                let (Some(one), Some(two)) = (self.outlines.get(a), self.outlines.get(b)) else {
                    continue;
                };
                if !(one.closed && two.closed) {
                    continue;
                }
                let Some((first, second)) = track::bordered(&one.points, &two.points) else {
                    continue;
                };
                for (id, points) in [(a, first), (b, second)] {
                    if let Ok(one) = self.one_mut(*id)
                        && !crosses(&points, true)
                    {
                        one.points = points;
                    }
                }
            }
        }
    }
}

/// Points along a line, about `spacing` apart, its ends among them.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at least 1, and as many as the line is long"
)]
fn stepped(line: &[DVec2], spacing: f64) -> Vec<DVec2> {
    let mut out = Vec::new();
    for pair in line.windows(2) {
        let parts = (pair[0].distance(pair[1]) / spacing.max(0.25))
            .ceil()
            .clamp(1.0, 1e4) as usize;
        out.extend((0..parts).map(|k| pair[0].lerp(pair[1], k as f64 / parts as f64)));
    }
    out.extend(line.last());
    out.dedup_by(|a, b| a.distance(*b) < 1e-9);
    out
}
