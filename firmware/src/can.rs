//! The fingertip's evidence and margin on classic CAN, where a chip has it in place of the palm's bus: CAN1 at 1 Mbit/s, PB8 from the
//! transceiver and PB9 to it.
//!
//! Control hands two frames to the mailboxes at the end of each slow frame, and never waits for one. What nobody has taken by the next
//! slow frame is given up then; what finds no mailbox is left out. It hears nothing: the filters stay as a reset leaves them, in their
//! initialisation, where nothing is received (RM0390, CAN filter master register). On a bus where nobody acknowledges, the chip repeats
//! a frame until it is given up, and after a bus-off goes on by itself.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

use embassy_stm32::Peri;
use embassy_stm32::pac::can::regs::Tsr;
use embassy_stm32::pac::can::vals::Ide;
use embassy_stm32::pac::gpio::vals::{Moder, Ospeedr, Pupdr};
use embassy_stm32::pac::{CAN1, GPIOB, RCC};
use embassy_stm32::peripherals::{self, PB8, PB9};
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::wire::{Received, Up};
use tenax_logic::fingertip::Fingertip;
use tenax_palm::bus::Chip;
use tenax_palm::can::{Evidence, Frame, Margin, Word, pack, who};

use crate::clock::APB1_HZ;

/// The bus's rate, bit/s.
const RATE: u32 = 1_000_000;
/// A bit in quanta of APB1's clock: one to synchronise, then these, with the sample after the first part.
const BEFORE_SAMPLE: u8 = 16;
const AFTER_SAMPLE: u8 = 8;
/// By how many a bit may be moved.
const JUMP: u8 = 4;
const _: () = assert!(APB1_HZ == RATE * (1 + BEFORE_SAMPLE as u32 + AFTER_SAMPLE as u32));
/// The pins, and the function of both that is the port's (DS10693, alternate functions).
const PINS: [usize; 2] = [8, 9];
const CAN1_PINS: u8 = 9;
/// Looks at whether it is ready to be set up: some of its clocks after it is asked.
const LOOKS: u32 = 1_000;
const MAILBOXES: usize = 3;
/// Where TSR says which of them are empty.
const EMPTY_SHIFT: u32 = 26;
/// Over the name, where the port is open.
const OPEN: u32 = 1 << 31;

/// Who speaks, and that the port is open. Only control looks at it, and at what is next.
static WHO: AtomicU32 = AtomicU32::new(0);
/// Detectors that said slip since the last slow frame, and those that warned of it.
static SAID: [AtomicU8; 2] = [const { AtomicU8::new(0) }; 2];

/// Sets the port up. Without the crystal it stays closed: the chip's own oscillator is too far off for CAN, and would disturb others.
pub fn start(
    crystal: bool,
    _port: Peri<'static, peripherals::CAN1>,
    _pins: (Peri<'static, PB8>, Peri<'static, PB9>),
    chip: Chip,
) {
    if !crystal {
        return;
    }
    RCC.apb1enr().modify(|w| w.set_can1en(true));
    // Without a transceiver the bus is silent.
    GPIOB.pupdr().modify(|w| w.set_pupdr(PINS[0], Pupdr::PULL_UP));
    for pin in PINS {
        GPIOB.ospeedr().modify(|w| w.set_ospeedr(pin, Ospeedr::MEDIUM_SPEED));
        GPIOB.afr(1).modify(|w| w.set_afr(pin - 8, CAN1_PINS));
        GPIOB.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
    }
    CAN1.mcr().modify(|w| {
        w.set_sleep(false);
        w.set_inrq(true);
    });
    if !(0..LOOKS).any(|_| CAN1.msr().read().inak()) {
        return;
    }
    CAN1.btr().write(|w| {
        w.set_ts(0, BEFORE_SAMPLE - 1);
        w.set_ts(1, AFTER_SAMPLE - 1);
        w.set_sjw(JUMP - 1);
    });
    // It takes part from the first pause on the bus on; nobody waits for that.
    CAN1.mcr().modify(|w| {
        w.set_abom(true);
        w.set_inrq(false);
    });
    WHO.store(OPEN | who(chip), Relaxed);
}

/// After a tick: keeps what was said, and says it at the end of a slow frame.
pub fn after_tick(fingertip: &mut Fingertip) {
    let now = [fingertip.slip(), fingertip.incipient()];
    for (said, now) in SAID.iter().zip(now) {
        // Control alone writes it.
        said.store(said.load(Relaxed) | now.bits(), Relaxed);
    }
    if fingertip.frame() % u32::from(FRAMES_PER_SLOW_FRAME) == u32::from(FRAMES_PER_SLOW_FRAME) - 1 {
        tenax_can_say(fingertip);
    }
}

/// Not inlined, so that the emulated board can count its instructions by this name.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_can_say(fingertip: &Fingertip) {
    let said = SAID.each_ref().map(|said| DetectorSet::from_bits(said.load(Relaxed)).unwrap_or_default());
    SAID.iter().for_each(|said| said.store(0, Relaxed));
    let own = WHO.load(Relaxed);
    if own & OPEN == 0 {
        return;
    }
    let [slip, incipient] = said;
    let frame = fingertip.frame();
    let evidence = Evidence { frame, slip, incipient, wearer: fingertip.wearer_active() };
    let margin = Margin::of(fingertip.forces(), fingertip.s2_permille());
    give_up();
    let mut frames =
        [Word::Evidence(evidence), Word::Margin(margin)].map(|word| pack(own, &word)).into_iter();
    let empty = CAN1.tsr().read().0 >> EMPTY_SHIFT;
    for mailbox in 0..MAILBOXES {
        if empty & 1 << mailbox != 0
            && let Some(frame) = frames.next()
        {
            send(mailbox, &frame);
        }
    }
}

/// Gives up what the last slow frame left: nobody took it, or the bus had no time for it. One that is on the wires is still sent.
fn give_up() {
    let empty = CAN1.tsr().read().0 >> EMPTY_SHIFT;
    let mut stale = Tsr(0);
    for mailbox in 0..MAILBOXES {
        stale.set_abrq(mailbox, empty & 1 << mailbox == 0);
    }
    if stale != Tsr(0) {
        CAN1.tsr().write_value(stale);
    }
}

fn send(mailbox: usize, frame: &Frame) {
    let [a, b, c, d, e, f, g, h] = frame.bytes;
    let place = CAN1.tx(mailbox);
    place.tdtr().write(|w| w.set_dlc(8));
    place.tdlr().write(|w| w.0 = u32::from_le_bytes([a, b, c, d]));
    place.tdhr().write(|w| w.0 = u32::from_le_bytes([e, f, g, h]));
    // Last: from here on it is the port's.
    place.tir().write(|w| {
        w.set_ide(Ide::EXTENDED);
        w.0 |= frame.identifier << 3;
        w.set_txrq(true);
    });
}

/// What the palm's bus does besides: nobody asks anything here.
pub fn before_tick(_fingertip: &mut Fingertip) {}

/// As above.
pub fn said(_posted: &Received<Up>, _frame: &[u8]) {}

/// As above.
pub fn frame_ended(_at_us: u32) {}

/// As above.
pub fn begin() {}
