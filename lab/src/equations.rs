//! Least squares and logistic regression, for few unknowns as for a hundred.

/// `matrix x = right`. The matrix is symmetric and positive definite; its lower half is kept.
#[derive(Clone, Debug)]
pub struct Equations {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Equations {
    pub fn new(unknowns: usize) -> Self {
        Self { matrix: (1..=unknowns).map(|cells| vec![0.0; cells]).collect(), right: vec![0.0; unknowns] }
    }

    /// One more row: its factors times the unknowns are `pull / weight`, and it counts `weight`.
    pub fn add(&mut self, factors: &[f64], weight: f64, pull: f64) {
        for ((row, right), own) in self.matrix.iter_mut().zip(&mut self.right).zip(factors) {
            if *own != 0.0 {
                *right += pull * own;
                let own = weight * own;
                row.iter_mut().zip(factors).for_each(|(cell, other)| *cell += own * other);
            }
        }
    }

    pub fn add_to(&mut self, unknown: usize, weight: f64, pull: f64) {
        self.matrix[unknown][unknown] += weight;
        self.right[unknown] += pull;
    }

    /// The unknowns, by Cholesky's factors.
    pub fn solve(self) -> Vec<f64> {
        let Self { matrix: mut rows, mut right } = self;
        for i in 0..right.len() {
            for j in 0..=i {
                let less: f64 = (0..j).map(|k| rows[i][k] * rows[j][k]).sum();
                let left = rows[i][j] - less;
                rows[i][j] = if i == j { left.max(1e-12).sqrt() } else { left / rows[j][j] };
            }
        }
        for i in 0..right.len() {
            right[i] = (right[i] - (0..i).map(|k| rows[i][k] * right[k]).sum::<f64>()) / rows[i][i];
        }
        for i in (0..right.len()).rev() {
            let known: f64 = (i + 1..right.len()).map(|k| rows[k][i] * right[k]).sum();
            right[i] = (right[i] - known) / rows[i][i];
        }
        right
    }
}

/// Weights and bias of a logistic regression by Newton's method. `rows` writes a row's factors, and tells whether it is of the positive
/// class and how much it counts; `ridge` is half the penalty of a squared weight.
pub fn logistic(
    unknowns: usize,
    rows: usize,
    ridge: f64,
    row: impl Fn(usize, &mut [f64]) -> (bool, f64),
) -> (Vec<f64>, f64) {
    let (mut weights, mut factors) = (vec![0.0; unknowns + 1], vec![1.0; unknowns + 1]);
    for _ in 0..ROUNDS {
        let mut equations = Equations::new(unknowns + 1);
        for n in 0..rows {
            let (positive, counts) = row(n, &mut factors[..unknowns]);
            let logit: f64 = factors.iter().zip(&weights).map(|(x, weight)| x * weight).sum();
            let p = 1.0 / (1.0 + (-logit).exp());
            equations.add(
                &factors,
                counts * (p * (1.0 - p)).max(1e-6),
                counts * (f64::from(u8::from(positive)) - p),
            );
        }
        (0..unknowns).for_each(|n| equations.add_to(n, ridge, -ridge * weights[n]));
        equations.add_to(unknowns, 1e-9, 0.0);
        weights.iter_mut().zip(equations.solve()).for_each(|(weight, step)| *weight += step);
    }
    let bias = weights.pop().unwrap_or_default();
    (weights, bias)
}

const ROUNDS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_through_its_points_and_a_ridge_shrinks_it() {
        let fit = |ridge: f64| {
            let mut fit = Equations::new(3);
            for x in (-3..4).map(f64::from) {
                let weight = 1.0 + x.abs();
                fit.add(&[1.0, x, x * x], weight, weight * (2.0 - x + 0.5 * x * x));
            }
            (0..3).for_each(|n| fit.add_to(n, ridge, 0.0));
            fit.solve()
        };
        let exact = fit(0.0);
        for (found, right) in exact.iter().zip([2.0, -1.0, 0.5]) {
            assert!((found - right).abs() < 1e-9, "{exact:?}");
        }
        assert!(fit(1e3).iter().zip(&exact).all(|(shrunk, exact)| shrunk.abs() < exact.abs()));
    }
}
