//! A flash that only clears bits, fails over what is not blank, and loses its power at any operation.

use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};

/// State of an operation when the power goes.
#[derive(Clone, Copy, Debug)]
pub enum Harm {
    Nothing,
    /// Complete, but not reported.
    Everything,
    /// A word's bits in this mask were not programmed yet; the words of an erased sector still have their zeros in it.
    Bits(u32),
    /// A word as above; every word of an erased sector reads something else.
    Noise(u32),
    /// These bits read as programmed at times; the other bits all are (true) or none is.
    Marginal(u32, bool),
}

pub const HARMS: [Harm; 6] = [
    Harm::Nothing,
    Harm::Everything,
    Harm::Bits(0xFFFF_0000),
    Harm::Bits(0x5555_5555),
    Harm::Bits(0x0000_0001),
    Harm::Noise(0x9E37_79B9),
];

#[derive(Clone, Debug)]
pub struct TestFlash {
    pub words: [Vec<u32>; 2],
    weak: Vec<(Sector, usize, u32)>,
    pub weak_reads_programmed: bool,
    /// Operations until the power goes, and the harm to the last one.
    pub cut: Option<(usize, Harm)>,
    pub dead: bool,
    pub worn: bool,
    pub operations: usize,
    pub erases: [usize; 2],
}

impl TestFlash {
    pub fn blank(sector_words: usize) -> Self {
        Self::holding([vec![BLANK; sector_words], vec![BLANK; sector_words]])
    }

    pub fn holding(words: [Vec<u32>; 2]) -> Self {
        Self {
            words,
            weak: Vec::new(),
            weak_reads_programmed: false,
            cut: None,
            dead: false,
            worn: false,
            operations: 0,
            erases: [0; 2],
        }
    }

    pub fn power_up(&mut self) {
        self.cut = None;
        self.dead = false;
    }

    fn begin(&mut self) -> Result<Option<Harm>, FlashFailed> {
        assert!(!self.dead, "nothing runs without power");
        self.operations += 1;
        match &mut self.cut {
            None => Ok(None),
            Some((0, harm)) => {
                self.dead = true;
                Ok(Some(*harm))
            }
            Some((left, _)) => {
                *left -= 1;
                Ok(None)
            }
        }
    }
}

impl FlashArea for TestFlash {
    fn sector_words(&self) -> usize {
        self.words[0].len()
    }

    fn read(&self, sector: Sector, word: usize) -> u32 {
        let bits = self.words[sector as usize].get(word).copied().unwrap_or(BLANK);
        let weak = self.weak.iter().filter(|weak| (weak.0, weak.1) == (sector, word)).map(|weak| weak.2);
        weak.fold(bits, |bits, mask| if self.weak_reads_programmed { bits & !mask } else { bits | mask })
    }

    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
        let harm = self.begin()?;
        assert_eq!(self.read(sector, word), BLANK, "{sector:?} {word} is programmed twice");
        let cell = self.words[sector as usize].get_mut(word).expect("a word of the sector");
        // A weak bit that is programmed is weak no more.
        for (_, _, mask) in self.weak.iter_mut().filter(|weak| (weak.0, weak.1) == (sector, word)) {
            *mask &= value;
        }
        *cell = match harm {
            None | Some(Harm::Everything) => value,
            Some(Harm::Nothing) => BLANK,
            Some(Harm::Bits(mask) | Harm::Noise(mask)) => value | mask,
            Some(Harm::Marginal(mask, others)) => {
                self.weak.push((sector, word, mask & !value));
                if others { value | mask } else { BLANK }
            }
        };
        if harm.is_some() { Err(FlashFailed) } else { Ok(()) }
    }

    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed> {
        let harm = self.begin()?;
        if self.worn {
            return Err(FlashFailed);
        }
        self.erases[sector as usize] += 1;
        self.weak.retain(|weak| weak.0 != sector);
        for (n, word) in self.words[sector as usize].iter_mut().enumerate() {
            *word = match harm {
                None | Some(Harm::Everything) => BLANK,
                Some(Harm::Nothing | Harm::Marginal(..)) => *word,
                Some(Harm::Bits(mask)) => *word | !mask,
                Some(Harm::Noise(seed)) => seed.wrapping_mul(2 * n as u32 + 1).rotate_left(n as u32),
            };
        }
        if harm.is_some() { Err(FlashFailed) } else { Ok(()) }
    }
}
