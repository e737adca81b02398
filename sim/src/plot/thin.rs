//! Fewer points for the same picture.

const COLUMNS: usize = 1_000;

/// A curve that is thinned as it comes to the first, lowest, highest and last point of each column of pixels.
#[derive(Clone, Debug)]
pub struct Thin {
    from_s: f64,
    to_s: f64,
    width_s: f64,
    kept: Vec<(f64, f64)>,
    at: usize,
    /// The points of the column that is drawn now.
    column: Vec<(f64, f64)>,
}

pub fn thin(points: impl IntoIterator<Item = (f64, f64)>, span_s: (f64, f64)) -> Vec<(f64, f64)> {
    let mut thin = Thin::new(span_s);
    points.into_iter().for_each(|point| thin.push(point));
    thin.points()
}

impl Thin {
    /// A curve without points, from and to these times, s.
    pub fn new((from_s, to_s): (f64, f64)) -> Self {
        let width_s = ((to_s - from_s) / COLUMNS as f64).max(f64::MIN_POSITIVE);
        Self { from_s, to_s, width_s, kept: Vec::new(), at: 0, column: Vec::new() }
    }

    pub fn push(&mut self, point: (f64, f64)) {
        if !(self.from_s..=self.to_s).contains(&point.0) {
            return;
        }
        let at = ((point.0 - self.from_s) / self.width_s) as usize;
        if at != self.at {
            self.flush();
            self.at = at;
        }
        self.column.push(point);
    }

    pub fn points(mut self) -> Vec<(f64, f64)> {
        self.flush();
        self.kept
    }

    fn flush(&mut self) {
        let column = &self.column;
        // The first of the lowest and the last of the highest; what is no number is higher than all.
        let by_value = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
        let all = || 0..column.len();
        let ends = [all().next(), all().min_by(by_value), all().max_by(by_value), all().last()];
        self.kept.extend(all().filter(|n| ends.contains(&Some(*n))).map(|n| column[n]));
        self.column.clear();
    }
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
