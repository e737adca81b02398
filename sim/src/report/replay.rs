//! What only a recording has to tell: its own peak and onset beside the fingertip's detections.

use std::path::Path;

use serde::Serialize;
use tenax_hal_shim::detector::DetectorId;

use super::wearer::Wearer;
use crate::replay::facts::{Crest, crest, doubts, muscle_onset_s};
use crate::replay::library::Named;
use crate::replay::meaning::{Meaning, Motion};
use crate::replay::{Recipe, Recording};
use crate::timeline::Timeline;

#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    pub recording: String,
    /// The recipe's name or file. Null where the columns were channels already.
    pub recipe: Option<String>,
    pub first_s: f64,
    pub duration_s: f64,
    pub lead_in_s: f64,
    pub longest_gap_ms: f64,
    pub unused_columns: Vec<String>,
    pub assumed: Vec<String>,
    pub doubts: Vec<String>,
    pub force: Option<Force>,
    pub muscle: Option<Muscle>,
    /// What the hand did against what the recording means. Null where the recipe does not say.
    pub meant: Option<Meant>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Meant {
    pub wants: Motion,
    pub never: Vec<Motion>,
    /// For how long it did what the wearer wants, s. Null where they want it to rest.
    pub wanted_s: Option<f64>,
    pub wrong_ms: f64,
}

impl Meant {
    fn new(meaning: &Meaning, wearer: &Wearer) -> Self {
        let longest_ms = |motion: &Motion| match motion {
            Motion::Rest => 0.0,
            Motion::Close => wearer.longest_close_ms,
            Motion::Open => wearer.longest_open_ms,
        };
        Self {
            wants: meaning.wants,
            never: meaning.never.clone(),
            wanted_s: match meaning.wants {
                Motion::Rest => None,
                Motion::Close => Some(wearer.closing_s),
                Motion::Open => Some(wearer.opening_s),
            },
            wrong_ms: meaning.never.iter().map(longest_ms).fold(0.0, f64::max),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Force {
    /// Ft/Fn at the crest. Null where it has none.
    pub peak_ratio: Option<f64>,
    pub peak_s: Option<f64>,
    pub s2_first_s: Option<f64>,
    pub s2_before_peak_ms: Option<f64>,
    pub s1_first_s: Option<f64>,
    pub s1_before_peak_ms: Option<f64>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Muscle {
    /// Onset in the recording itself, s: see [`muscle_onset_s`].
    pub onset_s: Option<f64>,
    pub noticed_s: Option<f64>,
    pub onset_delay_ms: Option<f64>,
    pub active_part: f64,
    pub reflex_while_active: u64,
}

impl Replay {
    pub fn new(
        recording: &Recording,
        named: Option<&Named>,
        lead_in_s: f64,
        timeline: &Timeline,
        wearer: &Wearer,
    ) -> anyhow::Result<Self> {
        let recipe = named.map(|named| &named.recipe);
        let used = |column: &str| recipe.is_none_or(|recipe| !recipe.goes_to(column).is_empty());
        let muscle = |recipe: &Recipe| -> anyhow::Result<Muscle> {
            let (onset_s, noticed_s) = (muscle_onset_s(recording, recipe)?, wearer.active_first_s);
            Ok(Muscle {
                onset_s,
                noticed_s,
                onset_delay_ms: onset_s.zip(noticed_s).map(|(onset, noticed)| (noticed - onset) * 1e3),
                active_part: timeline.active_part(recording.span_s()),
                reflex_while_active: wearer.reflex_while_active,
            })
        };
        let muscle = recipe.filter(|recipe| recipe.maps_a_muscle()).map(muscle).transpose()?;
        let force = |recipe| -> anyhow::Result<Force> { Ok(Force::new(crest(recording, recipe)?, timeline)) };
        Ok(Self {
            recording: recording.file().to_owned(),
            recipe: named.map(|named| named.name.clone()),
            first_s: recording.first_s(),
            duration_s: recording.duration_s(),
            lead_in_s,
            longest_gap_ms: recording.longest_gap_s() * 1e3,
            unused_columns: recording.signals().filter(|column| !used(column)).map(str::to_owned).collect(),
            assumed: recipe.map_or_else(Vec::new, assumed),
            doubts: [
                recording.doubts(),
                recipe.map_or_else(|| Ok(Vec::new()), |own| doubts(recording, own))?,
            ]
            .concat(),
            force: recipe.filter(|recipe| recipe.force.is_some()).map(force).transpose()?,
            muscle,
            meant: recipe
                .and_then(|recipe| recipe.meaning_of(file_name(recording)))
                .map(|meaning| Meant::new(meaning, wearer)),
        })
    }
}

impl Force {
    fn new(crest: Option<Crest>, timeline: &Timeline) -> Self {
        let [s1, s2] = [DetectorId::S1, DetectorId::S2].map(|id| timeline.believed(id).first().copied());
        let before_ms = |first: Option<f64>| Some((crest?.peak_s - first?) * 1e3);
        Self {
            peak_ratio: crest.map(|crest| crest.peak_ratio),
            peak_s: crest.map(|crest| crest.peak_s),
            s2_first_s: s2,
            s2_before_peak_ms: before_ms(s2),
            s1_first_s: s1,
            s1_before_peak_ms: before_ms(s1),
        }
    }
}

fn file_name(recording: &Recording) -> &str {
    Path::new(recording.file()).file_name().and_then(|name| name.to_str()).unwrap_or_default()
}

fn assumed(recipe: &Recipe) -> Vec<String> {
    let force = recipe.hold.force.iter().map(|hold| {
        let hold = hold.get_ref();
        format!("force sensor: {} N, shear {} N: {}", hold.normal_n, hold.shear_n, hold.why)
    });
    let pins = recipe.hold.pins.iter().map(|hold| {
        let names: Vec<&str> = hold.channels.iter().map(|name| name.get_ref().as_str()).collect();
        format!("{}: {} V: {}", names.join(", "), hold.volts.get_ref(), hold.why)
    });
    force.chain(pins).collect()
}
