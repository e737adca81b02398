//! Proof that neither control nor its interrupts' handlers can panic: the image's own sources of both, linked with a panic handler that
//! calls an undefined function. The linker fails if a panic is in reach. The serial line's handlers are embassy's, and not in it: they
//! panic where DMA cannot reach memory, which resets the chip. Built, never flashed:
//!
//! ```sh
//! cargo build --profile firmware --target thumbv7em-none-eabihf -p tenax-firmware --bin control-never-panics
//! ```
#![no_std]
#![no_main]
#![allow(dead_code, reason = "the main program's part of these modules is not in it")]

#[path = "../black_box.rs"]
mod black_box;
#[path = "../board.rs"]
mod board;
#[path = "../bridge.rs"]
mod bridge;
#[path = "../clock.rs"]
mod clock;
#[path = "../control.rs"]
mod control;
#[path = "../counts.rs"]
mod counts;
#[path = "../deadline.rs"]
mod deadline;
#[path = "../halves.rs"]
mod halves;
#[path = "../last_words.rs"]
mod last_words;
#[path = "../mail.rs"]
mod mail;
#[path = "../scan.rs"]
mod scan;
#[path = "../supply.rs"]
mod supply;
#[path = "../timing.rs"]
mod timing;

use core::hint::black_box;

use cortex_m_rt::entry;
use embassy_executor::InterruptExecutor;
use embassy_stm32::{bind_interrupts, interrupt};
use panic_never as _;

bind_interrupts!(struct Irqs {
    DMA2_STREAM0 => halves::OnHalf;
    TIM2 => deadline::OnDeadline;
});

static CONTROL_EXECUTOR: InterruptExecutor = InterruptExecutor::new();

#[interrupt]
unsafe fn I2C3_ER() {
    // SAFETY: this is that interrupt.
    unsafe { black_box(&CONTROL_EXECUTOR).on_interrupt() }
}

/// Control's task as the executor gets it. It is not spawned: that may panic, and is no part of control.
#[entry]
fn main() -> ! {
    let parts: Option<(scan::Scan, &'static mut control::Control)> = black_box(None);
    if let Some((scan, control)) = parts {
        core::mem::forget(black_box(control::control(scan, control)));
    }
    loop {
        cortex_m::asm::wfi();
    }
}
