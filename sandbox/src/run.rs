//! What is kept of a run: moments, and the account of its energies.

use crate::error::{Result, refused};
use crate::real;
use crate::table::shortest;
use glam::DVec2;

/// One curve at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The snake's number.
    pub id: usize,
    /// Whether it is closed.
    pub closed: bool,
    /// Its nodes.
    pub nodes: Vec<DVec2>,
}

impl Curve {
    /// Its points as they are drawn, a closed one led back to its first.
    pub(crate) fn points(&self) -> Vec<(f64, f64)> {
        let first = self.nodes.first().filter(|_| self.closed);
        let all = self.nodes.iter().chain(first);
        all.map(|&node| pair(node)).collect()
    }
}

/// All curves at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// When.
    pub t: f64,
    /// The curves there are.
    pub curves: Vec<Curve>,
}

impl Frame {
    /// A moment of a single closed curve.
    pub(crate) fn closed(t: f64, nodes: Vec<DVec2>) -> Self {
        let (id, closed) = (0, true);
        let curves = vec![Curve { id, closed, nodes }];
        Self { t, curves }
    }
}

/// What is kept of a run: moments, and the account of its energies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Run {
    /// The moments.
    pub frames: Vec<Frame>,
    /// What the energies are called.
    pub terms: Vec<String>,
    /// For each time of the account the energies, in the order of the terms.
    pub account: Vec<(f64, Vec<f64>)>,
}

impl From<Vec<Frame>> for Run {
    fn from(frames: Vec<Frame>) -> Self {
        Self {
            frames,
            ..Self::default()
        }
    }
}

impl From<&scene::Record> for Run {
    fn from(run: &scene::Record) -> Self {
        let frame = |frame: &scene::Frame| {
            let curves = frame.curves.iter().map(|curve| Curve {
                id: curve.id,
                closed: curve.closed,
                nodes: curve.nodes.clone(),
            });
            let curves = curves.collect();
            Frame { t: frame.t, curves }
        };
        let row = |frame: &scene::Frame| {
            let energies = frame.energies.as_ref()?;
            let mut row = energies.values();
            row.extend([energies.elastic(), energies.mechanical()]);
            Some((frame.t, row))
        };
        let sums = ["elastic", "total"].map(str::to_owned);
        Self {
            frames: run.frames.iter().map(frame).collect(),
            terms: run.terms.iter().cloned().chain(sums).collect(),
            account: run.frames.iter().filter_map(row).collect(),
        }
    }
}

impl Run {
    /// How many moments there are.
    pub(crate) fn len(&self) -> usize {
        self.frames.len()
    }

    /// The time of a moment.
    pub(crate) fn t(&self, frame: usize) -> f64 {
        self.frames[frame].t
    }

    /// The nodes of a moment's first curve.
    pub(crate) fn nodes(&self, frame: usize) -> &[DVec2] {
        &self.frames[frame].curves[0].nodes
    }

    /// The same as pairs.
    pub(crate) fn pairs(&self, frame: usize) -> Vec<(f64, f64)> {
        pairs(self.nodes(frame))
    }

