//! The chart of `tenax chart photoelastic`: the head's curve, how well its force is followed, and what slip looks like.

use serde::Serialize;
use tenax_scene::physics::stribeck::Slider;
use tenax_scene::sensor::photoelastic::HEAD_STRIP;
use tenax_scene::sensor::photoelastic::curve::{Day, Making};
use tenax_scene::sensor::photoelastic::optics::Layer;

use super::{Chart, Progress, csv};
use crate::photoelastic::balance;
use crate::photoelastic::force::{self, Point, Score};
use crate::photoelastic::rate::{self, Material, Rig, Seen};
use crate::photoelastic::region::{self, Region};
use tenax_frames::quantile::middle;
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Heads on whose days the rate is fitted, and their first days.
const HEADS: [u64; 4] = [1, 2, 3, 4];
/// Seeds of what is measured: no number of the logic was chosen by them.
const VALIDATION: std::ops::Range<u64> = 2_001..2_061;
/// Heads whose slowest visible slip is looked for.
const FLOORS: usize = 20;
const STORIES: usize = 6;
const SLIPS: usize = 10;
/// Rates of the curves, mm/s.
const RATES_MM_S: [f64; 9] = [0.05, 0.1, 0.2, 0.4, 0.6, 1.0, 1.6, 2.3, 3.0];

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Report {
    pub force: Score,
    /// With the shear of a lift: none to half of the force.
    pub force_sheared: Score,
    pub rate: Rate,
    /// Deviation of the boundary of vibration from theory, %.
    pub boundary_pct: f64,
    /// The slowest slip of aluminium that every head sees, mm/s.
    pub slip_floor_mm_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// Median error on days that were not calibrated on, %.
    pub median_pct: f64,
    /// On plastic, with aluminium's calibration.
    pub other_material_pct: f64,
}

/// Runs everything and draws it. Fails if the chart cannot be drawn.
pub fn chart(progress: Progress) -> anyhow::Result<(Chart, Report)> {
    let [runs, lifts] = [false, true].map(|sheared| force::sessions(VALIDATION, STORIES, sheared));
    let [force, force_sheared] = [&runs, &lifts].map(|runs| Score::of(runs.iter().map(Vec::as_slice)));
    progress(0.3);
    let (median_pct, other_material_pct) = rates(&|part| progress(0.3 + 0.4 * part));
    let region = region::region(&mut |part| progress(0.7 + 0.1 * part));
    let slip_floor_mm_s = region::floor_mm_s(VALIDATION.take(FLOORS));
    progress(0.9);
    let curves = Material::ALL.map(|material| (material, curve(material)));
    let report = Report {
        force,
        force_sheared,
        rate: Rate { median_pct, other_material_pct },
        boundary_pct: region.boundary_pct,
        slip_floor_mm_s,
    };
    let sheet = Sheet::new(
        "A photoelastic head: force from its light, slip from its flicker",
        format!(
            "Heads, days and stories of seeds {} to {}; curves of the mean head. Friction and strip: assumed.",
            VALIDATION.start,
            VALIDATION.end - 1
        ),
        2,
        vec![
            intensity(),
            followed("ramps without shear", &runs[0]),
            followed("ramps with the shear of a lift", &lifts[0]),
            against_rate("ac part, mean size", Axis::log("mV", 0.5, 100.0), &curves, |seen| {
                seen.amplitude_mv
            }),
            against_rate("ac part, frequency", Axis::even("Hz", 0.0, 200.0), &curves, |seen| seen.hz),
            map(&region),
        ],
    );
    let csv = table(&curves, &region)?;
    progress(1.0);
    Ok((Chart::new("photoelastic", &sheet, csv)?, report))
}

/// Each head is calibrated on four days, and asked on four others; then on plastic.
fn rates(progress: Progress) -> (f64, f64) {
    let (mut errors, mut others) = (Vec::new(), Vec::new());
    for (n, head) in HEADS.into_iter().enumerate() {
        let days = |from: u64, material| -> Vec<Seen> {
            (from..from + 4).flat_map(|day| rate::slips(head, 100 * head + day, material, SLIPS)).collect()
        };
        let fit = rate::fit(&days(1, Material::Aluminium));
        errors.extend(rate::errors_percent(&fit, &days(2_000, Material::Aluminium)));
        others.extend(rate::errors_percent(&fit, &days(3_000, Material::Plastic)[..SLIPS]));
        progress((n + 1) as f64 / HEADS.len() as f64);
    }
    [errors, others].map(|errors| middle(errors).unwrap_or(f64::NAN)).into()
}

fn curve(material: Material) -> Vec<Seen> {
    let slider = Slider { friction: material.friction(), ..HEAD_STRIP };
    RATES_MM_S.map(|rate| Rig::mean(slider, 1).slide(region::LOAD_N, rate, 0.8 + 0.1 / rate)).to_vec()
}

