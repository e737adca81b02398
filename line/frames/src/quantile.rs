//! Quantiles, the same for all programs. None of an empty list.

fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.into_iter().collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The least value that this part (0 to 1) of them does not exceed.
pub fn not_exceeded(values: impl IntoIterator<Item = f64>, part: f64) -> Option<f64> {
    let all = sorted(values);
    let rank = (part * all.len() as f64).ceil() as usize;
    all.get(rank.max(1) - 1).copied()
}

/// The median; of an even number of values the upper of the middle two.
pub fn middle(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let all = sorted(values);
    all.get(all.len() / 2).copied()
}

/// Linear between the ranks, for lists as short as a few people.
pub fn between_ranks(values: impl IntoIterator<Item = f64>, part: f64) -> Option<f64> {
    let all = sorted(values);
    let at = all.len().saturating_sub(1) as f64 * part;
    let (low, high) = (all.get(at.floor() as usize)?, all.get(at.ceil() as usize)?);
    Some(low + (high - low) * at.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_differ_in_an_even_list_and_an_empty_one_has_none() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(middle(values), Some(3.0));
        assert_eq!([0.0, 0.5, 1.0].map(|part| not_exceeded(values, part)), [1.0, 2.0, 4.0].map(Some));
        assert_eq!([0.0, 0.5, 1.0].map(|part| between_ranks(values, part)), [1.0, 2.5, 4.0].map(Some));
        assert_eq!((not_exceeded([], 0.5), middle([]), between_ranks([], 0.5)), (None, None, None));
    }
}
