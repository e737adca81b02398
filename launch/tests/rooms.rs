//! The rooms of the workspace: which crate stands on which, and that no two folders of a crate lean on each other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Each member, and those that it may take from. Its head says what may live in it.
const STANDS_ON: [(&str, &[&str]); 17] = [
    ("hal-shim", &[]),
    ("logic", &["hal-shim"]),
    ("scene", &["hal-shim", "logic"]),
    ("vision", &[]),
    ("vision/quarter", &[]),
    ("firmware", &["hal-shim", "logic"]),
    ("launch", &[]),
    ("serial", &["hal-shim", "launch", "logic"]),
    ("plot", &[]),
    ("board-model", &["hal-shim"]),
    ("bench", &["board-model", "hal-shim", "launch", "logic", "plot", "scene", "serial"]),
    ("studies", &["bench", "hal-shim", "logic", "plot", "scene", "serial", "vision", "vision/quarter"]),
    ("host", &["bench", "hal-shim", "launch", "logic", "plot", "scene", "serial", "studies", "vision"]),
    ("host-tests", &["hal-shim", "logic", "scene"]),
    ("train", &["bench", "logic"]),
    ("ros2", &["hal-shim"]),
    ("bridge", &["hal-shim", "ros2", "serial"]),
];
/// Modules that are in a circle and are still to be opened.
const OPEN: [(&str, &[&str]); 1] = [(
    "logic",
    &[
        "array",
        "behaviours",
        "config",
        "detectors",
        "force",
        "hebbian",
        "photoelastic",
        "plausibility",
        "vibration",
    ],
)];

/// A module, from the crate's root.
type Module = Vec<String>;
/// Who takes from whom.
type Graph = BTreeMap<String, BTreeSet<String>>;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace")
}

#[test]
fn no_crate_takes_from_one_that_stands_on_it() {
    let workspace = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let members = workspace.split("members = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let members: BTreeSet<&str> = members.split('"').skip(1).step_by(2).collect();
    assert_eq!(members, STANDS_ON.iter().map(|(member, _)| *member).collect(), "members of the workspace");
    for (member, below) in STANDS_ON {
        let manifest = fs::read_to_string(root().join(member).join("Cargo.toml")).unwrap();
        for taken in manifest.lines().filter_map(|line| line.strip_prefix("tenax-")) {
            let taken = taken.split(['.', ' ']).next().unwrap_or(taken);
            assert!(
                below.iter().any(|below| below.replace('/', "-") == taken),
                "{member} takes from {taken}"
            );
        }
        for next in below {
            let place = |name: &str| STANDS_ON.iter().position(|(own, _)| *own == name);
            assert!(place(next) < place(member), "{member} is listed above {next}");
        }
    }
}

#[test]
fn no_two_folders_of_a_crate_lean_on_each_other() {
    for (member, _) in STANDS_ON {
        let mut found = BTreeSet::new();
        for (parent, graph) in graphs(&root().join(member).join("src")) {
            let (graph, folders) = graph;
            for circle in circles(&graph) {
                // Files of one folder may.
                if circle.iter().any(|name| folders.contains(name)) {
                    println!("{member}: {} {circle:?}", parent.join("::"));
                    found.extend(circle);
                }
            }
        }
        let open = OPEN.iter().find(|(own, _)| *own == member).map_or(&[][..], |(_, modules)| modules);
        assert_eq!(found, open.iter().map(|&name| name.to_owned()).collect(), "circles in {member}");
    }
}

/// Of every module that has modules: who of them takes from whom, and which are folders.
fn graphs(src: &Path) -> BTreeMap<Module, (Graph, BTreeSet<String>)> {
    let mut files = BTreeMap::new();
    read(src, &mut Vec::new(), &mut files);
    let mut graphs: BTreeMap<Module, (Graph, BTreeSet<String>)> = BTreeMap::new();
    for (module, text) in &files {
        for at in 1..module.len() {
            graphs.entry(module[..at - 1].to_vec()).or_default().1.insert(module[at - 1].clone());
        }
        for path in paths(text) {
            let mut full = if path[0] == "crate" { Vec::new() } else { module.clone() };
            for part in path {
                match part.as_str() {
                    "crate" | "self" => {}
                    "super" => _ = full.pop(),
                    _ => full.push(part),
                }
            }
            let taken = (0..=full.len()).rev().map(|n| &full[..n]).find(|own| files.contains_key(*own));
            let taken = taken.unwrap_or(&[]);
            let same = module.iter().zip(taken).take_while(|(own, other)| own == other).count();
            if let (Some(own), Some(other)) = (module.get(same), taken.get(same)) {
                let graph = &mut graphs.entry(module[..same].to_vec()).or_default().0;
                graph.entry(own.clone()).or_default().insert(other.clone());
            }
        }
    }
    graphs
}

/// The files of a folder as modules, without their tests and comments.
fn read(folder: &Path, within: &mut Module, files: &mut BTreeMap<Module, String>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            // A program's files are apart from the library's.
            if name != "bin" {
                within.push(name);
                read(&path, within, files);
                within.pop();
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(&text);
            let code: Vec<_> = code.lines().map(|line| line.split("//").next().unwrap_or(line)).collect();
            let mut module = within.clone();
            if !["lib", "main", "mod"].contains(&name.as_str()) {
                module.push(name);
            }
            files.entry(module).or_default().push_str(&code.join(" "));
        }
    }
    let tests: Vec<Module> = files
        .iter()
        .flat_map(|(module, text)| {
            let tests = text.split("#[cfg(test)] mod ").skip(1).filter_map(|rest| rest.split(';').next());
            tests.map(|test| [&module[..], &[test.trim().to_owned()]].concat()).collect::<Vec<_>>()
        })
        .collect();
    files.retain(|module, _| !tests.contains(module));
}

