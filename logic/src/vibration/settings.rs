//! What can be chosen about S1.

use crate::setting::settings;

/// Thresholds of the vibration detector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VibrationConfig {
    /// S1: envelope that means slip, in samples (14 bits).
    pub s1: u16,
    /// Envelope above the slip band that an impact has at least, in samples (14 bits).
    pub impact_level: u16,
    /// A vibration whose envelope above the slip band is more than this part of the one inside it, per mille, is a
    /// impact. On real recordings slip onsets stay below 300, a shaken rig reaches 2500.
    pub impact_permille: u16,
    /// An impact is over after this long, in frames; what lasts longer is slip whatever it sounds like.
    pub impact_frames: u32,
    /// Whether the mains is at 60 Hz, not 50.
    pub mains_60_hz: bool,
}

settings! {
    VibrationConfig:
    /// S1: vibration envelope of a PVDF channel that means slip
    1 S1 "s1-mv" "mV" [30, 150, trusted 20, 1_500] = 100 => Mv(s1);
    /// Vibration above the slip band that an impact has at least
    6 ImpactLevel "impact-level-mv" "mV" [10, 100, trusted 10, 300] = 20 => Mv(impact_level);
    /// A vibration with more than this part of its envelope above the slip band is an impact
    7 ImpactRatio "impact-ratio-permille" "per mille" [300, 1_000, trusted 300, 3_000] = 500 => Number(impact_permille);
    /// An impact is over after this long; what lasts longer is slip
    8 ImpactLength "impact-ms" "ms" [20, 80, trusted 5, 100] = 45 => Ms(impact_frames);
    /// The mains, whose hum is taken off the PVDF films, is at 60 Hz (1), not at 50 (0)
    73 Mains60Hz "mains-60-hz-flag" "flag" [0, 1] = 0 => Flag(mains_60_hz);
}
