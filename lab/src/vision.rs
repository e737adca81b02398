//! A camera behind a clear skin: pictures through `tenax-vision`, to a report, tables and the teacher's codes.

pub mod film;
pub mod scored;
