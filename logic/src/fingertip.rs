//! The whole fingertip: a frame in, a motor drive out. In each tick the senses take the frame, the state
//! machine asks the wearer, then the detectors (Prosthesis, figure 9), and the arbiter chooses the source
//! that drives the motor.

mod behave;
mod commands;
mod consent;
mod link;
mod told;
mod verdicts;

use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{EventKind, Forces, Slow, TickRecord};
use tenax_hal_shim::words::{CalibrationRefusal, Cause, DriveSource, Fault, GripMode, Kept, Line};

use self::behave::Eye;
use self::commands::Staged;
use self::link::Link;
use self::verdicts::Verdicts;
use crate::arbiter::{Wishes, arbitrate};
use crate::arming::{Arming, STEP_FRAMES};
use crate::behaviours::Running;
use crate::button::Button;
use crate::config::Config;
use crate::detectors::{Detectors, Said, WEIGHED};
use crate::feedback::Feedback;
use crate::force::shear_mrad;
use crate::grip::relax::Reading;
use crate::grip::{Grip, Reflex};
use crate::journal::Journal;
use crate::mode;
use crate::samples::LastSamples;
use crate::senses::Senses;
use crate::store::keeper::{Keeper, Now};
use crate::store::payload;
use crate::store::record::Record;

/// Slot, modulo the step, in which consent is checked: the array's heaviest share is in another.
const CONSENT_SLOT: u32 = 0;
/// Slot, after the forces', in which the missing force is computed; `think` has no time left for it.
const FEEL_SLOT: u8 = 20;
const _: () = assert!(FEEL_SLOT > slot_of(Job::Forces) && FEEL_SLOT as u32 % STEP_FRAMES == CONSENT_SLOT);

/// Slot in which the motor's limits are judged: neither the array nor the forces have work in it.
const MOTOR_SLOT: u8 = 5;
const _: () =
    assert!(MOTOR_SLOT as u32 % STEP_FRAMES == CONSENT_SLOT && MOTOR_SLOT < slot_of(Job::ArrayBegins));

#[derive(Clone, Debug, Default)]
pub struct Fingertip {
    config: Config,
    settings_changed: u32,
    staged: Option<Staged>,
    calibrated: u32,
    senses: Senses,
    detectors: Detectors,
    /// Detectors that the reflex does not act on, beside those of `detectors-off-mask`.
    muted: DetectorSet,
    mode: GripMode,
    reflex: Reflex,
    behaviour: Option<Running>,
    eye: Eye,
    link: Link,
    arming: Arming,
    button_is_down: bool,
    button: Button,
    line: Line,
    told_no_wearer: bool,
    journal: Journal,
    feedback: Feedback,
    slow: Option<Slow>,
    save_asked: bool,
    asked: MotorDrive,
    drive: MotorDrive,
    /// The reflex has released force since the drive was last read.
    took_back: bool,
}

impl Fingertip {
    pub fn new(config: Config) -> Self {
        Self { config, ..Self::default() }
    }

    pub fn trusting() -> Self {
        Self::new(Config { line_trusted: true, ..Config::default() })
    }

    /// Call it before the first tick. A record that cannot be used is reported as a fault, and the defaults
    /// stay.
    #[inline(never)]
    pub fn restore(&mut self, kept: Kept, payload: &[u8]) {
        let restored = match kept {
            Kept::Network => self.detectors.hebbian.restore(payload),
            Kept::Zero => {
                let zero_uv = payload::zero(payload);
                zero_uv.map(|zero_uv| self.senses.force_sensor_mut().restore_zero(zero_uv)).is_some()
            }
            Kept::Settings => payload::restore_settings(&mut self.config, payload),
            Kept::Emg => {
                let model = payload::emg(payload);
                model.map(|model| self.senses.muscles_mut().calibrate(model)).is_some()
            }
        };
        if !restored {
            self.report(Fault::RecordDamaged(kept));
        }
    }

    pub fn keeper(&self) -> Keeper {
        Keeper::new(&self.now())
    }

    /// Each record is given once: call it regularly and save the result.
    #[inline(never)]
    pub fn next_record(&mut self, keeper: &mut Keeper) -> Option<Record> {
        let now = self.now();
        Some(match keeper.next(&now)? {
            Kept::Network => {
                self.save_asked = false;
                Record::Network(self.detectors.hebbian.learned())
            }
            Kept::Zero => Record::Zero(now.zero),
            Kept::Settings => Record::Settings(payload::of_settings(&self.config)),
            Kept::Emg => Record::Emg(self.senses.muscles().model().map(payload::of_emg)?),
        })
    }

    fn now(&self) -> Now {
        Now {
            settings_changed: self.settings_changed,
            calibrated: self.calibrated,
            zero: payload::of_zero(self.senses.force_sensor().zero_uv()),
            updates: self.detectors.hebbian.updates(),
            at_rest: self.is_at_rest(),
            asked: self.save_asked,
        }
    }

    pub fn report(&mut self, fault: Fault) {
        self.journal.fault(fault);
    }

