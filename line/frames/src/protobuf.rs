//! Protobuf messages of plain fields and the descriptor of them, which Foxglove, PlotJuggler and the public decoders read.

use std::borrow::Cow;

/// A field's value. NaN: there was none.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    Flag(bool),
    Text(String),
    Bytes(Vec<u8>),
}

pub type Fields = Vec<(Cow<'static, str>, Value)>;

pub const PACKAGE: &str = "tenax";

// Wire types.
const VARINT: u64 = 0;
const FIXED64: u64 = 1;
const BYTES: u64 = 2;

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn bytes(out: &mut Vec<u8>, number: u64, bytes: &[u8]) {
    varint(out, number << 3 | BYTES);
    varint(out, bytes.len() as u64);
    out.extend_from_slice(bytes);
}

pub fn message(fields: &Fields) -> Vec<u8> {
    let mut out = Vec::new();
    for (number, (_, value)) in (1..).zip(fields) {
        match value {
            Value::Number(value) => {
                varint(&mut out, number << 3 | FIXED64);
                out.extend_from_slice(&value.to_le_bytes());
            }
            Value::Numbers(values) => {
                let packed: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
                bytes(&mut out, number, &packed);
            }
            Value::Flag(value) => {
                varint(&mut out, number << 3 | VARINT);
                varint(&mut out, u64::from(*value));
            }
            Value::Text(text) => bytes(&mut out, number, text.as_bytes()),
            Value::Bytes(data) => bytes(&mut out, number, data),
        }
    }
    out
}

pub fn first_bytes(message: &[u8]) -> Option<&[u8]> {
    let mut rest = message.strip_prefix(&[(1 << 3 | BYTES) as u8])?;
    let (mut length, mut shift) = (0, 0);
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        length |= usize::from(byte & 0x7f).checked_shl(shift)?;
        shift += 7;
        if byte & 0x80 == 0 {
            return rest.get(..length);
        }
    }
    None
}

/// The `FileDescriptorSet` of one message (`google/protobuf/descriptor.proto`).
pub fn descriptor(name: &str, fields: &Fields) -> Vec<u8> {
    const OPTIONAL: u64 = 1;
    const REPEATED: u64 = 3;
    let mut message = Vec::new();
    bytes(&mut message, 1, name.as_bytes());
    for (number, (name, value)) in (1..).zip(fields) {
        let (label, kind) = match value {
            Value::Number(_) => (OPTIONAL, 1),
            Value::Numbers(_) => (REPEATED, 1),
            Value::Flag(_) => (OPTIONAL, 8),
            Value::Text(_) => (OPTIONAL, 9),
            Value::Bytes(_) => (OPTIONAL, 12),
        };
        let mut field = Vec::new();
        bytes(&mut field, 1, name.as_bytes());
        for (place, value) in [(3, number), (4, label), (5, kind)] {
            varint(&mut field, place << 3 | VARINT);
            varint(&mut field, value);
        }
        bytes(&mut message, 2, &field);
    }
    let mut file = Vec::new();
    bytes(&mut file, 1, format!("{PACKAGE}/{name}.proto").as_bytes());
    bytes(&mut file, 2, PACKAGE.as_bytes());
    bytes(&mut file, 4, &message);
    bytes(&mut file, 12, b"proto3");
    let mut set = Vec::new();
    bytes(&mut set, 1, &file);
    set
}
