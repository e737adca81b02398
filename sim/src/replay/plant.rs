//! A recording as a plant: its columns at the pins, whatever the motor does.

use anyhow::{Context, anyhow, bail};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use tenax_hal_shim::channel::{self, CHANNELS, FSR, SCAN_HZ};
use tenax_hal_shim::front_end::{fsr_mv, fsr_quadrants_n};
use tenax_hal_shim::motor::MotorDrive;
use tenax_logic::emg::model::EmgModel;
use tenax_scene::plant::{Calibrated, Pins, Plant};

use super::filter::{Pass, pass};
use super::library::Named;
use super::recipe::{ForceMap, HoldForce, Map, RemoveOffset};
use super::resample::Grid;
use super::{Recipe, Recording};

/// Noise on every pin, mV rms: half a code (assumed). One code for ever would be a broken sensor.
const PIN_NOISE_MV: f64 = 0.4;

const PLAIN_LEAD_IN_S: f64 = 1.0;
const PLAIN_LEAD_OUT_S: f64 = 0.2;

#[derive(Clone, Debug)]
struct Track {
    volts: Vec<f64>,
    /// Channel and its voltage for zero, V.
    pins: Vec<(usize, f64)>,
    clip_v: [f64; 2],
}

const PIN_MAX_V: f64 = 3.3;
const OVER: f64 = 0.02;

fn in_volts(rows: &[f64]) -> Result<(), String> {
    let known = || rows.iter().copied().filter(|value| value.is_finite());
    let (low, high) =
        known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low >= -OVER * PIN_MAX_V && high <= (1.0 + OVER) * PIN_MAX_V {
        return Ok(());
    }
    let whole = known().all(|value| value.fract() == 0.0);
    let likely = match high {
        _ if low < -OVER * PIN_MAX_V => {
            "it goes below 0: likely an offset was taken off, or it is no voltage at a pin"
        }
        _ if whole && high <= 4_095.0 && high > 3_300.0 => "likely codes of 12 bits, 1241 a volt",
        _ if high <= 3_300.0 * (1.0 + OVER) => "likely millivolts, 1000 a volt",
        _ if whole && high <= 16_380.0 => "likely samples of 14 bits, 4964 a volt",
        _ if whole && high <= 65_535.0 => "likely codes of 16 bits, 19859 a volt",
        _ if high <= 3_300_000.0 * (1.0 + OVER) => "likely microvolts, 1000000 a volt",
        _ => "no usual unit fits",
    };
    Err(format!(
        "{low} to {high}, but a pin has 0 to {PIN_MAX_V} V; {likely}. Give volts at the pin, or say with --recipe FILE \
         how the column reaches it (gain and offset_v, docs/recipes.md)"
    ))
}

#[derive(Debug)]
pub struct ReplayPlant {
    grid: Grid,
    tracks: Vec<Track>,
    still: Pins,
    pins: Pins,
    next: usize,
    rng: ChaCha8Rng,
    noise_v: Normal<f64>,
    pub calibrated: Option<EmgModel>,
}

impl ReplayPlant {
    pub fn of(recording: &Recording, named: Option<&Named>, seed: u64) -> anyhow::Result<Self> {
        match named {
            Some(Named { name, recipe }) => {
                Self::new(recording, recipe, seed).with_context(|| format!("recipe {name}"))
            }
            None => Self::plain(recording, seed),
        }
    }

    pub fn new(recording: &Recording, recipe: &Recipe, seed: u64) -> anyhow::Result<Self> {
        let mut plant =
            Self::empty(recording, *recipe.lead_in_s.get_ref(), *recipe.lead_out_s.get_ref(), seed);
        for map in &recipe.map {
            let values = plant.front_end(recording, map)?;
            let offset_v = map.offset_v.as_ref().map(|volts| *volts.get_ref());
            let pins = map.channels.iter().filter_map(|name| channel::by_name(name.get_ref()));
            plant.tracks.push(Track {
                volts: values,
                pins: pins.map(|index| (index, offset_v.unwrap_or_else(|| rest_v(index)))).collect(),
                clip_v: *map.clip_v.get_ref(),
            });
        }
        if let Some(force) = &recipe.force {
            let loads = plant.loads(recording, force)?;
            plant.press(loads);
        }
        if let Some(hold) = &recipe.hold.force {
            let loads = plant.held_loads(hold.get_ref());
            plant.press(loads);
        }
        for hold in &recipe.hold.pins {
            for index in hold.channels.iter().filter_map(|name| channel::by_name(name.get_ref())) {
                plant.still.0[index] = *hold.volts.get_ref();
            }
        }
        Ok(plant)
    }

