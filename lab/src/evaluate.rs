//! `tenax evaluate`: intent recognition on people, the hand in hours of disturbance. `tenax train emg` fits the former.

pub mod disturbed;
pub mod emg;
pub mod fit;
