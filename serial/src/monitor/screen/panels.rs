//! The panels beside the traces.

use ratatui::Frame;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line as Text, Span};
use ratatui::widgets::{Block, Paragraph, Row, Table, Wrap};
use tenax_hal_shim::channel::{
    ARRAY, ARRAY_COUNT, CHANNELS, FRAME_HZ, FSR, FSR_COUNT, MOTOR_CURRENT, PVDF_COUNT, STRAIN, STRAIN_COUNT,
    mv_from_sample,
};
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};
use tenax_hal_shim::motor::MotorDrive;

use crate::monitor::view::{Fate, View};

/// Frames for which what happened is shown as just now: half a second.
const RECENT: u32 = FRAME_HZ / 2;
/// Frames after which it is shown no more: five seconds.
const FORGOTTEN: u32 = 5 * FRAME_HZ;

fn block(title: &str) -> Block<'_> {
    Block::bordered().title(title).border_style(Style::new().fg(Color::DarkGray))
}

/// What every detector says, and what became of it.
pub fn detectors(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let now = view.slow.as_ref().map_or(0, |slow| slow.frame);
    let rows = DetectorId::ALL.into_iter().filter(|&id| id != DetectorId::Injected).map(|id| {
        let fate = &view.fates[id as usize];
        Row::new(
            [
                Span::raw(format!("{:<8.8} ", id.name())),
                evidence(fate),
                mark(fate.said, now, "says ", Color::Yellow),
            ]
            .into_iter()
            .chain([
                mark(fate.believed, now, "trusted ", Color::LightRed),
                mark(fate.acted, now, "ACTED", Color::Red),
            ]),
        )
    });
    let widths = [
        Constraint::Length(9),
        Constraint::Length(10),
        Constraint::Length(5),
        Constraint::Length(8),
        Constraint::Length(5),
    ];
    frame.render_widget(Table::new(rows, widths).column_spacing(0).block(block("detectors")), area);
}

fn evidence(fate: &Fate) -> Span<'static> {
    let Some(evidence) = fate.evidence else { return Span::raw("-") };
    let word = match evidence.health {
        DetectorHealth::Starting => return Span::styled("starting", Style::new().fg(Color::DarkGray)),
        DetectorHealth::Blind => return Span::styled("blind", Style::new().fg(Color::Magenta)),
        DetectorHealth::Working if evidence.slip => "slip",
        DetectorHealth::Working if evidence.incipient => "warns",
        DetectorHealth::Working => "quiet",
    };
    let way = match evidence.direction {
        Direction::Unknown => "",
        Direction::Down => "v",
        Direction::Up => "^",
    };
    Span::raw(format!("{word}{way} {:.0}%", f64::from(evidence.confidence_permille) / 10.0))
}

