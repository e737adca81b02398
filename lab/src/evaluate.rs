//! `tenax evaluate emg`: intent recognition on people. `tenax train emg` fits it to them.

pub mod emg;
pub mod fit;
