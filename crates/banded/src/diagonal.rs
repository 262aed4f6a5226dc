//! The diagonal of an inverse, without the inverse: how far each unknown may stray under a given stiffness.
//!
//! Taken in pairs, the unknowns of a pentadiagonal matrix have only their neighbouring pairs beside
//! them. Eliminating all pairs on the left of one, and all on its right, leaves a 2×2 matrix whose
//! inverse is that pair's block of the inverse (\[meurant92\]). Both eliminations are done once for all
//! pairs, in O(n).

use crate::{Factor, Pentadiagonal};

/// A 2×2 matrix by rows.
type Pair = [[f64; 2]; 2];

impl Pentadiagonal {
    /// The diagonal of the inverse of a positive definite matrix, in O(n); None if it is not
    /// positive definite.
    ///
    /// Of a cyclic matrix the last two unknowns are set aside: what is left is open, and the two
    /// columns that couple it to them change its inverse by a matrix of rank two.
    #[must_use]
    pub fn inverse_diagonal(&self) -> Option<Vec<f64>> {
        let n = self.len();
        if !self.is_cyclic() {
            return self.open_inverse_diagonal(n);
        }
        let inner = n - 2;
        let mut list = self.open_inverse_diagonal(inner)?;
        let couplings = [inner, inner + 1]
            .map(|j| -> Vec<f64> { (0..inner).map(|i| self.entry(i, j)).collect() });
        let factor = Factor::new(&self.without_last_two()?).ok()?;
        let columns = couplings.clone().map(|mut column| {
            factor.solve_scalars(&mut column);
            column
        });
        let rest: Pair = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let coupled = couplings[i].iter().zip(&columns[j]).map(|(a, b)| a * b);
                self.entry(inner + i, inner + j) - coupled.sum::<f64>()
            })
        });
        let rest = inverse(&rest)?;
        for (i, value) in list.iter_mut().enumerate() {
            let (a, b) = (columns[0][i], columns[1][i]);
            *value += a * a * rest[0][0] + 2.0 * a * b * rest[0][1] + b * b * rest[1][1];
        }
        list.extend([rest[0][0], rest[1][1]]);
        Some(list)
    }

    /// The matrix without its last two rows and columns, as an open one.
    fn without_last_two(&self) -> Option<Self> {
        let inner = self.len() - 2;
        let mut open = Self::new(inner, false).ok()?;
        for i in 0..inner {
            for j in i..(i + 3).min(inner) {
                open.add(i, j, self.entry(i, j));
            }
        }
        Some(open)
    }

    /// The diagonal of the inverse of the first `rows` rows and columns, as an open matrix.
    fn open_inverse_diagonal(&self, rows: usize) -> Option<Vec<f64>> {
        // an unknown without neighbours makes the last pair whole
        let pairs = rows.div_ceil(2);
        let entry = |i: usize, j: usize| {
            if i >= rows || j >= rows {
                return f64::from(u8::from(i == j));
            }
            let low = i.min(j);
            match i.abs_diff(j) {
                0 => self.diagonal()[low],
                1 => self.first()[low],
                2 => self.second()[low],
                _ => 0.0,
            }
        };
        let block = |p: usize, q: usize| -> Pair {
            std::array::from_fn(|i| std::array::from_fn(|j| entry(2 * p + i, 2 * q + j)))
        };
        let mut left = Vec::with_capacity(pairs);
        for p in 0..pairs {
            let mut own = block(p, p);
            if let Some(before) = left.last() {
                own = less(own, &through(&block(p, p - 1), &inverse(before)?));
            }
            left.push(own);
        }
        let mut list = vec![0.0; 2 * pairs];
        let mut right: Option<Pair> = None;
        for p in (0..pairs).rev() {
            let own = block(p, p);
            let rest = match &right {
                Some(behind) => less(own, &through(&block(p, p + 1), &inverse(behind)?)),
                None => own,
            };
            let both: Pair = std::array::from_fn(|i| {
                std::array::from_fn(|j| left[p][i][j] + rest[i][j] - own[i][j])
            });
            let found = inverse(&both)?;
            list[2 * p] = found[0][0];
            list[2 * p + 1] = found[1][1];
            right = Some(rest);
        }
        list.truncate(rows);
        Some(list)
    }
}

/// The inverse of a positive definite pair.
fn inverse(a: &Pair) -> Option<Pair> {
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let good = a[0][0] > 0.0 && determinant > 0.0 && determinant.is_finite();
    good.then(|| {
        let r = determinant.recip();
        [[a[1][1] * r, -a[0][1] * r], [-a[1][0] * r, a[0][0] * r]]
    })
}

/// B A Bᵀ.
fn through(b: &Pair, a: &Pair) -> Pair {
    let product = |x: &Pair, y: &Pair| -> Pair {
        std::array::from_fn(|i| std::array::from_fn(|j| x[i][0] * y[0][j] + x[i][1] * y[1][j]))
    };
    let turned = [[b[0][0], b[1][0]], [b[0][1], b[1][1]]];
    product(&product(b, a), &turned)
}

fn less(a: Pair, b: &Pair) -> Pair {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] - b[i][j]))
}

#[cfg(test)]
mod tests {
    use crate::Pentadiagonal;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_that_of_the_dense_inverse(
            n in 5_usize..40,
            cyclic in any::<bool>(),
            own in proptest::collection::vec(0.5..3.0_f64, 40),
            bend in 0.0..0.3_f64,
        ) {
            let mut a = Pentadiagonal::new(n, cyclic).unwrap();
            a.add_diagonal(&own[..n]);
            for i in 0..n {
                if cyclic || (i > 0 && i + 1 < n) {
                    let row = [((i + n - 1) % n, 1.0), (i, -2.0), ((i + 1) % n, 1.0)];
                    a.add_outer(bend, &row);
                }
            }
            let found = a.inverse_diagonal().unwrap();
            let factor = a.dense();
            for i in 0..n {
                let mut unit = vec![0.0; n];
                unit[i] = 1.0;
                let column = factor.solve(&unit).unwrap();
                let near = 1e-10 * column[i];
                prop_assert!((found[i] - column[i]).abs() <= near, "{i}: {} for {}", found[i], column[i]);
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_none() {
        let mut a = Pentadiagonal::new(8, false).unwrap();
        a.add_identity(-1.0);
        assert!(a.inverse_diagonal().is_none());
    }
}
