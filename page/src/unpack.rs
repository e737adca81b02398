//! Chunks of a recording (MCAP) decompressed: the reader is built without zstd, whose C does not compile to wasm32.

use std::io::Read;

use ruzstd::decoding::StreamingDecoder;

const MAGIC: &[u8] = b"\x89MCAP0\r\n";
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;

/// The same recording without compression: header, schemas, channels, messages. What is cut short or damaged is left out.
pub fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let Some(mut rest) = bytes.strip_prefix(MAGIC) else { return bytes.to_vec() };
    let mut out = MAGIC.to_vec();
    while let Some((opcode, body, after)) = record(rest) {
        match opcode {
            CHUNK => out.extend(chunk(body).unwrap_or_default()),
            1..=CHANNEL | MESSAGE => out.extend_from_slice(&rest[..rest.len() - after.len()]),
            _ => {}
        }
        rest = after;
    }
    out
}

/// Opcode and body of the first record, and what comes after it.
fn record(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&opcode, rest) = bytes.split_first()?;
    let (body, after) = sized(rest)?;
    Some((opcode, body, after))
}

/// Bytes after their length of 64 bits, and what comes after them.
fn sized(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<8>()?;
    rest.split_at_checked(u64::from_le_bytes(*length).try_into().ok()?)
}

fn chunk(body: &[u8]) -> Option<Vec<u8>> {
    // Times of its first and last message, size, checksum.
    let (length, rest) = body.get(28..)?.split_first_chunk::<4>()?;
    let (compression, rest) = rest.split_at_checked(u32::from_le_bytes(*length).try_into().ok()?)?;
    let (packed, _) = sized(rest)?;
    match compression {
        b"" => Some(packed.to_vec()),
        b"zstd" => {
            let mut records = Vec::new();
            StreamingDecoder::new(packed).ok()?.read_to_end(&mut records).ok()?;
            Some(records)
        }
        _ => None,
    }
}
