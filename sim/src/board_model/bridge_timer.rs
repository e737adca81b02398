//! TIM1, the motor bridge's timer: nobody needs 20 000 edges a second, so only its counter moves, and that when it is read.

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::soc::stm32f427::generated::tim1::{Register, cr1, egr};
use rigless::soc::{Layout, RegisterSpec};
use rigless::time::{EventId, VirtualNanos};

/// A tick of its counter: APB2's timers count at 100 MHz.
const TICK_NS: u64 = 10;

#[derive(Debug, Default)]
pub struct BridgeTimer {
    since_ns: u64,
    from: u64,
    runs: bool,
}

impl BridgeTimer {
    fn count(&self, registers: &RegisterFile, now: VirtualNanos) -> u64 {
        let ticks = if self.runs { now.0.saturating_sub(self.since_ns) / TICK_NS } else { 0 };
        (self.from + ticks) % (registers.get(Register::Arr) + 1)
    }
}

impl ErasedDevice for BridgeTimer {
    fn layout(&self) -> &'static [RegisterSpec] {
        Register::REGISTERS
    }

    fn read(
        &mut self,
        row: usize,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.peek(row, registers, context.now())
    }

    fn peek(&self, row: usize, registers: &RegisterFile, now: VirtualNanos) -> Option<u64> {
        (row == Register::Cnt as usize).then(|| self.count(registers, now))
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        let now = context.now();
        let from = match row {
            _ if row == Register::Cnt as usize => value,
            _ if row == Register::Egr as usize && egr::UG.is_set(value) => 0,
            _ if row == Register::Cr1 as usize => self.count(registers, now),
            _ => return,
        };
        *self = Self { since_ns: now.0, from, runs: cr1::CEN.is_set(registers.get(Register::Cr1)) };
    }

    fn reset(&mut self) {
        *self = Self::default();
    }

    fn on_event(&mut self, _: EventId, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_clock(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_access(&mut self, _: u64, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_refused(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}
}
