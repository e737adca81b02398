//! Input of a behaviour: slip, load, and the skin's cells: the camera's markers, or the taxels without it.

use tenax_hal_shim::behaviour::{CameraView, MARKERS, NORMAL_STEP_MN, SHEAR_STEP_MN, UNTRACKED};

use crate::array::{ELEMENTS, Reading};
use crate::grip::Grip;

/// 200 mV/N (`docs/hardware.md`): a sample is about 1 mN.
const TAXEL_SAMPLES_PER_N: i32 = 993;
/// Scores of a cell's normal force, mN: noise, sufficient, medium, large (FingerVision 2017, section II-A).
const SCORES: [(i32, u16); 3] = [(300, 5), (100, 3), (30, 1)];
const CHANGE_MN: i32 = 60;
/// Shear of all markers together that is a pull, mN: three times its noise.
const PULL_MN: i32 = 250;

#[derive(Clone, Copy, Debug)]
pub struct Felt<'a> {
    pub view: Option<&'a CameraView>,
    pub view_is_new: bool,
    pub cycle_is_over: bool,
    pub taxels: &'a Reading,
    pub grip: Grip,
    pub slips: bool,
    pub stirs: bool,
}

/// Readings at the behaviour's begin, mN for markers, 14-bit samples for taxels.
#[derive(Clone, Copy, Debug)]
pub enum Skin {
    Markers { normal_mn: [Option<i16>; MARKERS], shear_mn: [i16; MARKERS] },
    Taxels([Option<u16>; ELEMENTS]),
}

impl Skin {
    pub fn now(felt: &Felt<'_>) -> Option<Self> {
        if let Some(view) = felt.view {
            return Some(Self::Markers {
                normal_mn: core::array::from_fn(|n| normal_mn(view, n)),
                shear_mn: core::array::from_fn(|n| shear_mn(view, n)),
            });
        }
        felt.taxels.iter().any(Option::is_some).then_some(Self::Taxels(*felt.taxels))
    }

    pub fn score(&self, felt: &Felt<'_>) -> Option<u16> {
        match (self, felt.view) {
            (Self::Markers { .. }, Some(view)) => {
                Some((0..MARKERS).filter_map(|n| normal_mn(view, n)).map(|mn| score(mn.into())).sum())
            }
            (Self::Markers { .. }, None) => None,
            (Self::Taxels(first), _) => sum_over(first, felt.taxels, score),
        }
    }

    pub fn is_pulled(&self, felt: &Felt<'_>) -> bool {
        let (Self::Markers { normal_mn: normals, shear_mn: shears }, Some(view)) = (self, felt.view) else {
            return false;
        };
        let sheared = |n: usize| {
            normals[n].and(normal_mn(view, n))?;
            Some(i32::from(shear_mn(view, n)) - i32::from(shears[n]))
        };
        (0..MARKERS).filter_map(sheared).sum::<i32>().abs() > PULL_MN
    }

    /// Cells whose force differs from the first (section II-C). None without readings of that skin.
    pub fn changed(&self, felt: &Felt<'_>) -> Option<u16> {
        match (self, felt.view) {
            (Self::Markers { normal_mn: normals, shear_mn: shears }, Some(view)) => {
                let changed = |n: usize| {
                    let (was, is) = (i32::from(normals[n]?), i32::from(normal_mn(view, n)?));
                    let sheared = i32::from(shear_mn(view, n)) - i32::from(shears[n]);
                    Some(u16::from(differs(was, is - was) || differs(was, sheared)))
                };
                Some((0..MARKERS).filter_map(changed).sum())
            }
            (Self::Markers { .. }, None) => None,
            (Self::Taxels(first), _) => sum_over(first, felt.taxels, |mn| differs(0, mn).into())
                .map(|changed| changed * (MARKERS / ELEMENTS) as u16),
        }
    }
}

impl Felt<'_> {
    pub const fn skin_is_new(&self) -> bool {
        self.view_is_new || self.cycle_is_over
    }

    pub fn is_moving(&self, moving_e4: u16, sensitively: bool) -> bool {
        let least = if sensitively { moving_e4 / 2 } else { moving_e4 };
        self.view.is_some_and(|view| view.moving_e4 > least)
    }
}