    pub fn plain(recording: &Recording, seed: u64) -> anyhow::Result<Self> {
        let mut plant = Self::empty(recording, PLAIN_LEAD_IN_S, PLAIN_LEAD_OUT_S, seed);
        for column in recording.signals() {
            let Some(index) = channel::by_name(column) else {
                let names: Vec<&str> = CHANNELS.iter().map(|channel| channel.name).collect();
                bail!(
                    "{}:1: column `{column}` is no channel, and no recipe in the repository is for this file's name.\n\
                     Either name the columns like channels and give volts at the pin, or say with --recipe FILE how they \
                     reach the pins (docs/recipes.md).\nThe channels are {}",
                    recording.file(),
                    names.join(", ")
                );
            };
            let rows = recording.series(column)?;
            in_volts(&rows).map_err(|what| anyhow!("{}: column `{column}`: {what}", recording.file()))?;
            let drawn = plant.grid.draw(recording.t_s(), &rows);
            plant.tracks.push(Track {
                volts: plant.grid.thin(&drawn),
                pins: vec![(index, 0.0)],
                clip_v: [0.0, 3.3],
            });
        }
        if plant.tracks.is_empty() {
            bail!("{}:1: there is no column but the time", recording.file());
        }
        Ok(plant)
    }

    fn empty(recording: &Recording, lead_in_s: f64, lead_out_s: f64, seed: u64) -> Self {
        let (first_s, duration_s) = (recording.first_s(), recording.duration_s());
        Self {
            grid: Grid::new(recording.rate_hz(), first_s, duration_s, lead_in_s, lead_out_s),
            tracks: Vec::new(),
            still: Pins::default(),
            pins: Pins::default(),
            next: 0,
            rng: ChaCha8Rng::seed_from_u64(seed),
            noise_v: Normal::new(0.0, PIN_NOISE_MV / 1e3).expect("a positive, finite deviation"),
            calibrated: None,
        }
    }

    pub fn time_zero_s(&self) -> f64 {
        self.grid.from_s
    }

    fn front_end(&self, recording: &Recording, map: &Map) -> anyhow::Result<Vec<f64>> {
        let mut rows = recording.series(&map.column)?;
        let offset = match map.remove_offset {
            None => 0.0,
            Some(RemoveOffset::Value(value)) => value,
            Some(RemoveOffset::Mean) => mean(rows.iter()).unwrap_or(0.0),
            Some(RemoveOffset::MeanOfFirstS(seconds)) => {
                let until_s = recording.first_s() + seconds;
                let first = rows.iter().zip(recording.t_s()).filter(|&(_, &t)| t <= until_s);
                mean(first.map(|(value, _)| value)).with_context(|| {
                    format!("mean_of_first_s = {seconds} covers no row of {}", recording.file())
                })?
            }
        };
        rows.iter_mut().for_each(|value| *value -= offset);
        let mut drawn = self.grid.draw(recording.t_s(), &rows);
        let rate_hz = self.grid.rate_hz();
        let stage = |kind, corner: &Option<toml::Spanned<f64>>, drawn: &mut Vec<f64>| {
            if let Some(corner) = corner {
                pass(kind, *corner.get_ref(), rate_hz, drawn);
            }
        };
        stage(Pass::High, &map.high_pass_hz, &mut drawn);
        stage(Pass::Low, &map.low_pass_hz, &mut drawn);
        if map.rectify {
            drawn.iter_mut().for_each(|value| *value = value.abs());
        }
        stage(Pass::Low, &map.envelope_hz, &mut drawn);
        let mut volts = self.grid.thin(&drawn);
        volts.iter_mut().for_each(|value| *value *= map.gain.get_ref());
        Ok(volts)
    }

