use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotorConfig {
    pub limit_ma: u16,
    pub stall_ma: u16,
}

settings! {
    MotorConfig:
    /// Largest continuous motor current; a hot motor stops closing until it has cooled
    76 MotorLimit "motor-limit-ma" "mA" [300, 1_200] = 500 => Number(limit_ma);
    /// Current of the blocked motor at full duty; half of it while the fingers stand still is a stall
    77 MotorStall "motor-stall-ma" "mA" [300, 1_200] = 1_000 => Number(stall_ma);
}
