//! Quantiles, for all tools alike: each room's figures come from these three.

fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.into_iter().collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The least value that this part of them does not exceed. None of none.
pub fn not_exceeded(values: impl IntoIterator<Item = f64>, part: f64) -> Option<f64> {
    let all = sorted(values);
    let rank = (part * all.len() as f64).ceil() as usize;
    all.get(rank.max(1) - 1).copied()
}

/// The middle one, of an even number the upper: a value that was measured. None of none.
pub fn middle(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let all = sorted(values);
    all.get(all.len() / 2).copied()
}

/// Linear between the ranks, for lists as short as a few people. None of none.
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
    fn of_an_even_list_they_differ_as_they_say() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(not_exceeded(values, 0.5), Some(2.0));
        assert_eq!(middle(values), Some(3.0));
        assert_eq!(between_ranks(values, 0.5), Some(2.5));
        assert_eq!([0.0, 1.0].map(|part| not_exceeded(values, part)), [Some(1.0), Some(4.0)]);
        assert_eq!([0.0, 1.0].map(|part| between_ranks(values, part)), [Some(1.0), Some(4.0)]);
    }

    #[test]
    fn of_none_there_is_none() {
        assert_eq!((not_exceeded([], 0.5), middle([]), between_ranks([], 0.5)), (None, None, None));
    }
}
