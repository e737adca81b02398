//! `docs/settings.md` is the settings table's.

#[test]
fn the_page_is_fresh() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/settings.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        page == tenax_frames::settings::markdown(),
        "docs/settings.md is stale: run   cargo run -p tenax-serial -- settings > docs/settings.md"
    );
}
