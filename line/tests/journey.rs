//! The journeys of docs/bring-up.md: every command as it stands there, on a served bench, and somebody who does at the bench what
//! the page and the prompts say.

use std::io::{BufRead, BufReader};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::Duration;
use std::{fs, io::Write, thread};

/// From the clone on, which the page does not name, and the change into its folder.
const COMMANDS_MAX: usize = 30;
const BEFORE: usize = 2;

/// The commands of each journey, in their order, each with what is done at the bench meanwhile.
fn journeys() -> Vec<Vec<(String, String)>> {
    let page = include_str!("../../../docs/bring-up.md");
    let (_, section) = page.split_once("\n## Without a board\n").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let mut journeys: Vec<Vec<(String, String)>> = Vec::new();
    for line in section.lines().filter_map(|line| line.strip_prefix("    cargo tenax ")) {
        let (command, keys) = line.split_once('#').unwrap_or((line, ""));
        if command.starts_with("run ") {
            journeys.push(Vec::new());
        }
        journeys.last_mut().unwrap().push((command.trim().to_owned(), keys.trim().to_owned()));
    }
    journeys
}

fn start(folder: &Path, command: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tenax-host"))
        .args(command.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// What a person does at the bench when they read this.
fn answer(prompt: &str) -> String {
    let words: Vec<&str> = prompt.split_whitespace().collect();
    match words[..] {
        [_, "of", _, "put", "on", newtons, ..] => format!("weight {newtons}"),
        _ if prompt.contains("shall close the hand") => "c".to_owned(),
        _ if prompt.contains("shall open the hand") => "o".to_owned(),
        // A reflex that closed on what was pressed before holds the finger.
        _ if prompt.contains("Nothing may touch") => "o".to_owned(),
        _ => prompt.to_owned(),
    }
}

/// Runs a command to its end; what it printed.
fn run(folder: &Path, (command, keys): &(String, String), bench: &mut ChildStdin) -> String {
    if keys == "Enter" {
        writeln!(bench, "button").unwrap();
        thread::sleep(Duration::from_millis(500));
    }
    let mut child = start(folder, command);
    for key in keys.split(", ").filter(|key| !["", "Enter"].contains(key)) {
        thread::sleep(Duration::from_secs(3));
        writeln!(bench, "{key}").unwrap();
    }
    let mut said = String::new();
    for line in BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap) {
        writeln!(bench, "{}", answer(&line)).unwrap();
        said += &(line + "\n");
    }
    let done = child.wait_with_output().unwrap();
    println!("$ tenax {command}\n{said}{}", String::from_utf8_lossy(&done.stderr));
    assert!(done.status.success(), "{command}");
    said
}

/// A journey from its first command to the files that it leaves.
fn journey(commands: &[(String, String)], leaves: &[&str]) -> String {
    assert!(commands.len() + BEFORE <= COMMANDS_MAX, "{} commands", commands.len());
    let folder = tempfile::tempdir().unwrap();
    let mut bench = start(folder.path(), &commands[0].0);
    let mut serving = BufReader::new(bench.stderr.take().unwrap()).lines();
    assert!(serving.next().unwrap().unwrap().starts_with("serving on "));
    // Nobody else reads what it says.
    thread::spawn(move || serving.for_each(drop));
    let mut keys = bench.stdin.take().unwrap();
    // Nobody is at the button as soon as the board is on.
    thread::sleep(Duration::from_secs(1));
    // Whatever becomes of them, the bench is ended.
    let said = catch_unwind(AssertUnwindSafe(|| {
        commands[1..].iter().map(|command| run(folder.path(), command, &mut keys)).collect()
    }));
    bench.kill().unwrap();
    bench.wait().unwrap();
    let said = said.unwrap_or_else(|why| resume_unwind(why));
    for file in leaves {
        assert!(fs::metadata(folder.path().join(file)).unwrap().len() > 500, "{file}");
    }
    said
}

#[test]
fn a_person_with_the_page_alone_gets_to_a_tuned_recorded_and_plotted_board() {
    let journeys = journeys();
    let [hand, gripper] = &journeys[..] else { panic!("{} journeys", journeys.len()) };
    thread::scope(|scope| {
        scope.spawn(|| {
            let said = journey(hand, &["hand.mcap", "hand.toml", "hand.svg", "hand.png"]);
            for word in ["7 of 7 channels pass", "Zeroed.", "Taken, and kept", "s1-mv"] {
                assert!(said.contains(word), "no `{word}`");
            }
        });
        scope.spawn(|| {
            let said = journey(gripper, &["gripper.mcap", "gripper.toml", "gripper.svg", "gripper.png"]);
            for word in ["4 of 4 channels pass", "no-wearer-flag = 1", "line-trusted-flag = 1"] {
                assert!(said.contains(word), "no `{word}`");
            }
        });
    });
}
