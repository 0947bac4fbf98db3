//! Gauss's elimination for the small systems of the reduced problem.

use nalgebra::{SMatrix, SVector};

/// `x` with `matrix x = right`, by elimination with partial pivoting; `None` where a pivot is zero.
///
/// The right-hand side is eliminated with the matrix, and every column is updated over its whole length, with factors of
/// zero where nothing changes: the compiler makes vector instructions of loops of a fixed length.
pub(super) fn solve<const N: usize>(
    mut matrix: SMatrix<f64, N, N>,
    right: &SVector<f64, N>,
) -> Option<SVector<f64, N>> {
    let mut x = *right;
    for i in 0..N {
        let mut pivot = i;
        for row in i + 1..N {
            if matrix[(row, i)].abs() > matrix[(pivot, i)].abs() {
                pivot = row;
            }
        }
        if matrix[(pivot, i)] == 0.0 {
            return None;
        }
        if pivot != i {
            matrix.swap_rows(i, pivot);
            x.swap_rows(i, pivot);
        }
        let inverse = 1.0 / matrix[(i, i)];
        let mut factors = [0.0; N];
        for row in i + 1..N {
            factors[row] = matrix[(row, i)] * inverse;
        }
        for column in i + 1..N {
            let along = matrix[(i, column)];
            for row in 0..N {
                matrix[(row, column)] -= factors[row] * along;
            }
        }
        let along = x[i];
        for row in 0..N {
            x[row] -= factors[row] * along;
        }
    }
    for i in (0..N).rev() {
        x[i] /= matrix[(i, i)];
        for row in 0..i {
            x[row] -= matrix[(row, i)] * x[i];
        }
    }
    Some(x)
}
