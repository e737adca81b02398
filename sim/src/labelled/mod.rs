//! Labelled recordings of a force array, from CSV files of a row a reading: ten samples as the board would have read them, 80 times a
//! second, and where the object slipped.

pub mod library;
mod read;
pub mod recipe;

use std::str::FromStr;

use serde::{Deserialize, Serialize};
use tenax_hal_shim::channel::ARRAY_COUNT;

use crate::scorer::{Doing, SlipSpan, onsets};

pub use read::{parse, read};
pub use recipe::ArrayRecipe;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    Train,
    Validation,
    Test,
}

impl Part {
    pub const ALL: [Self; 3] = [Self::Train, Self::Validation, Self::Test];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Validation => "validation",
            Self::Test => "test",
        }
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let part = Self::ALL.into_iter().find(|part| part.name() == name);
        part.ok_or_else(|| format!("`{name}` is no part of a data set; they are train, validation and test"))
    }
}

/// One time step, 12.5 ms after the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The ten elements, 14-bit samples, 0 to [`SAMPLE_MAX`](tenax_hal_shim::channel::SAMPLE_MAX).
    pub samples: [u16; ARRAY_COUNT],
    pub slip: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    pub name: String,
    pub session: String,
    pub material: String,
    pub part: Option<Part>,
    pub doing: Doing,
    pub first_s: f64,
    pub steps: Vec<Step>,
    pub slips: Vec<SlipSpan>,
    pub exact: bool,
}

impl Recording {
    pub fn of_steps(name: &str, steps: Vec<Step>) -> Self {
        Self {
            name: name.to_owned(),
            session: name.to_owned(),
            material: name.to_owned(),
            part: None,
            doing: Doing::Unknown,
            first_s: 0.0,
            slips: onsets::of_labels(steps.iter().map(|step| step.slip), 0.0),
            steps,
            exact: false,
        }
    }
}
