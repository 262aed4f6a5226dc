//! The coefficients of two collocation methods, taken apart.

use banded::Complex;

/// Which collocation method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    /// Two stages at the nodes of Gauss, order 4: keeps energy, R(∞) = 1.
    Gauss4,
    /// Three stages at those of Radau, the last at the end, order 5: R(∞) = 0.
    Radau5,
}

impl Method {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Gauss4 => "gauss-4",
            Self::Radau5 => "radau-5",
        }
    }
}

/// An eigenvalue of `B` with its vectors, `left · right = 1`; unused entries are zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Eigenpair<T> {
    pub(crate) z: T,
    pub(crate) left: [T; 3],
    pub(crate) right: [T; 3],
}

/// A method as its stepper uses it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tableau {
    pub(crate) stages: usize,
    /// Where in the step each stage is.
    pub(crate) nodes: [f64; 3],
    /// `B`, the inverse of the coefficients.
    pub(crate) inverse: [[f64; 3]; 3],
    /// One of the complex pair.
    pub(crate) complex: Eigenpair<Complex>,
    /// The real eigenvalue of three stages.
    pub(crate) real: Option<Eigenpair<f64>>,
}

impl Tableau {
    pub(crate) fn new(method: Method) -> Self {
        match method {
            Method::Gauss4 => gauss(),
            Method::Radau5 => radau(),
        }
    }
}

/// Eigenvalues 3 ± i √3; [hairer96] IV.5.
fn gauss() -> Tableau {
    let root = 3.0_f64.sqrt();
    let zero = Complex::default();
    let half = Complex::from(0.5);
    Tableau {
        stages: 2,
        nodes: [0.5 - root / 6.0, 0.5 + root / 6.0, 0.0],
        inverse: [
            [3.0, 2.0 * root - 3.0, 0.0],
            [-2.0 * root - 3.0, 3.0, 0.0],
            [0.0; 3],
        ],
        complex: Eigenpair {
            z: Complex::new(3.0, root),
            left: [
                half,
                Complex::new(0.0, -0.5 * root / (3.0 + 2.0 * root)),
                zero,
            ],
            right: [
                Complex::from(1.0),
                Complex::new(0.0, root / (2.0 * root - 3.0)),
                zero,
            ],
        },
        real: None,
    }
}

/// Radau IIA of order 5; [hairer96] IV.5 and IV.8.
fn radau() -> Tableau {
    let root = 6.0_f64.sqrt();
    let coefficients = [
        [
            (88.0 - 7.0 * root) / 360.0,
            (296.0 - 169.0 * root) / 1800.0,
            (-2.0 + 3.0 * root) / 225.0,
        ],
        [
            (296.0 + 169.0 * root) / 1800.0,
            (88.0 + 7.0 * root) / 360.0,
            (-2.0 - 3.0 * root) / 225.0,
        ],
        [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
    ];
    let inverse = inverse(coefficients);
    let matrix = inverse.map(|row| row.map(Complex::from));
    // z³ − 9 z² + 36 z − 60 = 0, from the denominator of R(z)
    let mut real = 3.6;
    for _ in 0..8 {
        real -= (((real - 9.0) * real + 36.0) * real - 60.0) / ((3.0 * real - 18.0) * real + 36.0);
    }
    // the other two sum to 9 − z and have the product 60 / z
    let half = 0.5 * (9.0 - real);
    let z = Complex::new(half, (60.0 / real - half * half).sqrt());
    let pair = eigenpair(&matrix, Complex::from(real));
    Tableau {
        stages: 3,
        nodes: [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0],
        inverse,
        complex: eigenpair(&matrix, z),
        real: Some(Eigenpair {
            z: real,
            left: pair.left.map(|p| p.re),
            right: pair.right.map(|u| u.re),
        }),
    }
}

fn inverse(a: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, j: usize| {
        let (p, q) = ((i + 1) % 3, (i + 2) % 3);
        let (r, s) = ((j + 1) % 3, (j + 2) % 3);
        a[p][r] * a[q][s] - a[p][s] * a[q][r]
    };
    let determinant: f64 = (0..3).map(|j| a[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

/// The vectors of a simple eigenvalue: cross products of rows and of columns of `B − z`.
fn eigenpair(matrix: &[[Complex; 3]; 3], z: Complex) -> Eigenpair<Complex> {
    let mut rows = *matrix;
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = row[i] - z;
    }
    let columns: [[Complex; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i]));
    let right = cross(rows[0], rows[1]);
    let left = cross(columns[0], columns[1]);
    let product = (0..3).fold(Complex::default(), |sum, i| sum + left[i] * right[i]);
    let scale = product.recip();
    Eigenpair {
        z,
        left: left.map(|p| p * scale),
        right,
    }
}

fn cross(a: [Complex; 3], b: [Complex; 3]) -> [Complex; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(method: Method) {
        let tableau = Tableau::new(method);
        let n = tableau.stages;
        for i in 0..n {
            // B = 2 Re(z u p) + z u p of the real one, and B c = 1 since stage times are exact
            let mut along = 0.0;
            for j in 0..n {
                let pair = tableau.complex;
                let product = pair.z * pair.right[i] * pair.left[j];
                let mut sum = 2.0 * product.re;
                if let Some(real) = tableau.real {
                    sum += real.z * real.right[i] * real.left[j];
                }
                // a few roundings of numbers up to 10
                assert!(
                    (sum - tableau.inverse[i][j]).abs() < 1e-13,
                    "{method:?} {i} {j} {sum}"
                );
                along += tableau.inverse[i][j] * tableau.nodes[j];
            }
            assert!((along - 1.0).abs() < 1e-13, "{method:?} {i} {along}");
        }
    }

    #[test]
    fn the_eigenpairs_make_up_the_matrix_again() {
        check(Method::Gauss4);
        check(Method::Radau5);
    }
}
