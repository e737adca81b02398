//! People's prosthesis electrodes: medians of intent recognition over the recorded people.

use std::path::Path;

use super::{Bar, Verdict};
use crate::evaluate::emg;

pub fn bars(folder: &Path) -> anyhow::Result<Vec<Bar>> {
    let promise =
        "people's prosthesis electrodes, same session, medians; the constants were fitted to these people";
    if !folder.exists() {
        return Ok(vec![Bar::unjudged(promise, "recordings not present", Verdict::Skipped)]);
    }
    let report = emg::evaluate(folder, 0, 1)?;
    let measured = report.scores.same_session.map_or("every calibration was refused".to_owned(), |score| {
        format!(
            "{} people: closing {:.3} of the windows right, {:.3} the wrong way; opening {:.3} right, {:.3} the wrong way; {:.1} false \
             motions an hour; {:.3} of the calibrations refused",
            report.persons.len(),
            score.close_right,
            score.close_wrong_way,
            score.open_right,
            score.open_wrong_way,
            score.false_per_hour,
            report.refused_part
        )
    });
    Ok(vec![Bar::unjudged(promise, measured, Verdict::Noted)])
}
