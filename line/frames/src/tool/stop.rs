//! Signals that end a command in order.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use anyhow::Context;
use signal_hook::consts::TERM_SIGNALS;
use signal_hook::flag;

/// True from the first Ctrl-C, request to end or hang-up on. The second ends the process at once, with exit code 1.
pub fn on_signals() -> anyhow::Result<Arc<AtomicBool>> {
    let stopped = Arc::<AtomicBool>::default();
    let signals = TERM_SIGNALS.iter().copied();
    #[cfg(unix)]
    let signals = signals.chain([signal_hook::consts::SIGHUP]);
    for signal in signals {
        flag::register_conditional_shutdown(signal, 1, Arc::clone(&stopped))
            .and_then(|_| flag::register(signal, Arc::clone(&stopped)))
            .context("cannot listen for signals")?;
    }
    Ok(stopped)
}
