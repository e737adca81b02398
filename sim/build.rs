//! Says whether the recordings are here.

include!("../sim/recordings.rs");

fn main() {
    recordings();
}
