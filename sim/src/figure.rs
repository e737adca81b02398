//! The figure of a run, drawn while it goes: forces, Ft/Fn, vibration, detectors, muscles, motor and mode, with the thresholds in force.

pub mod sketch;

use plotters::style::{Color, RGBColor};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::{Down, EventKind};
use tenax_hal_shim::words::{DriveSource, GripMode};
use tenax_logic::config::Config;
use tenax_logic::setting::SettingId;

use self::sketch::{Drive, Needs, Sketch};
use crate::plot::colour;
use crate::plot::sheet::{Axis, Band, Mark, Panel, Series, Sheet};
use crate::plot::thin::{Thin, thin};
use crate::report::Subject;

const LEVEL: RGBColor = colour::VERMILLION;
const SLIP: RGBColor = colour::PURPLE;
/// Modes' place in the motor's panel, %.
const STRIP: (f64, f64) = (-150.0, -125.0);

pub fn figure(subject: &Subject, sketch: Sketch) -> Sheet {
    let span_s = sketch.span_s;
    let strip = modes(subject, sketch.first_mode, sketch.end_s.unwrap_or(span_s.1), span_s);
    let Sketch { forces, needs, ratio, s2, vibration, muscles, motor: drives, .. } = sketch;
    let in_force = |name, id| in_force(name, id, subject, span_s);
    let [normal, shear] = forces;
    let mut forces = Vec::new();
    if let Some(Needs { grip, needed }) = needs {
        forces.push(curve("grip force", colour::BLUE, grip));
        forces.push(curve("needed to hold", colour::VERMILLION, needed));
    }
    forces.push(curve("Fn as measured", colour::SKY, normal));
    forces.push(curve("Ft as measured", colour::ORANGE, shear));
    let ratio =
        vec![curve("Ft/Fn", colour::BLUE, ratio), Series::new("S2", LEVEL, Mark::Dashes, s2.points())];
    let vibration = vec![curve("PVDF envelope", colour::BLUE, vibration), in_force("S1", SettingId::S1)];
    let [flexor, extensor] = muscles;
    let (flexor, extensor) =
        (curve("flexor", colour::GREEN, flexor), curve("extensor", colour::ORANGE, extensor));
    let muscles = vec![flexor, extensor, in_force("gate", SettingId::EmgOn)];
    let mut panels = vec![
        panel("force, N", forces, (0.0, 1.0), span_s),
        panel("Ft/Fn", ratio, (0.0, 0.5), span_s),
        panel("vibration, mV", vibration, (0.0, 150.0), span_s),
        detectors(subject, span_s),
        panel("muscles, mV", muscles, (-50.0, 250.0), span_s),
        motor(drives, strip, span_s),
    ];
    shade_slips(&mut panels, subject, span_s);
    let subtitle = match subject.board {
        "recorded" => "recorded".to_owned(),
        board => format!("{board} board, seed {}", subject.seed),
    };
    Sheet::new(subject.scene, subtitle, 1, panels)
}

fn panel(title: &str, series: Vec<Series>, at_least: (f64, f64), (from_s, to_s): (f64, f64)) -> Panel {
    let values = series.iter().flat_map(|own| &own.points).map(|point| point.1).filter(|y| y.is_finite());
    let (low, high) = values.fold(at_least, |(low, high), y| (low.min(y), high.max(y)));
    let air = (high - low) * 0.05;
    let low = if low < 0.0 { low - air } else { low };
    Panel::new(title, Axis::even("time, s", from_s, to_s), Axis::even("", low, high + air), series)
}

