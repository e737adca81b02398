//! The monitor's screen as a person sees it, at two sizes, of a scene's line.

use std::time::Instant;

use tenax_bench::board::Run;
use tenax_bench::session::{Board, load_scene};
use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR, PVDF_COUNT, mv_from_sample, sample_from_mv};
use tenax_hal_shim::wire::{Answer, BadFrame, Down, Refusal, Senses, VERSION};
use tenax_logic::setting::SettingId;
use tenax_scene::World;
use tenax_serial::link::Inbox;
use tenax_serial::monitor::screen::{Edit, Shown};
use tenax_serial::monitor::source::News;
use tenax_serial::monitor::view::View;
use tenax_serial::truth::Truth;

use crate::tool::picture;

/// A view that has heard a scene's line.
fn heard(scene: &str, seconds: f64) -> View {
    let (run, _): (Run, _) =
        Board::Host.run(World::new(&load_scene(scene).unwrap(), 1), &mut |_| {}).unwrap();
    let (mut view, mut inbox) = (View::default(), Inbox::default());
    view.take(News::Open);
    for &byte in &run.line {
        if let Some(frame) = inbox.push(byte) {
            view.take(News::Frame(frame, inbox.counts(), Instant::now()));
        }
        if view.t_s() >= seconds {
            break;
        }
    }
    view
}

#[test]
fn what_matters_is_on_the_screen_at_80_by_24_and_at_200_by_60() {
    let view = heard("glass", 20.0);
    let shown = Shown { place: "/dev/pts/5".to_owned(), ..Shown::default() };
    for (width, height) in [(80, 24), (200, 60)] {
        let picture = picture(&view, &shown, width, height);
        println!("{picture}");
        for word in [
            "tenax /dev/pts/5",
            "vibration ",
            "S1 100",
            "Ft/Fn ",
            "S2 0.3",
            "grip force ",
            "s1 ",
            "hebbian",
            "mlp",
            "photoela ",
            "flexor ",
            "extensor ",
            "motor ",
            "missed 0 bad 0",
            "control ",
            "what happened",
            "q quit",
            "read only: --control",
        ] {
            assert!(picture.contains(word), "{word} at {width} x {height}");
        }
        assert!(
            picture.contains('⠤') || picture.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)),
            "a trace"
        );
    }
}

/// A reading of 1645 mV that shows as 164 is worse than none.
#[test]
fn no_reading_is_cut_off_at_the_border() {
    let mut view = heard("rig", 1.0);
    let samples = std::array::from_fn(|n| sample_from_mv(1_000 + 50 * n as u32));
    view.senses = Some(Senses { frame: 0, samples, films: [sample_from_mv(1_000); PVDF_COUNT] });
    for width in [80, 100, 119, 120, 160] {
        let picture = picture(&view, &Shown::default(), width, 60);
        let words: Vec<&str> = picture.split([' ', '\n', '│']).collect();
        for sample in samples {
            let reading = mv_from_sample(sample).to_string();
            let is_muscle = samples[MYO_FLEXOR..=MYO_EXTENSOR].contains(&sample);
            assert!(is_muscle || words.contains(&&*reading), "{reading} mV at {width}\n{picture}");
        }
    }
}

#[test]
fn an_answer_a_lost_line_and_another_version_are_said() {
    let mut view = heard("rig", 2.0);
    let shown = Shown { place: "COM3".to_owned(), control: true, ..Shown::default() };
    view.take(News::Answered(Down::Zero, Ok(Answer::Refused(Refusal::Loaded))));
    assert!(picture(&view, &shown, 80, 24).contains("> Zero: refused: Loaded"));
    view.take(News::Gone("unplugged".to_owned()));
    assert!(picture(&view, &shown, 80, 24).contains("NO LINE, trying again"));
    view.take(News::Open);
    view.take(News::Frame(Err(BadFrame::Version(9)), view.counts, Instant::now()));
    let said = format!("a board of version 9, and this tool speaks {VERSION}");
    assert!(picture(&view, &shown, 80, 24).contains(&said));
}

#[test]
fn settings_are_shown_with_their_ranges_and_what_is_typed() {
    let view = heard("rig", 2.0);
    let edit = Edit { typed: Some("12".to_owned()), ..Edit::default() };
    let shown = Shown { control: true, edit: Some(edit), ..Shown::default() };
    let text = picture(&view, &shown, 80, 24);
    assert!(text.contains("s1-mv") && text.contains("30 to 150, default 100"), "{text}");
    assert!(text.contains("new value, mV: 12_"), "{text}");
    // At 80 columns, the trace that it moves stays in view, and what the file has in its place.
    let mut edit = Edit::default();
    edit.step(true);
    let against = [(SettingId::S2.number(), 305)].into();
    let text = picture(&view, &Shown { edit: Some(edit), against, ..Shown::default() }, 80, 24);
    assert!(text.contains("Ft/Fn") && text.contains("default 300, file 305"), "{text}");
    let last_row = SettingId::ALL.last().expect("there are some").row().name;
    let mut last = Edit::default();
    last.step(false);
    let shown = Shown { edit: Some(last), ..Shown::default() };
    assert!(picture(&view, &shown, 80, 24).contains(last_row), "the last row is scrolled to");
}

#[test]
fn a_terminal_of_any_size_is_drawn_on() {
    let view = heard("rig", 1.0);
    for (width, height) in [(1, 1), (3, 2), (20, 5), (79, 10), (400, 100)] {
        for edit in [None, Some(Edit::default())] {
            picture(&view, &Shown { edit, ..Shown::default() }, width, height);
        }
    }
}

#[test]
fn the_truth_of_a_scene_stands_beside_what_the_board_says() {
    let mut view = heard("rig", 1.0);
    let shown = Shown::default();
    assert!(!picture(&view, &shown, 80, 24).contains("the scene:"), "a real board has none");
    let truth = Truth {
        t_s: 1.0,
        slide_mm_s: 3.21,
        stuck_part: 0.4,
        grip_n: 12.04,
        needed_n: 10.9,
        slips: 2,
        slipped_mm: 1.25,
        dropped: false,
    };
    view.take(News::Truth(truth));
    let line = " the scene: micro slip 3.2 mm/s; grip 12.0 N, needs 10.9 N; kept, 2 slips, 1.2 mm";
    assert!(picture(&view, &shown, 90, 24).contains(line), "{}", picture(&view, &shown, 90, 24));
    view.take(News::Truth(Truth { stuck_part: 0.0, dropped: true, ..truth }));
    assert!(picture(&view, &shown, 90, 24).contains("slides 3.2 mm/s; grip 12.0 N, needs 10.9 N; DROPPED"));
}
