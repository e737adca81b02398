//! The Hebbian detector: films and gauges are the network's inputs, a camera teaches it over the line at 1 kHz,
//! and its outputs from touch alone report slip and warn of it.
//!
//! Slip is reported while the films' part of o1 is far enough below 0 and below the films' own [`noise`](super::noise)
//! on a finger that holds something, and nothing is loud. Vibration of all films is slip only if it lasts. Ft/Fn
//! near the learned ratio ([`Ahead`]) is a warning. The direction comes from the gauges (Tada 2006, section I).

use core::ops::Range;

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Forces, NETWORK_OUTPUTS, NetworkState, RECEPTORS};
use tenax_hal_shim::words::{Code, Codes, NoLesson};

use super::noise::Noise;
use super::pvdf_part::PvdfPart;
use super::{Activations, FingertipNetwork, Normaliser, NormaliserConfig, Output, Sense, Teacher, snapshot};
use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::force::Ahead;
use crate::hebbian::settings::HebbianConfig;

pub type Learned = snapshot::Contents<RECEPTORS, NETWORK_OUTPUTS>;
pub const SNAPSHOT_LENGTH: usize = snapshot::length(RECEPTORS, NETWORK_OUTPUTS);

pub static NORMALISER: NormaliserConfig<RECEPTORS> = NormaliserConfig {
    senses: {
        let mut senses = [Sense::Pressure; RECEPTORS];
        let mut film = 0;
        while film < PVDF_COUNT {
            senses[film] = Sense::Vibration;
            film += 1;
        }
        senses
    },
    // 4 mV of vibration, 6 mV of load: below is noise.
    floors: {
        let mut floors = [480; RECEPTORS];
        let mut film = 0;
        while film < PVDF_COUNT {
            floors[film] = 320;
            film += 1;
        }
        floors
    },
    ceiling: 1 << 17,
    average_shift: 8,
};

const FILMS: Range<usize> = 0..PVDF_COUNT;
const GAUGES: Range<usize> = PVDF_COUNT..RECEPTORS;
const ONE: i64 = 1 << 26;
const SOMEWHERE_MAX: usize = 6;
const SHEAR_IS_JUDGED: u8 = slot_of(Job::Forces) + 1;
const CYCLE_ENDS: u8 = 20;
/// Least value of the second output that tells a direction; 128 is 1.
const DIRECTION_FROM: i8 = 16;

#[derive(Clone, Debug)]
pub struct HebbianDetector {
    normaliser: Normaliser<RECEPTORS>,
    network: FingertipNetwork,
    teacher: Teacher,
    activations: Activations<RECEPTORS>,
    pvdf_part: PvdfPart,
    noise: Noise,
    shear: Ahead,
    outputs: [Output; NETWORK_OUTPUTS],
    by_gauges: [i64; NETWORK_OUTPUTS],
    by_films: i64,
    weights_changed: bool,
    since_loud_frames: u32,
    said_frames: u32,
    films_say: bool,
    warns: bool,
    lesson: Result<Codes, NoLesson>,
    odd: bool,
    balance: Balance,
    updates: u32,
}

impl Default for HebbianDetector {
    fn default() -> Self {
        Self {
            normaliser: Normaliser::new(&NORMALISER),
            network: FingertipNetwork::default(),
            teacher: Teacher::default(),
            activations: Activations::default(),
            pvdf_part: PvdfPart::default(),
            noise: Noise::default(),
            shear: Ahead::default(),
            outputs: [Output::default(); NETWORK_OUTPUTS],
            by_gauges: [0; NETWORK_OUTPUTS],
            by_films: 0,
            weights_changed: false,
            since_loud_frames: 0,
            said_frames: 0,
            films_say: false,
            warns: false,
            lesson: Err(NoLesson::Absent),
            odd: false,
            balance: Balance::default(),
            updates: 0,
        }
    }
}

impl Detector for HebbianDetector {
    const ID: DetectorId = DetectorId::Hebbian;
    type Config = HebbianConfig;

    fn step(&mut self, config: &HebbianConfig, sensed: &Sensed<'_>) -> Option<Said> {
        if !sensed.valid {
            self.lose();
            return Some(Said::NOTHING);
        }
        if sensed.slot == SHEAR_IS_JUDGED {
            self.foretell(config, sensed.forces, sensed.grasp, sensed.unloaded || sensed.wearer);
        }
        self.tick(config, sensed);
        Some(Said { slip: self.slips(), incipient: self.warns() })
    }

