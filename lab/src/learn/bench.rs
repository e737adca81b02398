//! A fingertip on the host that goes from one world to the next and keeps what it has learned.

use anyhow::Context;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, PVDF_COUNT, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Setting};
use tenax_hal_shim::words;
use tenax_logic::detectors::Said;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::hebbian::network::Weight;
use tenax_logic::hebbian::{self, FingertipNetwork, snapshot};
use tenax_logic::setting::SettingId;
use tenax_scene::World;
use tenax_scene::plant::Plant;

use super::trial::{Setup, Trial};
use tenax_sim::board::simulated::Ahead;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judge {
    /// The fingertip's own detectors; the scenes silence all but the network.
    Touch,
    /// The camera's v1, as it comes over the line, and nothing else.
    Vision,
    /// The world's plan holds with the least force.
    Bound,
}

/// The fingertip. Its line is trusted: a camera teaches over it.
#[derive(Clone, Debug)]
pub struct Bench {
    fingertip: Fingertip,
    frame: u32,
}

impl Default for Bench {
    fn default() -> Self {
        Self { fingertip: Fingertip::trusting(), frame: 0 }
    }
}

impl Bench {
    /// Goes through the whole slow frames of a world.
    pub fn run(&mut self, mut world: World, judge: Judge) -> Trial {
        self.fingertip.act_on(match judge {
            Judge::Touch => DetectorSet::ALL,
            Judge::Vision => DetectorSet::only(DetectorId::Injected),
            Judge::Bound => DetectorSet::NONE,
        });
        // A lesson had switched them off.
        let none = Down::Set(Setting { id: SettingId::DetectorsOff.number(), value: 0 });
        // A trusted line may.
        let _ = self.fingertip.command(&none);
        let mut trial = Trial::default();
        let (mut drive, mut ahead) = (MotorDrive::Coast, Ahead::default());
        let frames = (world.duration_s() * f64::from(SCAN_HZ)) as usize / SCANS_PER_FRAME;
        for _ in 0..frames - frames % usize::from(FRAMES_PER_SLOW_FRAME) {
            let (frame, commands) = world.frame(self.frame, drive);
            for command in &commands {
                // A refusal goes back to whoever sent it; there is no line here.
                let _ = self.fingertip.command(command);
            }
            self.frame = self.frame.wrapping_add(1);
            if judge == Judge::Vision {
                self.fingertip.inject(Said::slip(world.said().is_some_and(|seen| seen.v1 < 0)));
            }
            drive = self.fingertip.tick(&frame);
            if frame.ends_slow_frame() {
                self.fingertip.listen();
            }
            if judge == Judge::Bound {
                drive = ahead.drive(drive, &self.fingertip, world.planned());
            }
            let [slip, incipient] = [self.fingertip.slip(), self.fingertip.incipient()]
                .map(|detectors| detectors.contains(DetectorId::Hebbian));
            trial.said.push(Said { slip, incipient });
            if let Some(slow) = self.fingertip.take_slow() {
                trial.outputs.extend(slow.ticks.iter().map(|tick| tick.outputs));
            }
            while self.fingertip.next_event().is_some() {}
        }
        trial.truth = world.truth().clone();
        trial
    }

    pub fn trial(&mut self, setup: Setup) -> Trial {
        Trial { lift_s: setup.lift_s, ..self.run(setup.world, Judge::Touch) }
    }

    /// The learned state, as the board keeps it. Fails by a bug alone.
    pub fn snapshot(&self) -> anyhow::Result<Vec<u8>> {
        let mut bytes = [0; hebbian::SNAPSHOT_LENGTH];
        let kept = self.fingertip.learned();
        Ok(kept.write(&mut bytes).context("a snapshot of another length")?.to_vec())
    }

    /// A copy whose films count alike in o1: each has the mean of their weights. Fails by a bug alone.
    pub fn equalised(&self) -> anyhow::Result<Self> {
        let kept = self.snapshot()?;
        let (normaliser, network, more) =
            snapshot::restore(&hebbian::NORMALISER, &kept).context("a damaged snapshot")?;
        let mut weights = network.weights();
        let films = &mut weights[0][..PVDF_COUNT];
        let sum: i64 = films.iter().map(|weight| i64::from(weight.into_bits())).sum();
        films.fill(Weight::from_bits((sum / PVDF_COUNT as i64) as i32));
        let mut bytes = [0; hebbian::SNAPSHOT_LENGTH];
        let changed = FingertipNetwork::from_weights(&weights);
        let kept = snapshot::Contents::of(&normaliser, &changed, more);
        let kept = kept.write(&mut bytes).context("a snapshot of another length")?;
        let mut other = self.clone();
        other.fingertip.restore(words::Kept::Network, kept);
        Ok(other)
    }
}
