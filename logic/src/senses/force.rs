use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, FSR, FSR_COUNT};
use tenax_hal_shim::words::{Fault, Reason};

use super::{DOUBTED_AFTER, FSR_LIMITS, OPEN_FRAMES, PRESSED_UV, Senses, report};
use crate::config::Config;
use crate::force::fsr;
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
        let samples = [a, b, c, d];
        let is_pressed = |sample: u16| fsr::uv_above_rest(sample) > PRESSED_UV;
        if !self.fsr_seen {
            self.fsr_seen = true;
            for (n, _) in samples.iter().enumerate().filter(|&(_, &sample)| is_pressed(sample)) {
                journal.fault(Fault::PressedAtBoot { channel: (FSR + n) as u8 });
                self.pressed = true;
            }
        }
        // Seen unloaded once, its zero is known again.
        self.pressed &= samples.into_iter().any(is_pressed);
        let opened = self.open_frames > 0;
        let forces =
            self.force_sensor.process(samples, config.friction.loaded_mn, opened, self.closes_silently());
        let Some(mut forces) = forces else {
            self.forces = None;
            return;
        };
        if self.pressed {
            // The load may be no object: its size is still a bound, its direction is not.
            forces.ratio_permille = None;
        }
        self.forces = Some(forces);
        if self.open_frames >= OPEN_FRAMES {
            self.force_sensor.follow();
            self.doubt_load(config, journal);
        }
    }

    pub(super) fn blame(&mut self, config: &Config, journal: &mut Journal) {
        if self.fsr_readings.contains(&None) {
            return;
        }
        let before = self.blamed.map(|cell| usize::from(cell) % FSR_COUNT);
        let still = self.still_frames / u32::from(FRAMES_PER_SLOW_FRAME);
        self.force_sensor.think(config.friction.loaded_mn, still);
        self.blamed = self.force_sensor.blamed().map(|blamed| blamed as u8);
        let blamed = self.force_sensor.blamed();
        if blamed != before {
            report(journal, FSR + before.unwrap_or(0), before.map(|_| Change::Back));
            report(journal, FSR + blamed.unwrap_or(0), blamed.map(|_| Change::Lost(Reason::Creep)));
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
