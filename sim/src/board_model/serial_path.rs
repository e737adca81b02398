//! The serial line's way through the chip, port and DMA: one event a message instead of one a byte.
//!
//! `rigless`'s own models stand on a bus of their own (`pair.rs`) and catch up on what is due whenever one of their registers
//! is looked at. The core is stopped only for what it can notice by itself, their interrupts: while a message goes up and
//! nothing comes down, that is the end of DMA's block. What DMA reads is asked for when its stream is switched on, for
//! who handed the message over does not touch it before it is sent; what it writes goes into memory when it catches up.

mod pair;

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::emulator::InterruptLine;
use rigless::mcu::Operate;
use rigless::soc::stm32f427::generated::usart6::Register;
use rigless::soc::stm32f427::generated::{DMA1, USART2, dma2};
use rigless::soc::{Error, Layout, RegisterSpec, Width};
use rigless::time::{EventId, VirtualNanos};

use self::pair::Pair;
use super::line::Line;

/// The stream of DMA1 that serves the transmitter of USART2, the ST-LINK's port (RM0383, table 27).
const UP: usize = 6;
/// The receiver's.
const DOWN: usize = 5;

/// Of a stream's registers, the first of which is the first stream's control: six in a row.
#[derive(Clone, Copy)]
enum Row {
    Control,
    Left,
    Memory = 3,
}

const fn row_of(stream: usize, row: Row) -> usize {
    dma2::Register::S0cr as usize + 6 * stream + row as usize
}

const CR1_OVER8: u64 = 1 << 15;
const CR2_STOP: u64 = 0b11 << 12;
/// The transmitter's interrupt that it is empty.
const CR1_TXEIE: u64 = 1 << 7;
const CR1_RXNEIE: u64 = 1 << 5;
const CR1_TCIE: u64 = 1 << 6;
const CR3_DMAR: u64 = 1 << 6;
const CR_TCIE: u64 = 1 << 4;
const CR_EN: u64 = 1;
const CR_HTIE: u64 = 1 << 3;
const CR_DIR: u64 = 0b11 << 6;
const CR_DIR_UP: u64 = 0b01 << 6;
const CR_SIZES: u64 = 0b1111 << 11;
const NS_PER_S: u64 = 1_000_000_000;
/// A start bit, eight data bits and a stop bit, of sixteen samples each that BRR counts together.
const FRAME_BITS: u64 = 10;
/// After so many frames without a byte, the line down has been found idle.
const IDLE_FRAMES: u64 = 4;

/// Which of the two is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    Port,
    Controller,
}

/// The port and its DMA.
#[derive(Debug)]
pub struct SerialPath {
    pair: Pair,
    clock_hz: u64,
    asked: Asked,
    wakes: Option<VirtualNanos>,
    starting: Option<Starting>,
}

/// The stream's start, put off until its message is there, which is at the same instant.
#[derive(Debug)]
struct Starting {
    control: u64,
    begins: u64,
    message: Vec<u8>,
    missing: usize,
}

impl SerialPath {
    /// The two out of reset, `far_end` at the far end.
    pub fn new(far_end: Option<Line>) -> Result<Self, Error> {
        let mut pair = Pair::new()?;
        if let Some(far_end) = far_end {
            pair.port.attach(far_end);
        }
        Ok(Self { pair, clock_hz: 0, asked: Asked::Port, wakes: None, starting: None })
    }

    /// The model of one of the two.
    pub fn of(&mut self, asked: Asked) -> &mut Self {
        self.asked = asked;
        self
    }

    /// As a reset of the chip leaves it. The far end has heard what was sent before.
    pub fn restarted(&mut self, at: VirtualNanos) {
        self.pair.run_to(at);
        let mut fresh = Self::new(None).expect("what was built once is built again");
        fresh.pair.port.inherit(&mut self.pair.port);
        *self = fresh;
    }

    /// The far end as it is now. What is handed over is the port's.
    pub fn line(&mut self, context: &mut DeviceContext<'_>) -> Option<&mut Line> {
        self.catch_up(context);
        self.pair.port.chip_mut::<Line>()
    }

    /// The far end is looked at, as it is at every stop.
    pub fn look(&mut self, context: &mut DeviceContext<'_>) {
        let now = context.now();
        if self.pair.port.chip_mut::<Line>().is_some_and(|line| !line.down.is_empty()) {
            self.pair.run_to(now);
            self.pair.ask_far_end(now);
            self.settle(context);
        }
    }

    fn catch_up(&mut self, context: &mut DeviceContext<'_>) {
        self.pair.run_to(context.now());
        self.settle(context);
    }

    /// Hands on what has happened, and has itself woken for what will.
    fn settle(&mut self, context: &mut DeviceContext<'_>) {
        let (stored, lines) = self.pair.outcome();
        for store in stored {
            context.write_to(store.address, store.width, store.value, 0);
        }
        for change in lines {
            if let Some(line) = InterruptLine::new(change.interrupt) {
                context.drive_line(line, change.level);
            }
        }
        let now = context.now();
        // An earlier wake-up does no harm: it asks again.
        self.wakes = self.wakes.filter(|&at| at > now);
        if let Some(at) = self.next_to_notice(now)
            && self.wakes.is_none_or(|wakes| at < wakes)
        {
            self.wakes = Some(at);
            context.schedule(at);
        }
    }

