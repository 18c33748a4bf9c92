//! The page and its jobs over HTTP, for this machine alone.

use super::jobs::{FORGOTTEN, Job, Jobs};
use seamstress::{Task, refusal};
use std::io::{self, Read};
use std::net::Ipv4Addr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tiny_http::{Header, Method, Request, Response, StatusCode};

const PAGE: &str = include_str!("assets/app.html");
const CODE: &str = include_str!("assets/app.js");
const STYLE: &str = include_str!("assets/style.css");

/// The largest mesh that is taken, bytes.
const LARGEST: u64 = 1_000_000_000;
/// How often the server looks up from waiting.
const LOOK_UP: Duration = Duration::from_millis(200);

/// The mesh that a page starts with.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) name: String,
    pub(super) content: Vec<u8>,
}

/// Serves pages that know the token of its address.
pub(super) struct Server {
    http: tiny_http::Server,
    shared: Arc<Shared>,
}

struct Shared {
    /// The names under which this server may be asked.
    hosts: [String; 2],
    token: String,
    mesh: Option<Mesh>,
    jobs: Jobs,
    asked: Mutex<Instant>,
}

/// What is answered: status, type, content.
type Answer = (u16, &'static str, Vec<u8>);

const JSON: &str = "application/json";
const TEXT: &str = "text/plain; charset=utf-8";
const BYTES: &str = "application/octet-stream";

fn text(status: u16, text: &str) -> Answer {
    (status, TEXT, text.into())
}

impl Server {
    /// Listens at a port of this machine, any for 0.
    pub(super) fn start(port: u16, mesh: Option<Mesh>) -> io::Result<Self> {
        let http =
            tiny_http::Server::http((Ipv4Addr::LOCALHOST, port)).map_err(io::Error::other)?;
        let port = http.server_addr().to_ip().map_or(port, |address| address.port());
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let shared = Shared {
            hosts: ["127.0.0.1", "localhost"].map(|host| format!("{host}:{port}")),
            token: random.iter().map(|byte| format!("{byte:02x}")).collect(),
            mesh,
            jobs: Jobs::default(),
            asked: Mutex::new(Instant::now()),
        };
        Ok(Self { http, shared: Arc::new(shared) })
    }

    pub(super) fn address(&self) -> String {
        format!("http://{}/{}/", self.shared.hosts[0], self.shared.token)
    }

    /// Answers until it is stopped, or no page has asked for anything for some time.
    pub(super) fn serve(&self, stop: &AtomicBool, idle: Duration) {
        while !stop.load(Ordering::Relaxed) {
            match self.http.recv_timeout(LOOK_UP) {
                Ok(Some(request)) => {
                    let shared = Arc::clone(&self.shared);
                    // A slow one must not keep the others waiting.
                    thread::spawn(move || shared.answer(request));
                }
                Ok(None) => {}
                Err(_) => return,
            }
            let is_working = self.shared.jobs.stop_forgotten(FORGOTTEN);
            let asked = *self.shared.asked.lock().unwrap_or_else(PoisonError::into_inner);
            if !is_working && asked.elapsed() > idle {
                return;
            }
        }
    }
}

impl Shared {
    fn answer(&self, mut request: Request) {
        let (status, kind, content) = self.answer_to(&mut request);
        let mut response = Response::from_data(content).with_status_code(StatusCode(status));
        let name = self.mesh.as_ref().map_or("", |mesh| &mesh.name);
        let name: String = form_urlencoded::byte_serialize(name.as_bytes()).collect();
        for (field, value) in [
            ("Content-Type", kind),
            ("Cache-Control", "no-store"),
            ("X-Content-Type-Options", "nosniff"),
            ("X-Frame-Options", "DENY"),
            ("Referrer-Policy", "no-referrer"),
            ("Cross-Origin-Resource-Policy", "same-origin"),
            ("X-Name", &name.replace('+', "%20")),
        ] {
            if let Ok(header) = Header::from_bytes(field, value) {
                response.add_header(header);
            }
        }
        // Whoever has asked may have gone away.
        let _ = request.respond(response);
    }

    fn answer_to(&self, request: &mut Request) -> Answer {
        let Some(path) = self.admitted(request) else {
            return text(403, "only the page of this program may ask");
        };
        *self.asked.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
        let (path, query) = path.split_once('?').unwrap_or((&path, ""));
        let parts: Vec<&str> = path.split('/').collect();
        match (request.method(), &parts[..]) {
            (Method::Get, [""]) => (200, "text/html; charset=utf-8", PAGE.into()),
            (Method::Get, ["app.js"]) => (200, "text/javascript; charset=utf-8", CODE.into()),
            (Method::Get, ["style.css"]) => (200, "text/css; charset=utf-8", STYLE.into()),
            (Method::Get, ["alive"]) => text(200, ""),
            (Method::Get, ["mesh"]) => match &self.mesh {
                Some(mesh) => (200, BYTES, mesh.content.clone()),
                None => text(204, ""),
            },
            (Method::Post, ["jobs"]) => self.start(query, request),
            (method, ["jobs", number, rest @ ..]) => {
                let number = number.parse().ok();
                let Some((number, job)) = number.and_then(|n| Some((n, self.jobs.get(n)?))) else {
                    return text(404, "there is no such job");
                };
                match method {
                    Method::Delete => {
                        self.jobs.stop(number);
                        text(200, "")
                    }
                    Method::Get => answer_of(&job, rest),
                    _ => text(405, "not here"),
                }
            }
            _ => text(404, "there is nothing here"),
        }
    }

    /// The path after the token, if the request comes from a page of this server.
    fn admitted(&self, request: &Request) -> Option<String> {
        let field = |name: &'static str| {
            let mut found = request.headers().iter().filter(|header| header.field.equiv(name));
            let first = found.next().map(|header| header.value.as_str().to_owned());
            (first, found.next().is_some())
        };
        let ((host, has_hosts), (origin, has_origins)) = (field("Host"), field("Origin"));
        let host = host.filter(|host| !has_hosts && self.hosts.contains(host))?;
        if has_origins || origin.is_some_and(|origin| origin != format!("http://{host}")) {
            return None;
        }
        let path = request.url().strip_prefix('/')?.strip_prefix(&self.token)?;
        path.strip_prefix('/').map(str::to_owned)
    }

    fn start(&self, query: &str, request: &mut Request) -> Answer {
        let value = |wanted: &str| {
            let mut pairs = form_urlencoded::parse(query.as_bytes());
            pairs.find(|(name, _)| name == wanted).map(|(_, value)| value.into_owned())
        };
        let task = match Task::parse(&value("task").unwrap_or_default()) {
            Ok(task) => task,
            Err(error) => return (400, JSON, refusal(&error).into()),
        };
        let mut content = Vec::new();
        // One byte more tells that there are more.
        let read = request.as_reader().take(LARGEST + 1).read_to_end(&mut content);
        if read.is_err() {
            return text(400, "the mesh did not arrive");
        }
        if content.len() as u64 > LARGEST {
            return text(413, &format!("meshes may have {} MB at most", LARGEST / 1_000_000));
        }
        let name = value("name").unwrap_or_else(|| "mesh".into());
        match self.jobs.start(task, content, name) {
            Some(number) => text(200, &number.to_string()),
            None => text(429, "too many jobs are running; wait for one to end, or cancel it"),
        }
    }
}

