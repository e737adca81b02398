//! Says whether the recordings are here.

include!("../recordings.rs");

fn main() {
    recordings();
}
