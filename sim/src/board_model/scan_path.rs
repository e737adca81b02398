//! The way of a scan through the chip, converter and DMA: one event a frame instead of one a conversion.
//!
//! `rigless`'s own models stand on a bus of their own, whose events stop nobody, and catch up on what is due whenever one of
//! their registers is looked at. The core is stopped only for what it can notice by itself: DMA's interrupts. What DMA carries
//! goes into memory when it catches up. It knows what the image uses: a regular group of equally long conversions, fetched into
//! a ring of half words by stream 0 of DMA2. `tests/emulated/converter.rs` holds it beside `rigless`'s models on the chip's bus.

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange, ResetCause};
use rigless::emulator::{Error as MemoryError, InterruptLine, Memory};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::stm32f427::CPU;
use rigless::soc::stm32f427::generated::{ADC1, DMA2, adc1, dma2};
use rigless::soc::stm32f427::peripherals::CONTROLLERS;
use rigless::soc::stm32f427::peripherals::adc::{Adc, Channel};
use rigless::soc::stm32f427::peripherals::dma::Dma;
use rigless::soc::{Bus, Error, Layout, Region, RegisterSpec, Width};
use rigless::time::{EventId, VirtualNanos};
use tenax_hal_shim::channel::{CODE_MAX, SCAN_LEN};

/// ADCCLK out of reset, Hz: PCLK2 over two.
const RESET_CLOCK_HZ: u64 = 8_000_000;
const CODE_BYTES: u64 = 2;
const CR2_SWSTART: u64 = 1 << 30;

/// Where DMA may write.
const RAM: std::ops::Range<u64> = 0x2000_0000..0x2002_0000;
static MEMORY: [Region; 1] = [Region::ram("sram", RAM.start, RAM.end - RAM.start)];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    Converter,
    Controller,
}

/// The converter and its DMA.
#[derive(Debug)]
pub struct ScanPath {
    models: Models,
    asked: Asked,
    wakes: Option<VirtualNanos>,
    conversion_ns: u64,
    /// Bytes of the ring.
    ring: u64,
}

impl ScanPath {
    pub fn new() -> Result<Self, Error> {
        let models = Models::new()?;
        Ok(Self { models, asked: Asked::Controller, wakes: None, conversion_ns: 0, ring: 0 })
    }

    /// The model of one of the two.
    pub fn of(&mut self, asked: Asked) -> &mut Self {
        self.asked = asked;
        self
    }

    /// As a reset of the chip leaves it. The pins stay as they are.
    pub fn restarted(&mut self) {
        let mut fresh = Self::new().expect("what was built once is built again");
        fresh.models.adc.inherit(&self.models.adc);
        *self = fresh;
    }

    /// Puts codes on pins. What was converted before was converted from what was there before.
    pub fn put(&mut self, codes: impl IntoIterator<Item = (u8, u16)>, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        for (channel, code) in codes {
            let channel = Channel::new(channel).expect("the channel map has pin channels");
            self.models.adc.set_input(channel, u32::from(code));
        }
    }

    /// A trigger arrives that the converter listens to.
    pub fn trigger(&mut self, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        let (now, cr2) = (context.now(), register(Asked::Converter, adc1::Register::Cr2 as usize));
        let started = self.models.peek(now, cr2, Width::W32);
        let started = started.and_then(|held| self.models.write(now, cr2, Width::W32, held | CR2_SWSTART));
        debug_assert!(started.is_ok(), "{cr2:#x} is a register of the chip");
        self.models.follow();
        self.conversion_ns = self.models.next_event().map_or(0, |next| next.0 - now.0);
        self.settle(context);
    }

    fn catch_up(&mut self, context: &mut DeviceContext<'_>) {
        while let Some(next) = self.models.next_event().filter(|&next| next <= context.now()) {
            self.models.advance_to(next);
            self.models.follow();
        }
        self.settle(context);
    }

    /// Hands on what has happened, and has itself woken for DMA's next interrupt.
    fn settle(&mut self, context: &mut DeviceContext<'_>) {
        // Codes follow one another in the ring: four are one access.
        let codes: Vec<(u64, u64)> = self.models.carried.0.drain(..).collect();
        for run in codes.chunk_by(|(before, _), (address, _)| *address == before + CODE_BYTES) {
            let mut codes = run;
            while let Some(&(address, _)) = codes.first() {
                let (width, count) = if codes.len() < 4 { (Width::W16, 1) } else { (Width::W64, 4) };
                let (now, later) = codes.split_at(count);
                let value = now.iter().rev().fold(0, |value, (_, code)| value << 16 | code);
                context.write_to(address, width, value, 0);
                codes = later;
            }
        }
        for change in self.models.drain_interrupts() {
            if let Some(line) = InterruptLine::new(change.interrupt) {
                context.drive_line(line, change.level);
            }
        }
        // An earlier wake-up does no harm: it asks again.
        self.wakes = self.wakes.filter(|&at| at > context.now());
        let next = self.next_interrupt();
        if let Some(at) = next.filter(|&at| self.wakes.is_none_or(|wakes| at < wakes)) {
            self.wakes = Some(at);
            context.schedule(at);
        }
    }

