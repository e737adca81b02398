//! A recording as Parquet, a file a topic: the same values as in MCAP and CSV, with the time in a column, for data frames and
//! training.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::csv::{columns, files};
use super::topics::Topic;
use crate::protobuf::{Kind, Value};

/// Rows of a group: some 30 s of ticks, so that a long recording takes little memory.
const GROUP_ROWS: usize = 65_536;

/// A topic's file, and the rows that are not yet in it.
struct Table {
    file: SerializedFileWriter<File>,
    columns: Vec<Column>,
}

enum Column {
    Numbers(Vec<f64>),
    Flags(Vec<bool>),
    Texts(Vec<ByteArray>),
}

/// Writes what a line says into `folder`; returns the files. Fails if one cannot be written.
pub fn export(line: &[u8], folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    files(line, folder, "parquet", Table::create, Table::push, Table::finish)
}

impl Table {
    fn create(topic: Topic, path: &Path) -> anyhow::Result<Self> {
        let (mut fields, mut own) = (Vec::new(), Vec::new());
        for (name, kind) in columns(topic) {
            let (physical, logical, column) = match kind {
                Kind::Flag => (Physical::BOOLEAN, None, Column::Flags(Vec::new())),
                Kind::Text | Kind::Bytes => {
                    (Physical::BYTE_ARRAY, Some(LogicalType::String), Column::Texts(Vec::new()))
                }
                Kind::Number | Kind::Numbers => (Physical::DOUBLE, None, Column::Numbers(Vec::new())),
            };
            let field = Type::primitive_type_builder(&name, physical).with_logical_type(logical);
            fields.push(Arc::new(field.with_repetition(Repetition::REQUIRED).build()?));
            own.push(column);
        }
        let schema = Type::group_type_builder(topic.message()).with_fields(fields).build()?;
        let properties = WriterProperties::builder().set_compression(Compression::ZSTD(Default::default()));
        let file = SerializedFileWriter::new(File::create(path)?, schema.into(), properties.build().into())?;
        Ok(Self { file, columns: own })
    }

    fn push(&mut self, time_s: f64, values: &[Value]) -> anyhow::Result<()> {
        let mut cells = self.columns.iter_mut();
        let mut put = |value: Cell<'_>| match (cells.next(), value) {
            (Some(Column::Numbers(all)), Cell::Number(number)) => all.push(number),
            (Some(Column::Flags(all)), Cell::Flag(flag)) => all.push(flag),
            (Some(Column::Texts(all)), Cell::Text(bytes)) => all.push(ByteArray::from(bytes.to_vec())),
            _ => unreachable!("a row has what its topic's fields say"),
        };
        put(Cell::Number(time_s));
        for value in values {
            match value {
                Value::Number(number) => put(Cell::Number(*number)),
                Value::Numbers(numbers) => numbers.iter().for_each(|number| put(Cell::Number(*number))),
                Value::Flag(flag) => put(Cell::Flag(*flag)),
                Value::Text(text) => put(Cell::Text(text.as_bytes())),
                Value::Bytes(bytes) => put(Cell::Text(bytes)),
            }
        }
        let full = matches!(&self.columns[0], Column::Numbers(times) if times.len() >= GROUP_ROWS);
        if full { self.group() } else { Ok(()) }
    }

    fn group(&mut self) -> anyhow::Result<()> {
        let mut group = self.file.next_row_group()?;
        for column in &mut self.columns {
            let mut writer = group.next_column()?.context("a file has its topic's columns")?;
            match column {
                Column::Numbers(all) => {
                    writer.typed::<DoubleType>().write_batch(&std::mem::take(all), None, None)?
                }
                Column::Flags(all) => {
                    writer.typed::<BoolType>().write_batch(&std::mem::take(all), None, None)?
                }
                Column::Texts(all) => {
                    writer.typed::<ByteArrayType>().write_batch(&std::mem::take(all), None, None)?
                }
            };
            writer.close()?;
        }
        group.close()?;
        Ok(())
    }

    fn finish(mut self) -> anyhow::Result<()> {
        self.group()?;
        self.file.close()?;
        Ok(())
    }
}

/// A value of one column.
enum Cell<'a> {
    Number(f64),
    Flag(bool),
    Text(&'a [u8]),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::Encoder;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    use tenax_hal_shim::wire::{Counters, Up};

    #[test]
    fn what_is_written_is_read_by_the_public_reader() {
        let (mut encoder, mut line) = (Encoder::default(), Vec::new());
        for frames in 0..3 {
            line.extend(encoder.frame(&Up::Counters(Counters { frames, ..Counters::default() })).1);
        }
        line.extend(encoder.frame(&Up::Hello { frame_hz: 2_000, after: None }).1);
        let folder = tempfile::tempdir().unwrap();
        let files = export(&line, folder.path()).unwrap();
        assert_eq!(
            files,
            ["counters", "event"].map(|name| folder.path().join(name).with_extension("parquet"))
        );
        let read = |file: &PathBuf| SerializedFileReader::new(File::open(file).unwrap()).unwrap();
        let counters = read(&files[0]);
        let rows: Vec<_> = counters.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(rows.iter().map(|row| row.get_double(1).unwrap()).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
        let event = read(&files[1]).get_row_iter(None).unwrap().next().unwrap().unwrap();
        assert!(event.get_string(1).unwrap().contains("2000"), "{event}");
    }
}
