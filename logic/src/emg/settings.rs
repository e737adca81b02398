use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GateConfig {
    pub on_mv: u16,
    pub hold_frames: u32,
    pub slowest_permille: u16,
}

settings! {
    GateConfig:
    /// Level over rest at which both muscles together give consent. Whether one muscle is active follows from its calibration
    3 EmgOn "emg-on-mv" "mV" [80, 400] = 160 => Number(on_mv);
    /// How long a muscle counts as active after its last activity
    20 EmgHold "emg-hold-ms" "ms" [100, 1_000] = 200 => Ms(hold_frames);
    /// Motor duty for the weakest contraction: the least that still moves the hand
    22 EmgSlowest "emg-slowest-permille" "per mille" [200, 1_000] = 300 => Number(slowest_permille);
}
