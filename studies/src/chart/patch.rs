//! The brush patch: its curve, its stick zone, and how its error and its cost go with the number of elements.

use std::num::NonZeroU16;
use std::time::{Duration, Instant};

use tenax_scene::physics::brush::{BrushPatch, ELEMENTS, Pad, closed_form};
use tenax_scene::physics::friction::Friction;

use super::{Chart, csv};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

const PAD: Pad = Pad { radius_m: 0.005, stiffness_n_per_m3: 2.55e7 };
const NORMAL_N: f64 = 2.0;
const PLAIN: Friction = Friction { mu_s: 0.5, mu_d: 0.5 };
/// Numbers of elements.
const COUNTS: [u16; 11] = [1, 2, 4, 8, 12, 16, 24, 32, 64, 128, 256];
/// Displacements on the way to macro slip: a prime, so that they fall on no ring.
const LOOKS: u16 = 4_801;
/// A run is repeated until so much time is over, and the quickest counts.
const TIMED: Duration = Duration::from_millis(12);

/// What `run` gives, and the quickest of its times.
fn timed<T>(run: impl Fn() -> T) -> (T, Duration) {
    let begun = Instant::now();
    let result = run();
    let mut quickest = begun.elapsed();
    while begun.elapsed() < TIMED {
        let again = Instant::now();
        std::hint::black_box(run());
        quickest = quickest.min(again.elapsed());
    }
    (result, quickest)
}

/// Q / (mu P) and c / a on the way to macro slip.
fn dragged(elements: NonZeroU16) -> Vec<(f64, f64, f64)> {
    let by_m = PAD.macro_slip_m(NORMAL_N, PLAIN.mu_s) / f64::from(LOOKS);
    let mut patch = BrushPatch::new(PAD, elements);
    let look = |n: u16| {
        let shear_n = patch.step(NORMAL_N, PLAIN, by_m).shear_n;
        (f64::from(n) / f64::from(LOOKS), shear_n / (PLAIN.mu_s * NORMAL_N), patch.stick_radius_part())
    };
    (1..=LOOKS).map(look).collect()
}

/// The worst error of Q / (mu P), and the time of a step, ns.
fn error_and_cost(elements: NonZeroU16) -> (f64, f64) {
    let (curve, taken) = timed(|| dragged(elements));
    let error = curve.iter().map(|(s, shear, _)| (shear - closed_form::shear(*s)).abs()).fold(0.0, f64::max);
    (error, taken.as_secs_f64() * 1e9 / f64::from(LOOKS))
}

pub fn chart() -> anyhow::Result<Chart> {
    let measured: Vec<(u16, f64, f64)> = COUNTS
        .iter()
        .filter_map(|&count| NonZeroU16::new(count))
        .map(|elements| {
            let (error, cost_ns) = error_and_cost(elements);
            (elements.get(), error, cost_ns)
        })
        .collect();
    let rows = measured.iter().map(|(elements, error, cost_ns)| {
        vec![elements.to_string(), format!("{error:.4e}"), format!("{cost_ns:.1}")]
    });
    let csv = csv(&["elements", "worst_error_of_mu_p", "time_ns_per_step"], rows)?;
    let sheet = Sheet::new(
        "The brush patch: rings of evenly spaced pressure",
        format!(
            "Shipped: {ELEMENTS} rings. The half-space has the same stiffness at rest, so s means the same."
        ),
        2,
        vec![shear(), stick_zone(), convergence(&measured), cost(&measured)],
    );
    Chart::new("brush-patch", &sheet, csv)
}

/// A few of the sum's points: so many that the curve under them is still seen.
fn sum(point: impl Fn(&(f64, f64, f64)) -> (f64, f64)) -> Series {
    let rings = dragged(ELEMENTS);
    let points = rings.iter().step_by(200).map(point);
    Series::new("sum of 24 rings", colour::BLUE, Mark::Dots, points)
}

fn shear() -> Panel {
    let brush = |s| (s, closed_form::shear(s));
    let half_space = |s| (s, closed_form::half_space_shear(s));
    let x = Axis::even("s = k delta / (mu p0)", 0.0, 1.0);
    let sum = sum(|&(s, shear, _)| (s, shear));
    beside("shear on the way to macro slip", x, Axis::even("Q / (mu P)", 0.0, 1.05), brush, half_space, sum)
}

fn stick_zone() -> Panel {
    let brush = |s| (closed_form::shear(s), closed_form::stick_radius(s));
    let half_space = |q| (q, closed_form::half_space_stick_radius(q));
    let (x, y) = (Axis::even("Q / (mu P)", 0.0, 1.0), Axis::even("c / a", 0.0, 1.05));
    beside("what still sticks", x, y, brush, half_space, sum(|&(_, shear, radius)| (shear, radius)))
}

/// The brush in closed form, the half-space, and the sum of the rings.
fn beside(
    title: &str,
    x: Axis,
    y: Axis,
    brush: impl Fn(f64) -> (f64, f64),
    half_space: impl Fn(f64) -> (f64, f64),
    sum: Series,
) -> Panel {
    let parts = || (0..=40).map(|n| f64::from(n) / 40.0);
    let brush = Series::new("brush: (3 s - s³) / 2", colour::BLUE, Mark::Line, parts().map(brush));
    let name = "elastic half-space (Cattaneo, Mindlin)";
    let half_space = Series::new(name, colour::VERMILLION, Mark::Dashes, parts().map(half_space));
    Panel::new(title, x, y, vec![brush, half_space, sum])
}

fn convergence(measured: &[(u16, f64, f64)]) -> Panel {
    let predicted = [1.0, 256.0].map(|n| (n, 0.375 / (n * n)));
    let points = measured.iter().map(|(n, error, _)| (f64::from(*n), *error));
    Panel::new(
        "error against the number of rings",
        Axis::log("N", 0.8, 320.0),
        Axis::log("worst error of Q / (mu P)", 1e-6, 1.0),
        vec![
            Series::new("predicted: 0.375 / N²", colour::GREY, Mark::Line, predicted),
            Series::new("measured", colour::GREEN, Mark::Dots, points),
        ],
    )
}

fn cost(measured: &[(u16, f64, f64)]) -> Panel {
    let points = measured.iter().map(|(_, error, cost_ns)| (*cost_ns, *error));
    let words = measured.iter().map(|(n, error, cost_ns)| (*cost_ns, *error, format!("N = {n}")));
    let (x, y) =
        (Axis::log("time of a step, ns", 1.0, 1e4), Axis::log("worst error of Q / (mu P)", 1e-6, 1.0));
    let series = vec![Series::new("measured", colour::GREEN, Mark::Dots, points)];
    Panel { words: words.collect(), ..Panel::new("error against cost", x, y, series) }
}
