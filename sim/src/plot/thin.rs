//! Fewer points for the same picture.

const COLUMNS: usize = 1_000;

/// A curve that is thinned as it comes, so that it takes the same memory however long it gets: of each column of pixels
/// the first, lowest, highest and last point are kept, so that no spike is lost.
#[derive(Clone, Debug)]
pub struct Thin {
    from_s: f64,
    to_s: f64,
    width_s: f64,
    kept: Vec<(f64, f64)>,
    column: Option<Column>,
}

pub fn thin(points: impl IntoIterator<Item = (f64, f64)>, span_s: (f64, f64)) -> Vec<(f64, f64)> {
    let mut thin = Thin::new(span_s);
    points.into_iter().for_each(|point| thin.push(point));
    thin.points()
}

#[derive(Clone, Copy, Debug)]
struct Column {
    at: usize,
    count: usize,
    first: Point,
    low: Point,
    high: Point,
    last: Point,
}

type Point = (usize, (f64, f64));

impl Thin {
    /// A curve without points, from and to these times, s.
    pub fn new((from_s, to_s): (f64, f64)) -> Self {
        let width_s = ((to_s - from_s) / COLUMNS as f64).max(f64::MIN_POSITIVE);
        Self { from_s, to_s, width_s, kept: Vec::new(), column: None }
    }

    pub fn push(&mut self, point: (f64, f64)) {
        if !(self.from_s..=self.to_s).contains(&point.0) {
            return;
        }
        let at = ((point.0 - self.from_s) / self.width_s) as usize;
        match &mut self.column {
            Some(column) if column.at == at => column.take(point),
            _ => {
                self.flush();
                let first = (0, point);
                self.column = Some(Column { at, count: 1, first, low: first, high: first, last: first });
            }
        }
    }

    pub fn points(mut self) -> Vec<(f64, f64)> {
        self.flush();
        self.kept
    }

    fn flush(&mut self) {
        let Some(Column { first, low, high, last, .. }) = self.column.take() else {
            return;
        };
        let mut points = [first, low, high, last];
        points.sort_unstable_by_key(|(place, _)| *place);
        for (n, (place, point)) in points.iter().enumerate() {
            if n == 0 || points[n - 1].0 != *place {
                self.kept.push(*point);
            }
        }
    }
}

impl Column {
    fn take(&mut self, point: (f64, f64)) {
        let new = (self.count, point);
        self.count += 1;
        self.last = new;
        // The first of the lowest and the last of the highest; what is no number is higher than all.
        if point.1.total_cmp(&self.low.1.1).is_lt() {
            self.low = new;
        }
        if point.1.total_cmp(&self.high.1.1).is_ge() {
            self.high = new;
        }
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
