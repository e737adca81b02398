//! Worlds that nobody chose: ten families of scenes, drawn from [`ranges`] by family, seed and index.
//!
//! A world is the text of a scene file: the wearer grasps an object, lifts it, and something happens within 6 s. Seeds 1 to 999 are
//! for choosing a reflex, others for scoring it.

mod page;
pub mod ranges;

use std::str::FromStr;

use tenax_hal_shim::named;

use self::page::{HAPPENS_S, Page};
use crate::file::{SceneError, SceneFile};

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Family {
        QuietHold = "quiet-hold",
        DisturbedHold = "disturbed-hold",
        Splash = "splash",
        Condensation = "condensation",
        Pour = "pour",
        DropInAndTug = "drop-in-and-tug",
        WalkAndSwing = "walk-and-swing",
        FragileAndSlippery = "fragile-and-slippery",
        OffCentre = "off-centre",
        WearersWill = "wearers-will",
    }
}

impl FromStr for Family {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|family| family.name() == name);
        found.ok_or_else(|| format!("no family; there are {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// A world as a scene file, and the seed of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    pub family: Family,
    pub index: u32,
    pub text: String,
    pub noise_seed: u64,
}

impl Drawn {
    pub fn new(family: Family, seed: u64, index: u32) -> Self {
        let noise_seed = mixed(mixed(mixed(seed) ^ family as u64) ^ u64::from(index)) >> 16;
        Self::on(Page::new(noise_seed, HAPPENS_S), family, seed, index, |page| page.world(family))
    }

    /// An object that is held for so many minutes, with everyday disturbances all along.
    pub fn hold(seed: u64, index: u32, minutes: u32) -> Self {
        let noise_seed = mixed(mixed(!seed) ^ u64::from(index)) >> 16;
        let page = Page::new(noise_seed, 60.0 * f64::from(minutes));
        Self::on(page, Family::DisturbedHold, seed, index, |page| page.day(minutes))
    }

    fn on(mut page: Page, family: Family, seed: u64, index: u32, draw: impl FnOnce(&mut Page)) -> Self {
        let (noise_seed, name) = (page.seed, family.name());
        page.put(format_args!(
            "# World {index} of {name}, drawn from seed {seed}. Its noise: --seed {noise_seed}"
        ));
        draw(&mut page);
        Self { family, index, text: page.text, noise_seed }
    }

    /// Fails only if a range leads out of what a scene file may say.
    pub fn scene(&self) -> Result<SceneFile, SceneError> {
        SceneFile::parse(&self.text, &format!("{} {}", self.family.name(), self.index))
    }
}

/// World `n` of a sweep: of one family, or of each in turn.
pub fn nth(family: Option<Family>, seed: u64, n: u32) -> Drawn {
    const COUNT: u32 = Family::ALL.len() as u32;
    match family {
        Some(family) => Drawn::new(family, seed, n),
        None => Drawn::new(Family::ALL[(n % COUNT) as usize], seed, n / COUNT),
    }
}

/// Steele's SplitMix64: neighbouring numbers become unlike ones.
const fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
