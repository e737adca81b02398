//! What every detector takes of the emulated core: as `tenax-kernels`, with frames in place of readings.
//!
//! An image of its own: what two kernels share is compiled once, and would change what the array's take there. It is never flashed.
#![no_std]
#![no_main]

mod frames;
#[path = "../kernels/mailbox.rs"]
mod mailbox;
mod rivals;
#[path = "../kernels/stand.rs"]
mod stand;

use core::hint::black_box;

use cortex_m_rt::entry;
// Brings the interrupt vectors that the linker's script asks for.
use embassy_stm32 as _;
use tenax_logic::array::{ShippedDetector, shipped};

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
        stand::tenax_kernels_next();
        if let Some(frame) = frames::comes() {
            frames.run(&frame);
            continue;
        }
        // It has no other kernels for readings, so both orders begin anew.
        let Orders { forget, everything } = mailbox::orders();
        if forget || everything {
            detector = Detector::new(model);
        }
        let verdict = mailbox::tenax_kernel_slow_frame(&mut detector, &mailbox::reading());
        mailbox::answer(&detector, verdict);
    }
}
