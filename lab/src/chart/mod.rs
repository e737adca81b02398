//! The charts of `tenax chart`, one module each; `docs/` has the pages that show them.

pub mod emg;
pub mod front;
pub mod table;

use tenax_sim::plot::sheet::Sheet;
use tenax_sim::plot::sheet::draw::svg;

/// A chart and the numbers in it.
#[derive(Clone, Debug)]
pub struct Chart {
    pub name: &'static str,
    pub svg: String,
    pub csv: String,
}

impl Chart {
    fn new(name: &'static str, sheet: &Sheet, csv: String) -> anyhow::Result<Self> {
        Ok(Self { name, svg: svg(sheet)?, csv })
    }
}

/// Told how much is done, from 0 to 1.
pub type Progress<'a> = tenax_sim::jobs::Told<'a>;

/// The rows of a CSV file, under the names of its columns, `a,b,c`.
fn csv(header: &str, rows: impl IntoIterator<Item = Vec<String>>) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header.split(','))?;
    for row in rows {
        writer.write_record(row)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