    /// The end of the conversion with which DMA has filled a half of its ring or fails, if the sequence under way has it.
    fn next_interrupt(&self) -> Option<VirtualNanos> {
        let next = self.models.next_event()?;
        let (_, left) = self.models.dma.remaining(0);
        let half = self.ring / 2;
        let begins = self.models.bus.slots()[self.models.slots[1]].registers().get(dma2::Register::S0m0ar);
        let codes = match left {
            // A ring that is not in memory is an error with the next code.
            _ if !RAM.contains(&begins) => 1,
            left if left > half => (left - half) / CODE_BYTES,
            left => left / CODE_BYTES,
        };
        let is_in_sequence = (1..=SCAN_LEN as u64).contains(&codes);
        is_in_sequence.then(|| VirtualNanos(next.0 + (codes - 1) * self.conversion_ns))
    }
}

/// The address of a register.
fn register(asked: Asked, row: usize) -> u64 {
    match asked {
        Asked::Converter => ADC1.base + u64::from(adc1::Register::REGISTERS[row].offset),
        Asked::Controller => DMA2.base + u64::from(dma2::Register::REGISTERS[row].offset),
    }
}

impl ErasedDevice for ScanPath {
    fn layout(&self) -> &'static [RegisterSpec] {
        match self.asked {
            Asked::Converter => adc1::Register::REGISTERS,
            Asked::Controller => dma2::Register::REGISTERS,
        }
    }

    fn read(&mut self, row: usize, _: &mut RegisterFile, context: &mut DeviceContext<'_>) -> Option<u64> {
        self.catch_up(context);
        let value = self.models.read(context.now(), register(self.asked, row), Width::W32).ok();
        self.models.follow();
        self.settle(context);
        value
    }

    fn write(&mut self, row: usize, value: u64, _: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        let address = register(self.asked, row);
        let written = self.models.write(context.now(), address, Width::W32, value);
        debug_assert!(written.is_ok(), "{address:#x} is a register");
        self.models.follow();
        if address == register(Asked::Controller, dma2::Register::S0cr as usize) {
            self.ring = self.models.dma.remaining(0).1;
        }
        self.settle(context);
    }

    fn peek(&self, row: usize, _: &RegisterFile, _: VirtualNanos) -> Option<u64> {
        // As it stood when it was last looked at.
        let [adc, dma] = self.models.slots.map(|slot| self.models.bus.slots()[slot].registers());
        Some(match self.asked {
            Asked::Converter => adc.get(adc1::Register::ALL[row]),
            Asked::Controller => dma.get(dma2::Register::ALL[row]),
        })
    }

    fn on_event(&mut self, _: EventId, _: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
    }

    fn on_clock(&mut self, hz: u64, _: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if self.asked == Asked::Converter {
            self.catch_up(context);
            let Models { adc, bus, slots, .. } = &mut self.models;
            let (registers, mut own) = bus.drive(context.now(), slots[0]);
            ErasedDevice::on_clock(adc, hz, registers, &mut own);
            self.models.follow();
        }
    }

    fn reset_line(&mut self, _: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
        let Models { adc, dma, bus, slots, .. } = &mut self.models;
        let (slot, model): (_, &mut dyn ErasedDevice) = match self.asked {
            Asked::Converter => (slots[0], adc),
            Asked::Controller => (slots[1], dma),
        };
        bus.slot_mut(slot).registers_mut().reset();
        let (registers, mut own) = bus.drive(context.now(), slot);
        model.reset_line(registers, &mut own);
        self.models.follow();
        // Its events are gone with it.
        self.wakes = None;
        self.settle(context);
    }

    fn reset(&mut self) {}

    /// The two hear each other, and nobody else.
    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_access(&mut self, _: u64, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_refused(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}
}

/// `rigless`'s two models, told of no other's requests.
#[derive(Debug)]
struct Models {
    adc: Adc,
    dma: Dma,
    bus: Bus,
    slots: [usize; 2],
    carried: Carried,
}

/// What DMA has written, to be put into the chip's memory.
#[derive(Debug, Default)]
struct Carried(Vec<(u64, u64)>);

impl Memory for Carried {
    fn read(&mut self, address: u64, width: Width) -> Result<u64, MemoryError> {
        Err(MemoryError::Memory { address, width })
    }

    fn write(&mut self, address: u64, width: Width, value: u64) -> Result<(), MemoryError> {
        debug_assert_eq!(width, Width::W16);
        self.0.push((address, value));
        Ok(())
    }
}

impl Models {
    fn new() -> Result<Self, Error> {
        let bus = Bus::builder(CPU, &MEMORY, [DMA2, ADC1]).reads_requests(DMA2.name).build()?;
        let controller = &CONTROLLERS[1];
        let mut models = Self {
            adc: Adc::with_clock(RESET_CLOCK_HZ),
            dma: Dma::new(controller.wiring, controller.last_data, controller.reaches_memory),
            slots: [bus.slot(ADC1.name)?, bus.slot(DMA2.name)?],
            bus,
            carried: Carried::default(),
        };
        // The model's word is `input * 4095 / reference`: with this reference, an input is a code.
        models.adc.set_reference(u32::from(CODE_MAX));
        models.check()?;
        Ok(models)
    }

    /// Carries out what an access or an event led to. DMA that is sent where no memory is hears of it.
    fn follow(&mut self) {
        let mut carried = std::mem::take(&mut self.carried);
        let _refused = self.settle(&mut carried).expect("the memory is DMA's to write");
        self.carried = carried;
    }
}

impl Mcu for Models {
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
        let Self { adc, dma, bus, slots, .. } = self;
        let model: Option<&mut dyn ErasedDevice> = match slot {
            _ if slot == slots[0] => Some(adc),
            _ if slot == slots[1] => Some(dma),
            _ => None,
        };
        (bus, model)
    }
}
