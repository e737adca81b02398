//! MCAP files (mcap.dev, version 0): written in chunks that zstd compresses, with an index of chunks and messages; read from begin to
//! end, or chunk by chunk.
//!
//! The crate `mcap` does this too, but its derive macros turn on a feature of `proc-macro2` with which everything that has
//! macros, the emulator included, is compiled anew.

mod read;

use std::collections::BTreeMap;
use std::io::{self, Write};

pub use self::read::{Chunk, Topics, chunk, chunks, read};

const MAGIC: &[u8] = b"\x89MCAP0\r\n";
const HEADER: u8 = 1;
const FOOTER: u8 = 2;
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;
const MESSAGE_INDEX: u8 = 7;
const CHUNK_INDEX: u8 = 8;
const STATISTICS: u8 = 11;
const METADATA: u8 = 12;
const METADATA_INDEX: u8 = 13;
const DATA_END: u8 = 15;
/// How chunks are compressed, as the file says.
const ZSTD: &[u8] = b"zstd";

/// A record's content as it grows.
#[derive(Default)]
struct Content(Vec<u8>);

impl Content {
    fn u16(mut self, value: u16) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    fn u32(mut self, value: u32) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    fn u64(mut self, value: u64) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    /// Bytes after their length.
    fn bytes(mut self, bytes: &[u8]) -> Self {
        self = self.u32(bytes.len() as u32);
        self.0.extend_from_slice(bytes);
        self
    }

    fn raw(mut self, bytes: &[u8]) -> Self {
        self.0.extend_from_slice(bytes);
        self
    }

    fn record(&self, opcode: u8) -> Vec<u8> {
        [&[opcode][..], &(self.0.len() as u64).to_le_bytes(), &self.0].concat()
    }
}

/// How long a chunk is when it is written, bytes, and how hard it is compressed.
#[derive(Clone, Copy, Debug)]
pub struct Packing {
    chunk_bytes: usize,
    level: i32,
}

impl Packing {
    /// zstd's own default.
    pub const FAST: Self = Self { chunk_bytes: 1 << 20, level: 3 };
    /// A seventh less. A chunk takes 17 ms: a serial port's 4 kB last for 40 ms of the whole line.
    pub const SMALL: Self = Self { chunk_bytes: 128 << 10, level: 17 };
}

/// Where a chunk is.
struct Indexed {
    first_ns: u64,
    last_ns: u64,
    at: u64,
    length: u64,
    content: u64,
    compressed: u64,
    /// Where the index of each channel's messages is, and how long all of them are.
    messages: Vec<u8>,
    messages_length: u64,
}

pub struct Writer<W: Write> {
    out: W,
    packing: Packing,
    at: u64,
    channels: Vec<u8>,
    counts: BTreeMap<u16, u64>,
    chunk: Vec<u8>,
    span_ns: Option<(u64, u64)>,
    /// Of each channel's messages in the chunk, time and place.
    places: BTreeMap<u16, Vec<u8>>,
    index: Vec<Indexed>,
    /// Index records of what was told of the file.
    metadata: Vec<Vec<u8>>,
}

impl<W: Write> Writer<W> {
    pub fn new(out: W, packing: Packing) -> io::Result<Self> {
        let mut writer = Self {
            out,
            packing,
            at: 0,
            channels: Vec::new(),
            counts: BTreeMap::new(),
            chunk: Vec::new(),
            span_ns: None,
            places: BTreeMap::new(),
            index: Vec::new(),
            metadata: Vec::new(),
        };
        writer.put(MAGIC)?;
        let library = concat!("tenax ", env!("CARGO_PKG_VERSION"));
        writer.put(&Content::default().bytes(b"").bytes(library.as_bytes()).record(HEADER))?;
        Ok(writer)
    }

    /// A topic whose messages are of one protobuf message; returns its number.
    pub fn channel(&mut self, topic: &str, message: &str, descriptor: &[u8]) -> u16 {
        let id = self.counts.len() as u16 + 1;
        let schema =
            Content::default().u16(id).bytes(message.as_bytes()).bytes(b"protobuf").bytes(descriptor);
        let channel = Content::default().u16(id).u16(id).bytes(topic.as_bytes()).bytes(b"protobuf").u32(0);
        let both = [schema.record(SCHEMA), channel.record(CHANNEL)].concat();
        self.chunk.extend_from_slice(&both);
        self.channels.extend_from_slice(&both);
        self.counts.insert(id, 0);
        id
    }

    /// What is to be known of the file.
    pub fn metadata(&mut self, name: &str, about: &[(&str, String)]) -> io::Result<()> {
        self.end_chunk()?;
        let both = |content: Content, (key, value): &(&str, String)| {
            content.bytes(key.as_bytes()).bytes(value.as_bytes())
        };
        let about = about.iter().fold(Content::default(), both);
        let record = Content::default().bytes(name.as_bytes()).bytes(&about.0).record(METADATA);
        let index = Content::default().u64(self.at).u64(record.len() as u64).bytes(name.as_bytes());
        self.metadata.push(index.record(METADATA_INDEX));
        self.put(&record)
    }

    /// Bytes that were written or wait to be.
    pub const fn bytes(&self) -> u64 {
        self.at + self.chunk.len() as u64
    }

