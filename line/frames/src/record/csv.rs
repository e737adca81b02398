//! A recording as CSV, a file a topic: the same values as in MCAP. Columns before them: time in the file, which goes on when the board
//! starts again; time since the board's start; the recording computer's time since 1970, empty where only bytes were kept; all in s.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::topics::timed;
use crate::link::{Captured, Clock};
use crate::protobuf::Value;

/// Writes the values of a line's messages into `folder`; returns the files. Fails if one cannot be written.
pub fn export(captured: &Captured, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)?;
    let (mut clock, mut paths, mut files) = (Clock::default(), Vec::new(), BTreeMap::new());
    for (_, came_ns, frame) in captured.frames() {
        let Ok(heard) = frame else { continue };
        for row in timed(&mut clock, &heard.received.message, came_ns) {
            let host_s = came_ns.map_or_else(String::new, |ns| format!("{:.4}", ns as f64 / 1e9));
            let times = [
                ("time_s", format!("{:.4}", clock.seconds(row.frame))),
                ("board_s", format!("{:.4}", clock.board_seconds(row.frame))),
                ("host_s", host_s),
            ]
            .map(|(name, text)| (name.to_owned(), text));
            let cells = row.fields.iter().flat_map(|(name, value)| cells(name, value));
            let (names, cells): (Vec<String>, Vec<String>) = times.into_iter().chain(cells).unzip();
            if !files.contains_key(&row.topic) {
                let name = row.topic.trim_matches('/').replace('/', "-");
                let path = folder.join(name).with_extension("csv");
                let mut file = csv::Writer::from_path(&path)?;
                file.write_record(&names)?;
                paths.push(path);
                files.insert(row.topic.clone(), file);
            }
            if let Some(file) = files.get_mut(&row.topic) {
                file.write_record(&cells)?;
            }
        }
    }
    files.into_values().try_for_each(|mut file| file.flush())?;
    Ok(paths)
}

fn cells(name: &str, value: &Value) -> Vec<(String, String)> {
    let text = match value {
        Value::Numbers(numbers) => {
            return (1..)
                .zip(numbers)
                .map(|(n, number)| (format!("{name}_{n}"), number.to_string()))
                .collect();
        }
        Value::Number(number) => number.to_string(),
        Value::Flag(flag) => u8::from(*flag).to_string(),
        Value::Text(text) => text.clone(),
        Value::Bytes(bytes) => bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
    };
    vec![(name.to_owned(), text)]
}
