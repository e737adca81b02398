//! As much of protobuf as a recording needs: messages of plain fields, and the descriptor that says which they are, both
//! made from one list, so that they cannot differ. Foxglove, PlotJuggler and the public decoders read the descriptor.

/// What a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number. NaN: there was none.
    Number,
    Numbers,
    /// Yes or no.
    Flag,
    /// Words.
    Text,
    Bytes,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    Flag(bool),
    Text(String),
    Bytes(Vec<u8>),
}

/// The package that the messages belong to.
pub const PACKAGE: &str = "tenax";

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

/// A message with these values in the order of its fields.
pub fn message(values: &[Value]) -> Vec<u8> {
    let mut out = Vec::new();
    for (number, value) in (1..).zip(values) {
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

/// The first field of a message, which is of bytes.
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
pub fn descriptor(name: &str, fields: &[(String, Kind)]) -> Vec<u8> {
    let mut message = Vec::new();
    bytes(&mut message, 1, name.as_bytes());
    for (number, (name, kind)) in (1..).zip(fields) {
        let (label, code) = match kind {
            Kind::Number => (1, 1),
            Kind::Numbers => (3, 1),
            Kind::Flag => (1, 8),
            Kind::Text => (1, 9),
            Kind::Bytes => (1, 12),
        };
        let mut field = Vec::new();
        bytes(&mut field, 1, name.as_bytes());
        for (place, value) in [(3, number), (4, label), (5, code)] {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_the_documentation() {
        // protobuf.dev, encoding: field 2 with the words `testing`.
        let values = [Value::Flag(true), Value::Text("testing".to_owned()), Value::Number(1.0)];
        let expected = [
            &[0x08, 0x01][..],
            &[0x12, 0x07, 0x74, 0x65, 0x73, 0x74, 0x69, 0x6e, 0x67],
            &[0x19, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f],
        ];
        assert_eq!(message(&values), expected.concat());
    }

    #[test]
    fn the_first_bytes_come_back_and_what_is_cut_short_is_none() {
        let data = vec![7; 300];
        let whole = message(&[Value::Bytes(data.clone())]);
        assert_eq!(first_bytes(&whole), Some(&data[..]));
        assert_eq!(first_bytes(&whole[..200]), None);
        assert_eq!(first_bytes(&[0x0a, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1]), None);
    }
}
