//! The select lines of the two analogue switches.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::pac;
use embassy_stm32::peripherals::{PB12, PB13, PB14, PB15};

/// The first select line's pin: S0 to S3 are PB12 to PB15.
const FIRST_PIN: usize = 12;

pub struct Switches {
    _lines: [Output<'static>; 4],
}

impl Switches {
    /// Takes the pins; the lines show 0.
    pub fn new(
        s0: Peri<'static, PB12>,
        s1: Peri<'static, PB13>,
        s2: Peri<'static, PB14>,
        s3: Peri<'static, PB15>,
    ) -> Self {
        // Slow edges: they must not be heard on the films, and the switches have most of 87 us to settle.
        Self {
            _lines: [
                Output::new(s0, Level::Low, Speed::Low),
                Output::new(s1, Level::Low, Speed::Low),
                Output::new(s2, Level::Low, Speed::Low),
                Output::new(s3, Level::Low, Speed::Low),
            ],
        }
    }

    /// Shows `select`, 0 to 15. All four lines step together: no other input is passed through on the way.
    pub fn show(&mut self, select: u8) {
        pac::GPIOB.bsrr().write(|w| {
            for line in 0..4 {
                let pin = FIRST_PIN + line;
                if select >> line & 1 == 1 {
                    w.set_bs(pin, true);
                } else {
                    w.set_br(pin, true);
                }
            }
        });
    }
}
