//! Whatever is sent to the page's server, it answers with HTTP or hangs up, and goes on answering.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::LazyLock;
use std::time::Duration;

/// Longer than anything takes that is not stuck.
const PATIENCE: Duration = Duration::from_secs(50);

/// Host and token.
static APP: LazyLock<(String, String)> = LazyLock::new(|| {
    let address = seamstress_cli::serve_forever().unwrap();
    let (host, token) = address.strip_prefix("http://").unwrap().split_once('/').unwrap();
    (host.into(), token.trim_end_matches('/').into())
});

/// What comes back.
fn ask(request: &[u8]) -> Vec<u8> {
    let mut stream = TcpStream::connect(&APP.0).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    // The server may hang up at any time.
    let _ = stream.write_all(request);
    let _ = stream.shutdown(Shutdown::Write);
    let mut answer = Vec::new();
    if let Err(error) = stream.read_to_end(&mut answer) {
        assert_ne!(error.kind(), std::io::ErrorKind::WouldBlock, "no answer");
    }
    answer
}

fuzz_target!(|data: &[u8]| {
    let (host, token) = &*APP;
    let mut request = Vec::new();
    for byte in data {
        match byte {
            // What nobody can guess.
            1 => request.extend_from_slice(token.as_bytes()),
            2 => request.extend_from_slice(host.as_bytes()),
            _ => request.push(*byte),
        }
    }
    let answer = ask(&request);
    // To a header that is none it answers in the version of the request.
    assert!(answer.is_empty() || answer.starts_with(b"HTTP/"));
    let alive = ask(format!("GET /{token}/alive HTTP/1.1\r\nHost: {host}\r\n\r\n").as_bytes());
    assert!(alive.starts_with(b"HTTP/1.1 200"));
});
