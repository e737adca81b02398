use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VibrationConfig {
    pub s1: u16,
    pub impact_level: u16,
    /// Real slip onsets stay below 300 per mille, a shaken rig reaches 2500.
    pub impact_permille: u16,
    pub impact_frames: u32,
    pub mains_60_hz: bool,
}

settings! {
    VibrationConfig:
    /// S1: threshold of a PVDF channel's vibration envelope above which it reports slip
    1 S1 "s1-mv" "mV" [20, 1_500] = 100 => Mv(s1);
    /// Least vibration above the slip band that counts as an impact
    6 ImpactLevel "impact-level-mv" "mV" [10, 300] = 20 => Mv(impact_level);
    /// Vibration is an impact if its envelope above the slip band exceeds this part of the one inside it
    7 ImpactRatio "impact-ratio-permille" "per mille" [300, 3_000] = 500 => Number(impact_permille);
    /// Longest impact; vibration that lasts longer is slip
    8 ImpactLength "impact-ms" "ms" [5, 100] = 45 => Ms(impact_frames);
    /// Mains hum that is removed from the PVDF films: 0 for 50 Hz, 1 for 60 Hz
    73 Mains60Hz "mains-60-hz-flag" "flag" [0, 1] = 0 => Flag(mains_60_hz);
}
