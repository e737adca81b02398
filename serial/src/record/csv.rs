//! A recording as CSV, a file a topic: the same values as in MCAP, with the time in a column.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::protobuf::{Kind, Value};
use super::topics::{Topic, rows, seconds};
use crate::link::Inbox;

/// Numbers of a frame's films, and of the films' envelopes.
const LIST: usize = tenax_hal_shim::channel::PVDF_COUNT;

/// Writes what a line says into `folder`; returns the files. Fails if one cannot be written.
pub fn export(line: &[u8], folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut files: BTreeMap<String, csv::Writer<File>> = BTreeMap::new();
    let (mut inbox, mut last, mut paths) = (Inbox::default(), 0, Vec::new());
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        for (topic, frame, values) in rows(&heard.received.message, last) {
            last = last.max(frame);
            let file = match files.entry(topic.name()) {
                std::collections::btree_map::Entry::Occupied(file) => file.into_mut(),
                std::collections::btree_map::Entry::Vacant(place) => {
                    let path = file_of(topic, folder, "csv");
                    let mut file = csv::Writer::from_path(&path)
                        .with_context(|| format!("cannot write {}", path.display()))?;
                    file.write_record(columns(topic).map(|(name, _)| name))?;
                    paths.push(path);
                    place.insert(file)
                }
            };
            let time = format!("{:.4}", seconds(frame));
            file.write_record([time].into_iter().chain(values.iter().flat_map(cells)))?;
        }
    }
    for file in files.values_mut() {
        file.flush()?;
    }
    Ok(paths)
}

pub fn file_of(topic: Topic, folder: &Path, extension: &str) -> PathBuf {
    folder.join(topic.name().trim_matches('/').replace('/', "-")).with_extension(extension)
}

/// The columns of a topic: the time, and its fields, a list as a column each.
pub fn columns(topic: Topic) -> impl Iterator<Item = (String, Kind)> {
    let columns = topic.fields().into_iter().flat_map(|(name, kind)| match kind {
        Kind::Numbers => (1..=LIST).map(|n| (format!("{name}_{n}"), kind)).collect(),
        _ => vec![(name, kind)],
    });
    [("time_s".to_owned(), Kind::Number)].into_iter().chain(columns)
}

fn cells(value: &Value) -> Vec<String> {
    match value {
        Value::Number(number) => vec![number.to_string()],
        Value::Numbers(numbers) => numbers.iter().map(ToString::to_string).collect(),
        Value::Flag(flag) => vec![u8::from(*flag).to_string()],
        Value::Text(text) => vec![text.clone()],
        Value::Bytes(bytes) => vec![bytes.iter().map(|byte| format!("{byte:02x}")).collect()],
    }
}
