//! The chart of `tenax chart sensors`: what the scenes' sensors and friction say, beside real recordings where they are
//! at hand. The numbers that are written are the model's only: the recordings are for looking at.

mod model;
mod recorded;

use std::path::Path;

use super::{Chart, Progress, csv};
use model::{Curve, PickUp};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// A spectrum is shown from here on, Hz: one bin of a cut of 100 ms.
const FROM_HZ: f64 = 10.0;
/// To half the frame rate, Hz.
const TO_HZ: f64 = 1_000.0;

/// Runs the scenes and draws them beside what lies in `recordings`. Fails if a scene or the chart cannot be made.
pub fn chart(recordings: &Path, progress: Progress) -> anyhow::Result<Chart> {
    // Parts of the whole time, as measured.
    let films = model::films(&mut |part| progress(0.7 * part))?;
    let rig = model::rig()?;
    let pick_up = model::pick_up(&mut |part| progress(0.75 + 0.2 * part))?;
    let real_films = recorded::films(recordings);
    let real_rig = recorded::rig(recordings);
    let present = if real_films.is_empty() || real_rig.is_empty() {
        "Recordings not present: the model only."
    } else {
        "Recorded by others (shared/data/README.md), evaluation only; a film's sign means nothing and is turned up."
    };

    let all = [("film_mv", &films), ("rig_ft_over_fn", &rig)];
    let rows = all.iter().flat_map(|(what, curves)| {
        curves.iter().flat_map(move |curve| {
            let points = curve.points.iter();
            points.map(move |(x, y)| {
                vec![(*what).to_owned(), curve.name.clone(), format!("{x:.5}"), format!("{y:.5}")]
            })
        })
    });
    let csv = csv(&["what", "curve", "t_s", "value"], rows)?;

    let sheet = Sheet::new(
        "What the sensors say at the onset of slip",
        present,
        2,
        vec![
            Panel::new(
                "PVDF films, mV at the film; 0 is the peak",
                Axis::even("time, s", -0.04, 0.04),
                Axis::even("mV", -30.0, 50.0),
                beside(&real_films, &films),
            ),
            Panel::new(
                "the same 100 ms, by frequency",
                Axis::log("frequency, Hz", FROM_HZ, TO_HZ),
                Axis::log("amplitude of a bin, mV", 1e-3, 30.0),
                beside(&spectra(&real_films), &spectra(&films)),
            ),
            Panel::new(
                "friction rig: Ft/Fn; 0 is the plate's first motion",
                Axis::even("time, s", -0.02, 0.12),
                Axis::even("Ft/Fn", -0.1, 0.8),
                beside(&real_rig, &rig),
            ),
            picked(&pick_up),
        ],
    );
    Chart::new("sensors", &sheet, csv)
}

/// Tada 2006, figures 6 and 7: the camera's word against the contact's own state.
fn picked(pick_up: &PickUp) -> Panel {
    let series = vec![
        Series::new("camera, v1", colour::ORANGE, Mark::Dots, pick_up.v1.iter().copied()),
        Series::new("part that sticks", colour::GREEN, Mark::Line, pick_up.stuck_part.iter().copied()),
    ];
    let y = Axis::even("v1; part of the contact", -1.2, 1.2);
    Panel::new(
        "pick-up: the camera's v1 (-1 slips), and what sticks",
        Axis::even("time, s", 1.0, 4.5),
        y,
        series,
    )
}

fn beside(recorded: &[Curve], modelled: &[Curve]) -> Vec<Series> {
    let series =
        |curve: &Curve, name, colour| Series::new(name, colour, Mark::Line, curve.points.iter().copied());
    let recorded = recorded.iter().map(|curve| series(curve, "recorded", colour::VERMILLION));
    recorded.chain(modelled.iter().map(|curve| series(curve, "modelled", colour::BLUE))).collect()
}

/// The amplitude of each bin of the Fourier transform, by its definition: the cuts are short.
fn spectra(curves: &[Curve]) -> Vec<Curve> {
    curves.iter().map(|curve| Curve { name: curve.name.clone(), points: spectrum(&curve.points) }).collect()
}

fn spectrum(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let count = points.len();
    let [(first_s, _), .., (last_s, _)] = points else { return Vec::new() };
    let bin_hz = (count - 1) as f64 / (last_s - first_s) / count as f64;
    let mean = points.iter().map(|point| point.1).sum::<f64>() / count as f64;
    (1..count / 2)
        .map(|bin| {
            let (re, im) = points.iter().enumerate().fold((0.0, 0.0), |(re, im), (n, (_, value))| {
                let (sin, cos) = (std::f64::consts::TAU * (bin * n) as f64 / count as f64).sin_cos();
                (re + (value - mean) * cos, im + (value - mean) * sin)
            });
            (bin as f64 * bin_hz, 2.0 / count as f64 * (re * re + im * im).sqrt())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_is_in_its_bin_with_its_amplitude() {
        let tone =
            |n: u32| (f64::from(n) / 2e3, 3.0 * (std::f64::consts::TAU * 50.0 * f64::from(n) / 2e3).sin());
        let points: Vec<(f64, f64)> = (0..200).map(tone).collect();
        let loudest = spectrum(&points).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((loudest.0 - 50.0).abs() < 1e-6 && (loudest.1 - 3.0).abs() < 1e-9, "{loudest:?}");
    }

    #[test]
    fn without_recordings_it_is_drawn_all_the_same() {
        let chart = chart(Path::new("nowhere"), &|_| ()).unwrap();
        assert!(chart.svg.contains("Recordings not present") && chart.csv.lines().count() > 1_000);
    }
}
