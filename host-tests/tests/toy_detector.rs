//! A toy detector: the trait is enough to write one, and to step it over what was sensed.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};
use tenax_host_tests::Bench;
use tenax_logic::config::Config;
use tenax_logic::detectors::{Description, Detector, Said, Sensed};
use tenax_logic::journal::Journal;
use tenax_logic::senses::Senses;

/// Fall of the normal force in one slow frame that means slip, mN.
const CONFIG_MN: i32 = 500;

/// Compares each normal force with the one before.
#[derive(Debug, Default)]
struct Fall {
    last_mn: Option<i32>,
    fall_mn: i32,
}

impl Detector for Fall {
    // One that joined the list would have a number of its own.
    const ID: DetectorId = DetectorId::Injected;
    type Config = i32;

    fn step(&mut self, config_mn: &i32, sensed: &Sensed<'_>) -> Option<Said> {
        if !sensed.forces_are_new {
            return None;
        }
        let now_mn = sensed.forces.map(|forces| forces.fn_mn);
        self.fall_mn = self.last_mn.zip(now_mn).map_or(0, |(last_mn, now_mn)| last_mn - now_mn);
        self.last_mn = now_mn;
        Some(Said::slip(self.fall_mn >= *config_mn))
    }

    fn describe(&self, config_mn: &i32) -> Description {
        Description {
            confidence_permille: (self.fall_mn.max(0) * 500 / config_mn).min(1_000) as u16,
            direction: Direction::Unknown,
            health: if self.last_mn.is_some() { DetectorHealth::Working } else { DetectorHealth::Blind },
            raw: self.fall_mn,
        }
    }
}

/// Frames in which the detector said slip.
fn run(bench: &mut Bench, senses: &mut Senses, toy: &mut Fall, frames: u32) -> Vec<u32> {
    let (config, mut journal) = (Config::default(), Journal::default());
    let mut slips = Vec::new();
    for _ in 0..frames {
        let frame = bench.frame();
        journal.begin(&frame);
        senses.process(&config, &frame, &mut journal);
        let said = toy.step(&CONFIG_MN, &senses.sensed(&config, &frame, 0, false));
        assert_eq!(said.is_some(), frame.slot() == 15, "it decides when the last quadrant has been read");
        slips.extend(said.filter(|said| said.slip).map(|_| frame.sequence));
    }
    slips
}

#[test]
fn a_detector_written_outside_the_logic_judges_what_the_logic_senses() {
    let (mut bench, mut senses, mut toy) = (Bench::new(1), Senses::default(), Fall::default());
    assert_eq!(toy.describe(&CONFIG_MN).health, DetectorHealth::Blind);
    bench.load(4.0, 0.6);
    assert!(run(&mut bench, &mut senses, &mut toy, 2_000).is_empty(), "a steady force falls nowhere");
    bench.load(2.0, 0.2);
    let slips = run(&mut bench, &mut senses, &mut toy, 500);
    assert_eq!(slips.first(), Some(&2_015), "in the first slow frame of the smaller force");
    let Description { confidence_permille, health, .. } = toy.describe(&CONFIG_MN);
    assert!(confidence_permille < 500 && health == DetectorHealth::Working);
}
