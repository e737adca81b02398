//! `docs/wiring.md` is the channel map's.

#[test]
fn the_page_is_fresh() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/wiring.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        page == tenax_serial::wiring::markdown(),
        "docs/wiring.md is stale: run   cargo run -p tenax-serial -- wiring > docs/wiring.md"
    );
}
