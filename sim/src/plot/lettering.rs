//! Words as outlines, from a font that comes along: no system font, no system library.

use anyhow::{Context, Result};
use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::{Face, OutlineBuilder};

/// DejaVu Sans, read once for a picture.
pub struct Lettering {
    face: Face<'static>,
}

impl Lettering {
    /// Reads the font. Fails if the font that comes along cannot be read.
    pub fn new() -> Result<Self> {
        let face = Face::parse(dejavu::sans::regular(), 0).context("the font cannot be read")?;
        Ok(Self { face })
    }

    /// One line of words, `size` pixels high, its baseline beginning at the origin; and its width.
    pub fn line(&self, words: &str, size: f32) -> (Option<Path>, f32) {
        // The font's units are as small as its designer liked, and its y axis goes up.
        let scale = size / f32::from(self.face.units_per_em());
        let mut outline = Outline { path: PathBuilder::new(), scale, x: 0.0 };
        for sign in words.chars() {
            let glyph = self.face.glyph_index(sign).unwrap_or_default();
            self.face.outline_glyph(glyph, &mut outline);
            outline.x += f32::from(self.face.glyph_hor_advance(glyph).unwrap_or(0)) * scale;
        }
        let width = outline.x;
        (outline.path.finish(), width)
    }
}

/// A line of words in the making; the next glyph begins at `x`.
struct Outline {
    path: PathBuilder,
    scale: f32,
    x: f32,
}

impl Outline {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, -y * self.scale)
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

/// Where a line of words of this width is put for an SVG's `text`: its anchor, its `dy`, its rotation.
/// Fails if one of them is none that plotters writes.
pub fn place(shape: &super::shapes::Shape<'_>, size: f32, width: f32) -> Result<Transform> {
    let (x, y) = (shape.number("x")?, shape.number("y")?);
    let left = match shape.text("text-anchor")? {
        "middle" => -width / 2.0,
        "end" => -width,
        _ => 0.0,
    };
    let down = shape.text("dy")?;
    // An ex is half an em, as everywhere where the font is not asked.
    let (down, unit) = match (down.strip_suffix("em"), down.strip_suffix("ex")) {
        (Some(number), _) => (number, size),
        (_, Some(number)) => (number, size / 2.0),
        _ => (down, 1.0),
    };
    let down = down.parse::<f32>().context("dy of a text")? * unit;
    let turned = match shape.text("transform").unwrap_or("").strip_prefix("rotate(") {
        // Only ever about the text's own place.
        Some(angle) => angle.split(',').next().unwrap_or("0").parse().context("rotation of a text")?,
        None => 0.0,
    };
    Ok(Transform::from_translate(left, down).post_rotate(turned).post_translate(x, y))
}
