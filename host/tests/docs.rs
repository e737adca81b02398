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
    let packages = "hal-shim logic scene serial bench studies host host-tests launch train vision";
    for (page, text) in pages() {
        let lines = text.lines().filter(|line| line.contains("cargo test"));
        for name in lines.flat_map(|line| names(line, "--test ")) {
            let is_there = packages.split(' ').any(|package| {
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

#[test]
fn every_figure_of_a_page_is_answered_for() {
    let wrong = tenax::check::pages::unanswered(&root()).unwrap();
    assert!(wrong.is_empty(), "docs/figures.toml has to say where they come from: {wrong:#?}");
}

/// Pages of `docs/` and the README, all words together: the bar of plain pages.
const WORDS_MAX: usize = 20_000;
const SENTENCE_MAX: usize = 25;

fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

/// Paragraphs and entries of lists, without code, tables, headings and pictures; of a link its text alone.
fn prose(page: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    let mut is_code = false;
    for line in page.lines() {
        is_code ^= line.starts_with("```");
        let is_prose = !is_code && !["```", "    ", "|", "#", "!["].iter().any(|mark| line.starts_with(mark));
        if line.is_empty() || !is_prose || line.starts_with("- ") {
            paragraphs.push(String::new());
        }
        if let (true, Some(paragraph)) = (is_prose && !line.is_empty(), paragraphs.last_mut()) {
            *paragraph += line.trim_start_matches("- ");
            paragraph.push(' ');
        }
    }
    let without_addresses = |text: &str| {
        let parts = text.split("](").enumerate();
        parts
            .map(|(n, part)| if n == 0 { part } else { part.split_once(')').map_or("", |rest| rest.1) })
            .collect()
    };
    paragraphs.iter().filter(|text| !text.trim().is_empty()).map(|text| without_addresses(text)).collect()
}

/// The sentences of a paragraph that have more words than a reader takes in at once.
fn long_sentences(paragraph: &str) -> Vec<String> {
    let plain = paragraph.replace(['*', '['], "");
    let ended = ["? ", "! "].iter().fold(plain, |text, end| text.replace(end, ". "));
    ended.split(". ").filter(|sentence| words(sentence) > SENTENCE_MAX).map(str::to_owned).collect()
}

#[test]
fn every_sentence_of_the_readme_is_short() {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let long: Vec<String> = prose(&page).iter().flat_map(|paragraph| long_sentences(paragraph)).collect();
    assert!(long.is_empty(), "more than {SENTENCE_MAX} words: {long:#?}");
}

/// A stranger knows after the first paragraph what a page is for and whether it is for him.
#[test]
fn every_page_opens_with_its_purpose_in_short_sentences() {
    for (path, text) in pages() {
        let name = path.file_name().unwrap().to_str().unwrap();
        if ["README.md", "CHANGELOG.md"].contains(&name) {
            continue;
        }
        let opening = prose(&text).into_iter().next().unwrap_or_default();
        let long = long_sentences(&opening);
        assert!(long.is_empty(), "{name}: more than {SENTENCE_MAX} words: {long:#?}");
        let has_purpose = ["This page", "Short names", "One entry", "Printed", "Written"];
        assert!(has_purpose.iter().any(|begin| opening.starts_with(begin)), "{name}: opens with `{opening}`");
    }
}

#[test]
fn all_pages_together_are_short() {
    let counts: Vec<(String, usize)> = pages()
        .into_iter()
        .map(|(path, text)| (path.file_name().unwrap().to_str().unwrap().to_owned(), words(&text)))
        .filter(|(name, _)| name != "CHANGELOG.md")
        .collect();
    let sum: usize = counts.iter().map(|count| count.1).sum();
    println!("{counts:#?}\n{sum} words");
    assert!(sum <= WORDS_MAX, "{sum} words, more than {WORDS_MAX}: {counts:?}");
}

#[test]
fn a_long_sentence_is_found_where_it_is_prose_and_nowhere_else() {
    let long = "word ".repeat(SENTENCE_MAX + 1);
    let page = format!(
        "# Title\n\n- {long}\n- [short](https://x.y)\n\n    {long}\n| {long} |\n```\n{long}\n```\nEnd. {long}"
    );
    let found = prose(&page).iter().flat_map(|paragraph| long_sentences(paragraph)).count();
    assert_eq!(found, 2, "{:?}", prose(&page));
    assert_eq!(words("a | -- `b_1` 0.5,"), 3);
}
