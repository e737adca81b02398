//! Recordings of a board's line: MCAP for Foxglove, PlotJuggler and Python, and CSV with the same values. The topic `/line` holds the bytes
//! as they came; all other topics are made from them. A message's log time is the board's, counted from this computer's clock at the
//! beginning and at each start of the board; its publish time is this computer's. The file is whole at every moment but for the last
//! half second. The metadata `tenax` names tool, chip, build, schema and settings.

#[cfg(feature = "host")]
pub mod csv;
#[cfg(feature = "host")]
mod file;
pub mod topics;

use std::collections::BTreeMap;
use std::io::Write;
use std::iter;
use std::time::{Duration, UNIX_EPOCH};

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{McapResult, WriteOptions, Writer};
use tenax_hal_shim::wire::{About, Answer, FRAME_MAX, Received, Up, encode};

#[cfg(feature = "host")]
pub use self::file::{Recording, name_now};
use self::topics::{Row, timed};
use crate::link::captured::TOPIC;
use crate::link::{Clock, Inbox};
use crate::protobuf::{self, PACKAGE, Value};
use crate::settings;

/// A recording on its way into `W`.
pub struct Tape<W: Write> {
    file: Writer<NoSeek<W>>,
    /// Number of each topic's channel, and of its next message.
    channels: BTreeMap<String, (u16, u32)>,
    began_ns: u64,
    clock: Clock,
    /// Whether the metadata are written: as soon as the board has said who it is.
    is_named: bool,
    inbox: Inbox,
}

impl<W: Write> Tape<W> {
    /// A recording that begins now, ns since 1970.
    pub fn new(out: W, now_ns: u64) -> McapResult<Self> {
        let options = WriteOptions::new()
            .library(concat!("tenax ", env!("CARGO_PKG_VERSION")))
            // A chunk is written when it is whole: a file that is cut short is read up to there.
            .disable_seeking(true);
        #[cfg(feature = "host")]
        let options = options.compression_threads(0);
        Ok(Self {
            file: options.create(NoSeek::new(out))?,
            channels: BTreeMap::new(),
            began_ns: now_ns,
            clock: Clock::default(),
            is_named: false,
            inbox: Inbox::default(),
        })
    }

    /// Records a message that comes now, ns since 1970; its log time. None: the board's time is not known yet.
    pub fn take(&mut self, received: &Received<Up>, now_ns: u64) -> McapResult<Option<u64>> {
        let message = &received.message;
        if let Up::About(about) | Up::Answer { answer: Answer::About(about), .. } = message
            && !self.is_named
        {
            self.name(Some(about))?;
        }
        let rows = timed(&mut self.clock, message, Some(now_ns));
        let Some(last) = self.clock.last() else { return Ok(None) };
        let mut buffer = [0; FRAME_MAX];
        let bytes = encode(received.sequence, message, &mut buffer);
        let fields = vec![("data".into(), Value::Bytes(bytes.unwrap_or_default().to_vec()))];
        let line = Row { topic: TOPIC.into(), message: "Line", frame: last, fields };
        iter::once(line).chain(rows).try_for_each(|row| self.write(&row, now_ns))?;
        Ok(Some(self.clock.ns(last)))
    }

    /// Records the messages in a line's bytes.
    pub fn line(&mut self, bytes: &[u8], now_ns: u64) -> McapResult<()> {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received, now_ns)?;
            }
        }
        Ok(())
    }

    pub fn flush(&mut self) -> McapResult<()> {
        self.file.flush()
    }

    fn write(&mut self, row: &Row, came_ns: u64) -> McapResult<()> {
        let log_time = self.clock.ns(row.frame);
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

    pub fn finish(mut self) -> McapResult<W> {
        if !self.is_named {
            self.name(None)?;
        }
        self.file.finish()?;
        let mut out = self.file.into_inner().into_inner();
        out.flush()?;
        Ok(out)
    }

    fn name(&mut self, about: Option<&About>) -> McapResult<()> {
        self.is_named = true;
        let began = UNIX_EPOCH + Duration::from_nanos(self.began_ns);
        let mut all = vec![
            ("tool", concat!("tenax ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("began", humantime::format_rfc3339_millis(began).to_string()),
        ];
        if let Some(About { identity, schema, settings, .. }) = about {
            let [c0, c1, c2] = identity.chip;
            all.extend([
                ("chip", format!("{c0:08x}-{c1:08x}-{c2:08x}")),
                ("build", format!("{:016x}", identity.build)),
                ("schema", format!("{schema:016x}")),
                ("settings", settings::toml(settings)),
            ]);
        }
        let metadata = all.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        self.file.write_metadata(&Metadata { name: "tenax".to_owned(), metadata })
    }
}
