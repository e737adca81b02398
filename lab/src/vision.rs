//! What cameras behind a clear skin tell: pictures from the `ffmpeg` program or from a drawn scene, through
//! `tenax-vision`, to a report, tables and overlays.

pub mod calibrate;
pub mod feed;
pub mod film;
pub mod overlay;
pub mod scored;
pub mod source;
pub mod told;
