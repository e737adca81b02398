//! The line on a pseudo-terminal, for one client after the other. While none has it open, what comes up is lost, as on a cable that
//! is not plugged in.

use std::fs;
use std::io::{ErrorKind, Read};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread;
use std::time::Duration;

use anyhow::{Context, bail};
use serialport::{SerialPort, TTYPort};
use tenax_hal_shim::wire::BAUD;

use super::hub::{Framer, Hub};

/// Interval at which a new or lost client is noticed.
const LOOK_EVERY: Duration = Duration::from_millis(10);
/// Time for a client to read the last bytes: the rest is lost when the near end closes.
const LAST_READ: Duration = Duration::from_millis(100);

pub struct Pty {
    near: TTYPort,
    path: String,
    link: Option<Link>,
}

impl Pty {
    pub fn new(at: Option<&Path>) -> anyhow::Result<Self> {
        let what = "cannot make a pseudo-terminal; serve on TCP instead, with --serve-tcp PORT";
        let (mut near, far) = TTYPort::pair().context(what)?;
        near.set_timeout(LOOK_EVERY).context(what)?;
        let path = far.name().context(what)?;
        let link = at.map(|at| Link::new(at, &path)).transpose()?;
        // The far end closes here, and stays raw as long as the near one is open.
        Ok(Self { near, path, link })
    }

    pub fn places(&self) -> Vec<String> {
        let link = self.link.as_ref().map(|link| link.0.display().to_string());
        [self.path.clone()].into_iter().chain(link).collect()
    }

    pub fn serve(mut self, hub: &Arc<Hub>) {
        let mut client: Option<Arc<AtomicBool>> = None;
        let (mut framer, mut buffer) = (Framer::default(), [0; 4096]);
        while !hub.is_closed() {
            let read = self.near.read(&mut buffer);
            if matches!(&read, Err(error) if error.kind() == ErrorKind::BrokenPipe) {
                thread::sleep(LOOK_EVERY);
                if let Some(gone) = client.take() {
                    // Its writer may be waiting for a frame: the next client would hear each one twice.
                    gone.store(true, Relaxed);
                    framer = Framer::default();
                    self.forget();
                }
                continue;
            }
            if client.is_none() {
                client = self.write(hub);
            }
            if let Ok(count) = read {
                hub.pass_on(&mut framer, &buffer[..count]);
            }
        }
        if client.is_some() {
            thread::sleep(LAST_READ);
        }
    }

    fn write(&self, hub: &Arc<Hub>) -> Option<Arc<AtomicBool>> {
        let gone = Arc::<AtomicBool>::default();
        let (mut near, frames) = (self.near.try_clone_native().ok()?, hub.join());
        let (hub, left) = (Arc::clone(hub), Arc::clone(&gone));
        thread::spawn(move || hub.write(&frames, &mut near, &left));
        Some(gone)
    }

    /// Reads what the last client has not read, so that the next does not take it for new.
    fn forget(&self) {
        let far = serialport::new(&self.path, BAUD).exclusive(false).timeout(Duration::ZERO);
        if let Ok(mut far) = far.open_native() {
            let mut buffer = [0; 4096];
            while far.read(&mut buffer).is_ok_and(|count| count > 0) {}
        }
    }
}

struct Link(PathBuf);

impl Link {
    fn new(at: &Path, path: &str) -> anyhow::Result<Self> {
        match fs::symlink_metadata(at) {
            // One that a run left which was killed.
            Ok(there) if there.is_symlink() => {
                fs::remove_file(at).with_context(|| format!("cannot replace {}", at.display()))?;
            }
            Ok(_) => bail!("{} is there already and no symlink: choose another path", at.display()),
            Err(_) => {}
        }
        symlink(path, at).with_context(|| format!("cannot make the symlink {}", at.display()))?;
        Ok(Self(at.to_owned()))
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}
