//! Software of unknown provenance (IEC 62304): each crate that Cargo builds into the image, with what is known of it. Versions, licences and
//! addresses are Cargo's; purpose and failure stand in `docs/safety/soup.toml`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};
use serde::Deserialize;

const HEAD: &str = "# Software of unknown provenance

Written by `cargo tenax safety --soup` from `Cargo.lock` and `soup.toml`; do not edit. For a reviewer who asks which foreign code is in the image.

- A crate is listed if Cargo builds it for the image, whether or not the linker keeps any of it. Macros and build scripts run on a PC alone.
- The compiler and its `core` are Rust's; `.ci/ferrocene` builds the image with the certified ones where they are installed, which was nowhere yet.
- `Cargo.lock` holds every version by its checksum; `deny.toml` says which licences and sources are allowed, `supply-chain/` what was vetted: so far
  nothing, every crate is exempt. Advisories were not searched by machine: an anomaly is here if somebody here knew it.

| crate | version | licence | purpose | if it fails | known anomalies |
|---|---|---|---|---|---|
";

/// What is known of a crate besides what Cargo knows.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    purpose: String,
    fails: String,
    anomalies: Option<String>,
}

/// A crate of the image: its name, version, licence and address.
type Linked = [String; 4];

/// Every foreign crate of the image in the workspace at `root`, by name.
fn linked(root: &Path) -> anyhow::Result<Vec<Linked>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let tree = "tree --locked --offline --package tenax-firmware --target thumbv7em-none-eabihf --edges normal,no-proc-macro \
                --prefix none --no-dedupe --format {p}|{l}|{r}";
    let told = Command::new(cargo).args(tree.split_whitespace()).current_dir(root).output()?;
    ensure!(told.status.success(), "cargo tree: {}", String::from_utf8_lossy(&told.stderr));
    let mut all = Vec::new();
    for line in String::from_utf8(told.stdout)?.lines() {
        let mut parts = line.split('|');
        let (package, licence, address) = (parts.next(), parts.next(), parts.next());
        let mut words = package.unwrap_or_default().split(' ');
        let (name, version) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        if !name.starts_with("tenax-") {
            let licence = licence.unwrap_or_default().replace(" / ", "/").replace('/', " OR ");
            let version = version.trim_start_matches('v');
            all.push([name, version, &licence, address.unwrap_or_default()].map(str::to_owned));
        }
    }
    all.sort();
    all.dedup();
    Ok(all)
}

/// The page `docs/safety/soup.md`. Fails if a crate is linked without a row, or a row's crate is not linked.
///
/// # Errors
/// Says which, or that Cargo cannot be asked.
pub fn page(root: &Path) -> anyhow::Result<String> {
    let path = root.join("docs/safety/soup.toml");
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    written(&linked(root)?, toml::from_str(&text)?)
}

fn written(linked: &[Linked], mut rows: BTreeMap<String, Row>) -> anyhow::Result<String> {
    let mut page = HEAD.to_owned();
    for [name, version, licence, address] in linked {
        let row = rows
            .get(name)
            .with_context(|| format!("{name} {version} is linked, and soup.toml has no table of it"))?;
        let Row { purpose, fails, anomalies } = row;
        let anomalies = anomalies.as_deref().unwrap_or("none");
        writeln!(
            page,
            "| [{name}]({address}) | {version} | {licence} | {purpose} | {fails} | {anomalies} |"
        )?;
    }
    rows.retain(|row, _| linked.iter().all(|[name, ..]| name != row));
    ensure!(rows.is_empty(), "soup.toml has tables of what is not linked: {:?}", rows.keys());
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_without_a_row_and_a_row_without_a_crate_are_errors() {
        let crates = [["a", "1.0.0", "MIT", "https://a.b"].map(str::to_owned)];
        let rows = |text: &str| toml::from_str(text).unwrap();
        let row = "[a]\npurpose = 'sums'\nfails = 'a wrong sum'\n";
        let page = written(&crates, rows(row)).unwrap();
        assert!(page.ends_with("| [a](https://a.b) | 1.0.0 | MIT | sums | a wrong sum | none |\n"), "{page}");
        let error = |text: &str| written(&crates, rows(text)).unwrap_err().to_string();
        assert!(error("").contains("a 1.0.0 is linked"), "{}", error(""));
        assert!(error(&format!("{row}[b]\npurpose = ''\nfails = ''")).contains("\"b\""));
    }

    #[test]
    fn every_crate_of_the_image_has_a_licence_that_is_allowed_and_a_version_that_is_vetted_or_exempt() {
        #[derive(Deserialize)]
        struct Deny {
            licenses: Licenses,
        }
        #[derive(Deserialize)]
        struct Licenses {
            allow: Vec<String>,
        }
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        let allowed = toml::from_str::<Deny>(&read("deny.toml")).unwrap().licenses.allow;
        let vetted = ["config", "audits"].map(|name| read(&format!("supply-chain/{name}.toml"))).concat();
        for [name, version, licence, _] in linked(root).unwrap() {
            let is_allowed = licence.split(" OR ").any(|one| allowed.iter().any(|own| own == one));
            assert!(is_allowed, "{name} {version}: {licence}");
            let entry = |kind: &str| format!("[[{kind}.{name}]]\nversion = \"{version}\"");
            assert!(
                ["exemptions", "audits"].iter().any(|kind| vetted.contains(&entry(kind))),
                "{name} {version}"
            );
        }
    }

    #[test]
    fn the_page_is_the_image_of_now() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let now = page(root).unwrap();
        let kept = std::fs::read_to_string(root.join("docs/safety/soup.md")).unwrap();
        assert!(now == kept, "print it again: cargo tenax safety --soup > docs/safety/soup.md");
    }
}
