//! What is printed, and who may stop reading it.

use std::fmt::Arguments;
use std::io::{self, Write};

/// Nobody reads standard output any more, as behind `| head -1`. That is no error of ours, so nothing is said of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("nobody reads the output any more")]
pub struct Closed;

/// Prints a line on standard output.
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

/// Prints on standard output.
///
/// # Errors
/// [`Closed`], or what went wrong.
pub fn print(what: Arguments) -> anyhow::Result<()> {
    print_to(&mut io::stdout().lock(), what)
}

/// For what goes on, and gives its verdict as the exit code, whether anybody reads or not.
/// An error says what went wrong, unless it is that the output is [`Closed`].
pub fn unless_closed(printed: anyhow::Result<()>) -> anyhow::Result<()> {
    match printed {
        Err(error) if error.is::<Closed>() => Ok(()),
        other => other,
    }
}

fn print_to(out: &mut dyn Write, what: Arguments) -> anyhow::Result<()> {
    match out.write_fmt(what).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Closed.into()),
        other => Ok(other?),
    }
}

/// Prints a line on standard error.
pub fn print_error(what: Arguments) {
    // Where nobody reads, nobody can be told so.
    let _ = writeln!(io::stderr().lock(), "{what}");
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Pipe(io::ErrorKind);

    impl Write for Pipe {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_closed_pipe_is_told_from_a_full_disk() {
        let mut words = Vec::new();
        print_to(&mut words, format_args!("{} m", 1)).unwrap();
        assert_eq!(words, b"1 m");
        let error = |kind| print_to(&mut Pipe(kind), format_args!("a")).unwrap_err();
        assert!(error(io::ErrorKind::BrokenPipe).is::<Closed>());
        assert!(!error(io::ErrorKind::StorageFull).is::<Closed>());
    }
}
