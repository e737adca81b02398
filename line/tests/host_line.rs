//! The bytes that the host's board writes up its line: numbered, whole, and what the report is made from.

use tenax_sim::board::line_log::LineLog;
use tenax_sim::board::{Run, Summary};
use tenax_sim::session::{Board, load_scene};
use tenax_hal_shim::wire::Up;
use tenax_scene::World;
use tenax_frames::link::{Counts, Inbox};

use crate::tool::tenax;

const SCENE: &str = "rig";

fn run() -> Run {
    let file = load_scene(SCENE).unwrap();
    Board::Host.run(World::new(&file, 1), &mut |_| {}).unwrap().0
}

fn messages(line: &[u8]) -> (Vec<Up>, Counts) {
    let mut inbox = Inbox::default();
    let messages = line
        .iter()
        .filter_map(|&byte| inbox.push(byte))
        .map(|heard| heard.unwrap().received.message)
        .collect();
    (messages, inbox.counts())
}

#[test]
fn the_line_says_what_the_report_is_made_from() {
    let run = run();
    let (mut summary, mut heard) = (Summary::default(), Run::default());
    LineLog::new(u32::MAX).hear(&run.line, &mut summary, &mut heard);
    assert_eq!((summary.bad_frames, summary.messages_missed), (0, 0));
    assert_eq!(summary.line_bytes, run.line_bytes);
    assert!(run.slows.len() > 400 && !run.events.is_empty());
    assert_eq!(heard.slows, run.slows);
    assert_eq!(summary.events, run.events);
    assert_eq!(summary.answers, run.answers);
    assert_eq!(summary.saved, run.saved);
    assert_eq!(summary.starts, [None]);
}

#[test]
fn hello_is_first_and_the_counters_come_ten_times_a_second() {
    let run = run();
    let (messages, counts) = messages(&run.line);
    assert_eq!(messages[0], Up::Hello { frame_hz: 2_000, after: None });
    assert_eq!(counts, Counts { messages: messages.len() as u64, bad_frames: 0, missed: 0 });
    let counted: Vec<_> = messages
        .iter()
        .filter_map(|message| match message {
            Up::Counters(counters) => Some((counters.frames, counters.ticks)),
            _ => None,
        })
        .collect();
    let due: Vec<_> = (1..=54).map(|n| (200 * n, 200 * n)).collect();
    assert_eq!(counted, due, "of 5.5 s; what would come at its end does not");
}

#[test]
fn the_file_holds_these_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    assert!(tenax(&["run", "--host", "--scene", SCENE, "--out", out]).0);
    assert!(std::fs::read(folder.path().join("rig.line.bin")).unwrap() == run().line);
}