    /// Drive of the motor until the next frame, 0.5 ms later. Every frame must be passed, lost ones too
    /// ([`Frame::lost`]), since time is counted in frames.
    pub fn tick(&mut self, frame: &Frame) -> MotorDrive {
        self.sense(frame);
        self.act(frame)
    }

    /// Work of a slow frame that takes too long for a tick. Call it always after the same tick.
    pub fn think(&mut self, samples: &LastSamples) {
        self.senses.think(&self.config, samples, &mut self.journal);
        if self.senses.muscles_mut().think(&mut self.journal) {
            self.calibrated = self.calibrated.wrapping_add(1);
        }
    }

    /// Likewise, of the films.
    pub fn listen(&mut self) {
        self.senses.listen(&self.config, &mut self.journal);
    }

    fn feel(&mut self) {
        let held = self.senses.forces.filter(|_| matches!(self.senses.grip, Grip::Holds(_)));
        let s2 = &self.detectors.s2;
        let lacks = held.map(|forces| s2.lacks(&self.config.friction, &forces)).unwrap_or_default();
        self.reflex.feel(self.mode, held.as_ref(), lacks);
        let slid_permille = self.reflex.slid_permille();
        let reading = held.map(|Forces { load_mn, ft_mn, .. }| Reading { load_mn, ft_mn, slid_permille });
        self.reflex.relax(self.mode, reading.filter(|_| self.may_relax()).as_ref());
    }

    fn may_relax(&self) -> bool {
        self.config.grip.may_relax(self.config.no_wearer)
            && self.senses.all_ready(&self.config)
            && self.senses.force_sensor().doubted() == 0
            && !self.senses.gate.is_active()
            && self.link.drive().is_none()
            && self.behaviour.is_none()
    }

    pub const fn inject(&mut self, said: Said) {
        self.detectors.injected.inject(said);
    }

    pub const fn act_on(&mut self, detectors: DetectorSet) {
        self.muted = DetectorSet::ALL.without(detectors);
    }

    fn is_at_rest(&self) -> bool {
        let listening = matches!(self.mode, GripMode::Standby | GripMode::Watch);
        listening
            && !self.senses.gate.is_active()
            && self.link.drive().is_none()
            && self.behaviour.is_none()
            && self.detectors.hebbian.lesson().is_err()
    }

    fn sense(&mut self, frame: &Frame) {
        self.journal.begin(frame);
        if frame.valid {
            self.senses.process(&self.config, frame, &mut self.journal);
        } else {
            self.senses.lose(&self.config, frame, &mut self.journal);
        }
        let moves = mode::closes(self.mode) || self.mode == GripMode::Settle;
        if frame.slot() == WEIGHED {
            let sound = self.senses.sound().filter(|_| !self.feedback.rings());
            self.detectors.weigh(sound, !self.reflex.is_still(), moves);
        }
        let sensed = self.senses.sensed(&self.config, frame, self.drive.permille(), moves);
        self.detectors.step(&self.config, &sensed);
    }

    fn act(&mut self, frame: &Frame) -> MotorDrive {
        self.link.tick(self.behaviour.as_ref().is_some_and(Running::answers_slip));
        if u32::from(frame.slot()) % STEP_FRAMES == CONSENT_SLOT {
            self.consent();
            if self.senses.muscles().is_calibrating() && !self.senses.unloaded {
                // The muscles must be able to open a hand that holds something or may hold something.
                self.senses.muscles_mut().give_up(CalibrationRefusal::Loaded, &mut self.journal);
            }
            if frame.slot() == FEEL_SLOT {
                self.feel();
            }
            // A hand that stalls while opening is at its stop, so the request counts.
            let did = if self.asked.opens() { self.asked } else { self.drive };
            self.senses.driven(did, core::mem::take(&mut self.took_back), self.mode, STEP_FRAMES);
            self.senses.motor.step(self.asked, self.drive);
            if frame.slot() == MOTOR_SLOT {
                self.senses.motor.judge(&self.config.motor, &mut self.journal);
            }
        }
        let verdicts = Verdicts::of(&self.detectors, self.muted.or(self.config.detectors_off));
        self.reflex.hear(!verdicts.said.is_empty(), verdicts.heard(self.senses.vibration.s1));
        if !verdicts.slip.is_empty() {
            self.reflex.sure_permille = self.detectors.sure_permille();
        }
        let behaviour = match self.behave(verdicts) {
            MotorDrive::Coast
                if self.reflex.is_relaxing() && self.mode == GripMode::Watch && self.may_relax() =>
            {
                self.reflex.relaxes()
            }
            wish => wish,
        };
        let grip = self.senses.grip;
        self.reflex.bind(!self.config.no_wearer && !self.senses.gate.is_known());
        self.step_mode(verdicts, grip);
        let wishes = Wishes {
            wearer_active: self.senses.gate.is_active(),
            wearer: self.senses.gate.wish(&self.config.gate, &self.reflex.account),
            link: self.link_drive(),
            reflex: self.reflex.drive(&self.config.grip, self.mode),
            behaviour,
        };
        // A lost frame shows no wish, so none is carried out.
        let (asked, source) = if frame.valid { arbitrate(wishes) } else { Default::default() };
        self.asked = asked;
        // Without a behaviour its place belongs to the reflex, which releases force.
        let source = match source {
            DriveSource::Behaviour if self.behaviour.is_none() => DriveSource::Reflex,
            source => source,
        };
        let allowed = self.senses.motor.allows(asked);
        let (drive, source) = if allowed { (asked, source) } else { Default::default() };
        self.drive = drive;
        let driven = source == DriveSource::Wearer;
        let refused = self.reflex.account.step(&self.senses.gate, wishes.wearer, driven);
        self.senses.muscles_mut().refuse(refused);
        let is_loud = drive.permille() >= self.config.hebbian.loud_duty_permille;
        if self.reflex.tick(self.mode, grip, is_loud) && verdicts.slip.contains(DetectorId::S1) {
            self.senses.refute();
        }
        self.took_back |= source == DriveSource::Reflex && drive.opens();
        if let MotorDrive::Close(duty) = drive {
            self.reflex.closes(duty, source == DriveSource::Reflex);
        }
        if matches!(source, DriveSource::Link | DriveSource::Behaviour) && drive.closes() {
            self.reflex.spend(grip);
        }
        self.journal.tick(
            frame.slot(),
            TickRecord {
                vibration: self.senses.vibration.level,
                outputs: self.detectors.hebbian.outputs(),
                said: verdicts.said,
                believed: verdicts.believed,
                acted: match (self.mode, source) {
                    (GripMode::Slip, DriveSource::Reflex) => verdicts.slip,
                    (GripMode::Incipient, DriveSource::Reflex) => verdicts.incipient,
                    _ => DetectorSet::NONE,
                },
                drive,
                source,
            },
        );
        if frame.ends_slow_frame() {
            self.slow = Some(self.end_slow_frame(frame));
        }
        drive
    }

