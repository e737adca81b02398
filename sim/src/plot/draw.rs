//! Draws a figure as SVG.

use anyhow::anyhow;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::figure::{Figure, Panel};

/// Size, pixels.
pub const SIZE: (u32, u32) = (1_200, 1_180);
pub const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

const TITLE_HEIGHT: i32 = 62;
const FOOT_HEIGHT: i32 = 46;
const LEFT: i32 = 84;
const RIGHT: i32 = 170;
const GAP: i32 = 14;
const STRIP: f64 = 0.09;
const SLIP: RGBColor = super::figure::colour::PURPLE;
const LEVEL: RGBColor = super::figure::colour::VERMILLION;
pub const INK: RGBColor = RGBColor(40, 40, 40);

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub fn svg(figure: &Figure) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        drawn(root.fill(&WHITE))?;
        title(&root, figure)?;
        let parts: f64 = figure.panels.iter().map(|panel| panel.height).sum();
        let height = f64::from(SIZE.1 as i32 - TITLE_HEIGHT - FOOT_HEIGHT) / parts;
        let mut top = f64::from(TITLE_HEIGHT);
        for (n, panel) in figure.panels.iter().enumerate() {
            let bottom = top + height * panel.height;
            let last = n + 1 == figure.panels.len();
            let foot = if last { FOOT_HEIGHT } else { 0 };
            let all = root.clone().shrink((0, top as i32), (SIZE.0, (bottom - top) as u32 + foot as u32));
            draw_panel(&all, figure, panel, foot)?;
            top = bottom;
        }
        drawn(root.present())?;
    }
    Ok(svg)
}

fn draw_panel(area: &Area, figure: &Figure, panel: &Panel, foot: i32) -> anyhow::Result<()> {
    let (from_s, to_s) = figure.span_s;
    let (low, high) = range(panel);
    let mut chart = drawn(
        ChartBuilder::on(area)
            .margin_top(GAP)
            .margin_right(RIGHT)
            .set_label_area_size(LabelAreaPosition::Left, LEFT)
            .set_label_area_size(LabelAreaPosition::Bottom, foot)
            .build_cartesian_2d(from_s..to_s, low..high),
    )?;
    // A slip is shorter than a pixel in a long run, and is what the figure is about.
    let visible_s = (to_s - from_s) / 400.0;
    for &(begin_s, end_s) in &figure.slips {
        let (from_s, to_s) = (begin_s, end_s.max(begin_s + visible_s).min(to_s));
        drawn(chart.draw_series([Rectangle::new([(from_s, low), (to_s, high)], SLIP.mix(0.35).filled())]))?;
    }
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.10))
        .axis_style(INK)
        .y_labels(5)
        .x_labels(10)
        .label_style((FONTS, 14).into_font().color(&INK))
        .y_label_formatter(&plain)
        .x_label_formatter(&plain)
        .axis_desc_style((FONTS, 15).into_font().color(&INK));
    if foot > 0 {
        mesh.x_desc("time, s");
    }
    if !panel.names.is_empty() {
        // Their places are no ticks of plotters' choice.
        mesh.y_labels(0).disable_y_mesh();
    }
    drawn(mesh.draw())?;
    for (at, name) in &panel.names {
        let y = chart.backend_coord(&(from_s, *at)).1 - area.get_base_pixel().1;
        words(area, name, (LEFT - 8, y), 13, (HPos::Right, VPos::Center))?;
    }
    let strip_top = low + (high - low) * STRIP;
    for stretch in &panel.strip {
        let corners = [(stretch.from_s, low), (stretch.to_s, strip_top)];
        drawn(chart.draw_series([Rectangle::new(corners, stretch.colour.filled())]))?;
    }
    for level in &panel.levels {
        let line = level.points.iter().copied();
        drawn(chart.draw_series(DashedLineSeries::new(line, 6, 4, LEVEL.stroke_width(2))))?;
    }
    for curve in &panel.curves {
        // A gap in a curve is a value that is no number: each stretch between gaps is a line of its own.
        for stretch in curve.points.split(|point| point.1.is_nan()) {
            let line = stretch.iter().copied();
            drawn(chart.draw_series(LineSeries::new(line, curve.colour.stroke_width(2))))?;
        }
    }
    let middle = (area.dim_in_pixel().1 as i32 - foot + GAP) / 2;
    let label = (FONTS, 15).into_font().transform(FontTransform::Rotate270).color(&INK);
    let label = label.pos(Pos::new(HPos::Center, VPos::Center));
    if panel.names.is_empty() {
        drawn(area.draw(&Text::new(panel.label.clone(), (20, middle), label)))?;
    }
    legend(area, panel)
}

