//! Calibrates a skin under known loads, and tries the calibration on loads that it has not seen.
//!
//! A table names a picture a row: `image,mass_g,fx_n,fy_n,fz_n`, with x to the picture's right, y into the skin, z the
//! picture's other direction. Rows of mass 0 show the skin at rest.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use tenax_vision::force::MIDDLE;
use tenax_vision::frame::{FRAME_BYTES, Frame, plane};
use tenax_vision::loads::{Features, Loads, NORMAL_FEATURES, SHEAR_FEATURES};
use tenax_vision::markers::{Calibration, Marker, Markers};

use super::source::Source;
use crate::equations::Equations;

/// Ridge of the shear's weights, px^2.
const SHEAR_RIDGE: f64 = 1.0;
/// Freedom of each marker's weight from a plane through all of them. Both were chosen by leaving out loads,
/// and all loads of a mass: what is learned under light loads then holds under heavy ones.
const FREE: f64 = 0.1;
/// Ridge of the normal force's.
const NORMAL_RIDGE: f64 = 0.5;
/// Normal force above which its relative error counts, N.
const NORMAL_MIN_N: f64 = 3.0;

/// Terms of the shear that all markers have together.
const SMOOTH: usize = 3;
/// A weight of each of the shear's features.
type OfEach = [f64; SHEAR_FEATURES];

#[derive(Clone, Debug, Deserialize)]
struct Row {
    image: String,
    mass_g: f64,
    fx_n: f64,
    fy_n: f64,
    fz_n: f64,
}

/// A picture under a known load.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Load on the skin, g.
    pub mass_g: f64,
    /// Force: x, into the skin, z; N.
    pub force_n: [f64; 3],
    features: Features,
}

impl Sample {
    /// Spread of the markers about their mean move, px rms.
    pub fn spread_px(&self) -> f64 {
        self.features.normal[0].into()
    }

    /// The force that a calibration makes of it: x, into the skin, z; N.
    pub fn estimate_n(&self, loads: &Loads) -> [f64; 3] {
        let force = loads.newtons(&self.features);
        [force.x, force.normal, force.y].map(f64::from)
    }
}

/// Errors of a calibration on samples.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Score {
    pub pictures: usize,
    /// Shear along x, N rms.
    pub x_rms_n: f64,
    /// Shear along z, N rms.
    pub z_rms_n: f64,
    /// Normal force above 3 N: error of the load, rms.
    pub normal_rms_share: Option<f64>,
    /// Share of those pictures within 15 % of the load.
    pub normal_within_15_percent: Option<f64>,
}

/// The skin of a folder of pictures.
#[derive(Clone, Debug)]
pub struct Skin {
    markers: Markers,
}

/// The rows of a table, with the pictures' paths: in the folder `loads` beside it, or beside it.
fn rows_of(table: &Path) -> Result<Vec<(Row, PathBuf)>> {
    let mut reader =
        csv::Reader::from_path(table).with_context(|| format!("cannot read {}", table.display()))?;
    let rows = reader.deserialize().collect::<Result<Vec<Row>, _>>();
    let rows = rows.with_context(|| format!("{} is no table of loads", table.display()))?;
    let folder = table.parent().unwrap_or(Path::new("."));
    let find = |row: Row| {
        let places = [folder.join("loads"), folder.to_owned(), table.with_extension("")];
        let found = places.iter().map(|place| place.join(&row.image)).find(|path| path.exists());
        let path = found.with_context(|| format!("the picture {} is not there", row.image))?;
        Ok((row, path))
    };
    rows.into_iter().map(find).collect()
}

fn for_each_picture(paths: Vec<PathBuf>, mut each: impl FnMut(usize, &Frame) -> Result<()>) -> Result<()> {
    let wanted = paths.len();
    let mut pictures = Source::Pictures(paths).open()?;
    let mut planes: Box<[u8; FRAME_BYTES]> =
        vec![0; FRAME_BYTES].try_into().ok().context("a picture's size")?;
    let mut number = 0;
    while number < wanted && pictures.next(&mut planes)? {
        each(number, &Frame::from_gbrp(&planes[..]).context("a picture's size")?)?;
        number += 1;
    }
    if number != wanted {
        bail!("ffmpeg decoded {number} of {wanted} pictures");
    }
    Ok(())
}

