//! Feedback to the wearer: bursts of a vibration motor on the socket.
//!
//! | told | pattern | duty |
//! |---|---|---|
//! | the force reaches 1 N, and each doubling up to 32 N | one burst | rises from burst to burst |
//! | the reflex answers slip, at most twice a second | one burst | full |
//! | a sensor or a sense is lost, the motor is hot or its bridge off; at most each 3 s | two bursts | full |
//!
//! Bursts at events, not a hum that goes on: the DESC-finger tells contact so (doi 10.1109/ICORR.2017.8009402). Lengths, steps and
//! duties are a choice; nobody has worn it.
//!
//! The films may hear the motor. So it runs only where no detector moves the hand: while somebody does (`Wearer`), while the reflex
//! answers slip and lets the object settle, and on standby. A burst ends early enough before the reflex listens again to ring down, and the
//! second of two slips within 0.5 s is not told: a burst that is taken for slip ends there. Nothing is masked for it.

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::words::GripMode;

/// A bit for each slow frame of 12.5 ms, the lowest first: 62.5 ms.
const BURST: u16 = 0b1_1111;
/// Two bursts with a pause of the same length.
const TWO_BURSTS: u16 = BURST | BURST << 10;
/// Slow frames between two slips that are told, and between two warnings.
const SLIPS_APART: u8 = SLOW_HZ as u8 / 2;
const WARNINGS_APART: u8 = 3 * SLOW_HZ as u8;
/// The last step of force, of 32 N and more.
const STEPS: u8 = 6;
/// A part of the full duty, in twentieths.
const WHOLE: u8 = 20;
const STEP_0: u8 = 14;

/// Input of the feedback in a slow frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Felt {
    /// Mode of the reflex.
    pub mode: GripMode,
    /// Load on the finger, mN. None: it holds nothing, or the force is unknown.
    pub load_mn: Option<i32>,
    /// The finger is known to touch nothing.
    pub unloaded: bool,
    /// A sensor, an ability or the motor was lost since the last slow frame.
    pub lost: bool,
}

/// State of the patterns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Feedback {
    /// The rest of the present pattern, its part of the full duty, and whether it reports slip.
    pattern: u16,
    part: u8,
    tells_slip: bool,
    /// The force step that was signalled last, or that the force had while no signal was possible.
    step: u8,
    /// A warning waits to be signalled.
    warns: bool,
    /// Slow frames until slip and warning may be told again.
    slip_in: u8,
    warning_in: u8,
}

impl Feedback {
    /// The reflex begins to answer slip.
    pub const fn slips(&mut self) {
        if self.slip_in == 0 {
            (self.pattern, self.part, self.tells_slip) = (BURST, WHOLE, true);
            self.slip_in = SLIPS_APART;
        }
    }

    /// Takes a slow frame and gives the vibration motor's duty until the next. `choice`: 0 off, 1 discreet, 2 strong.
    pub fn step(&mut self, choice: u16, felt: &Felt) -> Duty {
        self.slip_in = self.slip_in.saturating_sub(1);
        self.warning_in = self.warning_in.saturating_sub(1);
        self.warns |= felt.lost;
        // Per mille.
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
        // A load that trembles about a step is told once.
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
        self.pattern >>= 1;
        Duty::per_mille(on * twentieth * u16::from(self.part))
    }
}

/// Doublings of 1 N: 1 from there on, 2 from 2 N on.
fn step_of(load_mn: Option<i32>) -> u8 {
    let newtons = load_mn.unwrap_or_default().max(0).unsigned_abs() / 1_000;
    ((u32::BITS - newtons.leading_zeros()) as u8).min(STEPS)
}
