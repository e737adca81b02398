//! The line on a TCP port of this machine, for any number of clients.

use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::Context;

use super::hub::Hub;

const LOOK_EVERY: Duration = Duration::from_millis(10);
const TIMEOUT: Duration = Duration::from_millis(100);

/// Serves on 127.0.0.1 until the hub is closed; the address for `tenax monitor --port`. No other machine may reach the line: it can drive
/// the motor.
pub fn serve(port: u16, hub: &Arc<Hub>) -> anyhow::Result<(String, JoinHandle<()>)> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
        format!("cannot serve on TCP port {port}: choose another, or 0 for any that is free")
    })?;
    listener.set_nonblocking(true)?;
    let (place, hub) = (format!("tcp:{}", listener.local_addr()?), Arc::clone(hub));
    let door = thread::spawn(move || {
        while !hub.is_closed() {
            match listener.accept() {
                Ok((stream, _)) => drop(attend(stream, &hub)),
                Err(_) => thread::sleep(LOOK_EVERY),
            }
        }
    });
    Ok((place, door))
}

fn attend(mut stream: TcpStream, hub: &Arc<Hub>) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let (mut up, frames) = (stream.try_clone()?, hub.join());
    let (writer, reader) = (Arc::clone(hub), Arc::clone(hub));
    thread::spawn(move || {
        writer.write(&frames, &mut up, &AtomicBool::default());
        // The reader's thread has the stream too, so it is not closed by itself.
        let _closed = up.shutdown(Shutdown::Both);
    });
    thread::spawn(move || reader.read(&mut stream));
    Ok(())
}
