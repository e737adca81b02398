//! Equations 3 to 9 of Dubey 2006, as printed, with the sensor's dimensions.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    pub breadth_m: f64,
    pub thickness_m: f64,
    pub wavelength_m: f64,
    pub stress_optic_m2_n: f64,
    pub polariser_rad: f64,
}

impl Layer {
    /// The enhanced sensor: 9 mm x 5 mm x 3 mm, sensing area 9 mm x 3 mm, 850 nm (section 3).
    pub const DUBEY: Self = Self {
        breadth_m: 9e-3,
        thickness_m: 3e-3,
        wavelength_m: 850e-9,
        // Not in the paper. This one puts equation 9's first peak at figure 14's 1.7 N; handbooks give 3e-9 for urethane
        // rubber.
        stress_optic_m2_n: 850e-9 * 9e-3 / (2.0 * 1.7),
        // Not in the paper. At 45 degrees a normal force alone gives the whole intensity.
        polariser_rad: std::f64::consts::FRAC_PI_4,
    };

    pub fn area_m2(&self) -> f64 {
        self.breadth_m * self.thickness_m
    }

    /// Equations 3, 4 and 6 to 8: plane stress under a normal and a shear force.
    pub fn stress(&self, normal_n: f64, shear_n: f64) -> Stress {
        let (sigma_x, tau_xy) = (normal_n / self.area_m2(), shear_n / self.area_m2());
        let root = libm::sqrt(sigma_x * sigma_x + 4.0 * tau_xy * tau_xy);
        let twice_alpha = if root > 0.0 { libm::asin(2.0 * tau_xy / root) } else { 0.0 };
        Stress {
            sigma_x,
            tau_xy,
            sigma_1: sigma_x / 2.0 + root / 2.0,
            sigma_2: sigma_x / 2.0 - root / 2.0,
            alpha_rad: twice_alpha / 2.0,
        }
    }

    /// The argument of equation 9's second sine: half the retardation, rad.
    pub fn phase_rad(&self, stress: &Stress) -> f64 {
        std::f64::consts::PI * self.thickness_m * (stress.sigma_1 - stress.sigma_2) * self.stress_optic_m2_n
            / self.wavelength_m
    }

    pub fn orientation(&self, stress: &Stress) -> f64 {
        let sine = libm::sin(2.0 * (self.polariser_rad - stress.alpha_rad));
        sine * sine
    }

    pub fn intensity(&self, normal_n: f64, shear_n: f64) -> f64 {
        let stress = self.stress(normal_n, shear_n);
        let sine = libm::sin(self.phase_rad(&stress));
        self.orientation(&stress) * sine * sine
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stress {
    /// Along the normal force. The paper counts compression as positive.
    pub sigma_x: f64,
    pub tau_xy: f64,
    pub sigma_1: f64,
    pub sigma_2: f64,
    pub alpha_rad: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_printed_it_peaks_at_the_fold_and_is_back_at_twice_the_force_not_at_6_n() {
        let at = |normal_n| Layer::DUBEY.intensity(normal_n, 0.0);
        assert!((at(1.7) - 1.0).abs() < 1e-12 && at(0.0) == 0.0);
        assert!(at(3.4) < 1e-12, "equation 9 is symmetric about its peak; figure 14 is not");
    }
}
