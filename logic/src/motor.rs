//! Limits of the motor. A stopped motor is not driven, and the gear holds the object. The bridge's mirror shows the winding's current,
//! driven and short-circuited (DRV8874, section 7.3.3): of a blocked motor, duty times the stall current.
//!
//! | judged once a slow frame | from | stops |
//! |---|---|---|
//! | stall: half of a blocked motor's current or more, and the fingers stand still | current and opening, or the one that is left | the way it was driven |
//! | heat: the square of the current | current, or else the duty | closing |
//!
//! A stalled direction is driven again after 0.15 s without a request for it, after one for the other direction, or for a drive stronger by
//! an eighth. Heat never stops an opening: a hand that cannot let go is worse than a hot motor.

pub mod settings;

use core::mem::take;

use tenax_hal_shim::channel::{
    CHANNELS, FRAMES_PER_SLOW_FRAME, MOTOR_CURRENT, OPENING, REFERENCE_MV, SAMPLE_MAX, SLOW_HZ,
    sample_from_mv,
};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{MotorStop, Reason};

use self::settings::MotorConfig;
use crate::arming::STEP_FRAMES;
use crate::health::{Change, Limits, SensorHealth};
use crate::journal::{Journal, report};

const STEPS: u32 = FRAMES_PER_SLOW_FRAME as u32 / STEP_FRAMES;
/// Slow frames of stall after which the motor stops: 0.3 s.
const STALL_CYCLES: u8 = 24;
const LEAST_PERMILLE: u32 = 50;
const STRONGER_PERMILLE: u16 = 125;
/// Least change of the opening's reading of moving fingers: 8 mV, a third of a millimetre.
const MOVED: u16 = sample_from_mv(8);
/// The winding's time constant is `2^HEAT_SHIFT` slow frames: 6.4 s (small brushed motors: 5 to 15 s).
const HEAT_SHIFT: u32 = 9;
/// Slow frames without a drive after which no current flows: 0.2 s, with the motor's dead time.
const IDLE_CYCLES: u8 = 16;
const ODD_CYCLES: u8 = 16;
const MA_Q14: u32 =
    (((REFERENCE_MV as u64 * 1_000) << 14) / (SAMPLE_MAX as u64 * MOTOR_MV_PER_A as u64)) as u32;

static LIMITS: Limits = Limits::of(&CHANNELS[MOTOR_CURRENT], SLOW_HZ);
const _: () = assert!(CHANNELS[MOTOR_CURRENT].low_mv == CHANNELS[OPENING].low_mv);
const _: () = assert!(CHANNELS[MOTOR_CURRENT].high_mv == CHANNELS[OPENING].high_mv);
const REST: u16 = sample_from_mv(CHANNELS[MOTOR_CURRENT].rest_mv);

#[derive(Clone, Debug, Default)]
struct Sensor {
    health: SensorHealth,
    sample: Option<u16>,
}

impl Sensor {
    fn reading(&mut self, channel: usize, journal: &mut Journal) -> Option<u16> {
        let (reading, change) = self.health.take(&LIMITS, self.sample?);
        report(journal, channel, change);
        reading.ok()
    }
}

#[derive(Clone, Debug, Default)]
pub struct Motor {
    current: Sensor,
    opening: Sensor,
    stood: u16,
    /// Sum of the duty over the looks of this slow frame; the largest since the stall began.
    duty_sum: u16,
    duty_most: u16,
    asked: bool,
    opens: bool,
    stall: u8,
    stalled: bool,
    /// mA^2 times `2^HEAT_SHIFT` in the steady state.
    heat: u32,
    hot: bool,
    /// Least duty that may close and open, per mille.
    least: [u16; 2],
    is_barred: bool,
    told: Option<MotorStop>,
    bridge_is_off: bool,
    idle: u8,
    odd: u8,
    contradicts: bool,
}

impl Motor {
    /// 14-bit reading of current or opening, None if its frame was lost, for [`judge`](Self::judge).
    pub const fn take(&mut self, channel: usize, sample: Option<u16>) {
        let sensor = if channel == OPENING { &mut self.opening } else { &mut self.current };
        sensor.sample = sample;
    }

    pub const fn bridge(&mut self, is_off: bool) {
        self.bridge_is_off = is_off;
    }

    #[inline]
    pub const fn allows(&self, drive: MotorDrive) -> bool {
        !self.is_barred || self.is_allowed(drive)
    }

    #[inline(never)]
    const fn is_allowed(&self, drive: MotorDrive) -> bool {
        match drive {
            MotorDrive::Coast => true,
            MotorDrive::Close(duty) => duty.as_per_mille() >= self.least[0],
            MotorDrive::Open(duty) => duty.as_per_mille() >= self.least[1],
        }
    }

    /// `drive`: part of `asked` that the limits allowed. A request for the other direction ends a stall. Call it
    /// every [`STEP_FRAMES`] frames.
    pub const fn step(&mut self, asked: MotorDrive, drive: MotorDrive) {
        let opens = match asked {
            MotorDrive::Coast => return,
            MotorDrive::Close(_) => false,
            MotorDrive::Open(_) => true,
        };
        if self.opens != opens {
            self.opens = opens;
            self.free();
        }
        self.asked = true;
        if let MotorDrive::Close(duty) | MotorDrive::Open(duty) = drive {
            let duty = duty.as_per_mille();
            self.duty_sum = self.duty_sum.saturating_add(duty);
            if self.duty_most < duty {
                self.duty_most = duty;
            }
        }
    }

