//! Recordings of a board's line: MCAP for Foxglove, PlotJuggler and Python, and CSV with the same values.
//!
//! The topic `/line` holds the bytes as they came; all other topics are made from them. A message's log time is the board's,
//! counted from this computer's clock at the beginning; its publish time is this computer's. The metadata `tenax` names tool,
//! chip, build, schema and settings.

pub mod csv;
pub mod topics;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::iter;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{McapResult, WriteOptions, Writer};
use tenax_hal_shim::wire::{About, Answer, FRAME_MAX, Received, Up, encode};

use self::topics::{Row, rows};
use crate::link::Inbox;
use crate::link::captured::{TOPIC, is_recording};
use crate::protobuf::{self, PACKAGE, Value};
use crate::settings;
use crate::words::seconds;

/// The name of a recording that begins now: `tenax-20261123T081500Z.mcap`.
pub fn name_now() -> PathBuf {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    PathBuf::from(format!("tenax-{}.mcap", now.replace(['-', ':'], "")))
}

pub struct Recording {
    file: Writer<NoSeek<BufWriter<File>>>,
    /// Number of each topic's channel, and of its next message.
    channels: BTreeMap<String, (u16, u32)>,
    /// When the file was begun, and the board's time 0 by this computer's clock, if that is known.
    began_ns: u64,
    zero_ns: Option<u64>,
    last: u32,
    about: Option<About>,
    error: Option<anyhow::Error>,
    inbox: Inbox,
}

impl Recording {
    /// A recording in a new file. Fails if the file cannot be written, is there already, or is not called `*.mcap`.
    pub fn create(path: &Path) -> anyhow::Result<Self> {
        let name = path.display();
        if !is_recording(path) {
            bail!(
                "{name}: a recording is an MCAP file; call it {}. `tenax play FILE.mcap --csv DIR` makes CSV of it",
                path.with_extension("mcap").display()
            );
        }
        let file = match File::create_new(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                bail!("{name} is there already, and a recording overwrites nothing: choose another name")
            }
            other => other.with_context(|| format!("cannot write {name}"))?,
        };
        let options = WriteOptions::new()
            .library(concat!("tenax ", env!("CARGO_PKG_VERSION")))
            .compression_threads(0)
            // A chunk is written when it is whole: a file that is cut short is read up to there.
            .disable_seeking(true);
        Ok(Self {
            file: options.create(NoSeek::new(BufWriter::new(file)))?,
            channels: BTreeMap::new(),
            began_ns: now_ns(),
            zero_ns: None,
            last: 0,
            about: None,
            error: None,
            inbox: Inbox::default(),
        })
    }

    /// Records a message. An error is kept for [`finish`](Self::finish).
    pub fn take(&mut self, received: &Received<Up>) {
        if let Up::About(about) | Up::Answer { answer: Answer::About(about), .. } = &received.message {
            self.about = Some(about.clone());
        }
        let came_ns = now_ns();
        if matches!(received.message, Up::Hello { .. }) {
            // A board that starts anew counts from 0 again: in the file, its time goes on.
            (self.zero_ns, self.last) = (Some(came_ns.max(self.at_ns(self.last) + 1)), 0);
        }
        let rows = rows(&received.message, self.last);
        self.last = rows.iter().map(|row| row.frame).fold(self.last, u32::max);
        if self.zero_ns.is_none() {
            // Before the first frame there is no time.
            if self.last == 0 {
                return;
            }
            self.zero_ns = Some(came_ns.saturating_sub(in_ns(self.last)));
        }
        let mut buffer = [0; FRAME_MAX];
        let bytes = encode(received.sequence, &received.message, &mut buffer);
        let fields = vec![("data".into(), Value::Bytes(bytes.unwrap_or_default().to_vec()))];
        let line = Row { topic: TOPIC.into(), message: "Line", frame: self.last, fields };
        for row in iter::once(line).chain(rows) {
            if let Err(error) = self.write(&row, came_ns) {
                self.error.get_or_insert(error.into());
            }
        }
    }

    fn write(&mut self, row: &Row, came_ns: u64) -> McapResult<()> {
        let log_time = self.at_ns(row.frame);
        if !self.channels.contains_key(&*row.topic) {
            let descriptor = protobuf::descriptor(row.message, &row.fields);
            let schema =
                self.file.add_schema(&format!("{PACKAGE}.{}", row.message), "protobuf", &descriptor)?;
            let channel = self.file.add_channel(schema, &row.topic, "protobuf", &BTreeMap::new())?;
            self.channels.insert(row.topic.to_string(), (channel, 0));
        }
        let Some((channel_id, next)) = self.channels.get_mut(&*row.topic) else { return Ok(()) };
        let header =
            MessageHeader { channel_id: *channel_id, sequence: *next, log_time, publish_time: came_ns };
        *next += 1;
        self.file.write_to_known_channel(&header, &protobuf::message(&row.fields))
    }

    fn at_ns(&self, frame: u32) -> u64 {
        self.zero_ns.unwrap_or(0) + in_ns(frame)
    }

    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received);
            }
        }
    }

    /// Ends the file. Fails if it could not be written whole.
    pub fn finish(mut self) -> anyhow::Result<()> {
        if let Some(error) = self.error {
            return Err(error);
        }
        let began = UNIX_EPOCH + Duration::from_nanos(self.began_ns);
        let mut all = vec![
            ("tool", concat!("tenax ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("began", humantime::format_rfc3339_millis(began).to_string()),
        ];
        if let Some(About { identity, schema, settings, .. }) = &self.about {
            let [c0, c1, c2] = identity.chip;
            all.extend([
                ("chip", format!("{c0:08x}-{c1:08x}-{c2:08x}")),
                ("build", format!("{:016x}", identity.build)),
                ("schema", format!("{schema:016x}")),
                ("settings", settings::toml(settings)),
            ]);
        }
        let metadata = all.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        self.file.write_metadata(&Metadata { name: "tenax".to_owned(), metadata })?;
        self.file.finish()?;
        Ok(self.file.into_inner().flush()?)
    }
}

fn in_ns(frame: u32) -> u64 {
    (seconds(frame) * 1e9) as u64
}

fn now_ns() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64)
}
