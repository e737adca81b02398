//! How a CSV file becomes labelled recordings of the array (`docs/array.md`).

use serde::Deserialize;
use tenax_hal_shim::channel::ARRAY_COUNT;
use toml::Spanned;

use crate::recipe::{self, Checked, Kind};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArrayRecipe {
    pub title: String,
    pub description: String,
    /// Names of the files that it is taken for when no recipe is given; `*` and `?` match as in a shell.
    #[serde(default)]
    pub applies_to: Vec<Spanned<String>>,
    pub array: Array,
    #[serde(default)]
    pub recordings: Recordings,
    pub labels: Labels,
    #[serde(default)]
    pub features: Features,
}

/// The array's columns and how their numbers become 14-bit samples.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Array {
    pub columns: Spanned<Vec<String>>,
    /// 14-bit samples for one unit of the columns.
    #[serde(default = "recipe::one")]
    pub scale: Spanned<f64>,
    #[serde(default)]
    pub offset: f64,
    pub rate_hz: Option<Spanned<f64>>,
    /// The column that holds the time in seconds. Either this or `rate_hz`.
    pub time: Option<String>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recordings {
    pub name: Option<String>,
    pub session: Option<String>,
    pub material: Option<String>,
    pub task: Option<String>,
    /// `train`, `validation` or `test`. Default: sessions are left out in turn.
    pub part: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Labels {
    pub column: String,
    pub slip: Spanned<Vec<String>>,
    /// The column with exact onsets (`docs/array.md`). A file may lack it: then slips are made of the labels.
    pub onsets: Option<String>,
    pub no_slip: Spanned<Vec<String>>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Features {
    /// A difference is to the reading so many slow frames before (the paper: 1).
    pub lag: Option<Spanned<u8>>,
    /// Differences in the covariance (the paper: 10).
    pub window: Option<Spanned<u8>>,
    /// Covariance below which a feature is straight, samples^2.
    pub covariance_knee: Option<u32>,
    /// Power of a spectral bin below which a feature is straight, samples^2.
    pub spectrum_knee: Option<u32>,
    /// A frame of a structure function below which a feature is straight, samples^2 times ten.
    pub structure_knee: Option<u32>,
}

impl Kind for ArrayRecipe {
    const BUILTIN: &'static [(&'static str, &'static str)] = &[
        ("array", include_str!("../../recipes/array.toml")),
        ("biotac", include_str!("../../recipes/biotac.toml")),
    ];

    fn applies_to(&self) -> &[Spanned<String>] {
        &self.applies_to
    }

    fn check(&self) -> Checked {
        recipe::check_patterns(&self.applies_to)?;
        self.array.check()?;
        self.labels.check()?;
        for (name, frames) in [("lag", &self.features.lag), ("window", &self.features.window)] {
            recipe::if_within(frames, name, 1, 40)?;
        }
        Ok(())
    }
}

impl Array {
    fn check(&self) -> Checked {
        let columns = self.columns.get_ref();
        if columns.len() != ARRAY_COUNT {
            let what = format!("{} columns; the array has {ARRAY_COUNT} elements", columns.len());
            return Err((self.columns.span(), what));
        }
        if let Some(twice) =
            columns.iter().enumerate().find_map(|(n, c)| columns[..n].contains(c).then_some(c))
        {
            return Err((self.columns.span(), format!("column `{twice}` is given twice")));
        }
        recipe::check_scale(&self.scale)?;
        match (&self.rate_hz, &self.time) {
            (rate, None) if rate.is_some() => recipe::if_within(rate, "rate_hz", 1.0, 100_000.0),
            (None, Some(_)) => Ok(()),
            (Some(rate), Some(_)) => Err((rate.span(), "give either rate_hz or time, not both".into())),
            (None | Some(_), None) => {
                let what = "either rate_hz (rows a second) or time (a column in seconds) is needed";
                Err((self.columns.span(), what.into()))
            }
        }
    }
}

impl Labels {
    /// Fails if the recipe does not know the label.
    pub fn is_slip(&self, label: &str) -> Result<bool, String> {
        let means = |values: &Spanned<Vec<String>>| values.get_ref().iter().any(|value| value == label);
        let slip = means(&self.slip);
        if slip || means(&self.no_slip) {
            return Ok(slip);
        }
        let [slip, none] = [&self.slip, &self.no_slip].map(|values| values.get_ref().join(", "));
        Err(format!(
            "column `{}` is `{label}`; the recipe knows {slip} (slip) and {none} (none)",
            self.column
        ))
    }

    fn check(&self) -> Checked {
        for (name, values) in [("slip", &self.slip), ("no_slip", &self.no_slip)] {
            if values.get_ref().is_empty() {
                let what = format!("{name} needs at least one value of the label's column");
                return Err((values.span(), what));
            }
        }
        match self.slip.get_ref().iter().find(|value| self.no_slip.get_ref().contains(value)) {
            Some(both) => Err((self.no_slip.span(), format!("`{both}` is in slip and in no_slip"))),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "\
title = 't'
description = 'd'
[array]
columns = ['a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j']
rate_hz = 80
[labels]
column = 'label'
slip = ['1']
no_slip = ['0']
";

    fn mistake(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from));
        ArrayRecipe::parse(&GOOD.replace(from, to), "r.toml").unwrap_err().to_string()
    }

    #[test]
    fn mistakes_are_answered_with_their_line() {
        for (from, to, line, says) in [
            ("'j']", "]", 4, "9 columns"),
            ("'j']", "'a']", 4, "`a` is given twice"),
            ("rate_hz = 80", "rate_hz = 0.1", 5, "1 to 100000"),
            ("rate_hz = 80", "rate_hz = 80\ntime = 't'", 5, "not both"),
            ("rate_hz = 80\n", "", 4, "rate_hz"),
            ("rate_hz = 80", "rate = 80", 5, "unknown field"),
            ("slip = ['1']", "slip = []", 8, "at least one"),
            ("no_slip = ['0']", "no_slip = ['1']", 9, "in slip and in no_slip"),
            ("no_slip = ['0']", "no_slip = ['0']\n[features]\nlag = 41", 11, "1 to 40"),
            ("rate_hz = 80", "rate_hz = 80\nscale = 0", 6, "other than 0"),
        ] {
            let said = mistake(from, to);
            assert!(said.starts_with(&format!("r.toml:{line}: ")) && said.contains(says), "{to}: {said}");
        }
    }
}
