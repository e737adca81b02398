//! Every distribution that worlds are drawn from. `A`: assumed, over a decade. The shapes are assumed, too; sources anchor medians and
//! ends. Sensors, wearer and loads that stand in no row are as `file::defaults`.

use crate::random::Noise;

#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Median, and deviation of the natural logarithm.
    LogNormal(f64, f64),
    /// Deviation about 0.
    Normal(f64),
    LogUniform,
    Uniform,
}

/// A distribution; what falls outside its ends is drawn again.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    shape: Shape,
    low: f64,
    high: f64,
}

const fn log_normal(median: f64, deviation: f64, low: f64, high: f64) -> Law {
    Law { shape: Shape::LogNormal(median, deviation), low, high }
}

const fn normal(deviation: f64, most: f64) -> Law {
    Law { shape: Shape::Normal(deviation), low: -most, high: most }
}

const fn log_uniform(low: f64, high: f64) -> Law {
    Law { shape: Shape::LogUniform, low, high }
}

const fn uniform(low: f64, high: f64) -> Law {
    Law { shape: Shape::Uniform, low, high }
}

impl Law {
    pub(super) fn draw(self, noise: &mut Noise) -> f64 {
        self.beside(noise, 0.0, 0.0).0
    }

    /// A draw whose deviate is correlated by `rho` with another's, and its deviate.
    pub(super) fn beside(self, noise: &mut Noise, rho: f64, other: f64) -> (f64, f64) {
        let Self { shape, low, high } = self;
        loop {
            let mut deviate = || rho * other + (1.0 - rho * rho).sqrt() * noise.normal();
            let (value, deviate) = match shape {
                Shape::LogUniform => (low * libm::pow(high / low, noise.between(0.0, 1.0)), 0.0),
                Shape::Uniform => (noise.between(low, high), 0.0),
                Shape::Normal(deviation) => {
                    let deviate = deviate();
                    (deviation * deviate, deviate)
                }
                Shape::LogNormal(median, deviation) => {
                    let deviate = deviate();
                    (median * libm::exp(deviation * deviate), deviate)
                }
            };
            if (low..=high).contains(&value) {
                return (value, deviate);
            }
        }
    }
}

// Object and contact.

/// 92 % of what people grasp weighs at most 0.5 kg (doi 10.1109/TOH.2014.2326871), kg.
pub const MASS_KG: Law = log_normal(0.12, 1.0, 0.0017, 1.5);
/// 96 % is at most 70 mm wide (likewise), mm.
pub const WIDTH_MM: Law = log_normal(30.0, 0.48, 3.0, 90.0);
pub const MASS_WITH_WIDTH: f64 = 0.5; // A
pub const STIFFNESS_N_PER_MM: Law = log_normal(1.5, 0.9, 0.2, 10.0); // A
/// Tests at 6 and 18 N (JNER 2019 s12984-019-0511-2, figure 2); 10 N can crack an egg (pr2_gripper_sensor_msgs), N.
pub const CRUSH_N: Law = log_normal(18.0, 0.8, 4.0, 150.0);
pub const CRUSH_WITH_STIFFNESS: f64 = 0.6; // A
pub const CRUSH_PART: f64 = 0.4; // A: the others never yield
pub const MASS_ASIDE_MM: Law = normal(8.0, 30.0); // A
pub const HANGS_MM: Law = log_uniform(3.0, 30.0); // A
pub const GYRATION_PART: Law = uniform(0.3, 0.8); // A: of the width
/// Contact beside the pad's middle, mm: A, pad of 18 mm. Whoever grasps on purpose is nearer to the middle (A).
pub const ASIDE_MM: Law = normal(1.5, 4.5);
pub const FAR_ASIDE_MM: Law = normal(4.0, 9.0);
/// Silicone 0.25 to 0.75, tacky 1 (product pages); skin on aluminium 0.38, paper 0.27, vinyl 0.53 (Univ. of Michigan), on aluminium
/// 0.6, rubber 0.9 (doi 10.1080/00140130802471595); the rest A.
pub const MU_S: Law = log_normal(0.6, 0.4, 0.15, 1.2);
/// No significant difference of a wet palm, soap lower (doi 10.1080/00140130110074882); rubber A.
pub const WET_FACTOR: Law = log_normal(0.6, 0.45, 0.2, 1.4);
/// Silicone on oiled steel 0.30 (Robotiq, Hand-E manual).
pub const OILY_MU_S: Law = log_normal(0.3, 0.3, 0.1, 0.5);
pub const POWDER_FACTOR: Law = log_normal(0.6, 0.3, 0.3, 1.0); // A; talc lowers silicone's
pub const OILY_PART: f64 = 0.15; // A: of splashes
pub const POWDER_PART: f64 = 0.1; // A: of splashes
pub const PITCH_MM: Law = log_uniform(0.5, 2.0); // A: grooves of the skin
pub const BRUSH_PART: f64 = 0.5; // A: pads that let go ring by ring; the others are rigid
/// Onset of a splash, of what runs down, and of condensation (minutes, by popular accounts; here shortened ten times).
pub const SPLASH_MS: Law = log_uniform(5.0, 100.0); // A
pub const RUN_DOWN_MS: Law = log_uniform(100.0, 1_000.0); // A
pub const CONDENSATION_S: Law = log_uniform(3.0, 8.0); // A

