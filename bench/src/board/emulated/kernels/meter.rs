//! Counts kernels' instructions.

use std::collections::BTreeSet;

use crate::image::kernels::Kernel;

/// What a kernel cost, in instructions from its entry to where it returned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    pub name: String,
    pub calls: u64,
    pub least: u64,
    pub most: u64,
    sum: u64,
}

impl Cost {
    pub fn mean(&self) -> f64 {
        self.sum as f64 / self.calls as f64
    }
}

/// One for each kernel.
#[derive(Debug)]
pub struct Meters(Vec<Meter>);

#[derive(Debug)]
struct Meter {
    kernel: Kernel,
    entered: Option<u64>,
    cost: Cost,
}

impl Meters {
    pub fn new(kernels: &[Kernel]) -> Self {
        let meter = |kernel: &Kernel| Meter {
            kernel: kernel.clone(),
            entered: None,
            cost: Cost { name: kernel.name.clone(), calls: 0, least: u64::MAX, most: 0, sum: 0 },
        };
        Self(kernels.iter().map(meter).collect())
    }

    /// The instructions to be told about, each once: a kernel may return to where the next one begins.
    pub fn watched(kernels: &[Kernel]) -> impl Iterator<Item = u64> {
        let ends = kernels.iter().flat_map(|kernel| kernel.after.iter().copied().chain([kernel.entry]));
        ends.collect::<BTreeSet<_>>().into_iter()
    }

    /// The core is about to run a watched instruction, after so many.
    pub fn hit(&mut self, address: u64, executed: u64) {
        for meter in &mut self.0 {
            if meter.kernel.after.contains(&address)
                && let Some(entered) = meter.entered.take()
            {
                let instructions = executed - entered;
                meter.cost.calls += 1;
                meter.cost.least = meter.cost.least.min(instructions);
                meter.cost.most = meter.cost.most.max(instructions);
                meter.cost.sum += instructions;
            }
            if address == meter.kernel.entry {
                meter.entered = Some(executed);
            }
        }
    }

    /// What those that ran cost, by name.
    pub fn into_costs(self) -> Vec<Cost> {
        let mut costs: Vec<Cost> =
            self.0.into_iter().map(|meter| meter.cost).filter(|cost| cost.calls > 0).collect();
        costs.sort_by(|a, b| a.name.cmp(&b.name));
        costs
    }
}