    /// A message of a channel: when it was said, and when it came.
    pub fn message(&mut self, channel: u16, at_ns: u64, came_ns: u64, data: &[u8]) -> io::Result<()> {
        let count = self.counts.entry(channel).or_default();
        let content = Content::default().u16(channel).u32(*count as u32).u64(at_ns).u64(came_ns).raw(data);
        *count += 1;
        let place = Content::default().u64(at_ns).u64(self.chunk.len() as u64);
        self.places.entry(channel).or_default().extend_from_slice(&place.0);
        self.chunk.extend_from_slice(&content.record(MESSAGE));
        let (first, last) = self.span_ns.unwrap_or((at_ns, at_ns));
        self.span_ns = Some((first.min(at_ns), last.max(at_ns)));
        if self.chunk.len() >= self.packing.chunk_bytes { self.end_chunk() } else { Ok(()) }
    }

    pub fn finish(mut self) -> io::Result<W> {
        self.end_chunk()?;
        self.put(&Content::default().u32(0).record(DATA_END))?;
        let summary = self.at;
        let channels = std::mem::take(&mut self.channels);
        self.put(&channels)?;
        let (chunks, mut first, mut last) = (self.index.len() as u32, u64::MAX, 0);
        for chunk in std::mem::take(&mut self.index) {
            (first, last) = (first.min(chunk.first_ns), last.max(chunk.last_ns));
            let content =
                Content::default().u64(chunk.first_ns).u64(chunk.last_ns).u64(chunk.at).u64(chunk.length);
            let content = content.bytes(&chunk.messages).u64(chunk.messages_length);
            let content = content.bytes(ZSTD).u64(chunk.compressed).u64(chunk.content);
            self.put(&content.record(CHUNK_INDEX))?;
        }
        let metadata = std::mem::take(&mut self.metadata);
        for index in &metadata {
            self.put(index)?;
        }
        let counts = std::mem::take(&mut self.counts);
        let mut each = Content::default();
        for (channel, count) in &counts {
            each = each.u16(*channel).u64(*count);
        }
        let content = Content::default().u64(counts.values().sum()).u16(counts.len() as u16);
        let content = content.u32(counts.len() as u32).u32(0).u32(metadata.len() as u32).u32(chunks);
        let content = content.u64(first.min(last)).u64(last).bytes(&each.0);
        self.put(&content.record(STATISTICS))?;
        self.put(&Content::default().u64(summary).u64(0).u32(0).record(FOOTER))?;
        self.put(MAGIC)?;
        self.out.flush()?;
        Ok(self.out)
    }

    fn end_chunk(&mut self) -> io::Result<()> {
        let records = std::mem::take(&mut self.chunk);
        let (first_ns, last_ns) = self.span_ns.take().unwrap_or((0, 0));
        if records.is_empty() {
            return Ok(());
        }
        let content = records.len() as u64;
        let packed = zstd::bulk::compress(&records, self.packing.level)?;
        let compressed = packed.len() as u64;
        // A checksum of 0 says that there is none.
        let chunk =
            Content::default().u64(first_ns).u64(last_ns).u64(content).u32(0).bytes(ZSTD).u64(compressed);
        let record = chunk.raw(&packed).record(CHUNK);
        let (at, length) = (self.at, record.len() as u64);
        self.put(&record)?;
        // Foxglove's reader takes no chunk without it.
        let begin = self.at;
        let mut messages = Content::default();
        for (channel, places) in std::mem::take(&mut self.places) {
            messages = messages.u16(channel).u64(self.at);
            self.put(&Content::default().u16(channel).bytes(&places).record(MESSAGE_INDEX))?;
        }
        let (messages, messages_length) = (messages.0, self.at - begin);
        self.index.push(Indexed {
            first_ns,
            last_ns,
            at,
            length,
            content,
            compressed,
            messages,
            messages_length,
        });
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.at += bytes.len() as u64;
        self.out.write_all(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(messages: u64) -> Vec<u8> {
        let mut writer = Writer::new(Vec::new(), Packing::FAST).unwrap();
        let topics = ["/a", "/b"].map(|topic| writer.channel(topic, "tenax.A", b"descriptor"));
        for n in 0..messages {
            writer.message(topics[n as usize % 2], n, n, &[n as u8; 100]).unwrap();
        }
        writer.finish().unwrap()
    }

    fn count(file: &[u8]) -> u64 {
        let mut count = 0;
        read(file, &mut |topic, at_ns, data| {
            assert_eq!((topic, data), (["/a", "/b"][at_ns as usize % 2], &[at_ns as u8; 100][..]));
            assert_eq!(at_ns, count);
            count += 1;
        })
        .unwrap();
        count
    }

    #[test]
    fn messages_come_back_in_order_over_several_chunks() {
        assert_eq!(count(&file(20_000)), 20_000);
        assert_eq!(count(&file(0)), 0);
    }

    #[test]
    fn a_file_that_was_cut_short_gives_its_whole_chunks_and_garbage_is_no_panic() {
        let whole = file(20_000);
        for cut in [0, 1, 7, 8, 100, whole.len() / 2, whole.len() - 1] {
            let _short = read(&whole[..cut], &mut |_, _, _| {});
        }
        assert!(count(&whole[..whole.len() / 2]) > 5_000);
        let mut torn = whole;
        for n in (8..torn.len()).step_by(997) {
            torn[n] ^= 0x55;
        }
        let _torn = read(&torn, &mut |_, _, _| {});
        assert!(read(b"no such file", &mut |_, _, _| {}).is_err());
    }
}
