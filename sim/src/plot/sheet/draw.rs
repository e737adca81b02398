//! Draws a sheet as SVG.

use anyhow::anyhow;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::{Axis, Mark, Panel, Series, Sheet};

const WIDTH: u32 = 1_200;
const PANEL_HEIGHT: u32 = 340;
/// Of a panel that is as wide as the sheet.
const WIDE_PANEL_HEIGHT: u32 = 230;
const OWN_HEIGHT: i32 = 20;
const TITLE_HEIGHT: u32 = 72;
const FOOT_HEIGHT: u32 = 74;
const MARGIN: i32 = 26;
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";
const INK: RGBColor = RGBColor(40, 40, 40);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

pub fn svg(sheet: &Sheet) -> anyhow::Result<String> {
    let rows = (sheet.panels.len() as u32).div_ceil(sheet.columns);
    let panel_height = if sheet.columns == 1 && rows > 1 { WIDE_PANEL_HEIGHT } else { PANEL_HEIGHT };
    let height = TITLE_HEIGHT + rows * panel_height + FOOT_HEIGHT;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
        drawn(root.fill(&WHITE))?;
        words(&root, &sheet.title, (MARGIN, 12), 22)?;
        words(&root, &sheet.subtitle, (MARGIN, 44), 14)?;
        let (_, below) = root.split_vertically(TITLE_HEIGHT);
        let (panels, foot) = below.split_vertically(rows * panel_height);
        let areas = panels.split_evenly((rows as usize, sheet.columns as usize));
        let (common, own) = names(sheet);
        for ((panel, area), own) in sheet.panels.iter().zip(&areas).zip(&own) {
            draw_panel(area, panel, own)?;
        }
        legend(&foot, &common, (MARGIN, 14), (WIDTH as i32, 14, 26))?;
        drawn(root.present())?;
    }
    Ok(svg)
}

fn draw_panel(area: &Area, panel: &Panel, own: &[&Series]) -> anyhow::Result<()> {
    let wide = area.dim_in_pixel().0 as i32;
    let rows = legend(area, own, (70, 40), (wide, 12, OWN_HEIGHT))?;
    let mut chart = drawn(
        ChartBuilder::on(area)
            .margin_top(34 + OWN_HEIGHT * rows)
            .margin_right(22)
            .margin_bottom(6)
            .margin_left(8)
            .set_label_area_size(LabelAreaPosition::Left, 62)
            .set_label_area_size(LabelAreaPosition::Bottom, 44)
            .build_cartesian_2d(panel.x.places(), panel.y.places()),
    )?;
    words(area, &panel.title, (70, 12), 16)?;
    for band in &panel.bands {
        let corners = [(band.x.0, band.y.0), (band.x.1, band.y.1)];
        drawn(chart.draw_series([Rectangle::new(corners, band.colour.filled())]))?;
    }
    drawn(
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.10))
            .axis_style(INK)
            .x_labels(labels(&panel.x))
            .y_labels(labels(&panel.y))
            .x_label_formatter(&|place| name(&panel.x, *place))
            .y_label_formatter(&|place| name(&panel.y, *place))
            .x_desc(&panel.x.label)
            .y_desc(&panel.y.label)
            .label_style((FONTS, 13).into_font().color(&INK))
            .axis_desc_style((FONTS, 14).into_font().color(&INK))
            .draw(),
    )?;
    for series in &panel.series {
        draw_series(&mut chart, panel, series)?;
    }
    Ok(())
}

