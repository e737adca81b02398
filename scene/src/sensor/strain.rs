//! Strain gauges in the soft fingertip: each in its own random place and depth (Tada 2006, section III-A, figure 4).

use tenax_hal_shim::channel::{CHANNELS, STRAIN, STRAIN_COUNT};

use super::front_end_v;
use crate::file::sections::Strain;
use crate::physics::Touch;
use crate::random::{Noise, Seeds, Source};
use crate::schedule::FRAME_S;
use crate::schedule::LowPass;

/// Twelve foil gauges, half of them in each layer.
///
/// A gauge feels the normal pressure and the shear of its own place in some mixture, so some only ever read the grasping
/// force and others the friction, with either sign (Tada 2006, figure 6 d and f). Where the contact slides, the shear of
/// a place falls with the pressure there; where it sticks, it is that of the whole: the brush's two zones.
#[derive(Debug)]
pub(crate) struct Gauges {
    noise_mv: f64,
    creep: f64,
    gauges: [Gauge; STRAIN_COUNT],
    noise: Noise,
}

#[derive(Clone, Copy, Debug)]
struct Gauge {
    /// Pressure here over the mean: Hertz, evened out by depth.
    pressure: f64,
    depth: f64,
    normal_mv_per_n: f64,
    shear_mv_per_n: f64,
    offset_mv: f64,
    drift_mv_per_s: f64,
    crept: LowPass,
}

impl Gauges {
    pub(crate) fn new(parameters: &Strain, seeds: Seeds) -> Self {
        let mut making = Noise::new(seeds.making, Source::StrainMaking);
        let gauge = |n: usize| {
            // Evenly over the area: the square of the radius is even.
            let height = (1.0 - making.between(0.0, 1.0)).sqrt();
            let depth = making.between(0.0, 0.5) + if n < STRAIN_COUNT / 2 { 0.0 } else { 0.5 };
            let turn = making.between(0.0, std::f64::consts::TAU);
            let spread = parameters.spread.get();
            let gain = making.between(1.0 - spread, 1.0 + spread) / (1.0 + depth);
            let either = |making: &mut Noise, most: f64| making.between(-most, most);
            Gauge {
                pressure: mixed(1.5 * height, depth),
                depth,
                normal_mv_per_n: gain * parameters.normal_mv_per_n.get() * libm::cos(turn).abs(),
                shear_mv_per_n: gain * parameters.shear_mv_per_n.get() * libm::sin(turn),
                offset_mv: either(&mut making, parameters.offset_mv.get()),
                drift_mv_per_s: either(&mut making, parameters.drift_mv_per_min.get()) / 60.0,
                crept: LowPass::of_frames(parameters.creep_s.get()),
            }
        };
        Self {
            noise_mv: parameters.noise_mv.get(),
            creep: parameters.creep.get(),
            gauges: std::array::from_fn(gauge),
            noise: Noise::new(seeds.noise, Source::Strain),
        }
    }

    pub(crate) fn step(&mut self, touch: &Touch) -> [f64; STRAIN_COUNT] {
        // s of the brush, and what makes its two zones add up to the shear: the mean of min(s, w) over the patch.
        let slid = (1.0 - touch.stuck_part).max(0.0).sqrt();
        let mean = slid * (1.0 - slid * slid / 3.0);
        let mut pins = [0.0; STRAIN_COUNT];
        let draws: [f64; STRAIN_COUNT] = self.noise.normals();
        for (n, gauge) in self.gauges.iter_mut().enumerate() {
            let shear =
                if slid > 0.0 { mixed((gauge.pressure / 1.5).min(slid) / mean, gauge.depth) } else { 1.0 };
            let felt_mv = gauge.normal_mv_per_n * gauge.pressure * touch.normal_n
                + gauge.shear_mv_per_n * shear * touch.shear_n;
            gauge.offset_mv += gauge.drift_mv_per_s * FRAME_S;
            let read_mv = felt_mv + self.creep * gauge.crept.step(felt_mv) + gauge.offset_mv;
            let rest_mv = f64::from(CHANNELS[STRAIN + n].rest_mv);
            pins[n] = front_end_v(rest_mv + read_mv + self.noise_mv * draws[n]);
        }
        pins
    }
}

fn mixed(local: f64, depth: f64) -> f64 {
    1.0 + (local - 1.0) * (1.0 - depth / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quiet() -> Strain {
        use crate::file::quantity::Millivolts;
        let off = Millivolts::of(0.0);
        Strain { noise_mv: off, offset_mv: off, drift_mv_per_min: off, ..crate::file::plain("", "").strain }
    }

    fn above_rest_mv(gauges: &mut Gauges, touch: Touch) -> [f64; STRAIN_COUNT] {
        gauges.step(&touch).map(|volts| volts * 1e3 - 1_650.0)
    }

    #[test]
    fn some_feel_the_grasp_and_others_the_friction_with_either_sign() {
        let stuck = Touch { stuck_part: 1.0, ..Touch::default() };
        let mut gauges = Gauges::new(&quiet(), 3.into());
        let up = above_rest_mv(&mut gauges, Touch { normal_n: 4.0, shear_n: 1.5, ..stuck });
        let down = above_rest_mv(&mut gauges, Touch { normal_n: 4.0, shear_n: -1.5, ..stuck });
        let normal = (0..STRAIN_COUNT).filter(|&n| up[n] > 0.0 && down[n] > 0.0).count();
        let shear = (0..STRAIN_COUNT).filter(|&n| up[n] * down[n] < 0.0).count();
        assert!(normal >= 3 && shear >= 3, "{normal} of the grasp, {shear} of the friction");
    }
}
