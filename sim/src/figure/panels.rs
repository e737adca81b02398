//! The panels of a run, from top to bottom: forces, Ft/Fn and S2, vibration and S1, what each detector says, muscles and gate,
//! motor and mode. Thresholds are those in force: a command of the scene or of a person changes them.

use plotters::style::RGBColor;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::{Down, EventKind};
use tenax_hal_shim::words::{DriveSource, GripMode};
use tenax_logic::config::Config;
use tenax_logic::setting::SettingId;

use super::sketch::{Drive, Needs, Sketch};
use crate::plot::figure::{Curve, Figure, Level, Panel, Stretch, colour};
use crate::plot::thin::{Thin, thin};
use crate::report::Subject;

pub fn figure(subject: &Subject, sketch: Sketch) -> Figure {
    let span_s = sketch.span_s();
    let slips = subject.truth.map_or_else(Vec::new, |truth| {
        joined(truth.slips.iter().map(|slip| (slip.micro_onset_s, slip.end_s.min(span_s.1))), span_s)
    });
    let strip = modes(subject, sketch.first_mode, sketch.end_s().unwrap_or(span_s.1), span_s);
    let Sketch { forces: drawn, needs, ratio, s2, vibration, muscles: envelopes, motor: drives, .. } = sketch;
    Figure {
        title: subject.scene.to_owned(),
        subtitle: match subject.board {
            "recorded" => "recorded".to_owned(),
            board => format!("{board} board, seed {}", subject.seed),
        },
        span_s,
        slips,
        panels: vec![
            forces(drawn, needs),
            Panel {
                label: "Ft/Fn".to_owned(),
                curves: vec![curve("Ft/Fn", colour::BLUE, ratio)],
                levels: vec![Level { name: "S2".to_owned(), points: s2.points() }],
                at_least: (0.0, 0.5),
                height: 1.0,
                ..Panel::default()
            },
            Panel {
                label: "vibration, mV".to_owned(),
                curves: vec![curve("PVDF envelope", colour::BLUE, vibration)],
                levels: vec![in_force("S1", SettingId::S1, subject, span_s)],
                at_least: (0.0, 150.0),
                height: 1.0,
                ..Panel::default()
            },
            detectors(subject, span_s),
            muscles(envelopes, in_force("gate", SettingId::EmgOn, subject, span_s)),
            motor(drives, strip),
        ],
    }
}

const MANY: usize = 2_000;

fn joined(stretches: impl Iterator<Item = (f64, f64)>, (from_s, to_s): (f64, f64)) -> Vec<(f64, f64)> {
    let all: Vec<(f64, f64)> = stretches.collect();
    if all.len() <= MANY {
        return all;
    }
    let pixel_s = (to_s - from_s) / MANY as f64;
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (begin_s, end_s) in all {
        match joined.last_mut() {
            Some(last) if begin_s - last.1 < pixel_s => last.1 = last.1.max(end_s),
            _ => joined.push((begin_s, end_s)),
        }
    }
    joined
}

fn curve(name: &str, colour: RGBColor, thin: Thin) -> Curve {
    Curve { name: name.to_owned(), colour, points: thin.points() }
}

/// A threshold as it was in force: the default, and what each command that was taken made of it.
fn in_force(name: &str, id: SettingId, subject: &Subject, (from_s, to_s): (f64, f64)) -> Level {
    let mut config = Config { line_trusted: subject.run.trusts_line, ..Config::default() };
    let mut points = vec![(from_s, f64::from(config.get(id)))];
    for (frame, command) in &subject.run.taken {
        let Down::Set(setting) = command.message else { continue };
        let at_s = subject.timeline.time_s(*frame);
        let Some(own) = SettingId::from_number(setting.id).filter(|_| at_s <= to_s) else { continue };
        let before = f64::from(config.get(id));
        if config.set(own, setting.value).is_ok() && own == id {
            points.extend([(at_s.max(from_s), before), (at_s.max(from_s), f64::from(config.get(id)))]);
        }
    }
    points.push((to_s, f64::from(config.get(id))));
    Level { name: name.to_owned(), points }
}

/// When each detector said slip, or warned of it: a row for each, high while it did.
fn detectors(subject: &Subject, span_s: (f64, f64)) -> Panel {
    const COLOURS: [RGBColor; 5] =
        [colour::BLUE, colour::ORANGE, colour::PURPLE, colour::GREEN, colour::VERMILLION];
    // Nothing is injected but by a person.
    let all: Vec<DetectorId> = DetectorId::ALL.into_iter().filter(|&id| id != DetectorId::Injected).collect();
    let count = all.len();
    let curve = |(row, id): (usize, DetectorId)| {
        // From top to bottom, as they are named beside it.
        let low = (count - 1 - row) as f64;
        let (mut points, high) = (vec![(span_s.0, low)], low + 0.8);
        for verdict in subject.timeline.verdicts_said(id) {
            let (from_s, to_s) = (verdict.from_s.max(span_s.0), verdict.to_s.min(span_s.1));
            if from_s <= to_s {
                points.extend([(from_s, low), (from_s, high), (to_s, high), (to_s, low)]);
            }
        }
        points.push((span_s.1, low));
        Curve { name: String::new(), colour: COLOURS[row % COLOURS.len()], points: thin(points, span_s) }
    };
    let middle = |row: usize| (count - 1 - row) as f64 + 0.3;
    let names = all.iter().enumerate().map(|(row, id)| (middle(row), id.title().to_owned())).collect();
    let curves: Vec<Curve> = all.into_iter().enumerate().map(curve).collect();
    let rows = count as f64;
    Panel {
        label: "slip said".to_owned(),
        curves,
        names,
        at_least: (-0.2, rows),
        height: 0.8,
        ..Panel::default()
    }
}

