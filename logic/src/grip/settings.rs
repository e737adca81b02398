//! Settings of the reflex.

use crate::setting::settings;

/// Limits and pulses of the grip reflex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GripConfig {
    /// Duty of the pulse that answers slip, per mille.
    pub slip_duty_permille: u16,
    /// Length of the pulse that answers slip, frames.
    pub slip_frames: u32,
    /// Longest pulse while a detector still reports slip, frames.
    pub slip_frames_max: u32,
    /// Duty of the pulse that answers incipient slip, per mille.
    pub incipient_duty_permille: u16,
    /// Length of the pulse that answers incipient slip, frames.
    pub incipient_frames: u32,
    /// Time after a pulse in which no slip is answered, in frames: longer than the motor's dead time, so that the
    /// noise of the hand's own closing is not answered by more closing.
    pub settle_frames: u32,
    /// Load above which the reflex closes no further, mN.
    pub ceiling_mn: i32,
    /// Blind budget: closing time of the reflex in all while the force is unknown or an electrode is lost, in frames.
    pub blind_frames: u32,
    /// Whether the reflex releases force that it added: 0 never, 1 without a wearer, 2 always.
    pub relax: u16,
}

impl GripConfig {
    /// Whether `relax-choice` lets the reflex release force that it added. `no_wearer`: nobody wears the hand.
    #[must_use]
    pub const fn may_relax(&self, no_wearer: bool) -> bool {
        self.relax >= if no_wearer { 1 } else { 2 }
    }
}

settings! {
    GripConfig:
    /// Normal force above which the reflex closes no further
    4 ForceCeiling "force-ceiling-mn" "mN" [20_000, 60_000, trusted 3_000, 60_000] = 40_000 => Number(ceiling_mn);
    /// Motor duty of the pulse that answers slip
    23 SlipDuty "slip-duty-permille" "per mille" [900, 1_000, trusted 400, 1_000] = 1_000 => Number(slip_duty_permille);
    /// Length of the pulse that answers slip
    24 SlipPulse "slip-pulse-ms" "ms" [10, 60] = 30 => Ms(slip_frames);
    /// Longest pulse that answers slip, while a detector still reports it
    25 SlipPulseMax "slip-pulse-max-ms" "ms" [36, 200, trusted 10, 200] = 50 => Ms(slip_frames_max);
    /// Motor duty of the pulse that answers incipient slip
    26 IncipientDuty "incipient-duty-permille" "per mille" [380, 1_000, trusted 100, 1_000] = 400 => Number(incipient_duty_permille);
    /// Length of the pulse that answers incipient slip
    27 IncipientPulse "incipient-pulse-ms" "ms" [5, 50] = 15 => Ms(incipient_frames);
    /// Time after a pulse in which no slip is answered, longer than the motor's dead time
    28 Settle "settle-ms" "ms" [75, 85, trusted 40, 150] = 80 => Ms(settle_frames);
    /// Blind budget: closing time of the reflex in all while the force is unknown or an electrode is lost; an active muscle renews it
    29 Blind "blind-ms" "ms" [0, 400] = 200 => Ms(blind_frames);
    /// After 5 s without slip the reflex releases the force that it added, down to what stops a sliding object: 0 never, 1 without a
    /// wearer, 2 always
    75 Relax "relax-choice" "choice" [0, 2] = 1 => Number(relax);
}
