//! Figures as SVG: sheets of panels.

pub mod sheet;
pub mod thin;

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
    pub const BLACK: RGBColor = RGBColor(0, 0, 0);
    pub const YELLOW: RGBColor = RGBColor(240, 228, 66);
}
