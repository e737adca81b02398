//! Standard output, which may be closed by its reader, and standard error.

use std::fmt::Arguments;
use std::io::{self, Write};

/// The reader of standard output has closed it, as `| head -1` does: no message is printed for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("nobody reads the output any more")]
pub struct Closed;

#[macro_export]
macro_rules! say {
    ($($what:tt)*) => { $crate::tool::out::print(format_args!("{}\n", format_args!($($what)*))) };
}

/// Prints a line on standard error, if anybody reads it.
#[macro_export]
macro_rules! note {
    ($($what:tt)*) => { $crate::tool::out::print_error(format_args!($($what)*)) };
}

pub use crate::{note, say};

/// Prints on standard output. Fails with [`Closed`], or the error of the write.
pub fn print(what: Arguments) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_fmt(what).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Closed.into()),
        other => anyhow::Context::context(other, "cannot print"),
    }
}

/// For a command that goes on when its output is [`Closed`].
pub fn unless_closed(printed: anyhow::Result<()>) -> anyhow::Result<()> {
    match printed {
        Err(error) if error.is::<Closed>() => Ok(()),
        other => other,
    }
}

pub fn print_error(what: Arguments) {
    let _ = writeln!(io::stderr().lock(), "{what}");
}