impl Skin {
    /// The skin whose pictures at rest are in a table. Fails if there are none, or hardly a marker is seen in them.
    pub fn at_rest(table: &Path) -> Result<Self> {
        let rest: Vec<PathBuf> =
            rows_of(table)?.into_iter().filter(|(row, _)| row.mass_g == 0.0).map(|(_, path)| path).collect();
        if rest.is_empty() {
            bail!("{} has no pictures of mass 0, which show the skin at rest", table.display());
        }
        // As often as a calibration wants pictures.
        let mut again = rest.clone();
        while again.len() < tenax_vision::markers::CALIBRATION_FRAMES as usize {
            again.extend(rest.iter().cloned());
        }
        let (mut calibration, mut grey) = (Calibration::default(), plane());
        for_each_picture(again, |_, frame| {
            frame.grey(&mut grey);
            calibration.frame(&grey);
            Ok(())
        })?;
        let markers = Markers::new(&calibration);
        if markers.len() < 6 {
            bail!("{} markers are too few for a force", markers.len());
        }
        Ok(Self { markers })
    }

    pub fn markers(&self) -> usize {
        self.markers.len()
    }

    /// The samples of a table of loads on this skin. Fails if pictures cannot be read, or too few markers are found in one.
    pub fn samples(&self, table: &Path) -> Result<Vec<Sample>> {
        let (rows, paths): (Vec<Row>, Vec<PathBuf>) = rows_of(table)?.into_iter().unzip();
        let mut grey = plane();
        let mut samples = Vec::new();
        for_each_picture(paths, |number, frame| {
            let row = &rows[number];
            frame.grey(&mut grey);
            let mut markers = self.markers.clone();
            markers.locate(&grey);
            let features =
                Features::of(&markers).with_context(|| format!("too few markers in {}", row.image))?;
            samples.push(Sample { mass_g: row.mass_g, force_n: [row.fx_n, row.fy_n, row.fz_n], features });
            Ok(())
        })?;
        Ok(samples)
    }
}

impl Skin {
    fn smooth(&self) -> [[OfEach; SMOOTH]; 2] {
        let place = |marker: &Marker| {
            let at = marker.rest.at;
            vec![1.0, f64::from(at.x - MIDDLE.x) / 100.0, f64::from(at.y - MIDDLE.y) / 100.0]
        };
        let places: Vec<_> = self.markers.iter().map(place).collect();
        let mut terms = [[[0.0; SHEAR_FEATURES]; SMOOTH]; 2];
        for number in 0..places.len() {
            let mut only = vec![0.0; places.len()];
            only[number] = 1.0;
            // What this marker's move adds to the plane: its middle, its slopes to the right and down.
            let [middle, right, down] = ridge(&places, &only, 1e-3)[..] else { continue };
            for (own, axis) in terms.iter_mut().zip(0..) {
                let (along, aside) = (3 * number + axis, 3 * number + 1 - axis);
                (own[0][along], own[1][along], own[2][aside]) = (middle, down, right);
            }
        }
        terms
    }

    /// Weights that bring the samples' features nearest to their forces; light loads count more, for errors are relative.
    /// Fails if there are no samples.
    pub fn fit(&self, samples: &[Sample]) -> Result<Loads> {
        if samples.is_empty() {
            bail!("no loads to calibrate on");
        }
        let mut loads = Loads { shear: [[0.0; 2]; SHEAR_FEATURES], normal: [0.0; NORMAL_FEATURES] };
        // The picture's y goes down, which is against z.
        for (axis, (terms, of)) in self.smooth().iter().zip([0, 2]).enumerate() {
            let row = |sample: &Sample| -> Vec<f64> {
                let own = sample.features.shear.map(f64::from);
                let smooth = terms.iter().map(|term| term.iter().zip(own).map(|(a, b)| a * b).sum());
                smooth.chain(own.map(|value| FREE * value)).collect()
            };
            let weights = unshrunk(samples, of, SHEAR_RIDGE, row);
            let (smooth, free) = weights.split_at(SMOOTH);
            for (feature, slot) in loads.shear.iter_mut().enumerate() {
                let common: f64 = terms.iter().zip(smooth).map(|(term, weight)| term[feature] * weight).sum();
                slot[axis] = (common + FREE * free[feature]) as f32;
            }
        }
        let normal =
            weighted(samples, 1, NORMAL_RIDGE, |sample| sample.features.normal.map(f64::from).to_vec());
        loads.normal.iter_mut().zip(normal).for_each(|(slot, value)| *slot = value as f32);
        Ok(loads)
    }
}

fn weight(sample: &Sample) -> f64 {
    1.0 / (0.5 + 0.1 * sample.force_n.iter().map(|force| force * force).sum::<f64>().sqrt())
}

/// A ridge regression of the samples' force along an axis.
fn weighted(samples: &[Sample], axis: usize, by: f64, row: impl Fn(&Sample) -> Vec<f64>) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = samples
        .iter()
        .map(|sample| row(sample).iter().map(|value| value * weight(sample)).collect())
        .collect();
    let targets: Vec<f64> = samples.iter().map(|sample| sample.force_n[axis] * weight(sample)).collect();
    ridge(&rows, &targets, by)
}

