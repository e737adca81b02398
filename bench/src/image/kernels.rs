//! What the symbol table of the kernels' image says.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::calls::Calls;
use super::symbols::{address_of, entry_and_return, entry_and_returns};

/// What a kernel's name begins with in the image.
pub const PREFIX: &str = "tenax_kernel_";

/// A function whose instructions are counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// Its name, without what all have in common.
    pub name: String,
    /// Its first instruction.
    pub entry: u64,
    /// The instructions that it returns to.
    pub after: Vec<u64>,
}

impl Kernel {
    /// Every function whose name begins with [`PREFIX`], by address.
    fn all(file: &File<'_>) -> Result<Vec<Self>> {
        let mut kernels = Vec::new();
        for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text) {
            if let Some(name) = symbol.name()?.strip_prefix(PREFIX) {
                let (entry, after) = entry_and_return(file, symbol.name()?)?;
                kernels.push(Self { name: name.to_owned(), entry, after: vec![after] });
            }
        }
        ensure!(!kernels.is_empty(), "has no function that begins with `{PREFIX}`");
        kernels.sort_by_key(|kernel| kernel.entry);
        Ok(kernels)
    }
}

/// Addresses in the image of a small camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureSymbols {
    /// The whole of a picture, and its parts.
    pub kernels: Vec<Kernel>,
    /// Where the core stands while the host uses its memory.
    pub next: u64,
    /// Where the addresses of the three planes are.
    pub planes: u64,
    /// When the picture was taken, and whether colours are learned.
    pub orders: u64,
    pub said: u64,
    /// Bytes of the heap that are in use.
    pub heap: u64,
    /// RAM above the image's variables.
    pub stack: Range<u64>,
    /// Bytes of variables.
    pub variables: u64,
}

impl PictureSymbols {
    /// Parts of a picture, as they are called and as their mangled names end.
    const PARTS: [(&str, &str); 3] =
        [("markers", "7Markers6follow"), ("object", "7Tracker4step"), ("moves", "6motion4flow")];

    /// Reads them from an ELF file. Fails if it is not that image.
    pub fn read(elf: &Path) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
        let file = File::parse(&*bytes).context("not an ELF file")?;
        let mut kernels = Kernel::all(&file)?;
        for (name, mangled) in Self::PARTS {
            let names = || file.symbols().filter_map(|symbol| symbol.name().ok());
            let symbol = names().find(|symbol| symbol.contains(mangled)).context(mangled)?;
            let (entry, after) = entry_and_returns(&file, symbol)?;
            kernels.push(Kernel { name: name.to_owned(), entry, after });
        }
        let stack = address_of(&file, "__sheap")?..address_of(&file, "_stack_start")?;
        Ok(Self {
            kernels,
            next: address_of(&file, "tenax_kernels_next")? & !1,
            planes: address_of(&file, "TENAX_KERNELS_PLANES")?,
            orders: address_of(&file, "TENAX_KERNELS_ORDERS")?,
            said: address_of(&file, "TENAX_KERNELS_SAID")?,
            heap: address_of(&file, "TENAX_KERNELS_HEAP")?,
            variables: stack.start - (stack.end & !0xFF_FFFF),
            stack,
        })
    }
}

/// The kernels whose state and constants the image tells, in its order.
const TOLD: [&str; 12] = [
    "films",
    "gauges",
    "force",
    "s1",
    "s2",
    "hebbian",
    "slow_frame",
    "loudness",
    "features",
    "logistic_112",
    "logistic_76",
    "ratio",
];

/// What a kernel takes of the memories.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Its code and all that it calls: functions, each with its bytes. Two kernels may share one.
    pub code: BTreeMap<String, u64>,
    /// Constants in flash, bytes.
    pub constants: u64,
    /// State in RAM, bytes.
    pub state: u64,
}

/// What each kernel takes whose state the image tells. Fails if it is not the frames' image.
pub fn memories(elf: &Path) -> Result<BTreeMap<&'static str, Memory>> {
    let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
    let file = File::parse(&*bytes).context("not an ELF file")?;
    let calls = Calls::of(&file)?;
    let table = file.symbol_by_name("TENAX_KERNELS_BYTES").context("has no symbol `TENAX_KERNELS_BYTES`")?;
    let section = file.section_by_index(table.section_index().context("has no place")?)?;
    let at = (table.address() - section.address()) as usize;
    let words = section.data()?.get(at..at + 8 * TOLD.len()).context("is too short")?.as_chunks::<4>().0;
    let word = |n: usize| words.get(n).map_or(0, |word| u64::from(u32::from_le_bytes(*word)));
    let memory = |(n, name): (usize, &&'static str)| {
        let reached = calls.reached(&calls.named(|own| own == format!("{PREFIX}{name}")));
        let code = reached.keys().map(|&place| (calls.0[place].name.clone(), calls.0[place].bytes)).collect();
        (*name, Memory { code, state: word(2 * n), constants: word(2 * n + 1) })
    };
    Ok(TOLD.iter().enumerate().map(memory).collect())
}

/// Addresses in the kernels' image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelSymbols {
    /// The kernels, by address.
    pub kernels: Vec<Kernel>,
    /// Where the core stands while the host uses the mailbox.
    pub next: u64,
    /// What the core is to do with the reading.
    pub orders: u64,
    /// The reading: ten half-words.
    pub reading: u64,
    /// A frame: fourteen half-words, and whether there is one. Of the frames' image alone.
    pub frame: Option<[u64; 2]>,
    /// The answer: its features, a half-word each.
    pub features: u64,
    pub logit: u64,
    /// Whether there is a logit.
    pub judged: u64,
    pub verdict: u64,
}

impl KernelSymbols {
    /// Reads them from an ELF file. Fails if it is not the kernels' image, or a kernel is called from more than one place.
    pub fn read(elf: &Path) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
        Self::parse(&bytes).with_context(|| format!("the kernels' image {}", elf.display()))
    }

    fn parse(elf: &[u8]) -> Result<Self> {
        let file = File::parse(elf).context("not an ELF file")?;
        Ok(Self {
            kernels: Kernel::all(&file)?,
            next: address_of(&file, "tenax_kernels_next")? & !1,
            orders: address_of(&file, "TENAX_KERNELS_ORDERS")?,
            reading: address_of(&file, "TENAX_KERNELS_READING")?,
            frame: match ["TENAX_KERNELS_FRAME", "TENAX_KERNELS_COMES"].map(|name| address_of(&file, name)) {
                [Ok(frame), Ok(comes)] => Some([frame, comes]),
                _ => None,
            },
            features: address_of(&file, "TENAX_KERNELS_FEATURES")?,
            logit: address_of(&file, "TENAX_KERNELS_LOGIT")?,
            judged: address_of(&file, "TENAX_KERNELS_JUDGED")?,
            verdict: address_of(&file, "TENAX_KERNELS_VERDICT")?,
        })
    }
}
