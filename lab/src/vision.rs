//! Cameras behind a clear skin: pictures from the `ffmpeg` program or from a drawn scene, through `tenax-vision`, to a report and tables.

pub mod calibrate;
pub mod feed;
pub mod film;
pub mod scored;
pub mod source;
pub mod told;
