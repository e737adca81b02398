//! The settings over the screen: their values, ranges and meanings, and a value that is being typed.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line as Text, Span};
use ratatui::widgets::{Block, Clear, Paragraph};
use tenax_logic::setting::SettingId;

use super::Shown;
use crate::monitor::view::View;

/// What is chosen and typed.
#[derive(Debug, Default)]
pub struct Edit {
    pub row: usize,
    /// The value as far as it is typed. None: nothing is typed.
    pub typed: Option<String>,
}

impl Edit {
    /// Goes up or down, round the ends.
    pub fn step(&mut self, down: bool) {
        let rows = SettingId::ALL.len();
        self.row = (self.row + if down { 1 } else { rows - 1 }) % rows;
        self.typed = None;
    }

    /// The setting that is chosen.
    pub fn id(&self) -> SettingId {
        SettingId::ALL[self.row]
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, view: &View, edit: &Edit, shown: &Shown) {
    frame.render_widget(Clear, area);
    let [list, meaning] = Layout::vertical([Constraint::Min(3), Constraint::Length(4)]).areas(area);
    let room = usize::from(list.height.saturating_sub(2));
    let from = edit.row.saturating_sub(room.saturating_sub(1).max(room / 2)).min(SettingId::ALL.len());
    let lines: Vec<Text<'_>> = SettingId::ALL
        .iter()
        .enumerate()
        .skip(from)
        .take(room)
        .map(|(n, id)| {
            let row = id.row();
            let value = view.setting(*id).map_or_else(|| "?".to_owned(), |value| value.to_string());
            let changed = view.setting(*id).is_some_and(|value| value != row.default);
            let mut style = Style::new();
            if changed {
                style = style.fg(Color::Yellow);
            }
            if n == edit.row {
                style = style.add_modifier(Modifier::REVERSED);
            }
            let (min, max) = view.range_in_force(*id).into_inner();
            let there = shown.against.get(&id.number()).filter(|there| view.setting(*id) != Some(**there));
            let there = there.map_or_else(String::new, |there| format!(", file {there}"));
            let text = format!(
                "{:<23}{value:>8} {:<10} {min} to {max}, default {}{there}",
                row.name, row.unit, row.default
            );
            Text::from(Span::styled(text, style))
        })
        .collect();
    let title = if shown.control { "settings" } else { "settings, read only" };
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(title)), list);
    let row = edit.id().row();
    let typed =
        edit.typed.as_ref().map_or_else(String::new, |typed| format!("new value, {}: {typed}_", row.unit));
    let lines = vec![Text::from(row.meaning), Text::styled(typed, Style::new().fg(Color::Yellow))];
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(row.name)), meaning);
}
