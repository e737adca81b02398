//! A fingertip on the host that goes from one world to the next and keeps what it has learned.

use anyhow::{Context, anyhow};
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, PVDF_COUNT, SCANS_PER_FRAME};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, NETWORK_OUTPUTS, NetworkState, RECEPTORS, Setting, Slow};
use tenax_hal_shim::words::Kept;
use tenax_logic::detectors::Said;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::hebbian::network::Weight;
use tenax_logic::hebbian::{FingertipNetwork, snapshot};
use tenax_logic::touch;
use tenax_scene::World;
use tenax_scene::plant::Plant;

use super::chain::slow_frames;
use super::trial::{Setup, Trial};
use crate::board::simulated::with_plan;

/// Who says that the object slips, for the reflex to answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judge {
    /// The fingertip's own detectors; the scenes silence all but the network.
    Touch,
    /// The camera's v1, as it comes over the line, and nothing else.
    Vision,
    /// The world, which plans the least force that holds: the same gripper cannot do better.
    Oracle,
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
    /// Goes through a world to its end. `see` is shown every slow frame: its number in this world, what it tells, and what
    /// the network knows and feels after it.
    pub fn run(&mut self, mut world: World, judge: Judge, see: &mut dyn FnMut(usize, &Slow, &Self)) -> World {
        self.fingertip.act_on(match judge {
            Judge::Touch => DetectorSet::ALL,
            Judge::Vision => DetectorSet::only(DetectorId::Injected),
            Judge::Oracle => DetectorSet::only(DetectorId::S2),
        });
        let mut seen = 0;
        let mut drive = MotorDrive::Coast;
        for _ in 0..slow_frames(&world) * usize::from(FRAMES_PER_SLOW_FRAME) {
            let select = Frame::lost(self.frame).select();
            let mut scans = [Scan::default(); SCANS_PER_FRAME];
            let mut commands: Vec<Down> = Vec::new();
            for scan in &mut scans {
                *scan = scan_of_pins(&world.scan(drive).codes(), select);
                commands.extend(world.commands());
            }
            for command in &commands {
                // A refusal goes back to whoever sent it; there is no line here.
                let _ = self.fingertip.command(command);
            }
            let frame_in = Frame::from_scans(self.frame, &scans);
            self.frame = self.frame.wrapping_add(1);
            let told = match judge {
                Judge::Touch | Judge::Oracle => None,
                Judge::Vision => Some(world.said().is_some_and(|seen| seen.v1 < 0)),
            };
            if let Some(slips) = told {
                self.fingertip.inject(Said::slip(slips));
            }
            drive = self.fingertip.tick(&frame_in);
            if judge == Judge::Oracle {
                drive = with_plan(drive, self.fingertip.wearer_active(), world.planned());
            }
            if let Some(slow) = self.fingertip.take_slow() {
                see(seen, &slow, self);
                seen += 1;
            }
            while self.fingertip.next_event().is_some() {}
        }
        world
    }

    /// Goes through a trial.
    pub fn trial(&mut self, setup: Setup) -> Trial {
        let mut trial = Trial { lift_s: setup.lift_s, ..Trial::default() };
        let world = self.run(setup.world, Judge::Touch, &mut |n, slow, _| trial.hear(n, slow));
        trial.end(world.truth().clone());
        trial
    }

    /// A new fingertip with these settings.
    ///
    /// # Errors
    /// If a setting does not take its value.
    pub fn with_settings(settings: &[Setting]) -> anyhow::Result<Self> {
        let mut bench = Self::default();
        for setting in settings {
            let taken = bench.fingertip.command(&Down::Set(*setting));
            taken.map_err(|refusal| anyhow!("setting {} to {}: {refusal:?}", setting.id, setting.value))?;
        }
        Ok(bench)
    }

    /// The same fingertip with equal weights in place of learned ones: each film's part of o1 is the mean of theirs, so that
    /// their sum is the same and only the learning of which film to believe is gone. The control of what learning is worth.
    ///
    /// # Errors
    /// None but of a bug: what was learned can be restored.
    pub fn with_equal_weights(&self) -> anyhow::Result<Self> {
        let mut bytes = [0; touch::SNAPSHOT_LENGTH];
        let learned = self.fingertip.learned();
        let kept = learned.write(&mut bytes).context("a snapshot of another length")?;
        let (normaliser, network) =
            snapshot::restore(&touch::NORMALISER, kept).map_err(|damaged| anyhow!("{damaged:?}"))?;
        let mut weights: [[Weight; RECEPTORS]; NETWORK_OUTPUTS] = network.weights();
        let films = &mut weights[0][..PVDF_COUNT];
        let sum: i64 = films.iter().map(|weight| i64::from(weight.into_bits())).sum();
        films.fill(Weight::from_bits((sum / PVDF_COUNT as i64) as i32));
        let equal = FingertipNetwork::from_weights(&weights);
        let mut bytes = [0; touch::SNAPSHOT_LENGTH];
        let kept = snapshot::save(&normaliser, &equal, &mut bytes).context("a snapshot of another length")?;
        let mut other = self.clone();
        other.fingertip.restore(Kept::Network, kept);
        Ok(other)
    }

    /// Weights and activations.
    #[must_use]
    pub fn network(&self) -> NetworkState {
        self.fingertip.network()
    }
}
