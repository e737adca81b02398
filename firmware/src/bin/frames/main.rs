//! What every detector takes of the emulated core: as `tenax-kernels`, with frames in place of readings.
//!
//! An image of its own: what two kernels share is compiled once, and would change what the array's take there. It is never flashed.
#![no_std]
#![no_main]

mod frames;
#[path = "../kernels/mailbox.rs"]
mod mailbox;
mod rivals;

use core::hint::black_box;
use core::panic::PanicInfo;

use cortex_m_rt::entry;
// Brings the interrupt vectors that the linker's script asks for.
use embassy_stm32 as _;
use tenax_logic::array::{ArrayVerdict, Reading, ShippedDetector, shipped};

use self::frames::Frames;
use self::mailbox::Orders;

type Detector = ShippedDetector;

#[entry]
fn main() -> ! {
    // The compiler is not to know the weights: it would write them into the code.
    let model = black_box(&shipped::MODEL);
    let mut detector = Detector::new(model);
    let mut frames = Frames::default();
    loop {
        mailbox::tenax_kernels_next();
        if let Some(frame) = frames::comes() {
            frames.run(&frame);
            continue;
        }
        // It has no other kernels for readings, so both orders begin anew.
        let Orders { forget, everything } = mailbox::orders();
        if forget || everything {
            detector = Detector::new(model);
        }
        let verdict = tenax_kernel_slow_frame(&mut detector, &mailbox::reading());
        mailbox::answer(&detector, verdict);
    }
}

/// All that the array costs in a slow frame.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_slow_frame(detector: &mut Detector, reading: &Reading) -> ArrayVerdict {
    detector.push(reading)
}

#[panic_handler]
fn on_panic(_: &PanicInfo) -> ! {
    // The host notices that nobody comes for the next reading.
    loop {
        cortex_m::asm::nop();
    }
}
