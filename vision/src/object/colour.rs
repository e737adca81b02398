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

impl Bins {
    pub fn new() -> Self {
        let mut table = vec![0; 1 << (3 * BITS)].into_boxed_slice();
        for (at, entry) in table.iter_mut().enumerate() {
            let level = |shift: u32| coarse((at >> shift << (8 - BITS)) as u8);
            *entry = bin(level(2 * BITS), level(BITS), level(0));
        }
        Self { table }
    }

    #[inline]
    pub fn of(&self, red: u8, green: u8, blue: u8) -> usize {
        let level = |colour: u8| usize::from(colour >> (8 - BITS));
        usize::from(self.table[level(red) << (2 * BITS) | level(green) << BITS | level(blue)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hue_goes_around_and_saturation_and_brightness_up() {
        let split = |bin: u16| {
            let (rest, saturation) = (usize::from(bin) / SATURATIONS, usize::from(bin) % SATURATIONS);
            (rest / HUES, rest % HUES, saturation)
        };
        assert_eq!(split(bin(255, 0, 0)), (5, 0, 9));
        assert_eq!(split(bin(0, 100, 0)), (2, 33, 9));
        assert_eq!(split(bin(0, 0, 255)), (5, 66, 9));
        assert_eq!(split(bin(255, 0, 1)), (5, 99, 9));
        assert_eq!(split(bin(200, 200, 190)), (4, 16, 0));
        assert_eq!(split(bin(0, 0, 0)), (0, 0, 0));
        assert_eq!(split(bin(255, 255, 255)), (5, 0, 0));
    }

    #[test]
    fn every_colour_has_a_bin_and_the_table_is_close_to_it() {
        let bins = Bins::new();
        let (mut same, mut all) = (0, 0);
        for at in (0..1 << 24).step_by(97) {
            let (red, green, blue) = ((at >> 16) as u8, (at >> 8) as u8, at as u8);
            let exact = bin(red, green, blue);
            assert!(usize::from(exact) < BINS);
            let near = bins.of(red, green, blue) / SATURATIONS % HUES;
            let apart = near.abs_diff(usize::from(exact) / SATURATIONS % HUES);
            all += 1;
            same += u32::from(apart.min(HUES - apart) <= 2);
        }
        assert!(f64::from(same) / f64::from(all) > 0.95, "{same} of {all}");
    }
}
