//! The report for people.

use std::fmt::{self, Display};

use tenax_hal_shim::detector::DetectorId;

use super::replay::{Force, Meant, Muscle, Replay};
use super::scores::Detector;
use super::{CYCLES_PER_INSTRUCTION, Report};

#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Report);

/// A value with its unit, or a dash.
struct Or<T>(Option<T>, &'static str);

impl Display for Or<f64> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(value) => write!(f, "{value:.*} {}", f.precision().unwrap_or(3), self.1),
            None => f.write_str("-"),
        }
    }
}

/// One line: a label in a column of its own, then what there is to say.
macro_rules! line {
    ($f:expr, $label:expr, $($what:tt)*) => {
        writeln!($f, "  {:<14}{}", $label, format_args!($($what)*))
    };
}

impl Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = self.0;
        writeln!(f, "{} on the {} board", report.scene, report.board)?;
        let speed = report.virtual_s / report.wall_s.max(1e-9);
        line!(
            f,
            "time",
            "{:.2} s virtual in {:.2} s, {speed:.1} times real time",
            report.virtual_s,
            report.wall_s
        )?;
        ticks(f, report)?;
        slip(f, report)?;
        wearer(f, report)?;
        for (id, own) in &report.detectors.all {
            // Nothing is injected but by who knows it.
            if *id != DetectorId::Injected || own.said > 0 {
                detector(f, id.title(), own)?;
            }
        }
        if let Some(recorded) = &report.replay {
            replay(f, recorded)?;
        }
        if report.faults.is_empty() {
            line!(f, "faults", "none")?;
        }
        for fault in &report.faults {
            line!(f, "fault", "{:.4} {}", Or(fault.at_s, "s"), fault.what)?;
        }
        Ok(())
    }
}

fn ticks(f: &mut fmt::Formatter<'_>, report: &Report) -> fmt::Result {
    let ticks = &report.ticks;
    line!(f, "ticks", "{} run, {} dropped, {} overruns", ticks.count, ticks.dropped, report.overruns)?;
    if let (Some(mean), Some(max), Some(load), Some(core)) =
        (ticks.instructions_mean, ticks.instructions_max, ticks.load_percent, ticks.core_load_percent)
    {
        line!(
            f,
            "tick",
            "{mean:.0} instructions, {max} at worst; a period of 0.5 ms {:.0} in all",
            Or(report.load.period_instructions_mean, "")
        )?;
        let [few, many] = CYCLES_PER_INSTRUCTION;
        line!(
            f,
            "load",
            "ticks {:.1} to {:.1} %, all {:.1} to {:.1} % of 100 MHz, at {few:.0} to {many:.0} cycles an instruction",
            load[0],
            load[1],
            core[0],
            core[1]
        )?;
    }
    Ok(())
}

fn slip(f: &mut fmt::Formatter<'_>, report: &Report) -> fmt::Result {
    let slip = &report.slip;
    let (Some(dropped), Some(distance_mm)) = (slip.dropped, slip.distance_mm) else {
        return Ok(());
    };
    let fate = match (dropped, report.object.left_behind, report.object.handed_over) {
        (true, ..) => "DROPPED",
        (false, Some(true), _) => "LEFT BEHIND",
        (false, _, Some(true)) => "handed over",
        (false, ..) => "kept",
    };
    line!(
        f,
        "object",
        "{fate}; slid {distance_mm:.2} mm, the bound {:.2} ({:.2})",
        Or(report.bound.distance_mm, "mm"),
        Or(report.bound.distance_ratio, "times")
    )?;
    if let Some(turned_deg) = report.object.turned_deg.filter(|deg| deg.abs() >= 0.05) {
        line!(f, "turned", "{turned_deg:.1} degrees in the hand")?;
    }
    for ran in &report.behaviours {
        let (end, how) = (Or(ran.end_s, "s"), ran.ending.unwrap_or("goes on"));
        line!(f, "behaviour", "{} from {:.2} s to {end:.2}: {how}", ran.name, ran.begin_s)?;
    }
    line!(
        f,
        "reflex",
        "{} pulses, {} of them without slip; they added {:.2} N, without need {:.2}; it took back {:.2} N",
        report.reflex.pulses,
        report.reflex.without_slip.unwrap_or(0),
        report.added.added_n,
        Or(report.added.added_without_need_n, "N"),
        report.added.relaxed_n
    )?;
    line!(
        f,
        "grip force",
        "peak {:.2}, needed {:.2}, the bound {:.2} ({:.2})",
        Or(report.grip.peak_force_n, "N"),
        Or(report.grip.needed_force_n, "N"),
        Or(report.bound.peak_force_n, "N"),
        Or(report.bound.peak_force_ratio, "times")
    )?;
    line!(
        f,
        "margin",
        "least {:.0}, last {:.0}",
        Or(report.margin.least_mn, "mN"),
        Or(report.margin.last_mn, "mN")
    )?;
    for control in &report.controls {
        line!(
            f,
            control.name,
            "{}; slid {:.2} mm, peak {:.2}, mean {:.2}, beyond need {:.2}",
            if control.kept { "kept" } else { "LOST" },
            control.distance_mm,
            Or(control.peak_force_n, "N"),
            Or(control.mean_force_n, "N"),
            Or(control.beyond_need_n, "N")
        )?;
    }
    if let (Some(at_s), Some(dent_mm)) = (report.grip.crushed_at_s, report.grip.dent_mm) {
        line!(f, "damage", "CRUSHED at {at_s:.2} s by {dent_mm:.2} mm")?;
    }
    if let Some(at_s) = report.grip.broken_at_s {
        line!(f, "damage", "BROKEN at {at_s:.2} s")?;
    }
    let caught = match (slip.macro_slips, slip.macro_slips_caught) {
        (Some(0) | None, _) => "no macro slip".to_owned(),
        (Some(all), caught) => format!("{} of {all} macro slips caught", caught.unwrap_or(0)),
    };
    line!(
        f,
        "slip",
        "{caught}; first micro onset {:.4}, macro onset {:.4}, latency {:.1}",
        Or(slip.micro_onset_s, "s"),
        Or(slip.macro_onset_s, "s"),
        Or(slip.latency_ms, "ms")
    )
}

