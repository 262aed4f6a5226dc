//! The frame of a panel: where values stand, what of a line is inside, how numbers are written.

use super::panel::{Axis, Scale};

/// The frame of a panel in page units, and the values at its edges.
pub(crate) struct Frame {
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) top: f64,
    pub(crate) bottom: f64,
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
}

impl Frame {
    pub(crate) fn place(&self, at: (f64, f64)) -> (f64, f64) {
        let u = (at.0 - self.x.0) / (self.x.1 - self.x.0);
        let v = (at.1 - self.y.0) / (self.y.1 - self.y.0);
        (
            self.left + u * (self.right - self.left),
            self.bottom + v * (self.top - self.bottom),
        )
    }

    /// The part of a segment inside the frame (Liang and Barsky's clipping).
    pub(crate) fn cut(&self, a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (p, q) in [
            (-dx, a.0 - self.left),
            (dx, self.right - a.0),
            (-dy, a.1 - self.top),
            (dy, self.bottom - a.1),
        ] {
            if p == 0.0 {
                if q < 0.0 {
                    return None;
                }
            } else if p < 0.0 {
                from = from.max(q / p);
            } else {
                to = to.min(q / p);
            }
        }
        let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
        (from <= to).then(|| (at(from), at(to)))
    }

    pub(crate) fn contains(&self, at: (f64, f64)) -> bool {
        at.0 >= self.left && at.0 <= self.right && at.1 >= self.top && at.1 <= self.bottom
    }
}

/// How an axis writes its numbers.
pub(crate) fn numbers(axis: &Axis) -> impl Fn(&f64) -> String + use<> {
    let (scale, silent) = (axis.scale, axis.ticks == 0);
    move |&value| match scale {
        Scale::Linear if !silent => number(value),
        _ => String::new(), // a logarithmic axis has ticks of its own
    }
}

/// The ticks of a logarithmic axis: where each stands, as a logarithm, and what is written there.
///
/// Every decade where there are two or more, else 1, 2 and 5 of each, so that a range can be read from
/// at least two numbers; where `axis.ticks` is too few for all decades, every second, third, ….
pub(crate) fn log_ticks(axis: &Axis) -> Vec<(f64, String)> {
    let (a, b) = (axis.from.log10(), axis.to.log10());
    let (low, high) = (a.min(b) - 1e-9, a.max(b) + 1e-9);
    if axis.ticks == 0 || !(low.is_finite() && high.is_finite()) {
        return Vec::new();
    }
    let decades = || {
        let first = low.ceil();
        (0..700)
            .map(move |k| first + f64::from(k))
            .take_while(move |&decade| decade <= high)
    };
    let count = decades().count();
    if count < 3 {
        let steps = [1.0, 2.0, 5.0];
        let from = low.floor();
        return (0..4)
            .flat_map(|k| steps.map(|step: f64| (from + f64::from(k), step)))
            .filter_map(|(decade, step)| {
                let at = decade + step.log10();
                (low..=high)
                    .contains(&at)
                    .then(|| (at, at_decade(decade, step)))
            })
            .collect();
    }
    let every = count.div_ceil(axis.ticks.max(2));
    decades()
        .filter(|decade| every < 2 || decade.rem_euclid(crate::real(every)) < 0.5)
        .map(|decade| (decade, power_of_ten(decade)))
        .collect()
}

/// One, two or five times a power of ten, in full where that is short.
fn at_decade(decade: f64, step: f64) -> String {
    if (-3.0..=4.0).contains(&decade) {
        return number(step * 10.0_f64.powf(decade));
    }
    match step {
        1.0 => power_of_ten(decade),
        step => format!("{step}·{}", power_of_ten(decade)),
    }
}

/// A number on an axis: as short as it can be read.
fn number(value: f64) -> String {
    if value.abs() < 1e-12 {
        return "0".to_owned();
    }
    if value.abs() >= 1e5 || value.abs() < 1e-4 {
        return format!("{value:e}").replace('-', "−");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0')
        .trim_end_matches('.')
        .replace('-', "−")
}

fn power_of_ten(exponent: f64) -> String {
    let raised: String = format!("{exponent:.0}")
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            _ => '⁹',
        })
        .collect();
    match raised.as_str() {
        "⁰" => "1".to_owned(),
        "¹" => "10".to_owned(),
        _ => format!("10{raised}"),
    }
}

