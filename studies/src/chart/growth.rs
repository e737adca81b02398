//! The Stribeck slider: when it vibrates by itself, how fast that grows, and what it sounds like.

use tenax_scene::physics::stribeck::{BLOCK_N, STRIP};
use tenax_scene::stepping::{SHIPPED_S, SelfExcited};

use super::{Chart, csv};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Sliding speeds, mm/s.
const SPEEDS: [f64; 12] = [2.9, 3.3, 3.6, 3.9, 4.2, 4.5, 4.8, 5.2, 5.6, 6.0, 7.0, 8.0];

pub fn chart() -> anyhow::Result<Chart> {
    let theory = |mm_s: f64| STRIP.small_signal(BLOCK_N, mm_s / 1e3);
    let measured: Vec<_> = SPEEDS
        .iter()
        .filter_map(|&mm_s| {
            let scene = SelfExcited { slider: STRIP, normal_n: BLOCK_N, surface_m_s: mm_s / 1e3 };
            scene.measured(SHIPPED_S).map(|signal| (mm_s, signal))
        })
        .collect();
    let rows = measured.iter().map(|(mm_s, signal)| {
        let right = theory(*mm_s);
        let figures = [signal.growth_per_s, right.growth_per_s, signal.omega_rad_s, right.omega_rad_s];
        std::iter::once(format!("{mm_s}")).chain(figures.map(|figure| format!("{figure:.4}"))).collect()
    });
    let header = ["speed_mm_s", "growth_per_s", "growth_theory_per_s", "omega_rad_s", "omega_theory_rad_s"];
    let csv = csv(&header, rows)?;

    let fine = || (0..=40).map(|n| 2.8 + 5.4 * f64::from(n) / 40.0);
    let hertz = |omega_rad_s: f64| omega_rad_s / std::f64::consts::TAU;
    let panel = |title: &str, y: Axis, line: Vec<(f64, f64)>, dots: Vec<(f64, f64)>| {
        let series = vec![
            Series::new("linearised equation", colour::BLUE, Mark::Line, line),
            Series::new("stepped by 125 us", colour::VERMILLION, Mark::Dots, dots),
            Series::new("c + P dmu/dv = 0", colour::GREY, Mark::Dashes, [(2.8, 0.0), (8.2, 0.0)]),
        ];
        Panel::new(title, Axis::even("sliding speed, mm/s", 2.8, 8.2), y, series)
    };
    let sheet = Sheet::new(
        "Vibrating by itself: the Stribeck slider near steady sliding",
        "Above zero a small vibration grows by itself, below it dies. Parameters of the strip: assumed.",
        2,
        vec![
            panel(
                "growth rate",
                Axis::even("growth, 1/s", -350.0, 300.0),
                fine().map(|mm_s| (mm_s, theory(mm_s).growth_per_s)).collect(),
                measured.iter().map(|(mm_s, signal)| (*mm_s, signal.growth_per_s)).collect(),
            ),
            panel(
                "frequency",
                Axis::even("frequency, Hz", 105.0, 122.0),
                fine().map(|mm_s| (mm_s, hertz(theory(mm_s).omega_rad_s))).collect(),
                measured.iter().map(|(mm_s, signal)| (*mm_s, hertz(signal.omega_rad_s))).collect(),
            ),
        ],
    );
    Chart::new("stribeck-growth", &sheet, csv)
}
