//! Recorded envelopes of people: what `evaluate emg` and `train emg` have in common.

use std::path::PathBuf;

use tenax_frames::tool::format::Format;

/// Where they are, and what is drawn and printed of them.
#[derive(Debug, clap::Args)]
pub struct People {
    /// Folder of personP_dayD_postureQ.csv: t_s, ecu, edc, fcr, fcu (32767 is 2.8 V), label (1 rest, 3 close, 4 open)
    #[arg(long, value_name = "FOLDER")]
    pub recordings: PathBuf,
    /// Seed of the random faults, or of the search
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub report: Format,
}
