//! A type's hash, RIHS01 (REP-2016): SHA-256 of the type's description as JSON, the types that it is made of included. The
//! description is read from the .msg text, so that the text that is shipped and the hash cannot differ.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use sha2::{Digest, Sha256};

/// A type's name, `sensor_msgs/msg/JointState`, and its .msg text.
pub type Definition<'a> = (&'a str, &'a str);

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
    let text = match known.iter().find(|(own, _)| *own == name) {
        Some((_, text)) => (*text).to_owned(),
        None => derived(name)?,
    };
    // Its place, for a type that would hold itself.
    described.insert(name.to_owned(), String::new());
    let mut fields = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or("").trim();
        // A constant is no field; `<=` is a bound.
        if line.is_empty() || line.replace("<=", "").contains('=') {
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

/// The text of a type that rosidl derives from a service or an action.
fn derived(name: &str) -> Option<String> {
    let own = name.rsplit_once('/')?.1;
    let id = "unique_identifier_msgs/UUID goal_id";
    Some(if let Some(action) = own.strip_suffix("_SendGoal_Request") {
        format!("{id}\n{action}_Goal goal")
    } else if own.ends_with("_SendGoal_Response") {
        "bool accepted\nbuiltin_interfaces/Time stamp".to_owned()
    } else if own.ends_with("_GetResult_Request") {
        id.to_owned()
    } else if let Some(action) = own.strip_suffix("_GetResult_Response") {
        format!("int8 status\n{action}_Result result")
    } else if let Some(action) = own.strip_suffix("_FeedbackMessage") {
        format!("{id}\n{action}_Feedback feedback")
    } else if let Some(service) = own.strip_suffix("_Event") {
        let info = "service_msgs/ServiceEventInfo info";
        format!("{info}\n{service}_Request[<=1] request\n{service}_Response[<=1] response")
    } else if ["_SendGoal", "_GetResult", "CancelGoal"].iter().any(|end| own.ends_with(end)) {
        format!("{own}_Request request_message\n{own}_Response response_message\n{own}_Event event_message")
    } else {
        return None;
    })
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
