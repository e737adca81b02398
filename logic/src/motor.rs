//! Limits of the motor: it is stopped by stall and by heat. A stopped motor is not driven, and the gear holds the object.
//!
//! The bridge's mirror shows the current only while the bridge drives, so the filtered pin reads duty times the winding's current
//! (DRV8874, section 7.3.3; docs/hardware.md). Of a blocked motor that is duty squared times the stall current.
//!
//! | judged once a slow frame | from | stops |
//! |---|---|---|
//! | stall: half of a blocked motor's current or more, and the fingers stand still | current and opening, or the one that is left | the way it was driven |
//! | heat: the current shown times the stall current, which is the winding's squared if it is blocked and more if it turns | current, or else the duty | closing |
//!
//! A stalled direction is driven again after 0.15 s without a request for it, after a request for the other direction, or for a drive that
//! is stronger by an eighth. So an opening always wins: at once after a stalled closing, and after its own stall by a new request.
//! Heat never stops an opening: a hand that cannot let go is worse than a hot motor, and a stall ends each try.

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

/// Number of looks at the drive in a slow frame.
const STEPS: u32 = FRAMES_PER_SLOW_FRAME as u32 / STEP_FRAMES;
/// Slow frames of stall after which the motor stops: 0.3 s, so that 0.5 s are kept with the filter at the pin and the motor's dead time.
const STALL_CYCLES: u8 = 24;
/// Mean duty below which the motor does not move, per mille.
const LEAST_PERMILLE: u32 = 50;
/// A stalled motor is driven again if the duty is larger by this, per mille.
const STRONGER_PERMILLE: u16 = 125;
/// Fingers that move change the opening's reading by more than this: 8 mV, a third of a millimetre.
const MOVED: u16 = sample_from_mv(8);
/// The winding's time constant is `2^HEAT_SHIFT` slow frames: 6.4 s (small brushed motors: 5 to 15 s).
const HEAT_SHIFT: u32 = 9;
/// Slow frames without a drive after which no current flows: 0.2 s, with the motor's dead time.
const IDLE_CYCLES: u8 = 16;
/// Further such slow frames in which a current means a fault of sensor or bridge.
const ODD_CYCLES: u8 = 16;
/// Milliamperes of a sample, 14 fraction bits.
const MA_Q14: u32 =
    (((REFERENCE_MV as u64 * 1_000) << 14) / (SAMPLE_MAX as u64 * MOTOR_MV_PER_A as u64)) as u32;

static LIMITS: Limits = Limits::of(&CHANNELS[MOTOR_CURRENT], SLOW_HZ);
const _: () = assert!(CHANNELS[MOTOR_CURRENT].low_mv == CHANNELS[OPENING].low_mv);
const _: () = assert!(CHANNELS[MOTOR_CURRENT].high_mv == CHANNELS[OPENING].high_mv);
const REST: u16 = sample_from_mv(CHANNELS[MOTOR_CURRENT].rest_mv);

/// One of the hand's own sensors.
#[derive(Clone, Debug, Default)]
struct Sensor {
    health: SensorHealth,
    /// Sample of this slow frame; None if its frame was lost.
    sample: Option<u16>,
}

impl Sensor {
    /// The reading of this cycle, None where there is none.
    fn reading(&mut self, channel: usize, journal: &mut Journal) -> Option<u16> {
        let (reading, change) = self.health.take(&LIMITS, self.sample?);
        report(journal, channel, change);
        reading.ok()
    }
}

/// Current, opening, stall and heat of the motor.
#[derive(Clone, Debug, Default)]
pub struct Motor {
    current: Sensor,
    opening: Sensor,
    /// The opening's reading when the fingers were last seen to move.
    stood: u16,
    /// Sum of the duty over the [`STEPS`] looks of this slow frame; the largest since the stall began.
    duty_sum: u16,
    duty_most: u16,
    /// A drive was asked for in this slow frame.
    asked: bool,
    /// The drive that was asked for last opens.
    opens: bool,
    /// Slow frames of stall, less those without.
    stall: u8,
    stalled: bool,
    /// mA squared times `2^HEAT_SHIFT` when it flows for ever.
    heat: u32,
    hot: bool,
    /// The least duty that may close and open, per mille.
    least: [u16; 2],
    /// Any of it is not 0: nearly never.
    is_barred: bool,
    told: Option<MotorStop>,
    /// The bridge says that it has switched itself off.
    bridge_is_off: bool,
    /// Slow frames without a drive, and those of them with current.
    idle: u8,
    odd: u8,
    /// The sensor shows a current that cannot be.
    contradicts: bool,
}

