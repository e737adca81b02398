//! The line on a TCP port of this machine, for any number of clients.

use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::thread;
use std::time::Duration;

use anyhow::Context;

use super::client::Ends;

const LOOK_EVERY: Duration = Duration::from_millis(10);
const TIMEOUT: Duration = Duration::from_millis(100);

pub struct Tcp(TcpListener);

impl Tcp {
    /// On 127.0.0.1: whoever reaches the line can drive the motor, so no other machine may.
    pub fn new(port: u16) -> anyhow::Result<Self> {
        let listen = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            listener.set_nonblocking(true)?;
            Ok::<_, std::io::Error>(listener)
        };
        listen().map(Self).with_context(|| {
            format!("cannot serve on TCP port {port}: choose another, or 0 for any that is free")
        })
    }

    /// As `tenax monitor --port` takes it.
    pub fn place(&self) -> anyhow::Result<String> {
        Ok(format!("tcp:{}", self.0.local_addr()?))
    }

    /// Serves clients until the hub is closed.
    pub fn serve(&self, ends: &Ends) {
        while !ends.hub.is_closed() {
            match self.0.accept() {
                Ok((stream, _)) => drop(client(stream, ends)),
                Err(_) => thread::sleep(LOOK_EVERY),
            }
        }
    }
}

fn client(mut stream: TcpStream, ends: &Ends) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let mut up = stream.try_clone()?;
    let frames = ends.hub.join();
    let writer = ends.clone();
    thread::spawn(move || {
        let _left = writer.write(&frames, &mut up);
        // The reader's thread has the stream too, so it is not closed by itself.
        let _closed = up.shutdown(Shutdown::Both);
    });
    let reader = ends.clone();
    thread::spawn(move || {
        let _left = reader.read(&mut stream);
    });
    Ok(())
}
