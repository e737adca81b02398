//! The seconds before a fault outlive the reset, and are there at the next start.

use tenax_frames::link::Inbox;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, Last, PIECE_MAX, Received, Up};
use tenax_hal_shim::words::Fault;
use tenax_sim::board::Run;
use tenax_sim::board::emulated::{Mishap, Options};

use crate::{Swing, drives, run};

fn asking(mut swing: Swing, from_s: f64, pieces: u16) -> Swing {
    for piece in 0..pieces {
        swing = swing.sending(from_s + 0.013 * f64::from(piece), Down::Last(piece * PIECE_MAX as u16));
    }
    swing
}

fn pieces(run: &Run) -> Vec<Last> {
    let last = |(_, answer): &(u16, Answer)| match answer {
        Answer::Last(last) => Some(last.clone()),
        _ => None,
    };
    run.answers.iter().filter_map(last).collect()
}

fn kept(line: &[u8]) -> Vec<Received<Up>> {
    let mut inbox = Inbox::default();
    let heard = line.iter().filter_map(|&byte| inbox.push(byte)).flatten().map(|heard| heard.received);
    heard.filter(|received| !matches!(received.message, Up::Raw(_) | Up::Answer { .. })).collect()
}

fn lasted_s(run: &Run, start: usize, bytes: &[u8]) -> f64 {
    let (line, own) = (kept(&run.line), kept(bytes));
    let starts: Vec<usize> =
        (0..line.len()).filter(|&at| matches!(line[at].message, Up::Hello { .. })).collect();
    let said = &line[..starts[start]];
    // What was on its way when the core stopped is in the box and never came.
    let came = (own.len() - 3..=own.len()).rev().find(|&end| said.ends_with(&own[..end]));
    assert!(came.is_some(), "{:?}\n{:?}", own.last(), said.last());
    let frame = |received: &Received<Up>| match &received.message {
        Up::Slow(slow) => Some(slow.frame),
        _ => None,
    };
    let (first, last) = (own.iter().find_map(frame), own.iter().rev().find_map(frame));
    f64::from(last.expect("slow frames") - first.expect("slow frames")) / 2_000.0
}

#[test]
fn the_seconds_before_a_hang_and_before_a_panic_are_there_at_the_next_start() {
    let swing =
        asking(Swing::new(9.9), 4.2, 192).sending(6.8, Down::Last(u16::MAX)).sending(6.9, Down::Last(0));
    let plant = asking(swing, 8.4, 100).at_rest();
    let mishaps = vec![(3.7, Mishap::CoreHangs), (8.0, Mishap::DmaFails)];
    let run = run(plant, &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None, Some(Fault::WatchdogReset), Some(Fault::PanicReset)]);
    let pieces = pieces(&run);
    assert_eq!(pieces.len(), 192 + 2 + 100);

    // The box is full: what is older was written over.
    let (hung, rest) = pieces.split_at(192);
    assert!(hung.iter().all(|piece| (piece.after, piece.length) == (Some(Fault::WatchdogReset), 48 * 1024)));
    assert!(hung.iter().all(|piece| piece.why.is_empty()), "who hangs says nothing");
    let bytes: Vec<u8> = hung.iter().flat_map(|piece| piece.bytes.iter().copied()).collect();
    assert_eq!(bytes.len(), 48 * 1024);
    let seconds = lasted_s(&run, 1, &bytes);
    println!("a full box lasts {seconds} s");
    assert!(seconds > 2.5, "{seconds}");

    // Let go, it is empty; and the next fault finds what was said since.
    let (empty, panicked) = rest.split_at(2);
    assert!(empty.iter().all(|piece| piece.after.is_none() && piece.bytes.is_empty()));
    let length = usize::from(panicked[0].length);
    let whole = length.div_ceil(PIECE_MAX);
    let bytes: Vec<u8> = panicked[..whole].iter().flat_map(|piece| piece.bytes.iter().copied()).collect();
    assert!(panicked[..whole].iter().all(|piece| piece.after == Some(Fault::PanicReset)));
    assert_eq!(bytes.len(), length);
    assert!(panicked[..whole].iter().all(|piece| piece.why == b"DMA could not reach its ring"[..]));
    let seconds = lasted_s(&run, 2, &bytes);
    assert!((1.0..1.3).contains(&seconds), "{seconds} s since it was let go");
    assert!(panicked[whole..].iter().all(|piece| piece.after.is_none()), "who asks from its end on has it");
    // With the box nothing is late.
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost), (0, 0), "{:?}", run.counters);
}

#[test]
fn a_fault_of_the_core_says_where_it_was_and_what_the_core_says_of_it() {
    let options = Options { mishaps: vec![(0.3, Mishap::CoreStrays)], ..Options::default() };
    let run = run(asking(Swing::new(1.0), 0.8, 1).at_rest(), &options);
    assert_eq!(run.starts, [None, Some(Fault::PanicReset)]);
    let why = String::from_utf8(pieces(&run)[0].why.to_vec()).expect("text");
    // PC, LR, CFSR with IBUSERR, HFSR with FORCED (ARM DDI 0403E, section B3.2).
    let words: Vec<&str> = why.split(' ').collect();
    assert_eq!(
        (words.len(), words[0], words[1], words[3], words[4]),
        (6, "HF", "60000000", "00000100", "40000000"),
        "{why}"
    );
}

// Shows B3.
#[test]
fn a_stream_that_does_not_stop_is_a_panic_that_says_so() {
    let mishaps = vec![(0.3, Mishap::DmaStalls), (0.3, Mishap::DmaSticks)];
    let run = run(asking(Swing::new(0.8), 0.6, 1).at_rest(), &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None, Some(Fault::PanicReset)]);
    assert_eq!(pieces(&run)[0].why, b"DMA does not stop"[..]);
}

// Shows B2.
#[test]
fn a_brown_out_is_told_and_keeps_what_was_said() {
    let drive = MotorDrive::Close(Duty::per_mille(400));
    let swing = asking(Swing::new(2.0).sending(0.5, Down::Drive { drive, hold_ms: 250 }), 1.2, 1);
    let options = Options { mishaps: vec![(0.6, Mishap::BrownsOut)], ..Options::default() };
    let run_of = run(swing.at_rest(), &options);
    assert_eq!(run_of.starts, [None, Some(Fault::SupplySagged)]);
    assert!(drives(&run_of, 0.55, 0.6).iter().all(|now| *now == drive), "it was driven before");
    assert!(drives(&run_of, 0.601, 2.0).iter().all(|now| *now == MotorDrive::Coast));
    let piece = &pieces(&run_of)[0];
    assert_eq!((piece.after, &piece.why[..]), (Some(Fault::SupplySagged), &b"brown-out"[..]));
    assert!(piece.length > 4_000, "{} bytes of 0.6 s", piece.length);
}