/// mu_d over mu_s, 5/50/95 %: 0.73/0.86/0.96. A finger on wet glass slips by 30 % of its steady force (stick-slip of human skin); steel
/// 0.81 dry, 0.70 greasy. Kumaraswamy's law in the place of a beta law: it inverts in closed form.
pub(super) fn mu_d_part(noise: &mut Noise) -> f64 {
    let rest = libm::pow(1.0 - noise.between(0.0, 1.0), 1.0 / 2.3);
    0.6 + 0.4 * libm::pow(1.0 - rest, 1.0 / 3.2)
}

// Force sensor.

/// Parts +-6 %, one part +-2 % (FSR 400 data sheet); 5 to 26 % spread (J. Sensors 2018 6561901, table 5).
pub const QUADRANT_GAIN: Law = log_normal(1.0, 0.08, 0.7, 1.4);
pub const HYSTERESIS: Law = uniform(0.02, 0.08); // FSR 400 data sheet: 10 % in the mean
pub const CREEP: Law = uniform(0.01, 0.05); // likewise: below 5 % a decade of time
pub const FSR_NOISE: Law = log_uniform(0.002, 0.02); // A

// Films.

/// Of the scenes' film, all of them alike; and how far one film is from another, decades.
pub const FILM_FACTOR: Law = log_uniform(0.4, 4.0); // A
pub const FILM_DECADES: Law = uniform(0.0, 0.5); // A
pub const FILM_NOISE_MV: Law = log_uniform(0.1, 1.0); // A: around the recordings' 0.3 mV
pub const GEAR_HZ: Law = log_uniform(100.0, 600.0); // A
pub const GEAR_MV: Law = log_uniform(0.3, 10.0); // A
pub const MAINS_MV: Law = log_uniform(0.1, 10.0); // A
pub const KNOCK_HZ: Law = log_uniform(50.0, 2_000.0); // A
pub const KNOCK_MS: Law = log_uniform(1.0, 30.0); // A
pub const KNOCK_MV: Law = log_uniform(5.0, 300.0); // A
pub const UNEVEN: Law = uniform(0.0, 1.0); // A
/// Knocks fall at 2 to 200 an hour (A): in the families that are not about them, this part of the worlds has one.
pub const KNOCK_PART: f64 = 0.15;

// Hand.

/// 15 N (PMC4663252, table 1) to 140 N (bebionic v3, likewise).
pub const HAND_N: Law = log_normal(60.0, 0.5, 15.0, 140.0);
/// Closes in 0.37 to 1 s (likewise); SensorHand 300 mm/s, Robotiq 2F-85 20 to 150 mm/s (manuals).
pub const HAND_MM_S: Law = log_normal(100.0, 0.5, 20.0, 300.0);
pub const DEAD_TIME_MS: Law = log_normal(30.0, 0.45, 10.0, 100.0); // A
pub const GAP_MM: Law = log_uniform(5.0, 15.0); // A: opening beyond the object's width
/// The wearer's own grip over what carries the object still and dry.
pub const GRIP_OVER_NEED: Law = log_normal(1.5, 0.4, 1.0, 4.0); // A
pub const CLOSING_MV: Law = uniform(200.0, 280.0); // A: gently

