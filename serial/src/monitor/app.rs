//! The screen's loop: keys, what the line tells, and twenty pictures a second.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use anyhow::Context;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use tenax_hal_shim::wire::{Down, Setting};
use tenax_hal_shim::words::Code;
use tenax_logic::setting::SettingId;

use super::screen::{self, Edit, Shown};
use super::source::{self, News, Places};
use super::view::View;
use crate::play::Playing;
use crate::record::{self, Recording};

const PICTURE_EVERY: Duration = Duration::from_millis(50);
/// Age of a picture that a key stands for, ms.
const PICTURE_AGE_MS: u16 = 33;

/// Shows a board or a recording until somebody quits. `control` lets keys change something; settings are compared with `against`.
/// Fails if the terminal cannot be drawn on, or a recording cannot be written.
pub fn show(places: &Places, control: bool, against: BTreeMap<u8, i32>) -> anyhow::Result<()> {
    let (commands, waiting) = channel();
    let (sender, news) = channel();
    // The bench has its keys in the terminal that serves it; a recording has them here.
    let play = source::start(places, waiting, sender);
    let shown = Shown { place: places.line.to_string(), control, against, ..Shown::default() };
    let (view, undo) = (View::default(), Vec::new());
    let mut app = App { view, shown, commands, play, undo, recording: None, marks: 0, over: false };
    let mut terminal = ratatui::try_init().context("this is no terminal: use --plain")?;
    let ended = app.run(&mut terminal, &mut || news.try_recv().ok());
    ratatui::restore();
    app.end_recording()?;
    ended
}

fn set(id: SettingId, value: i32) -> Down {
    Down::Set(Setting { id: id.number(), value })
}

/// What a key does to a recording.
fn control(key: KeyCode, playing: &Playing) -> Option<String> {
    let control = match key {
        KeyCode::Left => "-5".to_owned(),
        KeyCode::Right => "+5".to_owned(),
        KeyCode::PageUp => "-60".to_owned(),
        KeyCode::PageDown => "+60".to_owned(),
        KeyCode::Home => "0".to_owned(),
        KeyCode::Char(' ') => "pause".to_owned(),
        KeyCode::Char('l') => "loop".to_owned(),
        KeyCode::Char('[') => format!("x{}", playing.speed / 2.0),
        KeyCode::Char(']') => format!("x{}", playing.speed * 2.0),
        _ => return None,
    };
    Some(control)
}

struct App {
    view: View,
    shown: Shown,
    commands: Sender<Down>,
    /// How a recording is played.
    play: Sender<String>,
    /// What settings were before they were changed here.
    undo: Vec<(SettingId, i32)>,
    recording: Option<(PathBuf, Recording)>,
    marks: u32,
    over: bool,
}

impl App {
    fn run(
        &mut self,
        terminal: &mut DefaultTerminal,
        news: &mut dyn FnMut() -> Option<News>,
    ) -> anyhow::Result<()> {
        let mut due = Instant::now();
        while !self.over {
            while let Some(news) = news() {
                if let (News::Frame(Ok(heard), ..), Some((_, recording))) = (&news, &mut self.recording) {
                    recording.take(&heard.received);
                }
                if !self.shown.paused || !matches!(news, News::Frame(..)) {
                    self.view.take(news);
                }
            }
            terminal.draw(|frame| screen::draw(frame, &self.view, &self.shown)).context("cannot draw")?;
            due += PICTURE_EVERY;
            // After a stop it is not hurried.
            due = due.max(Instant::now());
            while let Some(left) = due.checked_duration_since(Instant::now())
                && event::poll(left).context("cannot read keys")?
            {
                if let Event::Key(key) = event::read().context("cannot read keys")?
                    && key.kind == KeyEventKind::Press
                {
                    let quits =
                        key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
                    self.over |= quits;
                    self.key(key.code)?;
                }
            }
        }
        Ok(())
    }

