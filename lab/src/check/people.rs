//! People's envelopes: medians of intent recognition over those whom the proof was chosen on, and over the others, whose scores were read meanwhile.

use std::path::Path;

use super::{Bar, Verdict};
use crate::evaluate::emg;

/// Folder, whom proof and doubt were chosen on, and whose scores were only read. The other constants are fitted to MyoBock 1 to 4.
const PEOPLE: [(&str, &str, &[u32], &[u32]); 2] = [
    ("prosthesis electrodes", "myobock", &[1, 2], &[3, 4]),
    ("armband", "myo", &[1, 2, 3, 4, 5], &[6, 7, 8, 9]),
];

pub fn bars(data: &Path) -> anyhow::Result<Vec<Bar>> {
    let mut bars = Vec::new();
    for (front_end, folder, chosen_on, read) in PEOPLE {
        for (part, people) in [("chosen on", chosen_on), ("read while choosing", read)] {
            bars.push(bar(&format!("{front_end}, people {people:?}, {part}"), &data.join(folder), people)?);
        }
    }
    Ok(bars)
}

fn bar(of: &str, folder: &Path, people: &[u32]) -> anyhow::Result<Bar> {
    let promise = format!(
        "{of}: same session, medians; the other constants were fitted to prosthesis electrodes 1 to 4"
    );
    if !folder.exists() {
        return Ok(Bar::unjudged(&promise, "recordings not present", Verdict::Skipped));
    }
    let report = emg::evaluate(folder, people, 0, 1)?;
    let measured = report.scores.same_session.map_or("every calibration was refused".to_owned(), |score| {
        format!(
            "closing {:.3} right, {:.3} wrong way; opening {:.3}, {:.3}; repetitions {:.3}; full speed p95 {:.2} s; {:.1} false an hour; doubt {:.4}; \
             refused {:.3}",
            score.close_right,
            score.close_wrong_way,
            score.open_right,
            score.open_wrong_way,
            score.repetitions_right,
            score.full_s_p95,
            score.false_per_hour,
            score.doubted_part,
            report.refused_part
        )
    });
    Ok(Bar::unjudged(&promise, measured, Verdict::Noted))
}
