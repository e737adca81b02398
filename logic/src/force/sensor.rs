//! Normal and tangential force from the four quadrants (Prosthesis, section 4). The paper's `Fn = sqrt(A^2 +
//! B^2 + C^2 + D^2)`, times two, is exact for an even load; under a shear a true ratio r reads `r / sqrt(1 +
//! r^2)`, and S2 is on this scale. Decisions on a force use the load, the sum of the quadrants.

use tenax_hal_shim::channel::FSR_COUNT;
use tenax_hal_shim::wire::Forces;

use super::contact::Contact;
use super::drift::{Cells, Drift};
use super::fsr::{force_mn, uv_above_rest};

pub const ZERO_LIMIT_UV: i32 = 60_000;
pub(crate) const CARRIES_MN: i32 = 15;
/// Quadrants that have to carry a load. A shear along a diagonal may unload one.
const AGREEING: usize = 3;
const FOLLOWED_IN: i32 = 64;

#[derive(Clone, Debug, Default)]
pub struct ForceSensor {
    zero_uv: [i32; FSR_COUNT],
    drift_uv: [i32; FSR_COUNT],
    last_uv: [i32; FSR_COUNT],
    drift: Drift,
    contact: Contact,
}

impl ForceSensor {
    /// One 14-bit sample of each quadrant A, B, C, D. `loaded_mn`: load from which Ft/Fn is valid. `opened`:
    /// the motor has opened the hand since it last closed it. None once the quadrants have drifted too far.
    pub fn process(
        &mut self,
        samples: [u16; FSR_COUNT],
        loaded_mn: i32,
        opened: bool,
        closes: bool,
    ) -> Option<Forces> {
        self.last_uv = samples.map(uv_above_rest);
        let read_mn = self.quadrants();
        match self.drift.step(read_mn, loaded_mn, opened) {
            Cells::Known(quadrant_mn) => {
                self.contact.feel(quadrant_mn, loaded_mn, closes);
                let mut forces = forces(self.contact.centred(quadrant_mn), loaded_mn);
                // The shear is as uncertain as the drift is large: what drifts with it cannot be told from the object's.
                let is_doubted =
                    self.drift.doubted() != 0 || self.drift.is_contradicted(read_mn, forces.load_mn);
                if carrying(&quadrant_mn) < AGREEING || is_doubted {
                    forces.ratio_permille = None;
                }
                Some(forces)
            }
            Cells::Sunk => None,
        }
    }

    pub const fn doubted(&self) -> u8 {
        self.drift.doubted()
    }

    pub fn think(&mut self, loaded_mn: i32, still: u32) {
        self.drift.think(self.quadrants(), loaded_mn, still);
    }

    /// mN, from the zero; a quadrant that drifts is not corrected.
    pub fn quadrants(&self) -> [i32; FSR_COUNT] {
        core::array::from_fn(|n| force_mn(self.last_uv[n] - self.zero_uv[n] - self.drift_uv[n]))
    }

    /// False, and nothing changed, if a quadrant is beyond [`ZERO_LIMIT_UV`].
    #[must_use]
    pub fn zero(&mut self) -> bool {
        let unloaded = self.last_uv.iter().all(|uv| uv.abs() <= ZERO_LIMIT_UV);
        if unloaded {
            self.zero_uv = self.last_uv;
            self.drift_uv = [0; FSR_COUNT];
            self.drift = Drift::default();
        }
        unloaded
    }

    pub fn follow(&mut self) {
        for ((drift, zero), &uv) in self.drift_uv.iter_mut().zip(&self.zero_uv).zip(&self.last_uv) {
            if uv.abs() <= ZERO_LIMIT_UV {
                // Rounded away from 0, so that the last microvolts are followed too.
                let off = uv - zero - *drift;
                *drift += (off + off.signum() * (FOLLOWED_IN - 1)) / FOLLOWED_IN;
            }
        }
    }

    pub const fn zero_uv(&self) -> &[i32; FSR_COUNT] {
        &self.zero_uv
    }

    pub const fn restore_zero(&mut self, zero_uv: [i32; FSR_COUNT]) {
        self.zero_uv = zero_uv;
    }
}

/// Prosthesis, section 4. Quadrants A to D, each 0 to 24 000 mN. Ft/Fn is None for a load below `loaded_mn`.
pub fn forces([a, b, c, d]: [i32; FSR_COUNT], loaded_mn: i32) -> Forces {
    let fn_mn = 2 * root([a, b, c, d]);
    let fx_mn = (a + b) - (c + d);
    let fy_mn = (a + d) - (c + b);
    let ft_mn = root([fx_mn, fy_mn]);
    let load_mn = a + b + c + d;
    let ratio_permille = (load_mn >= loaded_mn.max(1) && carrying(&[a, b, c, d]) >= AGREEING && fn_mn > 0)
        .then(|| (i64::from(ft_mn) * 1_000 / i64::from(fn_mn)).min(i64::from(u16::MAX)) as u16);
    Forces { fn_mn, fx_mn, fy_mn, ft_mn, load_mn, ratio_permille }
}

fn carrying(cells: &[i32; FSR_COUNT]) -> usize {
    cells.iter().filter(|&&mn| mn >= CARRIES_MN).count()
}

