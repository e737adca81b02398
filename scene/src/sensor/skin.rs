//! A camera behind a clear skin, as the summary that its computer sends: markers' forces, moving points, the object's angle
//! (FingerVision 2017, sections III and IV). The pictures themselves are not drawn here.

use std::collections::VecDeque;

use tenax_hal_shim::behaviour::{CameraView, MARKERS, NORMAL_STEP_MN, SHEAR_STEP_MN};

use crate::file::sections::Skin;
use crate::physics::Touch;
use crate::random::{Noise, Source};
use crate::schedule::STEP_S;

/// Markers along and across the skin.
const LONG: usize = 6;
const WIDE: usize = MARKERS / LONG;
/// Distance of two markers as a part of the contact's radius (FingerVision 2017, figure 2: about 5 mm over a contact that is
/// some 20 mm wide; assumed).
const SPACING_PART: f64 = 0.5;
/// The soft layer spreads the load over so many radii (assumed, as for the normal-force array).
const SPREADS: f64 = 1.4;
/// The part of the picture in which the object lies, times the part of its points that have an edge to be seen moving (assumed).
const TEXTURE_PART: f64 = 0.02;
const SLIPS_PX: f64 = 0.3;
/// Range of the motion that is reported in a wrong picture, in 1/10,000 of it.
const WRONG_E4: (f64, f64) = (30.0, 200.0);
/// Time constant of an error of the angle, s: where the object has the wall's colours its rims are elsewhere.
const ANGLE_LASTS_S: f64 = 2.0;
const PIXEL_MM: f64 = 0.094;

#[derive(Debug)]
pub(crate) struct SkinCamera {
    parameters: Skin,
    patch_m: f64,
    shares: [f64; MARKERS],
    noise: Noise,
    mistakes: Noise,
    is_wrong: bool,
    angle_off: f64,
    pictures: u64,
    moved_m: f64,
    under_way: VecDeque<(f64, f64, CameraView)>,
}

