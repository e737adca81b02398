//! How a run compares with the bound: the least force that holds, planned ahead by one who knows the whole scene and is limited
//! by the gripper alone.

use serde::Serialize;

use super::fate::Fate;

pub const SAME_MM: f64 = 0.02;

/// The bound's run, and how the real one compares. A ratio below 0.98 is an error of the bound.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Bound {
    pub kept: Option<bool>,
    pub distance_mm: Option<f64>,
    /// The least greatest force that keeps the object, N, or lets it slide no further than the run did where that pressed less.
    pub peak_force_n: Option<f64>,
    /// The run's slip distance over the bound's. 1 where neither object slid by 0.02 mm; null where only the run's did.
    pub distance_ratio: Option<f64>,
    /// The run's peak force over the bound's. Null if the run lost the object.
    pub peak_force_ratio: Option<f64>,
}

impl Bound {
    pub fn of(run: Option<&Fate>, bound: Option<&Fate>) -> Self {
        let (Some(run), Some(bound)) = (run, bound) else {
            return Self::default();
        };
        let peaks = run.peak_grip_n.zip(bound.peak_grip_n).filter(|_| run.kept());
        let distance_ratio = match () {
            () if bound.distance_mm >= SAME_MM => Some(run.distance_mm / bound.distance_mm),
            () if run.distance_mm < SAME_MM => Some(1.0),
            () => None,
        };
        Self {
            kept: Some(bound.kept()),
            distance_mm: Some(bound.distance_mm),
            peak_force_n: bound.peak_grip_n,
            distance_ratio,
            peak_force_ratio: peaks.map(|(run_n, bound_n)| run_n / bound_n),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Control {
    pub name: String,
    pub distance_mm: f64,
    pub peak_force_n: Option<f64>,
    /// The mean grip force while the hand carried the object, N.
    pub mean_force_n: Option<f64>,
    /// The mean of what it pressed beyond the need meanwhile, N.
    pub beyond_need_n: Option<f64>,
    pub kept: bool,
}

impl Control {
    pub fn of(name: &str, fate: &Fate) -> Self {
        Self {
            name: name.to_owned(),
            distance_mm: fate.distance_mm,
            peak_force_n: fate.peak_grip_n,
            mean_force_n: fate.mean_grip_n,
            beyond_need_n: fate.beyond_need_n,
            kept: fate.kept(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_there_where_it_says_something() {
        let fate = |distance_mm, peak_n| Fate { distance_mm, peak_grip_n: Some(peak_n), ..Fate::default() };
        let ratios = |run: &Fate, bound: &Fate| {
            let own = Bound::of(Some(run), Some(bound));
            (own.distance_ratio, own.peak_force_ratio)
        };
        assert_eq!(ratios(&fate(3.0, 12.0), &fate(1.5, 10.0)), (Some(2.0), Some(1.2)));
        assert_eq!(ratios(&fate(0.01, 12.0), &fate(0.0, 10.0)), (Some(1.0), Some(1.2)));
        assert_eq!(ratios(&fate(3.0, 12.0), &fate(0.0, 10.0)), (None, Some(1.2)));
        let lost = Fate { dropped: true, ..fate(40.0, 5.0) };
        assert_eq!(ratios(&lost, &fate(1.0, 10.0)), (Some(40.0), None));
    }
}
