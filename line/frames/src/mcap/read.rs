//! Reading MCAP: all of a file, or a chunk of it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use anyhow::{Context, bail, ensure};

use super::{CHANNEL, CHUNK, DATA_END, FOOTER, MAGIC, MESSAGE};

/// No chunk of a file that is read may be longer than this.
const CHUNK_BYTES_MAX: u64 = 256 << 20;
/// Bytes before a record's content.
const HEAD: u64 = 9;

/// The topics that were named so far, by their channels' numbers.
pub type Topics = BTreeMap<u16, String>;

/// Where a chunk is, and the span of its messages.
#[derive(Clone, Copy, Debug)]
pub struct Chunk {
    pub first_ns: u64,
    pub last_ns: u64,
    at: u64,
    length: u64,
}

/// Every chunk with messages, found by the records' heads alone. A file that ends early has those that are whole.
/// Fails if it is no such file, or cannot be read.
pub fn chunks(file: &mut File) -> anyhow::Result<Vec<Chunk>> {
    let end = file.metadata()?.len();
    let mut magic = [0; MAGIC.len()];
    file.read_exact(&mut magic).ok();
    ensure!(magic == MAGIC, "this is no MCAP file");
    let (mut chunks, mut at) = (Vec::new(), MAGIC.len() as u64);
    loop {
        let mut head = Vec::new();
        file.seek(SeekFrom::Start(at))?;
        file.take(HEAD + 16).read_to_end(&mut head)?;
        let mut fields = Fields(&head);
        let (Some(&[opcode]), Some(content)) = (fields.take(1), fields.u64()) else { break };
        let length = HEAD.saturating_add(content);
        if matches!(opcode, DATA_END | FOOTER) || at.saturating_add(length) > end {
            break;
        }
        if let (CHUNK, Some(first_ns), Some(last_ns)) = (opcode, fields.u64(), fields.u64())
            && last_ns > 0
        {
            chunks.push(Chunk { first_ns, last_ns, at, length });
        }
        at += length;
    }
    Ok(chunks)
}

/// Hands every message of one chunk to `each`, as [`read`] does those of a file.
pub fn chunk(
    file: &mut File,
    chunk: &Chunk,
    topics: &mut Topics,
    each: &mut dyn FnMut(&str, u64, &[u8]),
) -> anyhow::Result<()> {
    let mut record = Vec::new();
    file.seek(SeekFrom::Start(chunk.at))?;
    file.take(chunk.length).read_to_end(&mut record)?;
    walk(&record, topics, each)
}

/// Hands every message of a file to `each`: its topic, its time and its data. A file that ends early, because whoever wrote
/// it was killed, is read as far as it goes. Fails if it is no such file, or is compressed.
pub fn read(file: &[u8], each: &mut dyn FnMut(&str, u64, &[u8])) -> anyhow::Result<()> {
    let records = file.strip_prefix(MAGIC).context("this is no MCAP file")?;
    let mut topics = Topics::new();
    walk(records, &mut topics, each)
}

fn walk(mut rest: &[u8], topics: &mut Topics, each: &mut dyn FnMut(&str, u64, &[u8])) -> anyhow::Result<()> {
    while let Some((opcode, content)) = next(&mut rest) {
        match opcode {
            CHANNEL => {
                let mut fields = Fields(content);
                if let (Some(id), Some(_), Some(topic)) = (fields.u16(), fields.u16(), fields.text()) {
                    topics.insert(id, topic);
                }
            }
            MESSAGE => {
                let mut fields = Fields(content);
                if let (Some(id), Some(_), Some(at_ns), Some(_)) =
                    (fields.u16(), fields.take(4), fields.u64(), fields.u64())
                    && let Some(topic) = topics.get(&id)
                {
                    each(topic, at_ns, fields.0);
                }
            }
            CHUNK => {
                let mut fields = Fields(content);
                let compression = fields.take(28).and_then(|_| fields.text());
                if fields.u64().is_none() {
                    continue;
                }
                match compression.as_deref() {
                    Some("") => walk(fields.0, topics, each)?,
                    Some("zstd") => {
                        let mut records = Vec::new();
                        let unpacked = zstd::Decoder::new(fields.0)
                            .and_then(|chunk| chunk.take(CHUNK_BYTES_MAX).read_to_end(&mut records));
                        // Of a chunk that is damaged, what was whole.
                        let _damaged = unpacked.is_err();
                        walk(&records, topics, each)?;
                    }
                    Some(other) => {
                        bail!("this MCAP file is compressed ({other}): `mcap convert` undoes that")
                    }
                    None => {}
                }
            }
            DATA_END | FOOTER => break,
            _ => {}
        }
    }
    Ok(())
}

/// The next record: its kind and its content.
fn next<'a>(rest: &mut &'a [u8]) -> Option<(u8, &'a [u8])> {
    let mut fields = Fields(rest);
    let opcode = fields.take(1)?[0];
    let length = usize::try_from(fields.u64()?).ok()?;
    let content = fields.take(length)?;
    *rest = fields.0;
    Some((opcode, content))
}

struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(taken)
    }

    fn u16(&mut self) -> Option<u16> {
        Some(u16::from_le_bytes(self.take(2)?.try_into().ok()?))
    }

    fn u64(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn text(&mut self) -> Option<String> {
        let length = u32::from_le_bytes(self.take(4)?.try_into().ok()?);
        String::from_utf8(self.take(length as usize)?.to_vec()).ok()
    }
}
