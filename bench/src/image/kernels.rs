//! What the symbol table of the kernels' image says.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSymbol, SymbolKind};

use super::symbols::{address_of, entry_and_return};

/// What a kernel's name begins with in the image.
const KERNEL: &str = "tenax_kernel_";

/// A function whose instructions are counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// Its name, without what all have in common.
    pub name: String,
    /// Its first instruction.
    pub entry: u64,
    /// The instruction that it returns to.
    pub after: u64,
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
    /// The answer: its features, a half-word each.
    pub features: u64,
    /// The answer's logit.
    pub logit: u64,
    /// Whether there is a logit.
    pub judged: u64,
    /// The answer's verdict.
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
        let mut kernels = Vec::new();
        for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text) {
            if let Some(name) = symbol.name()?.strip_prefix(KERNEL) {
                let (entry, after) = entry_and_return(&file, symbol.name()?)?;
                kernels.push(Kernel { name: name.to_owned(), entry, after });
            }
        }
        ensure!(!kernels.is_empty(), "has no function that begins with `{KERNEL}`");
        kernels.sort_by_key(|kernel| kernel.entry);
        Ok(Self {
            kernels,
            next: address_of(&file, "tenax_kernels_next")? & !1,
            orders: address_of(&file, "TENAX_KERNELS_ORDERS")?,
            reading: address_of(&file, "TENAX_KERNELS_READING")?,
            features: address_of(&file, "TENAX_KERNELS_FEATURES")?,
            logit: address_of(&file, "TENAX_KERNELS_LOGIT")?,
            judged: address_of(&file, "TENAX_KERNELS_JUDGED")?,
            verdict: address_of(&file, "TENAX_KERNELS_VERDICT")?,
        })
    }
}
