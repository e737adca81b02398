//! Control after too many restarts in a row ([`restart`](crate::restart)): a press of the button opens the hand,
//! since converter, DMA or telemetry may be what failed.

use tenax_hal_shim::channel::{FRAME_HZ, frames};
use tenax_hal_shim::motor::{Duty, MotorDrive};

use crate::arming::STEP_FRAMES;
use crate::button::{Button, Press};

pub const STEP_US: u32 = STEP_FRAMES * 1_000_000 / FRAME_HZ;
const OPENS_STEPS: u32 = frames(4_000) / STEP_FRAMES;
const SLOWLY: Duty = Duty::per_mille(300);

#[derive(Clone, Copy, Debug, Default)]
pub struct Rescue {
    button: Button,
    opens: u32,
}

impl Rescue {
    /// Drive until the next step. Held for 1 to 3 s and let go, the button opens; pressed again, it stops.
    pub fn step(&mut self, is_down: bool) -> MotorDrive {
        self.opens = self.opens.saturating_sub(1);
        match self.button.tick(is_down, false, self.opens > 0) {
            Some(Press::Release) => self.opens = OPENS_STEPS,
            Some(Press::Stop | Press::Calibrate) => self.opens = 0,
            None => {}
        }
        if self.opens > 0 { MotorDrive::Open(SLOWLY) } else { MotorDrive::Coast }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn opens(presses_ms: &[u32]) -> [u32; 2] {
        let mut rescue = Rescue::default();
        let (mut opened, mut other) = (0, 0);
        for (n, ms) in presses_ms.iter().enumerate() {
            for _ in 0..frames(*ms) / STEP_FRAMES {
                match rescue.step(n % 2 == 1) {
                    MotorDrive::Coast => {}
                    MotorDrive::Open(SLOWLY) => opened += 1,
                    _ => other += 1,
                }
            }
        }
        [opened, other]
    }

    // Shows B2.
    #[test]
    fn a_press_of_1_to_3_s_opens_slowly_for_4_s_and_another_stops_it() {
        assert_eq!(opens(&[100, 1_100, 10_000]), [OPENS_STEPS, 0]);
        let [stopped, other] = opens(&[100, 1_100, 500, 100, 10_000]);
        assert!(
            (frames(400) / STEP_FRAMES..frames(600) / STEP_FRAMES).contains(&stopped) && other == 0,
            "{stopped}"
        );
        assert_eq!(SLOWLY.as_per_mille(), Config::default().gate.slowest_permille);
    }

    // Shows B2.
    #[test]
    fn a_button_that_is_tapped_stuck_or_down_at_the_start_opens_nothing() {
        for presses_ms in
            [&[100, 500, 5_000][..], &[100, 60_000], &[100, 3_100, 5_000], &[0, 1_100, 5_000], &[60_000]]
        {
            assert_eq!(opens(presses_ms), [0, 0], "{presses_ms:?}");
        }
    }
}
