//! The fingertip's end of the bus to a palm (`tenax-palm`): USART1 at 5 Mbit/s, a transceiver whose driver PA12 switches on.
//!
//! DMA writes what comes into a ring. A pause on the wires interrupts for an instant, above control, which notes when and how far; a
//! second interrupt below control decodes it and lets DMA send the answer. Control never waits for either: while the end is held below
//! it, what a tick says to the palm is said just before the next one. Nobody on the bus: control looks at one flag.

use core::mem::MaybeUninit;
use core::ptr::{addr_of, addr_of_mut};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering::Relaxed, compiler_fence};

use cortex_m::peripheral::NVIC;
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::pac::{self, Interrupt};
use embassy_stm32::peripherals::{DMA2_CH5, DMA2_CH7, PA10, PA12, PA15, USART1};
use embassy_stm32::{Peri, interrupt};
use tenax_hal_shim::wire::{Received, Receiver, Up};
use tenax_logic::allowance::Allowance;
use tenax_logic::detectors::Said;
use tenax_logic::fingertip::Fingertip;
use tenax_palm::bus::{BAUD, BEGINS_US, Chip, FRAME_MAX, bytes_us};
use tenax_palm::finger::{Answer, Finger};

use crate::commands;
use crate::deadline::Slot;
use crate::micros::clock_us;
use crate::port::BUS;

/// Bytes that DMA writes around in: 0.5 ms of a full bus, and control takes a tenth of that from who reads them.
const RING_LEN: usize = 256;
/// USART1's clock, APB2.
const CLOCK_HZ: u32 = 100_000_000;
/// Ticks after which what a palm wished is void, if nothing could be said to its end since: as long as a wish lasts.
const WISH_TICKS_MAX: u8 = 16;
/// Ticks after which an answer that is still being sent is given up, and with it the wires.
const SENDING_MAX: u8 = 4;

/// What is held by one at a time.
pub struct End {
    finger: Finger,
    /// Where the ring was read to.
    read: usize,
    /// What comes down its line.
    down: Receiver,
    allowance: Allowance,
    _driver: Output<'static>,
}

static mut END: MaybeUninit<End> = MaybeUninit::uninit();
static mut RING: [u8; RING_LEN] = [0; RING_LEN];
static mut ANSWER: [u8; FRAME_MAX] = [0; FRAME_MAX];

/// Somebody below control has the end.
static HELD: AtomicBool = AtomicBool::new(false);
/// A palm has been answered.
static JOINED: AtomicBool = AtomicBool::new(false);
/// A tick was over while the end was held.
static LATE: AtomicBool = AtomicBool::new(false);
/// Times that the end was held as something was to be said to it, in a row: twice a tick.
static UNSAID: AtomicU8 = AtomicU8::new(0);
/// When the last frame ended, us.
static FRAME_US: AtomicU32 = AtomicU32::new(0);
/// An answer is being sent, or waits for its slot; and ticks since.
static SENDING: AtomicBool = AtomicBool::new(false);
static SENT_TICKS: AtomicU8 = AtomicU8::new(0);
/// The last pause: when its frame had ended, us, and where the ring stood.
static PAUSE: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];
/// What is done with the end: the pause that is read up to, the frame's end that is told, us, and the number of the message that is sent
/// up. The emulated board reads them by this name.
#[unsafe(no_mangle)]
static TENAX_BUS_DOES: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];

/// Listens from now on. Called once, before control starts.
pub fn start(
    _port: Peri<'static, USART1>,
    _streams: (Peri<'static, DMA2_CH5>, Peri<'static, DMA2_CH7>),
    _pins: (Peri<'static, PA15>, Peri<'static, PA10>),
    driver: Peri<'static, PA12>,
    chip: Chip,
) {
    let end = End {
        finger: Finger::new(chip),
        read: 0,
        down: Receiver::new(),
        allowance: Allowance::default(),
        _driver: Output::new(driver, Level::Low, Speed::Low),
    };
    // SAFETY: nobody looks at it before the interrupts are enabled below.
    unsafe { addr_of_mut!(END).cast::<End>().write(end) };
    pac::RCC.apb2enr().modify(|w| w.set_usart1en(true));
    BUS.open((CLOCK_HZ / BAUD) as u16, [15, 10], addr_of_mut!(RING));
    interrupt::USART1.set_priority(Priority::P1);
    interrupt::I2C3_EV.set_priority(Priority::P4);
    // SAFETY: what their handlers use is set up above.
    unsafe {
        interrupt::USART1.enable();
        interrupt::I2C3_EV.enable();
    }
}

