//! The report for people.

use std::fmt::{self, Display, Formatter};

use tenax_hal_shim::detector::DetectorId;

use super::replay::Replay;
use super::{CYCLES_PER_INSTRUCTION, Report};
use crate::replay::meaning::Motion;

#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Report);

/// A value with its unit, or a dash.
struct Or(Option<f64>, &'static str);

impl Display for Or {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
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
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let report = self.0;
        writeln!(f, "{} on the {} board", report.scene, report.board)?;
        let (virtual_s, wall_s) = (report.virtual_s, report.wall_s);
        let speed = virtual_s / wall_s.max(1e-9);
        line!(f, "time", "{virtual_s:.2} s virtual in {wall_s:.2} s, {speed:.1} times real time")?;
        ticks(f, report)?;
        slip(f, report)?;
        wearer(f, report)?;
        for (id, own) in &report.detectors.all {
            // Nothing is injected but by who knows it.
            if *id == DetectorId::Injected && own.said == 0 {
                continue;
            }
            let (first, said, believed, acted) = (Or(own.first_s, "s"), own.said, own.detections, own.acted);
            let alarms = own.false_alarms.map_or(String::new(), |count| format!(", {count} false alarms"));
            let label = id.title();
            line!(f, label, "first {first:.4}, said {said}, believed {believed}, acted on {acted}{alarms}")?;
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

fn ticks(f: &mut Formatter<'_>, report: &Report) -> fmt::Result {
    let ticks = &report.ticks;
    line!(f, "ticks", "{} run, {} dropped, {} overruns", ticks.count, ticks.dropped, report.overruns)?;
    let (Some(mean), Some(max), Some([least, most]), Some([all_least, all_most])) =
        (ticks.instructions_mean, ticks.instructions_max, ticks.load_percent, ticks.core_load_percent)
    else {
        return Ok(());
    };
    let period = Or(report.load.period_instructions_mean, "");
    let [few, many] = CYCLES_PER_INSTRUCTION;
    line!(f, "tick", "{mean:.0} instructions, {max} at worst; a period of 0.5 ms {period:.0} in all")?;
    line!(
        f,
        "load",
        "ticks {least:.1} to {most:.1} %, all {all_least:.1} to {all_most:.1} % of 100 MHz, at {few:.0} to {many:.0} cycles an \
         instruction"
    )
}

fn slip(f: &mut Formatter<'_>, report: &Report) -> fmt::Result {
    let (slip, object, reflex, bound) = (&report.slip, &report.object, &report.reflex, &report.bound);
    let (Some(dropped), Some(distance_mm)) = (slip.dropped, slip.distance_mm) else {
        return Ok(());
    };
    let fate = match (dropped, object.left_behind, object.handed_over) {
        (true, ..) => "DROPPED",
        (false, Some(true), _) => "LEFT BEHIND",
        (false, _, Some(true)) => "handed over",
        (false, ..) => "kept",
    };
    let (own, ratio) = (Or(bound.distance_mm, "mm"), Or(bound.distance_ratio, "times"));
    line!(f, "object", "{fate}; slid {distance_mm:.2} mm, the bound {own:.2} ({ratio:.2})")?;
    if let Some(turned_deg) = object.turned_deg.filter(|deg| deg.abs() >= 0.05) {
        line!(f, "turned", "{turned_deg:.1} degrees in the hand")?;
    }
    for ran in &report.behaviours {
        let (end, how) = (Or(ran.end_s, "s"), ran.ending.unwrap_or("goes on"));
        line!(f, "behaviour", "{} from {:.2} s to {end:.2}: {how}", ran.name, ran.begin_s)?;
    }
    let (pulses, without) = (reflex.pulses, reflex.without_slip.unwrap_or(0));
    let (added_n, relaxed_n) = (report.added.added_n, report.added.relaxed_n);
    let needless = Or(report.added.added_without_need_n, "N");
    line!(
        f,
        "reflex",
        "{pulses} pulses, {without} of them without slip; they added {added_n:.2} N, without need {needless:.2}; it took back \
         {relaxed_n:.2} N"
    )?;
    let (peak, needed) = (Or(report.grip.peak_force_n, "N"), Or(report.grip.needed_force_n, "N"));
    let (own, ratio) = (Or(bound.peak_force_n, "N"), Or(bound.peak_force_ratio, "times"));
    line!(f, "grip force", "peak {peak:.2}, needed {needed:.2}, the bound {own:.2} ({ratio:.2})")?;
    let (least, last) = (Or(report.margin.least_mn, "mN"), Or(report.margin.last_mn, "mN"));
    line!(f, "margin", "least {least:.0}, last {last:.0}")?;
    for control in &report.controls {
        let (fate, slid_mm) = (if control.kept { "kept" } else { "LOST" }, control.distance_mm);
        let [peak, mean, beyond] =
            [control.peak_force_n, control.mean_force_n, control.beyond_need_n].map(|force| Or(force, "N"));
        let label = &control.name;
        line!(
            f,
            label,
            "{fate}; slid {slid_mm:.2} mm, peak {peak:.2}, mean {mean:.2}, beyond need {beyond:.2}"
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
    let (micro, macro_, late) =
        (Or(slip.micro_onset_s, "s"), Or(slip.macro_onset_s, "s"), Or(slip.latency_ms, "ms"));
    line!(f, "slip", "{caught}; first micro onset {micro:.4}, macro onset {macro_:.4}, latency {late:.1}")
}

fn wearer(f: &mut Formatter<'_>, report: &Report) -> fmt::Result {
    let wearer = &report.wearer;
    if wearer.none {
        line!(f, "wearer", "none: the reflex works without myosensors")?;
    }
    let (first, slowest) = (Or(wearer.active_first_s, "s"), Or(wearer.open_latency_ms, "ms"));
    let (active, others) = (wearer.reflex_while_active, wearer.reflex_ticks - wearer.reflex_while_active);
    line!(
        f,
        "wearer",
        "first active {first:.4}; {active} reflex ticks while active, {others} at other times; slowest open {slowest:.1}"
    )?;
    if wearer.vibration_steps > 0 {
        let (lasted_s, steps) = (wearer.vibration_s, wearer.vibration_steps);
        line!(f, "vibration", "{lasted_s:.3} s of the feedback's motor, in {steps} steps")?;
    }
    Ok(())
}

fn replay(f: &mut Formatter<'_>, replay: &Replay) -> fmt::Result {
    let recipe = replay.recipe.as_deref().unwrap_or("none: columns are channels");
    let (from_s, to_s) = (replay.first_s, replay.first_s + replay.duration_s);
    let (gap_ms, lead_in_s) = (replay.longest_gap_ms, replay.lead_in_s);
    line!(
        f,
        "recording",
        "{from_s:.3} to {to_s:.3} s, longest gap {gap_ms:.2} ms; recipe {recipe}; first row held for {lead_in_s} s before"
    )?;
    for assumption in &replay.assumed {
        line!(f, "assumed", "{assumption}")?;
    }
    for doubt in &replay.doubts {
        line!(f, "WARNING", "{doubt}")?;
    }
    if let Some(force) = &replay.force {
        let (peak, at) = (Or(force.peak_ratio, ""), Or(force.peak_s, "s"));
        let [s2, s1] = [force.s2_before_peak_ms, force.s1_before_peak_ms].map(|before| Or(before, "ms"));
        line!(f, "Ft/Fn crest", "{peak:.3} at {at:.4}; S2 spoke {s2:.1} before it, S1 {s1:.1} before it")?;
    }
    if let Some(muscle) = &replay.muscle {
        let (onset, noticed) = (Or(muscle.onset_s, "s"), Or(muscle.noticed_s, "s"));
        let (late, percent) = (Or(muscle.onset_delay_ms, "ms"), 100.0 * muscle.active_part);
        line!(
            f,
            "muscle",
            "active in the recording from {onset:.4}, noticed at {noticed:.4}, {late:.1} later; active for {percent:.0} % of it"
        )?;
    }
    if let Some(meant) = &replay.meant {
        let name = |motion: &Motion| format!("{motion:?}").to_lowercase();
        let never: Vec<String> = meant.never.iter().map(name).collect();
        let (wants, never) = (name(&meant.wants), never.join(" or "));
        let did = meant.wanted_s.map_or(String::new(), |wanted_s| format!("it did for {wanted_s:.2} s; "));
        let wrong = Or(Some(meant.wrong_ms), "ms");
        line!(f, "meant", "the hand shall {wants} and never {never}: {did}wrong for {wrong:.0} at most")?;
    }
    Ok(())
}