/// The runs of a line that lie inside the frame.
pub(crate) fn cut(frame: &Frame, points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let finite = |p: (f64, f64)| p.0.is_finite() && p.1.is_finite();
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut end: Option<(f64, f64)> = None;
    for pair in points.windows(2) {
        let inside = if finite(pair[0]) && finite(pair[1]) {
            frame.cut(pair[0], pair[1])
        } else {
            None
        };
        match inside {
            Some((a, b)) => {
                match runs.last_mut() {
                    Some(run) if end == Some(a) => run.push(b),
                    _ => runs.push(vec![a, b]),
                }
                end = Some(b);
            }
            None => end = None,
        }
    }
    runs
}

/// A line cut into dashes, the pattern running on round its corners.
pub(crate) fn dashes(points: &[(f64, f64)], on: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, on);
    for pair in points.windows(2) {
        let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
        let length = dx.hypot(dy);
        let mut gone = 0.0;
        while length - gone > left {
            gone += left;
            let at = (
                pair[0].0 + dx * gone / length,
                pair[0].1 + dy * gone / length,
            );
            if drawing {
                piece.push(at);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![at];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length - gone;
        if drawing {
            piece.push(pair[1]);
        }
    }
    if drawing && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        Frame {
            left: 0.0,
            right: 10.0,
            top: 0.0,
            bottom: 10.0,
            x: (0.0, 1.0),
            y: (0.0, 1.0),
        }
    }

    #[test]
    fn a_line_is_cut_where_it_leaves_the_frame_and_goes_on_where_it_comes_back() {
        let line = [(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (5.0, 8.0)];
        let runs = cut(&frame(), &line);
        assert_eq!(
            runs,
            vec![vec![(5.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (5.0, 8.0)]]
        );
    }

    #[test]
    fn a_line_breaks_at_a_point_that_is_not_finite() {
        let line = [
            (1.0, 1.0),
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (4.0, 1.0),
            (5.0, 1.0),
        ];
        assert_eq!(cut(&frame(), &line).len(), 2);
    }

    #[test]
    fn dashes_run_on_round_a_corner() {
        let pieces = dashes(&[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)], 4.0, 1.0);
        assert_eq!(pieces[0], vec![(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)]);
        assert_eq!(pieces[1], vec![(3.0, 2.0), (3.0, 3.0)]);
    }

    #[test]
    fn a_logarithmic_axis_has_numbers_to_read_its_range_from() {
        let words = |from: f64, to: f64, ticks: Option<usize>| {
            let axis = Axis::log("", from, to);
            let axis = ticks.map_or(axis.clone(), |ticks| axis.with_ticks(ticks));
            let ticks = log_ticks(&axis);
            ticks.into_iter().map(|tick| tick.1).collect::<Vec<_>>()
        };
        assert_eq!(words(0.1, 100.0, None), ["10⁻¹", "1", "10", "10²"]);
        assert_eq!(
            words(3.0, 300.0, None),
            ["5", "10", "20", "50", "100", "200"]
        );
        assert_eq!(words(12.0, 90.0, None), ["20", "50"]);
        assert_eq!(
            words(1e-16, 1.0, Some(5)),
            ["10⁻¹⁶", "10⁻¹²", "10⁻⁸", "10⁻⁴", "1"]
        );
        assert_eq!(words(2e-6, 6e-6, None), ["2·10⁻⁶", "5·10⁻⁶"]);
        assert!(words(1.0, 10.0, Some(0)).is_empty());
    }

    #[test]
    fn axis_numbers_are_short() {
        let shown = [0.0, 0.30000000000000004, -2.0, 1e-7, 250_000.0].map(number);
        assert_eq!(shown, ["0", "0.3", "−2", "1e−7", "2.5e5"]);
        assert_eq!(power_of_ten(-12.0), "10⁻¹²");
    }
}