    /// Flow chart of Prosthesis, figure 9, from its top.
    fn step_mode(&mut self, verdicts: Verdicts, grip: Grip) {
        let config = self.config.grip;
        let answered = self.behaviour.as_ref().is_some_and(Running::answers_slip);
        let before = self.mode;
        let taken_over = self.senses.gate.is_active() || self.link_silences() || answered;
        self.cause(if self.senses.ready(&self.config) { Cause::SensorsReady } else { Cause::SensorsLost });
        self.cause(if taken_over { Cause::TakenOver } else { Cause::Released });
        let slips = !verdicts.slip.is_empty();
        if !verdicts.believed.is_empty() && self.reflex.may_close(&config, grip) {
            if let Some(id) = verdicts.slip.first()
                && self.reflex.may_answer(grip)
            {
                self.cause(Cause::Slip(id));
            }
            if let Some(id) = verdicts.incipient.first()
                && self.reflex.may_tighten(&config, grip)
            {
                self.cause(Cause::Incipient(id));
            }
        }
        if mode::closes(self.mode) && self.reflex.pulse_over(&config, self.mode, slips, grip) {
            self.cause(Cause::PulseOver);
        }
        if self.mode == GripMode::Settle && self.reflex.settled(&config) {
            self.cause(Cause::Settled);
        }
        if self.mode != before && mode::closes(self.mode) {
            self.explain(verdicts);
        }
    }

    #[inline(never)]
    fn explain(&mut self, Verdicts { said, believed, .. }: Verdicts) {
        let s2_permille = self.detectors.s2.s2_permille(&self.config.friction);
        let margin_mn = self.senses.forces.and_then(|forces| forces.margin_mn(s2_permille));
        self.journal.event(EventKind::Pulse { margin_mn, said, believed });
    }

    #[inline]
    fn cause(&mut self, cause: Cause) {
        if let Some(to) = mode::next(self.mode, cause) {
            self.change(to, cause);
        }
    }

    #[inline(never)]
    fn change(&mut self, to: GripMode, cause: Cause) {
        let from = core::mem::replace(&mut self.mode, to);
        let held = self.senses.forces.as_ref().filter(|_| matches!(self.senses.grip, Grip::Holds(_)));
        self.reflex.enter(to, self.senses.grip, held.zip(self.detectors.s2.carried()));
        if to == GripMode::Slip {
            self.feedback.slips();
        }
        self.journal.mode(from, to, cause);
    }

    #[inline(never)]
    fn measured(&mut self) {
        let Some(measured) = self.detectors.s2.end_stroke(&self.config.friction) else {
            return;
        };
        if self.config.measured(measured.s2_permille.into()) {
            self.settings_changed = self.settings_changed.wrapping_add(1);
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
            shear_mrad: shear_mrad(self.senses.forces.as_ref()),
            s2_permille: self.detectors.s2.s2_permille(&self.config.friction),
            flexor_mv: self.senses.gate.flexor_mv(),
            extensor_mv: self.senses.gate.extensor_mv(),
            wearer_active: self.senses.gate.is_active(),
            lesson: self.detectors.hebbian.lesson().ok(),
            evidence: self.detectors.evidence(&self.config),
            samples_sum,
            line: self.line,
            behaviour: self.behaviour(),
        }
    }
}
