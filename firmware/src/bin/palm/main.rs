//! The palm's image, for a board of its own: it polls its fingertips over the bus, shares the force, and passes their lines to a PC.
//!
//! What it says is decided in `tenax-palm`; here bytes are moved. One loop does it, and sleeps until a frame ends on the bus or the palm is
//! due. The interrupt of the bus lets go of the wires at the end of a frame, for an answer may begin while the loop is at something else.
//! It drives no motor. If it stops, its fingertips go on alone, and the watchdog resets it.
//!
//! | what | where |
//! |---|---|
//! | bus | USART1, PA15 and PA10; its driver PA12, as on a fingertip |
//! | line to the PC | USART2, PA2 and PA3, the ST-LINK's |
//! | the fingers of this hand | the first word of the store on (`memory.x`) |
#![no_std]
#![no_main]

#[allow(dead_code, unused_imports, reason = "a palm has no converter")]
#[path = "../../chip.rs"]
mod chip;
#[path = "../../clock.rs"]
mod clock;
#[path = "../../flash.rs"]
mod flash;
mod handed;
#[path = "../../micros.rs"]
mod micros;
#[path = "../../port.rs"]
mod port;
mod ring;
#[path = "../../watchdog.rs"]
mod watchdog;

use core::panic::PanicInfo;
use core::ptr::{addr_of, addr_of_mut};
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, entry, exception};
use embassy_stm32::interrupt::InterruptExt;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::{DMA1, GPIOA, RCC, TIM2, USART2};
use embassy_stm32::{Peripherals, interrupt};
use static_cell::StaticCell;
use tenax_palm::bus::{self, FRAME_MAX};
use tenax_palm::line::{self, Answer, FRAME_UP_MAX, Lines};
use tenax_palm::palm::Palm;
use tenax_palm::places::{self, Places};

use self::flash::Flash;
use self::micros::clock_us;
use self::port::{BUS, Port};
use self::ring::Ring;
use self::watchdog::Watchdog;

/// USART2, of the PC's line.
const LINE: Port = Port { usart: USART2, dma: DMA1, rx: 5, tx: 6 };
/// The transceiver's pin that lets it drive the wires, of port A.
const DRIVER: usize = 12;
/// Bytes that are read at once where their frame has not ended: fewer are not worth the way.
const AT_ONCE: usize = 16;

/// A frame is on its way.
static SENDING: AtomicBool = AtomicBool::new(false);
/// What is being sent. DMA reads it.
static mut FRAME: [u8; FRAME_MAX] = [0; FRAME_MAX];
static mut FRAME_UP: [u8; FRAME_UP_MAX] = [0; FRAME_UP_MAX];
static PALM: StaticCell<Palm> = StaticCell::new();
static LINES: StaticCell<Lines> = StaticCell::new();

/// With what something is done: see the places below. The emulated board reads them by this name.
#[unsafe(no_mangle)]
static TENAX_PALM_DOES: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];
/// The instant, us; how far the ring of the bus is read, and that of the line; the instant of the start, us.
const AT: usize = 0;
const BUS_END: usize = 1;
const LINE_END: usize = 2;
const BEGAN: usize = 3;