    /// The moment nearest in time.
    pub(crate) fn nearest(&self, t: f64) -> usize {
        let distance = |i: &usize| (self.t(*i) - t).abs();
        let nearest = (0..self.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or(0)
    }

    /// The moments nearest to `0, every, 2 every …` up to the last.
    pub(crate) fn each(&self, every: f64) -> Vec<usize> {
        let end = self.frames.last().map_or(0.0, |frame| frame.t);
        let times = (0..100_000).map(|i| real(i) * every);
        let times = times.take_while(|t| *t <= end + 1e-9);
        let mut out: Vec<usize> = times.map(|t| self.nearest(t)).collect();
        out.dedup();
        out
    }

    /// An energy over time.
    pub(crate) fn energy(&self, term: &str) -> Result<Vec<(f64, f64)>> {
        let column = self.terms.iter().position(|known| known == term);
        let column = column.ok_or_else(|| refused(format!("the account has no {term}")))?;
        let rows = self.account.iter();
        Ok(rows.map(|(t, row)| (*t, row[column])).collect())
    }

    /// The moments as CSV, a node a line; behind them the account, if there is one.
    pub(crate) fn csv(&self) -> String {
        let mut out = String::from("t,curve,x,y\n");
        for frame in &self.frames {
            for curve in &frame.curves {
                for node in &curve.nodes {
                    let [t, x, y] = [frame.t, node.x, node.y].map(shortest);
                    out.push_str(&format!("{t},{},{x},{y}\n", curve.id));
                }
            }
        }
        if !self.account.is_empty() {
            out.push_str(&format!("\nt,{}\n", self.terms.join(",")));
        }
        for (t, row) in &self.account {
            let cells = std::iter::once(t).chain(row);
            let cells: Vec<String> = cells.map(|&value| shortest(value)).collect();
            out.push_str(&format!("{}\n", cells.join(",")));
        }
        out
    }
}

/// A point as the drawing kit takes it.
pub(crate) fn pair(p: DVec2) -> (f64, f64) {
    (p.x, p.y)
}

/// Points as the drawing kit takes them.
pub(crate) fn pairs(points: &[DVec2]) -> Vec<(f64, f64)> {
    points.iter().map(|&p| pair(p)).collect()
}

/// The largest change of the sum of an account.
pub(crate) fn stray(rows: &[(f64, Vec<f64>)]) -> f64 {
    let total = |row: &(f64, Vec<f64>)| row.1.iter().sum::<f64>();
    let first = rows.first().map_or(0.0, total);
    rows.iter()
        .fold(0.0, |off, row| off.max((total(row) - first).abs()))
}

/// The largest change of a term of an account.
pub(crate) fn change(rows: &[(f64, Vec<f64>)]) -> f64 {
    let first = rows.first().into_iter().flat_map(|row| &row.1);
    let changes = rows.iter().flat_map(|row| row.1.iter().zip(first.clone()));
    changes.fold(f64::MIN_POSITIVE, |most, (now, then)| {
        most.max((now - then).abs())
    })
}

/// How far the sum of an account strays, as a share of the largest change of one of its terms.
pub(crate) fn gap_of(rows: &[(f64, Vec<f64>)]) -> f64 {
    stray(rows) / change(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run() -> Run {
        let frame = |t: f64| Frame::closed(t, vec![DVec2::new(t, 0.0), DVec2::new(t, 1.0)]);
        Run {
            frames: [0.0, 1.0, 2.5].map(frame).to_vec(),
            terms: vec!["kinetic".to_owned(), "damping".to_owned()],
            account: vec![(0.0, vec![4.0, 0.0]), (1.0, vec![1.0, 2.5])],
        }
    }

    #[test]
    fn moments_are_found_by_their_times() {
        let run = run();
        assert_eq!([0.4, 0.6, 9.0].map(|t| run.nearest(t)), [0, 1, 2]);
        assert_eq!(run.each(1.0), [0, 1, 2]);
        assert_eq!(run.frames[2].curves[0].points().len(), 3);
    }

    #[test]
    fn an_account_strays_by_its_sum_and_changes_by_its_terms() {
        let run = run();
        assert_eq!(run.energy("damping").unwrap(), [(0.0, 0.0), (1.0, 2.5)]);
        assert!(run.energy("none").is_err());
        assert!((stray(&run.account) - 0.5).abs() < 1e-15);
        assert!((gap_of(&run.account) - 0.5 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_run_is_written_a_node_a_line_with_its_account_below() {
        let text = run().csv();
        assert!(text.starts_with("t,curve,x,y\n0,0,0,0\n0,0,0,1\n1,0,1,0\n"));
        assert!(text.ends_with("\nt,kinetic,damping\n0,4,0\n1,1,2.5\n"));
    }
}
