//! Whether a picture of whole numbers is a mask with soft borders, and not labels.

use crate::picture::Numbers;

/// Black and white are at most so many pixels from any grey of a soft mask, along rows and columns.
const BORDER: usize = 4;

/// Whether there are black, white and grey, and all grey has black and white near: a mask drawn smoothly. Labels whose
/// numbers are between have pixels of which that is not so.
pub(super) fn is_soft(numbers: &Numbers) -> bool {
    let Numbers {
        width,
        list,
        whole,
        white,
        colors,
    } = numbers;
    let (black, white) = (|v: &f64| *v == 0.0, |v: &f64| v.total_cmp(white).is_eq());
    let bytes = *whole && !colors && [255.0, 65535.0].iter().any(white);
    let grey = |v: &f64| !black(v) && !white(v);
    if !bytes || !list.iter().any(grey) || !list.iter().any(black) || !list.iter().any(white) {
        return false;
    }
    let height = list.len() / width;
    let about = |at: usize, most: usize| at.saturating_sub(BORDER)..(at + BORDER + 1).min(most);
    list.iter()
        .enumerate()
        .filter(|(_, v)| grey(v))
        .all(|(at, _)| {
            let near = |is: &dyn Fn(&f64) -> bool| {
                about(at / width, height)
                    .any(|y| about(at % width, *width).any(|x| is(&list[y * width + x])))
            };
            near(&black) && near(&white)
        })
}
