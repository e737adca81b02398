//! The calibration curve of figure 14, and how far one head's curve is from the mean one.

use std::f64::consts::{PI, TAU};

use super::optics::Layer;
use crate::random::{Noise, Seeds, Source};

/// Force at the peak of figure 14, N.
pub const PEAK_N: f64 = 1.7;
/// Force at which figure 14 is back at its first value, N.
pub const BACK_N: f64 = 6.0;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Making {
    pub peak_n: f64,
    pub back_n: f64,
    pub bend: f64,
    pub dark_mv: f64,
    pub span_mv: f64,
    pub frozen_rad: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Day {
    pub source: f64,
    pub source_per_min: f64,
    pub ambient_mv: f64,
    pub aged_rad: f64,
    pub aged_optic: f64,
}

impl Making {
    pub const MEAN: Self = Self {
        peak_n: PEAK_N,
        back_n: BACK_N,
        bend: 0.0,
        // Assumed, as the next: 2.2 V of signal on an offset, read by the board's 3.3 V.
        dark_mv: 400.0,
        span_mv: 2_200.0,
        frozen_rad: 0.0,
    };

    /// A head of this seed. `spread` is the part by which force and voltages differ from the mean one, either way; what the
    /// paper says nothing of is drawn over a decade.
    pub fn drawn(seeds: Seeds, spread: f64) -> Self {
        let mut noise = Noise::new(seeds.making, Source::HeadMaking);
        let mut near = |mean: f64, part: f64| mean * noise.between(1.0 - part * spread, 1.0 + part * spread);
        let (peak_n, back_n) = (near(PEAK_N, 0.5), near(BACK_N, 0.5));
        let (dark_mv, span_mv) = (near(Self::MEAN.dark_mv, 1.0), near(Self::MEAN.span_mv, 1.0));
        // Over a decade of size, either sign.
        let bend = spread * 0.1 * noise.sign() * libm::pow(10.0, noise.between(-1.0, 0.0));
        let frozen_rad = spread * 0.5 * libm::pow(10.0, noise.between(-1.0, 0.0));
        Self { peak_n, back_n, bend, dark_mv, span_mv, frozen_rad }
    }

    /// Half the retardation under a normal force alone, rad: a quarter turn at the peak, half a turn where it is back.
    /// Equation 9 has it proportional to force, so that the curve would be back at twice the peak. Figure 14 is back at 3.5
    /// times: the phase grows as `F^0.55`, nearly that of a line contact which widens under load (Hertz: `F^0.5`).
    pub fn phase_rad(&self, normal_n: f64) -> f64 {
        let exponent = std::f64::consts::LN_2 / libm::log(self.back_n / self.peak_n);
        let turns = 0.5 * libm::pow(normal_n.max(0.0) / self.peak_n, exponent);
        PI * (turns + self.bend * libm::sin(TAU * turns))
    }
}

impl Day {
    pub const FIRST: Self =
        Self { source: 1.0, source_per_min: 0.0, ambient_mv: 0.0, aged_rad: 0.0, aged_optic: 1.0 };

    /// A day of this seed. `drift` is the part by which source and coefficient have changed at most, either way.
    pub fn drawn(seeds: Seeds, drift: f64, ambient_mv: f64) -> Self {
        let mut noise = Noise::new(seeds.noise, Source::HeadDay);
        Self {
            source: noise.between(1.0 - drift, 1.0 + drift),
            source_per_min: noise.between(-drift, drift) / 10.0,
            ambient_mv: noise.between(0.0, ambient_mv),
            aged_rad: noise.between(0.0, drift),
            aged_optic: noise.between(1.0 - drift / 2.0, 1.0 + drift / 2.0),
        }
    }
}

/// Output of the receiver's amplifier, mV, before it clips. Orientation and the share of shear in the principal stresses
/// are equations 4 to 9; the phase under a normal force alone is the head's own curve.
pub fn receiver_mv(layer: &Layer, making: &Making, day: &Day, t_s: f64, normal_n: f64, shear_n: f64) -> f64 {
    let normal_n = normal_n.max(0.0);
    // Below a millinewton there is no contact to shear.
    let shear_n = if normal_n > 1e-3 { shear_n } else { 0.0 };
    let stress = layer.stress(normal_n, shear_n);
    let stretch = if normal_n > 1e-3 { (stress.sigma_1 - stress.sigma_2) / stress.sigma_x } else { 1.0 };
    let phase_rad = day.aged_optic * making.phase_rad(normal_n) * stretch + making.frozen_rad + day.aged_rad;
    let sine = libm::sin(phase_rad);
    let source = day.source + day.source_per_min * t_s / 60.0;
    making.dark_mv + day.ambient_mv + making.span_mv * source * layer.orientation(&stress) * sine * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mv(normal_n: f64) -> f64 {
        receiver_mv(&Layer::DUBEY, &Making::MEAN, &Day::FIRST, 0.0, normal_n, 0.0)
    }

    #[test]
    fn the_curve_is_figure_14s() {
        assert_eq!(mv(0.0), 400.0);
        assert!((mv(PEAK_N) - 2_600.0).abs() < 1e-9 && (mv(BACK_N) - 400.0).abs() < 1e-9);
        let forces = |from: i32, to: i32| (from..to).map(|n| f64::from(n) / 100.0);
        assert!(forces(0, 169).all(|f| mv(f + 0.01) > mv(f)), "it rises to 1.7 N");
        assert!(forces(170, 599).all(|f| mv(f + 0.01) < mv(f)), "and falls to 6 N");
        assert!(mv(0.7) - mv(2.7) < -250.0, "not symmetric: it falls more slowly than it rises");
    }

    #[test]
    fn shear_lowers_the_peak_and_moves_it_to_a_smaller_force() {
        let sheared = |normal_n: f64| {
            receiver_mv(&Layer::DUBEY, &Making::MEAN, &Day::FIRST, 0.0, normal_n, 0.3 * normal_n)
        };
        let (at_n, peak_mv) = (1..600)
            .map(|n| f64::from(n) / 100.0)
            .map(|f| (f, sheared(f)))
            .fold((0.0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
        assert!(
            (peak_mv - 400.0 - 2_200.0 / 1.36).abs() < 1.0 && (at_n - 1.29).abs() < 0.02,
            "{at_n} {peak_mv}"
        );
    }
}
