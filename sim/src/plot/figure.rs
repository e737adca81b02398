//! What is in a figure, before anybody draws it.

use plotters::style::RGBColor;

/// Colours that stay apart for colour-blind eyes and in print (Okabe and Ito, 2008).
pub mod colour {
    use plotters::style::RGBColor;

    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    pub const GREY: RGBColor = RGBColor(150, 150, 150);
    pub const YELLOW: RGBColor = RGBColor(240, 228, 66);
}

#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub colour: RGBColor,
    pub points: Vec<(f64, f64)>,
}

#[derive(Clone, Debug)]
pub struct Level {
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

#[derive(Clone, Debug)]
pub struct Stretch {
    pub name: String,
    pub colour: RGBColor,
    pub from_s: f64,
    pub to_s: f64,
}

#[derive(Clone, Debug, Default)]
pub struct Panel {
    pub label: String,
    pub curves: Vec<Curve>,
    pub levels: Vec<Level>,
    pub strip: Vec<Stretch>,
    pub names: Vec<(f64, String)>,
    pub at_least: (f64, f64),
    pub height: f64,
}

#[derive(Clone, Debug)]
pub struct Figure {
    pub title: String,
    pub subtitle: String,
    pub span_s: (f64, f64),
    pub slips: Vec<(f64, f64)>,
    pub panels: Vec<Panel>,
}