impl SkinCamera {
    pub(crate) fn new(parameters: &Skin, patch_mm: f64, seed: u64) -> Self {
        let share = |n: usize| {
            let place = |n: usize, of: usize| (n as f64 - (of as f64 - 1.0) / 2.0) * SPACING_PART;
            let (x, y) = (place(n % LONG, LONG), place(n / LONG, WIDE));
            (1.0 - (x * x + y * y) / (SPREADS * SPREADS)).max(0.0).sqrt()
        };
        let mut shares: [f64; MARKERS] = std::array::from_fn(share);
        let whole: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= whole);
        Self {
            parameters: parameters.clone(),
            patch_m: patch_mm / 1e3,
            shares,
            noise: Noise::new(seed, Source::Skin),
            mistakes: Noise::new(seed, Source::SkinMistakes),
            is_wrong: false,
            angle_off: 0.0,
            pictures: 0,
            moved_m: 0.0,
            under_way: VecDeque::new(),
        }
    }

    pub(crate) fn step(&mut self, t_s: f64, touch: &Touch, pitch_rad: f64) {
        // Where the object rubs, and where it turns: seen at the rim of the contact.
        self.moved_m += touch.slide_m_s.abs() * STEP_S + touch.turn_m_s.abs() * STEP_S;
        if t_s * self.parameters.rate_hz.get() < self.pictures as f64 {
            return;
        }
        self.pictures += 1;
        if self.parameters.dark_from_s.is_some_and(|dark_s| t_s >= dark_s.get()) {
            return;
        }
        let view = self.view(touch, pitch_rad);
        self.moved_m = 0.0;
        self.under_way.push_back((t_s, t_s + self.parameters.delay_ms.get() / 1e3, view));
    }

    pub(crate) fn take(&mut self, t_s: f64) -> Option<CameraView> {
        let &(taken_s, arrives_s, view) = self.under_way.front()?;
        if arrives_s > t_s {
            return None;
        }
        self.under_way.pop_front();
        Some(CameraView { age_ms: ((t_s - taken_s) * 1e3).round() as u16, ..view })
    }

    fn goes_wrong(&mut self) -> Option<f64> {
        let (part, stretch) =
            (self.parameters.wrong_part.get(), self.parameters.wrong_pictures.get().max(1.0));
        // It ends once in `stretch` pictures, and begins as often as keeps the part.
        let change = if self.is_wrong { 1.0 / stretch } else { part / (stretch * (1.0 - part).max(1e-3)) };
        self.is_wrong ^= self.mistakes.between(0.0, 1.0) < change;
        let seen_e4 = self.mistakes.between(WRONG_E4.0, WRONG_E4.1);
        self.is_wrong.then_some(seen_e4)
    }

    fn view(&mut self, touch: &Touch, pitch_rad: f64) -> CameraView {
        let noise_n = self.parameters.force_noise_mn.get() / 1e3;
        let mut steps = |part: f64, whole_n: f64, step_mn: i32, low: f64, high: f64| {
            let mn = (part * whole_n + noise_n * self.noise.normal()) * 1e3;
            (mn / f64::from(step_mn)).round().clamp(low, high)
        };
        let normal = self.shares.map(|part| steps(part, touch.normal_n, NORMAL_STEP_MN, 0.0, 254.0) as u8);
        let shear = self.shares.map(|part| steps(part, touch.shear_n, SHEAR_STEP_MN, -128.0, 127.0) as i8);
        let pixels = self.moved_m * 1e3 / PIXEL_MM;
        let speckle_e4 = self.parameters.speckle_e4.get() * self.noise.normal().abs();
        let moving_e4 = match self.goes_wrong() {
            // A spot of the background that leans on the object, or an object whose move was not found.
            Some(seen_e4) if pixels < SLIPS_PX => seen_e4,
            Some(_) => 0.0,
            None => 1e4 * TEXTURE_PART * pixels.min(1.0),
        } + speckle_e4;
        let stays = libm::exp(-1.0 / (ANGLE_LASTS_S * self.parameters.rate_hz.get()));
        self.angle_off = stays * self.angle_off + libm::sqrt(1.0 - stays * stays) * self.noise.normal();
        let degrees = pitch_rad.to_degrees() + self.parameters.angle_noise_deg.get() * self.angle_off;
        let sees = touch.normal_n > 0.0 && self.patch_m > 0.0;
        CameraView {
            age_ms: 0,
            moving_e4: moving_e4.round() as u16,
            angle_ddeg: sees.then_some((10.0 * degrees).round() as i16),
            normal,
            shear,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain_skin() -> Skin {
        crate::file::plain("", "").skin.expect("it has one")
    }

    fn views(touch: &Touch) -> Vec<CameraView> {
        let mut camera = SkinCamera::new(&plain_skin(), 5.0, 1);
        let at = |n: u32| f64::from(n) * STEP_S;
        (1..=8_000)
            .filter_map(|n| {
                camera.step(at(n), touch, 0.1);
                camera.take(at(n))
            })
            .collect()
    }

    #[test]
    fn it_sends_its_pictures_late_and_their_forces_add_up() {
        let touch = Touch { normal_n: 2.0, shear_n: 0.8, sticks: true, ..Touch::default() };
        let views = views(&touch);
        let rate_hz = plain_skin().rate_hz.get();
        assert!((views.len() as f64 - rate_hz).abs() <= 3.0, "{}", views.len());
        let all =
            |forces: &dyn Fn(&CameraView) -> f64| views.iter().map(forces).sum::<f64>() / views.len() as f64;
        let normal_n = all(&|view| view.normal.iter().map(|&n| f64::from(n)).sum::<f64>() * 0.01);
        let shear_n = all(&|view| view.shear.iter().map(|&n| f64::from(n)).sum::<f64>() * 0.02);
        assert!((normal_n - 2.0).abs() < 0.1 && (shear_n - 0.8).abs() < 0.1, "{normal_n} N, {shear_n} N");
        assert!(views.iter().all(|view| view.angle_ddeg.is_some_and(|angle| (angle - 57).abs() < 30)));
        let delay_ms = plain_skin().delay_ms.get();
        assert!(views.iter().all(|view| (f64::from(view.age_ms) - delay_ms).abs() <= 1.0));
    }

    #[test]
    fn sliding_moves_points_and_rest_hardly_any() {
        let mean = |slide_m_s| {
            let touch = Touch { normal_n: 1.0, slide_m_s, ..Touch::default() };
            let views = views(&touch);
            views.iter().map(|view| f64::from(view.moving_e4)).sum::<f64>() / views.len() as f64
        };
        assert!(mean(0.0) < 8.0 && mean(0.002) > 40.0 && mean(0.1) > 190.0);
    }
}
