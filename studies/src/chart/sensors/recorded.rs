//! The recordings' side of the chart. A recording that is not there is an empty panel, not an error.

use std::path::Path;

use super::model::{Curve, peak_at_zero};

/// The plate's encoder passes this at first motion, mm/s: the recording's own mark.
const MOVES_MM_S: f64 = 2.0;
/// The rig's rows a second, thinned to the scans' rate or less.
const EVERY: usize = 2;

/// The two films at the onset of slip, mV.
pub fn films(folder: &Path) -> Vec<Curve> {
    let rows = read(&folder.join("pvdf_slip_onset.csv"));
    let film = |column: usize| {
        let mv: Vec<f64> = rows.iter().filter_map(|row| Some(row.get(column)? * 1e3)).collect();
        Curve { name: format!("recorded {column}"), points: peak_at_zero(mv) }
    };
    if rows.is_empty() { Vec::new() } else { vec![film(1), film(2)] }
}

/// Ft/Fn of the rig's finger.
pub fn rig(folder: &Path) -> Vec<Curve> {
    let rows = read(&folder.join("friction_rig_10khz.csv"));
    let moves =
        rows.iter().find(|row| matches!(row[..], [t_s, _, _, mm_s, ..] if t_s > 1.0 && mm_s >= MOVES_MM_S));
    let Some(&moves_s) = moves.and_then(|row| row.first()) else { return Vec::new() };
    let ratio = |row: &Vec<f64>| match row[..] {
        [t_s, shear_n, normal_n, ..] if (-0.02..0.12).contains(&(t_s - moves_s)) => {
            Some((t_s - moves_s, shear_n / normal_n))
        }
        _ => None,
    };
    vec![Curve {
        name: "recorded".to_owned(),
        points: rows.iter().filter_map(ratio).step_by(EVERY).collect(),
    }]
}

/// The rows of numbers of a file; none if there is no such file.
fn read(file: &Path) -> Vec<Vec<f64>> {
    let Ok(mut reader) = csv::Reader::from_path(file) else { return Vec::new() };
    let numbers = |row: csv::StringRecord| row.iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    reader.records().filter_map(Result::ok).map(numbers).collect()
}
