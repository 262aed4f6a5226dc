//! The best one-to-one match of rows and columns.

use ndarray::Array2;

use crate::ScoreError;

/// For each row the column that is matched with it, so that the sum of the costs is least.
///
/// As many are matched as there are rows or columns, whichever is fewer; a row that is left over has none. By the
/// Hungarian method `[kuhn55]`, with shortest paths and potentials; O(fewer² × more). Of several best matches, one
/// that depends on the costs alone.
///
/// ```
/// let costs = ndarray::array![[4.0, 1.0, 3.0], [2.0, 0.0, 5.0]];
/// // 1 + 2, not 4 + 0 or 3 + 0 or 1 + 5
/// assert_eq!(score::tracking::assignment(&costs)?, [Some(1), Some(0)]);
/// # Ok::<(), score::ScoreError>(())
/// ```
///
/// # Errors
///
/// A cost that is not finite.
pub fn assignment(costs: &Array2<f64>) -> Result<Vec<Option<usize>>, ScoreError> {
    if let Some((at, got)) = costs.indexed_iter().find(|(_, cost)| !cost.is_finite()) {
        return Err(ScoreError::Cost { at, got: *got });
    }
    let (rows, columns) = costs.dim();
    let mut answer = vec![None; rows];
    if rows <= columns {
        for (column, row) in matched(rows, columns, &|i, j| costs[[i, j]]) {
            answer[row] = Some(column);
        }
    } else {
        for (row, column) in matched(columns, rows, &|i, j| costs[[j, i]]) {
            answer[row] = Some(column);
        }
    }
    Ok(answer)
}

/// Pairs of a column and its row, of at most as many rows as columns: every row is matched.
fn matched(rows: usize, columns: usize, cost: &dyn Fn(usize, usize) -> f64) -> Vec<(usize, usize)> {
    // what a row and a column cost by themselves; no pair costs less than both together
    let (mut of_row, mut of_column) = (vec![0.0; rows], vec![0.0; columns]);
    let mut row_of: Vec<Option<usize>> = vec![None; columns];
    for start in 0..rows {
        // the shortest path from the row to a free column, over pairs that are matched
        let mut least = vec![f64::INFINITY; columns];
        let mut from: Vec<Option<usize>> = vec![None; columns];
        let mut seen = vec![false; columns];
        let (mut row, mut last) = (start, None);
        loop {
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in (0..columns).filter(|column| !seen[*column]) {
                let far = cost(row, column) - of_row[row] - of_column[column];
                if far < least[column] {
                    (least[column], from[column]) = (far, last);
                }
                if least[column] < step {
                    (step, next) = (least[column], column);
                }
            }
            // all seen columns and their rows, and the first row, move with the step
            of_row[start] += step;
            for column in 0..columns {
                if seen[column] {
                    of_column[column] -= step;
                    if let Some(other) = row_of[column] {
                        of_row[other] += step;
                    }
                } else {
                    least[column] -= step;
                }
            }
            seen[next] = true;
            last = Some(next);
            match row_of[next] {
                Some(other) => row = other,
                None => break,
            }
        }
        // each column of the path takes the row of the one before it
        while let Some(column) = last {
            last = from[column];
            row_of[column] = match last {
                Some(before) => row_of[before],
                None => Some(start),
            };
        }
    }
    let pair = |(column, row): (usize, &Option<usize>)| row.map(|row| (column, row));
    row_of.iter().enumerate().filter_map(pair).collect()
}
