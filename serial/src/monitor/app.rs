//! The screen's loop: keys, what the line tells, and twenty pictures a second.

use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use anyhow::Context;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use tenax_hal_shim::wire::{Down, Setting};
use tenax_hal_shim::words::Code;

use super::screen::{self, Edit, Shown};
use super::source::{self, News, Places};
use super::view::View;
use crate::record::{self, Recording};

const PICTURE_EVERY: Duration = Duration::from_millis(50);
/// Age of a picture that a key stands for, ms.
const PICTURE_AGE_MS: u16 = 33;

/// Shows a board until somebody quits. `control` lets keys change something.
/// Fails if the terminal cannot be drawn on, or a recording cannot be written.
pub fn show(places: &Places, control: bool) -> anyhow::Result<()> {
    let (commands, waiting) = channel();
    let (sender, news) = channel();
    // The bench has its keys in the terminal that serves it.
    let _bench = source::start(places, waiting, sender);
    let shown = Shown { place: places.line.to_string(), control, ..Shown::default() };
    let mut app = App { view: View::default(), shown, commands, recording: None, marks: 0, over: false };
    let mut terminal = ratatui::try_init().context("this is no terminal: use --plain")?;
    let ended = app.run(&mut terminal, &mut || news.try_recv().ok());
    ratatui::restore();
    app.end_recording()?;
    ended
}

struct App {
    view: View,
    shown: Shown,
    commands: Sender<Down>,
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
            KeyCode::Char('d') => self.set(&edit, edit.id().row().default),
            KeyCode::Char(digit @ '0'..='9') => edit.typed.get_or_insert_default().push(digit),
            KeyCode::Backspace => _ = edit.typed.as_mut().and_then(String::pop),
            KeyCode::Enter => match edit.typed.take().and_then(|typed| typed.parse().ok()) {
                Some(value) => self.set(&edit, value),
                None => edit.typed = Some(String::new()),
            },
            _ => {}
        }
        Some(edit)
    }

    fn set(&mut self, edit: &Edit, value: i32) {
        self.send(Down::Set(Setting { id: edit.id().number(), value }));
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
