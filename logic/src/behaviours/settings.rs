use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BehaviourConfig {
    pub duty_permille: u16,
    pub movement_frames: u32,
    pub wait_frames: u32,
    pub gentle_score: u16,
    pub changed_cells: u16,
    pub moving_e4: u16,
    pub turn_lead_frames: u32,
}

settings! {
    BehaviourConfig:
    /// Behaviours: motor duty of their movements
    50 BehaviourDuty "behaviour-duty-permille" "per mille" [50, 300] = 100 => Number(duty_permille);
    /// Behaviours: length of a small movement
    51 BehaviourMovement "behaviour-movement-ms" "ms" [2, 50] = 10 => Ms(movement_frames);
    /// Behaviours: pause after a small movement (FingerVision 2017, section II-D)
    52 BehaviourWait "behaviour-wait-ms" "ms" [20, 500] = 100 => Ms(wait_frames);
    /// Gentle grasp: sum of the skin cells' scores above which the object is held (FingerVision 2017, section II-A)
    53 GentleScore "gentle-score-points" "points" [1, 100] = 7 => Number(gentle_score);
    /// Hand-over: cells of the skin that must feel another force (FingerVision 2017, section II-C)
    54 ChangedCells "hand-over-cells" "cells" [2, 20] = 5 => Number(changed_cells);
    /// Moving points in the camera's picture above which it shows slip, ten-thousandths of the picture
    55 MovingPoints "moving-points-e4" "e4" [2, 1_000] = 30 => Number(moving_e4);
    /// Turn: time by which the camera's angle is extrapolated; 0: not at all, as in FingerVision 2017
    56 TurnLead "turn-lead-ms" "ms" [0, 300] = 90 => Ms(turn_lead_frames);
}
