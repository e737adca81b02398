//! A recipe with a mistake gets one message with file and line; the repository's own have none.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::with_head;
use tenax_sim::replay::Recipe;

const MAP: &str = "[[map]]\ncolumn = 'a'\nchannels = ['pvdf_1']\ngain = 1.0\n";

#[test]
fn mistakes_are_named_by_file_and_line() {
    for (body, expected) in [
        ("".to_owned(), "r.toml:1: nothing is mapped"),
        ("lead_in = 1.0\n".to_owned(), "r.toml:3: unknown field `lead_in`, expected one of `title`"),
        ("lead_in_s = -1.0\n".to_owned() + MAP, "r.toml:3: lead_in_s is -1; 0 to 60 is allowed"),
        ("applies_to = ['[']\n".to_owned() + MAP, "r.toml:3: `[` is no pattern"),
        (
            MAP.replace("pvdf_1", "pvdf_13"),
            "r.toml:5: no channel is called `pvdf_13`; the channels are pvdf_1,",
        ),
        (format!("{MAP}\n{MAP}"), "r.toml:10: channel `pvdf_1` is given twice"),
        (MAP.replace("1.0", "nan"), "r.toml:6: gain must be a finite number"),
        (MAP.replace("gain = 1.0\n", ""), "r.toml:3: missing field `gain`"),
        (format!("{MAP}high_pass_hz = 9000.0\n"), "r.toml:7: high_pass_hz is 9000; 0.01 to 3000 is allowed"),
        (format!("{MAP}clip_v = [3.0, 1.0]\n"), "r.toml:7: clip_v is [lowest, highest] voltage"),
        (
            format!("{MAP}remove_offset = 'median'\n"),
            "r.toml:7: unknown variant `median`, expected one of `mean`",
        ),
        (
            format!("{MAP}[[hold.pins]]\nchannels = ['myo_flexor']\nvolts = 0.3\n"),
            "r.toml:7: missing field `why`",
        ),
        (
            format!("{MAP}[force]\nnormal = 'n'\nshear_x = 's'\nscale = 0.0\n"),
            "r.toml:10: scale must be a number other than 0",
        ),
        ("title = 'again'\n".to_owned(), "r.toml:3: duplicate key"),
    ] {
        let message = Recipe::parse(&with_head(&body), "r.toml").expect_err("it is wrong").to_string();
        assert!(message.starts_with(expected), "{body}\nsays      {message}\ninstead of {expected}");
    }
}

#[test]
fn every_recipe_in_the_folder_is_built_in_and_good() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("recipes");
    let files: BTreeSet<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(files, Recipe::BUILTIN.iter().map(|(name, _)| (*name).to_owned()).collect());
    for (name, text) in Recipe::BUILTIN {
        assert!(!Recipe::parse(text, name).unwrap().applies_to.is_empty(), "{name} is for no recording");
    }
}