/// A pause on the wires, or the end of the answer: the driver lets go of them at once, for the palm goes on 10 us later.
#[interrupt]
unsafe fn USART1() {
    let seen = pac::USART1.sr().read();
    if seen.idle() {
        // With the status before, this clears the flag.
        let _last = pac::USART1.dr().read();
        let [at_us, to] = &PAUSE;
        // The pause is a byte long by now.
        at_us.store(clock_us().wrapping_sub(bytes_us(1)), Relaxed);
        to.store((RING_LEN - BUS.left()) as u32, Relaxed);
        NVIC::pend(Interrupt::I2C3_EV);
    }
    if seen.tc() && pac::USART1.cr1().read().tcie() {
        let_go();
    }
}

/// Reads what came before the pause.
#[interrupt]
unsafe fn I2C3_EV() {
    HELD.store(true, Relaxed);
    compiler_fence(SeqCst);
    // SAFETY: it is set up before this is enabled. The line's task disables this interrupt before it takes the end, and control leaves
    // it alone while it is held.
    let end = unsafe { &mut *addr_of_mut!(END).cast::<End>() };
    let [at_us, to] = cortex_m::interrupt::free(|_| PAUSE.each_ref().map(|word| word.load(Relaxed)));
    let [does_at_us, does_to, ..] = &TENAX_BUS_DOES;
    does_at_us.store(at_us, Relaxed);
    does_to.store(to, Relaxed);
    tenax_bus_hear(end, at_us, to);
    compiler_fence(SeqCst);
    HELD.store(false, Relaxed);
}

/// Not inlined, so that the emulated board can tell by this name when what came was read.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_bus_hear(end: &mut End, at_us: u32, to: u32) {
    let mut out = [0; FRAME_MAX];
    while end.read != to as usize % RING_LEN {
        // SAFETY: within the ring, which DMA writes behind the compiler's back.
        let byte = unsafe { addr_of!(RING).cast::<u8>().add(end.read).read_volatile() };
        end.read = (end.read + 1) % RING_LEN;
        // More has come since: the pause that is known is not this poll's.
        if let Some(answer) = end.finger.hear(byte, at_us, &mut out)
            && end.read == to as usize % RING_LEN
        {
            JOINED.store(true, Relaxed);
            say(answer, at_us, &out);
        }
    }
    while let Some(byte) = end.finger.line_byte() {
        commands::take(&mut end.down, &mut end.allowance, byte);
    }
}

/// Sends an answer, unless it comes too late or one is on its way.
fn say(answer: Answer, at_us: u32, out: &[u8; FRAME_MAX]) {
    if SENDING.load(Relaxed) {
        return;
    }
    // SAFETY: nobody sends from it: see above.
    unsafe { addr_of_mut!(ANSWER).write(*out) };
    BUS.prepare(addr_of!(ANSWER).cast(), answer.length);
    let due_us = at_us.wrapping_add(answer.after_us);
    // Between a look at the clock and the wires nothing comes, so that neither what is late is begun nor a slot is missed.
    cortex_m::interrupt::free(|_| {
        let late_us = clock_us().wrapping_sub(due_us).cast_signed();
        if late_us > LATEST_US {
            return;
        }
        SENDING.store(true, Relaxed);
        if late_us < -SOON_US {
            Slot::at(due_us);
        } else {
            begin();
        }
    });
}

/// An answer that would begin later is left out: with long wires, the palm has gone on when its first byte is over.
const LATEST_US: i32 = BEGINS_US as i32 - 25;
/// A slot this near is not waited for, us.
const SOON_US: i32 = 5;

