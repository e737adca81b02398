//! Logistic regression, for few unknowns as for a hundred.

const ROUNDS: usize = 8;

/// Weights and bias by Newton's method. `row` writes a row's factors, and tells whether it is of the positive class; `ridge` is half the
/// penalty of a squared weight.
pub fn logistic(
    unknowns: usize,
    rows: usize,
    ridge: f64,
    row: impl Fn(usize, &mut [f64]) -> bool,
) -> (Vec<f64>, f64) {
    let (mut weights, mut factors) = (vec![0.0; unknowns + 1], vec![1.0; unknowns + 1]);
    for _ in 0..ROUNDS {
        let mut matrix: Vec<Vec<f64>> = (1..=unknowns + 1).map(|cells| vec![0.0; cells]).collect();
        let mut right = vec![0.0; unknowns + 1];
        for n in 0..rows {
            let positive = row(n, &mut factors[..unknowns]);
            let logit: f64 = factors.iter().zip(&weights).map(|(x, weight)| x * weight).sum();
            let p = 1.0 / (1.0 + (-logit).exp());
            let (weight, pull) = ((p * (1.0 - p)).max(1e-6), f64::from(u8::from(positive)) - p);
            for ((cells, right), own) in matrix.iter_mut().zip(&mut right).zip(&factors) {
                *right += pull * own;
                cells.iter_mut().zip(&factors).for_each(|(cell, other)| *cell += weight * own * other);
            }
        }
        for n in 0..unknowns {
            matrix[n][n] += ridge;
            right[n] -= ridge * weights[n];
        }
        matrix[unknowns][unknowns] += 1e-9;
        weights.iter_mut().zip(solve(matrix, right)).for_each(|(weight, step)| *weight += step);
    }
    let bias = weights.pop().unwrap_or_default();
    (weights, bias)
}

/// x of `matrix x = right`, by Cholesky's factors. The matrix is symmetric and positive definite; its lower half is given.
fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of the rows is positive without the first factor, three quarters with it; the second says nothing.
    #[test]
    fn odds_are_found_and_a_ridge_shrinks_them() {
        let fit = |ridge| {
            let row = |n: usize, factors: &mut [f64]| {
                (factors[0], factors[1]) =
                    (f64::from(u8::from(n < 8)), f64::from(u8::from(n.is_multiple_of(2))));
                if n < 8 { n >= 2 } else { n < 10 }
            };
            logistic(2, 16, ridge, row)
        };
        let (weights, bias) = fit(0.0);
        let ln_3 = 3.0_f64.ln();
        for (found, right) in [(weights[0], 2.0 * ln_3), (weights[1], 0.0), (bias, -ln_3)] {
            assert!((found - right).abs() < 1e-6, "{weights:?} {bias}");
        }
        assert!(fit(1e3).0[0].abs() < 0.1);
    }
}
