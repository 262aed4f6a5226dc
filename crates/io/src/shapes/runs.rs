//! Masks as runs of pixels of the background and of the object in turn, as COCO and CVAT keep them.

use glam::DVec2;

use super::budget::Budget;
use super::raster::Boxed;
use super::trace::Labels;

/// The lengths of runs as COCO packs them: groups of five bits from the lowest on, each a letter
/// from `0`; from the fourth run on the difference from the run two before.
pub(super) fn unpacked(text: &str) -> Result<Vec<f64>, String> {
    let mut runs: Vec<i64> = Vec::new();
    let mut letters = text.bytes();
    while letters.len() > 0 {
        let (mut value, mut shift) = (0_i64, 0_u32);
        loop {
            let Some(letter) = letters.next() else {
                return Err("the packed runs end within a number".to_owned());
            };
            let bits = letter.wrapping_sub(48);
            if bits > 63 || shift > 35 {
                return Err("the packed runs hold a letter or a number that cannot be".to_owned());
            }
            value |= i64::from(bits & 31) << shift;
            shift += 5;
            if bits & 32 == 0 {
                if bits & 16 != 0 {
                    value |= -1 << shift;
                }
                break;
            }
        }
        if runs.len() > 2 {
            value += runs[runs.len() - 2];
        }
        runs.push(value);
    }
    Ok(runs.into_iter().map(|run| run as f64).collect())
}

/// The outline of runs that go through `lines` lines of `length` pixels; along columns if `down`.
pub(super) fn rings(
    runs: &[f64],
    [length, lines]: [usize; 2],
    down: bool,
    budget: &mut Budget,
) -> Result<Vec<Vec<DVec2>>, String> {
    let whole = (length as u64).saturating_mul(lines as u64);
    if whole == 0 || whole > crate::limits::MOST_WHOLE {
        return Err(format!(
            "a mask of {whole} pixels; it must have from 1 to {}",
            crate::limits::MOST_WHOLE
        ));
    }
    // where the object begins and ends, and the lines and places it spans
    let mut spans: Vec<(usize, usize)> = Vec::new();
    let mut at = 0_usize;
    let (mut first, mut last) = (usize::MAX, 0);
    for (number, &run) in runs.iter().enumerate() {
        let count = count(run).filter(|&count| at + count <= length * lines);
        let Some(count) = count else {
            return Err(format!(
                "run {number} must be a whole number of pixels of the mask"
            ));
        };
        if number % 2 == 1 && count > 0 {
            spans.push((at, at + count));
            let (begin, end) = (at % length, (at + count - 1) % length);
            if at / length == (at + count - 1) / length {
                (first, last) = (first.min(begin), last.max(end));
            } else {
                (first, last) = (0, length - 1);
            }
        }
        at += count;
    }
    let (Some(&(begin, _)), Some(&(_, end))) = (spans.first(), spans.last()) else {
        return Ok(Vec::new());
    };
    let (top, bottom) = (begin / length, (end - 1) / length);
    let (across, along) = (bottom - top + 1, last - first + 1);
    budget.pixels((across * along) as u64)?;
    let (width, height) = if down {
        (across, along)
    } else {
        (along, across)
    };
    let mut list = vec![0_u32; across * along];
    for (begin, end) in spans {
        for at in begin..end {
            let (line, place) = (at / length - top, at % length - first);
            let (x, y) = if down { (line, place) } else { (place, line) };
            list[y * width + x] = 1;
        }
    }
    let labels = Labels {
        list,
        width,
        height,
    };
    let mut rings = labels.outlines(budget)?.remove(&1).unwrap_or_default();
    let corner = if down { (top, first) } else { (first, top) };
    let corner = DVec2::new(corner.0 as f64, corner.1 as f64);
    rings.iter_mut().flatten().for_each(|p| *p += corner);
    Ok(rings)
}

/// A whole number of pixels.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to 2^32"
)]
pub(super) fn count(number: f64) -> Option<usize> {
    let whole = number.fract() == 0.0 && (0.0..=4_294_967_296.0).contains(&number);
    whole.then_some(number as usize)
}

/// Runs of a part of a picture that is read down its columns, from its first pixel on; background first.
pub(crate) fn of_columns(part: &Boxed, [width, height]: [usize; 2]) -> Vec<usize> {
    let rows = part.mask.len().checked_div(part.width).unwrap_or(0);
    // where runs of the object begin and end
    let mut spans: Vec<(usize, usize)> = Vec::new();
    for x in 0..part.width {
        for y in (0..rows).filter(|y| part.mask[y * part.width + x]) {
            let at = (part.left + x) * height + part.top + y;
            match spans.last_mut() {
                Some((_, end)) if *end == at => *end += 1,
                _ => spans.push((at, at + 1)),
            }
        }
    }
    let (mut runs, mut last) = (Vec::new(), 0);
    for (begin, end) in spans {
        runs.extend([begin - last, end - begin]);
        last = end;
    }
    if last < width * height {
        runs.push(width * height - last);
    }
    runs
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "areas of whole pixels are exact")]
mod tests {
    use super::*;
    use crate::shapes::rings::even_odd_area;

    #[test]
    fn packed_runs_are_those_of_the_reference_program() {
        // by pycocotools 2.0.11: noise of 5 rows and 4 columns, and a rectangle with a hole
        let noise = [1, 1, 1, 2, 1, 2, 1, 2, 2, 2, 1, 1, 1, 2];
        let rectangle = [
            83, 27, 13, 17, 1, 9, 13, 17, 1, 9, 13, 27, 13, 27, 13, 27, 50,
        ];
        for (text, runs) in [
            ("1111000010OO01", &noise[..]),
            ("c2k0=FDH<8DH<b00000U1", &rectangle),
        ] {
            let runs: Vec<f64> = runs.iter().map(|&run| f64::from(run)).collect();
            assert_eq!(unpacked(text).unwrap(), runs);
        }
        for bad in ["R", "~", "oooooooooooo0"] {
            assert!(unpacked(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn runs_give_the_outline_of_their_pixels() {
        let mask = [0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1].map(|v| v == 1);
        let part = Boxed {
            left: 0,
            top: 0,
            width: 4,
            mask: mask.to_vec(),
        };
        let runs = of_columns(&part, [4, 3]);
        assert_eq!(runs, [3, 2, 1, 1, 1, 1, 1, 2]);
        let runs: Vec<f64> = runs.iter().map(|&v| v as f64).collect();
        let down = rings(&runs, [3, 4], true, &mut Budget::default()).unwrap();
        assert_eq!(even_odd_area(&down).unwrap(), 6.0);
        let p = down[0][0];
        assert_eq!((p.x, p.y), (2.5, -0.5));
        assert!(rings(&[3.0, 99.0], [3, 4], true, &mut Budget::default()).is_err());
        assert!(rings(&[-3.0, 1.0], [3, 4], true, &mut Budget::default()).is_err());
    }
}