/// A ridge regression, scaled so that its estimates of the samples are as large as their forces. A regression tells less: the loads are
/// known, and what scatters are the moves, since a block is never set down twice alike. Under heavier loads than it has learned
/// that would be missing.
fn unshrunk(samples: &[Sample], axis: usize, by: f64, row: impl Fn(&Sample) -> Vec<f64>) -> Vec<f64> {
    let mut weights = weighted(samples, axis, by, &row);
    let (mut told, mut known) = (0.0, 0.0);
    for sample in samples {
        let squared = weight(sample) * weight(sample);
        let force_n: f64 = row(sample).iter().zip(&weights).map(|(value, weight)| value * weight).sum();
        told += squared * force_n * sample.force_n[axis];
        known += squared * sample.force_n[axis] * sample.force_n[axis];
    }
    if told > 0.0 {
        weights.iter_mut().for_each(|weight| *weight *= known / told);
    }
    weights
}

fn ridge(rows: &[Vec<f64>], targets: &[f64], ridge: f64) -> Vec<f64> {
    let unknowns = rows.first().map_or(0, Vec::len);
    let mut equations = Equations::new(unknowns);
    rows.iter().zip(targets).for_each(|(row, target)| equations.add(row, 1.0, *target));
    (0..unknowns).for_each(|n| equations.add_to(n, ridge, 0.0));
    equations.solve()
}

pub fn score(loads: &Loads, samples: &[Sample]) -> Score {
    let forces: Vec<_> =
        samples.iter().map(|sample| (loads.newtons(&sample.features), sample.force_n)).collect();
    let rms = |errors: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = errors.fold((0.0, 0u32), |(sum, count), error| (sum + error * error, count + 1));
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    };
    let relative: Vec<f64> = forces
        .iter()
        .filter(|(_, truth)| truth[1] > NORMAL_MIN_N)
        .map(|(force, truth)| f64::from(force.normal) / truth[1] - 1.0)
        .collect();
    let within = relative.iter().filter(|error| error.abs() <= 0.15).count();
    Score {
        pictures: samples.len(),
        x_rms_n: rms(&mut forces.iter().map(|(force, truth)| f64::from(force.x) - truth[0]))
            .unwrap_or(f64::NAN),
        z_rms_n: rms(&mut forces.iter().map(|(force, truth)| f64::from(force.y) - truth[2]))
            .unwrap_or(f64::NAN),
        normal_rms_share: rms(&mut relative.iter().copied()),
        normal_within_15_percent: (!relative.is_empty()).then(|| within as f64 / relative.len() as f64),
    }
}

/// A load: truth and the mean estimate over its pictures, N.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Load {
    pub mass_g: f64,
    pub x_n: f64,
    pub normal_n: f64,
    pub z_n: f64,
    pub told_x_n: f64,
    pub told_normal_n: f64,
    pub told_z_n: f64,
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub markers: usize,
    pub learned: Score,
    /// Loads that nothing was learned from.
    pub tried: Option<Score>,
    pub loads: Vec<Load>,
}

/// The places of each load's samples.
pub fn by_load(samples: &[Sample]) -> Vec<Vec<usize>> {
    let mut loads: BTreeMap<[i64; 4], Vec<usize>> = BTreeMap::new();
    for (at, sample) in samples.iter().enumerate() {
        let [x, y, z] = sample.force_n;
        let key = [sample.mass_g, x, y, z].map(|value| (value * 1e4).round() as i64);
        loads.entry(key).or_default().push(at);
    }
    loads.into_values().collect()
}

/// Each load's truth and estimate.
pub fn table(loads: &Loads, samples: &[Sample]) -> Vec<Load> {
    let load = |own: Vec<usize>| {
        let told = |axis: usize| {
            own.iter().map(|&at| samples[at].estimate_n(loads)[axis]).sum::<f64>() / own.len() as f64
        };
        let Sample { mass_g, force_n: [x_n, normal_n, z_n], .. } = samples[own[0]];
        Load { mass_g, x_n, normal_n, z_n, told_x_n: told(0), told_normal_n: told(1), told_z_n: told(2) }
    };
    by_load(samples).into_iter().map(load).collect()
}

/// Samples whose mass is within 2 % of one of `masses_g`, and the others.
pub fn left_out(samples: &[Sample], masses_g: &[f64]) -> (Vec<Sample>, Vec<Sample>) {
    let is = |sample: &&Sample| masses_g.iter().any(|mass| (sample.mass_g - mass).abs() <= 0.02 * mass);
    (
        samples.iter().filter(is).cloned().collect(),
        samples.iter().filter(|sample| !is(sample)).cloned().collect(),
    )
}
