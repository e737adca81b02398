//! Traces of the last ten seconds, each with the threshold that it is judged by.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::text::Line as Text;
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType};
use tenax_logic::setting::SettingId;

use crate::monitor::view::{Point, View};

/// Seconds that are shown.
const SPAN_S: f64 = 10.0;

struct Trace<'a> {
    title: String,
    values: Vec<(f64, f64)>,
    threshold: Vec<(f64, f64)>,
    /// The highest value that is shown even if nothing is as high.
    at_least: f64,
    unit: &'a str,
}

/// The vibration envelope, and S1.
pub fn vibration(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let s1 = view.setting(SettingId::S1).map(f64::from);
    let now = view.history.back().map_or(0.0, |point| point.vibration_mv);
    trace(
        frame,
        area,
        view,
        Trace {
            title: format!("vibration {now:.0} mV{}", s1.map_or(String::new(), |s1| format!(", S1 {s1:.0}"))),
            values: values(view, |point| Some(point.vibration_mv)),
            threshold: values(view, |_| s1),
            at_least: s1.unwrap_or(100.0) * 1.3,
            unit: "mV",
        },
    );
}

/// Ft/Fn, and S2.
pub fn ratio(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let last = view.history.back();
    let now =
        last.and_then(|point| point.ratio).map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.3}"));
    let s2 = last.map_or(0.3, |point| point.s2);
    trace(
        frame,
        area,
        view,
        Trace {
            title: format!("Ft/Fn {now}, S2 {s2:.3}"),
            values: values(view, |point| point.ratio),
            threshold: values(view, |point| Some(point.s2)),
            at_least: s2 * 1.3,
            unit: "",
        },
    );
}

/// The force that the object is held with, and the ceiling where it is near.
pub fn load(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let now = view.history.back().and_then(|point| point.load_n);
    let now = now.map_or_else(|| "no force".to_owned(), |load_n| format!("{load_n:.2} N"));
    trace(
        frame,
        area,
        view,
        Trace {
            title: format!("grip force {now}"),
            values: values(view, |point| point.load_n),
            threshold: Vec::new(),
            at_least: 2.0,
            unit: "N",
        },
    );
}

fn values(view: &View, value: impl Fn(&Point) -> Option<f64>) -> Vec<(f64, f64)> {
    view.history.iter().filter_map(|point| Some((point.t_s, value(point)?))).collect()
}

fn trace(frame: &mut Frame<'_>, area: Rect, view: &View, trace: Trace<'_>) {
    let end_s = view.t_s().max(SPAN_S);
    let top = trace.values.iter().map(|(_, value)| *value).fold(trace.at_least, f64::max);
    let set = |data, color| {
        let lines = Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line);
        lines.style(Style::new().fg(color)).data(data)
    };
    let chart =
        Chart::new(vec![set(&trace.threshold, Color::Red), set(&trace.values, Color::Cyan)])
            .block(Block::bordered().title(trace.title).border_style(Style::new().fg(Color::DarkGray)))
            .x_axis(Axis::default().bounds([end_s - SPAN_S, end_s]).labels([
                Text::from(format!("{:.0} s", end_s - SPAN_S)),
                Text::from(format!("{end_s:.0} s")),
            ]))
            .y_axis(Axis::default().bounds([0.0, top]).labels([
                Text::from("0"),
                Text::from(format!("{top:.0$} {1}", usize::from(top < 10.0), trace.unit)),
            ]));
    frame.render_widget(chart, area);
}
