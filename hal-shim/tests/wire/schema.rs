//! Types of the messages by name, and a message of each kind.

use postcard_schema::schema::{
    DataModelType as Ty, DataModelVariant as Variant, NamedType, NamedValue, NamedVariant,
};

/// Every type that has fields or variants, in the order in which messages need them.
#[derive(Default)]
pub struct Types(Vec<&'static NamedType>);

/// A field's type as JSON.
fn reference(of: &NamedType) -> String {
    match of.ty {
        _ if is_packed(of) => format!("\"{}\"", of.name),
        Ty::Option(inner) => format!("[\"opt\", {}]", reference(inner)),
        Ty::Seq(inner) => format!("[\"vec\", {}]", reference(inner)),
        Ty::Tuple(all) if all.iter().all(|one| one == &all[0]) => {
            format!("[\"arr\", {}, {}]", all.len(), reference(all[0]))
        }
        Ty::Tuple(all) => {
            let all: Vec<String> = all.iter().map(|one| reference(one)).collect();
            format!("[\"tuple\", [{}]]", all.join(", "))
        }
        Ty::NewtypeStruct(inner) => reference(inner),
        Ty::Struct(_) | Ty::Enum(_) => format!("\"{}\"", of.name),
        plain => format!("\"{plain:?}\"").to_lowercase(),
    }
}

/// A field's name in Python; a field that has none is called after its type.
fn field_name(name: Option<&str>, of: &NamedType) -> String {
    let inner = |of: &NamedType| match of.ty {
        Ty::Option(inner) => inner.name.to_owned(),
        Ty::Struct(_) | Ty::Enum(_) | Ty::NewtypeStruct(_) => of.name.to_owned(),
        _ => "value".to_owned(),
    };
    let name = name.map_or_else(|| inner(of), str::to_owned);
    let mut snake = String::new();
    for (n, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && n > 0 {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
    }
    // Words of Python, and the name of the message itself.
    if matches!(snake.as_str(), "from" | "kind") { snake + "_" } else { snake }
}

fn field(name: Option<&str>, of: &NamedType) -> String {
    format!("[\"{}\", {}]", field_name(name, of), reference(of))
}

fn fields(values: &[&NamedValue]) -> String {
    let all: Vec<String> = values.iter().map(|value| field(Some(value.name), value.ty)).collect();
    format!("[{}]", all.join(", "))
}

/// A variant's fields. Those of a message that is a type of its own are that type's.
fn fields_of(variant: &NamedVariant) -> String {
    match variant.ty {
        Variant::NewtypeVariant(NamedType { ty: Ty::Struct(values), .. })
        | Variant::StructVariant(values) => fields(values),
        _ => {
            let all: Vec<String> = types_of(variant).into_iter().map(|of| field(None, of)).collect();
            format!("[{}]", all.join(", "))
        }
    }
}

fn types_of(variant: &NamedVariant) -> Vec<&'static NamedType> {
    match variant.ty {
        Variant::UnitVariant => Vec::new(),
        Variant::NewtypeVariant(inner) => vec![inner],
        Variant::TupleVariant(all) => all.to_vec(),
        Variant::StructVariant(values) => values.iter().map(|value| value.ty).collect(),
    }
}

/// Types with places of their own for their fields.
fn is_packed(of: &NamedType) -> bool {
    matches!(of.name, "tick" | "frame")
}

impl Types {
    /// Adds a type, after those that it is made of.
    pub fn add(&mut self, of: &'static NamedType) {
        if is_packed(of) || self.0.iter().any(|known| known.name == of.name) {
            return;
        }
        match of.ty {
            Ty::Option(inner) | Ty::Seq(inner) | Ty::NewtypeStruct(inner) => self.add(inner),
            Ty::Tuple(all) => all.iter().for_each(|one| self.add(one)),
            Ty::Struct(values) => {
                values.iter().for_each(|value| self.add(value.ty));
                self.0.push(of);
            }
            Ty::Enum(variants) => {
                variants.iter().flat_map(|variant| types_of(variant)).for_each(|inner| self.add(inner));
                self.0.push(of);
            }
            _ => {}
        }
    }

    /// A line a type.
    pub fn json(&self) -> Vec<String> {
        let line = |of: &&NamedType| match of.ty {
            Ty::Struct(values) => format!("\"{}\": {{\"struct\": {}}}", of.name, fields(values)),
            Ty::Enum(variants) => {
                let all: Vec<String> =
                    variants.iter().map(|v| format!("[\"{}\", {}]", v.name, fields_of(v))).collect();
                format!("\"{}\": {{\"enum\": [{}]}}", of.name, all.join(", "))
            }
            _ => String::new(),
        };
        self.0.iter().map(line).collect()
    }
}

/// The bytes of messages: one of each variant, and of each variant that a field of it may have. With each the variant's number.
pub fn messages(of: &NamedType) -> Vec<(usize, Vec<u8>)> {
    let Ty::Enum(variants) = of.ty else { return Vec::new() };
    let (mut count, mut all) = (0, Vec::new());
    for (number, variant) in variants.iter().enumerate() {
        all.extend(of_variant(number, variant, &mut count).into_iter().map(|bytes| (number, bytes)));
    }
    all
}

fn varint(value: u64) -> Vec<u8> {
    postcard::to_allocvec(&value).expect("a number")
}

fn of_variant(number: usize, variant: &NamedVariant, count: &mut u64) -> Vec<Vec<u8>> {
    each(varint(number as u64), &types_of(variant), count)
}

/// All parts as they are first, and each other that one of them may be.
fn each(begin: Vec<u8>, types: &[&NamedType], count: &mut u64) -> Vec<Vec<u8>> {
    let parts: Vec<Vec<Vec<u8>>> = types.iter().map(|of| values(of, count)).collect();
    let with = |place: usize, which: usize| {
        let mut bytes = begin.clone();
        for (n, part) in parts.iter().enumerate() {
            bytes.extend(&part[if n == place { which } else { 0 }]);
        }
        bytes
    };
    let others = parts.iter().enumerate().flat_map(|(place, part)| (1..part.len()).map(move |n| (place, n)));
    std::iter::once(with(usize::MAX, 0)).chain(others.map(|(place, n)| with(place, n))).collect()
}

/// Bytes of a type: numbers of the longest form that differ from each other, of a plain list of names the last, and of variants
/// with fields one of each.
fn values(of: &NamedType, count: &mut u64) -> Vec<Vec<u8>> {
    *count += 1;
    let n = *count % 500;
    let one = match of.ty {
        _ if of.name == "tick" => vec![0xF4, 0x41, 0x80, 0x40, 0xE8, 0x37],
        _ if of.name == "frame" => (1..=25).map(|byte| byte * 5).collect(),
        Ty::Bool => vec![1],
        Ty::U8 => vec![0x81 | n as u8 & 0x3F],
        Ty::I8 => vec![0xC0 | n as u8 & 0x3F],
        Ty::U16 => varint(300 + n),
        Ty::U32 => varint(70_000 + n),
        Ty::U64 => varint((1 << 40) + n),
        // Zigzag of a number below 0 is odd.
        Ty::I16 => varint(2 * (300 + n) + 1),
        Ty::I32 => varint(2 * (70_000 + n) + 1),
        Ty::Option(inner) => return each(vec![1], &[inner], count),
        Ty::NewtypeStruct(inner) => return values(inner, count),
        Ty::Seq(inner) => return each(vec![2], &[inner, inner], count),
        Ty::Tuple(all) => return each(Vec::new(), all, count),
        Ty::Struct(fields) => {
            let types: Vec<&NamedType> = fields.iter().map(|field| field.ty).collect();
            return each(Vec::new(), &types, count);
        }
        Ty::Enum(variants) if variants.iter().all(|v| matches!(v.ty, Variant::UnitVariant)) => {
            varint(variants.len() as u64 - 1)
        }
        Ty::Enum(variants) => {
            let all = variants.iter().enumerate();
            return all.flat_map(|(number, variant)| of_variant(number, variant, count)).collect();
        }
        other => panic!("no message has {other:?}"),
    };
    vec![one]
}
