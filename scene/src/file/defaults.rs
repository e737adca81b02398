//! Defaults of the hand and its sensors, each number with its source.

use toml::Spanned;

use super::quantity::{
    Damping, DeadTime, Degrees, Duration, Gain, Hertz, Kilograms, Lever, Micrometres, Millimetres,
    Millinewtons, Milliseconds, Millivolts, Mu, NewtonsMax, Part, Play, Speed, Stiffness,
};
use super::sections::{Array, Camera, Fsr, Gripper, Myo, Photoelastic, Pvdf, Robot, Skin, Strain, Table};

impl Default for Gripper {
    fn default() -> Self {
        Self {
            // Prosthesis, section 1: "average speed of 120 mm/s", "maximum force 140 N".
            speed_mm_s: Speed::of(120.0),
            force_n: NewtonsMax::of(140.0),
            // Assumed: motors and gears of such hands start to move 20 to 50 ms after the voltage.
            dead_time_ms: DeadTime::of(30.0),
            // Assumed: the Ottobock's opening width is about 100 mm.
            range_mm: Millimetres::of(100.0),
            opening_mm: Spanned::new(0..0, Millimetres::of(90.0)),
            // The Ottobock is driven by voltage.
            step_mm: Play::of(0.0),
        }
    }
}

impl Default for Table {
    fn default() -> Self {
        // Assumed: a thin felt mat that gives 1 mm under 2 N and rings little.
        Self { mat_n_per_mm: Stiffness::of(2.0), damping: Damping::of(0.7) }
    }
}

impl Default for Robot {
    fn default() -> Self {
        Self {
            // Assumed: the cylindrical probe of Prosthesis, figure 3.
            probe_kg: Kilograms::of(0.2),
            // Assumed: a PUMA 560 along one axis is stiffer; probe and skin in series are not.
            stiffness_n_per_mm: Stiffness::of(0.5),
            damping: Damping::of(0.7),
            ramp_ms: Milliseconds::of(80.0),
        }
    }
}

impl Default for Pvdf {
    fn default() -> Self {
        Self {
            // The board: 30 mV at the film are 600 mV at the pin.
            gain: Gain::of(20.0),
            // Recordings: two films of one fingertip differ by 1.7 times (37 and 61 mV peak to peak at slip onset).
            spread: Part::of(0.3),
            // `tenax learn` draws a decade for fingers made by chance.
            film_decades: Part::of(0.0),
            film_directions: Part::of(0.0),
            // Recordings: after the bump of 25 ms the film is back within another 10 ms.
            high_pass_hz: Hertz::of(16.0),
            skin_ms: Milliseconds::of(3.5),
            // Recordings: contact gives 7 to 13 mV peak to peak, slowly; that it loads a film with some 5 N is assumed.
            normal_mv_per_n: Gain::of(2.0),
            shear_mv_per_n: Gain::of(3.0),
            // Recordings: slip onset gives 37 to 61 mV peak to peak; that it lets go of about 0.3 N is assumed.
            release_mv_per_n: Gain::of(200.0),
            // Recordings (friction rig): steady sliding at 40 mm/s has 0.24 to 0.39 of the onset's rms.
            texture_mv_per_n: Gain::of(40.0),
            texture_half_mm_s: Speed::of(20.0),
            // Assumed: closing at 100 N/s is heard at 2 mV rms, below sliding.
            adjust_mv_per_n_s: Gain::of(0.02),
            // Assumed: a worm gear at 18 000 turns a minute.
            motor_mv: Millivolts::of(1.0),
            motor_hz: Hertz::of(300.0),
            // Assumed: as large as the noise.
            mains_mv: Millivolts::of(0.4),
            mains_hz: Hertz::of(50.0),
            // Recordings: quiet is 0.3 mV rms, white.
            noise_mv: Millivolts::of(0.3),
        }
    }
}

impl Default for Fsr {
    fn default() -> Self {
        // Interlink's integration guide gives 10 % of hysteresis and 5 % of drift in a log decade at most; half of each
        // is assumed to be left under a tilting element that always presses the same spots.
        Self {
            hysteresis: Part::of(0.03),
            creep: Part::of(0.03),
            creep_s: Duration::of(10.0),
            // An ideal fitting; worlds that are drawn have none.
            gains: [Gain::of(1.0); 4],
            aside_mm: [Lever::of(0.0); 2],
            noise: Part::of(0.0),
        }
    }
}

