//! Closed loops, properties and published results: see `tests/`.
