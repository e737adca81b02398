use super::curve::Curve;
use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeadConfig {
    pub fitted: bool,
    pub slip: u16,
    pub curve: Curve,
}

settings! {
    HeadConfig:
    /// 1: a photoelastic head is in the place of PVDF film 12
    60 Head "head-photoelastic-flag" "flag" [0, 1] = 0 => Flag(fitted);
    /// Photoelastic: threshold of the ac envelope above which it reports slip
    61 HeadSlip "head-slip-mv" "mV" [1, 100] = 2 => Mv(slip);
    /// Photoelastic calibration: voltage without load
    62 HeadDark "head-dark-mv" "mV" [50, 2_000] = 400 => MvQ4(curve.dark_q4);
    /// Photoelastic calibration: voltage at the peak
    63 HeadBright "head-bright-mv" "mV" [200, 3_300] = 2_600 => MvQ4(curve.bright_q4);
    /// Photoelastic calibration: force at 1/8 of half a turn of phase
    64 HeadForce1 "head-force-1-mn" "mN" [1, 30_000] = 136 => Number(curve.force_mn[0]);
    /// The same at 2/8
    65 HeadForce2 "head-force-2-mn" "mN" [1, 30_000] = 481 => Number(curve.force_mn[1]);
    /// The same at 3/8
    66 HeadForce3 "head-force-3-mn" "mN" [1, 30_000] = 1_007 => Number(curve.force_mn[2]);
    /// The same at 4/8, the peak
    67 HeadForce4 "head-force-4-mn" "mN" [1, 30_000] = 1_700 => Number(curve.force_mn[3]);
    /// The same at 5/8
    68 HeadForce5 "head-force-5-mn" "mN" [1, 30_000] = 2_551 => Number(curve.force_mn[4]);
    /// The same at 6/8
    69 HeadForce6 "head-force-6-mn" "mN" [1, 30_000] = 3_554 => Number(curve.force_mn[5]);
    /// The same at 7/8
    70 HeadForce7 "head-force-7-mn" "mN" [1, 30_000] = 4_706 => Number(curve.force_mn[6]);
    /// Photoelastic calibration: force at half a turn, where the voltage is back at its first value
    71 HeadForce8 "head-force-8-mn" "mN" [1, 30_000] = 6_000 => Number(curve.force_mn[7]);
}
