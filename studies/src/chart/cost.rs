//! Error against time: what each method costs for what it gives.

use std::time::{Duration, Instant};

use plotters::style::RGBColor;
use tenax_scene::stepping::problem::{Problem, ShakenHold, error, problems};
use tenax_scene::stepping::{LuGre, Method, SHIPPED_S, methods};

use super::{Chart, FAILED, METHOD, Progress, csv, draw};
use tenax_plot::sheet::draw::INK;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Steps, as the shipped one times 2 to these powers: 3.9 us to 2 ms.
const POWERS: std::ops::RangeInclusive<i32> = -5..=4;
/// The reference is the same method at the shipped step over this.
const FINER: f64 = 1_024.0;
/// A run is repeated until so much time is over, and the quickest counts.
const TIMED: Duration = Duration::from_millis(12);

/// One method at one step on one problem.
struct Point {
    problem: &'static str,
    method: usize,
    dt_s: f64,
    us_per_s: f64,
    to_closed_form: Option<f64>,
    to_itself: f64,
}

impl Point {
    /// The error that the chart shows.
    fn error(&self) -> f64 {
        self.to_closed_form.unwrap_or(self.to_itself)
    }
}

pub fn chart(progress: Progress) -> anyhow::Result<Chart> {
    let (methods, problems) = (methods(LuGre::SHARP), problems());
    let all = (methods.len() * problems.len()) as f64;
    let mut points = Vec::new();
    let mut done = 0.0;
    for problem in &problems {
        for (n, method) in methods.iter().enumerate() {
            points.extend(measured(&**problem, n, &**method));
            done += 1.0;
            progress(done / all);
        }
    }
    let rows = points.iter().map(|point| {
        let mut row = vec![point.problem.to_owned(), methods[point.method].name().to_owned()];
        row.extend([point.dt_s * 1e6, point.us_per_s].map(|figure| format!("{figure:.4e}")));
        row.push(point.to_closed_form.map_or_else(String::new, |error| format!("{error:.4e}")));
        row.push(format!("{:.4e}", point.to_itself));
        row
    });
    let header = ["problem", "method", "step_us", "time_us_per_s", "error_to_closed_form", "error_to_itself"];
    let csv = csv(&header, rows)?;
    let names = methods.iter().map(|method| method.name()).collect::<Vec<_>>();
    let mut panels: Vec<Panel> = problems.iter().map(|problem| panel(&**problem, &names, &points)).collect();
    panels.push(creep(&methods));
    let sheet = Sheet {
        title: "What each step costs: error against time per simulated second".to_owned(),
        subtitle: "Each dot is a step, from 2 ms (left) to 3.9 us (right), halved each time. LuGre's bristle: 10⁶ N/m. One \
                   core; the times are those of the machine that drew it."
            .to_owned(),
        columns: 3,
        panels,
        errors: None,
    };
    Ok(Chart { name: "stepping-cost", svg: draw::svg(&sheet)?, csv })
}

fn measured(problem: &dyn Problem, method_place: usize, method: &dyn Method) -> Vec<Point> {
    let itself = problem.figures(method, SHIPPED_S / FINER);
    let closed_form = problem.closed_form();
    let point = |power: i32| {
        let dt_s = SHIPPED_S * 2_f64.powi(power);
        let (figures, taken) = timed(|| problem.figures(method, dt_s));
        Point {
            problem: problem.name(),
            method: method_place,
            dt_s,
            us_per_s: taken.as_secs_f64() * 1e6 / problem.duration_s(),
            to_closed_form: closed_form.as_ref().map(|right| error(&figures, right)),
            to_itself: error(&figures, &itself),
        }
    };
    POWERS.rev().map(point).collect()
}

/// What `run` gives, and the quickest of its times.
pub fn timed<T>(run: impl Fn() -> T) -> (T, Duration) {
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

fn panel(problem: &dyn Problem, names: &[&str], points: &[Point]) -> Panel {
    let against = if problem.closed_form().is_some() { "closed form" } else { "itself, step / 1024" };
    let (x, y) = (time_axis(), Axis::log("error", 1e-6, 3.0));
    let mut series = Vec::new();
    let (mut failed, mut shipped) = (Vec::new(), Vec::new());
    for (n, name) in names.iter().enumerate() {
        let mut good = Vec::new();
        for point in points.iter().filter(|point| point.problem == problem.name() && point.method == n) {
            if point.error() >= FAILED {
                // A run that is given up early takes next to no time.
                let us_per_s = point.us_per_s.max(1.2 * x.ends.0);
                failed.push(one(FAILED_NAME, METHOD[n], Mark::Crosses, vec![(us_per_s, 2.0)]));
                continue;
            }
            let at = (point.us_per_s, point.error().max(y.ends.0));
            good.push(at);
            if point.dt_s == SHIPPED_S {
                shipped.push(at);
            }
        }
        series.push(one(name, METHOD[n], Mark::Line, good.clone()));
        series.push(one(name, METHOD[n], Mark::Dots, good));
    }
    series.extend(failed);
    series.push(one(SHIPPED_NAME, INK, Mark::Rings, shipped));
    Panel {
        title: format!("{} (against {against})", problem.name()),
        x,
        y,
        cells: Vec::new(),
        series,
        words: Vec::new(),
    }
}

const FAILED_NAME: &str = "failed";
const SHIPPED_NAME: &str = "at the scenes' step, 125 us";

fn time_axis() -> Axis {
    Axis::log("time per simulated second, us", 1e1, 1e5)
}

fn one(name: &str, colour: RGBColor, mark: Mark, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.to_owned(), colour, mark, points }
}

/// What no smaller step cures: LuGre creeps.
fn creep(methods: &[Box<dyn Method>]) -> Panel {
    let hold = ShakenHold { duration_s: 10.0 };
    let (y_least, y_most, to_mm_per_h) = (1.0, 1e4, 1e3 * 3_600.0 / hold.duration_s);
    let mut series = Vec::new();
    let mut shipped = Vec::new();
    for (method, colour) in methods.iter().zip(METHOD) {
        let mut points = Vec::new();
        for power in (-3..=3).rev() {
            let dt_s = SHIPPED_S * 2_f64.powi(power);
            let (drift_m, taken) = timed(|| hold.drift_m(&**method, dt_s));
            let us_per_s = taken.as_secs_f64() * 1e6 / hold.duration_s;
            if !drift_m.is_finite() {
                series.push(one(FAILED_NAME, colour, Mark::Crosses, vec![(us_per_s, 0.7 * y_most)]));
                continue;
            }
            let at = (us_per_s, (drift_m.abs() * to_mm_per_h).max(y_least));
            points.push(at);
            if power == 0 {
                shipped.push(at);
            }
        }
        series.push(one(method.name(), colour, Mark::Line, points.clone()));
        series.push(one(method.name(), colour, Mark::Dots, points));
    }
    series.push(one(SHIPPED_NAME, INK, Mark::Rings, shipped));
    Panel {
        title: "held and shaken: creep of what should stay".to_owned(),
        x: time_axis(),
        y: Axis::log("creep, mm/h", y_least, y_most),
        cells: Vec::new(),
        series,
        words: vec![(2e1, 1.6, "Moreau: exactly 0, drawn at the foot".to_owned())],
    }
}
