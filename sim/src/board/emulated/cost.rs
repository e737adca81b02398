//! What the image costs: instructions a tick, instructions a second, and how deep its stack gets.

use std::ops::Range;
use std::path::Path;

use rigless::emulator::{Hit, Host};
use rigless::image::Image;
use rigless::soc::Width;

use crate::board::TickCost;
use crate::image::symbols::Symbols;

#[derive(Debug, Default)]
pub struct CostMeter {
    pub tick: u64,
    pub after_tick: u64,
    entered: Option<u64>,
    /// Ticks so far.
    pub count: u64,
    sum: u64,
    max: u64,
}

impl CostMeter {
    pub fn new(symbols: &Symbols) -> Self {
        Self { tick: symbols.tick, after_tick: symbols.after_tick, ..Self::default() }
    }

    pub fn hit(&mut self, hit: Hit) {
        if hit.address == self.tick {
            self.entered = Some(hit.instruction_count);
        } else if let Some(entered) = self.entered.take() {
            let instructions = hit.instruction_count - entered;
            self.count += 1;
            self.sum += instructions;
            self.max = self.max.max(instructions);
        }
    }

    /// What it counted, given everything that the core executed in a second. None if there was no tick.
    pub fn cost(&self, instructions_per_s: f64) -> Option<TickCost> {
        (self.count > 0).then(|| TickCost {
            count: self.count,
            instructions_mean: self.sum as f64 / self.count as f64,
            instructions_max: self.max,
            instructions_per_s,
        })
    }
}

const PAINT: u32 = 0xA5C3_3C5A;

pub fn paint(stack: &Range<u64>) -> Result<Image, rigless::image::Error> {
    let words = (stack.end - stack.start) / 4;
    let bytes = (0..words).flat_map(|_| PAINT.to_le_bytes()).collect();
    Image::new(Path::new("stack paint"), bytes, Some(stack.start))
}

/// The deepest that the stack was, bytes: interrupts use the same one.
pub fn stack_used(stack: &Range<u64>, host: &mut dyn Host) -> u64 {
    let untouched = (stack.start..stack.end)
        .step_by(4)
        .take_while(|&address| host.read(address, Width::W32).is_ok_and(|word| word == u64::from(PAINT)))
        .count();
    stack.end - stack.start - 4 * untouched as u64
}
