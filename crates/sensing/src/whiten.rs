//! The inverse Cholesky factor of a covariance: numbers that it is multiplied by are of unit variance.

use crate::SensingError;

/// A lower triangle, row after row.
#[derive(Debug, Clone, PartialEq)]
pub struct Whiten {
    count: usize,
    packed: Vec<f64>,
}

impl Whiten {
    /// From the rows of a square matrix, of which what is above the diagonal does not count.
    pub fn new(rows: impl ExactSizeIterator<Item = Vec<f64>>) -> Result<Self, SensingError> {
        let count = rows.len();
        let mut packed = Vec::with_capacity(count * (count + 1) / 2);
        for (r, row) in rows.enumerate() {
            SensingError::same("a whitening matrix's columns", row.len(), count)?;
            packed.extend_from_slice(&row[..=r]);
        }
        Ok(Self { count, packed })
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Appends the product with `N` columns, given as rows.
    pub fn apply<const N: usize>(&self, columns: &[[f64; N]], out: &mut Vec<[f64; N]>) {
        let mut rest = self.packed.as_slice();
        for r in 0..self.count {
            let (row, below) = rest.split_at(r + 1);
            rest = below;
            let mut sum = [0.0; N];
            for (w, values) in row.iter().zip(columns) {
                for (s, v) in sum.iter_mut().zip(values) {
                    *s += w * v;
                }
            }
            out.push(sum);
        }
    }
}