/// Root of the sum of squares, rounded down; exact, where micromath's is off by up to 6.1 %.
fn root<const N: usize>(values: [i32; N]) -> i32 {
    // Unsigned: core's root of a signed number would panic below 0.
    let squares: u64 = values.iter().map(|&value| u64::from(value.unsigned_abs()).pow(2)).sum();
    squares.isqrt() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::channel::sample_from_mv;
    use tenax_hal_shim::front_end::{FSR_REST_MV, fsr_mv, fsr_quadrants_n};

    #[test]
    fn formulas_against_f64() {
        for quadrants in
            [[0; 4], [1, 0, 0, 0], [1_000; 4], [23_630, 0, 0, 23_630], [23_630; 4], [7, 11, 13, 17]]
        {
            let [a, b, c, d] = quadrants.map(f64::from);
            let f = forces(quadrants, 600);
            let exact_fn = 2.0 * (a * a + b * b + c * c + d * d).sqrt();
            let (fx, fy) = ((a + b) - (c + d), (a + d) - (c + b));
            assert!((f64::from(f.fn_mn) - exact_fn).abs() <= 2.0);
            assert_eq!((f64::from(f.fx_mn), f64::from(f.fy_mn)), (fx, fy));
            assert!((f64::from(f.ft_mn) - fx.hypot(fy)).abs() <= 1.0);
        }
    }

    #[test]
    fn a_known_ratio_is_read_on_the_papers_scale() {
        for (normal, shear) in [(4.0, 0.4), (4.0, 1.2), (12.0, 6.0), (2.0, 1.4)] {
            let samples = fsr_quadrants_n(normal, shear, 0.0)
                .map(|f| sample_from_mv(fsr_mv(f, f64::powf).round() as u32));
            let read = f64::from(
                ForceSensor::default().process(samples, 600, false, false).unwrap().ratio_permille.unwrap(),
            ) / 1e3;
            let true_ratio: f64 = shear / normal;
            let expected = true_ratio / true_ratio.hypot(1.0);
            assert!((read - expected).abs() < 0.02, "{normal} N, {shear} N: {read} for {expected}");
        }
    }

    #[test]
    fn one_quadrant_by_itself_is_no_load_and_no_shear() {
        let alone = forces([300, 0, 0, 0], 600);
        assert_eq!((alone.load_mn, alone.ratio_permille), (300, None), "{alone:?}");
        assert_eq!(forces([2_000, 0, 0, 0], 600).ratio_permille, None);
        assert!(forces([500, 300, 300, 0], 600).ratio_permille.is_some(), "a shear along a diagonal");
    }

    #[test]
    fn an_offset_is_followed_while_the_hand_is_open_and_a_press_is_not() {
        for mv in [10, 45, -20] {
            let mut sensor = ForceSensor::default();
            let offset = sample_from_mv((FSR_REST_MV as i32 + mv) as u32);
            for _ in 0..80 * 6 {
                sensor.process([offset; 4], 600, false, false);
                sensor.follow();
            }
            assert!(sensor.process([offset; 4], 600, false, false).unwrap().load_mn <= 8, "{mv} mV");
            assert_eq!(sensor.zero_uv(), &[0; 4], "what is kept stays as it was calibrated");
            let pressed = sample_from_mv((FSR_REST_MV as i32 + mv + 200) as u32);
            let before = sensor.process([pressed; 4], 600, false, false);
            (0..800).for_each(|_| sensor.follow());
            assert_eq!(sensor.process([pressed; 4], 600, false, false), before);
        }
    }

    #[test]
    fn a_quadrant_that_is_cut_gives_no_ratio_and_one_that_a_shear_lifts_does() {
        let read = |sensor: &mut ForceSensor, cells_mv: [f64; FSR_COUNT]| {
            let samples = cells_mv.map(|mv| sample_from_mv(mv.round() as u32));
            let forces = sensor.process(samples, 600, false, false).unwrap();
            sensor.think(600, 100);
            forces.ratio_permille
        };
        let [held, sheared] = [1.0, 7.0].map(|shear| {
            fsr_quadrants_n(8.0, shear / 2f64.sqrt(), shear / 2f64.sqrt()).map(|f| fsr_mv(f, f64::powf))
        });
        assert!(sheared.contains(&FSR_REST_MV.into()) && !held.contains(&FSR_REST_MV.into()));
        for cut in 0..FSR_COUNT {
            let mut sensor = ForceSensor::default();
            assert!((0..80).all(|_| read(&mut sensor, held).is_some()));
            let mut blinks = held;
            blinks[cut] = FSR_REST_MV.into();
            assert!((0..16).all(|_| read(&mut sensor, blinks).is_none()), "{cut}");
            assert!(read(&mut sensor, held).is_some() && read(&mut sensor, sheared).is_some(), "{cut}");
        }
    }

    // Shows R6.
    #[test]
    fn only_an_unloaded_finger_is_zeroed() {
        let mut sensor = ForceSensor::default();
        let offset = sample_from_mv(FSR_REST_MV + 30);
        assert!(sensor.process([offset; 4], 600, false, false).unwrap().fn_mn > 0);
        assert!(sensor.zero());
        assert_eq!(sensor.process([offset; 4], 600, false, false).unwrap().fn_mn, 0);
        sensor.process([sample_from_mv(FSR_REST_MV + 300); 4], 600, false, false);
        assert!(!sensor.zero());
    }
}
