//! The screen of `tenax monitor`, from 80 x 24 characters on.

mod charts;
mod panels;
mod settings;

use std::collections::BTreeMap;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line as Text, Span};
use ratatui::widgets::Paragraph;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::words::Line;

use super::view::View;
use crate::play::Playing;
use crate::settings::Trace;
use crate::truth::Truth;

pub use self::settings::Edit;

/// From this height on every sensor's reading is shown too.
const TALL: u16 = 40;
/// From this width on the settings are shown beside the traces.
const WIDE: u16 = 150;

/// What every key does, for the log.
pub const KEYS: [&str; 5] = [
    "q quit, space pause, m mark the log, r record or end it",
    "s settings: up and down choose, Enter changes, d default, f as in --against, u undo",
    "of a recording: left, right, page up and down, home; space pause, [ ] speed, l loop",
    "with --control: z zero the force sensor, c calibrate the muscles",
    "with --control: t teach that it slips, y that it holds",
];

/// What is shown beside the board.
#[derive(Debug, Default)]
pub struct Shown {
    /// Where its line is.
    pub place: String,
    /// Keys may change something.
    pub control: bool,
    /// What comes is kept back.
    pub paused: bool,
    pub recording: Option<String>,
    /// What settings are compared with, by their numbers.
    pub against: BTreeMap<u8, i32>,
    /// The settings are open.
    pub edit: Option<Edit>,
}

/// Draws everything.
pub fn draw(frame: &mut Frame<'_>, view: &View, shown: &Shown) {
    let scene = Constraint::Length(u16::from(!view.truth.is_empty()));
    let [head, truth, body, keys] =
        Layout::vertical([Constraint::Length(1), scene, Constraint::Min(0), Constraint::Length(1)])
            .areas(frame.area());
    frame.render_widget(Paragraph::new(title(view, shown)), head);
    if let Some(now) = view.truth.back() {
        frame.render_widget(Paragraph::new(true_words(now)).style(Style::new().fg(Color::Green)), truth);
    }
    frame.render_widget(
        Paragraph::new(help(shown, view.playing.is_some())).style(Style::new().fg(Color::DarkGray)),
        keys,
    );
    let tall = frame.area().height >= TALL;
    let [left, right] =
        Layout::horizontal([Constraint::Percentage(51), Constraint::Percentage(49)]).areas(body);
    let first = shown.edit.as_ref().and_then(|edit| Trace::of(edit.id())).unwrap_or(Trace::Vibration);
    draw_left(frame, left, view, tall, first);
    let [detectors, muscles, line, log] = Layout::vertical([
        Constraint::Length(1 + DetectorId::COUNT as u16),
        Constraint::Length(4),
        Constraint::Length(6),
        Constraint::Min(3),
    ])
    .areas(right);
    panels::detectors(frame, detectors, view);
    panels::muscles(frame, muscles, view);
    panels::line(frame, line, view);
    panels::log(frame, log, view);
    if let Some(edit) = &shown.edit {
        // Beside the traces that they move: at least that of the chosen one stays in view.
        let over = if body.width >= WIDE { right } else { below_first(left, body) };
        settings::draw(frame, over, view, edit, shown);
    }
}

/// The body without the height of its first trace.
fn below_first(left: Rect, body: Rect) -> Rect {
    let first = left.height / 3;
    Rect { y: body.y + first, height: body.height - first, ..body }
}

fn draw_left(frame: &mut Frame<'_>, area: Rect, view: &View, tall: bool, first: Trace) {
    let readings =
        if tall { Constraint::Length(panels::senses_height(area.width)) } else { Constraint::Length(0) };
    let third = Constraint::Ratio(1, 3);
    let [charts, senses] = Layout::vertical([Constraint::Min(0), readings]).areas(area);
    let areas: [Rect; 3] = Layout::vertical([third; 3]).areas(charts);
    let mut traces = [Trace::Vibration, Trace::Ratio, Trace::Load];
    traces.sort_by_key(|trace| *trace != first);
    for (area, trace) in areas.into_iter().zip(traces) {
        match trace {
            Trace::Ratio => charts::ratio(frame, area, view),
            Trace::Load => charts::load(frame, area, view),
            Trace::Vibration | Trace::Muscles => charts::vibration(frame, area, view),
        }
    }
    if tall {
        panels::senses(frame, senses, view);
    }
}

fn title<'a>(view: &View, shown: &'a Shown) -> Text<'a> {
    let strong = Style::new().add_modifier(Modifier::BOLD);
    let mut spans = vec![Span::styled(format!(" tenax {} ", shown.place), strong.fg(Color::Cyan))];
    if let Some(why) = &view.other_version {
        spans.push(Span::styled(format!(" a board {why}"), strong.fg(Color::Red)));
        return Text::from(spans);
    }
    match (&view.gone, &view.slow) {
        (Some(_), _) => spans.push(Span::styled(" NO LINE, trying again ", strong.fg(Color::Red))),
        (None, None) => spans.push(Span::raw(" nothing heard yet ")),
        (None, Some(slow)) => {
            spans.push(Span::styled(format!(" {:?} ", slow.mode), strong.fg(Color::Black).bg(Color::Green)));
            spans.push(Span::raw(format!(" {:.1} s ", view.t_s())));
            spans.push(match slow.line {
                Line::Reading => Span::raw(" line reads only "),
                Line::Armed { left_s } => {
                    Span::styled(format!(" ARMED {left_s} s "), strong.fg(Color::Yellow))
                }
                Line::Trusted => Span::styled(" LINE TRUSTED ", strong.fg(Color::Yellow)),
            });
        }
    }
    if let Some(Playing { at_s, of_s, speed, repeat, paused }) = view.playing {
        let how =
            [(paused, " PAUSED"), (repeat, " loop")].map(|(is, word)| if is { word } else { "" }).concat();
        spans.push(Span::styled(
            format!(" at {at_s:.1} of {of_s:.1} s x{speed}{how} "),
            strong.fg(Color::Yellow),
        ));
    }
    if let Some(file) = &shown.recording {
        spans.push(Span::styled(format!(" REC {file} "), strong.fg(Color::Red)));
    }
    if shown.paused {
        spans.push(Span::styled(" PAUSED ", strong.fg(Color::Black).bg(Color::Yellow)));
    }
    Text::from(spans)
}

/// What really happens in a scene.
fn true_words(truth: &Truth) -> String {
    let fate = if truth.dropped { "DROPPED" } else { "kept" };
    let Truth { slide_mm_s, grip_n, needed_n, slips, slipped_mm, .. } = truth;
    format!(
        " the scene: {} {slide_mm_s:.1} mm/s; grip {grip_n:.1} N, needs {needed_n:.1} N; {fate}, {slips} slips, {slipped_mm:.1} mm",
        truth.contact()
    )
}

fn help(shown: &Shown, playing: bool) -> &'static str {
    match (&shown.edit, shown.control) {
        (None, _) if playing => " ? keys  q quit  left/right 5 s  space pause  [ ] speed  l loop  s settings",
        (Some(_), true) => {
            " up/down choose   Enter change   d default   f as in the file   u undo   Esc close"
        }
        (Some(_), false) => " up/down   Esc close   (to change: start with --control)",
        (None, true) => {
            " ? keys  q quit  space pause  m mark  r record  s settings  z zero  t slips  y holds"
        }
        (None, false) => " ? keys  q quit  space pause  r record  s settings   read only: --control",
    }
}
