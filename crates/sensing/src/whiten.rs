//! The inverse Cholesky factor of a covariance: numbers that it is multiplied by are of unit variance.

use crate::SensingError;

/// Rows whose sums are made side by side.
const TOGETHER: usize = 4;

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
        let mut next = |length: usize| {
            let (row, below) = rest.split_at(length);
            rest = below;
            row
        };
        // A sum waits for its last addition: those of some rows go side by side.
        let together = self.count - self.count % TOGETHER;
        for r in (0..together).step_by(TOGETHER) {
            let rows: [&[f64]; TOGETHER] = std::array::from_fn(|k| next(r + k + 1));
            let mut sums = [[0.0; N]; TOGETHER];
            let [a, b, c, d] = rows;
            for ((((a, b), c), d), values) in a.iter().zip(b).zip(c).zip(d).zip(columns) {
                for (sum, w) in sums.iter_mut().zip([a, b, c, d]) {
                    add(sum, *w, values);
                }
            }
            for (sum, row) in sums.iter_mut().zip(rows) {
                for (w, values) in row.iter().zip(columns).skip(r + 1) {
                    add(sum, *w, values);
                }
            }
            out.extend(sums);
        }
        for r in together..self.count {
            let mut sum = [0.0; N];
            for (w, values) in next(r + 1).iter().zip(columns) {
                add(&mut sum, *w, values);
            }
            out.push(sum);
        }
    }
}

#[inline]
fn add<const N: usize>(sum: &mut [f64; N], weight: f64, values: &[f64; N]) {
    for (s, v) in sum.iter_mut().zip(values) {
        *s += weight * v;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_side_by_side_are_those_of_one_row_after_another_to_the_bit() {
        for count in 0..10_usize {
            let value = |r: usize, k: usize| ((7 * r + 3 * k + 1) as f64).sin();
            let rows: Vec<Vec<f64>> = (0..count).map(|r| (0..count).map(|k| value(r, k)).collect()).collect();
            let columns: Vec<[f64; 3]> = (0..count).map(|k| [value(k, 20), value(k, 30), 1e9 * value(k, 40)]).collect();
            let mut found = Vec::new();
            Whiten::new(rows.clone().into_iter()).unwrap().apply(&columns, &mut found);
            let expected: Vec<[f64; 3]> = (0..count)
                .map(|r| std::array::from_fn(|c| (0..=r).fold(0.0, |sum, k| sum + rows[r][k] * columns[k][c])))
                .collect();
            assert_eq!(found, expected);
        }
    }
}
