//! A fingertip on the host that goes from one world to the next and keeps what it has learned.

use anyhow::Context;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, PVDF_COUNT, SLOW_HZ};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Setting, Slow};
use tenax_hal_shim::words;
use tenax_logic::detectors::Said;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::hebbian::{self, FingertipNetwork, snapshot};
use tenax_logic::setting::SettingId;
use tenax_scene::World;
use tenax_scene::plant::Plant;

use super::chain::slow_frames;
use super::control::Control;
use super::trial::{Setup, Trial, by_network};
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
    said: Vec<Said>,
}

impl Default for Bench {
    fn default() -> Self {
        Self { fingertip: Fingertip::trusting(), frame: 0, said: Vec::new() }
    }
}

impl Bench {
    /// Goes through a world for so long at most, s. `see` gets every slow frame with its number in this world.
    pub fn run(
        &mut self,
        for_s: f64,
        mut world: World,
        judge: Judge,
        see: &mut dyn FnMut(usize, &Slow, &Self),
    ) -> World {
        self.fingertip.act_on(match judge {
            Judge::Touch => DetectorSet::ALL,
            Judge::Vision => DetectorSet::only(DetectorId::Injected),
            Judge::Bound => DetectorSet::NONE,
        });
        // A lesson had switched them off.
        let none = Down::Set(Setting { id: SettingId::DetectorsOff.number(), value: 0 });
        // A trusted line may.
        let _ = self.fingertip.command(&none);
        let mut seen = 0;
        let (mut drive, mut ahead) = (MotorDrive::Coast, Ahead::default());
        let slow_frames = slow_frames(&world).min((for_s * f64::from(SLOW_HZ)) as usize);
        for _ in 0..slow_frames * usize::from(FRAMES_PER_SLOW_FRAME) {
            let (frame_in, commands) = world.frame(self.frame, drive);
            for command in &commands {
                // A refusal goes back to whoever sent it; there is no line here.
                let _ = self.fingertip.command(command);
            }
            self.frame = self.frame.wrapping_add(1);
            let told = match judge {
                Judge::Touch | Judge::Bound => None,
                Judge::Vision => Some(world.said().is_some_and(|seen| seen.v1 < 0)),
            };
            if let Some(slips) = told {
                self.fingertip.inject(Said::slip(slips));
            }
            drive = self.fingertip.tick(&frame_in);
            if judge == Judge::Bound {
                drive = ahead.drive(drive, &self.fingertip, world.planned());
            }
            self.said.push(by_network([self.fingertip.slip(), self.fingertip.incipient()]));
            if let Some(slow) = self.fingertip.take_slow() {
                see(seen, &slow, self);
                seen += 1;
                self.said.clear();
            }
            while self.fingertip.next_event().is_some() {}
        }
        world
    }

    pub fn trial(&mut self, setup: Setup) -> Trial {
        self.trial_for(f64::INFINITY, setup)
    }

    /// Goes through a trial until so long after the lift began, s.
    pub fn trial_for(&mut self, for_s: f64, setup: Setup) -> Trial {
        let mut trial = Trial { lift_s: setup.lift_s, ..Trial::default() };
        let for_s = setup.lift_s + for_s;
        let world = self.run(for_s, setup.world, Judge::Touch, &mut |n, slow, bench| {
            trial.hear(n, slow, &bench.said);
        });
        trial.truth = world.truth().clone();
        trial
    }

    /// The learned state, as the board keeps it. Fails by a bug alone.
    pub fn snapshot(&self) -> anyhow::Result<Vec<u8>> {
        let mut bytes = [0; hebbian::SNAPSHOT_LENGTH];
        let kept = self.fingertip.learned();
        Ok(kept.write(&mut bytes).context("a snapshot of another length")?.to_vec())
    }

    /// A copy with something of its learning changed, switched off and on. Fails by a bug alone.
    pub fn controlled(&self, control: Control) -> anyhow::Result<Self> {
        let kept = self.snapshot()?;
        let (normaliser, network, more) =
            snapshot::restore(&hebbian::NORMALISER, &kept).context("a damaged snapshot")?;
        let mut weights = network.weights();
        let films = &mut weights[0][..PVDF_COUNT];
        let more = control.change(films, more);
        let changed = FingertipNetwork::from_weights(&weights);
        let mut bytes = [0; hebbian::SNAPSHOT_LENGTH];
        let kept = snapshot::Contents::of(&normaliser, &changed, more);
        let kept = kept.write(&mut bytes).context("a snapshot of another length")?;
        let mut other = self.clone();
        other.fingertip.restore(words::Kept::Network, kept);
        Ok(other)
    }

    pub fn said(&self) -> &[Said] {
        &self.said
    }
}
