//! `seamstress app`: who may ask it, and what it does.
#![cfg(feature = "app")]

use crate::harness::{Folder, obj};
use seamstress_testkit as kit;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::Child;
use std::time::Duration;

/// The program, which is stopped in the end.
struct App {
    child: Child,
    host: String,
    token: String,
}

impl App {
    fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let mut child = folder.start(&[&["app", "--no-open"], arguments].concat());
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let (host, token) =
            address.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
        Self { child, host: host.into(), token: token.trim_end_matches('/').into() }
    }

    /// The status and the content of an answer.
    fn ask(&self, method: &str, path: &str, headers: &str, body: &str) -> (u16, String) {
        let length = body.len();
        self.send(&format!(
            "{method} {path} HTTP/1.1\r\n{headers}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
        ))
    }

    /// The answer to what stands on the wire.
    fn send(&self, request: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let status = answer.split(' ').nth(1).unwrap().parse().unwrap();
        (status, answer.split_once("\r\n\r\n").unwrap().1.into())
    }

    /// The same for what pages of the program ask.
    fn own(&self, method: &str, path: &str, body: &str) -> (u16, String) {
        let host = format!("Host: {}\r\n", self.host);
        self.ask(method, &format!("/{}/{path}", self.token), &host, body)
    }

    /// Starts a job with a torus, and waits for its end.
    fn make(&self, task: &str, mesh: &str) -> (String, Value) {
        let task: String = task.bytes().map(|byte| format!("%{byte:02X}")).collect();
        let (status, job) = self.own("POST", &format!("jobs?name=torus.obj&task={task}"), mesh);
        assert_eq!(status, 200, "{job}");
        loop {
            let state: Value =
                serde_json::from_str(&self.own("GET", &format!("jobs/{job}"), "").1).unwrap();
            if state["state"] != "running" {
                return (job, state);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for App {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn only_pages_of_the_program_are_answered() {
    let folder = Folder::new();
    let app = App::start(&folder, &[]);
    let (host, page) = (format!("Host: {}\r\n", app.host), format!("/{}/", app.token));
    let status = |path: &str, headers: &str| app.ask("GET", path, headers, "").0;
    assert_eq!(status(&page, &host), 200);
    assert_eq!(status(&page, &format!("{host}Origin: http://{}\r\n", app.host)), 200);
    let foreign = [
        (page.as_str(), "Host: other.example\r\n".to_owned()),
        (&page, String::new()),
        (&page, format!("{host}Host: other.example\r\n")),
        (&page, format!("{host}Origin: http://other.example\r\n")),
        (&page, format!("{host}Origin: null\r\n")),
        ("/", host.clone()),
        ("/00000000000000000000000000000000/", host.clone()),
    ];
    for (path, headers) in foreign {
        assert_eq!(status(path, &headers), 403, "{path} {headers}");
    }
    // Files of this machine are none of a page's business.
    let task = "%7B%22make%22%3A%7B%22check%22%3A%5B%22pairs%3A%2Fetc%2Fpasswd%22%5D%7D%7D";
    let (status, text) = app.own("POST", &format!("jobs?task={task}"), "v 0 0 0");
    assert!(status == 400 && text.contains("cannot come from a file here"), "{text}");
}

/// Found by the fuzz target `http`: such an answer has the version of the request.
#[test]
fn a_header_that_is_none_is_a_bad_request_in_any_version() {
    let folder = Folder::new();
    let app = App::start(&folder, &[]);
    for version in ["1.0", "1.1", "2.0"] {
        let request = format!("GET /{}/alive HTTP/{version}\r\nno header\r\n\r\n", app.token);
        assert_eq!(app.send(&request).0, 400, "{version}");
        assert_eq!(app.own("GET", "alive", "").0, 200);
    }
}

#[test]
fn quads_are_made_and_bad_meshes_refused_as_by_the_command() {
    let folder = Folder::new();
    let torus = kit::torus(16, 10, 2.0, 0.8);
    folder.write_obj("torus.obj", &torus);
    let app = App::start(&folder, &["torus.obj"]);
    assert_eq!(app.own("GET", "mesh", "").1, obj(&torus));

    let task = r#"{"make": {"quads": {"size": {"quads": 200.0}}}}"#;
    let (job, state) = app.make(task, &obj(&torus));
    assert_eq!(state["state"], "done", "{state}");
    folder.write("page.obj", app.own("GET", &format!("jobs/{job}/files/q.obj"), "").1);
    folder.expect(0, &["quad", "torus.obj", "--quads", "200", "-o", "command.obj"]);
    assert_eq!(folder.read("page.obj"), folder.read("command.obj"));

    let (_, state) = app.make(r#"{"make": {"check": []}}"#, "v 0 0 0\nf 1 2 3\n");
    folder.write("torus.obj", "v 0 0 0\nf 1 2 3\n");
    let run = folder.expect(1, &["check", "torus.obj"]);
    let message = state["error"]["message"].as_str().unwrap();
    assert!(run.stderr.starts_with(&format!("error: {message}")), "{message} is not {run:?}");
}

#[test]
fn a_job_is_forgotten_when_it_is_stopped() {
    let folder = Folder::new();
    let app = App::start(&folder, &[]);
    let (job, _) = app.make(r#"{"make": {"check": []}}"#, &obj(&kit::tetrahedron()));
    assert_eq!(app.own("DELETE", &format!("jobs/{job}"), "").0, 200);
    assert_eq!(app.own("GET", &format!("jobs/{job}"), "").0, 404);
}
