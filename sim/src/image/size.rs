//! What an image takes of the chip's memories.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection, SectionFlags, SectionKind, elf};

/// Flash for an image, bytes: all but the last two sectors, which outlive it.
pub const FLASH_BYTES: u64 = 256 * 1024;
pub const RAM_BYTES: u64 = 128 * 1024;

/// Bytes that an image takes before it runs, without its stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    pub flash: u64,
    pub ram: u64,
}

impl Size {
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("reading the image {}", path.display()))?;
        let file = File::parse(&*bytes).with_context(|| format!("{} is not an ELF file", path.display()))?;
        let mut size = Self::default();
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
            let is = |flag| sh_flags & u64::from(flag) != 0;
            let bytes = if is(elf::SHF_ALLOC) { section.size() } else { 0 };
            // Variables with first values are in both.
            size.ram += if is(elf::SHF_WRITE) { bytes } else { 0 };
            size.flash += if section.kind() == SectionKind::UninitializedData { 0 } else { bytes };
        }
        ensure!(size.flash > 0, "{} has nothing to flash", path.display());
        Ok(size)
    }
}
