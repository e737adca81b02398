use super::{LearningConfig, Rule};
use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HebbianConfig {
    pub slip_permille: u16,
    pub slip_frames: u32,
    pub everywhere_frames: u32,
    pub loud_frames: u32,
    pub ahead_ms: u16,
    pub loud_duty_permille: u16,
    pub teacher_fresh_ms: u16,
    pub learning: LearningConfig,
    pub rule: Rule,
}

impl HebbianConfig {
    pub(crate) const fn follow(&mut self) {
        self.rule = Rule::of(&self.learning);
    }
}

settings! {
    HebbianConfig:
    /// Hebbian: slip is reported while the PVDF part of o1 is below minus this value
    5 HebbianSlip "hebbian-slip-permille" "per mille" [10, 1_000] = 100 => Number(slip_permille);
    /// Hebbian: time below the threshold before slip is reported, if only some PVDF channels show it
    11 HebbianTime "hebbian-ms" "ms" [1, 100] = 15 => Ms(slip_frames);
    /// Hebbian: time below the threshold before slip is reported, if all PVDF channels show it; longer than an impact
    12 HebbianEverywhere "hebbian-everywhere-ms" "ms" [1, 500] = 40 => Ms(everywhere_frames);
    /// Hebbian: time after an impact or a fast run of the motor in which it is not evaluated
    13 HebbianAfterNoise "hebbian-after-noise-ms" "ms" [0, 1_000] = 100 => Ms(loud_frames);
    /// Motor duty whose noise disturbs the Hebbian detector; a line's closing then silences the reflex
    14 NoisyDuty "noisy-duty-permille" "per mille" [10, 1_000] = 100 => Number(loud_duty_permille);
    /// Teacher's pictures older than this are ignored
    15 TeacherFresh "teacher-fresh-ms" "ms" [40, 1_000] = 120 => Number(teacher_fresh_ms);
    /// Hebbian: learning rate alpha of one update (Tada 2006, equation 5)
    16 HebbianAlpha "hebbian-alpha-ppb" "ppb" [0, 16_000_000] = 50_000 => Number(learning.alpha_ppb);
    /// Hebbian: forgetting rate beta of one update (Tada 2006, equation 5)
    17 HebbianBeta "hebbian-beta-ppb" "ppb" [0, 16_000_000] = 10_000 => Number(learning.beta_ppb);
    /// Hebbian: delta, the constant share of each connection in the variable learning rate (Tada 2006, equation 6)
    18 HebbianDelta "hebbian-delta-ppm" "ppm" [1_000, 8_000_000] = 300_000 => Number(learning.delta_ppm);
    /// Hebbian: time by which Ft/Fn is extrapolated; it warns if the result reaches the ratio at which the camera saw slip; 0: no warnings
    72 HebbianAhead "hebbian-ahead-ms" "ms" [0, 250] = 75 => Number(ahead_ms);
}
