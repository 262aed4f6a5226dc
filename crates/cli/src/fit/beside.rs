//! Outlines of one file that are neighbours: borders in common where they touch.

use glam::DVec2;

use super::one::Found;

/// Give outlines that were found from starts apart, as labels are, common borders where they touch.
pub(super) fn in_contact(found: &mut [Found]) {
    let outline = |found: &Found| -> Option<(Vec<DVec2>, Vec<DVec2>)> {
        let shape = found.shape.as_ref()?;
        let closed = shape.closed == Some(true) && found.start.closed == Some(true);
        let start = found.start.first();
        (closed && start.len() > 2).then(|| (shape.first().to_vec(), start.to_vec()))
    };
    let all: Vec<usize> = (0..found.len())
        .filter(|&at| outline(&found[at]).is_some())
        .collect();
    let both = all.iter().filter_map(|&at| outline(&found[at]));
    let (mut outlines, starts): (Vec<_>, Vec<_>) = both.unzip();
    let back = instances::in_contact(&mut outlines, &starts);
    for (place, (&at, outline)) in all.iter().zip(outlines).enumerate() {
        let one = &mut found[at];
        if let Some(ring) = one.shape.as_mut().and_then(|shape| shape.rings.first_mut()) {
            *ring = outline;
        }
        if back.contains(&place) {
            one.doubtful("unsure: it would take in a neighbour; it is left as its start");
        }
    }
}
