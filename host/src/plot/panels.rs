//! The panels of a run, from top to bottom: forces, Ft/Fn and S2, vibration and S1, muscles and gate, motor and mode.

use plotters::style::RGBColor;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, REFERENCE_MV, SAMPLE_MAX};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{EventKind, Slow};
use tenax_hal_shim::words::{DriveSource, GripMode};
use tenax_logic::config::Config;

use super::figure::{Curve, Figure, Level, Panel, Stretch, colour};
use super::thin::thin;
use crate::report::Subject;
use crate::timeline::Timeline;

/// The figure of a run between two instants.
#[must_use]
pub fn figure(subject: &Subject, span_s: (f64, f64)) -> Figure {
    let timeline = Timeline::new(subject.run, subject.zero_s);
    let slips = subject.truth.map_or_else(Vec::new, |truth| {
        truth.slips.iter().map(|slip| (slip.micro_onset_s, slip.end_s.min(span_s.1))).collect()
    });
    Figure {
        title: subject.scene.to_owned(),
        subtitle: format!("{} board, seed {}", subject.board, subject.seed),
        span_s,
        slips,
        panels: vec![
            forces(subject, timeline, span_s),
            ratio(timeline, span_s),
            vibration(timeline, span_s),
            muscles(timeline, span_s),
            motor(subject, timeline, span_s),
        ],
    }
}

fn curve(
    name: &str,
    colour: RGBColor,
    points: impl Iterator<Item = (f64, f64)>,
    span_s: (f64, f64),
) -> Curve {
    Curve { name: name.to_owned(), colour, points: thin(points, span_s) }
}

/// One point a slow frame; NaN where there is no number.
fn slow<'a>(
    timeline: Timeline<'a>,
    value: impl Fn(&Slow) -> Option<f64> + 'a,
) -> impl Iterator<Item = (f64, f64)> + 'a {
    timeline.slows().map(move |(t, slow)| (t, value(slow).unwrap_or(f64::NAN)))
}

fn constant(name: &str, value: f64, (from_s, to_s): (f64, f64)) -> Level {
    Level { name: name.to_owned(), points: vec![(from_s, value), (to_s, value)] }
}

/// Only the points where the value changes, from one end of the span to the other.
fn steps(points: impl Iterator<Item = (f64, f64)>, (from_s, to_s): (f64, f64)) -> Vec<(f64, f64)> {
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for (t, value) in points.filter(|point| point.0 <= to_s) {
        match steps.last() {
            Some(&(_, before)) if before == value => {}
            Some(&(_, before)) => steps.extend([(t.max(from_s), before), (t.max(from_s), value)]),
            None => steps.push((from_s, value)),
        }
    }
    steps.extend(steps.last().map(|&(_, value)| (to_s, value)));
    steps
}

fn forces(subject: &Subject, timeline: Timeline, span_s: (f64, f64)) -> Panel {
    let newtons = |mn: i32| f64::from(mn) / 1e3;
    let mut curves = Vec::new();
    if let Some(truth) = subject.truth {
        curves.push(curve("grip force", colour::BLUE, truth.grip_n.iter().copied(), span_s));
        curves.push(curve("needed to hold", colour::VERMILLION, truth.needed_n.iter().copied(), span_s));
    }
    let measured_n = slow(timeline, move |slow| Some(newtons(slow.forces?.fn_mn)));
    curves.push(curve("Fn as measured", colour::SKY, measured_n, span_s));
    let shear_n = slow(timeline, move |slow| Some(newtons(slow.forces?.ft_mn)));
    curves.push(curve("Ft as measured", colour::ORANGE, shear_n, span_s));
    Panel { label: "force, N".to_owned(), curves, at_least: (0.0, 1.0), height: 1.3, ..Panel::default() }
}

fn ratio(timeline: Timeline, span_s: (f64, f64)) -> Panel {
    let per_mille = |value: u16| f64::from(value) / 1e3;
    let ratio = slow(timeline, move |slow| Some(per_mille(slow.forces?.ratio_permille?)));
    // A stroke changes it.
    let s2 = timeline.slows().map(move |(t, slow)| (t, per_mille(slow.s2_permille)));
    Panel {
        label: "Ft/Fn".to_owned(),
        curves: vec![curve("Ft/Fn", colour::BLUE, ratio, span_s)],
        levels: vec![Level { name: "S2".to_owned(), points: steps(s2, span_s) }],
        at_least: (0.0, 0.5),
        height: 1.0,
        ..Panel::default()
    }
}

