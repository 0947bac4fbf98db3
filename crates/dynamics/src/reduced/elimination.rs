//! Gauss's elimination for the small systems of the reduced problem.

use nalgebra::{SMatrix, SVector};

/// `P A = L U`, by elimination with partial pivoting.
pub(super) struct Factors<const N: usize> {
    /// The columns of `U`, and below its diagonal those of `L`, whose own diagonal is 1.
    columns: [[f64; N]; N],
    /// The row that each row was swapped with when its turn came.
    pivots: [usize; N],
}

impl<const N: usize> Factors<N> {
    /// The factors of `matrix`; `None` where a pivot is zero.
    pub(super) fn of(matrix: &SMatrix<f64, N, N>) -> Option<Self> {
        const { assert!(N <= 9, "a turn for every column") };
        let mut factors = Self { columns: matrix.data.0, pivots: [0; N] };
        // Written out, so that the compiler knows the length of every loop in a turn.
        let regular = factors.eliminate::<0>()
            && factors.eliminate::<1>()
            && factors.eliminate::<2>()
            && factors.eliminate::<3>()
            && factors.eliminate::<4>()
            && factors.eliminate::<5>()
            && factors.eliminate::<6>()
            && factors.eliminate::<7>()
            && factors.eliminate::<8>();
        regular.then_some(factors)
    }

    /// The turn of column `I`, where there is one; false where its pivot is zero.
    #[inline(always)]
    fn eliminate<const I: usize>(&mut self) -> bool {
        if I >= N {
            return true;
        }
        let columns = &mut self.columns;
        let (mut pivot, mut greatest) = (I, columns[I][I].abs());
        for (row, value) in columns[I].iter().enumerate().skip(I + 1) {
            if value.abs() > greatest {
                (pivot, greatest) = (row, value.abs());
            }
        }
        self.pivots[I] = pivot;
        if pivot != I {
            columns.iter_mut().for_each(|column| column.swap(I, pivot));
        }
        let (done, rest) = columns.split_at_mut(I + 1);
        let factors = &mut done[I][I..];
        let inverse = 1.0 / factors[0];
        factors[1..].iter_mut().for_each(|factor| *factor *= inverse);
        for column in rest {
            let along = column[I];
            column[I..].iter_mut().zip(&*factors).skip(1).for_each(|(value, factor)| *value -= factor * along);
        }
        greatest != 0.0
    }

    /// `A⁻¹ right`.
    pub(super) fn solve(&self, right: &SVector<f64, N>) -> SVector<f64, N> {
        let mut x = right.data.0[0];
        for (i, &pivot) in self.pivots.iter().enumerate() {
            x.swap(i, pivot);
        }
        for (i, column) in self.columns.iter().enumerate() {
            let along = x[i];
            for row in i + 1..N {
                x[row] -= column[row] * along;
            }
        }
        for (i, column) in self.columns.iter().enumerate().rev() {
            x[i] /= column[i];
            let along = x[i];
            for row in 0..i {
                x[row] -= column[row] * along;
            }
        }
        SVector::from(x)
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
            let factors = Factors::of(&matrix).expect("a regular matrix");
            for right in rights {
                let right = SVector::from_column_slice(&right);
                let x = factors.solve(&right);
                prop_assert!((matrix * x - right).norm() < 1e-14);
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_none() {
        assert!(Factors::of(&SMatrix::<f64, 3, 3>::from_element(1.0)).is_none());
    }
}
