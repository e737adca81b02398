//! `docs/wiring.md` is the channel map's, and its picture has the same pins.

use std::collections::BTreeSet;

#[test]
fn the_page_is_fresh() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/wiring.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        page == tenax_line::wiring::markdown(),
        "docs/wiring.md is stale: run   cargo run -p tenax-serial -- wiring > docs/wiring.md"
    );
}

/// Pins such as PA0 that a text names.
fn pins(text: &str) -> BTreeSet<String> {
    let is_pin = |word: &&str| {
        let port = word.strip_prefix('P').filter(|rest| rest.starts_with(['A', 'B', 'C']));
        port.is_some_and(|rest| rest[1..].parse::<u8>().is_ok_and(|number| number < 16))
    };
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(is_pin).map(str::to_owned).collect()
}

#[test]
fn the_picture_has_the_pages_pins() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/figures/wiring.svg");
    let picture = pins(&std::fs::read_to_string(path).unwrap());
    assert_eq!(picture, pins(&tenax_line::wiring::markdown()));
    assert!(picture.len() > 20);
}