    /// Call it once a slow frame, always in the same slot.
    #[inline(never)]
    pub fn judge(&mut self, config: &MotorConfig, journal: &mut Journal) {
        let duty = u32::from(take(&mut self.duty_sum)) / STEPS;
        let asked = take(&mut self.asked);
        self.idle = if duty > 0 { 0 } else { self.idle.saturating_add(1) };
        let stall_ma = u32::from(config.stall_ma);
        let ma = self.current_ma(stall_ma, journal);
        let moved = self.moved(journal);
        self.warm(u32::from(config.limit_ma), stall_ma, ma, moved, duty);

        let blocked_ma = stall_ma * duty / 1_000;
        let draws = match ma {
            Some(ma) => 2 * ma >= blocked_ma,
            None => moved.is_some(),
        };
        if self.stalled && duty > 0 {
            // Only a stronger drive than the stalled one is allowed.
            self.free();
        }
        if duty >= LEAST_PERMILLE && draws && moved != Some(true) {
            self.stall = self.stall.saturating_add(1);
        } else if duty > 0 && moved == Some(true) {
            self.free();
        } else if duty > 0 || !asked {
            self.stall = self.stall.saturating_sub(1);
        }
        if self.stall >= STALL_CYCLES {
            (self.stall, self.stalled) = (STALL_CYCLES, true);
        } else if self.stall <= STALL_CYCLES / 2 {
            self.stalled = false;
        }
        if self.stall == 0 {
            self.duty_most = 0;
        }
        self.close_ways();
        self.tell(journal);
    }

    const fn free(&mut self) {
        (self.stall, self.stalled, self.duty_most) = (0, false, 0);
        self.close_ways();
    }

    const fn close_ways(&mut self) {
        let stalled = if self.stalled { self.duty_most.saturating_add(STRONGER_PERMILLE) } else { 0 };
        self.least = match self.opens {
            true => [0, stalled],
            false => [stalled, 0],
        };
        if self.hot {
            self.least[0] = u16::MAX;
        }
        self.is_barred = self.hot || self.stalled;
    }

    fn tell(&mut self, journal: &mut Journal) {
        let stop = match (self.stalled, self.opens) {
            (true, false) => Some(MotorStop::ClosingStalled),
            (true, true) => Some(MotorStop::OpeningStalled),
            (false, _) if self.hot => Some(MotorStop::Hot),
            // The bridge protects itself: driving on does no harm, and shows when it is back.
            (false, _) => self.bridge_is_off.then_some(MotorStop::BridgeOff),
        };
        if self.told != stop {
            self.told = stop;
            journal.event(EventKind::Motor(stop));
        }
    }

    fn current_ma(&mut self, stall_ma: u32, journal: &mut Journal) -> Option<u32> {
        let reading = self.current.reading(MOTOR_CURRENT, journal)?;
        let ma = (u32::from(reading.saturating_sub(REST)) * MA_Q14) >> 14;
        if self.idle >= IDLE_CYCLES {
            self.odd = if 8 * ma > stall_ma {
                self.odd.saturating_add(1).min(ODD_CYCLES)
            } else {
                self.odd.saturating_sub(1)
            };
            if !self.contradicts && self.odd == ODD_CYCLES {
                // The heat that it has shown was wrong as well.
                (self.contradicts, self.heat) = (true, self.heat / 16);
                report(journal, MOTOR_CURRENT, Some(Change::Lost(Reason::Creep)));
            } else if self.contradicts && self.odd == 0 {
                self.contradicts = false;
                report(journal, MOTOR_CURRENT, Some(Change::Back));
            }
        }
        (!self.contradicts).then_some(ma)
    }

    fn moved(&mut self, journal: &mut Journal) -> Option<bool> {
        let opening = self.opening.reading(OPENING, journal)?;
        let moved = opening.abs_diff(self.stood) > MOVED;
        if moved {
            self.stood = opening;
        }
        Some(moved)
    }

    /// Heat of a slow frame. An unknown current counts as that of a blocked motor, or half of it while it moves.
    fn warm(&mut self, limit_ma: u32, stall_ma: u32, ma: Option<u32>, moved: Option<bool>, duty: u32) {
        let blocked_ma = stall_ma * duty / 1_000;
        let warms = match (ma, moved) {
            (Some(_), _) if self.idle >= IDLE_CYCLES => 0,
            (Some(ma), _) => ma * ma,
            (None, Some(true)) => blocked_ma * blocked_ma / 4,
            (None, _) => blocked_ma * blocked_ma,
        };
        // At most 1.5e6 times 2^9.
        self.heat = self.heat - (self.heat >> HEAT_SHIFT) + warms;
        let limit = (limit_ma * limit_ma) << HEAT_SHIFT;
        self.hot = self.heat > limit || (self.hot && self.heat > limit / 2);
    }
}

#[cfg(test)]
mod tests;
