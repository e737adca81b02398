//! A photoelastic head in the place of PVDF film 12 (Dubey 2006): one optical channel for slip and normal force.
//!
//! Under the metal strip the layer is a spring. Where friction falls with speed the strip vibrates by itself
//! ([`physics::stribeck`](crate::physics::stribeck)), its pull shears the layer, and the light flickers.

pub mod curve;
pub mod optics;

use curve::{Day, Making, receiver_mv};
use optics::Layer;

use super::front_end_v;
use crate::file::sections::{Knock, Photoelastic};
use crate::physics::Touch;
use crate::physics::stribeck::{METAL, Slider, Stribeck, StribeckSlider};
use crate::random::{Noise, Seeds, Source};
use crate::schedule::STEP_S;
use tenax_hal_shim::channel::SCANS_PER_FRAME;

/// The strip on its layer. Stiffness: a block of urethane of 9 mm x 5 mm x 3 mm in shear, E about 9 MPa. Mass and damping are assumed:
/// amplitude and frequency rise with the rate, as in figures 12 and 13.
pub const HEAD_STRIP: Slider =
    Slider { mass_kg: 0.010, stiffness_n_per_m: 10_000.0, damping_ns_per_m: 4.0, friction: METAL };

/// Noise of a frame's sample of a head without a scene, rms, mV.
const NOISE_MV: f64 = 0.5;

#[derive(Debug)]
pub struct Head {
    layer: Layer,
    making: Making,
    day: Day,
    stiffness_n_per_m: f64,
    strip: StribeckSlider,
    knocks: Vec<Knock>,
    share: f64,
    knock_mn_per_mv: f64,
    noise_mv: f64,
    noise: Noise,
    last_shear_n: f64,
}

impl Head {
    pub(crate) fn new(parameters: &Photoelastic, knocks: &[Knock], seeds: Seeds) -> Self {
        let (spread, drift) = (parameters.spread.get(), parameters.drift.get());
        let drawn = Making::drawn(seeds, spread);
        let making = Making {
            dark_mv: parameters.dark_mv.get() * drawn.dark_mv / Making::MEAN.dark_mv,
            span_mv: parameters.span_mv.get() * drawn.span_mv / Making::MEAN.span_mv,
            ..drawn
        };
        let layer = Layer { polariser_rad: parameters.polariser_deg.get().to_radians(), ..Layer::DUBEY };
        let slider = Slider { friction: friction(parameters), ..drawn_strip(seeds, spread) };
        let day = Day::drawn(seeds, drift, parameters.ambient_mv.get());
        let mut head = Self::with(layer, making, day, slider, seeds);
        head.knocks = knocks.to_vec();
        head.share = parameters.share.get();
        head.knock_mn_per_mv = parameters.knock_mn_per_mv.get();
        head.noise_mv = parameters.noise_mv.get();
        head
    }

    pub fn with(layer: Layer, making: Making, day: Day, slider: Slider, seeds: Seeds) -> Self {
        Self {
            layer,
            making,
            day,
            stiffness_n_per_m: slider.stiffness_n_per_m,
            strip: StribeckSlider::new(slider),
            knocks: Vec::new(),
            share: 1.0,
            knock_mn_per_mv: 0.0,
            noise_mv: NOISE_MV,
            noise: Noise::new(seeds.noise, Source::Head),
            last_shear_n: 0.0,
        }
    }

    pub fn step(&mut self, t_s: f64, touch: &Touch) -> f64 {
        let rings = self.knocks.iter().map(|knock| super::pvdf::ring_mv(knock, t_s, 0.0)).sum::<f64>();
        let normal_n = (self.share * touch.normal_n + rings * self.knock_mn_per_mv / 1e3).max(0.0);
        // While all of it sticks, the strip follows the object, and takes its share of the pad's shear.
        let shear_n = self.share * touch.shear_n;
        let crept_m_s =
            if touch.sticks { (shear_n - self.last_shear_n) / self.stiffness_n_per_m / STEP_S } else { 0.0 };
        self.last_shear_n = shear_n;
        self.strip.step(normal_n, touch.slide_m_s + crept_m_s, STEP_S);
        let pull_n = self.stiffness_n_per_m * self.strip.position_m();
        let mv = receiver_mv(&self.layer, &self.making, &self.day, t_s, normal_n, pull_n);
        // White over the scan rate, so that a frame's sum has the rms that was asked for.
        let noise_mv = self.noise_mv * (SCANS_PER_FRAME as f64).sqrt() * self.noise.normal();
        front_end_v(mv + noise_mv)
    }
}

fn friction(parameters: &Photoelastic) -> Stribeck {
    let mu_d = parameters.mu_d.get();
    let mu_s = if parameters.strip { parameters.mu_s.get() } else { mu_d };
    Stribeck { mu_s: mu_s.max(mu_d), mu_d, speed_m_s: parameters.stribeck_mm_s.get() / 1e3 }
}

pub fn drawn_strip(seeds: Seeds, spread: f64) -> Slider {
    let mut noise = Noise::new(seeds.making, Source::HeadStrip);
    let mut near = |mean: f64| mean * noise.between(1.0 - spread, 1.0 + spread);
    Slider {
        mass_kg: near(HEAD_STRIP.mass_kg),
        stiffness_n_per_m: near(HEAD_STRIP.stiffness_n_per_m),
        damping_ns_per_m: near(HEAD_STRIP.damping_ns_per_m),
        friction: HEAD_STRIP.friction,
    }
}
