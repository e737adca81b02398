//! Ways for the perceptron to learn that were chosen from.

use tenax_logic::array::FEATURES;

use crate::train::fit::Candidate;
use crate::train::network::{H1, H2};

/// The way for a large data set with validation sessions: quickly from random weights, with all but variances and structure functions
/// scaled to a tenth, since the rest tells arrays apart sooner than sliding. The penalty of a squared weight of a
/// logistic regression that it could begin as is 1e-4 a row.
pub const SHIPPED: [Candidate; 1] = [Candidate {
    shyness: 0.1,
    ridge: 1e-4,
    warm: false,
    epochs: 12,
    learning_rate: 2e-3,
    decay: 1e-2,
    look_back: 1,
}];

/// Ways to learn from a few objects: each begins as a logistic regression, and how far it leaves that is chosen on objects
/// that were left out.
pub const FEW_OBJECTS: [Candidate; 2] = [few(0.1), few(1.0)];

const fn few(shyness: f32) -> Candidate {
    Candidate { shyness, ridge: 4e-3, warm: true, epochs: 4, learning_rate: 3e-4, decay: 1e-1, look_back: 1 }
}

/// The layers' sizes, in words.
pub fn sizes(look_back: usize) -> String {
    match look_back {
        1 => format!("{FEATURES}-{H1}-{H2}-1"),
        frames => format!("{FEATURES}-{H1}-{H2}-1, of which the {H2} see {frames} frames of the {H1}"),
    }
}