fn answer_of(job: &Job, what: &[&str]) -> Answer {
    let found = match what {
        [] => Some((200, JSON, job.state().to_string().into_bytes())),
        ["facts"] => job.with_result(|done| (200, JSON, done.page().facts().into_bytes())),
        ["scene"] => job.with_result(|done| (200, BYTES, done.page().scene().to_vec())),
        ["files", name] => job.with_result(|done| match done.file(name) {
            Ok(content) => (200, BYTES, content),
            Err(error) => (400, JSON, refusal(&error).into()),
        }),
        _ => None,
    };
    found.unwrap_or_else(|| text(404, "there is no such result"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::net::TcpStream;

    /// Asks whether the program is alive, as open pages do again and again.
    fn ask(server: &Server) {
        let host = &server.shared.hosts[0];
        let mut stream = TcpStream::connect(host).unwrap();
        let token = &server.shared.token;
        write!(stream, "GET /{token}/alive HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n")
            .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }

    #[test]
    fn it_ends_when_no_page_has_asked_for_long_enough() {
        let server = Server::start(0, None).unwrap();
        let (stop, idle) = (AtomicBool::new(false), Duration::from_millis(1500));
        thread::scope(|scope| {
            let serving = scope.spawn(|| server.serve(&stop, idle));
            let begin = Instant::now();
            while begin.elapsed() < 2 * idle {
                ask(&server);
                thread::sleep(LOOK_UP);
            }
            assert!(!serving.is_finished(), "a page still asks");
            let last = Instant::now();
            // Nobody sets `stop`: it ends by itself, or this waits for ever.
            serving.join().unwrap();
            assert!(last.elapsed() + LOOK_UP + LOOK_UP >= idle, "it ended too early");
        });
    }
}
