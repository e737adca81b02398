//! From uneven rows to the even instants of the scans: straight lines between rows, filtered at a whole multiple of the scan rate that
//! is at least twice the recording's own, and thinned to the scans behind the front end.

use tenax_hal_shim::channel::SCAN_HZ;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    pub per_scan: usize,
    pub from_s: f64,
    pub scans: usize,
}

impl Grid {
    /// A grid for a recording of `rate_hz` rows a second that begins at `first_s`, with a lead-in and a lead-out.
    pub fn new(rate_hz: f64, first_s: f64, duration_s: f64, lead_in_s: f64, lead_out_s: f64) -> Self {
        let scan_hz = f64::from(SCAN_HZ);
        let per_scan = (2.0 * rate_hz / scan_hz).ceil().clamp(1.0, 16.0) as usize;
        Self {
            per_scan,
            from_s: first_s - lead_in_s,
            scans: ((lead_in_s + duration_s + lead_out_s) * scan_hz).ceil() as usize,
        }
    }

    pub fn rate_hz(&self) -> f64 {
        f64::from(SCAN_HZ) * self.per_scan as f64
    }

    /// The series on the grid: straight lines between rows, the first and last row held outside. `t_s` must not decrease.
    pub fn draw(&self, t_s: &[f64], values: &[f64]) -> Vec<f64> {
        let step_s = 1.0 / self.rate_hz();
        let mut next = 0;
        (0..self.scans * self.per_scan)
            .map(|n| {
                let t = self.from_s + n as f64 * step_s;
                while next < t_s.len() && t_s[next] <= t {
                    next += 1;
                }
                match next {
                    0 => values[0],
                    _ if next == t_s.len() => values[next - 1],
                    _ => {
                        let part = (t - t_s[next - 1]) / (t_s[next] - t_s[next - 1]);
                        values[next - 1] + part * (values[next] - values[next - 1])
                    }
                }
            })
            .collect()
    }

    pub fn thin(&self, values: &[f64]) -> Vec<f64> {
        values.iter().step_by(self.per_scan).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uneven_rows_of_a_straight_line_stay_a_straight_line() {
        let t_s = [0.0, 0.000_3, 0.001, 0.001, 0.004];
        let values = t_s.map(|t| 5.0 * t - 1.0);
        let grid = Grid::new(1_000.0, 0.0, 0.004, 0.001, 0.001);
        assert_eq!((grid.per_scan, grid.scans), (1, 48));
        for (n, value) in grid.draw(&t_s, &values).iter().enumerate() {
            let t = (n as f64 / 8_000.0 - 0.001).clamp(0.0, 0.004);
            assert!((value - (5.0 * t - 1.0)).abs() < 1e-12, "at {t}");
        }
    }

    #[test]
    fn a_fast_recording_is_worked_on_at_twice_its_rate_or_more() {
        let grid = Grid::new(10_000.0, 0.0, 1.0, 0.0, 0.0);
        assert_eq!(grid.per_scan, 3);
        assert_eq!(grid.thin(&grid.draw(&[0.0, 1.0], &[0.0, 1.0])).len(), 8_000);
        // One time stamp for all rows: an infinite rate is worked on at a finite one.
        assert_eq!(Grid::new(f64::INFINITY, 0.0, 0.0, 0.0, 0.1).per_scan, 16);
    }
}