fn forces([normal, shear]: [Thin; 2], needs: Option<Needs>) -> Panel {
    let mut curves = Vec::new();
    if let Some(Needs { grip, needed }) = needs {
        curves.push(curve("grip force", colour::BLUE, grip));
        curves.push(curve("needed to hold", colour::VERMILLION, needed));
    }
    curves.push(curve("Fn as measured", colour::SKY, normal));
    curves.push(curve("Ft as measured", colour::ORANGE, shear));
    Panel { label: "force, N".to_owned(), curves, at_least: (0.0, 1.0), height: 1.3, ..Panel::default() }
}

fn muscles([flexor, extensor]: [Thin; 2], gate: Level) -> Panel {
    Panel {
        label: "muscles, mV".to_owned(),
        curves: vec![curve("flexor", colour::GREEN, flexor), curve("extensor", colour::ORANGE, extensor)],
        levels: vec![gate],
        at_least: (-50.0, 250.0),
        height: 1.0,
        ..Panel::default()
    }
}

fn motor(drives: [Drive; 4], strip: Vec<Stretch>) -> Panel {
    let look = |source| match source {
        DriveSource::Wearer => ("by the wearer", colour::GREEN),
        DriveSource::Reflex => ("by the reflex", colour::BLUE),
        DriveSource::Link => ("by the line", colour::ORANGE),
        _ => ("by a behaviour", colour::PURPLE),
    };
    let always = |source| matches!(source, DriveSource::Wearer | DriveSource::Reflex);
    let shown = drives.into_iter().filter(|own| own.drove || always(own.source));
    let curves = shown.map(|own| curve(look(own.source).0, look(own.source).1, own.percent)).collect();
    Panel {
        label: "motor, % (close > 0)".to_owned(),
        curves,
        strip,
        at_least: (-110.0, 110.0),
        height: 1.3,
        ..Panel::default()
    }
}

/// Every stretch of one mode; the run ends at `end_s`.
fn modes(subject: &Subject, first: Option<GripMode>, end_s: f64, (from_s, to_s): (f64, f64)) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let changes = subject.run.events.iter().filter_map(|event| match event.kind {
        EventKind::Mode { to, .. } => Some((to, subject.timeline.time_s(event.frame))),
        _ => None,
    });
    // What was in force before the first change: a run begins in standby, a recording perhaps in the middle.
    let first =
        if changes.clone().next().is_none() || from_s > subject.timeline.zero_s() { first } else { None };
    let mut begun = (first.unwrap_or_default(), subject.timeline.zero_s());
    for next in changes.chain([(GripMode::default(), end_s.max(to_s))]) {
        let (mode, since_s) = std::mem::replace(&mut begun, next);
        let (colour, name) = look(mode);
        let (from_s, to_s) = (since_s.max(from_s), next.1.min(to_s));
        if from_s < to_s {
            stretches.push(Stretch { name: name.to_owned(), colour, from_s, to_s });
        }
    }
    let pixel_s = (to_s - from_s) / MANY as f64;
    if stretches.len() > MANY {
        // Of many, those that can be seen, and of the others the first in each pixel.
        let mut pixel = usize::MAX;
        stretches.retain(|stretch| {
            let at = ((stretch.from_s - from_s) / pixel_s) as usize;
            let first = std::mem::replace(&mut pixel, at) != at;
            first || stretch.to_s - stretch.from_s > pixel_s
        });
    }
    stretches
}

fn look(mode: GripMode) -> (RGBColor, &'static str) {
    let colour = match mode {
        GripMode::Standby => colour::GREY,
        GripMode::Wearer => colour::GREEN,
        GripMode::Watch => colour::SKY,
        GripMode::Slip => colour::VERMILLION,
        GripMode::Incipient => colour::ORANGE,
        GripMode::Settle => colour::YELLOW,
    };
    (colour, mode.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_those_in_force_and_every_detector_has_a_row() {
        // The scene makes the films as good as deaf at 0.1 s.
        let file = crate::session::load_scene("array-pour").unwrap();
        let outcome = crate::session::scene(&file, 1, &crate::session::Board::Host, &mut |_| {}).unwrap();
        let panel = |label: &str| outcome.figure.panels.iter().find(|panel| panel.label.starts_with(label));
        let s1 = &panel("vibration").unwrap().levels[0].points;
        assert_eq!((s1.first().map(|p| p.1), s1.last().map(|p| p.1)), (Some(100.0), Some(1_500.0)), "{s1:?}");
        assert!(s1.iter().any(|point| (point.0 - 0.1).abs() < 0.01));
        let says = panel("slip said").unwrap();
        let rows = &says.curves;
        assert_eq!((rows.len(), says.names.len()), (DetectorId::COUNT - 1, DetectorId::COUNT - 1));
        let highest = |row: &Curve| row.points.iter().map(|point| point.1).fold(0.0, f64::max);
        let mlp = says.names.iter().position(|(_, name)| name == DetectorId::Mlp.title()).unwrap();
        let mlp = &rows[mlp];
        let said = outcome.report.detectors.of_id(DetectorId::Mlp).said;
        assert_eq!(highest(mlp).fract() > 0.5, said > 0, "said {said} times");
    }
}