fn mark(when: Option<u32>, now: u32, word: &'static str, color: Color) -> Span<'static> {
    match when {
        Some(at) if now.wrapping_sub(at) < RECENT => {
            Span::styled(word, Style::new().fg(color).add_modifier(Modifier::BOLD))
        }
        Some(at) if now.wrapping_sub(at) < FORGOTTEN => Span::styled(word, Style::new().fg(Color::DarkGray)),
        _ => Span::raw(""),
    }
}

/// The myosensors, the gate, and what drives the motor.
pub fn muscles(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let Some(slow) = &view.slow else {
        return frame.render_widget(block("muscles"), area);
    };
    let mv = |mv: Option<i16>| mv.map_or_else(|| "lost".to_owned(), |mv| format!("{mv} mV"));
    let gate = if slow.wearer_active { "ACTIVE: the reflex is silent" } else { "at rest" };
    let drive = slow.ticks.iter().rev().find(|tick| tick.drive != MotorDrive::Coast);
    let motor = match drive.map(|tick| (tick.drive, tick.source)) {
        None => "coasts".to_owned(),
        Some((MotorDrive::Coast, _)) => "coasts".to_owned(),
        Some((MotorDrive::Close(duty), source)) => {
            format!("closes {:.0} % ({source:?})", f64::from(duty.as_per_mille()) / 10.0)
        }
        Some((MotorDrive::Open(duty), source)) => {
            format!("opens {:.0} % ({source:?})", f64::from(duty.as_per_mille()) / 10.0)
        }
    };
    let lines = vec![
        Text::from(format!("flexor {}  extensor {}", mv(slow.flexor_mv), mv(slow.extensor_mv))),
        Text::from(format!("{gate}; motor {motor}")),
    ];
    frame.render_widget(Paragraph::new(lines).block(block("muscles, motor")), area);
}

/// True rates, what is lost, what control takes, and what is wrong.
pub fn line(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let counters = view.counters.unwrap_or_default();
    let rates = match view.rates() {
        Some((frames, slows)) => format!("{frames:.0} frames/s, {slows:.1} slow frames/s"),
        None => "no rate yet".to_owned(),
    };
    let faults = match view.faults.len() {
        0 => Text::from("no fault"),
        n => {
            let all: Vec<&str> = view.faults.iter().map(String::as_str).collect();
            Text::styled(format!("{n}: {}", all.join(", ")), Style::new().fg(Color::Red))
        }
    };
    let lines = vec![
        Text::from(rates),
        Text::from(format!(
            "missed {} bad {}; lost {} dropped {}",
            view.counts.missed, view.counts.bad_frames, counters.frames_lost, counters.telemetry_dropped
        )),
        Text::from(format!(
            "control {:.1} % worst {} us late {}",
            f64::from(counters.control_permille) / 10.0,
            counters.control_us_max,
            counters.ticks_late
        )),
        faults,
    ];
    frame.render_widget(Paragraph::new(lines).block(block("line, core, faults")), area);
}

/// What happened, the newest at the bottom.
pub fn log(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let [room, width] = [area.height, area.width].map(|side| usize::from(side.saturating_sub(2)).max(1));
    let wrapped = |line: &String| -> Vec<String> {
        let letters: Vec<char> = line.trim_start().chars().collect();
        letters.chunks(width).map(|part| part.iter().collect()).collect()
    };
    let newest = view.log.len().saturating_sub(room);
    let lines: Vec<Text<'_>> = view.log.iter().skip(newest).flat_map(wrapped).map(Text::from).collect();
    let above = lines.len().saturating_sub(room);
    frame.render_widget(Paragraph::new(lines[above..].to_vec()).block(block("what happened")), area);
}

/// Columns of a reading in mV, with the space behind it.
const READING: usize = 5;

/// Lines that every sensor's reading takes in a panel of this width.
pub fn senses_height(width: u16) -> u16 {
    let on_a_line = ((usize::from(width).saturating_sub(2) + 1) / READING).max(1);
    let counts = [PVDF_COUNT, PVDF_COUNT, STRAIN_COUNT, FSR_COUNT, ARRAY_COUNT];
    let lines: usize = counts.iter().map(|count| 1 + count.div_ceil(on_a_line)).sum();
    // The two that have names of their own, and the border.
    lines as u16 + 3
}

pub fn senses(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let Some(senses) = &view.senses else {
        return frame.render_widget(Paragraph::new("not heard yet").block(block("sensors")), area);
    };
    let in_mv = |samples: &[u16]| {
        let all: Vec<String> =
            samples.iter().map(|&sample| format!("{:1$}", mv_from_sample(sample), READING - 1)).collect();
        all.join(" ")
    };
    let mv = |range: std::ops::Range<usize>| in_mv(&senses.samples[range]);
    let last = |n: usize| format!("{} {} mV", CHANNELS[n].name, mv_from_sample(senses.samples[n]));
    let name = |words: &'static str| Text::styled(words, Style::new().fg(Color::DarkGray));
    let lines = vec![
        name("films: envelope, mV"),
        Text::from(in_mv(&senses.films)),
        name("films: sample, mV"),
        Text::from(mv(0..PVDF_COUNT)),
        name("strain gauges, mV"),
        Text::from(mv(STRAIN..STRAIN + STRAIN_COUNT)),
        name("quadrants, mV"),
        Text::from(mv(FSR..FSR + FSR_COUNT)),
        name("taxels, mV"),
        Text::from(mv(ARRAY..ARRAY + ARRAY_COUNT)),
        Text::from(format!("{}, {}", last(MOTOR_CURRENT - 1), last(MOTOR_CURRENT))),
    ];
    // A reading that is cut off at the border would be another one.
    let readings = Paragraph::new(lines).wrap(Wrap { trim: false });
    frame.render_widget(readings.block(block("sensors")), area);
}