/// What a file names of its own crate, from `crate`, `super` or `self` on.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    let is_name = |sign: char| sign.is_alphanumeric() || sign == '_';
    for head in ["crate", "super", "self"] {
        for (at, _) in code.match_indices(&format!("{head}::")) {
            if !code[..at].ends_with(|sign| is_name(sign) || sign == ':' || sign == '$') {
                branches(&code[at..], &[], &mut all);
            }
        }
    }
    all
}

/// The paths of `a::{b, c::d}`, each after `before`; gives what comes behind them.
fn branches<'a>(mut code: &'a str, before: &[String], all: &mut Vec<Vec<String>>) -> &'a str {
    let mut path = before.to_vec();
    loop {
        code = code.trim_start();
        if let Some(mut inside) = code.strip_prefix('{') {
            loop {
                inside = branches(inside, &path, all).trim_start();
                match inside.strip_prefix(',') {
                    Some(next) => inside = next,
                    None => return inside.strip_prefix('}').unwrap_or(inside),
                }
            }
        }
        let end = code.find(|sign: char| !sign.is_alphanumeric() && sign != '_').unwrap_or(code.len());
        path.push(code[..end].to_owned());
        code = &code[end..];
        match code.strip_prefix("::") {
            Some(next) => code = next,
            None => break,
        }
    }
    all.push(path);
    // `as name`
    let end = code.find([',', '}', ';', '(', ')', '{', '<', '>']).unwrap_or(code.len());
    &code[end..]
}

/// Those that can be reached from one another.
fn circles(graph: &Graph) -> Vec<BTreeSet<String>> {
    let reached = |from: &String| {
        let (mut seen, mut left) = (BTreeSet::new(), vec![from]);
        while let Some(next) = left.pop() {
            let new = graph.get(next).into_iter().flatten();
            left.extend(new.filter(|name| seen.insert((*name).clone())));
        }
        seen
    };
    let all: BTreeMap<&String, BTreeSet<String>> = graph.keys().map(|name| (name, reached(name))).collect();
    let circle = |from: &&String| -> BTreeSet<String> {
        all[*from]
            .iter()
            .filter(|name| all.get(name).is_some_and(|back| back.contains(*from)))
            .cloned()
            .collect()
    };
    let found: BTreeSet<_> = all.keys().map(circle).filter(|circle| circle.len() > 1).collect();
    found.into_iter().collect()
}

#[test]
fn a_circle_is_found_and_a_tree_has_none() {
    let folder = std::env::temp_dir().join(format!("tenax-rooms-{}", std::process::id()));
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    write("lib.rs", "mod a; mod b;");
    write("a.rs", "mod deep; // use crate::b::B;\nuse super::b::{self, B as C};");
    write("a/deep.rs", "pub struct Deep;");
    write("b.rs", "pub struct B;\n#[cfg(test)]\nmod tests { use crate::a::A; }");
    let circles = || graphs(&folder).values().flat_map(|(graph, _)| circles(graph)).count();
    assert_eq!(circles(), 0);
    write("b.rs", "use crate::{a::{deep::Deep}};");
    assert_eq!(circles(), 1);
    fs::remove_dir_all(&folder).unwrap();
}
