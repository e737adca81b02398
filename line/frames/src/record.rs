//! Recordings of a board's line: MCAP for Foxglove, PlotJuggler and Python, and CSV with the same values. The topic `/line` holds the bytes
//! as they came; all other topics are made from them. A message's log time is the board's, counted from this computer's clock at the
//! beginning and at each start of the board; its publish time is this computer's. The file is whole at every moment but for the last
//! half second. The metadata `tenax` names tool, chip, build, schema and settings.

pub mod csv;
pub mod topics;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::iter;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{McapResult, WriteOptions, Writer};
use tenax_hal_shim::wire::{About, Answer, FRAME_MAX, Received, Up, encode};

use self::topics::{Row, timed};
use crate::link::captured::{TOPIC, is_recording};
use crate::link::{Clock, Inbox};
use crate::protobuf::{self, PACKAGE, Value};
use crate::settings;

/// The name of a recording that begins now: `tenax-20261123T081500Z.mcap`.
pub fn name_now() -> PathBuf {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    PathBuf::from(format!("tenax-{}.mcap", now.replace(['-', ':'], "")))
}

/// Messages reach the file after so much of the recording computer's time, or of the board's.
const WHOLE_EVERY: Duration = Duration::from_millis(500);

pub struct Recording {
    path: PathBuf,
    file: Writer<NoSeek<BufWriter<File>>>,
    /// Number of each topic's channel, and of its next message.
    channels: BTreeMap<String, (u16, u32)>,
    /// When the file was begun, ns since 1970, and by a clock that nobody sets.
    began_ns: u64,
    began: Instant,
    clock: Clock,
    /// Whether the metadata are written: as soon as the board has said who it is.
    is_named: bool,
    /// When the oldest message that is not in the file came, and its log time, ns.
    oldest: Option<(Instant, u64)>,
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
            path: path.to_owned(),
            file: options.create(NoSeek::new(BufWriter::new(file)))?,
            channels: BTreeMap::new(),
            began_ns: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64),
            began: Instant::now(),
            clock: Clock::default(),
            is_named: false,
            oldest: None,
            inbox: Inbox::default(),
        })
    }

    /// Records a message. Fails if the file cannot be written: it is whole up to there.
    pub fn take(&mut self, received: &Received<Up>) -> anyhow::Result<()> {
        self.try_take(received).with_context(|| self.cannot())
    }

    fn try_take(&mut self, received: &Received<Up>) -> McapResult<()> {
        let message = &received.message;
        if let Up::About(about) | Up::Answer { answer: Answer::About(about), .. } = message
            && !self.is_named
        {
            self.name(Some(about))?;
        }
        let came_ns = self.began_ns + self.began.elapsed().as_nanos() as u64;
        let rows = timed(&mut self.clock, message, Some(came_ns));
        let Some(last) = self.clock.last() else { return Ok(()) };
        let mut buffer = [0; FRAME_MAX];
        let bytes = encode(received.sequence, message, &mut buffer);
        let fields = vec![("data".into(), Value::Bytes(bytes.unwrap_or_default().to_vec()))];
        let line = Row { topic: TOPIC.into(), message: "Line", frame: last, fields };
        iter::once(line).chain(rows).try_for_each(|row| self.write(&row, came_ns))?;
        let (_, from_ns) = *self.oldest.get_or_insert((Instant::now(), self.clock.ns(last)));
        if self.clock.ns(last).saturating_sub(from_ns) >= WHOLE_EVERY.as_nanos() as u64 {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes what has waited for long enough; to be called all the time. Fails as [`take`](Self::take) does.
    pub fn keep(&mut self) -> anyhow::Result<()> {
        match self.oldest {
            Some((came, _)) if came.elapsed() >= WHOLE_EVERY => self.flush().with_context(|| self.cannot()),
            _ => Ok(()),
        }
    }

    fn flush(&mut self) -> McapResult<()> {
        self.oldest = None;
        self.file.flush()
    }

    fn cannot(&self) -> String {
        format!("cannot write {}, which is whole up to there", self.path.display())
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

    /// Records the messages in a line's bytes. Fails as [`take`](Self::take) does.
    pub fn line(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received)?;
            }
        }
        self.keep()
    }

    /// Ends the file. Fails if it could not be written whole.
    pub fn finish(self) -> anyhow::Result<()> {
        let cannot = self.cannot();
        self.try_finish().context(cannot)
    }

    fn try_finish(mut self) -> McapResult<()> {
        if !self.is_named {
            self.name(None)?;
        }
        self.file.finish()?;
        Ok(self.file.into_inner().flush()?)
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