    fn key(&mut self, key: KeyCode) -> anyhow::Result<()> {
        if let Some(edit) = self.shown.edit.take() {
            self.shown.edit = self.edit(edit, key);
            return Ok(());
        }
        if let Some(playing) = self.view.playing
            && let Some(control) = control(key, &playing)
        {
            // It has ended with its file.
            let _ended = self.play.send(control);
            return Ok(());
        }
        match key {
            KeyCode::Char('q') => self.over = true,
            KeyCode::Char(' ') => self.shown.paused = !self.shown.paused,
            KeyCode::Char('m') => {
                self.marks += 1;
                self.view.say(format!("{:10.4} s mark {}", self.view.t_s(), self.marks));
            }
            KeyCode::Char('?') => screen::KEYS.iter().for_each(|line| self.view.say(*line)),
            KeyCode::Char('r') => self.record()?,
            KeyCode::Char('s') => self.shown.edit = Some(Edit::default()),
            KeyCode::Char('z') => self.send(Down::Zero),
            KeyCode::Char('c') => self.send(Down::CalibrateEmg),
            KeyCode::Char('t') => self.teach([Code::Minus, Code::Plus]),
            KeyCode::Char('y') => self.teach([Code::Plus, Code::Plus]),
            _ => {}
        }
        Ok(())
    }

    /// What a key does in the settings; None closes them.
    fn edit(&mut self, mut edit: Edit, key: KeyCode) -> Option<Edit> {
        match key {
            KeyCode::Esc if edit.typed.is_some() => edit.typed = None,
            KeyCode::Esc | KeyCode::Char('s' | 'q') => return None,
            KeyCode::Up => edit.step(false),
            KeyCode::Down => edit.step(true),
            KeyCode::Char('d') => self.set(edit.id(), edit.id().row().default),
            KeyCode::Char('f') => match self.shown.against.get(&edit.id().number()).copied() {
                Some(value) => self.set(edit.id(), value),
                None => self.view.say("not in the file that --against names"),
            },
            KeyCode::Char('u') => match self.undo.pop() {
                Some((id, value)) => self.send(set(id, value)),
                None => self.view.say("nothing was changed here"),
            },
            KeyCode::Char(digit @ '0'..='9') => edit.typed.get_or_insert_default().push(digit),
            KeyCode::Backspace => _ = edit.typed.as_mut().and_then(String::pop),
            KeyCode::Enter => match edit.typed.take().and_then(|typed| typed.parse().ok()) {
                Some(value) => self.set(edit.id(), value),
                None => edit.typed = Some(String::new()),
            },
            _ => {}
        }
        Some(edit)
    }

    fn set(&mut self, id: SettingId, value: i32) {
        if let (Some(before), true) = (self.view.setting(id), self.shown.control) {
            self.undo.push((id, before));
        }
        self.send(set(id, value));
    }

    fn teach(&mut self, codes: [Code; 2]) {
        self.send(Down::Teach { codes, age_ms: PICTURE_AGE_MS });
    }

    /// Sends what changes something, if that is allowed.
    fn send(&mut self, command: Down) {
        if !self.shown.control {
            self.view.say("read only: start the monitor with --control to change anything");
        } else if self.commands.send(command).is_err() {
            self.view.say("the line is gone");
        }
    }

    fn record(&mut self) -> anyhow::Result<()> {
        if self.recording.is_some() {
            return self.end_recording();
        }
        let path = record::name_now();
        self.recording = Some((path.clone(), Recording::create(&path)?));
        self.shown.recording = Some(path.display().to_string());
        Ok(())
    }

    fn end_recording(&mut self) -> anyhow::Result<()> {
        self.shown.recording = None;
        let Some((path, recording)) = self.recording.take() else { return Ok(()) };
        recording.finish().with_context(|| format!("cannot write {}", path.display()))?;
        self.view.say(format!("recorded {}", path.display()));
        Ok(())
    }
}
