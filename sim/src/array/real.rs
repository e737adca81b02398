//! Logits of a network over recordings, and how well they rank steps that slip.

/// Logits of the steps of one recording. None where the network has nothing to judge by yet.
pub type Logits = Vec<Option<i32>>;

/// Area under the ROC curve: the Mann-Whitney statistic, ties counting half. Sorts them by their score.
pub fn auc(scored: &mut [(f64, bool)]) -> f64 {
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut below, mut slips, mut won) = (0.0, 0.0, 0.0);
    for tied in scored.chunk_by(|a, b| a.0 == b.0) {
        let of = |kind: bool| tied.iter().filter(|own| own.1 == kind).count() as f64;
        let (slip, other) = (of(true), of(false));
        won += slip * (below + other / 2.0);
        below += other;
        slips += slip;
    }
    won / (slips * below)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_area_is_the_share_of_pairs_in_order() {
        let mut scored = [(1.0, false), (2.0, true), (2.0, false), (3.0, true)];
        assert!((super::auc(&mut scored) - 0.875).abs() < 1e-12);
    }
}
