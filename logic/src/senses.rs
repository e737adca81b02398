//! Conditions a frame: which sensors are valid, and the quantities that they measure.

mod force;
mod select_lines;

use tenax_hal_shim::channel::{
    ARRAY, CHANNELS, COUNT, FRAMES_PER_SLOW_FRAME, FSR, FSR_COUNT, HEAD, MYO_EXTENSOR, MYO_FLEXOR, OPENING,
    PVDF, PVDF_COUNT, Role, SAMPLE_MAX, SLOW_HZ, STRAIN, frames,
};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::front_end::FSR_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::SCHEDULE;
use tenax_hal_shim::wire::Forces;
use tenax_hal_shim::words::{Capability, Fault, GripMode, Reason};

use self::select_lines::SelectLines;
use crate::array::Reading;
use crate::array::taxels::Taxels;
use crate::config::Config;
use crate::detectors::Sensed;
use crate::evidence::Sound;
use crate::force::ForceSensor;
use crate::gate::Gate;
use crate::grip::Grip;
use crate::health::{Change, Limits, SensorHealth};
use crate::journal::{Journal, report};
use crate::motor::Motor;
use crate::muscles::Muscles;
use crate::photoelastic::Head;
use crate::photoelastic::track::Hints;
use crate::samples::LastSamples;
use crate::strain::Gauges;
use crate::vibration::quality::PvdfQuality;
use crate::vibration::sliding::Hand;
use crate::vibration::{Trust, Vibration, VibrationDetector};

const WARM_UP_FRAMES: u32 = frames(200);
const STALE_FRAMES: u32 = FRAMES_PER_SLOW_FRAME as u32;
/// Readings that a quadrant may miss: a tick that is always late never reaches [`STALE_FRAMES`].
const QUADRANT_MISSES: u8 = 2;
/// Time after a closing in which the force still rises: the dead time and a reading.
const CLOSES_FRAMES: u32 = frames(60);
/// Time from the first touch in which nothing lifts the object yet.
const TOUCH_FRAMES: u32 = frames(150);
/// Silence from which a closing hand holds what does not slide.
const SILENT_FRAMES: u32 = frames(500);
/// Envelope below which nothing slides, samples (14 bits): a quarter of S1.
const SILENT_LEVEL: u16 = 80;
/// Opening since the last closing after which the hand is surely open: at its slowest it has moved 2 cm.
const OPEN_FRAMES: u32 = frames(600);
/// Slow frames in which a surely open hand reads a load before that is reported: 4 s.
const DOUBTED_AFTER: u16 = 4 * SLOW_HZ as u16;
/// Part of `loaded-mn` below which the finger is unloaded, whatever its quadrants share it by.
const UNLOADED_PART: i32 = 4;
static FSR_LIMITS: Limits = Limits::of(&CHANNELS[FSR], SLOW_HZ);

#[derive(Clone, Debug, Default)]
pub struct Senses {
    films: PvdfQuality,
    select_lines: SelectLines,
    fsr: [SensorHealth; FSR_COUNT],
    muscles: Muscles,
    fsr_readings: [Option<u16>; FSR_COUNT],
    fsr_missed: [u8; FSR_COUNT],
    fsr_seen: bool,
    pressed: bool,
    /// Quadrants reported as drifting, one bit each.
    doubted: u8,
    force_sensor: ForceSensor,
    detector: VibrationDetector,
    gauges: Gauges,
    taxels: Taxels,
    head: Head,
    head_is_fitted: bool,
    frames_seen: u32,
    open_frames: u32,
    still_frames: u32,
    /// Frames since a sound of slip or an answer to it, since the hand was closed, since a warning closed it, since
    /// it touched something.
    silent_frames: u32,
    closed_frames: u32,
    warned_frames: u32,
    held_frames: u32,
    /// A pulse against slip, or settling after it.
    striking: bool,
    open_and_loaded: u16,
    frames_lost: u32,
    films_usable: bool,
    /// Noisy films that have been reported.
    noisy_told: u16,
    lost: [bool; 3],
    pub vibration: Vibration,
    pub forces: Option<Forces>,
    pub forces_are_new: bool,
    pub gate: Gate,
    pub motor: Motor,
    pub grip: Grip,
    pub unloaded: bool,
}

