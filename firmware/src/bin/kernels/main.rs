//! The array detector's arithmetic on the emulated core, without the rest of the fingertip.
//!
//! The host puts a reading into the [`mailbox`] whenever the core arrives at `tenax_kernels_next`, and finds there what the
//! core made of the one before. Each kernel is a function that is called from one place, so its instructions can be
//! counted from its entry to where it returns. This image drives nothing and is never flashed.
#![no_std]
#![no_main]

mod mailbox;
mod parts;
mod stand;

use core::hint::black_box;

use cortex_m_rt::entry;
// Brings the interrupt vectors that the linker's script asks for.
use embassy_stm32 as _;
use tenax_logic::array::{ShippedDetector, shipped};

use self::parts::Parts;

type Detector = ShippedDetector;

#[entry]
fn main() -> ! {
    // The compiler is not to know the weights: it would write them into the code.
    let model = black_box(&shipped::MODEL);
    let mut detector = Detector::new(model);
    let mut parts = Parts::default();
    loop {
        stand::tenax_kernels_next();
        let orders = mailbox::orders();
        let reading = mailbox::reading();
        if orders.forget {
            detector = Detector::new(model);
        }
        let verdict = mailbox::tenax_kernel_slow_frame(&mut detector, &reading);
        mailbox::answer(&detector, verdict);
        if orders.everything {
            parts.run(&reading, detector.features());
        }
    }
}
