//! The CRC of everything that is kept, in one table: CRC-32 as on the wire (ISO-HDLC).

use crc::{CRC_32_ISO_HDLC, Crc};

pub(crate) static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
