//! Real input: what each kind of recording must and must not set off. The recordings are not part of the project. Every recording in the
//! folder whose name has a rule here is played, so more of the same kinds can simply be put there. The first of each kind is played on the
//! board and on the host, which have to say the same; the others on the host alone: emulated, all of them take 4 minutes of a core.

use std::fs;
use std::path::{Path, PathBuf};

use tenax_hal_shim::detector::DetectorId;
use tenax_sim::report::Report;
use tenax_sim::session::{self, Board};

use super::{Bar, Group, Verdict};

/// On the rig nothing slides before this, s.
const RIG_STILL_UNTIL_S: f64 = 1.5;

struct Rule {
    pattern: &'static str,
    promise: &'static str,
    judge: fn(&Report) -> (String, bool),
}

const RULES: [Rule; 7] = [
    Rule {
        pattern: "friction_rig*.csv",
        promise: "S2 warns before the peak of Ft/Fn, no alarm before 1.50 s",
        judge: rig,
    },
    Rule {
        pattern: "emg_*rest*.csv",
        promise: "relaxed muscles move nothing, and the reflex fires while none is active",
        judge: relaxed,
    },
    Rule {
        pattern: "emg_*fist*.csv",
        promise: "a fist is noticed and never opens, the reflex is silent throughout",
        judge: |report| contracted(report, report.wearer.longest_open_ms),
    },
    Rule {
        pattern: "emg_*extension*.csv",
        promise: "an extension is noticed and never closes, the reflex is silent throughout",
        judge: |report| contracted(report, report.wearer.longest_close_ms),
    },
    Rule {
        pattern: "emg_bursts*.csv",
        promise: "contractions are noticed, the reflex is silent throughout",
        judge: |report| contracted(report, 0.0),
    },
    Rule {
        pattern: "pvdf_*onset*.csv",
        promise: "S1 sees the onset of slip",
        judge: |report| s1(report, true),
    },
    Rule {
        pattern: "pvdf_[qc]*.csv",
        promise: "S1 is silent: quiet, or contact's slow drift",
        judge: |report| s1(report, false),
    },
];

/// A group for each recording in `folder` that a rule is for, and for each rule that has none.
pub fn groups<'a>(folder: &Path, board: &'a Board) -> anyhow::Result<Vec<Group<'a>>> {
    let mut files: Vec<_> = fs::read_dir(folder)
        .map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())).collect())
        .unwrap_or_default();
    files.sort();
    let mut groups: Vec<Group<'a>> = Vec::new();
    for rule in &RULES {
        let pattern = glob::Pattern::new(rule.pattern)?;
        let name_of = |file: &PathBuf| file.file_name().map(|name| name.to_string_lossy().into_owned());
        let named = files.iter().filter_map(|file| Some((file.clone(), name_of(file)?)));
        let before = groups.len();
        for (file, name) in named.filter(|(_, name)| pattern.matches(name)) {
            let emulated = (groups.len() == before).then_some(board);
            groups.push(Box::new(move || Ok(vec![bar(rule, &file, &name, emulated)?])));
        }
        if groups.len() == before {
            let promise = format!("{}: {}", rule.pattern, rule.promise);
            let skipped = Bar::unjudged(promise, "recording not present", Verdict::Skipped);
            groups.push(Box::new(move || Ok(vec![skipped.clone()])));
        }
    }
    Ok(groups)
}

/// A recording on the host, and on the emulated board if there is one.
fn bar(rule: &Rule, file: &Path, name: &str, emulated: Option<&Board>) -> anyhow::Result<Bar> {
    let judged = |board: &Board| -> anyhow::Result<_> {
        Ok((rule.judge)(&session::replay(file, None, 1, board, &mut |_| {})?.report))
    };
    let (figure, holds) = judged(&Board::Host)?;
    let promise = format!("{name}: {}", rule.promise);
    let Some(board) = emulated else {
        return Ok(Bar::new(promise, format!("{figure}; on the host"), "", holds));
    };
    let same = judged(board)? == (figure.clone(), holds);
    let word = if same { "too" } else { "NOT the same" };
    Ok(Bar::new(promise, format!("{figure}; {} {word}", board.name()), "", holds && same))
}

fn rig(report: &Report) -> (String, bool) {
    let Some(force) = report.replay.as_ref().and_then(|replay| replay.force.as_ref()) else {
        return ("no force in it".to_owned(), false);
    };
    let (Some(ratio), Some(peak_s)) = (force.peak_ratio, force.peak_s) else {
        return ("no peak of Ft/Fn in it".to_owned(), false);
    };
    let Some(before_ms) = force.s2_before_peak_ms else {
        return (format!("peak {ratio:.3} at {peak_s:.4} s, S2 never spoke"), false);
    };
    let first_alarm_s =
        [force.s1_first_s, force.s2_first_s].into_iter().flatten().fold(f64::INFINITY, f64::min);
    let figure = format!(
        "peak {ratio:.3} at {peak_s:.4} s, S2 {before_ms:.1} ms before it, first alarm of all at {first_alarm_s:.4} s"
    );
    (figure, before_ms > 0.0 && first_alarm_s >= RIG_STILL_UNTIL_S)
}

fn relaxed(report: &Report) -> (String, bool) {
    // The control of the contracted recordings: the same grasp, and nobody but the reflex to hold it.
    let (detections, reflex_ticks) = (report.detectors.wearer.detections, report.wearer.reflex_ticks);
    let moved_ms = report.wearer.longest_open_ms.max(report.wearer.longest_close_ms);
    let figure =
        format!("{detections} activities, {reflex_ticks} ticks of reflex, moved for {moved_ms:.0} ms");
    // Hum at rest is activity to a hand that is not calibrated: it silences, and moves nothing.
    (figure, reflex_ticks > 0 && moved_ms == 0.0)
}

/// `wrong_ms` is the longest motion that this contraction does not mean.
fn contracted(report: &Report, wrong_ms: f64) -> (String, bool) {
    let Some(muscle) = report.replay.as_ref().and_then(|replay| replay.muscle.as_ref()) else {
        return ("no muscle in it".to_owned(), false);
    };
    let Some(delay_ms) = muscle.onset_delay_ms else {
        return ("never noticed".to_owned(), false);
    };
    let figure = format!(
        "noticed {delay_ms:.1} ms after its onset; active {:.0} %, {} reflex commands, wrong motion {wrong_ms:.0} ms",
        100.0 * muscle.active_part,
        muscle.reflex_while_active
    );
    (figure, muscle.reflex_while_active == 0 && wrong_ms == 0.0)
}

fn s1(report: &Report, speaks: bool) -> (String, bool) {
    let s1 = report.detectors.of_id(DetectorId::S1);
    let figure = match s1.first_s {
        Some(first_s) => format!("S1 spoke at {first_s:.4} s, {} times in all", s1.detections),
        None => "S1 did not speak".to_owned(),
    };
    (figure, s1.first_s.is_some() == speaks)
}