fn vibration(timeline: Timeline, span_s: (f64, f64)) -> Panel {
    let mv = |sample: u16| f64::from(sample) * f64::from(REFERENCE_MV) / f64::from(SAMPLE_MAX);
    let envelope = timeline.ticks().map(move |(t, tick)| (t, mv(tick.vibration)));
    Panel {
        label: "vibration, mV".to_owned(),
        curves: vec![curve("PVDF envelope", colour::BLUE, envelope, span_s)],
        levels: vec![constant("S1", mv(Config::default().vibration.s1), span_s)],
        at_least: (0.0, 150.0),
        height: 1.0,
        ..Panel::default()
    }
}

fn muscles(timeline: Timeline, span_s: (f64, f64)) -> Panel {
    let flexor = slow(timeline, |slow| slow.flexor_mv.map(f64::from));
    let extensor = slow(timeline, |slow| slow.extensor_mv.map(f64::from));
    Panel {
        label: "muscles, mV".to_owned(),
        curves: vec![
            curve("flexor", colour::GREEN, flexor, span_s),
            curve("extensor", colour::ORANGE, extensor, span_s),
        ],
        levels: vec![constant("gate", f64::from(Config::default().gate.on_mv), span_s)],
        at_least: (-50.0, 250.0),
        height: 1.0,
        ..Panel::default()
    }
}

fn motor(subject: &Subject, timeline: Timeline, span_s: (f64, f64)) -> Panel {
    let duty = |drive: MotorDrive| match drive {
        MotorDrive::Coast => 0.0,
        MotorDrive::Close(duty) => f64::from(duty.as_per_mille()) / 10.0,
        MotorDrive::Open(duty) => -f64::from(duty.as_per_mille()) / 10.0,
    };
    let by = |source: DriveSource| {
        timeline.ticks().map(move |(t, tick)| (t, if tick.source == source { duty(tick.drive) } else { 0.0 }))
    };
    let mut curves = vec![
        curve("by the wearer", colour::GREEN, by(DriveSource::Wearer), span_s),
        curve("by the reflex", colour::BLUE, by(DriveSource::Reflex), span_s),
    ];
    if timeline.ticks().any(|(_, tick)| tick.source == DriveSource::Link) {
        curves.push(curve("by the line", colour::ORANGE, by(DriveSource::Link), span_s));
    }
    Panel {
        label: "motor, % (close > 0)".to_owned(),
        curves,
        strip: modes(subject, timeline, span_s),
        at_least: (-110.0, 110.0),
        height: 1.3,
        ..Panel::default()
    }
}

/// Every stretch of one mode.
fn modes(subject: &Subject, timeline: Timeline, (from_s, to_s): (f64, f64)) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut begun = (GripMode::default(), subject.zero_s);
    let changes = subject.run.events.iter().filter_map(|event| match event.kind {
        EventKind::Mode { to, .. } => Some((to, timeline.time_s(event.frame))),
        _ => None,
    });
    let end_s = timeline.slows().last().map_or(to_s, |(t, _)| t + f64::from(FRAMES_PER_SLOW_FRAME) * 0.5e-3);
    for next in changes.chain([(GripMode::default(), end_s.max(to_s))]) {
        let (mode, since_s) = std::mem::replace(&mut begun, next);
        let (colour, name) = look(mode);
        let (from_s, to_s) = (since_s.max(from_s), next.1.min(to_s));
        if from_s < to_s {
            stretches.push(Stretch { name: name.to_owned(), colour, from_s, to_s });
        }
    }
    stretches
}

fn look(mode: GripMode) -> (RGBColor, &'static str) {
    match mode {
        GripMode::Standby => (colour::GREY, "standby"),
        GripMode::Wearer => (colour::GREEN, "wearer"),
        GripMode::Watch => (colour::SKY, "watch"),
        GripMode::Slip => (colour::VERMILLION, "slip"),
        GripMode::Incipient => (colour::ORANGE, "incipient"),
        GripMode::Settle => (colour::YELLOW, "settle"),
        GripMode::Explore => (colour::PURPLE, "explore"),
    }
}
