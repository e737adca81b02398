//! A recording as CSV, a file a topic: the same values as in MCAP, with the time in a column.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::topics::rows;
use crate::link::Inbox;
use crate::protobuf::Value;
use crate::words::seconds;

/// Writes the values of a line's messages into `folder`; returns the files. Fails if one cannot be written.
pub fn export(line: &[u8], folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let (mut inbox, mut last, mut paths, mut files) = (Inbox::default(), 0, Vec::new(), BTreeMap::new());
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        for row in rows(&heard.received.message, last) {
            last = last.max(row.frame);
            let cells = row.fields.iter().flat_map(|(name, value)| cells(name, value));
            let (names, cells): (Vec<String>, Vec<String>) =
                [("time_s".to_owned(), format!("{:.4}", seconds(row.frame)))]
                    .into_iter()
                    .chain(cells)
                    .unzip();
            if !files.contains_key(&row.topic) {
                let name = row.topic.trim_matches('/').replace('/', "-");
                let path = folder.join(name).with_extension("csv");
                let mut file = csv::Writer::from_path(&path)
                    .with_context(|| format!("cannot write {}", path.display()))?;
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