/// Sums of normal force and shear, mN.
#[inline(never)]
pub fn skin_mn(view: &CameraView) -> [i32; 2] {
    let of = |n: usize| normal_mn(view, n).map(|mn| [i32::from(mn), shear_mn(view, n).into()]);
    (0..MARKERS).filter_map(of).fold([0, 0], |sum, of| [sum[0] + of[0], sum[1] + of[1]])
}

fn normal_mn(view: &CameraView, n: usize) -> Option<i16> {
    let steps = *view.normal.get(n)?;
    (steps != UNTRACKED).then_some(i16::from(steps) * NORMAL_STEP_MN as i16)
}

fn shear_mn(view: &CameraView, n: usize) -> i16 {
    view.shear.get(n).map_or(0, |&steps| i16::from(steps) * SHEAR_STEP_MN as i16)
}

/// Sum of a measure of each taxel's change, mN; None if no taxel is known.
fn sum_over(first: &Reading, now: &Reading, measure: impl Fn(i32) -> u16) -> Option<u16> {
    let change = |(was, is): (&Option<u16>, &Option<u16>)| Some(i32::from((*is)?) - i32::from((*was)?));
    let mut known = first.iter().zip(now).filter_map(change).peekable();
    known.peek()?;
    Some(known.map(|samples| measure(samples * 1_000 / TAXEL_SAMPLES_PER_N)).sum())
}

const fn differs(was_mn: i32, by_mn: i32) -> bool {
    by_mn.abs() > CHANGE_MN && by_mn.abs() > was_mn / 4
}

fn score(mn: i32) -> u16 {
    SCORES.iter().find(|(from_mn, _)| mn >= *from_mn).map_or(0, |&(_, score)| score)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(normal: u8, shear: i8) -> CameraView {
        CameraView {
            age_ms: 0,
            moving_e4: 0,
            angle_ddeg: None,
            normal: [normal; MARKERS],
            shear: [shear; MARKERS],
        }
    }

    fn felt<'a>(view: Option<&'a CameraView>, taxels: &'a Reading) -> Felt<'a> {
        Felt {
            view,
            view_is_new: true,
            cycle_is_over: true,
            taxels,
            grip: Grip::Unknown,
            slips: false,
            stirs: false,
        }
    }

    #[test]
    fn markers_count_while_the_camera_sees_and_taxels_while_it_does_not() {
        let (light, none) = (view(3, 0), [None; ELEMENTS]);
        let skin = Skin::now(&felt(Some(&light), &none)).expect("markers");
        assert_eq!(skin.score(&felt(Some(&light), &none)), Some(MARKERS as u16));
        assert_eq!(skin.score(&felt(None, &none)), None, "a camera that went silent is no zero");
        assert!(Skin::now(&felt(None, &none)).is_none());

        let (rest, pressed) = ([Some(2_000); ELEMENTS], [Some(2_110); ELEMENTS]);
        let skin = Skin::now(&felt(None, &rest)).expect("taxels");
        assert_eq!(skin.score(&felt(None, &rest)), Some(0));
        assert_eq!([0, 29, 30, 99, 100, 299, 300, 2_000].map(score), [0, 0, 1, 1, 3, 3, 5, 5]);
        assert_eq!(skin.score(&felt(None, &pressed)), Some(3 * ELEMENTS as u16));
        assert_eq!(skin.score(&felt(None, &none)), None);
    }

    #[test]
    fn a_pull_changes_markers_and_a_lost_marker_changes_none() {
        let (before, pulled) = (view(20, 0), view(20, 10));
        let none = [None; ELEMENTS];
        let skin = Skin::now(&felt(Some(&before), &none)).expect("markers");
        assert_eq!(skin.changed(&felt(Some(&before), &none)), Some(0));
        assert_eq!(skin.changed(&felt(Some(&pulled), &none)), Some(MARKERS as u16));
        let lost = CameraView { normal: [UNTRACKED; MARKERS], ..pulled };
        assert_eq!(skin.changed(&felt(Some(&lost), &none)), Some(0));
        assert!(!skin.is_pulled(&felt(Some(&lost), &none)));
        let gently = view(20, 1);
        assert_eq!(skin.changed(&felt(Some(&gently), &none)), Some(0), "too little for each");
        assert!(skin.is_pulled(&felt(Some(&gently), &none)) && !skin.is_pulled(&felt(Some(&before), &none)));
    }
}
