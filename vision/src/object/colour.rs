//! Hue and saturation in 100 x 10 bins (FingerVision 2017, section III B), and six steps of brightness.

pub const HUES: usize = 100;
pub const SATURATIONS: usize = 10;
/// Steps of brightness, each with its own bins: a grey card and a white wall differ in nothing else. 1 is the paper's.
pub const VALUES: usize = 6;
pub const BINS: usize = VALUES * HUES * SATURATIONS;
/// Bits of each colour that the table looks at: with 5 the hue of a nearly grey card falls into bins at random.
const BITS: u32 = 6;

pub fn bin(red: u8, green: u8, blue: u8) -> u16 {
    let (red, green, blue) = (i32::from(red), i32::from(green), i32::from(blue));
    let (value, least) = (red.max(green).max(blue), red.min(green).min(blue));
    let chroma = value - least;
    let step = value as usize * VALUES / 256 * HUES * SATURATIONS;
    if chroma == 0 {
        return step as u16;
    }
    // Sixths of a turn, in units of chroma.
    let (sixth, towards) = match value {
        _ if value == red => (0, green - blue),
        _ if value == green => (2, blue - red),
        _ => (4, red - green),
    };
    let hue = ((sixth * chroma + towards + 6 * chroma) % (6 * chroma)) * HUES as i32 / (6 * chroma);
    let saturation = chroma * SATURATIONS as i32 / (value + 1);
    (step + hue as usize * SATURATIONS + saturation as usize) as u16
}

const fn coarse(level: u8) -> u8 {
    level >> (8 - BITS) << (8 - BITS) | 1 << (7 - BITS)
}

#[derive(Clone, Debug)]
pub struct Bins {
    table: Box<[u16]>,
}

impl Default for Bins {
    fn default() -> Self {
        let mut table = vec![0; 1 << (3 * BITS)].into_boxed_slice();
        for (at, entry) in table.iter_mut().enumerate() {
            let level = |shift: u32| coarse((at >> shift << (8 - BITS)) as u8);
            *entry = bin(level(2 * BITS), level(BITS), level(0));
        }
        Self { table }
    }
}

impl Bins {
    #[inline]
    pub fn of(&self, [red, green, blue]: [u8; 3]) -> usize {
        let level = |colour: u8| usize::from(colour >> (8 - BITS));
        usize::from(self.table[level(red) << (2 * BITS) | level(green) << BITS | level(blue)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hue_goes_around_and_saturation_and_brightness_up() {
        for (red, green, blue, split) in [
            (255, 0, 0, (5, 0, 9)),
            (0, 100, 0, (2, 33, 9)),
            (0, 0, 255, (5, 66, 9)),
            (255, 0, 1, (5, 99, 9)),
            (200, 200, 190, (4, 16, 0)),
            (0, 0, 0, (0, 0, 0)),
            (255, 255, 255, (5, 0, 0)),
        ] {
            let bin = usize::from(bin(red, green, blue));
            assert_eq!((bin / SATURATIONS / HUES, bin / SATURATIONS % HUES, bin % SATURATIONS), split);
        }
    }

    #[test]
    fn the_table_s_hue_is_nearly_that_of_the_colour() {
        let bins = Bins::default();
        let colours = || (0..1u32 << 24).step_by(97).map(|at| [(at >> 16) as u8, (at >> 8) as u8, at as u8]);
        let is_near = |&[red, green, blue]: &[u8; 3]| {
            let [exact, near] = [bin(red, green, blue).into(), bins.of([red, green, blue])]
                .map(|bin: usize| bin / SATURATIONS % HUES);
            let apart = near.abs_diff(exact);
            apart.min(HUES - apart) <= 2
        };
        assert!(colours().filter(is_near).count() * 100 > colours().count() * 95);
    }
}