// Muscles.

pub const MYO_NOISE_MV: Law = log_uniform(2.0, 20.0); // A
pub const RIPPLE: Law = uniform(0.02, 0.1); // A
pub const CROSSTALK: Law = uniform(0.02, 0.1); // A: the wearer was calibrated at 0.05 to 0.1
pub const MYO_MAINS_MV: Law = log_uniform(1.0, 10.0); // A
pub const TENSE_MV: Law = log_uniform(200.0, 1_000.0); // A: contractions that are meant for nothing
pub const TENSE_S: Law = log_uniform(0.1, 3.0); // A
pub const LIFTED_S: Law = log_normal(0.4, 1.0, 0.05, 3.0); // A; loose sockets lose contact (Sci. Rep. s41598-021-82764-6)
pub const LIFTED_MV: Law = log_uniform(50.0, 1_500.0); // A: mains of the open electrode

// Loads and events.

pub const LIFT_M_S2: Law = log_normal(1.5, 0.5, 0.3, 15.0); // A
pub const FILLING_KG_S: Law = log_normal(0.06, 0.6, 0.005, 0.17); // a tap gives 10 l a minute; the rest A
pub const POURS_S: Law = log_uniform(1.5, 5.0); // A
pub const DROPPED_KG: Law = log_uniform(0.005, 0.3); // A
/// What falls in is at most this part of what it falls into, and nobody tugs at more times its weight: harder ones no hand holds (A).
pub const DROPPED_PART: f64 = 0.5;
pub const TUG_WEIGHTS: f64 = 3.0;
pub const DROPPED_FROM_MM: Law = log_uniform(10.0, 300.0); // A
pub const DROPPED_MS: Law = log_uniform(5.0, 30.0); // A
/// Studied at 6 to 30 N (Uygur 2010); 4 to 16 N pull objects out of terminal devices (arXiv 2503.01585).
pub const TUG_N: Law = log_uniform(1.0, 30.0);
pub const TUG_N_S: Law = log_uniform(5.0, 500.0); // A
pub const TUG_S: Law = log_uniform(0.1, 1.5); // A
pub const HAND_OVER_MS: Law = log_uniform(100.0, 800.0); // A
pub const WALK_M_S2: Law = log_normal(3.0, 0.5, 0.3, 15.0); // A
pub const SWING_M_S2: Law = log_normal(7.0, 0.5, 0.3, 15.0); // A
pub const WALK_HZ: Law = uniform(0.7, 3.0); // walking, a weak source
pub const BUMP_M_S2: Law = log_uniform(5.0, 30.0); // A
pub const BUMP_MS: Law = log_uniform(10.0, 50.0); // A
/// From a slip's cause to the next: the same cause, still loading.
pub const AGAIN_S: Law = log_normal(0.4, 0.8, 0.05, 3.0); // A
pub const AGAIN_PART: f64 = 0.5; // A

// Hours of holding.

pub const KNOCKS_H: Law = log_uniform(2.0, 200.0); // A: of the socket and of what the hand touches
pub const BUMPS_H: Law = log_uniform(1.0, 30.0); // A
pub const HUMS_H: Law = log_uniform(1.0, 30.0); // A: machines near by, on 50 or 60 Hz
pub const HUM_S: Law = uniform(1.0, 3.5); // A
pub const STRETCH_S: Law = log_uniform(5.0, 50.0); // A: of walking, driving, trembling, hum
pub const DRIVE_HZ: Law = uniform(1.0, 20.0); // a vehicle
pub const DRIVE_M_S2: Law = log_uniform(0.14, 1.4); // A: 0.1 to 1 m/s^2 rms
pub const TREMOR_HZ: Law = uniform(8.0, 12.0); // physiological
pub const TREMOR_M_S2: Law = log_uniform(0.05, 0.3); // A
/// Offset of a charge amplifier, up to 30 mV an hour (A).
pub const FILM_DRIFT_MV_S: Law = uniform(-8e-3, 8e-3);