impl Motor {
    /// Takes a 14-bit reading of the motor's current or of the opening, None if its frame was lost. [`judge`](Self::judge) uses it later:
    /// the array has work in the same slots.
    pub const fn take(&mut self, channel: usize, sample: Option<u16>) {
        let sensor = if channel == OPENING { &mut self.opening } else { &mut self.current };
        sensor.sample = sample;
    }

    /// Sets whether the bridge reports that it has switched itself off, until the next call.
    pub const fn bridge(&mut self, is_off: bool) {
        self.bridge_is_off = is_off;
    }

    /// Whether the limits allow this drive.
    #[must_use]
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

    /// Records the last frame's drives for [`judge`](Self::judge): `asked` was requested, `drive` is what the limits
    /// allowed of it. A request for the other direction than the last ends a stall. Call it every [`STEP_FRAMES`]
    /// frames.
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

    /// Judges stall and heat, and reports changes. Call it once a slow frame, always in the same slot.
    #[inline(never)]
    pub fn judge(&mut self, config: &MotorConfig, journal: &mut Journal) {
        let duty = u32::from(take(&mut self.duty_sum)) / STEPS;
        let asked = take(&mut self.asked);
        self.idle = if duty > 0 { 0 } else { self.idle.saturating_add(1) };
        let stall_ma = u32::from(config.stall_ma);
        let ma = self.current_ma(stall_ma, journal);
        let moved = self.moved(journal);
        self.warm(u32::from(config.limit_ma), stall_ma, ma, moved, duty);

        // Of a blocked motor the winding has this much, and the pin shows a part of it that is the duty.
        let blocked_ma = stall_ma * duty / 1_000;
        let draws = match ma {
            Some(ma) => 2_000 * ma >= blocked_ma * duty,
            None => moved.is_some(),
        };
        if self.stalled && duty > 0 {
            // What it stalled at is not allowed: this is a stronger drive.
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

    /// Ends the stall: another drive is asked for, or the fingers move.
    const fn free(&mut self) {
        (self.stall, self.stalled, self.duty_most) = (0, false, 0);
        self.close_ways();
    }

    /// Updates which drives are allowed.
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
            // It protects itself: to be driven on does no harm, and shows when it is back.
            (false, _) => self.bridge_is_off.then_some(MotorStop::BridgeOff),
        };
        if self.told != stop {
            self.told = stop;
            journal.event(EventKind::Motor(stop));
        }
    }

    /// The current that the pin shows, mA. None where the sensor gives no number, or one that cannot be.
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
                // Whatever it has said of the heat was wrong as well.
                (self.contradicts, self.heat) = (true, self.heat / 16);
                report(journal, MOTOR_CURRENT, Some(Change::Lost(Reason::Creep)));
            } else if self.contradicts && self.odd == 0 {
                self.contradicts = false;
                report(journal, MOTOR_CURRENT, Some(Change::Back));
            }
        }
        (!self.contradicts).then_some(ma)
    }

    /// Whether the fingers have moved since the last cycle. None while the opening gives no number.
    fn moved(&mut self, journal: &mut Journal) -> Option<bool> {
        let opening = self.opening.reading(OPENING, journal)?;
        let moved = opening.abs_diff(self.stood) > MOVED;
        if moved {
            self.stood = opening;
        }
        Some(moved)
    }

    /// Heats the winding for a slow frame. If the current is unknown, that of a blocked motor is taken, or half of it while the
    /// fingers move. A motor that is not driven cools, whatever current the sensor shows.
    fn warm(&mut self, limit_ma: u32, stall_ma: u32, ma: Option<u32>, moved: Option<bool>, duty: u32) {
        let blocked_ma = stall_ma * duty / 1_000;
        let warms = match (ma, moved) {
            (Some(_), _) if self.idle >= IDLE_CYCLES => 0,
            (Some(ma), _) => ma * stall_ma,
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