#[entry]
fn main() -> ! {
    let crystal = clock::has_crystal(true);
    clock::start(crystal);
    GPIOA.bsrr().write(|w| w.set_br(DRIVER, true));
    GPIOA.moder().modify(|w| w.set_moder(DRIVER, Moder::OUTPUT));
    if crystal {
        clock::watch_crystal();
    }
    clock::accelerate_flash();
    micros::start();
    RCC.apb1enr().modify(|w| w.set_usart2en(true));
    RCC.apb2enr().modify(|w| w.set_usart1en(true));
    let mut bus = Ring::of_bus(BUS, (clock::CORE_HZ / bus::BAUD) as u16, [15, 10]);
    let mut pc = Ring::of_line(LINE, (clock::APB1_HZ / line::BAUD) as u16, [2, 3]);
    // SAFETY: nobody else takes them.
    let p = unsafe { Peripherals::steal() };
    let mut flash = Flash::new(p.FLASH);
    let lines = LINES.init_with(Lines::default);
    // Before the watchdog, which does not wait for an erase.
    if let Some(kept) = handed::take() {
        let is_kept = places::save(&mut flash, &kept).is_ok();
        lines.answer(if is_kept { Answer::Hand } else { Answer::Refused });
    }
    let began_us = clock_us();
    does(BEGAN, began_us);
    let palm = PALM.init_with(|| Palm::new(&places::load(&flash).unwrap_or_default(), began_us));
    let mut watchdog = Watchdog::new(p.IWDG);
    watchdog.start();

    // SAFETY: what their handlers use is set up above.
    unsafe {
        interrupt::USART1.enable();
        interrupt::TIM2.enable();
    }
    TIM2.dier().write(|w| w.set_ccie(0, true));
    let (mut is_telling, mut is_told) = (false, false);
    loop {
        watchdog.feed();
        let (now_us, end) = (clock_us(), bus.end());
        let due = !SENDING.load(Relaxed) && palm.is_due(now_us);
        if bus.is_whole(end) || bus.waits(end) >= if due { 1 } else { AT_ONCE } {
            does(AT, now_us);
            does(BUS_END, end as u32);
            tenax_palm_hear(palm, lines, &mut bus, end, now_us);
        } else if due {
            does(AT, now_us);
            // SAFETY: DMA is done with it.
            let length = tenax_palm_step(palm, now_us, unsafe { &mut *addr_of_mut!(FRAME) });
            if length > 0 {
                BUS.prepare(addr_of!(FRAME).cast(), length);
                SENDING.store(true, Relaxed);
                is_told = false;
                GPIOA.bsrr().write(|w| w.set_bs(DRIVER, true));
                BUS.begin();
            }
        } else if is_told || !SENDING.load(Relaxed) {
            sleep(palm.due_us());
        } else if pc.waits(pc.end()) > 0 {
            let end = pc.end();
            does(LINE_END, end as u32);
            if let Some(places) = tenax_palm_take(palm, lines, &mut pc, end) {
                handed::give(&places);
                give_up();
            }
        } else {
            // This and the one before take longer than an answer may wait: their time is while a poll is on its way.
            is_told = true;
            if !is_telling || LINE.usart.sr().read().tc() {
                LINE.end();
                // SAFETY: DMA is done with it.
                let length = lines.next(palm, unsafe { &mut *addr_of_mut!(FRAME_UP) });
                is_telling = length > 0;
                if is_telling {
                    LINE.prepare(addr_of!(FRAME_UP).cast(), length);
                    LINE.begin();
                }
            }
        }
    }
}

/// Until something happens on the bus, or this instant.
fn sleep(until_us: u32) {
    TIM2.ccr(0).write_value(until_us);
    // An interrupt before this is remembered: it does not sleep then.
    if until_us.wrapping_sub(clock_us()).cast_signed() > 0 {
        cortex_m::asm::wfe();
    }
}

fn does(place: usize, word: u32) {
    if let Some(own) = TENAX_PALM_DOES.get(place) {
        own.store(word, Relaxed);
    }
}

/// What the loop sleeps until.
#[interrupt]
unsafe fn TIM2() {
    embassy_stm32::pac::TIM2.sr().write(|w| w.0 = 0);
}

/// A pause, which the loop is woken by, or the last bit of a frame is out.
#[interrupt]
unsafe fn USART1() {
    let seen = BUS.usart.sr().read();
    if seen.idle() {
        // With the status before, this clears the flag. DMA has had the byte.
        let _last = BUS.usart.dr().read();
    }
    if seen.tc() && BUS.usart.cr1().read().tcie() {
        GPIOA.bsrr().write(|w| w.set_br(DRIVER, true));
        BUS.end();
        SENDING.store(false, Relaxed);
    }
}

/// Not inlined, as the next two, so that the emulated board can tell by these names what was done when.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_palm_hear(palm: &mut Palm, lines: &mut Lines, bus: &mut Ring, end: usize, now_us: u32) {
    while let Some(byte) = bus.next(end) {
        if let Some(finger) = palm.hear(byte, now_us) {
            lines.answered(palm, finger);
        }
    }
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_palm_step(palm: &mut Palm, now_us: u32, out: &mut [u8; FRAME_MAX]) -> usize {
    palm.step(now_us, out)
}

/// Some if this hand is to have other fingers from now on.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_palm_take(palm: &mut Palm, lines: &mut Lines, line: &mut Ring, end: usize) -> Option<Places> {
    let mut places = None;
    while let Some(byte) = line.next(end) {
        places = lines.hear(byte, palm).or(places);
    }
    places
}

/// Leaves the wires to the others, and begins anew.
fn give_up() -> ! {
    cortex_m::interrupt::disable();
    GPIOA.bsrr().write(|w| w.set_br(DRIVER, true));
    SCB::sys_reset()
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    give_up()
}

/// A fault of the core.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    give_up()
}

/// The crystal has stopped.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    give_up()
}