/// Takes the wires and sends the answer that is ready: where it was decoded, or at its slot.
pub fn begin() {
    if !SENDING.load(Relaxed) {
        return;
    }
    pac::GPIOA.bsrr().write(|w| w.set_bs(12, true));
    BUS.begin();
}

/// Leaves the wires to the others.
fn let_go() {
    pac::GPIOA.bsrr().write(|w| w.set_br(12, true));
    BUS.end();
    Slot::cancel();
    SENDING.store(false, Relaxed);
}

/// A frame has ended, at this instant of the clock, us.
pub fn frame_ended(at_us: u32) {
    FRAME_US.store(at_us, Relaxed);
}

/// Before a tick: says what the last one could not.
pub fn before_tick(fingertip: &mut Fingertip) {
    if LATE.load(Relaxed) {
        tell(fingertip);
    }
}

/// After a tick.
pub fn after_tick(fingertip: &mut Fingertip) {
    if JOINED.load(Relaxed) {
        after(fingertip);
    }
}

#[inline(never)]
fn after(fingertip: &mut Fingertip) {
    let sent = if SENDING.load(Relaxed) { SENT_TICKS.load(Relaxed) + 1 } else { 0 };
    SENT_TICKS.store(sent, Relaxed);
    if sent > SENDING_MAX {
        let_go();
    }
    LATE.store(true, Relaxed);
    let [_, _, tick_us, _] = &TENAX_BUS_DOES;
    tick_us.store(FRAME_US.load(Relaxed), Relaxed);
    tell(fingertip);
}

#[inline(never)]
fn tell(fingertip: &mut Fingertip) {
    if HELD.load(Relaxed) {
        // A flood keeps it: what was wished before does not go on for that.
        let ticks = UNSAID.load(Relaxed).saturating_add(1);
        UNSAID.store(ticks, Relaxed);
        if ticks > 2 * WISH_TICKS_MAX {
            fingertip.inject(Said::default());
            fingertip.wish(None);
        }
    } else {
        LATE.store(false, Relaxed);
        UNSAID.store(0, Relaxed);
        // SAFETY: a palm was answered, so it is set up; nobody has it, and nobody who could take it runs before this is over.
        let end = unsafe { &mut *addr_of_mut!(END).cast::<End>() };
        let [_, _, tick_us, _] = &TENAX_BUS_DOES;
        tenax_bus_tick(&mut end.finger, fingertip, tick_us.load(Relaxed));
    }
}

/// Not inlined, so that the emulated board can tell by this name between which commands and ticks it was.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_bus_tick(finger: &mut Finger, fingertip: &mut Fingertip, at_us: u32) {
    finger.ticked(fingertip, at_us);
}

/// A message goes up the line as this frame: up the bus as well, once there is a palm.
pub fn said(posted: &Received<Up>, frame: &[u8]) {
    let Received { sequence, message } = posted;
    if JOINED.load(Relaxed) || matches!(message, Up::Slow(_)) {
        interrupt::I2C3_EV.disable();
        cortex_m::asm::isb();
        HELD.store(true, Relaxed);
        compiler_fence(SeqCst);
        // SAFETY: a palm was answered, or control runs, so it is set up; the interrupt that takes it is off, and control leaves it alone.
        let end = unsafe { &mut *addr_of_mut!(END).cast::<End>() };
        let joined = JOINED.load(Relaxed);
        let [_, _, _, number] = &TENAX_BUS_DOES;
        number.store((*sequence).into(), Relaxed);
        tenax_bus_said(&mut end.finger, message, if joined { frame } else { &[] });
        compiler_fence(SeqCst);
        HELD.store(false, Relaxed);
        // SAFETY: as it was.
        unsafe { interrupt::I2C3_EV.enable() };
    }
}

/// Not inlined, so that the emulated board can tell by this name between which polls it was.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_bus_said(finger: &mut Finger, message: &Up, frame: &[u8]) {
    finger.note(message);
    finger.post(frame);
}
