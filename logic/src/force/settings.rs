use crate::setting::settings;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrictionConfig {
    pub s2_permille: u16,
    pub s2_of_mu_s_permille: u16,
    pub loaded_mn: i32,
}

settings! {
    FrictionConfig:
    /// S2: threshold of Ft/Fn above which it warns, until a stroke measures it
    2 S2 "s2-permille" "per mille" [150, 1_500] = 300 => Number(s2_permille);
    /// S2 from a stroke or grasp: this part of the friction that was measured
    9 S2OfMuS "s2-of-mu-s-permille" "per mille" [300, 950] = 800 => Number(s2_of_mu_s_permille);
    /// Normal force from which the finger counts as loaded
    10 Loaded "loaded-mn" "mN" [300, 2_000] = 300 => Number(loaded_mn);
}
