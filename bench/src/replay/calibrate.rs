//! The guided calibration from recordings: each prompt is answered with one.

use std::path::PathBuf;

use anyhow::bail;
use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, MYO_EXTENSOR, MYO_FLEXOR, MYO_SELECT, SCANS_PER_FRAME};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::select_of_slot;
use tenax_logic::emg::calibration::{Calibration, PROMPT_FRAMES, Progress};
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::uv_of_sample;
use tenax_scene::plant::Plant;

use super::{Recording, ReplayPlant, library};

/// Calibrates to the wearer of these recordings: rest, close, open. Of each, the first 5 s as the board reads them.
/// Fails if one cannot be read or has no recipe, or the calibration is refused.
pub fn calibrate(recordings: &[PathBuf], recipe: Option<&str>, seed: u64) -> anyhow::Result<EmgModel> {
    let [rest, close, open] = recordings else {
        bail!("a calibration takes three recordings: REST.csv,CLOSE.csv,OPEN.csv");
    };
    let mut calibration = Calibration::begin(0);
    for (phase, path) in (0..).zip([rest, close, open]) {
        let recording = Recording::read(path)?;
        let mut plant = match library::choose(&recording, path, recipe)? {
            Some(named) => ReplayPlant::new(&recording, &named.recipe, seed)?,
            None => ReplayPlant::plain(&recording, seed)?,
        };
        let before = ((recording.first_s() - plant.time_zero_s()) * f64::from(FRAME_HZ)).round() as u32;
        let mut pair = [None; 2];
        let frames = (plant.duration_s() * f64::from(FRAME_HZ)) as u32;
        for frame in 0..frames.min(before + PROMPT_FRAMES) {
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
            if muscle == 1 && frame >= before {
                calibration.take(phase * PROMPT_FRAMES + frame - before, pair);
            }
        }
    }
    match calibration.take(3 * PROMPT_FRAMES, [None; 2]) {
        Progress::Done(Ok(model)) => Ok(model),
        Progress::Done(Err(refusal)) => bail!("the calibration is refused: {refusal}"),
        Progress::Asks(..) => bail!("the calibration is not over"),
    }
}
