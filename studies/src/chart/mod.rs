//! The charts of `tenax chart scenes`: where each way of stepping friction fails, and what it costs where it does not.
//! Of `tenax chart sensors`: the scenes' sensors beside real ones. Of `tenax chart detectors`: what detectors from normal
//! force get wrong against what they cost. Of `tenax chart array`: where the one that ships fails. Of `tenax chart front`: newtons beyond need against
//! millimetres slid, and decision delay by stiffness by gain. Of `tenax chart
//! features`: what tells slip from rest. Of `tenax chart photoelastic`: what a photoelastic head tells of force and slip.
//! Of `tenax chart onset`: how soon the slip of a lift could be told. And of `tenax chart vision`: what finding an object
//! costs, and how known loads are told.

pub mod array;
mod cost;
pub mod delay;
pub mod detectors;
pub mod features;
pub mod front;
mod growth;
pub mod loads;
mod map;
pub mod onset;
mod patch;
pub mod photoelastic;
pub mod sensors;
pub mod vision;

use plotters::style::RGBColor;
use tenax_plot::sheet::draw;
use tenax_scene::stepping::SHIPPED_S;

use tenax_plot::figure::colour;

/// A chart and the numbers in it.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Its file name, without extension.
    pub name: &'static str,
    /// The drawing.
    pub svg: String,
    /// The numbers.
    pub csv: String,
}

/// Told how much is done, from 0 to 1.
pub type Progress<'a> = tenax_bench::jobs::Told<'a>;

/// Runs everything and draws it. Times are of this machine; all else is the same on every one.
///
/// # Errors
/// If a chart cannot be drawn.
pub fn scenes(progress: Progress) -> anyhow::Result<Vec<Chart>> {
    // Parts of the whole time, as measured.
    let map = map::chart(&|part| progress(0.85 * part))?;
    let cost = cost::chart(&|part| progress(0.85 + 0.13 * part))?;
    let rest = [patch::chart()?, growth::chart()?];
    progress(1.0);
    Ok([map, cost].into_iter().chain(rest).collect())
}

/// The colour of a method, by its place in [`tenax_scene::stepping::methods`].
const METHOD: [RGBColor; 5] =
    [colour::VERMILLION, colour::ORANGE, colour::GREEN, colour::PURPLE, colour::BLUE];

/// An error from here on is no answer.
const FAILED: f64 = 1.0;

/// The scenes' step, us.
const SHIPPED_US: f64 = SHIPPED_S * 1e6;

/// The rows of a CSV file, under its header.
fn csv(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in rows {
        writer.write_record(row)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