fn shade_slips(panels: &mut [Panel], subject: &Subject, span_s: (f64, f64)) {
    let slips = subject.truth.iter().flat_map(|truth| &truth.slips);
    let slips = joined(slips.map(|slip| (slip.micro_onset_s, slip.end_s.min(span_s.1))), span_s);
    // A slip is shorter than a pixel in a long run, and is what the figure is about.
    let visible_s = (span_s.1 - span_s.0) / 400.0;
    for panel in panels.iter_mut() {
        panel.bands.extend(slips.iter().map(|&(begin_s, end_s)| Band {
            x: (begin_s, end_s.max(begin_s + visible_s).min(span_s.1)),
            y: panel.y.ends,
            colour: SLIP.mix(0.35),
        }));
    }
    if let (Some(first), false) = (panels.first_mut(), slips.is_empty()) {
        first.series.push(Series::new("the object slips", SLIP, Mark::Line, []));
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

fn curve(name: &str, colour: RGBColor, thin: Thin) -> Series {
    Series::new(name, colour, Mark::Line, thin.points())
}

/// A threshold as it was in force: the default, and what each command that was taken made of it.
fn in_force(name: &str, id: SettingId, subject: &Subject, (from_s, to_s): (f64, f64)) -> Series {
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
    Series::new(name, LEVEL, Mark::Dashes, points)
}

/// A row for each detector, high while it said slip or warned of it.
fn detectors(subject: &Subject, span_s: (f64, f64)) -> Panel {
    const COLOURS: [RGBColor; 5] =
        [colour::BLUE, colour::ORANGE, colour::PURPLE, colour::GREEN, colour::VERMILLION];
    // Nothing is injected but by a person.
    let all: Vec<DetectorId> = DetectorId::ALL.into_iter().filter(|&id| id != DetectorId::Injected).collect();
    let row = |(row, id): (usize, &DetectorId)| {
        // From top to bottom, as they are named above it.
        let low = (all.len() - 1 - row) as f64;
        let (mut points, high) = (vec![(span_s.0, low)], low + 0.8);
        for verdict in subject.timeline.verdicts_said(*id) {
            let (from_s, to_s) = (verdict.from_s.max(span_s.0), verdict.to_s.min(span_s.1));
            if from_s <= to_s {
                points.extend([(from_s, low), (from_s, high), (to_s, high), (to_s, low)]);
            }
        }
        points.push((span_s.1, low));
        Series::new(id.title(), COLOURS[row % COLOURS.len()], Mark::Line, thin(points, span_s))
    };
    let rows = all.iter().enumerate().map(row).collect();
    panel("slip said", rows, (-0.2, all.len() as f64), span_s)
}

fn motor(drives: [Drive; 4], strip: Vec<(GripMode, f64, f64)>, span_s: (f64, f64)) -> Panel {
    let look = |source| match source {
        DriveSource::Wearer => ("by the wearer", colour::GREEN),
        DriveSource::Reflex => ("by the reflex", colour::BLUE),
        DriveSource::Link => ("by the line", colour::ORANGE),
        _ => ("by a behaviour", colour::PURPLE),
    };
    let always = |source| matches!(source, DriveSource::Wearer | DriveSource::Reflex);
    let shown = drives.into_iter().filter(|own| own.drove || always(own.source));
    let curves = shown.map(|own| curve(look(own.source).0, look(own.source).1, own.percent)).collect();
    let mut panel = panel("motor, % (close > 0)", curves, (STRIP.0, 110.0), span_s);
    for (mode, from_s, to_s) in strip {
        let colour = colour_of(mode);
        panel.bands.push(Band { x: (from_s, to_s), y: STRIP, colour: colour.to_rgba() });
        if panel.series.iter().all(|own| own.name != mode.name()) {
            panel.series.push(Series::new(mode.name(), colour, Mark::Line, []));
        }
    }
    panel
}

/// The stretches of the modes; the run ends at `end_s`.
fn modes(
    subject: &Subject,
    first: Option<GripMode>,
    end_s: f64,
    (from_s, to_s): (f64, f64),
) -> Vec<(GripMode, f64, f64)> {
    let mut stretches = Vec::new();
    let changes = subject.run.events.iter().filter_map(|event| match event.kind {
        EventKind::Mode { to, .. } => Some((to, subject.timeline.time_s(event.frame))),
        _ => None,
    });
    // What was in force before the first change: a run begins in standby, a recording perhaps in the middle.
    let first =
        if changes.clone().next().is_none() || from_s > subject.timeline.zero_s { first } else { None };
    let mut begun = (first.unwrap_or_default(), subject.timeline.zero_s);
    for next in changes.chain([(GripMode::default(), end_s.max(to_s))]) {
        let (mode, since_s) = std::mem::replace(&mut begun, next);
        let (from_s, to_s) = (since_s.max(from_s), next.1.min(to_s));
        if from_s < to_s {
            stretches.push((mode, from_s, to_s));
        }
    }
    let pixel_s = (to_s - from_s) / MANY as f64;
    if stretches.len() > MANY {
        stretches.retain(|(_, from_s, to_s)| to_s - from_s > pixel_s);
    }
    stretches
}

const fn colour_of(mode: GripMode) -> RGBColor {
    match mode {
        GripMode::Standby => colour::GREY,
        GripMode::Wearer => colour::GREEN,
        GripMode::Watch => colour::SKY,
        GripMode::Slip => colour::VERMILLION,
        GripMode::Incipient => colour::ORANGE,
        GripMode::Settle => colour::YELLOW,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_those_in_force_and_every_detector_has_a_row() {
        // The scene makes the films as good as deaf at 0.1 s.
        let file = crate::session::load_scene("array-pour").unwrap();
        let outcome = crate::session::scene(&file, 1, &crate::session::Board::Host, &mut |_| {}).unwrap();
        let panel = |title: &str| outcome.figure.panels.iter().find(|panel| panel.title.starts_with(title));
        let s1 = &panel("vibration").unwrap().series[1].points;
        assert_eq!((s1.first().map(|p| p.1), s1.last().map(|p| p.1)), (Some(100.0), Some(1_500.0)), "{s1:?}");
        assert!(s1.iter().any(|point| (point.0 - 0.1).abs() < 0.01));
        let rows = &panel("slip said").unwrap().series;
        assert_eq!(rows.iter().filter(|row| row.name != "the object slips").count(), DetectorId::COUNT - 1);
        let mlp = rows.iter().find(|row| row.name == DetectorId::Mlp.title()).unwrap();
        let highest = mlp.points.iter().map(|point| point.1).fold(0.0, f64::max);
        let said = outcome.report.detectors.of_id(DetectorId::Mlp).said;
        assert_eq!(highest.fract() > 0.5, said > 0, "said {said} times");
    }
}
