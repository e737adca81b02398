//! The whole fingertip: a frame goes in, a motor drive comes out.
//!
//! In each tick the senses take the frame, the machine of figure 9 asks them its questions in the paper's order (first
//! the wearer, then S1, then S2), and the arbiter says who drives the motor.

use core::ops::RangeInclusive;

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::wire::{
    DRIVE_HOLD_MAX_MS, Down, Event, EventKind, NetworkState, Refusal, Setting, Slow, TickRecord,
};
use tenax_hal_shim::words::{Cause, Fault, GripMode, Kept};

use crate::arbiter::{Wishes, arbitrate};
use crate::config::{Config, frames};
use crate::friction::FrictionDetector;
use crate::grip::{Grip, Reflex};
use crate::hebbian::Situation;
use crate::journal::Journal;
use crate::mode;
use crate::senses::Senses;
use crate::store::keeper::{Keeper, Now};
use crate::store::payload;
use crate::store::record::Record;
use crate::touch::{Felt, Touch};

/// A stroke that nobody ends is over after this long, in frames: a lost link must not leave the reflex silent.
const STROKE_FRAMES_MAX: u32 = frames(60_000);

/// A drive command that holds for some frames more.
#[derive(Clone, Copy, Debug)]
struct LinkDrive {
    drive: MotorDrive,
    frames_left: u32,
}

/// The detectors' verdict of one tick.
#[derive(Clone, Copy, Debug, Default)]
struct Verdict {
    s1: bool,
    network: bool,
    array: bool,
    incipient: bool,
}

/// The fingertip's memory between ticks.
#[derive(Clone, Debug, Default)]
pub struct Fingertip {
    config: Config,
    /// Changes of the settings, so that nobody has to compare them all.
    settings_changed: u32,
    senses: Senses,
    friction: FrictionDetector,
    touch: Touch,
    s2: bool,
    mode: GripMode,
    reflex: Reflex,
    link: Option<LinkDrive>,
    journal: Journal,
    slow: Option<Slow>,
    save_asked: bool,
    drive: MotorDrive,
}

