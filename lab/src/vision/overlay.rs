//! What the camera sees with what was made of it, drawn as in FingerVision 2017, figure 7: forces on the left, object and
//! movement on the right.

use anyhow::{Context, Result};
use tenax_vision::frame::{Frame, HEIGHT, WIDTH};
use tenax_vision::mask::Mask;
use tenax_vision::{Camera, Summary};
use tiny_skia::{Color, IntSize, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// Pixels for one of the picture's.
const SCALE: usize = 2;
/// A marker's move is drawn this much longer than it is.
const LONGER: f32 = 10.0;

const RED: (u8, u8, u8) = (235, 30, 30);
const GREY: (u8, u8, u8) = (150, 150, 150);
const YELLOW: (u8, u8, u8) = (250, 220, 0);

/// Draws one picture as PNG. Fails if it cannot be written.
pub fn png(frame: &Frame, camera: &Camera, summary: &Summary) -> Result<Vec<u8>> {
    let (width, height) = (2 * WIDTH * SCALE, HEIGHT * SCALE);
    let mut bytes = vec![255; 4 * width * height];
    let object = camera.object();
    for y in 0..height {
        for x in 0..width {
            let (px, py, right) = (x / SCALE % WIDTH, y / SCALE, x >= WIDTH * SCALE);
            let at = py * WIDTH + px;
            let mut colour = [frame.red[at], frame.green[at], frame.blue[at]];
            if right {
                let is = |mask: &Mask| mask.contains(px, py);
                colour = match (is(object.object()), is(object.moving())) {
                    (true, true) => [200, 0, 200],
                    (true, false) => [colour[0] / 2, colour[1] / 2 + 30, colour[2] / 2 + 100],
                    (false, true) => [0, 220, 0],
                    (false, false) => colour,
                };
            }
            let place = 4 * (y * width + x);
            bytes[place..place + 3].copy_from_slice(&colour);
        }
    }
    let size = IntSize::from_wh(width as u32, height as u32).context("no size")?;
    let mut canvas = Pixmap::from_vec(bytes, size).context("no picture")?;
    let scale = SCALE as f32;
    let place = |x: f32, y: f32| ((x + 0.5) * scale, (y + 0.5) * scale);
    for marker in camera.markers().into_iter().flat_map(|markers| markers.iter()) {
        let (x, y) = place(marker.at.x, marker.at.y);
        let colour = if marker.found.is_ok() { RED } else { GREY };
        let rim = PathBuilder::from_circle(x, y, (marker.rest.radius() + marker.growth + 1.5) * scale);
        stroke(&mut canvas, rim, colour, 1.0);
        if marker.known() {
            let (dx, dy) = marker.moved();
            line(&mut canvas, (x, y), (x + dx * LONGER * scale, y + dy * LONGER * scale), colour);
        }
    }
    if let Some(sighting) = summary.object {
        // The long axis, in the right half.
        let (x, y) = place(sighting.moments.middle.x + WIDTH as f32, sighting.moments.middle.y);
        let (sin, cos) = sighting.angle_rad.sin_cos();
        let long = 60.0 * sighting.moments.eccentricity() * scale;
        line(&mut canvas, (x - long * cos, y - long * sin), (x + long * cos, y + long * sin), YELLOW);
        stroke(&mut canvas, PathBuilder::from_circle(x, y, 4.0), YELLOW, 2.0);
    }
    canvas.encode_png().context("the overlay cannot be written as PNG")
}

fn line(canvas: &mut Pixmap, from: (f32, f32), to: (f32, f32), colour: (u8, u8, u8)) {
    let mut path = PathBuilder::new();
    path.move_to(from.0, from.1);
    path.line_to(to.0, to.1);
    stroke(canvas, path.finish(), colour, 2.0);
}

/// Nothing is drawn of what has no length.
fn stroke(canvas: &mut Pixmap, path: Option<tiny_skia::Path>, (r, g, b): (u8, u8, u8), width: f32) {
    let Some(path) = path else { return };
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(r, g, b, 255));
    canvas.stroke_path(&path, &paint, &Stroke { width, ..Stroke::default() }, Transform::identity(), None);
}
