//! Exact onsets in a data set: one cell of a row holds the slips whose micro onset lies in that row's step.
//!
//! `micro/macro/end/mm`, in seconds with 6 places, joined by `;`. An empty macro onset is micro slip that came to nothing, an empty end
//! is never, and a `!` behind the millimetres is a slip that was meant.

use std::fmt::Write;

use tenax_hal_shim::channel::SLOW_HZ;

use super::SlipSpan;

const STEP_S: f64 = 1.0 / SLOW_HZ as f64;

pub fn text<'a>(slips: impl IntoIterator<Item = &'a SlipSpan>) -> String {
    let mut text = String::new();
    for slip in slips {
        if !text.is_empty() {
            text.push(';');
        }
        let at = |s: Option<f64>| s.map_or(String::new(), |s| format!("{s:.6}"));
        let _ = write!(
            text,
            "{:.6}/{}/{}/{:.4}{}",
            slip.micro_onset_s,
            at(slip.macro_onset_s),
            at(slip.end_s.is_finite().then_some(slip.end_s)),
            slip.distance_mm,
            if slip.meant { "!" } else { "" }
        );
    }
    text
}

pub fn parse(cell: &str) -> Result<Vec<SlipSpan>, String> {
    cell.split(';').filter(|slip| !slip.trim().is_empty()).map(one).collect()
}

fn one(text: &str) -> Result<SlipSpan, String> {
    let wrong =
        || format!("`{text}` is no slip; one is micro/macro/end/mm, in seconds, such as 1.5/1.62/2.1/3.4");
    let parts: Vec<&str> = text.trim().trim_end_matches('!').split('/').collect();
    let [micro, macro_, end, mm] = parts[..] else { return Err(wrong()) };
    let number = |text: &str| text.parse::<f64>().ok().filter(|s| s.is_finite()).ok_or_else(wrong);
    let maybe = |text: &str| if text.is_empty() { Ok(None) } else { number(text).map(Some) };
    let slip = SlipSpan {
        micro_onset_s: number(micro)?,
        macro_onset_s: maybe(macro_)?,
        end_s: maybe(end)?.unwrap_or(f64::INFINITY),
        distance_mm: number(mm)?,
        meant: text.trim().ends_with('!'),
    };
    let macro_s = slip.macro_onset_s.unwrap_or(slip.micro_onset_s);
    if slip.micro_onset_s > macro_s || macro_s > slip.end_s {
        return Err(format!("`{text}` is not in the order of time: micro onset, macro onset, end"));
    }
    Ok(slip)
}

/// Slips of a recording that has labels and no onsets: each run of labelled steps, from the beginning of its first to the end
/// of its last, with no micro slip before it. Two that are nearer than the time that a detection may take are one. The first
/// step ends at `first_s`.
pub fn of_labels(labels: impl Iterator<Item = bool>, first_s: f64) -> Vec<SlipSpan> {
    let mut slips: Vec<SlipSpan> = Vec::new();
    for (n, _) in labels.enumerate().filter(|(_, slips)| *slips) {
        let to_s = first_s + n as f64 * STEP_S;
        let from_s = to_s - STEP_S;
        match slips.last_mut() {
            // Half a step is for what floats round off.
            Some(last) if from_s - last.end_s < super::CAUGHT_WITHIN_S - STEP_S / 2.0 => last.end_s = to_s,
            _ => slips.push(SlipSpan {
                micro_onset_s: from_s,
                macro_onset_s: Some(from_s),
                end_s: to_s,
                distance_mm: 0.0,
                meant: false,
            }),
        }
    }
    slips
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIP: SlipSpan = SlipSpan {
        micro_onset_s: 1.25,
        macro_onset_s: Some(1.375),
        end_s: 2.0,
        distance_mm: 3.5,
        meant: false,
    };

    #[test]
    fn what_is_written_is_read() {
        let all = [
            SLIP,
            SlipSpan { meant: true, end_s: f64::INFINITY, ..SLIP },
            SlipSpan { macro_onset_s: None, distance_mm: 0.0, ..SLIP },
        ];
        assert_eq!(parse(&text(&all)), Ok(all.to_vec()));
        assert_eq!((text(&[]), parse("")), (String::new(), Ok(Vec::new())));
    }

    #[test]
    fn labels_alone_make_slips_of_runs() {
        let runs = [10..=12, 16..=20, 25..=30];
        let slips = of_labels((0..40).map(|n| runs.iter().any(|run| run.contains(&n))), STEP_S);
        // 3 steps between the first two are 37.5 ms, 4 between the last two 50 ms.
        let spans: Vec<[f64; 2]> = slips
            .iter()
            .map(|slip| [slip.micro_onset_s, slip.end_s].map(|s| (s * 1e6).round() / 1e6))
            .collect();
        assert_eq!(spans, [[0.125, 0.2625], [0.3125, 0.3875]]);
    }
}