    /// No later than the next instant at which the core is interrupted.
    fn next_to_notice(&mut self, now: VirtualNanos) -> Option<VirtualNanos> {
        let next = self.pair.next_event()?;
        let [cr1, cr2, cr3, brr] =
            [Register::Cr1, Register::Cr2, Register::Cr3, Register::Brr].map(|row| self.pair.port_holds(row));
        let frame_ns = (FRAME_BITS * brr * NS_PER_S).checked_div(self.clock_hz).unwrap_or(0);
        let [up, down] = [UP, DOWN].map(|stream| self.control(stream));
        let [ready, heard_at] = match self.pair.port.chip_mut::<Line>() {
            Some(line) => [line.down.len() as u64, line.last_down.map_or(0, |at| at.0)],
            None => [1, now.0],
        };
        let hears = ready > 0 || heard_at + IDLE_FRAMES * frame_ns > now.0 && heard_at > 0;
        let unusual = cr1 & (CR1_TXEIE | CR1_OVER8) | cr2 & CR2_STOP | up & CR_HTIE;
        let by_itself = cr1 & CR1_RXNEIE | down & (CR_HTIE | CR_TCIE) == 0 && cr3 & CR3_DMAR != 0;
        let left = self.pair.left(UP);
        if unusual != 0 || hears && !(by_itself && left == 0 && ready > 0) {
            return Some(next);
        }
        if hears {
            // DMA takes what comes; who hears of it waits for the pause behind.
            return Some(VirtualNanos(next.0 + (ready - 1) * frame_ns));
        }
        match left {
            0 if cr1 & CR1_TCIE != 0 => Some(next),
            // All handed over: how it goes out changes nothing but flags.
            0 => None,
            left => Some(VirtualNanos(next.0 + (left - 1) * frame_ns)),
        }
    }

    /// The control register of a stream.
    fn control(&self, stream: usize) -> u64 {
        self.pair.dma_holds(dma2::Register::ALL[row_of(stream, Row::Control)])
    }

    fn address(&self, row: usize) -> u64 {
        match self.asked {
            Asked::Port => USART2.base + u64::from(Register::REGISTERS[row].offset),
            Asked::Controller => DMA1.base + u64::from(dma2::Register::REGISTERS[row].offset),
        }
    }

    fn write_own(&mut self, row: usize, value: u64, context: &mut DeviceContext<'_>) {
        let written = self.pair.write(context.now(), self.address(row), Width::W32, value);
        debug_assert!(written.is_ok(), "{:#x} is a register", self.address(row));
        self.pair.follow();
        self.settle(context);
    }

    /// Asks for the message that the stream is to carry.
    fn start(&mut self, control: u64, context: &mut DeviceContext<'_>) {
        assert!(control & CR_SIZES == 0, "messages go up byte by byte: {control:#x}");
        let [begins, length] =
            [Row::Memory, Row::Left].map(|row| self.pair.dma_holds(dma2::Register::ALL[row_of(UP, row)]));
        for offset in 0..length {
            context.read_from(begins + offset, Width::W8, offset);
        }
        let missing = length as usize;
        self.starting = Some(Starting { control, begins, message: vec![0; missing], missing });
        if missing == 0 {
            self.started(context);
        }
    }

    fn started(&mut self, context: &mut DeviceContext<'_>) {
        if let Some(starting) = self.starting.take() {
            self.pair.carry(starting.begins, starting.message);
            self.asked = Asked::Controller;
            self.write_own(row_of(UP, Row::Control), starting.control, context);
        }
    }
}

impl ErasedDevice for SerialPath {
    fn layout(&self) -> &'static [RegisterSpec] {
        match self.asked {
            Asked::Port => Register::REGISTERS,
            Asked::Controller => dma2::Register::REGISTERS,
        }
    }

    fn read(
        &mut self,
        row: usize,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.pair.run_to(context.now());
        let value = self.pair.read(context.now(), self.address(row), Width::W32).ok();
        self.pair.follow();
        self.settle(context);
        value
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        self.pair.run_to(context.now());
        let on = self.control(UP) & CR_EN != 0;
        let is_control = self.asked == Asked::Controller && row == row_of(UP, Row::Control);
        let switched_on = is_control && value & CR_EN != 0 && !on;
        if switched_on && value & CR_DIR == CR_DIR_UP {
            self.start(value, context);
        } else {
            self.write_own(row, value, context);
        }
    }

    fn on_access(
        &mut self,
        token: u64,
        value: u64,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        // Stores are answered too, in the order in which they were asked for, and none is under way beside a start.
        if let Some(starting) = &mut self.starting {
            starting.message[token as usize] = value as u8;
            starting.missing -= 1;
            if starting.missing == 0 {
                self.started(context);
            }
        }
    }

    fn on_event(&mut self, _: EventId, _: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.catch_up(context);
    }

    fn on_clock(&mut self, hz: u64, _registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if self.asked == Asked::Port {
            self.pair.run_to(context.now());
            self.clock_hz = hz;
            self.pair.clock(context.now(), hz);
            self.settle(context);
        }
    }

    fn reset_line(&mut self, _registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.pair.run_to(context.now());
        self.pair.reset_one(context.now(), self.asked == Asked::Port);
        // Its events are gone with it.
        self.wakes = None;
        self.settle(context);
    }

    fn reset(&mut self) {}

    /// The two hear each other, and nobody else.
    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_refused(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {
        debug_assert!(false, "the line's DMA was sent where no memory is");
    }
}
