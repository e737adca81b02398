//! A type's hash, RIHS01 (REP-2016): SHA-256 of the type's description as JSON, the types that it is made of included. The
//! description is read from the .msg text, so that the text that is shipped and the hash cannot differ.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use sha2::{Digest, Sha256};

/// A type whose .msg text is known: `sensor_msgs/msg/JointState`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Definition {
    pub name: &'static str,
    pub text: &'static str,
}

/// The hash of a type, given it and all that it is made of. None where a type is missing or a line is no field.
pub fn hash(name: &str, known: &[Definition]) -> Option<String> {
    let mut described = BTreeMap::new();
    describe(name, known, &mut described)?;
    let own = described.remove(name)?;
    let others: Vec<String> = described.into_values().collect();
    let json =
        format!("{{\"type_description\": {own}, \"referenced_type_descriptions\": [{}]}}", others.join(", "));
    let mut hash = "RIHS01_".to_owned();
    for byte in Sha256::digest(json.as_bytes()) {
        // Writing to a string cannot fail.
        let _written = write!(hash, "{byte:02x}");
    }
    Some(hash)
}

fn describe(name: &str, known: &[Definition], described: &mut BTreeMap<String, String>) -> Option<()> {
    if described.contains_key(name) {
        return Some(());
    }
    let text = known.iter().find(|definition| definition.name == name)?.text;
    // Its place, for a type that would hold itself.
    described.insert(name.to_owned(), String::new());
    let mut fields = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or("").trim();
        // A constant is no field.
        if line.is_empty() || line.contains('=') {
            continue;
        }
        let (kind, field) = line.split_once(char::is_whitespace)?;
        let (element, dimension) = match kind.split_once('[') {
            Some((element, dimension)) => (element, Some(dimension.strip_suffix(']')?)),
            None => (kind, None),
        };
        let (offset, capacity) = match dimension {
            None => (0, 0),
            Some("") => (144, 0),
            Some(count) => match count.strip_prefix("<=") {
                Some(most) => (96, most.parse().ok()?),
                None => (48, count.parse::<u64>().ok()?),
            },
        };
        let (id, nested) = match plain(element) {
            Some(id) => (id, String::new()),
            None => {
                let nested = match element.split_once('/') {
                    Some((package, kind)) => format!("{package}/msg/{kind}"),
                    None => format!("{}/{element}", name.rsplit_once('/')?.0),
                };
                describe(&nested, known, described)?;
                (1, nested)
            }
        };
        fields.push(format!(
            "{{\"name\": \"{}\", \"type\": {{\"type_id\": {}, \"capacity\": {capacity}, \"string_capacity\": 0, \
             \"nested_type_name\": \"{nested}\"}}}}",
            field.trim(),
            id + offset
        ));
    }
    let described_as = format!("{{\"type_name\": \"{name}\", \"fields\": [{}]}}", fields.join(", "));
    described.insert(name.to_owned(), described_as);
    Some(())
}

/// The number of a type that is made of no others (`type_description_interfaces/msg/FieldType`).
fn plain(name: &str) -> Option<u16> {
    Some(match name {
        "int8" => 2,
        "uint8" => 3,
        "int16" => 4,
        "uint16" => 5,
        "int32" => 6,
        "uint32" => 7,
        "int64" => 8,
        "uint64" => 9,
        "float32" => 10,
        "float64" => 11,
        "bool" => 15,
        "byte" => 16,
        "string" => 17,
        _ => return None,
    })
}