impl Senses {
    pub fn process(&mut self, config: &Config, frame: &Frame, journal: &mut Journal) {
        if self.frames_lost > 0 {
            journal.fault(Fault::FramesLost { count: self.frames_lost });
            self.frames_lost = 0;
        }
        self.frames_seen = self.frames_seen.saturating_add(1);
        self.condition_vibration(config, frame, journal);
        self.forces_are_new = false;
        let slot = &SCHEDULE[usize::from(frame.slot())];
        if let Some(channel) = slot.switch_a {
            let sample = self.select_lines.believed(frame.switch_a);
            self.on_switch_a(config, usize::from(channel), sample, journal);
        }
        if let Some(channel) = slot.switch_b {
            self.on_switch_b(usize::from(channel), frame.switch_b, journal);
        }
        self.weigh(config);
        self.gate.tick(&config.gate, self.unloaded);
        if frame.ends_slow_frame() {
            self.capabilities(journal);
        }
    }

    /// The films give nothing; other readings expire after a slow frame of lost frames.
    pub fn lose(&mut self, config: &Config, frame: &Frame, journal: &mut Journal) {
        self.frames_lost = self.frames_lost.saturating_add(1);
        self.vibration = Vibration { masked: self.vibration.masked, ..Vibration::default() };
        self.head.miss();
        self.forces_are_new = false;
        let slot = &SCHEDULE[usize::from(frame.slot())];
        for channel in [slot.switch_a, slot.switch_b].into_iter().flatten() {
            self.miss(usize::from(channel), journal);
        }
        if self.frames_lost == STALE_FRAMES {
            journal.fault(Fault::FramesLost { count: self.frames_lost });
            self.forces = None;
            self.fsr_readings = [None; FSR_COUNT];
            self.films_usable = false;
        }
        self.weigh(config);
        self.gate.tick(&config.gate, self.unloaded);
        self.capabilities(journal);
    }

    pub fn sound(&self) -> Option<Sound> {
        self.hears().then_some(self.detector.sound())
    }

