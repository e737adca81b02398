//! Limit of the force that warnings add without confirmation. A sliding object carries Ft = mu Fn, a held one
//! its weight.

use tenax_hal_shim::wire::Forces;

/// Growth of the load that a warning may cause: 1/2 of the load at its begin.
const GROWTH_PART: i32 = 2;
/// Growth of the load from which shear shows a held object: 1/8 of it, several times the hysteresis.
const SHOWS_PART: i32 = 8;
const HELD_PART: i64 = 4;

#[derive(Clone, Copy, Debug, Default)]
pub struct Asked(Option<At>);

#[derive(Clone, Copy, Debug)]
struct At {
    load_mn: i32,
    ft_mn: Option<i32>,
}

const fn at(forces: &Forces) -> At {
    At {
        load_mn: forces.load_mn,
        ft_mn: if forces.ratio_permille.is_some() { Some(forces.ft_mn) } else { None },
    }
}

impl Asked {
    pub fn begin(&mut self, forces: &Forces) {
        self.0.get_or_insert(at(forces));
    }

    /// Call it when slip is confirmed or another grasp begins: the next warning may add force again.
    pub const fn renew(&mut self) {
        self.0 = None;
    }

    /// True if the load exceeds 1.5 times that at `begin` by `on_top_mn`: the allowance is spent.
    pub fn in_vain(&self, forces: &Forces, on_top_mn: i32) -> bool {
        self.0.is_some_and(|began| forces.load_mn > began.load_mn + began.load_mn / GROWTH_PART + on_top_mn)
    }

    /// True if the load has grown by more than 1/8 and `on_top_mn`, and the shear by less than 1/4 of sliding.
    pub fn is_held(&self, forces: &Forces, on_top_mn: i32) -> bool {
        let (Some(began), now) = (self.0, at(forces)) else { return false };
        let (Some(began_mn), Some(now_mn)) = (began.ft_mn, now.ft_mn) else { return false };
        let grown_mn = now.load_mn - began.load_mn;
        // Forces are below 2^17 mN.
        grown_mn > began.load_mn / SHOWS_PART + on_top_mn
            && i64::from(now_mn - began_mn) * HELD_PART * i64::from(began.load_mn)
                < i64::from(began_mn) * i64::from(grown_mn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forces(load_mn: i32, ft_mn: i32) -> Forces {
        Forces {
            fn_mn: load_mn,
            fx_mn: ft_mn,
            fy_mn: 0,
            ft_mn,
            load_mn,
            ratio_permille: Some((ft_mn * 1_000 / load_mn) as u16),
        }
    }

    #[test]
    fn its_limits_are_a_half_an_eighth_and_a_quarter_of_what_sliding_would_carry() {
        let mut asked = Asked::default();
        let heavier = forces(9_000, 1_000);
        assert!(!asked.in_vain(&heavier, 0) && !asked.is_held(&heavier, 0), "it asked for nothing");
        asked.begin(&forces(4_000, 1_000));
        let unknown = Forces { ratio_permille: None, ..forces(4_600, 1_000) };
        assert!(!asked.is_held(&unknown, 0));
        assert_eq!([6_100, 6_101].map(|mn| asked.in_vain(&forces(mn, 1_000), 100)), [false, true]);
        assert_eq!([4_500, 4_501].map(|mn| asked.is_held(&forces(mn, 1_000), 0)), [false, true]);
        assert_eq!([4_600, 4_601].map(|mn| asked.is_held(&forces(mn, 1_000), 100)), [false, true]);
        // 1 N more of load is 0.25 N more of shear, if it slid.
        assert_eq!([1_062, 1_063].map(|ft_mn| asked.is_held(&forces(5_000, ft_mn), 0)), [true, false]);
        let mut heavy = Asked::default();
        heavy.begin(&forces(4_000, 4_000));
        assert_eq!([4_249, 4_250].map(|ft_mn| heavy.is_held(&forces(5_000, ft_mn), 0)), [true, false]);
    }
}
