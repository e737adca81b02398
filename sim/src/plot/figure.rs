//! What is in a figure, before anybody draws it.

use plotters::style::RGBColor;

/// Colours that stay apart for colour-blind eyes and in print (Okabe and Ito, 2008).
pub mod colour {
    use plotters::style::RGBColor;

    /// The main curve of a panel.
    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    /// The second one.
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    /// Thresholds, and what goes wrong.
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
    /// The wearer.
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    /// Slip.
    pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
    /// Watching.
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    /// Standing by.
    pub const GREY: RGBColor = RGBColor(150, 150, 150);
    /// Settling.
    pub const YELLOW: RGBColor = RGBColor(240, 228, 66);
}

#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is, at the panel's right; empty where the axis names it.
    pub name: String,
    pub colour: RGBColor,
    /// Its points; a gap is a point whose value is NaN.
    pub points: Vec<(f64, f64)>,
}

/// A threshold.
#[derive(Clone, Debug)]
pub struct Level {
    pub name: String,
    /// Where it is, from one end to the other.
    pub points: Vec<(f64, f64)>,
}

/// A stretch of time with a colour.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// What it is; equal names share one entry at the panel's right.
    pub name: String,
    pub colour: RGBColor,
    pub from_s: f64,
    pub to_s: f64,
}

#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// What its axis shows, with the unit.
    pub label: String,
    pub curves: Vec<Curve>,
    pub levels: Vec<Level>,
    /// A strip of states at its foot.
    pub strip: Vec<Stretch>,
    /// Names on the axis in the place of numbers, each at its value.
    pub names: Vec<(f64, String)>,
    /// The least that the axis spans.
    pub at_least: (f64, f64),
    /// Its height, in parts of the figure's.
    pub height: f64,
}

#[derive(Clone, Debug)]
pub struct Figure {
    pub title: String,
    /// One line under it.
    pub subtitle: String,
    pub span_s: (f64, f64),
    /// When the object slipped.
    pub slips: Vec<(f64, f64)>,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}
