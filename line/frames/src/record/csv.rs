//! A recording as CSV, a file a topic: the same values as in MCAP, with the time in a column.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs::File;
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::protobuf::{Kind, Value};
use super::topics::{Topic, rows};
use crate::link::Inbox;
use crate::words::seconds;

/// Numbers of a frame's films, and of the films' envelopes.
const LIST: usize = tenax_hal_shim::channel::PVDF_COUNT;

/// Writes what a line says into `folder`; returns the files. Fails if one cannot be written.
pub fn export(line: &[u8], folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let create = |topic: Topic, path: &Path| {
        let mut file = csv::Writer::from_path(path)?;
        file.write_record(columns(topic).map(|(name, _)| name))?;
        Ok(file)
    };
    let put = |file: &mut csv::Writer<File>, time_s: f64, values: &[Value]| {
        let time = format!("{time_s:.4}");
        Ok(file.write_record([time].into_iter().chain(values.iter().flat_map(cells)))?)
    };
    files(line, folder, "csv", create, put, |mut file| Ok(file.flush()?))
}

/// A file a topic, begun with its first row and ended with the line; returns their paths.
pub(super) fn files<T>(
    line: &[u8],
    folder: &Path,
    extension: &str,
    create: impl Fn(Topic, &Path) -> anyhow::Result<T>,
    put: impl Fn(&mut T, f64, &[Value]) -> anyhow::Result<()>,
    finish: impl Fn(T) -> anyhow::Result<()>,
) -> anyhow::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut files: BTreeMap<String, T> = BTreeMap::new();
    let (mut inbox, mut last, mut paths) = (Inbox::default(), 0, Vec::new());
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        for (topic, frame, values) in rows(&heard.received.message, last) {
            last = last.max(frame);
            let file = match files.entry(topic.name()) {
                Entry::Occupied(file) => file.into_mut(),
                Entry::Vacant(place) => {
                    let name = topic.name().trim_matches('/').replace('/', "-");
                    let path = folder.join(name).with_extension(extension);
                    let file =
                        create(topic, &path).with_context(|| format!("cannot write {}", path.display()))?;
                    paths.push(path);
                    place.insert(file)
                }
            };
            put(file, seconds(frame), &values)?;
        }
    }
    files.into_values().try_for_each(finish)?;
    Ok(paths)
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
