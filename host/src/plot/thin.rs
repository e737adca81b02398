//! Fewer points for the same picture.

/// At most this many columns of pixels matter in one panel.
const COLUMNS: usize = 1_000;

/// Keeps the first, lowest, highest and last point of each column of pixels, so that no spike is lost.
#[must_use]
pub fn thin(points: impl IntoIterator<Item = (f64, f64)>, (from_s, to_s): (f64, f64)) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    let mut column: Vec<(f64, f64)> = Vec::new();
    let mut current = usize::MAX;
    let width_s = ((to_s - from_s) / COLUMNS as f64).max(f64::MIN_POSITIVE);
    for point in points.into_iter().filter(|point| (from_s..=to_s).contains(&point.0)) {
        let place = ((point.0 - from_s) / width_s) as usize;
        if place != current {
            flush(&mut column, &mut kept);
            current = place;
        }
        column.push(point);
    }
    flush(&mut column, &mut kept);
    kept
}

fn flush(column: &mut Vec<(f64, f64)>, kept: &mut Vec<(f64, f64)>) {
    let by_value = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
    let (Some(low), Some(high)) = ((0..column.len()).min_by(by_value), (0..column.len()).max_by(by_value))
    else {
        return;
    };
    let mut places = [0, low, high, column.len() - 1];
    places.sort_unstable();
    for (n, &place) in places.iter().enumerate() {
        if n == 0 || places[n - 1] != place {
            kept.push(column[place]);
        }
    }
    column.clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_among_a_million_points_is_kept() {
        let points = (0..1_000_000).map(|n| (f64::from(n) * 1e-6, if n == 123_456 { 9.0 } else { 0.0 }));
        let kept = thin(points, (0.0, 1.0));
        assert!(kept.len() <= 4 * (COLUMNS + 1), "{}", kept.len());
        assert!(kept.contains(&(123_456.0 * 1e-6, 9.0)));
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
