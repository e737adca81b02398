//! The normal-force array: two rows of five elements under a silicone cover (Bamshad 2023, section 2.1).

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS};

use super::front_end_v;
use crate::file::sections::Array;
use crate::physics::{TOUCH_N, Touch};
use crate::random::{Noise, Source};
use crate::schedule::FRAME_S;

/// Elements side by side.
const ROWS: usize = 2;
/// Elements along the pad.
const LONG: usize = ARRAY_COUNT / ROWS;
/// How long the cover takes to forget that an element slipped, s (assumed).
const FORGETS_S: f64 = 0.030;

/// Ten shares of one load.
///
/// The weight that hangs on the pad tilts the load along it, torsion tilts it across the diagonal, and each element slip
/// moves some of it from one element to the others: the sum stays, the covariance changes, which is all that the
/// detector of Bamshad 2023 (section 4) has to go by.
#[derive(Debug)]
pub(crate) struct Elements {
    parameters: Array,
    patch_m: f64,
    elements: [Element; ARRAY_COUNT],
    noise: Noise,
    slips: Noise,
}

#[derive(Clone, Copy, Debug)]
struct Element {
    gain: f64,
    offset_mv: f64,
    /// Across and along the pad, -1 to 1.
    across: f64,
    along: f64,
    moved_n: f64,
}

impl Elements {
    pub(crate) fn new(parameters: &Array, patch_radius_mm: f64, seed: u64) -> Self {
        let mut making = Noise::new(seed, Source::ArrayMaking);
        let spread = parameters.spread.get();
        let element = |n: usize| Element {
            gain: making.between(1.0 - spread, 1.0 + spread),
            offset_mv: making.between(0.0, parameters.offset_mv.get()),
            across: if n / LONG == 0 { -1.0 } else { 1.0 },
            along: (n % LONG) as f64 * 2.0 / (LONG - 1) as f64 - 1.0,
            moved_n: 0.0,
        };
        Self {
            parameters: parameters.clone(),
            patch_m: patch_radius_mm / 1e3,
            elements: std::array::from_fn(element),
            noise: Noise::new(seed, Source::Array),
            slips: Noise::new(seed, Source::ArraySlips),
        }
    }

    /// Voltages at the pins after one frame. `released_n` is the shear that was let go during it.
    pub(crate) fn step(&mut self, touch: &Touch, released_n: f64) -> [f64; ARRAY_COUNT] {
        self.slip(touch, released_n);
        let p = &self.parameters;
        let pressed = touch.normal_n > TOUCH_N;
        // Both as parts of the load: the shear, and the torsion over the patch's radius.
        let (weight, twist) = if pressed {
            (touch.shear_n / touch.normal_n, touch.torque_nm / (self.patch_m * touch.normal_n))
        } else {
            (0.0, 0.0)
        };
        let moved_n = self.elements.iter().map(|element| element.moved_n).sum::<f64>() / ARRAY_COUNT as f64;
        let mut pins = [0.0; ARRAY_COUNT];
        for (n, element) in self.elements.iter().enumerate() {
            let tilt = p.tilt.get() * (weight * element.along + twist * element.across * element.along);
            let share_n = touch.normal_n / ARRAY_COUNT as f64 * (1.0 + tilt) + element.moved_n - moved_n;
            let read_mv = p.mv_per_n.get() * element.gain * share_n.max(0.0) + element.offset_mv;
            let rest_mv = f64::from(CHANNELS[ARRAY + n].rest_mv);
            pins[n] = front_end_v(rest_mv + read_mv + p.noise_mv.get() * self.noise.normal());
        }
        pins
    }

    /// Each element that lets go moves load; sliding does so all the time.
    fn slip(&mut self, touch: &Touch, released_n: f64) {
        let keeps = libm::exp(-FRAME_S / FORGETS_S);
        for element in &mut self.elements {
            element.moved_n *= keeps;
        }
        let part = self.parameters.slip_part.get();
        if released_n > 0.0 {
            let which = self.slips.between(0.0, ARRAY_COUNT as f64) as usize;
            self.elements[which.min(ARRAY_COUNT - 1)].moved_n -= part * released_n;
        }
        if !touch.sticks && touch.normal_n > TOUCH_N && touch.rub_m_s() > 0.0 {
            let step_n = part * touch.drop_n / ARRAY_COUNT as f64 * (1.0 - keeps * keeps).sqrt();
            for element in &mut self.elements {
                element.moved_n += step_n * self.slips.normal();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::quantity::{Millivolts, Part};

    const HELD: Touch = Touch {
        normal_n: 5.0,
        shear_n: 0.0,
        slide_m_s: 0.0,
        turn_m_s: 0.0,
        torque_nm: 0.0,
        sticks: true,
        stuck_part: 1.0,
        let_go: 0,
        released_n: 0.0,
        drop_n: 0.5,
    };

    fn quiet() -> Elements {
        let off = Millivolts::of(0.0);
        let parameters = Array { noise_mv: off, offset_mv: off, spread: Part::of(0.0), ..Array::default() };
        Elements::new(&parameters, 5.0, 1)
    }

    fn newtons(elements: &mut Elements, touch: Touch, released_n: f64) -> [f64; ARRAY_COUNT] {
        elements.step(&touch, released_n).map(|volts| (volts * 1e3 - 200.0) / 200.0)
    }

    #[test]
    fn the_shares_add_up_to_the_load_whatever_moves_them() {
        let slides = Touch { sticks: false, slide_m_s: 0.01, shear_n: 2.0, torque_nm: 0.004, ..HELD };
        for (touch, released_n) in [(HELD, 0.0), (HELD, 0.5), (slides, 0.5)] {
            let sum: f64 = newtons(&mut quiet(), touch, released_n).iter().sum();
            assert!((sum - 5.0).abs() < 1e-9, "{sum} N");
        }
    }

    #[test]
    fn weight_tilts_it_along_the_pad_and_torsion_across_the_diagonal() {
        let hangs = newtons(&mut quiet(), Touch { shear_n: 2.0, ..HELD }, 0.0);
        assert!(hangs[4] > hangs[0] && hangs[9] > hangs[5] && (hangs[0] - hangs[5]).abs() < 1e-12);
        let twisted = newtons(&mut quiet(), Touch { torque_nm: 0.004, ..HELD }, 0.0);
        assert!(twisted[9] > twisted[5] && twisted[4] < twisted[0]);
    }

    #[test]
    fn sliding_makes_the_shares_wander_and_sticking_does_not() {
        let wander = |touch: Touch| {
            let mut elements = quiet();
            let shares: Vec<f64> = (0..2_000).map(|_| newtons(&mut elements, touch, 0.0)[3]).collect();
            let mean = shares.iter().sum::<f64>() / 2_000.0;
            (shares.iter().map(|share| (share - mean).powi(2)).sum::<f64>() / 2_000.0).sqrt()
        };
        assert!(wander(HELD) < 1e-12);
        assert!(wander(Touch { sticks: false, slide_m_s: 0.01, ..HELD }) > 0.005);
    }
}
