use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, FSR, FSR_COUNT};
use tenax_hal_shim::words::{Fault, Reason};

use super::{DOUBTED_AFTER, FSR_LIMITS, OPEN_FRAMES, Senses, UNLOADED_PART, report};
use crate::config::Config;
use crate::force::sensor::CARRIES_MN;
use crate::health::Change;
use crate::journal::Journal;

impl Senses {
    pub(super) fn quadrant(&mut self, config: &Config, quadrant: usize, sample: u16, journal: &mut Journal) {
        self.fsr_missed[quadrant] = 0;
        let (reading, change) = self.fsr[quadrant].take(&FSR_LIMITS, sample);
        report(journal, FSR + quadrant, change);
        self.fsr_readings[quadrant] = reading.ok();
        if quadrant + 1 < FSR_COUNT {
            return;
        }
        self.forces_are_new = true;
        self.quadrants(config, journal);
        if self.head_is_fitted {
            self.track(config);
        }
    }

    fn quadrants(&mut self, config: &Config, journal: &mut Journal) {
        let [Some(a), Some(b), Some(c), Some(d)] = self.fsr_readings else {
            self.forces = None;
            return;
        };
        let opened = self.open_frames > 0;
        let loaded_mn = config.friction.loaded_mn;
        let forces = self.force_sensor.process([a, b, c, d], loaded_mn, opened, self.closes_silently());
        let Some(mut forces) = forces else {
            self.forces = None;
            return;
        };
        // Seen unloaded once, its zero is known again.
        let is_loaded = forces.load_mn >= loaded_mn / UNLOADED_PART;
        self.pressed = is_loaded && (self.pressed || !self.fsr_seen);
        if !core::mem::replace(&mut self.fsr_seen, true) && is_loaded {
            for (n, _) in (0..).zip(self.force_sensor.quadrants()).filter(|&(_, mn)| mn >= CARRIES_MN) {
                journal.fault(Fault::PressedAtBoot { channel: FSR as u8 + n });
            }
        }
        if self.pressed {
            // The load may be no object: its size is still a bound, its direction is not.
            forces.ratio_permille = None;
        }
        self.forces = Some(forces);
        if self.open_frames >= OPEN_FRAMES {
            if !self.pressed {
                self.force_sensor.follow();
            }
            self.doubt_load(config, journal);
        }
    }

    pub(super) fn blame(&mut self, config: &Config, journal: &mut Journal) {
        if self.fsr_readings.contains(&None) {
            return;
        }
        let still = self.still_frames / u32::from(FRAMES_PER_SLOW_FRAME);
        self.force_sensor.think(config.friction.loaded_mn, still);
        // One quadrant a slow frame: a tick has no time for four reports.
        let changed = self.force_sensor.doubted() ^ self.doubted;
        if changed != 0 {
            let quadrant = changed.trailing_zeros() as usize;
            self.doubted ^= 1 << quadrant;
            let is_doubted = self.doubted >> quadrant & 1 != 0;
            let change = if is_doubted { Change::Lost(Reason::Creep) } else { Change::Back };
            report(journal, FSR + quadrant, Some(change));
        }
    }

    fn doubt_load(&mut self, config: &Config, journal: &mut Journal) {
        self.weigh(config);
        if self.unloaded {
            self.open_and_loaded = 0;
            return;
        }
        self.open_and_loaded = self.open_and_loaded.saturating_add(1);
        if self.open_and_loaded == DOUBTED_AFTER {
            journal.fault(Fault::NeverUnloaded);
        }
    }
}