    /// Forces on the four quadrants, N, one a scan, from the recording.
    fn loads(&self, recording: &Recording, force: &ForceMap) -> anyhow::Result<Vec<[f64; 4]>> {
        let axis = |column: &str| -> anyhow::Result<Vec<f64>> {
            let mut drawn = self.grid.draw(recording.t_s(), &recording.series(column)?);
            if let Some(corner) = &force.low_pass_hz {
                pass(Pass::Low, *corner.get_ref(), self.grid.rate_hz(), &mut drawn);
            }
            let mut newtons = self.grid.thin(&drawn);
            newtons.iter_mut().for_each(|value| *value *= force.scale.get_ref());
            Ok(newtons)
        };
        let normal = axis(&force.normal)?;
        let x = axis(&force.shear_x)?;
        let y = match &force.shear_y {
            Some(column) => axis(column)?,
            None => vec![0.0; x.len()],
        };
        // A finger is pressed or it is not: a negative normal force is the load cell's own noise.
        let quadrants = |((normal, x), y): ((&f64, &f64), &f64)| fsr_quadrants_n(normal.max(0.0), *x, *y);
        Ok(normal.iter().zip(&x).zip(&y).map(quadrants).collect())
    }

    fn held_loads(&self, hold: &HoldForce) -> Vec<[f64; 4]> {
        let load = |scan| {
            let since_s = f64::from(scan as u32) / f64::from(SCAN_HZ) - hold.after_s;
            let part = match since_s {
                s if s < 0.0 => 0.0,
                s if s < hold.ramp_s => s / hold.ramp_s,
                _ => 1.0,
            };
            fsr_quadrants_n(part * hold.normal_n, part * hold.shear_n, 0.0)
        };
        (0..self.grid.scans).map(load).collect()
    }

    fn press(&mut self, loads: Vec<[f64; 4]>) {
        for quadrant in 0..channel::FSR_COUNT {
            self.tracks.push(Track {
                volts: loads.iter().map(|load| fsr_mv(load[quadrant], f64::powf) / 1e3).collect(),
                pins: vec![(FSR + quadrant, 0.0)],
                clip_v: [0.05, 3.2],
            });
        }
    }
}

impl Plant for ReplayPlant {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        self.pins.0 = self.still.0;
        for track in &self.tracks {
            // A board that runs a scan or two longer than asked hears the last one again.
            let Some(volts) = track.volts.get(self.next).or(track.volts.last()) else {
                continue;
            };
            for &(index, offset_v) in &track.pins {
                self.pins.0[index] = (offset_v + volts).clamp(track.clip_v[0], track.clip_v[1]);
            }
        }
        for volts in &mut self.pins.0 {
            *volts += self.noise_v.sample(&mut self.rng);
        }
        self.next += 1;
        &self.pins
    }

    fn calibrated(&self) -> Option<Calibrated> {
        self.calibrated.map(|model| Calibrated::Words(model.to_words()))
    }

    fn duration_s(&self) -> f64 {
        self.grid.scans as f64 / f64::from(SCAN_HZ)
    }
}

fn rest_v(index: usize) -> f64 {
    f64::from(CHANNELS[index].rest_mv) / 1e3
}

fn mean<'a>(values: impl Iterator<Item = &'a f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::in_volts;

    #[test]
    fn what_no_pin_can_have_is_refused_with_its_likely_unit() {
        assert_eq!(in_volts(&[0.0, 1.65, 3.3, f64::NAN]), Ok(()));
        for (rows, says) in [
            ([1_650.0, 1_672.5], "millivolts"),
            ([2_048.0, 4_000.0], "12 bits"),
            ([8_190.0, 9_000.0], "14 bits"),
            ([8_190.0, 60_000.0], "16 bits"),
            ([1_650_000.0, 1_672_000.5], "microvolts"),
            ([-0.2, 0.3], "below 0"),
        ] {
            let said = in_volts(&rows).unwrap_err();
            assert!(said.contains(says) && said.contains("recipe"), "{rows:?}: {said}");
        }
    }
}
