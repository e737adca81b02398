//! Every interrupt of the image: who handles it, and its priority, which nobody else sets. A lower number is more urgent.

use embassy_stm32::interrupt::{self, Interrupt, InterruptExt, Priority};

/// The supply sags: `supply::PVD`.
const FAILURE: Priority = Priority::P0;
/// `halves::OnHalf`, `deadline::OnDeadline`. Late, a lost frame stays unnoticed.
const SCAN: Priority = Priority::P1;
/// [`control`](crate::control)'s executor: I2C3 itself is not used. Late, the switches step late and ticks run late.
const CONTROL: Priority = Priority::P2;
/// embassy's handlers of [`serial`](crate::serial). At or above control they would delay it.
const LINE: Priority = Priority::P6;
const _: () =
    assert!((FAILURE as u8) < SCAN as u8 && (SCAN as u8) < CONTROL as u8 && (CONTROL as u8) < LINE as u8);

const PRIORITIES: [(Interrupt, Priority); 7] = [
    (interrupt::PVD, FAILURE),
    (interrupt::DMA2_STREAM0, SCAN),
    (interrupt::TIM2, SCAN),
    (interrupt::I2C3_ER, CONTROL),
    (interrupt::USART2, LINE),
    (interrupt::DMA1_STREAM5, LINE),
    (interrupt::DMA1_STREAM6, LINE),
];

/// After embassy's `init`, which switches those of DMA on and gives them one.
pub fn set_priorities() {
    for (interrupt, priority) in PRIORITIES {
        interrupt.set_priority(priority);
    }
}
