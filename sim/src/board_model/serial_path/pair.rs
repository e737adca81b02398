//! A serial port and its DMA on a bus of their own: `rigless`'s models, which stop nobody and are told of no other's requests.

use std::collections::VecDeque;

use rigless::device::{ErasedDevice, InterruptChange, ResetCause};
use rigless::emulator::{Error as MemoryError, Memory};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::stm32f427::CPU;
use rigless::soc::stm32f427::generated::{DMA1, USART2, dma2, usart6};
use rigless::soc::stm32f427::peripherals::CONTROLLERS;
use rigless::soc::stm32f427::peripherals::dma::Dma;
use rigless::soc::stm32f427::peripherals::usart::{Kind, Usart};
use rigless::soc::{Bus, Error, Region, Width};
use rigless::time::VirtualNanos;

/// The chip's clock out of reset, Hz.
const RESET_CLOCK_HZ: u64 = 16_000_000;
/// SR out of reset: nothing to send and all sent (RM0383, section 19.6.1; the table that it comes from has a slip).
const RESET_SR: u64 = 0xC0;

/// Where DMA may read and write.
static MEMORY: [Region; 2] =
    [Region::ram("sram", 0x2000_0000, 128 << 10), Region::system("flash", 0x0800_0000, 512 << 10)];

/// The two models.
#[derive(Debug)]
pub struct Pair {
    pub port: Usart,
    dma: Dma,
    bus: Bus,
    port_slot: usize,
    dma_slot: usize,
    memory: Carried,
}

/// What DMA is to read, and what it wrote and is to be put into the chip's memory.
#[derive(Debug, Default)]
struct Carried {
    begins: u64,
    message: Vec<u8>,
    stored: VecDeque<Stored>,
}

/// A store of DMA.
#[derive(Clone, Copy, Debug)]
pub struct Stored {
    pub address: u64,
    pub width: Width,
    pub value: u64,
}

impl Memory for Carried {
    fn read(&mut self, address: u64, width: Width) -> Result<u64, MemoryError> {
        let first = address.checked_sub(self.begins).map(|first| first as usize);
        let bytes = first.and_then(|first| self.message.get(first..first + width.bytes() as usize));
        let bytes = bytes.ok_or(MemoryError::Memory { address, width })?;
        Ok(bytes.iter().rev().fold(0, |value, &byte| value << 8 | u64::from(byte)))
    }

    fn write(&mut self, address: u64, width: Width, value: u64) -> Result<(), MemoryError> {
        self.stored.push_back(Stored { address, width, value });
        Ok(())
    }
}

impl Pair {
    /// The two out of reset, nothing at the line's far end.
    pub fn new() -> Result<Self, Error> {
        let bus = Bus::builder(CPU, &MEMORY, [DMA1, USART2])
            .reset(USART2.name, "SR", RESET_SR)
            .reads_requests(DMA1.name)
            .build()?;
        let controller = &CONTROLLERS[0];
        let mut pair = Self {
            port: Usart::with_clock(Kind::Usart, RESET_CLOCK_HZ),
            dma: Dma::new(controller.wiring, controller.last_data, controller.reaches_memory),
            port_slot: bus.slot(USART2.name)?,
            dma_slot: bus.slot(DMA1.name)?,
            bus,
            memory: Carried::default(),
        };
        pair.check()?;
        Ok(pair)
    }

    /// The message that DMA is about to carry.
    pub fn carry(&mut self, begins: u64, message: Vec<u8>) {
        (self.memory.begins, self.memory.message) = (begins, message);
    }

    pub fn port_holds(&self, register: usart6::Register) -> u64 {
        self.bus.slots()[self.port_slot].registers().get(register)
    }

    pub fn dma_holds(&self, register: dma2::Register) -> u64 {
        self.bus.slots()[self.dma_slot].registers().get(register)
    }

    /// Bytes that a stream of DMA has yet to hand over.
    pub fn left(&self, stream: usize) -> u64 {
        self.dma.remaining(stream).1
    }

    /// Lets what is due by `now` happen.
    pub fn run_to(&mut self, now: VirtualNanos) {
        while let Some(next) = self.next_event().filter(|&next| next <= now) {
            self.advance_to(next);
            self.follow();
        }
    }

    /// Carries out what an access or an event led to.
    pub fn follow(&mut self) {
        let mut memory = std::mem::take(&mut self.memory);
        let refused = self.settle(&mut memory).expect("DMA reads messages that it was given");
        debug_assert!(refused.is_empty(), "{refused:?}");
        self.memory = memory;
    }

    /// What DMA has stored, and what has become of the interrupt lines.
    pub fn outcome(&mut self) -> (VecDeque<Stored>, Vec<InterruptChange>) {
        (std::mem::take(&mut self.memory.stored), self.drain_interrupts())
    }

    /// The port's far end is asked for a byte.
    pub fn ask_far_end(&mut self, now: VirtualNanos) {
        let Self { port, bus, port_slot, .. } = self;
        let (registers, mut context) = bus.drive(now, *port_slot);
        ErasedDevice::poll(port, registers, &mut context);
        self.follow();
    }

    /// The port's clock changes.
    pub fn clock(&mut self, now: VirtualNanos, hz: u64) {
        let Self { port, bus, port_slot, .. } = self;
        let (registers, mut context) = bus.drive(now, *port_slot);
        ErasedDevice::on_clock(port, hz, registers, &mut context);
        self.follow();
    }

    /// One of the two is held in reset.
    pub fn reset_one(&mut self, now: VirtualNanos, port: bool) {
        let slot = if port { self.port_slot } else { self.dma_slot };
        self.bus.slot_mut(slot).registers_mut().reset();
        let (registers, mut context) = self.bus.drive(now, slot);
        let model: &mut dyn ErasedDevice = if port { &mut self.port } else { &mut self.dma };
        model.reset_line(registers, &mut context);
        self.follow();
    }
}

impl Mcu for Pair {
    fn bus(&self) -> &Bus {
        &self.bus
    }

    fn bus_mut(&mut self) -> &mut Bus {
        &mut self.bus
    }

    fn reset(&mut self, _at: VirtualNanos, _cause: ResetCause) {
        self.reset_every_model();
    }

    fn poll(&mut self, _now: VirtualNanos) {}

    fn split(&mut self, slot: usize) -> (&mut Bus, Option<&mut dyn ErasedDevice>) {
        let Self { port, dma, bus, port_slot, dma_slot, .. } = self;
        let model: Option<&mut dyn ErasedDevice> = match slot {
            _ if slot == *port_slot => Some(port),
            _ if slot == *dma_slot => Some(dma),
            _ => None,
        };
        (bus, model)
    }
}
