//! The host's own build of the logic, wired to a plant directly: no converter, no line, no core.
