//! What the inputs read: their noise, and what the motor adds to it.

use std::time::Duration;

use tenax_hal_shim::channel::{
    CHANNELS, COUNT, MOTOR_CURRENT, OPENING, PVDF, PVDF_COUNT, REFERENCE_MV, SAMPLE_MAX,
};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::schedule::SCHEDULE;
use tenax_hal_shim::wire::Up;
use tenax_logic::setting::SettingId;

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;

/// A sample, mV.
const SAMPLE_MV: f64 = REFERENCE_MV as f64 / SAMPLE_MAX as f64;
/// Where the inputs are held, and how far off each may stand, mV.
const HELD_MV: f64 = 1_650.0;
const OFF_MV: f64 = 20.0;
/// Noise of a sample, mV rms: twice what one code of noise in each of its four conversions makes.
const NOISE_MV: f64 = 0.8;
/// What the motor may make of a film's envelope, per cent of S1.
const OF_S1_PERCENT: f64 = 50.0;
/// How the motor is driven.
const DUTIES: [u16; 2] = [300, 1_000];
const RAW: Stream = Stream { raw: true, senses: true };

/// Each channel's samples: their number, sum and sum of squares, mV; and the films' largest envelope.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    sums: [[f64; 3]; COUNT],
    envelope_mv: f64,
}

impl Default for Levels {
    fn default() -> Self {
        Self { sums: [[0.0; 3]; COUNT], envelope_mv: 0.0 }
    }
}

impl Levels {
    /// What is read in so long.
    pub(super) fn heard(wire: &mut Wire<'_>, lasts: Duration) -> anyhow::Result<Self> {
        let mut levels = Self::default();
        wire.hear(lasts, RAW, &mut |_, message| {
            levels.take(message);
            Ok(false)
        })?;
        Ok(levels)
    }

    /// What is read while the motor is driven for so long.
    pub(super) fn driven(
        wire: &mut Wire<'_>,
        drive: MotorDrive,
        lasts: Duration,
        say: Say<'_>,
    ) -> anyhow::Result<Self> {
        let mut levels = Self::default();
        wire.drive(drive, lasts, RAW, say, &mut |_, message| {
            levels.take(message);
            Ok(false)
        })?;
        Ok(levels)
    }

    fn take(&mut self, message: &Up) {
        match message {
            Up::Raw(raw) => {
                for frame in raw.frames().iter().filter(|frame| frame.valid) {
                    for (film, &sample) in frame.pvdf.iter().enumerate() {
                        self.add(PVDF + film, sample);
                    }
                    let slot = SCHEDULE[usize::from(frame.slot())];
                    for (channel, sample) in
                        [(slot.switch_a, frame.switch_a), (slot.switch_b, frame.switch_b)]
                    {
                        channel.into_iter().for_each(|channel| self.add(channel.into(), sample));
                    }
                }
            }
            Up::Senses(senses) => {
                let most = senses.films.iter().max().map_or(0.0, |&most| f64::from(most) * SAMPLE_MV);
                self.envelope_mv = self.envelope_mv.max(most);
            }
            _ => {}
        }
    }

    fn add(&mut self, channel: usize, sample: u16) {
        // From the middle, so that nothing is lost in the squares.
        let mv = f64::from(sample) * SAMPLE_MV - HELD_MV;
        let [count, sum, squares] = &mut self.sums[channel];
        (*count, *sum, *squares) = (*count + 1.0, *sum + mv, *squares + mv * mv);
    }

    /// A channel's mean and its deviation, mV. NaN where nothing was read.
    pub(super) fn of(&self, channel: usize) -> (f64, f64) {
        let [count, sum, squares] = self.sums[channel];
        let mean = sum / count;
        (mean + HELD_MV, (squares / count - mean * mean).max(0.0).sqrt())
    }

    /// The channel of these in which that is largest, and how large; NaN is larger than any.
    fn worst(channels: &[usize], of: impl Fn(usize) -> f64) -> (&'static str, f64) {
        let worst = channels.iter().map(|&n| (CHANNELS[n].name, of(n))).max_by(|a, b| a.1.total_cmp(&b.1));
        worst.unwrap_or(("none", f64::NAN))
    }
}

/// What every input reads as it is: its mean and its noise.
pub fn readings(wire: &mut Wire<'_>, lasts: Duration) -> anyhow::Result<Vec<Figure>> {
    let levels = Levels::heard(wire, lasts)?;
    let of = |channel: usize| {
        let (name, (mean, deviation)) = (CHANNELS[channel].name, levels.of(channel));
        [Figure::told(name, mean, "mV"), Figure::told(format!("{name}, noise"), deviation, "mV")]
    };
    Ok((0..COUNT).flat_map(of).collect())
}

/// What inputs that are held at 1.65 V read.
pub(super) fn noise(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let levels = Levels::heard(wire, asked.lasts.unwrap_or(Duration::from_secs(10)))?;
    for &channel in &asked.channels {
        let (mean, deviation) = levels.of(channel);
        say(&format!("   {:<14}{mean:>9.1} mV, noise {deviation:.3} mV rms", CHANNELS[channel].name))?;
    }
    let (noisiest, rms_mv) = Levels::worst(&asked.channels, |n| levels.of(n).1);
    let (farthest, off_mv) = Levels::worst(&asked.channels, |n| (levels.of(n).0 - HELD_MV).abs());
    Ok(vec![
        Figure::told(format!("worst noise, {noisiest}"), rms_mv, "mV").within(0.0, NOISE_MV),
        Figure::told("effective bits there", (f64::from(REFERENCE_MV) / (rms_mv * 12_f64.sqrt())).log2(), ""),
        Figure::told(format!("farthest from 1650 mV, {farthest}"), off_mv, "mV").within(0.0, OFF_MV),
    ])
}

/// What the motor makes the films say.
pub(super) fn interference(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let lasts = asked.lasts.unwrap_or(Duration::from_secs(1));
    let films: Vec<usize> = (PVDF..PVDF + PVDF_COUNT).collect();
    let others: Vec<usize> =
        (0..COUNT).filter(|n| !films.contains(n) && ![OPENING, MOTOR_CURRENT].contains(n)).collect();
    let s1_mv = f64::from(wire.client.setting(SettingId::S1)?);
    let rest = Levels::heard(wire, 2 * lasts)?;
    let mut figures = vec![Figure::told("films' envelope at rest", rest.envelope_mv, "mV")];
    type Way = fn(Duty) -> MotorDrive;
    for (name, way) in [("closing", MotorDrive::Close as Way), ("opening", MotorDrive::Open)] {
        for permille in DUTIES {
            let driven = Levels::driven(wire, way(Duty::per_mille(permille)), lasts, say)?;
            let duty = format!("{name} at {} %", permille / 10);
            let part = 100.0 * driven.envelope_mv / s1_mv;
            let step = |n: usize| (driven.of(n).0 - rest.of(n).0).abs();
            let (film, film_mv) = Levels::worst(&films, step);
            let (other, other_mv) = Levels::worst(&others, step);
            figures.extend([
                Figure::told(format!("{duty}: films' envelope, of S1"), part, "%").within(0.0, OF_S1_PERCENT),
                Figure::told(format!("{duty}: step of {film}"), film_mv, "mV"),
                Figure::told(format!("{duty}: step of {other}"), other_mv, "mV"),
            ]);
            // It settles, and the line may drive again.
            wire.hear(lasts, RAW, &mut |_, _| Ok(false))?;
        }
    }
    Ok(figures)
}
