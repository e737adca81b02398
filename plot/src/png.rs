//! A plot's SVG as PNG.

use anyhow::{Context, Result, bail};
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::lettering::{self, Lettering};
use super::shapes::Shape;

/// Pixels for one of the SVG's.
const SCALE: f32 = 1.5;

/// Draws the SVG that plotters wrote as PNG. Fails if it is another SVG.
pub fn png(svg: &str) -> Result<Vec<u8>> {
    let shapes = Shape::all(svg).context("the plot's SVG cannot be read back")?;
    let (size, shapes) = shapes.split_first().context("the plot is empty")?;
    let pixels = |key| size.number(key).map(|length| (length * SCALE).ceil() as u32);
    let mut canvas = Pixmap::new(pixels("width")?, pixels("height")?).context("the plot has no size")?;
    let lettering = Lettering::new()?;
    for shape in shapes {
        draw(shape, &lettering, &mut canvas).with_context(|| format!("{shape:?}"))?;
    }
    canvas.encode_png().context("the plot cannot be written as PNG")
}

fn draw(shape: &Shape<'_>, lettering: &Lettering, canvas: &mut Pixmap) -> Result<()> {
    let mut place = Transform::identity();
    let path = match shape.name {
        "rect" => {
            let (x, y) = (shape.number("x")?, shape.number("y")?);
            Rect::from_xywh(x, y, shape.number("width")?, shape.number("height")?).map(PathBuilder::from_rect)
        }
        "circle" => PathBuilder::from_circle(shape.number("cx")?, shape.number("cy")?, shape.number("r")?),
        "line" => {
            let (from, to) = (("x1", "y1"), ("x2", "y2"));
            let point = |(x, y)| anyhow::Ok((shape.number(x)?, shape.number(y)?));
            joined(&[point(from)?, point(to)?], false)
        }
        "polyline" => joined(&shape.points()?, false),
        "polygon" => joined(&shape.points()?, true),
        "text" => {
            let size = shape.number("font-size")?;
            let (path, width) = lettering.line(&shape.words(), size);
            place = lettering::place(shape, size, width)?;
            path
        }
        other => bail!("no plot has a {other}"),
    };
    // Nothing is seen of a rectangle without width, or a line of one point.
    let Some(path) = path else { return Ok(()) };
    let opacity = shape.number("opacity")?;
    let place = place.post_scale(SCALE, SCALE);
    if let Some(colour) = shape.colour("fill")? {
        canvas.fill_path(&path, &paint(colour, opacity), FillRule::Winding, place, None);
    }
    if let Some(colour) = shape.colour("stroke")? {
        let stroke = Stroke { width: shape.number("stroke-width").unwrap_or(1.0), ..Stroke::default() };
        canvas.stroke_path(&path, &paint(colour, opacity), &stroke, place, None);
    }
    Ok(())
}

fn joined(points: &[(f32, f32)], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (n, &(x, y)) in points.iter().enumerate() {
        if n == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn paint([red, green, blue]: [u8; 3], opacity: f32) -> Paint<'static> {
    let mut colour = Color::from_rgba8(red, green, blue, 255);
    colour.apply_opacity(opacity);
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(colour);
    paint
}
