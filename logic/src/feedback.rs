//! Feedback to the wearer: bursts of a vibration motor on the socket, at events.
//!
//! | event | pattern | duty |
//! |---|---|---|
//! | the force reaches 1 N, and each doubling up to 32 N | one burst | rises from burst to burst |
//! | the reflex answers slip, at most twice a second | one burst | full |
//! | a sensor or a sense is lost, the motor is hot or its bridge off; at most each 3 s | two bursts | full |
//!
//! The films may pick up the motor, so it runs only where no detector moves the hand: while the wearer does,
//! while the reflex answers slip and settles, and on standby.

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::words::GripMode;

/// A bit for each slow frame of 12.5 ms, the lowest first: 62.5 ms.
const BURST: u16 = 0b1_1111;
const TWO_BURSTS: u16 = BURST | BURST << 10;
/// Least distance of two slips or warnings that are signalled, slow frames.
const SLIPS_APART: u8 = SLOW_HZ as u8 / 2;
const WARNINGS_APART: u8 = 3 * SLOW_HZ as u8;
/// As long as a vibration motor takes to stop, 150 ms.
const RINGS: u8 = (3 * SLOW_HZ / 20) as u8;
/// Highest step of force: 32 N and more.
const STEPS: u8 = 6;
const WHOLE: u8 = 20;
const STEP_0: u8 = 14;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Felt {
    pub mode: GripMode,
    /// mN; None: it holds nothing, or the force is unknown.
    pub load_mn: Option<i32>,
    pub unloaded: bool,
    pub lost: bool,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Feedback {
    pattern: u16,
    part: u8,
    tells_slip: bool,
    step: u8,
    warns: bool,
    slip_in: u8,
    warning_in: u8,
    /// Slow frames for which the films may still hear it.
    rings: u8,
}

impl Feedback {
    pub const fn slips(&mut self) {
        if self.slip_in == 0 {
            (self.pattern, self.part, self.tells_slip) = (BURST, WHOLE, true);
            self.slip_in = SLIPS_APART;
        }
    }

    /// What the films hear may be the vibration motor.
    pub const fn rings(&self) -> bool {
        self.rings > 0
    }

    /// Duty of the vibration motor until the next slow frame. `choice`: 0 off, 1 discreet, 2 strong.
    pub fn step(&mut self, choice: u16, felt: &Felt) -> Duty {
        self.slip_in = self.slip_in.saturating_sub(1);
        self.warning_in = self.warning_in.saturating_sub(1);
        self.warns |= felt.lost;
        let twentieth = match choice {
            0 => {
                *self = Self::default();
                return Duty::default();
            }
            1 => 38,
            _ => 50,
        };
        let step = step_of(felt.load_mn);
        let rose = step > self.step;
        // Hysteresis: a load that trembles about a step is one step.
        if rose || step_of(felt.load_mn.map(|mn| mn.saturating_add(mn / 4))) < self.step {
            self.step = step;
        }
        // An empty finger's films would hear it as slip of nothing, and their detector would be ignored as implausible.
        let moved = felt.mode == GripMode::Wearer && !felt.unloaded;
        let answers = matches!(felt.mode, GripMode::Slip | GripMode::Settle);
        if moved && rose {
            (self.pattern, self.part, self.tells_slip) = (BURST, STEP_0 + step, false);
        } else if self.pattern == 0
            && self.warns
            && self.warning_in == 0
            && (moved || felt.mode == GripMode::Standby)
        {
            (self.pattern, self.part, self.tells_slip) = (TWO_BURSTS, WHOLE, false);
            (self.warns, self.warning_in) = (false, WARNINGS_APART);
        }
        if !(moved || felt.mode == GripMode::Standby || answers && self.tells_slip) {
            self.pattern = 0;
        }
        let on = self.pattern & 1;
        self.rings = if on == 1 { RINGS } else { self.rings.saturating_sub(1) };
        self.pattern >>= 1;
        Duty::per_mille(on * twentieth * u16::from(self.part))
    }
}

fn step_of(load_mn: Option<i32>) -> u8 {
    let newtons = load_mn.unwrap_or_default().max(0).unsigned_abs() / 1_000;
    ((u32::BITS - newtons.leading_zeros()) as u8).min(STEPS)
}
