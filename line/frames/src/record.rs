//! Recordings of a board's line: MCAP for Foxglove, PlotJuggler and Python, and CSV with the same values.
//!
//! The topic `/line` holds the bytes as they came; all other topics are made from them. So a recording is played, watched
//! and replayed like a captured line, and what a later tool knows better it takes from the bytes again. A message's log time is the
//! board's, from where it was by this computer's clock at the beginning; its publish time is this computer's. The metadata `tenax` tell tool, chip, build, schema and settings.

pub mod csv;
pub mod topics;

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{About, Answer, FRAME_MAX, Received, Up, encode};

use self::topics::{Topic, rows};
use crate::link::Inbox;
use crate::link::captured::is_recording;
use crate::mcap::{Packing, Writer};
use crate::protobuf::{self, PACKAGE, Value};
use crate::settings;
use crate::words::seconds;

/// What a recording that begins now is called: `tenax-20261123T081500Z.mcap`.
pub fn name_now() -> PathBuf {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    PathBuf::from(format!("tenax-{}.mcap", now.replace(['-', ':'], "")))
}

/// A recording that is being written.
pub struct Recording {
    file: Writer<BufWriter<File>>,
    channels: Vec<(Topic, u16)>,
    /// When the file was begun, and when the board's time 0 was by this computer's clock, if that is known.
    began_ns: u64,
    zero_ns: Option<u64>,
    last: u32,
    about: Option<About>,
    error: Option<io::Error>,
    inbox: Inbox,
    /// Bytes of the line that wait to be one message, the slow frames in them, and how many of these it has.
    batch: (Vec<u8>, u32, u32),
}

/// Slow frames in a message of a compact recording's line, and for each of its states: a message takes 16 bytes of an index that
/// nothing compresses.
const BATCH: u32 = 4;

impl Recording {
    /// A recording of every topic in a new file.
    /// Fails if the file cannot be written, is there already, or is not called `*.mcap`.
    pub fn create(path: &Path) -> anyhow::Result<Self> {
        Self::of(path, Topic::all(), Packing::FAST, 1)
    }

    /// One for hours: the line, and what a person draws first, 20 times a second.
    /// Fails as [`create`](Self::create) does.
    pub fn compact(path: &Path) -> anyhow::Result<Self> {
        Self::of(path, Topic::compact(), Packing::SMALL, BATCH)
    }

    fn of(path: &Path, topics: Vec<Topic>, packing: Packing, batch: u32) -> anyhow::Result<Self> {
        let name = path.display();
        if !is_recording(path) {
            bail!(
                "{name}: a recording is an MCAP file; call it {}. `tenax play FILE.mcap --csv DIR` makes CSV of it",
                path.with_extension("mcap").display()
            );
        }
        let cannot = || format!("cannot write {name}");
        let file = match File::create_new(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                bail!("{name} is there already, and a recording overwrites nothing: choose another name")
            }
            other => other.with_context(cannot)?,
        };
        let out = BufWriter::new(file);
        let mut file = Writer::new(out, packing).with_context(cannot)?;
        let channels = topics
            .into_iter()
            .map(|topic| {
                let message = topic.message();
                let descriptor = protobuf::descriptor(message, &topic.fields());
                (topic, file.channel(&topic.name(), &format!("{PACKAGE}.{message}"), &descriptor))
            })
            .collect();
        Ok(Self {
            file,
            channels,
            began_ns: now_ns(),
            zero_ns: None,
            last: 0,
            about: None,
            error: None,
            inbox: Inbox::default(),
            batch: (Vec::new(), 0, batch),
        })
    }

    /// Takes a message in. An error is kept for [`finish`](Self::finish).
    pub fn take(&mut self, received: &Received<Up>) {
        if let Up::About(about) | Up::Answer { answer: Answer::About(about), .. } = &received.message {
            self.about = Some(about.clone());
        }
        let came_ns = now_ns();
        if matches!(received.message, Up::Hello { .. }) {
            self.end_batch();
            // A board that starts anew counts from 0 again: in the file, its time goes on.
            (self.zero_ns, self.last) = (Some(came_ns.max(self.at_ns(self.last) + 1)), 0);
        }
        let rows = rows(&received.message, self.last);
        if let Some(last) = rows.iter().map(|(_, frame, _)| *frame).max() {
            self.last = self.last.max(last);
        }
        if self.zero_ns.is_none() {
            // What was said before the first time was is of no time.
            if self.last == 0 {
                return;
            }
            self.zero_ns = Some(came_ns.saturating_sub(in_ns(self.last)));
        }
        let mut buffer = [0; FRAME_MAX];
        let bytes = encode(received.sequence, &received.message, &mut buffer);
        self.batch.0.extend_from_slice(bytes.unwrap_or_default());
        self.batch.1 += u32::from(matches!(received.message, Up::Slow(_)));
        let ends = self.batch.2 == 1 || self.batch.1 >= self.batch.2;
        if ends {
            self.end_batch();
        }
        for (topic, frame, values) in rows.into_iter().filter(|(topic, ..)| ends || *topic != Topic::State) {
            self.put(topic, frame, came_ns, &values);
        }
    }

    /// Writes what there is of the line's bytes.
    fn end_batch(&mut self) {
        let bytes = std::mem::take(&mut self.batch.0);
        self.batch.1 = 0;
        if !bytes.is_empty() {
            self.put(Topic::Line, self.last, now_ns(), &[Value::Bytes(bytes)]);
        }
    }

    fn put(&mut self, topic: Topic, frame: u32, came_ns: u64, values: &[Value]) {
        let at_ns = self.at_ns(frame);
        let Some((_, channel)) = self.channels.iter().find(|(own, _)| *own == topic) else { return };
        if let Err(error) = self.file.message(*channel, at_ns, came_ns, &protobuf::message(values)) {
            self.error.get_or_insert(error);
        }
    }

    /// When a frame ended, by the file's time.
    fn at_ns(&self, frame: u32) -> u64 {
        self.zero_ns.unwrap_or(0) + in_ns(frame)
    }

    /// Takes in what comes up a line, as it comes.
    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received);
            }
        }
    }

    /// Bytes in the file so far.
    pub const fn bytes(&self) -> u64 {
        self.file.bytes()
    }

    /// Who the board is, as far as it said so.
    fn metadata(&self) -> Vec<(&'static str, String)> {
        let mut metadata = vec![
            ("tool", concat!("tenax ", env!("CARGO_PKG_VERSION")).to_owned()),
            (
                "began",
                humantime::format_rfc3339_millis(UNIX_EPOCH + Duration::from_nanos(self.began_ns))
                    .to_string(),
            ),
        ];
        if let Some(About { identity, schema, settings, .. }) = &self.about {
            let [c0, c1, c2] = identity.chip;
            metadata.extend([
                ("chip", format!("{c0:08x}-{c1:08x}-{c2:08x}")),
                ("build", format!("{:016x}", identity.build)),
                ("schema", format!("{schema:016x}")),
                ("settings", settings::toml(settings)),
            ]);
        }
        metadata
    }

    /// Ends the file. Fails if it could not be written whole.
    pub fn finish(mut self) -> io::Result<()> {
        self.end_batch();
        if let Err(error) = self.file.metadata("tenax", &self.metadata()) {
            self.error.get_or_insert(error);
        }
        let finished = self.file.finish().map(drop);
        self.error.map_or(finished, Err)
    }
}

fn in_ns(frame: u32) -> u64 {
    (seconds(frame) * 1e9) as u64
}

fn now_ns() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64)
}
