//! Thresholds from a recording: what each should be on this board, and why.
//!
//! Everything is taken from what the board said of its own ticks, so any recording or captured line will do. Levels are
//! medians, and what is usual is the median and five times the median deviation: half of a recording may be something else.

mod emg;
mod friction;
mod vibration;

use tenax_hal_shim::wire::{Setting, Slow, Up};
use tenax_logic::setting::SettingId;

use crate::link::Inbox;
use crate::quantile::middle;

/// A setting's value, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    pub id: SettingId,
    /// Its value; within its range.
    pub value: i32,
    /// What was measured, and what follows.
    pub why: String,
}

impl Suggestion {
    /// The setting with this value, as near as its range allows.
    fn new(id: SettingId, wanted: f64, why: String) -> Self {
        let row = id.row();
        let value = (wanted.round() as i32).clamp(row.min, row.max);
        let why = if f64::from(value) == wanted.round() {
            why
        } else {
            format!("{why}; {:.0} would be outside {} to {}", wanted, row.min, row.max)
        };
        Self { id, value, why }
    }

    /// As it is sent.
    pub const fn setting(&self) -> Setting {
        Setting { id: self.id.number(), value: self.value }
    }
}

/// What a recording says of thresholds, and why it says nothing of the others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Suggestions {
    /// What it says.
    pub all: Vec<Suggestion>,
    /// What it does not, and what is missing.
    pub missing: Vec<String>,
}

impl Suggestions {
    /// From a line's bytes.
    pub fn of(line: &[u8]) -> Self {
        let mut inbox = Inbox::default();
        let heard = line.iter().filter_map(|&byte| inbox.push(byte)).flatten();
        let slows: Vec<Slow> = heard
            .filter_map(|heard| match heard.received.message {
                Up::Slow(slow) => Some(slow),
                _ => None,
            })
            .collect();
        let mut suggestions = Self::default();
        for looked in [vibration::suggest(&slows), friction::suggest(&slows), emg::suggest(&slows)] {
            match looked {
                Ok(suggestion) => suggestions.all.push(suggestion),
                Err(missing) => suggestions.missing.push(missing),
            }
        }
        suggestions
    }
}

/// The median, and what is still usual: five median deviations above it, as five of a normal distribution's.
fn usual(values: &[f64]) -> Option<(f64, f64)> {
    let median = middle(values.iter().copied())?;
    let apart = values.iter().map(|value| (value - median).abs());
    Some((median, median + 5.0 * 1.4826 * middle(apart)?))
}

/// Slow frames as seconds.
fn seconds(slows: usize) -> f64 {
    slows as f64 / f64::from(tenax_hal_shim::channel::SLOW_HZ)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_usual_is_not_moved_by_what_is_rare() {
        let mut values: Vec<f64> = (0..1_000).map(|n| 10.0 + f64::from(n % 11 - 5) / 5.0).collect();
        let (median, most) = usual(&values).unwrap();
        assert!((median - 10.0).abs() < 0.01 && (13.0..16.0).contains(&most), "{median} {most}");
        values.extend([900.0; 400]);
        let (median, with) = usual(&values).unwrap();
        assert!((9.9..10.9).contains(&median) && with < 20.0, "{median} {with}");
        assert_eq!(usual(&[]), None);
    }

    #[test]
    fn what_is_out_of_range_is_moved_into_it_and_says_so() {
        let suggestion = Suggestion::new(SettingId::S1, 3.0, "quiet".to_owned());
        assert_eq!(suggestion.value, 30);
        assert!(suggestion.why.contains("3 would be outside 30 to 150"), "{}", suggestion.why);
    }
}
