//! The way of a scan through the chip, converter and DMA, as one model: one event a frame instead of one a conversion.
//!
//! Nothing of a scan is seen from outside before a frame's last code, so this model is worked out when it is looked at: at
//! every access to a register of the two and at DMA's interrupts it takes the conversions that have ended by then, with the
//! times that clock and sampling give them. `tests/emulated/converter.rs` holds it beside `rigless`'s own models.
//!
//! It knows what the image uses: a regular group of a trigger, fetched into a ring by stream 0 of DMA2.

mod converter;
mod stream;

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::soc::stm32f427::generated::{adc1, dma2};
use rigless::soc::{Layout, RegisterSpec, Width};
use rigless::time::{EventId, VirtualNanos};

use self::converter::Converter;
use self::stream::Stream;

const DMA2_LIFCR: u64 = 0x4002_6408;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// The converter, ADC1.
    Converter,
    /// The controller, DMA2. Events are its own.
    Controller,
}

#[derive(Debug)]
pub struct ScanPath {
    converter: Converter,
    stream: Stream,
    asked: Asked,
    wakes: Option<EventId>,
}

impl ScanPath {
    pub fn new() -> Self {
        Self { converter: Converter::new(), stream: Stream::new(), asked: Asked::Controller, wakes: None }
    }

    pub fn of(&mut self, asked: Asked) -> &mut Self {
        self.asked = asked;
        self
    }

    pub fn restarted(&mut self) {
        self.converter.restarted();
        self.stream.reset();
        self.wakes = None;
    }

    pub fn put(&mut self, codes: impl IntoIterator<Item = (u8, u16)>, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        codes.into_iter().for_each(|(channel, code)| self.converter.put(channel, code));
    }

    pub fn trigger(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        self.converter.start(context.now());
        self.settle(registers, context);
    }

    fn catch_up(&mut self, context: &mut DeviceContext<'_>) {
        let Self { converter, stream, .. } = self;
        while converter.convert(context.now()).is_some() {
            fetch(converter, stream, context);
        }
        stream.put(context);
    }

    fn settle(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.stream.settle(registers, context);
        // Nothing is seen before somebody asks, except when the stream raises a flag.
        let next = self.stream.patience().and_then(|codes| self.converter.ends(codes as usize - 1));
        self.wakes = next.map(|at| context.schedule(at));
    }
}

fn fetch(converter: &mut Converter, stream: &mut Stream, context: &mut DeviceContext<'_>) {
    if converter.requests() {
        stream.take(|| converter.taken(), context);
    }
}

impl ErasedDevice for ScanPath {
    fn layout(&self) -> &'static [RegisterSpec] {
        match self.asked {
            Asked::Converter => adc1::Register::REGISTERS,
            Asked::Controller => dma2::Register::REGISTERS,
        }
    }

    fn read(
        &mut self,
        row: usize,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.catch_up(context);
        match self.asked {
            Asked::Converter => {
                let shown = self.converter.shows(row);
                if row == adc1::Register::Dr as usize {
                    self.converter.taken();
                }
                shown
            }
            Asked::Controller => self.stream.shows(row),
        }
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        self.catch_up(context);
        match self.asked {
            Asked::Converter => {
                self.converter.written(row, value);
                if self.converter.requests() {
                    // It asks for an old code. What follows may be a flag of the controller, so it is the controller that
                    // looks: a write that clears nothing.
                    context.write_to(DMA2_LIFCR, Width::W32, 0, 0);
                }
            }
            Asked::Controller => {
                self.stream.written(row, value, registers, context);
                fetch(&mut self.converter, &mut self.stream, context);
                self.stream.put(context);
                self.settle(registers, context);
            }
        }
    }

    fn on_event(&mut self, event: EventId, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if self.asked == Asked::Controller && self.wakes == Some(event) {
            self.catch_up(context);
            self.settle(registers, context);
        }
    }

    fn on_clock(&mut self, hz: u64, _registers: &mut RegisterFile, _context: &mut DeviceContext<'_>) {
        if self.asked == Asked::Converter {
            self.converter.clock(hz);
        }
    }

    /// The converter's request does not go over the bus, and nothing else's is carried.
    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_access(&mut self, _: u64, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn reset(&mut self) {
        match self.asked {
            Asked::Converter => self.converter.reset(),
            Asked::Controller => self.stream.reset(),
        }
    }

    fn reset_line(&mut self, _registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        self.reset();
    }

    fn on_refused(&mut self, token: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        // What is not carried into memory is carried code by code, at the controller's events.
        if self.asked == Asked::Controller {
            self.stream.refused(token, registers, context);
        }
    }

    fn peek(&self, row: usize, _registers: &RegisterFile, _now: VirtualNanos) -> Option<u64> {
        // As it stood when it was last looked at.
        match self.asked {
            Asked::Converter => self.converter.shows(row),
            Asked::Controller => self.stream.shows(row),
        }
    }
}
