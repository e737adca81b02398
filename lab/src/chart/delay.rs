//! The second half of `tenax chart front`: decision delay by stiffness by gain, where the object is lost and where the loop swings.

use rayon::prelude::*;
use tenax_hal_shim::wire::{Event, EventKind};
use tenax_hal_shim::words::GripMode;
use tenax_scene::{SceneFile, World};
use tenax_sim::board::simulated;
use tenax_sim::jobs::Jobs;
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Cell, Mark, Panel, Series, Sheet};
use tenax_sim::report::fate::Fate;

use super::{Chart, Progress, csv};

/// From a decision to the fingers' motion, ms: the motor's dead time, and what a slower decision adds to it.
const DELAYS_MS: [f64; 8] = [10.0, 20.0, 30.0, 45.0, 65.0, 90.0, 130.0, 190.0];
/// Pad and object together, N/mm a finger.
const STIFFNESS_N_PER_MM: [f64; 8] = [0.3, 0.5, 0.9, 1.6, 3.0, 5.0, 9.0, 16.0];
/// Lengths of the pulse that answers slip, ms: the gain, a third of the default, the default, and twice that.
const PULSES_MS: [u32; 3] = [10, 30, 60];
const PULSE_MS: u32 = 30;
/// The scenes' dead time, and their glass: where the defaults stand.
const DEFAULT: (f64, f64) = (30.0, 3.0);
/// More pulses than this for one wet patch is a limit cycle: each answers what the last one did.
const CYCLE_PULSES: usize = 6;

const MASS_KG: f64 = 0.25;
const GRAVITY_M_S2: f64 = 9.81;
/// Dry, then wet.
const MU_S: [f64; 2] = [0.5, 0.25];
const MU_D: [f64; 2] = [0.44, 0.22];
const PAD_MM: f64 = 18.0;
/// Force of each finger on the dry glass, N: 1.35 times its need.
const HELD_N: f64 = 1.35 * MASS_KG * GRAVITY_M_S2 / 2.0 / MU_S[0];
const SPEED_MM_S: f64 = 120.0;
const FORCE_N: f64 = 140.0;

struct Point {
    pulse_ms: u32,
    delay_ms: f64,
    stiffness: f64,
    kept: bool,
    slid_mm: f64,
    over: f64,
    pulses: usize,
}

/// A glass that is held and gets wet at 4 s, in a hand with this delay and stiffness.
fn scene(delay_ms: f64, stiffness: f64, pulse_ms: u32) -> anyhow::Result<SceneFile> {
    // The fingers close over 20 mm, and the pads by what the grip asks for; the motor's load takes part of its speed.
    let closes_s = (20.0 + 2.0 * HELD_N / stiffness) / (SPEED_MM_S * (0.5 - 0.5 * HELD_N / FORCE_N));
    let text = format!(
        r#"
name = "delay"
title = "A glass gets wet in a hand that decides late"
from = "tenax chart front"
duration_s = 10
slip_floor_mm_s = 1.0
arm = "robot"
[contact]
level = "l1"
mu_s = {}
mu_d = {}
pad_length_mm = {PAD_MM}
pitch_mm = 1.0
[object]
mass_kg = {MASS_KG}
width_mm = 70
stiffness_n_per_mm = {stiffness}
[gripper]
speed_mm_s = {SPEED_MM_S}
force_n = {FORCE_N}
dead_time_ms = {delay_ms}
range_mm = 120
opening_mm = 90
[[command]]
at_s = 0.1
kind = "set-slip-pulse-ms"
value = {pulse_ms}
[[command]]
at_s = 0.3
kind = "close"
duty_permille = 500
for_s = {closes_s:.4}
[[move]]
at_s = 2.2
for_s = 1.0
to_mm = 60
[[wet]]
at_s = 4.0
ramp_ms = 20
mu_s = {}
mu_d = {}
"#,
        MU_S[0], MU_D[0], MU_S[1], MU_D[1]
    );
    Ok(SceneFile::parse(&text, "delay")?)
}

/// Theory, a rigid glass that the fingers go on closing on at full speed: it is braked by friction alone during the delay, and then the
/// force grows by `k v / 2`; how far it
/// has slid when it stands still, mm.
fn slides_mm(delay_s: f64, stiffness: f64) -> f64 {
    let rate_n_s = stiffness * SPEED_MM_S / 2.0;
    let (mut t_s, mut speed, mut way) = (0.0, 0.0, 0.0);
    let dt_s = 1e-4;
    while way < PAD_MM / 1e3 && t_s < 5.0 {
        let grip_n = HELD_N + rate_n_s * (t_s - delay_s).max(0.0);
        let a = GRAVITY_M_S2 - 2.0 * MU_D[1] * grip_n / MASS_KG;
        speed += a * dt_s;
        if speed <= 0.0 {
            break;
        }
        way += speed * dt_s;
        t_s += dt_s;
    }
    way * 1e3
}