fn plain(value: &f64) -> String {
    // Adding zero turns -0 into 0.
    format!("{}", (value * 1e6).round() / 1e6 + 0.0)
}

/// Names at the panel's right, each beside what it names.
fn legend(area: &Area, panel: &Panel) -> anyhow::Result<()> {
    let left = SIZE.0 as i32 - RIGHT + 14;
    let side = (HPos::Left, VPos::Center);
    let mut y = GAP + 10;
    if !panel.names.is_empty() {
        // On the axis they have its place.
        words(area, &panel.label, (left, y), 14, side)?;
        y += 19;
    }
    let mut name = |name: &str| {
        y += 19;
        words(area, name, (left + 27, y - 19), 14, side).map(|()| y - 19)
    };
    for curve in panel.curves.iter().filter(|curve| !curve.name.is_empty()) {
        let y = name(&curve.name)?;
        drawn(area.draw(&PathElement::new([(left, y), (left + 20, y)], curve.colour.stroke_width(3))))?;
    }
    for level in &panel.levels {
        let y = name(&level.name)?;
        for dash in [0, 8, 16] {
            let line = [(left + dash, y), (left + dash + 5, y)];
            drawn(area.draw(&PathElement::new(line, LEVEL.stroke_width(2))))?;
        }
    }
    let mut named: Vec<&str> = Vec::new();
    for stretch in &panel.strip {
        if !named.contains(&stretch.name.as_str()) {
            named.push(&stretch.name);
            let y = name(&stretch.name)?;
            drawn(area.draw(&Rectangle::new([(left, y - 6), (left + 20, y + 6)], stretch.colour.filled())))?;
        }
    }
    Ok(())
}

fn title(root: &Area, figure: &Figure) -> anyhow::Result<()> {
    let side = (HPos::Left, VPos::Top);
    words(root, &figure.title, (LEFT, 10), 22, side)?;
    words(root, &figure.subtitle, (LEFT, 40), 14, side)?;
    if !figure.slips.is_empty() {
        let left = SIZE.0 as i32 - RIGHT + 14;
        drawn(root.draw(&Rectangle::new([(left, 16), (left + 20, 28)], SLIP.mix(0.35).filled())))?;
        words(root, "the object slips", (left + 27, 15), 14, side)?;
    }
    Ok(())
}

fn range(panel: &Panel) -> (f64, f64) {
    let values = panel.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
    let (mut low, mut high) = panel.at_least;
    for value in values.filter(|value| value.is_finite()) {
        low = low.min(value);
        high = high.max(value);
    }
    let air = (high - low) * 0.05;
    let low = if low < 0.0 { low - air } else { low };
    if panel.strip.is_empty() {
        return (low, high + air);
    }
    (low - (high - low) * STRIP * 1.5, high + air)
}

pub(super) fn words(
    area: &Area,
    text: &str,
    at: (i32, i32),
    size: i32,
    (side, height): (HPos, VPos),
) -> anyhow::Result<()> {
    let style = (FONTS, size).into_font().color(&INK).pos(Pos::new(side, height));
    drawn(area.draw(&Text::new(text.to_owned(), at, style)))
}

/// plotters' error as ours; it does not go through `?` because it borrows.
pub(super) fn drawn<T, E: std::fmt::Display>(result: Result<T, E>) -> anyhow::Result<T> {
    result.map_err(|error| anyhow!("the plot cannot be drawn: {error}"))
}
