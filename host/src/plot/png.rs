//! The SVG as PNG, with a font that comes along: no system font, no system library.

use std::sync::Arc;

use anyhow::Context;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Pixels for one of the SVG's.
const SCALE: f32 = 1.5;

/// Draws SVG as PNG.
pub fn png(svg: &str) -> anyhow::Result<Vec<u8>> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).context("the plot's SVG cannot be read back")?;
    let size = tree.size().to_int_size().scale_by(SCALE).context("the plot has no size")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).context("the plot is too large")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().context("the plot cannot be written as PNG")
}
