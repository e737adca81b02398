//! The force sensing resistor with its four quadrants under the tilting element (Prosthesis, figures 1 and 2).

use tenax_hal_shim::channel::FSR_COUNT;
use tenax_hal_shim::front_end::{FSR_TILT, fsr_mv, fsr_quadrants_n};

use super::front_end_v;
use crate::file::sections::Fsr;
use crate::physics::Touch;
use crate::random::{Noise, Source};
use crate::schedule::LowPass;

/// The middle of a quadrant beside the pad's, mm: a quarter of 18 mm (Prosthesis, section 2).
const QUADRANT_MM: f64 = 4.5;

/// Four quadrants: gain, tilt, hysteresis, creep, and the power law between force and conductance.
#[derive(Debug)]
pub(crate) struct Quadrants {
    hysteresis: f64,
    creep: f64,
    gains: [f64; FSR_COUNT],
    /// Moment of the load, as shear for 1 N of it.
    aside: [f64; 2],
    noise_part: f64,
    noise: Noise,
    quadrants: [Quadrant; FSR_COUNT],
}

#[derive(Clone, Copy, Debug)]
struct Quadrant {
    followed_n: f64,
    crept: LowPass,
}

impl Quadrants {
    pub(crate) fn new(parameters: &Fsr, seed: u64) -> Self {
        let crept = LowPass::of_frames(parameters.creep_s.get());
        Self {
            hysteresis: parameters.hysteresis.get(),
            creep: parameters.creep.get(),
            gains: parameters.gains.map(|gain| gain.get()),
            aside: parameters.aside_mm.map(|mm| mm.get() / QUADRANT_MM / FSR_TILT),
            noise_part: parameters.noise.get(),
            noise: Noise::new(seed, Source::Fsr),
            quadrants: [Quadrant { followed_n: 0.0, crept }; FSR_COUNT],
        }
    }

    pub(crate) fn step(&mut self, touch: &Touch, pressed_n: [f64; FSR_COUNT]) -> [f64; FSR_COUNT] {
        let [along, across] = self.aside.map(|part| part * touch.normal_n);
        let loads_n = fsr_quadrants_n(touch.normal_n, touch.shear_n + along, across);
        let draws: [f64; FSR_COUNT] = self.noise.normals();
        let mut pins = [0.0; FSR_COUNT];
        for (n, quadrant) in self.quadrants.iter_mut().enumerate() {
            let force_n = (loads_n[n] + pressed_n[n]).max(0.0);
            let play_n = self.hysteresis * force_n;
            quadrant.followed_n = quadrant.followed_n.clamp(force_n - play_n, force_n + play_n);
            let read_n = quadrant.followed_n + self.creep * quadrant.crept.step(quadrant.followed_n);
            let read_n = read_n * self.gains[n] * (1.0 + self.noise_part * draws[n]);
            pins[n] = front_end_v(fsr_mv(read_n, libm::pow));
        }
        pins
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(quadrants: &mut Quadrants, normal_n: f64) -> f64 {
        quadrants.step(&Touch { normal_n, ..Touch::default() }, [0.0; FSR_COUNT])[0]
    }

    #[test]
    fn unloading_reads_more_than_loading_at_the_same_force() {
        let mut quadrants = Quadrants::new(&crate::file::plain("", "").fsr, 1);
        let loading = settled(&mut quadrants, 5.0);
        settled(&mut quadrants, 20.0);
        let unloading = settled(&mut quadrants, 5.0);
        assert!(unloading > loading * 1.02 && unloading < loading * 1.08, "{loading} V, then {unloading} V");
    }

    #[test]
    fn a_load_beside_the_middle_reads_as_shear_and_a_gain_as_load() {
        let touch = Touch { normal_n: 8.0, shear_n: 1.0, ..Touch::default() };
        let read = |then: &str, touch: &Touch| {
            let fsr = crate::file::plain("", then).fsr;
            Quadrants::new(&fsr, 1).step(touch, [0.0; FSR_COUNT])
        };
        let plain = read("", &touch);
        let sheared = Touch { shear_n: 3.0, ..touch };
        assert_eq!(read("[fsr]\naside_mm = [1.125, 0]", &touch), read("", &sheared));
        let [more, same, ..] = read("[fsr]\ngains = [1.25, 1, 1, 1]", &touch);
        assert!(more > plain[0] && same == plain[1]);
    }

    #[test]
    fn a_lasting_load_creeps_up_and_the_unloaded_sensor_comes_back() {
        let mut quadrants = Quadrants::new(&crate::file::plain("", "").fsr, 1);
        let first = settled(&mut quadrants, 5.0);
        (0..2_000 * 20).for_each(|_| _ = settled(&mut quadrants, 5.0));
        let later = settled(&mut quadrants, 5.0);
        let more = (later - 0.2) / (first - 0.2);
        assert!((1.02..1.03).contains(&more), "{first} V, then {later} V");
        (0..2_000 * 100).for_each(|_| _ = settled(&mut quadrants, 0.0));
        assert!((settled(&mut quadrants, 0.0) - 0.2).abs() < 1e-3);
    }
}
