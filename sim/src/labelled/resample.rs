//! From a sensor's own instants to the board's 80 Hz.

use tenax_hal_shim::channel::SLOW_HZ;

/// Places on a recording's own rows at which the board would have read: row, and how far on the way to the next.
///
/// Between rows a signal is a straight line. A recording that is faster than 80 Hz is not low-passed first: the board's
/// switched inputs would not do so either.
pub fn instants(t_s: &[f64]) -> Vec<(usize, f64)> {
    let (Some(&first), Some(&last)) = (t_s.first(), t_s.last()) else { return Vec::new() };
    let rate_hz = f64::from(SLOW_HZ);
    // A hair more, so that a last row that is there but for rounding counts.
    let count = ((last - first) * rate_hz + 1e-6) as usize + 1;
    let mut row = 0;
    (0..count)
        .map(|n| {
            let t = first + n as f64 / rate_hz;
            while row + 2 < t_s.len() && t_s[row + 1] <= t {
                row += 1;
            }
            match t_s.get(row + 1) {
                Some(&next) if next > t_s[row] => (row, ((t - t_s[row]) / (next - t_s[row])).clamp(0.0, 1.0)),
                _ => (row, 0.0),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_at_another_rate_stays_one() {
        let t_s = [0.0, 0.01, 0.02, 0.02, 0.045, 0.1];
        for (n, (row, part)) in instants(&t_s).into_iter().enumerate() {
            let t = t_s[row] + part * (t_s.get(row + 1).unwrap_or(&t_s[row]) - t_s[row]);
            assert!((t - n as f64 * 0.0125).abs() < 1e-9, "{n}: {t}");
        }
        assert_eq!(instants(&t_s).len(), 9);
        assert_eq!(instants(&[3.0]), [(0, 0.0)]);
        assert!(instants(&[]).is_empty());
    }
}
