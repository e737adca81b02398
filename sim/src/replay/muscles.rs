//! Both muscles of a recording, as the board reads them.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, MYO_EXTENSOR, MYO_FLEXOR, MYO_SELECT, SCANS_PER_FRAME};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::select_of_slot;
use tenax_logic::emg::calibration::{Calibration, PROMPT_FRAMES, Progress};
use tenax_logic::emg::model::{EmgModel, Refusal};
use tenax_logic::emg::uv_of_sample;
use tenax_scene::plant::Plant;

use super::{ReplayPlant, library};

#[derive(Clone, Debug)]
pub struct Muscles {
    pub duration_s: f64,
    /// Time since the first row, s, negative while the front end settles; flexor and extensor, uV, None where there is no number.
    pub pairs: Vec<(f64, [Option<i32>; 2])>,
}

impl Muscles {
    pub fn read(path: &Path, recipe: Option<&str>, seed: u64) -> anyhow::Result<Self> {
        let (recording, named) = library::read(path, recipe)?;
        let mut plant = ReplayPlant::of(&recording, named.as_ref(), seed)?;
        let from_s = plant.time_zero_s() - recording.first_s();
        let mut pair = [None; 2];
        let mut pairs = Vec::new();
        for frame in 0..(plant.duration_s() * f64::from(FRAME_HZ)) as u32 {
            let mut samples = [0u16; 2];
            for _ in 0..SCANS_PER_FRAME {
                let codes = plant.scan(MotorDrive::Coast).codes();
                samples[0] += codes[MYO_FLEXOR];
                samples[1] += codes[MYO_EXTENSOR];
            }
            let Some(muscle @ 0..=1) = select_of_slot((frame % 25) as u8).checked_sub(MYO_SELECT) else {
                continue;
            };
            let (muscle, channel) = (usize::from(muscle), &CHANNELS[MYO_FLEXOR + usize::from(muscle)]);
            let uv = uv_of_sample(samples[muscle]);
            let mv = uv / 1_000 + 300;
            pair[muscle] = (channel.low_mv as i32..=channel.high_mv as i32).contains(&mv).then_some(uv);
            if muscle == 1 {
                pairs.push((f64::from(frame) / f64::from(FRAME_HZ) + from_s, pair));
            }
        }
        Ok(Self { duration_s: recording.duration_s(), pairs })
    }

    pub fn within(&self) -> impl Iterator<Item = (f64, [Option<i32>; 2])> {
        self.pairs.iter().copied().filter(|(t_s, _)| (0.0..self.duration_s).contains(t_s))
    }
}

/// The guided calibration: each prompt, rest, close and open, is answered with the first 5 s of a recording.
pub fn calibrate(phases: [&Muscles; 3]) -> Result<EmgModel, Refusal> {
    let mut calibration = Calibration::begin(0);
    for begin in (0..).step_by(PROMPT_FRAMES as usize) {
        let prompt = match calibration.take(begin, [None; 2]) {
            Progress::Done(result) => return result,
            Progress::Asks(prompt, _) => prompt,
        };
        for (t_s, pair) in phases[prompt as usize].within() {
            let frame = (t_s * f64::from(FRAME_HZ)) as u32;
            if frame < PROMPT_FRAMES {
                calibration.take(begin + frame, pair);
            }
        }
    }
    unreachable!("it ends by itself")
}

/// Calibrates to the wearer of these recordings: rest, close, open.
/// Fails if one cannot be read or has no recipe, or the calibration is refused.
pub fn calibrate_by(recordings: &[PathBuf], recipe: Option<&str>, seed: u64) -> anyhow::Result<EmgModel> {
    let [rest, close, open] = recordings else {
        bail!("a calibration takes three recordings: REST.csv,CLOSE.csv,OPEN.csv");
    };
    let read = |path: &PathBuf| Muscles::read(path, recipe, seed);
    let (rest, close, open) = (read(rest)?, read(close)?, read(open)?);
    calibrate([&rest, &close, &open]).map_err(|refusal| anyhow!("the calibration is refused: {refusal}"))
}