fn draw_series(chart: &mut Chart, panel: &Panel, series: &Series) -> anyhow::Result<()> {
    // A gap in a curve is a value that is no number: each stretch between gaps is a line of its own.
    for stretch in series.points.split(|point| point.1.is_nan()) {
        let shown = stretch.iter().filter(|(x, y)| panel.x.shows(*x) && panel.y.shows(*y));
        let points: Vec<(f64, f64)> = shown.map(|(x, y)| (panel.x.place(*x), panel.y.place(*y))).collect();
        let line = series.colour.stroke_width(2);
        let marks = points.iter().copied();
        match series.mark {
            Mark::Line => drawn(chart.draw_series(LineSeries::new(points, line)))?,
            Mark::Dashes => drawn(chart.draw_series(DashedLineSeries::new(points, 7, 5, line)))?,
            Mark::Dots => {
                drawn(chart.draw_series(marks.map(|at| Circle::new(at, 3, series.colour.filled()))))?
            }
            Mark::Crosses => drawn(chart.draw_series(marks.map(|at| Cross::new(at, 4, line))))?,
        };
    }
    Ok(())
}

fn names(sheet: &Sheet) -> (Vec<&Series>, Vec<Vec<&Series>>) {
    let shown = |panel: &Panel, series: &Series| panel.series.iter().any(|other| other.name == series.name);
    let (mut common, mut own): (Vec<&Series>, Vec<Vec<&Series>>) = (Vec::new(), Vec::new());
    for panel in &sheet.panels {
        let mut alone: Vec<&Series> = Vec::new();
        for series in &panel.series {
            let panels = sheet.panels.iter().filter(|panel| shown(panel, series)).count();
            let list = if panels > 1 || sheet.panels.len() == 1 { &mut common } else { &mut alone };
            // Dots on a line of the same name are one thing.
            if list.iter().all(|before| before.name != series.name) {
                list.push(series);
            }
        }
        own.push(alone);
    }
    (common, own)
}

fn legend(
    area: &Area,
    named: &[&Series],
    (left, top): (i32, i32),
    (wide, letters, row): (i32, i32, i32),
) -> anyhow::Result<i32> {
    let (mut x, mut y) = (left, top);
    for series in named {
        let width = 44 + letters * series.name.chars().count() as i32 * 11 / 20 + letters;
        if x + width > wide && x > left {
            (x, y) = (left, y + row);
        }
        let (line, left) = (series.colour.stroke_width(2), x);
        let drew = match series.mark {
            Mark::Line => area.draw(&PathElement::new([(left, y), (left + 26, y)], line)),
            Mark::Dashes => [0, 10, 20].iter().try_for_each(|dash| {
                area.draw(&PathElement::new([(left + dash, y), (left + dash + 6, y)], line))
            }),
            Mark::Dots => area.draw(&Circle::new((left + 13, y), 3, series.colour.filled())),
            Mark::Crosses => area.draw(&Cross::new((left + 13, y), 4, line)),
        };
        drawn(drew)?;
        words(area, &series.name, (x + 34, y - letters / 2 + 1), letters)?;
        x += width;
    }
    Ok(if named.is_empty() { 0 } else { (y - top) / row + 1 })
}

fn labels(axis: &Axis) -> usize {
    let places = axis.places();
    if axis.log { (places.end - places.start).ceil() as usize + 1 } else { 6 }
}

fn name(axis: &Axis, place: f64) -> String {
    let places = axis.places();
    match axis.log {
        // Between powers of ten where there is room for it.
        true if (place - place.round()).abs() > 1e-6 && places.end - places.start > 2.0 => String::new(),
        true => number(format!("{:.1e}", 10f64.powf(place)).parse().unwrap_or_default()),
        false => number((place * 1e6).round() / 1e6 + 0.0),
    }
}

fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// `at`: the upper left corner.
fn words(area: &Area, text: &str, at: (i32, i32), size: i32) -> anyhow::Result<()> {
    drawn(area.draw(&Text::new(text.to_owned(), at, (FONTS, size).into_font().color(&INK))))
}

/// plotters' error as ours; it does not go through `?` because it borrows.
fn drawn<T, E: std::fmt::Display>(result: Result<T, E>) -> anyhow::Result<T> {
    result.map_err(|error| anyhow!("the plot cannot be drawn: {error}"))
}
