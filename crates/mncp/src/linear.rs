use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::{Mat, MatMut, MatRef, Par};

/// Storage for `PA = LU` and for solving with it.
pub(crate) struct Lu {
    factors: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    scratch: MemBuffer,
}

impl Lu {
    /// Solves once with the identity, since faer's product kernels keep a buffer for each thread that they allocate
    /// when first used.
    pub fn new(n: usize) -> Self {
        let scratch = StackReq::any_of(&[
            factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default()),
            solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq),
        ]);
        let mut lu = Self {
            factors: Mat::zeros(n, n),
            forward: vec![0; n],
            inverse: vec![0; n],
            scratch: MemBuffer::new(scratch),
        };
        lu.solve(Mat::<f64>::identity(n, n).as_ref(), &mut vec![0.0; n]);
        lu
    }

    /// `x = A⁻¹ rhs`, in place. A singular matrix leaves infinities, NaN or a great error.
    pub fn solve(&mut self, matrix: MatRef<'_, f64>, rhs: &mut [f64]) {
        let n = rhs.len();
        let stack = MemStack::new(&mut self.scratch);
        self.factors.copy_from(matrix);
        let (_, permutation) = factor::lu_in_place(
            self.factors.as_mut(),
            &mut self.forward,
            &mut self.inverse,
            Par::Seq,
            stack,
            Default::default(),
        );
        solve::solve_in_place(
            self.factors.as_ref(),
            self.factors.as_ref(),
            permutation,
            MatMut::from_column_major_slice_mut(rhs, n, 1),
            Par::Seq,
            stack,
        );
    }
}
