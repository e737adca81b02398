//! Every setting, out of the rows of each sense.

use core::fmt;

use tenax_hal_shim::wire::SETTINGS_MAX;

use super::TABLES;
use crate::setting::{Row, SettingId};

const COUNT: usize = {
    let (mut count, mut table) = (0, 0);
    while table < TABLES.len() {
        count += TABLES[table].len();
        table += 1;
    }
    count
};
// Checked at compile time, not when the board starts.
const _: () = assert!(COUNT <= SETTINGS_MAX);

static ROWS: [Row; COUNT] = {
    let mut rows = [TABLES[0][0]; COUNT];
    let (mut count, mut table) = (0, 0);
    while table < TABLES.len() {
        let mut n = 0;
        while n < TABLES[table].len() {
            let row = TABLES[table][n];
            let mut place = count;
            while place > 0 && rows[place - 1].id.number() > row.id.number() {
                rows[place] = rows[place - 1];
                place -= 1;
            }
            rows[place] = row;
            count += 1;
            n += 1;
        }
        table += 1;
    }
    rows
};

impl SettingId {
    pub const ALL: [Self; COUNT] = {
        let mut all = [ROWS[0].id; COUNT];
        let mut n = 0;
        while n < COUNT {
            all[n] = ROWS[n].id;
            n += 1;
        }
        all
    };

    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|id| id.number() == number)
    }

    pub fn by_name(name: &str) -> Option<Self> {
        ROWS.iter().find(|row| row.name == name).map(|row| row.id)
    }

    pub fn row(self) -> &'static Row {
        // Every number has a row; the first stands in, so that nothing can panic.
        ROWS.iter().find(|row| row.id == self).unwrap_or(&ROWS[0])
    }
}

impl fmt::Debug for SettingId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use std::collections::HashSet;

    #[test]
    fn numbers_and_names_are_given_once_and_defaults_are_accepted() {
        let mut names = HashSet::new();
        for id in SettingId::ALL {
            let row = id.row();
            assert!(names.insert(row.name), "{}", row.name);
            assert!(row.range().contains(&row.default) && row.min < row.max, "{}", row.name);
            let unit = row.unit.replace(' ', "").to_lowercase();
            assert!(row.name.ends_with(&std::format!("-{unit}")), "{} in {}", row.name, row.unit);
            assert!(row.min >= 0 && row.max < 1 << 24, "{}: a record keeps 24 bits of it", row.name);
            assert_eq!(SettingId::from_number(id.number()), Some(id));
            assert_eq!(SettingId::by_name(row.name), Some(id));
        }
    }

    #[test]
    fn each_setting_comes_back_as_it_was_set_and_refuses_what_is_out_of_range() {
        for id in SettingId::ALL {
            let row = id.row();
            assert_eq!(Config::default().get(id), row.default, "{}", row.name);
            let steps = 1 + (row.max - row.min) / 997;
            for value in (row.min..=row.max).step_by(steps as usize).chain([row.max]) {
                let mut config = Config::default();
                assert_eq!(config.set(id, value), Ok(()));
                assert_eq!(config.get(id), value, "{}", row.name);
                for other in SettingId::ALL.into_iter().filter(|other| *other != id) {
                    assert_eq!(config.get(other), other.row().default, "{} moved {other:?}", row.name);
                }
            }
            for value in [i32::MIN, -1, row.min - 1, row.max + 1, i32::MAX] {
                let mut config = Config::default();
                assert_eq!(config.set(id, value), Err(row.min..=row.max), "{}", row.name);
                assert_eq!(config, Config::default());
            }
        }
    }
}