    fn describe(&self, config: &HebbianConfig) -> Description {
        let raw = (self.by_films * 1_000 / ONE) as i32;
        let [_, o2] = self.outputs();
        let direction = match (self.slips() | self.warns(), o2) {
            (true, o2) if o2 <= -DIRECTION_FROM => Direction::Down,
            (true, o2) if o2 >= DIRECTION_FROM => Direction::Up,
            _ => Direction::Unknown,
        };
        let health =
            if self.pvdf_part.quiet_known { DetectorHealth::Working } else { DetectorHealth::Starting };
        Description {
            confidence_permille: confidence(-raw, config.slip_permille.into()),
            direction,
            health,
            raw,
        }
    }
}

impl HebbianDetector {
    fn tick(&mut self, config: &HebbianConfig, sensed: &Sensed<'_>) {
        let learns = self.lesson.is_ok();
        if self.pvdf_part.stale && !learns {
            self.know_gains();
        }
        let mut by_films = self.pvdf_part.process(sensed);
        // The first twelve slots read a gauge each.
        let gauge = usize::from(sensed.slot);
        if let Some(load) = sensed.strain.load(gauge) {
            self.weigh(PVDF_COUNT + gauge, load);
        }
        if learns {
            self.feel_films();
            by_films = self.network.sum_of_parts(0, FILMS, &self.activations);
        }
        self.by_films = by_films;
        let [o1_by_gauges, o2_by_gauges] = self.by_gauges;
        self.outputs = [output(by_films + o1_by_gauges), output(o2_by_gauges)];
        self.judge(config, sensed, by_films);
        self.noise.add(by_films);
        if sensed.slot == CYCLE_ENDS {
            let quiet = self.pvdf_part.quiet_known && self.since_loud_frames >= config.loud_frames;
            self.noise.end_cycle(sensed.unloaded && quiet);
        }
        self.learn(config, sensed, learns);
    }

    /// Call it in slot [`SHEAR_IS_JUDGED`], before its tick. `anew`: nothing is touched, or a muscle is active.
    #[inline(never)]
    fn foretell(&mut self, config: &HebbianConfig, forces: Option<&Forces>, grasp: bool, anew: bool) {
        if anew {
            self.shear.renew();
        }
        self.shear.feel(config.ahead_ms, forces);
        self.warns = grasp && self.shear.warns();
    }

    #[inline(never)]
    fn feel_films(&mut self) {
        self.normaliser.renew(&NORMALISER, 0, &self.pvdf_part.heard, &mut self.activations);
    }

    #[inline(never)]
    fn know_gains(&mut self) {
        let [to_o1, _] = self.network.weights();
        self.pvdf_part.renew(&to_o1, &self.normaliser.maxima());
    }

    /// While no weight has changed, no other gauge's part has.
    fn weigh(&mut self, receptor: usize, load: i32) {
        let before = self.network.parts_of(receptor, &self.activations);
        self.normaliser.renew(&NORMALISER, receptor, &[load], &mut self.activations);
        if core::mem::take(&mut self.weights_changed) {
            self.by_gauges =
                [0, 1].map(|output| self.network.sum_of_parts(output, GAUGES, &self.activations));
            return;
        }
        let after = self.network.parts_of(receptor, &self.activations);
        for ((sum, before), after) in self.by_gauges.iter_mut().zip(before).zip(after) {
            *sum += i64::from(after) - i64::from(before);
        }
    }

    pub fn lose(&mut self) {
        self.outputs = [Output::default(); NETWORK_OUTPUTS];
        self.said_frames = 0;
        self.films_say = false;
        self.warns = false;
        self.shear.lose();
        self.pass();
    }

    pub fn teach(&mut self, config: &HebbianConfig, codes: Codes, age_ms: u16) {
        self.teacher.receive(config.teacher_fresh_ms, codes, age_ms);
    }

    pub fn forget(&mut self) {
        self.normaliser = Normaliser::new(&NORMALISER);
        self.network = FingertipNetwork::default();
        self.by_gauges = [0; NETWORK_OUTPUTS];
        self.weights_changed = true;
        self.pvdf_part.stale = true;
        self.shear = Ahead::default();
        self.noise = Noise::default();
        self.balance = Balance::default();
        self.updates = 0;
    }

    pub const fn slips(&self) -> bool {
        self.films_say
    }

    pub const fn warns(&self) -> bool {
        self.warns
    }

    /// Relative motion (o1) and direction (o2) from touch alone; 128 is 1.
    pub fn outputs(&self) -> [i8; NETWORK_OUTPUTS] {
        self.outputs.map(|output| (output.into_bits() >> 19).clamp(-128, 127) as i8)
    }

    pub const fn lesson(&self) -> Result<Codes, NoLesson> {
        self.lesson
    }

