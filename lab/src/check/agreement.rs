//! The image and the host's build of the logic, given the same codes, say the same, bit for bit.

use super::Bar;
use tenax_sim::board::Run;
use tenax_sim::board::agreement::Agreement;

/// The bar for a run on the emulated board.
pub fn bar(run: &Run) -> Bar {
    let agreement = Agreement::of(run);
    Bar::new(
        "image = host logic, bit for bit, every detector output and command",
        agreement.to_string(),
        agreement.holds(),
    )
}
