//! Settings of the reflex.

use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GripConfig {
    pub slip_duty_permille: u16,
    pub slip_frames: u32,
    pub slip_frames_max: u32,
    pub incipient_duty_permille: u16,
    pub incipient_frames: u32,
    /// Longer than the motor's dead time, so that the noise of the hand's own closing is not answered by more
    /// closing.
    pub settle_frames: u32,
    pub ceiling_mn: i32,
    pub blind_frames: u32,
    pub relax: u16,
}

impl GripConfig {
    pub const fn may_relax(&self, no_wearer: bool) -> bool {
        self.relax >= if no_wearer { 1 } else { 2 }
    }
}

settings! {
    GripConfig:
    /// Normal force above which the reflex closes no further
    4 ForceCeiling "force-ceiling-mn" "mN" [3_000, 60_000] = 40_000 => Number(ceiling_mn);
    /// Motor duty of the pulse that answers slip
    23 SlipDuty "slip-duty-permille" "per mille" [400, 1_000] = 1_000 => Number(slip_duty_permille);
    /// Length of the pulse that answers slip
    24 SlipPulse "slip-pulse-ms" "ms" [10, 60] = 30 => Ms(slip_frames);
    /// Longest pulse that answers slip, while a detector still reports it
    25 SlipPulseMax "slip-pulse-max-ms" "ms" [10, 200] = 50 => Ms(slip_frames_max);
    /// Motor duty of the pulse that answers incipient slip
    26 IncipientDuty "incipient-duty-permille" "per mille" [100, 1_000] = 400 => Number(incipient_duty_permille);
    /// Length of the pulse that answers incipient slip
    27 IncipientPulse "incipient-pulse-ms" "ms" [5, 50] = 15 => Ms(incipient_frames);
    /// Time after a pulse in which no slip is answered, longer than the motor's dead time
    28 Settle "settle-ms" "ms" [40, 150] = 80 => Ms(settle_frames);
    /// Blind budget: closing time of the reflex in all while the force is unknown or an electrode is lost; a proven contraction or an empty hand renews it
    29 Blind "blind-ms" "ms" [0, 400] = 200 => Ms(blind_frames);
    /// After 5 s without slip the reflex releases the force that it added, down to what stops a sliding object: 0 never, 1 without a
    /// wearer, 2 always
    75 Relax "relax-choice" "choice" [0, 2] = 1 => Number(relax);
}