    pub const fn updates(&self) -> u32 {
        self.updates
    }

    pub fn state(&self, frame: u32) -> NetworkState {
        let mut activations = self.activations;
        self.normaliser.renew(&NORMALISER, 0, &self.pvdf_part.heard, &mut activations);
        NetworkState {
            frame,
            weights: self.network.weights().map(|row| row.map(|weight| weight.into_bits())),
            activations: activations.as_bits().map(|bits| (bits >> 12) as i16),
            updates: self.updates,
            teacher_age_ms: self.teacher.age_ms(),
            no_lesson: self.lesson.err(),
        }
    }

    pub fn learned(&self) -> Learned {
        Learned::of(&self.normaliser, &self.network, self.shear.learned())
    }

    /// False if the bytes are no snapshot of this network; nothing has changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> bool {
        let Some((normaliser, network, slips_at)) = snapshot::restore(&NORMALISER, bytes) else {
            return false;
        };
        (self.normaliser, self.network) = (normaliser, network);
        self.shear.restore(slips_at);
        self.noise = Noise::default();
        self.weights_changed = true;
        self.pvdf_part.stale = true;
        true
    }

    fn judge(&mut self, config: &HebbianConfig, sensed: &Sensed<'_>, sum: i64) {
        self.since_loud_frames = if sensed.noisy { 0 } else { self.since_loud_frames.saturating_add(1) };
        // Half the threshold keeps it on: one slip has dips.
        let threshold = i64::from(config.slip_permille) / if self.films_say { 2 } else { 1 };
        let says = sensed.grasp
            && self.since_loud_frames >= config.loud_frames
            && sum * 1_000 <= -threshold * ONE
            && sum <= -self.noise.floor / if self.films_say { 2 } else { 1 };
        if !says {
            self.said_frames = 0;
            self.films_say = false;
            return;
        }
        self.said_frames = self.said_frames.saturating_add(1);
        let hears = |part: &i32| i64::from(*part) * 2 * PVDF_COUNT as i64 <= sum;
        let count = if self.lesson.is_ok() {
            self.network.parts(0, FILMS, &self.activations).filter(hears).count()
        } else {
            self.pvdf_part.parts().filter(hears).count()
        };
        let somewhere = count <= SOMEWHERE_MAX;
        let long_enough = if somewhere { config.slip_frames } else { config.everywhere_frames };
        if self.said_frames >= long_enough {
            self.films_say = true;
            self.shear.renew();
        }
    }

    fn learn(&mut self, config: &HebbianConfig, sensed: &Sensed<'_>, felt_so: bool) {
        let disturbed = sensed.vibration.impact || sensed.moves || !sensed.vibration_known;
        self.lesson = self.teacher.lesson(config.teacher_fresh_ms, sensed.grasp, disturbed);
        if let Ok(codes) = self.lesson {
            self.pvdf_part.stale = true;
            if sensed.slot == SHEAR_IS_JUDGED && codes[0] == Code::Minus {
                self.shear.learn();
            }
            if !felt_so {
                self.feel_films();
            }
            if self.odd {
                let codes = self.balance.admit(codes);
                self.network.learn(&config.rule, &self.activations, &codes);
                self.weights_changed = true;
                self.updates = self.updates.saturating_add(1);
            } else {
                let mut readings = [0; RECEPTORS];
                let (films, gauges) = readings.split_at_mut(PVDF_COUNT);
                films.copy_from_slice(&self.pvdf_part.heard);
                gauges.copy_from_slice(&sensed.strain.loads());
                self.normaliser.observe(&NORMALISER, &readings);
            }
        }
        self.pass();
    }

    fn pass(&mut self) {
        self.odd = !self.odd;
        if self.odd {
            self.teacher.tick_ms();
        }
    }
}

/// Equation 4.
fn output(sum: i64) -> Output {
    Output::from_bits(sum.clamp(-ONE, ONE) as i32)
}

const AHEAD_MAX: i16 = 2_000;

/// Lessons of each code less those of its opposite: Hebb's rule lets a constant input learn whichever code was
/// taught longer.
#[derive(Clone, Copy, Debug, Default)]
struct Balance([i16; NETWORK_OUTPUTS]);

impl Balance {
    fn admit(&mut self, codes: Codes) -> [Option<Code>; NETWORK_OUTPUTS] {
        let mut admitted = [None; NETWORK_OUTPUTS];
        for ((ahead, slot), code) in self.0.iter_mut().zip(&mut admitted).zip(codes) {
            let after = *ahead + code.sign() as i16;
            if after.abs() <= AHEAD_MAX {
                *ahead = after;
                *slot = Some(code);
            }
        }
        admitted
    }
}
