//! What each row takes of the core and its memories.

use std::collections::BTreeMap;

/// Of a row, or of a kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Times a second.
    pub per_s: u32,
    pub instructions_mean: f64,
    pub instructions_max: u64,
    pub cycles_mean: Option<f64>,
    pub flash_bytes: Option<u64>,
    pub ram_bytes: Option<u64>,
}

/// Every kernel's, by name. Empty where there is no core to count on.
#[derive(Clone, Debug, Default)]
pub struct Costs(pub BTreeMap<String, Cost>);

impl Costs {
    /// Of these kernels together, for each decision of the one that decides most often. None if one of them was not counted.
    pub fn of(&self, kernels: &[&str]) -> Option<Cost> {
        let own: Vec<&Cost> = kernels.iter().map(|name| self.0.get(*name)).collect::<Option<_>>()?;
        let per_s = own.iter().map(|cost| cost.per_s).max()?;
        let share = |cost: &Cost| f64::from(cost.per_s) / f64::from(per_s);
        let sum = |of: fn(&Cost) -> Option<u64>| own.iter().map(|cost| of(cost)).sum::<Option<u64>>();
        Some(Cost {
            per_s,
            instructions_mean: own.iter().map(|cost| cost.instructions_mean * share(cost)).sum(),
            instructions_max: own.iter().map(|cost| cost.instructions_max).sum(),
            cycles_mean: own.iter().map(|cost| Some(cost.cycles_mean? * share(cost))).sum(),
            flash_bytes: sum(|cost| cost.flash_bytes),
            ram_bytes: sum(|cost| cost.ram_bytes),
        })
    }
}
