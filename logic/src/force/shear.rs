//! Direction of the shear, in which Tada 2006 has the object slip.

use micromath::F32Ext;
use tenax_hal_shim::wire::Forces;

/// Angle of the shear, mrad from x towards y, within 4 of the true one. None while there is no ratio.
pub fn shear_mrad(forces: Option<&Forces>) -> Option<i16> {
    let forces = forces.filter(|forces| forces.ratio_permille.is_some())?;
    // By its trait: on a PC `f32` has one of its own, which rounds otherwise.
    Some((F32Ext::atan2(forces.fy_mn as f32, forces.fx_mn as f32) * 1_000.0) as i16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_that_of_f64_within_4_mrad() {
        let of = |fx_mn, fy_mn| {
            let forces = Forces { fx_mn, fy_mn, ratio_permille: Some(300), ..Forces::default() };
            shear_mrad(Some(&forces)).unwrap()
        };
        let mut worst: f64 = 0.0;
        for n in 0..62_832 {
            for ft_mn in [20.0, 700.0, 94_000.0] {
                let (y, x) = (f64::from(n) / 1e4).sin_cos();
                let (fx_mn, fy_mn) = ((ft_mn * x) as i32, (ft_mn * y) as i32);
                let off = f64::from(of(fx_mn, fy_mn)) - 1e3 * f64::from(fy_mn).atan2(fx_mn.into());
                // Both are angles of a circle: -pi is pi.
                worst = worst.max(off.abs().min((off.abs() - 2e3 * std::f64::consts::PI).abs()));
            }
        }
        assert!((2.0..4.0).contains(&worst), "{worst} mrad");
        let right = [of(500, 0), of(0, 500), of(-500, 0), of(0, -500)];
        assert_eq!(right, [0, 1_570, 3_141, -1_570]);
        assert_eq!(shear_mrad(Some(&Forces::default())), None, "no ratio");
    }
}