impl Default for Myo {
    fn default() -> Self {
        Self {
            // Assumed, as all of these: an Ottobock-like electrode with its own rectifier and low-pass.
            rise_ms: Milliseconds::of(60.0),
            tone_mv: Millivolts::of(50.0),
            noise_mv: Millivolts::of(8.0),
            ripple: Part::of(0.06),
            crosstalk: Part::of(0.05),
            mains_mv: Millivolts::of(5.0),
        }
    }
}

impl Default for Strain {
    fn default() -> Self {
        Self {
            // Assumed: 20 N of grasp stay within the front end's range.
            normal_mv_per_n: Gain::of(60.0),
            shear_mv_per_n: Gain::of(120.0),
            // Tada 2006, section III: random places and depths; how unlike is assumed.
            spread: Part::of(0.3),
            offset_mv: Millivolts::of(40.0),
            drift_mv_per_min: Millivolts::of(5.0),
            // Assumed: silicone rubber relaxes by a few per cent.
            creep: Part::of(0.02),
            creep_s: Duration::of(10.0),
            // Assumed: a foil gauge behind an instrumentation amplifier.
            noise_mv: Millivolts::of(1.0),
        }
    }
}

impl Default for Array {
    fn default() -> Self {
        Self {
            // Bamshad 2023, section 2.1: 14.7 N full scale, here over the front end's 3 V.
            mv_per_n: Gain::of(200.0),
            // Assumed, as the rest: piezoresistive elements under one cover.
            spread: Part::of(0.15),
            offset_mv: Millivolts::of(30.0),
            tilt: Part::of(0.5),
            slip_part: Part::of(0.5),
            rim_part: Part::of(0.5),
            // Some tens of micrometres on polymers (Dieterich and Kilgore 1994); assumed for the cover.
            renews_um: Micrometres::of(50.0),
            uneven: Part::of(0.02),
            knock_mn_per_mv: Gain::of(1.0),
            motor_part: Part::of(0.003),
            place_mm: Lever::of(0.0),
            specimen: None,
            noise_mv: Millivolts::of(0.5),
        }
    }
}

impl Default for Skin {
    fn default() -> Self {
        Self {
            // FingerVision 2017, section VI-A: the pictures are sent at 63 a second at least; read out, judged and sent within
            // two of them (assumed).
            rate_hz: Hertz::of(60.0),
            delay_ms: DeadTime::of(33.0),
            // Assumed, as the rest: a marker is found to a tenth of a pixel, and 1 N on it moves it by 10.
            force_noise_mn: Millinewtons::of(10.0),
            speckle_e4: Gain::of(4.0),
            // On drawn pictures (docs/vision.md) the crate's angle is off by 0.33 degrees, and 0.05 % of its pictures are wrong.
            // These are worse.
            angle_noise_deg: Degrees::of(0.5),
            wrong_part: Part::of(0.01),
            wrong_pictures: Gain::of(3.0),
            dark_from_s: None,
        }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            // Tada 2006, section III-A.
            pixel_mm: Millimetres::of(1.32),
            rate_hz: Hertz::of(30.0),
            // Assumed, as the rest: marks are found to a fiftieth of a pixel; an image is read out while the next is taken
            // (33 ms), and its words are 20 ms on the way.
            jitter_px: Part::of(0.02),
            delay_ms: DeadTime::of(53.0),
            teaches: false,
        }
    }
}

impl Default for Photoelastic {
    fn default() -> Self {
        Self {
            strip: true,
            // Aluminium on the strip. Assumed, as `physics::stribeck::METAL`.
            mu_s: Mu::of(0.35),
            mu_d: Mu::of(0.30),
            stribeck_mm_s: Speed::of(3.0),
            // Assumed: the head is what the object touches.
            share: Part::of(1.0),
            // Not in the paper: at 45 degrees a normal force alone gives all the light.
            polariser_deg: Degrees::of(45.0),
            // Dubey 2006, section 4: "high initial offset"; the numbers are assumed.
            dark_mv: Millivolts::of(400.0),
            span_mv: Millivolts::of(2_200.0),
            // Assumed, as the rest: glued by hand.
            spread: Part::of(0.0),
            drift: Part::of(0.02),
            ambient_mv: Millivolts::of(20.0),
            knock_mn_per_mv: Gain::of(0.05),
            noise_mv: Millivolts::of(0.5),
        }
    }
}
