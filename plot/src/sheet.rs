//! What is on a sheet of panels, before anybody draws it.

pub mod draw;

use plotters::style::RGBColor;

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// Its ends.
    pub ends: (f64, f64),
    /// Whether it is logarithmic.
    pub log: bool,
}

impl Axis {
    /// By decades.
    pub fn log(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.to_owned(), ends: (from, to), log: true }
    }

    /// Evenly.
    pub fn even(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.to_owned(), ends: (from, to), log: false }
    }

    /// Where a value is.
    pub fn place(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }

    /// Both ends.
    pub fn places(&self) -> std::ops::Range<f64> {
        self.place(self.ends.0)..self.place(self.ends.1)
    }

    /// Whether it has this value.
    pub fn shows(&self, value: f64) -> bool {
        (self.ends.0..=self.ends.1).contains(&value)
    }
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A dashed line.
    Dashes,
    /// A dot at each.
    Dots,
    /// A ring at each.
    Rings,
    /// A cross at each.
    Crosses,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// What they are; equal names share one entry of the legend.
    pub name: String,
    /// Their colour.
    pub colour: RGBColor,
    /// How they are drawn.
    pub mark: Mark,
    /// Where they are. What is outside the axes is not drawn.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// Points of one look.
    pub fn new(
        name: impl Into<String>,
        colour: RGBColor,
        mark: Mark,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self { name: name.into(), colour, mark, points: points.into_iter().collect() }
    }
}

/// A cell of a map.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// From and to.
    pub x: (f64, f64),
    /// From and to.
    pub y: (f64, f64),
    /// None where it failed.
    pub error: Option<f64>,
}

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What it is of.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// A map, under everything else.
    pub cells: Vec<Cell>,
    /// Curves and points.
    pub series: Vec<Series>,
    /// Words at points.
    pub words: Vec<(f64, f64, String)>,
}

impl Panel {
    /// Curves and points alone.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { title: title.into(), x, y, cells: Vec::new(), series, words: Vec::new() }
    }
}

/// The sheet: panels from left to right and from top to bottom, a legend at its foot.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// What it is of.
    pub title: String,
    /// One line under it.
    pub subtitle: String,
    /// Panels in a row.
    pub columns: u32,
    /// All of them.
    pub panels: Vec<Panel>,
    /// The ends of the colours of errors, if there is a map.
    pub errors: Option<(f64, f64)>,
}

impl Sheet {
    /// Without a map.
    pub fn new(
        title: impl Into<String>,
        subtitle: impl Into<String>,
        columns: u32,
        panels: Vec<Panel>,
    ) -> Self {
        Self { title: title.into(), subtitle: subtitle.into(), columns, panels, errors: None }
    }
}