/// The stiffness below which nobody saves it at this delay.
fn edge(delay_s: f64) -> f64 {
    let (mut low, mut high) = (0.01_f64, 1_000.0_f64);
    for _ in 0..40 {
        let mid = (low * high).sqrt();
        if slides_mm(delay_s, mid) < PAD_MM { high = mid } else { low = mid }
    }
    high
}

/// Runs the map on the host. Fails if a scene or the chart cannot be made.
pub fn map(progress: Progress) -> anyhow::Result<Chart> {
    let cells = PULSES_MS.into_iter().flat_map(|pulse_ms| {
        DELAYS_MS.into_iter().flat_map(move |delay| STIFFNESS_N_PER_MM.map(|k| (pulse_ms, delay, k)))
    });
    let cells: Vec<(u32, f64, f64)> = cells.collect();
    let jobs = Jobs::new(cells.len(), progress);
    let run = |&(pulse_ms, delay_ms, stiffness): &(u32, f64, f64)| {
        let _job = jobs.begin();
        let file = scene(delay_ms, stiffness, pulse_ms)?;
        let (run, world) = simulated::record(World::new(&file, 1), &mut (), &mut |_| {});
        let fate = Fate::of(world.truth(), &file);
        let closes = |event: &&Event| {
            matches!(event.kind, EventKind::Mode { to: GripMode::Slip | GripMode::Incipient, .. })
        };
        let peaks = fate.peak_grip_n.zip(fate.needed_force_n);
        let over = peaks.map_or(f64::NAN, |(peak_n, needed_n)| peak_n / needed_n);
        let (kept, slid_mm) = (fate.kept(), fate.distance_mm);
        let pulses = run.events.iter().filter(closes).count();
        anyhow::Ok(Point { pulse_ms, delay_ms, stiffness, kept, slid_mm, over, pulses })
    };
    let cells: Vec<Point> = cells.par_iter().map(run).collect::<anyhow::Result<_>>()?;
    let rows = cells.iter().map(|cell| {
        let theory_mm = slides_mm(cell.delay_ms / 1e3, cell.stiffness).min(PAD_MM);
        let numbers =
            [f64::from(cell.pulse_ms), cell.delay_ms, cell.stiffness, cell.slid_mm, cell.over, theory_mm];
        let numbers = numbers.map(|value| format!("{value:.4}"));
        numbers.into_iter().chain([cell.kept.to_string(), cell.pulses.to_string()]).collect()
    });
    let header = "pulse_ms,delay_ms,stiffness_n_per_mm,slid_mm,peak_over_needed,theory_slid_mm,kept,pulses";
    let csv = csv(header, rows)?;
    let panels = PULSES_MS.map(|pulse_ms| panel(pulse_ms, &cells)).into();
    let sheet = Sheet {
        title: "Decision delay by stiffness by gain".to_owned(),
        subtitle: format!(
            "a held glass gets wet; colour: slid over the pad's {PAD_MM} mm; none: lost; a limit cycle is more than {CYCLE_PULSES} pulses"
        ),
        columns: 3,
        panels,
        errors: Some((1e-3, 1.0)),
    };
    Chart::new("front-delay", &sheet, csv)
}

fn panel(pulse_ms: u32, cells: &[Point]) -> Panel {
    let own: Vec<&Point> = cells.iter().filter(|cell| cell.pulse_ms == pulse_ms).collect();
    let around = |all: &[f64], value: f64| {
        let n = all.iter().position(|own| *own == value).unwrap_or(0);
        let between = |a: f64, b: f64| (a * b).sqrt();
        let low = if n > 0 { between(all[n - 1], value) } else { value * value / between(value, all[1]) };
        let high = all.get(n + 1).map_or(value * value / low, |next| between(value, *next));
        (low, high)
    };
    let cell = |cell: &&Point| Cell {
        x: around(&DELAYS_MS, cell.delay_ms),
        y: around(&STIFFNESS_N_PER_MM, cell.stiffness),
        error: cell.kept.then_some((cell.slid_mm / PAD_MM).clamp(1e-3, 1.0)),
    };
    let x = Axis::log("decision delay and dead time, ms", 6.5, 230.0);
    let y = Axis::log("stiffness, N/mm a finger", 0.23, 22.0);
    let line = (0..=60).map(|n| 6.5 * (230.0_f64 / 6.5).powf(f64::from(n) / 60.0));
    let cycles = own.iter().filter(|cell| cell.pulses > CYCLE_PULSES);
    let series = vec![
        Series::new(
            "theory: below it the glass is lost",
            colour::VERMILLION,
            Mark::Line,
            line.map(|ms| (ms, edge(ms / 1e3))),
        ),
        Series::new(
            "limit cycle",
            colour::PURPLE,
            Mark::Crosses,
            cycles.map(|cell| (cell.delay_ms, cell.stiffness)),
        ),
        Series::new("the defaults", colour::GREEN, Mark::Dots, (pulse_ms == PULSE_MS).then_some(DEFAULT)),
    ];
    let cells = own.iter().map(cell).collect();
    Panel { cells, ..Panel::new(format!("pulses of {pulse_ms} ms"), x, y, series) }
}
