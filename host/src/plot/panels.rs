//! The panels of a run, from top to bottom: forces, Ft/Fn and S2, vibration and S1, muscles and gate, motor and mode.

use plotters::style::RGBColor;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::GripMode;
use tenax_logic::config::Config;

use super::figure::{Curve, Figure, Level, Panel, Stretch, colour};
use super::sketch::{self, Drives, Needs, Sketch};
use super::thin::Thin;
use crate::report::Subject;

/// The figure of a run: what was drawn of it while it went.
#[must_use]
pub fn figure(subject: &Subject, sketch: Sketch) -> Figure {
    let span_s = sketch.span_s();
    let slips = subject.truth.map_or_else(Vec::new, |truth| {
        joined(truth.slips.iter().map(|slip| (slip.micro_onset_s, slip.end_s.min(span_s.1))), span_s)
    });
    let strip = modes(subject, sketch.end_s().unwrap_or(span_s.1), span_s);
    let Sketch { forces: drawn, needs, ratio, s2, vibration, muscles: envelopes, motor: drives, .. } = sketch;
    Figure {
        title: subject.scene.to_owned(),
        subtitle: format!("{} board, seed {}", subject.board, subject.seed),
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
                levels: vec![constant("S1", sketch::mv(Config::default().vibration.s1), span_s)],
                at_least: (0.0, 150.0),
                height: 1.0,
                ..Panel::default()
            },
            muscles(envelopes, span_s),
            motor(drives, strip),
        ],
    }
}

/// More slips, or modes, than this are more than the columns of pixels that they would stand in.
const MANY: usize = 2_000;

/// Stretches of time in order, those of them that are many made one where no pixel is between them.
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

fn constant(name: &str, value: f64, (from_s, to_s): (f64, f64)) -> Level {
    Level { name: name.to_owned(), points: vec![(from_s, value), (to_s, value)] }
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

fn muscles([flexor, extensor]: [Thin; 2], span_s: (f64, f64)) -> Panel {
    Panel {
        label: "muscles, mV".to_owned(),
        curves: vec![curve("flexor", colour::GREEN, flexor), curve("extensor", colour::ORANGE, extensor)],
        levels: vec![constant("gate", f64::from(Config::default().gate.on_mv), span_s)],
        at_least: (-50.0, 250.0),
        height: 1.0,
        ..Panel::default()
    }
}

fn motor(drives: Drives, strip: Vec<Stretch>) -> Panel {
    let Drives { wearer, reflex, link, by_link, behaviour, by_behaviour } = drives;
    let mut curves =
        vec![curve("by the wearer", colour::GREEN, wearer), curve("by the reflex", colour::BLUE, reflex)];
    if by_link {
        curves.push(curve("by the line", colour::ORANGE, link));
    }
    if by_behaviour {
        curves.push(curve("by a behaviour", colour::PURPLE, behaviour));
    }
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
fn modes(subject: &Subject, end_s: f64, (from_s, to_s): (f64, f64)) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut begun = (GripMode::default(), subject.timeline.zero_s());
    let changes = subject.run.events.iter().filter_map(|event| match event.kind {
        EventKind::Mode { to, .. } => Some((to, subject.timeline.time_s(event.frame))),
        _ => None,
    });
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
    fn a_few_slips_are_drawn_as_they_are_and_many_in_no_more_than_the_pixels() {
        let slips = |count: u32| (0..count).map(move |n| (f64::from(n), f64::from(n) + 0.1));
        assert_eq!(joined(slips(3), (0.0, 3.0)).len(), 3);
        let many = joined(slips(1_000_000), (0.0, 1e6));
        assert!(many.len() <= MANY && many.first().map(|slip| slip.0) == Some(0.0));
        assert!(many.last().is_some_and(|slip| slip.1 > 999_999.0));
    }
}
