//! The way of a scan through the chip, converter and DMA, as one model: one event a frame instead of one a conversion.
//!
//! `rigless` stops the core at each conversion's end, moves a code, and tells every peripheral of every request. Nothing
//! of that is seen from outside before a frame's last code: the ring is read after DMA's interrupt. So this model is
//! worked out when it is looked at: at every access to a register of the two, and at the instants at which something is
//! to be seen without one, which are DMA's interrupts, it takes the conversions that have ended by then, one after another
//! with the times that the clock and the sampling give them. What is read at any instant is what `rigless`'s own models
//! show at that instant: `beside.rs` and `bench/tests/emulated/converter.rs` hold them beside each other.
//!
//! It knows what the image uses: a regular group of a trigger, fetched into a ring by stream 0 of DMA2. It panics at what
//! it does not know. The common status register (ADC_CSR) does not image the flags.

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

    fn on_request(
        &mut self,
        _request: RequestChange,
        _registers: &mut RegisterFile,
        _context: &mut DeviceContext<'_>,
    ) {
    }

    fn poll(&mut self, _registers: &mut RegisterFile, _context: &mut DeviceContext<'_>) {}

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

    fn on_access(
        &mut self,
        _token: u64,
        _value: u64,
        _registers: &mut RegisterFile,
        _context: &mut DeviceContext<'_>,
    ) {
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