fn wearer(f: &mut fmt::Formatter<'_>, report: &Report) -> fmt::Result {
    let wearer = &report.wearer;
    if wearer.none {
        line!(f, "wearer", "none: the reflex works without myosensors")?;
    }
    line!(
        f,
        "wearer",
        "first active {:.4}; {} reflex ticks while active, {} at other times; slowest open {:.1}",
        Or(wearer.active_first_s, "s"),
        wearer.reflex_while_active,
        wearer.reflex_ticks - wearer.reflex_while_active,
        Or(wearer.open_latency_ms, "ms")
    )?;
    if wearer.vibration_steps > 0 {
        line!(
            f,
            "vibration",
            "{:.3} s of the feedback's motor, in {} steps",
            wearer.vibration_s,
            wearer.vibration_steps
        )?;
    }
    Ok(())
}

fn detector(f: &mut fmt::Formatter<'_>, label: &str, detector: &Detector) -> fmt::Result {
    let false_alarms = detector.false_alarms.map_or(String::new(), |count| format!(", {count} false alarms"));
    line!(
        f,
        label,
        "first {:.4}, said {}, believed {}, acted on {}{false_alarms}",
        Or(detector.first_s, "s"),
        detector.said,
        detector.detections,
        detector.acted
    )
}

fn replay(f: &mut fmt::Formatter<'_>, replay: &Replay) -> fmt::Result {
    let recipe = replay.recipe.as_deref().unwrap_or("none: columns are channels");
    line!(
        f,
        "recording",
        "{:.3} to {:.3} s, longest gap {:.2} ms; recipe {recipe}; first row held for {} s before",
        replay.first_s,
        replay.first_s + replay.duration_s,
        replay.longest_gap_ms,
        replay.lead_in_s
    )?;
    for assumption in &replay.assumed {
        line!(f, "assumed", "{assumption}")?;
    }
    for doubt in &replay.doubts {
        line!(f, "WARNING", "{doubt}")?;
    }
    if let Some(force) = &replay.force {
        crest(f, force)?;
    }
    if let Some(muscle) = &replay.muscle {
        activity(f, muscle)?;
    }
    if let Some(meant) = &replay.meant {
        meaning(f, meant)?;
    }
    Ok(())
}

fn meaning(f: &mut fmt::Formatter<'_>, meant: &Meant) -> fmt::Result {
    let never: Vec<&str> = meant.never.iter().map(|motion| motion.name()).collect();
    let did = meant.wanted_s.map_or(String::new(), |wanted_s| format!("it did for {wanted_s:.2} s; "));
    line!(
        f,
        "meant",
        "the hand shall {} and never {}: {did}wrong for {:.0} at most",
        meant.wants.name(),
        never.join(" or "),
        Or(Some(meant.wrong_ms), "ms")
    )
}

fn crest(f: &mut fmt::Formatter<'_>, force: &Force) -> fmt::Result {
    line!(
        f,
        "Ft/Fn crest",
        "{:.3} at {:.4}; S2 spoke {:.1} before it, S1 {:.1} before it",
        Or(force.peak_ratio, ""),
        Or(force.peak_s, "s"),
        Or(force.s2_before_peak_ms, "ms"),
        Or(force.s1_before_peak_ms, "ms")
    )
}

fn activity(f: &mut fmt::Formatter<'_>, muscle: &Muscle) -> fmt::Result {
    line!(
        f,
        "muscle",
        "active in the recording from {:.4}, noticed at {:.4}, {:.1} later; active for {:.0} % of it",
        Or(muscle.onset_s, "s"),
        Or(muscle.noticed_s, "s"),
        Or(muscle.onset_delay_ms, "ms"),
        100.0 * muscle.active_part
    )
}