    /// `duty_permille`: 0 to 1000. `moves`: the reflex moves the hand or lets it settle.
    #[inline(always)]
    pub fn sensed(&self, config: &Config, frame: &Frame, duty_permille: u16, moves: bool) -> Sensed<'_> {
        let (vibration, wearer) = (self.vibration, self.gate.is_active());
        Sensed {
            frame: frame.sequence,
            slot: frame.slot(),
            valid: frame.valid,
            vibration,
            envelopes: self.envelopes(),
            vibration_known: self.hears(),
            strain: &self.gauges,
            forces: self.forces.as_ref(),
            forces_are_new: self.forces_are_new,
            taxels: self.taxels(),
            head: &self.head,
            unloaded: self.unloaded,
            grasp: matches!(self.grip, Grip::Holds(_)),
            noisy: vibration.impact || duty_permille >= config.hebbian.loud_duty_permille,
            moves: moves || wearer,
            wearer,
        }
    }

    /// Drive of the last `frames`. `took_back`: the reflex released force.
    pub fn driven(&mut self, drive: MotorDrive, took_back: bool, mode: GripMode, frames: u32) {
        let striking = matches!(mode, GripMode::Slip | GripMode::Settle);
        let warned = mode == GripMode::Incipient;
        self.striking = striking;
        let still = !took_back && matches!(drive, MotorDrive::Coast);
        self.still_frames = if still { self.still_frames.saturating_add(frames) } else { 0 };
        let closes = matches!(drive, MotorDrive::Close(_));
        let loud = striking || self.vibration.level >= SILENT_LEVEL || (closes && !warned);
        self.silent_frames = if loud { 0 } else { self.silent_frames.saturating_add(frames) };
        self.held_frames = if self.unloaded { 0 } else { self.held_frames.saturating_add(frames) };
        self.closed_frames = if closes { 0 } else { self.closed_frames.saturating_add(frames) };
        self.warned_frames = if closes && warned { 0 } else { self.warned_frames.saturating_add(frames) };
        match drive {
            MotorDrive::Open(_) if took_back => {}
            MotorDrive::Open(_) => self.open_frames = self.open_frames.saturating_add(frames),
            MotorDrive::Close(_) => self.open_frames = 0,
            MotorDrive::Coast => {}
        }
    }

    /// The hand has closed within the motor's dead time, and shear shows the contact's offset alone: it has just
    /// touched the object, or a warning closed it in silence. Whoever else closes it may lift the object meanwhile.
    const fn closes_silently(&self) -> bool {
        let touches = self.closed_frames <= CLOSES_FRAMES && self.held_frames <= TOUCH_FRAMES;
        touches || (self.warned_frames <= CLOSES_FRAMES && self.silent_frames >= SILENT_FRAMES)
    }

    /// False if the finger is loaded. What it has carried since the start may be an offset, a later load is none.
    #[must_use]
    pub fn zero(&mut self) -> bool {
        let unloaded = (self.unloaded || self.pressed) && self.force_sensor.zero();
        if unloaded {
            self.gauges.zero();
        }
        unloaded
    }

    pub const fn force_sensor(&self) -> &ForceSensor {
        &self.force_sensor
    }

    pub const fn force_sensor_mut(&mut self) -> &mut ForceSensor {
        &mut self.force_sensor
    }

    pub const fn envelopes(&self) -> &[i32; PVDF_COUNT] {
        self.detector.envelopes()
    }

    pub const fn muscles(&self) -> &Muscles {
        &self.muscles
    }

    pub const fn muscles_mut(&mut self) -> &mut Muscles {
        &mut self.muscles
    }

    pub const fn taxels(&self) -> &Reading {
        self.taxels.reading()
    }

    pub const fn hears(&self) -> bool {
        self.films_usable
    }

    /// Slip can be felt, and both muscles are known, or one is and the other cannot be active.
    pub fn ready(&self, config: &Config) -> bool {
        self.feels() && (config.no_wearer || self.gate.is_half_certain(&config.gate))
    }

    /// Like [`ready`](Self::ready), with both muscles known: for behaviours.
    pub fn all_ready(&self, config: &Config) -> bool {
        self.feels() && (config.no_wearer || self.gate.is_certain(&config.gate))
    }

    const fn feels(&self) -> bool {
        self.frames_seen >= WARM_UP_FRAMES
            && (self.films_usable || self.forces.is_some() || self.head.is_usable)
    }

    fn weigh(&mut self, config: &Config) {
        let loaded_mn = config.friction.loaded_mn;
        (self.grip, self.unloaded) = match self.forces {
            None => (Grip::Unknown, false),
            Some(forces) if forces.load_mn < loaded_mn => {
                (Grip::Unloaded, !self.pressed && forces.load_mn < loaded_mn / UNLOADED_PART)
            }
            Some(forces) => (Grip::Holds(forces.load_mn), false),
        };
    }

    #[inline(always)]
    fn condition_vibration(&mut self, config: &Config, frame: &Frame, journal: &mut Journal) {
        if config.head.fitted | self.head_is_fitted {
            self.condition_head(config, frame, journal);
        } else {
            self.condition_pvdf(config, &frame.pvdf, PVDF_COUNT, journal);
        }
    }

    #[inline(always)]
    fn condition_pvdf(
        &mut self,
        config: &Config,
        pvdf: &[u16; PVDF_COUNT],
        films: usize,
        journal: &mut Journal,
    ) {
        let trusts = self.films.check(pvdf, |film, change| report(journal, PVDF + film, Some(change)));
        self.films_usable =
            trusts.is_none_or(|trusts| trusts[..films].iter().any(|&trust| trust != Trust::None));
        self.vibration = self.detector.process(&config.vibration, pvdf, trusts.as_ref());
        if self.vibration.masked != self.noisy_told {
            self.tell_noisy(journal);
        }
    }

    /// Cut wires and select lines. Call it once a slow frame, always after the same tick.
    #[inline(never)]
    pub fn think(&mut self, config: &Config, samples: &LastSamples, journal: &mut Journal) {
        // A muscle's spectrum, twice in 64 cycles, leaves no time for the quadrants.
        if !self.muscles().has_window() {
            self.blame(config, journal);
        }
        self.select_lines.look(&samples.switch_b);
    }

    /// Noise of the films and steady sliding. Call it once a slow frame, in another tick than [`think`](Self::think).
    #[inline(never)]
    pub fn listen(&mut self, config: &Config, journal: &mut Journal) {
        self.films.slow(|film, change| report(journal, PVDF + film, Some(change)));
        self.detector.learn_noise(&config.vibration, self.unloaded);
        let forces = self.forces.filter(|_| matches!(self.grip, Grip::Holds(_)));
        let (wearer, striking) = (self.gate.is_active(), self.striking);
        self.detector.slow(Hand { forces, wearer, striking, loud: false });
    }

    /// A report of slip has been refuted.
    pub fn refute(&mut self) {
        self.detector.refute();
    }

    /// The films get a healthy silent film in the head's place. Compiled apart: twelve films cost nothing more.
    #[cold]
    #[inline(never)]
    fn condition_head(&mut self, config: &Config, frame: &Frame, journal: &mut Journal) {
        let is_fitted = Role::of(HEAD, config.head.fitted) == Role::Photoelastic;
        if self.head_is_fitted != is_fitted {
            self.head_is_fitted = is_fitted;
            self.head = Head::default();
            self.detector.forget(HEAD - PVDF);
        }
        let mut pvdf = frame.pvdf;
        if is_fitted {
            let silent = SAMPLE_MAX / 2 + (frame.sequence & 1) as u16;
            let sample = core::mem::replace(&mut pvdf[HEAD - PVDF], silent);
            let change = self.head.process(&config.head, sample);
            report(journal, HEAD, change);
        }
        let films = if is_fitted { HEAD - PVDF } else { PVDF_COUNT };
        self.condition_pvdf(config, &pvdf, films, journal);
    }

    #[inline(never)]
    fn track(&mut self, config: &Config) {
        let force_mn = self.forces.filter(|_| !self.pressed).map(|forces| forces.load_mn);
        let hints = Hints { unloaded: self.open_frames >= OPEN_FRAMES, force_mn };
        self.head.cycle(&config.head, hints);
        if self.forces.is_none() {
            self.forces = self.head.stand_in();
        }
    }

    /// One film a tick: a tick has no time for twelve reports.
    #[inline(never)]
    fn tell_noisy(&mut self, journal: &mut Journal) {
        let film = (self.vibration.masked ^ self.noisy_told).trailing_zeros() as usize;
        self.noisy_told ^= 1 << film;
        let lost = self.vibration.masked >> film & 1 != 0;
        let change = if lost { Change::Lost(Reason::Noisy) } else { Change::Back };
        report(journal, PVDF + film, Some(change));
    }

    fn on_switch_a(&mut self, config: &Config, channel: usize, sample: u16, journal: &mut Journal) {
        if let Some(quadrant) = channel.checked_sub(FSR) {
            self.quadrant(config, quadrant, sample, journal);
        } else if let Some(gauge) = channel.checked_sub(STRAIN) {
            let change = self.gauges.read(gauge, sample, self.unloaded);
            report(journal, channel, change);
        }
    }

    fn on_switch_b(&mut self, channel: usize, sample: u16, journal: &mut Journal) {
        let lines = self.select_lines;
        match channel {
            ARRAY..MYO_FLEXOR => {
                let change = self.taxels.read(channel - ARRAY, lines.believed(sample));
                report(journal, channel, change);
            }
            MYO_FLEXOR..=MYO_EXTENSOR => {
                self.muscle(channel - MYO_FLEXOR, lines.believed_muscle(sample), journal);
            }
            _ => self.motor.take(channel, Some(lines.believed(sample))),
        }
    }

    fn miss(&mut self, channel: usize, journal: &mut Journal) {
        match channel {
            FSR..ARRAY => {
                let quadrant = channel - FSR;
                self.fsr_missed[quadrant] = self.fsr_missed[quadrant].saturating_add(1);
                if self.fsr_missed[quadrant] >= QUADRANT_MISSES {
                    self.fsr_readings[quadrant] = None;
                    self.forces = None;
                }
            }
            ARRAY..MYO_FLEXOR => self.taxels.lose(channel - ARRAY),
            MYO_FLEXOR..=MYO_EXTENSOR => {
                let muscle = channel - MYO_FLEXOR;
                if self.muscles.miss(muscle, journal) {
                    self.gate.show(muscle, None);
                    self.gate.take(self.muscles.verdict());
                }
            }
            OPENING..COUNT => self.motor.take(channel, None),
            _ => {}
        }
    }

    fn muscle(&mut self, muscle: usize, sample: u16, journal: &mut Journal) {
        let uv = self.muscles.take(muscle, sample, journal);
        self.gate.show(muscle, uv.map(|uv| (uv / 1_000) as i16));
        self.gate.take(self.muscles.verdict());
    }

    fn capabilities(&mut self, journal: &mut Journal) {
        if self.frames_seen < WARM_UP_FRAMES {
            return;
        }
        let now = [
            (Capability::Vibration, !self.films_usable && !self.head.is_usable),
            (Capability::Force, self.forces.is_none()),
            (Capability::WearerIntent, !self.gate.is_known()),
        ];
        for (was, (capability, is)) in self.lost.iter_mut().zip(now) {
            if *was != is {
                *was = is;
                journal.fault(if is {
                    Fault::CapabilityLost(capability)
                } else {
                    Fault::CapabilityBack(capability)
                });
            }
        }
    }
}

// The front end's rest must read as unloaded, or every hand would report that it was pressed at boot.
const _: () = assert!(FSR_REST_MV > CHANNELS[FSR].low_mv && CHANNELS[FSR].rest_mv == FSR_REST_MV);
