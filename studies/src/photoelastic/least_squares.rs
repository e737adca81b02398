//! Weighted least squares with few unknowns.

/// Normal equations, the right side in the last column.
#[derive(Clone, Debug)]
pub struct LeastSquares<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> Default for LeastSquares<N> {
    fn default() -> Self {
        Self { matrix: [[0.0; N]; N], right: [0.0; N] }
    }
}

impl<const N: usize> LeastSquares<N> {
    /// One equation: the unknowns times `factors` are `value`.
    pub fn add(&mut self, factors: [f64; N], value: f64, weight: f64) {
        for ((row, right), own) in self.matrix.iter_mut().zip(&mut self.right).zip(factors) {
            for (cell, other) in row.iter_mut().zip(factors) {
                *cell += weight * own * other;
            }
            *right += weight * own * value;
        }
    }

    /// The unknowns. Without pivots: the matrix is positive definite where there are as many different equations.
    pub fn solve(mut self) -> [f64; N] {
        for n in 0..N {
            let (pivot, value) = (self.matrix[n], self.right[n]);
            for (row, right) in self.matrix.iter_mut().zip(&mut self.right).skip(n + 1) {
                let factor = row[n] / pivot[n];
                row.iter_mut().zip(pivot).for_each(|(cell, above)| *cell -= factor * above);
                *right -= factor * value;
            }
        }
        let mut solution = [0.0; N];
        for n in (0..N).rev() {
            let known: f64 = (n + 1..N).map(|m| self.matrix[n][m] * solution[m]).sum();
            solution[n] = (self.right[n] - known) / self.matrix[n][n];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_through_its_points() {
        let mut fit = LeastSquares::<3>::default();
        (-3..4).map(f64::from).for_each(|x| fit.add([1.0, x, x * x], 2.0 - x + 0.5 * x * x, 1.0 + x.abs()));
        let [a, b, c] = fit.solve();
        assert!((a - 2.0).abs() < 1e-9 && (b + 1.0).abs() < 1e-9 && (c - 0.5).abs() < 1e-9, "{a} {b} {c}");
    }
}
