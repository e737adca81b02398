//! Every number that can be chosen. Plain values, apart from all state, so that a whole set can be swapped at once.

mod table;

use core::ops::RangeInclusive;

use tenax_hal_shim::detector::DetectorSet;

use crate::behaviours::settings::BehaviourConfig;
use crate::emg::settings::GateConfig;
use crate::force::settings::FrictionConfig;
use crate::grip::settings::GripConfig;
use crate::hebbian::settings::HebbianConfig;
use crate::motor::settings::MotorConfig;
use crate::photoelastic::HeadConfig;
use crate::setting::{Row, SettingId, Settings, settings};
use crate::vibration::settings::VibrationConfig;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    pub vibration: VibrationConfig,
    pub friction: FrictionConfig,
    pub hebbian: HebbianConfig,
    pub gate: GateConfig,
    pub grip: GripConfig,
    pub motor: MotorConfig,
    pub behaviour: BehaviourConfig,
    pub head: HeadConfig,
    pub line_trusted: bool,
    pub stream_at_start: bool,
    pub no_wearer: bool,
    pub detectors_off: DetectorSet,
    pub feedback: u16,
}

settings! {
    Config:
    /// 1: the serial line needs no consent (gripper on a robot). Setting it needs consent by muscles or button
    40 LineTrusted "line-trusted-flag" "flag" [0, 1] = 0 => Flag(line_trusted);
    /// 1: frames are streamed from the start on, so that a recording can be replayed bit for bit
    41 StreamAtStart "stream-at-start-flag" "flag" [0, 1] = 0 => Flag(stream_at_start);
    /// 1: no wearer, the reflex works without myosensors (gripper on a robot). Setting it needs consent by muscles or button
    42 NoWearer "no-wearer-flag" "flag" [0, 1] = 0 => Flag(no_wearer);
    /// Detectors that the reflex does not act on, the sum of: 1 Hebbian, 2 MLP, 4 photoelastic, 8 S2, 16 S1
    74 DetectorsOff "detectors-off-mask" "mask" [0, 31] = 0 => Mask(detectors_off);
    /// Vibration motor that signals force, slip and losses to the wearer: 0 off, 1 discreet, 2 strong
    78 Feedback "feedback-choice" "choice" [0, 2] = 0 => Number(feedback);
}

const TABLES: [&[Row]; 9] = [
    VibrationConfig::ROWS,
    FrictionConfig::ROWS,
    HebbianConfig::ROWS,
    GateConfig::ROWS,
    GripConfig::ROWS,
    MotorConfig::ROWS,
    BehaviourConfig::ROWS,
    HeadConfig::ROWS,
    Config::ROWS,
];

const MEASURED_MAX_PERMILLE: i32 = 900;

impl Default for Config {
    fn default() -> Self {
        let mut config = Self {
            vibration: VibrationConfig::default(),
            friction: FrictionConfig::default(),
            hebbian: HebbianConfig::default(),
            gate: GateConfig::default(),
            grip: GripConfig::default(),
            motor: MotorConfig::default(),
            behaviour: BehaviourConfig::default(),
            head: HeadConfig::default(),
            line_trusted: false,
            stream_at_start: false,
            no_wearer: false,
            detectors_off: DetectorSet::NONE,
            feedback: 0,
        };
        for id in SettingId::ALL {
            config.put(id, id.row().default);
        }
        config
    }
}

impl Config {
    fn parts(&self) -> [&dyn Settings; TABLES.len()] {
        [
            &self.vibration,
            &self.friction,
            &self.hebbian,
            &self.gate,
            &self.grip,
            &self.motor,
            &self.behaviour,
            &self.head,
            self,
        ]
    }

    pub fn get(&self, id: SettingId) -> i32 {
        self.parts().into_iter().find_map(|part| part.value(id)).unwrap_or_default()
    }

    pub fn set(&mut self, id: SettingId, value: i32) -> Result<(), RangeInclusive<i32>> {
        let range = id.row().range();
        if !range.contains(&value) {
            return Err(range);
        }
        self.put(id, value);
        Ok(())
    }

    /// S2 from a stroke. False if no surface has such friction.
    pub(crate) fn measured(&mut self, s2_permille: i32) -> bool {
        s2_permille <= MEASURED_MAX_PERMILLE && self.set(SettingId::S2, s2_permille).is_ok()
    }

    /// `value`: 0 to 2^24, which each field has room for.
    pub(crate) fn put(&mut self, id: SettingId, value: i32) {
        self.vibration.put(id, value);
        self.friction.put(id, value);
        self.hebbian.put(id, value);
        self.hebbian.follow();
        self.gate.put(id, value);
        self.grip.put(id, value);
        self.motor.put(id, value);
        self.behaviour.put(id, value);
        self.head.put(id, value);
        Settings::put(self, id, value);
    }
}