impl Fingertip {
    /// A fingertip with these thresholds and limits.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self { config, ..Self::default() }
    }

    /// Takes up what was kept through a power cut, before the first tick. What it cannot use it reports; the defaults
    /// stay.
    #[inline(never)]
    pub fn restore(&mut self, kept: Kept, payload: &[u8]) {
        let restored = match kept {
            Kept::Network => self.touch.restore(payload).is_ok(),
            Kept::Zero => {
                let zero_uv = payload::zero(payload);
                zero_uv.map(|zero_uv| self.senses.force_sensor_mut().restore_zero(zero_uv)).is_some()
            }
            Kept::Settings => payload::restore_settings(&mut self.config, payload),
        };
        if !restored {
            self.report(Fault::RecordDamaged(kept));
        }
    }

    /// One who sees to it that changes are saved, from what there is now.
    #[must_use]
    pub fn keeper(&self) -> Keeper {
        Keeper::new(&self.now())
    }

    /// What has to be kept and is not yet, one thing at a time; ask now and then. Who asks sees to it that it is saved: it
    /// is given once.
    #[inline(never)]
    pub fn next_record(&mut self, keeper: &mut Keeper) -> Option<Record> {
        let now = self.now();
        Some(match keeper.next(&now)? {
            Kept::Network => {
                self.save_asked = false;
                Record::Network(self.touch.learned())
            }
            Kept::Zero => Record::Zero(now.zero),
            Kept::Settings => Record::Settings(payload::of_settings(&self.config)),
        })
    }

    /// What there is to keep.
    fn now(&self) -> Now {
        Now {
            settings_changed: self.settings_changed,
            zero: payload::of_zero(self.senses.force_sensor().zero_uv()),
            updates: self.touch.updates(),
            at_rest: self.is_at_rest(),
            asked: self.save_asked,
        }
    }

    /// Tells of something that went wrong outside.
    pub fn report(&mut self, fault: Fault) {
        self.journal.fault(fault);
    }

    /// Takes one frame, decides, and says how to drive the motor until the next.
    ///
    /// Frames come one by one, lost ones included ([`Frame::lost`]): time is counted by them.
    pub fn tick(&mut self, frame: &Frame) -> MotorDrive {
        self.sense(frame);
        let verdict = Verdict {
            s1: self.senses.vibration.s1,
            network: self.touch.slips(),
            array: self.senses.array_slips(),
            incipient: self.s2,
        };
        self.act(frame, verdict)
    }

    /// The oracle's tick: the same fingertip, told by somebody who knows whether the object slips.
    pub fn tick_told(&mut self, frame: &Frame, slips: bool) -> MotorDrive {
        self.sense(frame);
        self.act(frame, Verdict { s1: slips, ..Verdict::default() })
    }

    /// Carries out a command.
    ///
    /// # Errors
    /// Says why it was not carried out; then nothing has changed.
    pub fn command(&mut self, command: &Down) -> Result<(), Refusal> {
        match *command {
            Down::Ping | Down::Samples | Down::Network | Down::Get(_) | Down::Settings(_) => Ok(()),
            Down::Drive { hold_ms, .. } if hold_ms > DRIVE_HOLD_MAX_MS => {
                Err(Refusal::OutOfRange { min: 0, max: DRIVE_HOLD_MAX_MS.into() })
            }
            Down::Drive { drive: MotorDrive::Close(_), .. } if self.senses.gate.is_active() => {
                Err(Refusal::WearerActive)
            }
            Down::Drive { drive, hold_ms } => {
                let frames_left = u32::from(hold_ms) * FRAME_HZ / 1_000;
                self.link = Some(LinkDrive { drive, frames_left });
                Ok(())
            }
            Down::Set(Setting { id, value }) => {
                let id = SettingId::from_number(id).ok_or(Refusal::UnknownSetting)?;
                self.set(id, value)
            }
            Down::Stroke(true) => self.begin_stroke(),
            Down::Stroke(false) => {
                self.end_stroke();
                Ok(())
            }
            Down::Teach { codes, age_ms } => {
                self.touch.hear(&self.config.touch, codes, age_ms);
                Ok(())
            }
            Down::Forget => {
                self.touch.forget();
                // What is forgotten does not come back with the power.
                self.save_asked = true;
                Ok(())
            }
            Down::Save => {
                self.save_asked = true;
                Ok(())
            }
            Down::Zero if self.senses.forces.is_none() => Err(Refusal::SensorLost),
            Down::Zero => {
                if self.senses.zero() {
                    Ok(())
                } else {
                    Err(Refusal::Loaded)
                }
            }
        }
    }

    fn set(&mut self, id: SettingId, value: i32) -> Result<(), Refusal> {
        let out_of_range = |range: RangeInclusive<i32>| {
            let (min, max) = range.into_inner();
            Refusal::OutOfRange { min, max }
        };
        self.config.set(id, value).map_err(out_of_range)?;
        self.settings_changed = self.settings_changed.wrapping_add(1);
        Ok(())
    }

    /// Every number that can be chosen, as it is in force.
    #[must_use]
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// The slow frame that the last tick ended, if it ended one.
    pub fn take_slow(&mut self) -> Option<Slow> {
        self.slow.take()
    }

    /// The oldest thing that happened and has not been taken yet.
    pub fn next_event(&mut self) -> Option<Event> {
        self.journal.next_event()
    }

    /// Sequence number of the last frame taken.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.journal.frame()
    }

    /// What the reflex is doing.
    #[must_use]
    pub const fn mode(&self) -> GripMode {
        self.mode
    }

    /// Whether a myosensor is active, its hold time included.
    #[must_use]
    pub const fn wearer_active(&self) -> bool {
        self.senses.gate.is_active()
    }

    /// What the network knows and feels.
    #[must_use]
    pub fn network(&self) -> NetworkState {
        self.touch.state(self.journal.frame())
    }

    /// Nobody moves the hand and nobody teaches.
    fn is_at_rest(&self) -> bool {
        let listening = matches!(self.mode, GripMode::Standby | GripMode::Watch);
        listening && !self.senses.gate.is_active() && self.link.is_none() && self.touch.lesson().is_err()
    }

    fn sense(&mut self, frame: &Frame) {
        self.journal.begin(frame);
        if frame.valid {
            self.senses.take(&self.config, frame, &mut self.journal);
            self.feel(frame);
        } else {
            self.senses.lose(&self.config, frame, &mut self.journal);
            self.touch.lose();
        }
        if self.senses.forces.is_none() {
            self.s2 = self.friction.process(&self.config.friction, None);
        } else if self.senses.forces_are_new {
            let ratio = self.senses.forces.and_then(|forces| forces.ratio_permille);
            self.s2 = self.friction.process(&self.config.friction, ratio);
        }
    }

    fn feel(&mut self, frame: &Frame) {
        let knock = self.senses.vibration.knock;
        let moves = mode::closes(self.mode) || self.mode == GripMode::Settle || self.senses.gate.is_active();
        let duty = match self.drive {
            MotorDrive::Close(duty) | MotorDrive::Open(duty) => duty.as_per_mille(),
            MotorDrive::Coast => 0,
        };
        let felt = Felt {
            envelopes: self.senses.envelopes(),
            loads: &self.senses.gauges().loads(),
            gauge: usize::from(frame.place()),
            loud: knock || duty >= self.config.touch.loud_duty_permille,
            unloaded: self.senses.is_unloaded(&self.config),
            situation: Situation {
                grasp: matches!(self.senses.grip(&self.config), Grip::Holds(_)),
                disturbed: knock || moves || !self.senses.hears(),
            },
        };
        self.touch.tick(&self.config.touch, &felt);
    }

    fn act(&mut self, frame: &Frame, verdict: Verdict) -> MotorDrive {
        self.link = self.link.and_then(|link| {
            let frames_left = link.frames_left.checked_sub(1)?;
            Some(LinkDrive { frames_left, ..link })
        });
        self.step_mode(verdict);
        let wishes = Wishes {
            wearer_active: self.senses.gate.is_active(),
            wearer: self.senses.gate.wish(&self.config.gate),
            link: self.link.map(|link| link.drive),
            reflex: Reflex::drive(&self.config.grip, self.mode),
        };
        // A lost frame says nothing about anybody's wish, so nobody's is carried out.
        let (drive, source) = if frame.valid { arbitrate(wishes) } else { Default::default() };
        self.drive = drive;
        self.reflex.tick(self.mode, self.senses.grip(&self.config));
        let listens = mode::listens(self.mode);
        self.journal.tick(
            frame.place(),
            TickRecord {
                vibration: self.senses.vibration.level,
                s1: listens && self.senses.vibration.s1,
                outputs: self.touch.outputs(),
                slips: self.touch.slips(),
                drive,
                source,
            },
        );
        if frame.ends_slow_frame() {
            self.slow = Some(self.end_slow_frame(frame));
        }
        drive
    }

    /// The flow chart, asked from the top in every tick.
    fn step_mode(&mut self, verdict: Verdict) {
        let grip = self.senses.grip(&self.config);
        let config = self.config.grip;
        let taken_over = self.senses.gate.is_active() || self.link.is_some();
        self.cause(if self.senses.ready(&self.config) { Cause::SensorsReady } else { Cause::SensorsLost });
        self.cause(if taken_over { Cause::TakenOver } else { Cause::Released });
        let may_close = self.reflex.may_close(&config, grip);
        let slips = verdict.s1 || verdict.network || verdict.array;
        if verdict.s1 && may_close {
            self.cause(Cause::S1);
        }
        if verdict.network && may_close {
            self.cause(Cause::Network);
        }
        if verdict.array && may_close {
            self.cause(Cause::Array);
        }
        if verdict.incipient && may_close {
            self.cause(Cause::S2);
        }
        if mode::closes(self.mode) && self.reflex.pulse_over(&config, self.mode, slips, grip) {
            self.cause(Cause::PulseOver);
        }
        if self.mode == GripMode::Settle && self.reflex.settled(&config) {
            self.cause(Cause::Settled);
        }
        if self.mode == GripMode::Explore && self.reflex.elapsed() >= STROKE_FRAMES_MAX {
            self.cause(Cause::StrokeOver);
        }
    }

    /// Lets a cause do what the table says, if it says anything.
    fn cause(&mut self, cause: Cause) {
        let Some(to) = mode::next(self.mode, cause) else {
            return;
        };
        let from = core::mem::replace(&mut self.mode, to);
        self.reflex.enter(to);
        self.journal.mode(from, to, cause);
        if from == GripMode::Explore {
            self.measured();
        }
    }

    fn begin_stroke(&mut self) -> Result<(), Refusal> {
        if self.senses.gate.is_active() {
            return Err(Refusal::WearerActive);
        }
        if self.senses.forces.is_none() {
            return Err(Refusal::SensorLost);
        }
        self.cause(Cause::StrokeBegun);
        if self.mode != GripMode::Explore {
            return Err(Refusal::SensorLost);
        }
        self.friction.begin_stroke();
        Ok(())
    }

    fn end_stroke(&mut self) {
        self.cause(Cause::StrokeOver);
    }

    /// A stroke is over, by command or because somebody took over: what it measured becomes S2, if that is allowed.
    fn measured(&mut self) {
        let Some(measured) = self.friction.end_stroke(&self.config.friction) else {
            return;
        };
        if self.set(SettingId::S2, measured.s2_permille.into()).is_ok() {
            self.journal.event(EventKind::Stroke {
                mu_s_permille: measured.mu_s_permille,
                s2_permille: measured.s2_permille,
            });
        }
    }

    fn end_slow_frame(&mut self, frame: &Frame) -> Slow {
        let (ticks, samples_sum) = self.journal.take_slow();
        Slow {
            frame: frame.sequence,
            ticks,
            mode: self.mode,
            forces: self.senses.forces,
            s2: mode::listens(self.mode) && self.s2,
            s2_permille: self.config.friction.s2_permille,
            flexor_mv: self.senses.gate.flexor.mv(),
            extensor_mv: self.senses.gate.extensor.mv(),
            wearer_active: self.senses.gate.is_active(),
            lesson: self.touch.lesson().ok(),
            array: self.senses.array(),
            samples_sum,
        }
    }
}
