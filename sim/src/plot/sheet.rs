//! The panels of a sheet, before anybody draws it.

pub mod draw;

use plotters::style::{RGBAColor, RGBColor};

#[derive(Clone, Debug)]
pub struct Axis {
    pub label: String,
    pub ends: (f64, f64),
    pub log: bool,
}

impl Axis {
    pub fn log(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.to_owned(), ends: (from, to), log: true }
    }

    pub fn even(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.to_owned(), ends: (from, to), log: false }
    }

    pub fn place(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }

    pub fn places(&self) -> std::ops::Range<f64> {
        self.place(self.ends.0)..self.place(self.ends.1)
    }

    pub fn shows(&self, value: f64) -> bool {
        (self.ends.0..=self.ends.1).contains(&value)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    Line,
    Dashes,
    Dots,
    Crosses,
}

#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub colour: RGBColor,
    pub mark: Mark,
    pub points: Vec<(f64, f64)>,
}

impl Series {
    pub fn new(
        name: impl Into<String>,
        colour: RGBColor,
        mark: Mark,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self { name: name.into(), colour, mark, points: points.into_iter().collect() }
    }
}

/// A rectangle behind the curves.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub colour: RGBAColor,
}

#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub bands: Vec<Band>,
    pub series: Vec<Series>,
}

impl Panel {
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { title: title.into(), x, y, bands: Vec::new(), series }
    }
}

#[derive(Clone, Debug)]
pub struct Sheet {
    pub title: String,
    pub subtitle: String,
    pub columns: u32,
    pub panels: Vec<Panel>,
}

impl Sheet {
    pub fn new(
        title: impl Into<String>,
        subtitle: impl Into<String>,
        columns: u32,
        panels: Vec<Panel>,
    ) -> Self {
        Self { title: title.into(), subtitle: subtitle.into(), columns, panels }
    }
}