fn intensity() -> Panel {
    let calibration = balance::weigh(&Making::MEAN, &Day::FIRST, 1.into());
    let Making { dark_mv, span_mv, .. } = Making::MEAN;
    let printed = (0..=600)
        .map(|n| f64::from(n) / 100.0)
        .map(|force_n| (force_n, dark_mv + span_mv * Layer::DUBEY.intensity(force_n, 0.0)));
    let weighed = calibration.weighed.iter().map(|w| (w.force_n, w.level_mv));
    let read = calibration.weighed.iter().map(|w| (w.read_n, w.level_mv));
    Panel::new(
        "light against force",
        Axis::even("force, N", 0.0, 6.0),
        Axis::even("mV", 0.0, 3_000.0),
        vec![
            Series::new("equation 9 as printed", colour::GREY, Mark::Dashes, printed),
            Series::new("known weights", colour::VERMILLION, Mark::Crosses, weighed),
            Series::new("calibrated curve", colour::BLUE, Mark::Line, read),
        ],
    )
}

fn followed(title: &str, run: &[Point]) -> Panel {
    let begin_s = run.first().map_or(0.0, |point| point.t_s);
    let end_s = run.last().map_or(1.0, |point| point.t_s - begin_s);
    let at = |point: &Point| point.t_s - begin_s;
    let ends = |end: fn(&Point) -> f64, certain: bool| -> Vec<(f64, f64)> {
        run.iter()
            .filter(|point| point.is_certain == certain)
            .map(|point| (at(point), end(point).min(6.5)))
            .collect()
    };
    let both =
        |certain| [ends(|point| point.range_n.0, certain), ends(|point| point.range_n.1, certain)].concat();
    Panel::new(
        title,
        Axis::even("time, s", 0.0, end_s),
        Axis::even("force, N", 0.0, 6.5),
        vec![
            Series::new("true force", colour::ORANGE, Mark::Line, run.iter().map(|p| (at(p), p.true_n))),
            Series::new("least and most, certain", colour::BLUE, Mark::Dots, both(true)),
            Series::new("least and most, either branch", colour::GREY, Mark::Dots, both(false)),
        ],
    )
}

fn against_rate(title: &str, y: Axis, curves: &[(Material, Vec<Seen>)], of: impl Fn(&Seen) -> f64) -> Panel {
    let all = curves.iter().zip([colour::BLUE, colour::GREEN]).flat_map(|((material, seen), colour)| {
        let points: Vec<_> = seen.iter().map(|seen| (seen.rate_mm_s, of(seen))).collect();
        [Mark::Line, Mark::Dots].map(|mark| Series::new(material.name(), colour, mark, points.clone()))
    });
    Panel::new(title, Axis::log("slip rate, mm/s", 0.04, 4.0), y, all.collect())
}

fn map(region: &Region) -> Panel {
    let points = |seen: bool| {
        let points = region.points.iter().filter(move |point| point.seen == seen);
        points.map(|point| (point.rate_mm_s, point.steepness_s_m))
    };
    let theory = (8..=200).filter_map(|n| {
        let drop = f64::from(n) / 2_000.0;
        Some((region::theory_mm_s(drop)?, region::steepness_s_m(drop)))
    });
    let measured = region.boundary.iter().map(|(steepness, _, measured)| (*measured, *steepness));
    Panel::new(
        "where slip is seen; vibrates by itself to the left of the line",
        Axis::log("slip rate, mm/s", 0.04, 12.0),
        Axis::even("fall of friction at rest, s/m", 0.0, 36.0),
        vec![
            Series::new("slip said", colour::BLUE, Mark::Dots, points(true)),
            Series::new("not said", colour::GREY, Mark::Crosses, points(false)),
            Series::new("c + P dmu/dv = 0", colour::VERMILLION, Mark::Line, theory),
            Series::new("boundary as measured", colour::VERMILLION, Mark::Rings, measured),
        ],
    )
}

/// Slips and boundary, one row each.
fn table(curves: &[(Material, Vec<Seen>)], region: &Region) -> anyhow::Result<String> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let row = |what: &str, which: String, x: f64, y: f64| {
        vec![what.to_owned(), which, format!("{x:.5}"), format!("{y:.5}")]
    };
    for (material, seen) in
        curves.iter().flat_map(|(material, seen)| seen.iter().map(move |own| (material, own)))
    {
        rows.push(row("ac_mv", material.name().to_owned(), seen.rate_mm_s, seen.amplitude_mv));
        rows.push(row("ac_hz", material.name().to_owned(), seen.rate_mm_s, seen.hz));
    }
    for (steepness, theory, measured) in &region.boundary {
        rows.push(row("boundary_mm_s", format!("{steepness:.3} s/m"), *theory, *measured));
    }
    for point in &region.points {
        let seen = f64::from(u8::from(point.seen));
        rows.push(row("seen", format!("{:.3} s/m", point.steepness_s_m), point.rate_mm_s, seen));
    }
    csv("what,which,x,y", rows)
}
