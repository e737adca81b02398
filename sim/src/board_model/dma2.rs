//! DMA2, which carries the scan and what comes and goes on the palm's bus: each stream is the model's that it serves.

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::soc::stm32f427::generated::dma2::Register;
use rigless::soc::{Error, Layout, RegisterSpec};
use rigless::time::{EventId, VirtualNanos};

use super::line::BusEnd;
use super::scan_path::{self, ScanPath};
use super::serial_path::{self, PALM, SerialPath};

/// Both models, for DMA2's slot.
#[derive(Debug)]
pub struct Shared {
    /// Stream 0.
    pub scan: ScanPath,
    /// Streams 5 and 7.
    pub bus: SerialPath<BusEnd>,
}

impl Shared {
    /// Both out of reset.
    pub fn new() -> Result<Self, Error> {
        Ok(Self { scan: ScanPath::new(), bus: SerialPath::new(&PALM, Some(BusEnd::default()))? })
    }

    fn scan(&mut self) -> &mut ScanPath {
        self.scan.of(scan_path::Asked::Controller)
    }

    fn bus(&mut self) -> &mut SerialPath<BusEnd> {
        self.bus.of(serial_path::Asked::Controller)
    }

    fn of(&mut self, row: usize) -> &mut dyn ErasedDevice {
        let flags = [Register::Hisr as usize, Register::Hifcr as usize];
        if PALM.has(row) || flags.contains(&row) { self.bus() } else { self.scan() }
    }
}

impl ErasedDevice for Shared {
    fn layout(&self) -> &'static [RegisterSpec] {
        Register::REGISTERS
    }

    fn read(
        &mut self,
        row: usize,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.of(row).read(row, registers, context)
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        self.of(row).write(row, value, registers, context);
    }

    fn on_event(&mut self, event: EventId, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.scan().on_event(event, registers, context);
        self.bus().on_event(event, registers, context);
    }

    fn on_clock(&mut self, hz: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.scan().on_clock(hz, registers, context);
    }

    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn reset(&mut self) {
        self.scan().reset();
        self.bus().reset();
    }

    fn reset_line(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.scan().reset_line(registers, context);
        self.bus().reset_line(registers, context);
    }

    fn on_access(
        &mut self,
        token: u64,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        // The scan asks memory for nothing.
        self.bus().on_access(token, value, registers, context);
    }

    fn on_refused(&mut self, token: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        // The bus is sent nowhere else than into its ring.
        self.scan().on_refused(token, registers, context);
    }

    fn peek(&self, row: usize, registers: &RegisterFile, now: VirtualNanos) -> Option<u64> {
        if PALM.has(row) { self.bus.peek(row, registers, now) } else { self.scan.peek(row, registers, now) }
    }
}
