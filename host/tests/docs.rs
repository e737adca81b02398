//! What the pages say can be found: files that they link to, commands and tests that they name.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every page with its folder and text.
fn pages() -> Vec<(PathBuf, String)> {
    let in_docs = fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let of_root = ["README.md", "CHANGELOG.md"].map(|name| root().join(name));
    let pages = in_docs.chain(of_root).filter(|path| path.extension().is_some_and(|end| end == "md"));
    pages.map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// What stands behind each `before` in a text, up to the first character that is none of a name.
fn names<'a>(text: &'a str, before: &str) -> Vec<&'a str> {
    let of_name = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let behind = text.split(before).skip(1);
    behind.map(|rest| rest.split(|c| !of_name(c)).next().unwrap_or_default()).collect()
}

#[test]
fn every_file_that_a_page_links_to_is_there() {
    for (page, text) in pages() {
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if !file.is_empty() && !link.starts_with("http") {
                assert!(page.parent().unwrap().join(file).exists(), "{}: {link}", page.display());
            }
        }
    }
}

#[test]
fn every_command_that_a_page_names_is_one() {
    let help = Command::new(env!("CARGO_BIN_EXE_tenax-host")).arg("--help").output().unwrap().stdout;
    let help = String::from_utf8(help).unwrap();
    let commands = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    let commands: BTreeSet<&str> =
        commands.lines().filter_map(|line| line.split_whitespace().next()).collect();
    for (page, text) in pages() {
        for name in names(&text, "cargo tenax ").into_iter().filter(|name| !name.is_empty()) {
            assert!(commands.contains(name), "{}: cargo tenax {name}", page.display());
        }
    }
}

#[test]
fn every_test_that_a_page_names_is_one() {
    let packages = [
        "hal-shim",
        "logic",
        "scene",
        "serial",
        "bench",
        "studies",
        "host",
        "host-tests",
        "launch",
        "train",
        "vision",
    ];
    for (page, text) in pages() {
        let lines = text.lines().filter(|line| line.contains("cargo test"));
        for name in lines.flat_map(|line| names(line, "--test ")) {
            let is_there = packages.iter().any(|package| {
                let tests = root().join(package).join("tests");
                tests.join(format!("{name}.rs")).exists() || tests.join(name).join("main.rs").exists()
            });
            assert!(is_there, "{}: --test {name}", page.display());
        }
    }
}

#[test]
fn the_commands_page_is_the_tools() {
    let printed = Command::new(env!("CARGO_BIN_EXE_tenax-host")).arg("commands").output().unwrap().stdout;
    let page = fs::read_to_string(root().join("docs/commands.md")).unwrap();
    assert!(
        String::from_utf8(printed).unwrap() == page,
        "docs/commands.md is stale: run   cargo tenax commands > docs/commands.md"
    );
}
