//! Gauss's elimination for the small systems of the reduced problem.

use nalgebra::{SMatrix, SVector};

/// `P A = L U`, by elimination with partial pivoting.
pub(super) struct Factors<const N: usize> {
    /// `U`, and below its diagonal `L`, whose own is 1.
    matrix: SMatrix<f64, N, N>,
    /// The row that each row was swapped with when its turn came.
    pivots: [usize; N],
}

impl<const N: usize> Factors<N> {
    /// The factors of `matrix`; `None` where a pivot is zero.
    ///
    /// Every column is updated over its whole length, with factors of zero where nothing changes: the compiler makes
    /// vector instructions of loops of a fixed length.
    pub(super) fn of(mut matrix: SMatrix<f64, N, N>) -> Option<Self> {
        let mut pivots = [0; N];
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
            pivots[i] = pivot;
            if pivot != i {
                matrix.swap_rows(i, pivot);
            }
            let inverse = 1.0 / matrix[(i, i)];
            let mut factors = [0.0; N];
            for row in i + 1..N {
                factors[row] = matrix[(row, i)] * inverse;
                matrix[(row, i)] = factors[row];
            }
            for column in i + 1..N {
                let along = matrix[(i, column)];
                for row in 0..N {
                    matrix[(row, column)] -= factors[row] * along;
                }
            }
        }
        Some(Self { matrix, pivots })
    }

    /// `A⁻¹ right`.
    pub(super) fn solve(&self, right: &SVector<f64, N>) -> SVector<f64, N> {
        let mut x = *right;
        for (i, &pivot) in self.pivots.iter().enumerate() {
            x.swap_rows(i, pivot);
        }
        for i in 0..N {
            for row in i + 1..N {
                x[row] -= self.matrix[(row, i)] * x[i];
            }
        }
        for i in (0..N).rev() {
            x[i] /= self.matrix[(i, i)];
            for row in 0..i {
                x[row] -= self.matrix[(row, i)] * x[i];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A diagonal of zeros makes every row move.
        #[test]
        fn the_factors_solve_for_every_right_hand_side(
            entries in prop::collection::vec(-1.0..1.0f64, 64),
            rights in prop::array::uniform2(prop::collection::vec(-1.0..1.0f64, 8)),
        ) {
            let mut matrix = SMatrix::<f64, 8, 8>::from_column_slice(&entries) * 0.1;
            for i in 0..8 {
                matrix[(i, i)] = 0.0;
                matrix[((i + 3) % 8, i)] += 2.0;
            }
            let factors = Factors::of(matrix).expect("a regular matrix");
            for right in rights {
                let right = SVector::from_column_slice(&right);
                let x = factors.solve(&right);
                prop_assert!((matrix * x - right).norm() < 1e-14);
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_none() {
        assert!(Factors::of(SMatrix::<f64, 3, 3>::from_element(1.0)).is_none());
    }
}
