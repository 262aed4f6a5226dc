//! The server of `snake live`: what is not of this machine is refused, and nothing that is sent to it stops it.

#![allow(clippy::unwrap_used, reason = "a test may stop the process")]
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest as _;
use tungstenite::{Message, WebSocket};

/// A window's server, ended with the test.
struct Served {
    child: Child,
    /// `127.0.0.1:PORT`.
    host: String,
    secret: String,
    folder: tempfile::TempDir,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_snake"));
    command.arg("live").arg("--no-open").args(args);
    command
}

fn serve(args: &[&str]) -> Served {
    let folder = tempfile::tempdir().unwrap();
    let mut child = command(args)
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    out.read_line(&mut line).unwrap();
    let (host, secret) = line
        .trim()
        .strip_prefix("http://")
        .and_then(|rest| rest.split_once("/?secret="))
        .unwrap();
    Served {
        host: host.to_owned(),
        secret: secret.to_owned(),
        child,
        folder,
    }
}

/// The first line of the answer to a request, and the rest of it.
fn get(served: &Served, path: &str, headers: &str) -> (String, String) {
    let mut stream = TcpStream::connect(&served.host).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let request = format!("GET {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    let (first, rest) = text.split_once("\r\n").unwrap();
    (first.to_owned(), rest.to_owned())
}

type Socket = WebSocket<TcpStream>;

/// A window's socket, as a page of that origin opens it.
fn window(served: &Served, secret: &str, origin: Option<&str>, me: &str) -> Result<Socket, String> {
    let url = format!("ws://{}/socket?secret={secret}&me={me}", served.host);
    let mut request = url.into_client_request().unwrap();
    if let Some(origin) = origin {
        request
            .headers_mut()
            .insert("Origin", origin.parse().unwrap());
    }
    let stream = TcpStream::connect(&served.host).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let opened = tungstenite::client(request, stream);
    opened
        .map(|(socket, _)| socket)
        .map_err(|error| error.to_string())
}

fn own(served: &Served, me: &str) -> Socket {
    let origin = format!("http://{}", served.host);
    window(served, &served.secret, Some(&origin), me).unwrap()
}

fn packet(head: &Value) -> Message {
    live::Packet::words(head.clone()).encode().into()
}

/// The answer to a message; frames between are passed over.
fn answer(socket: &mut Socket, head: &Value) -> Value {
    socket.send(packet(head)).unwrap();
    loop {
        let Message::Binary(bytes) = socket.read().unwrap() else {
            continue;
        };
        let head = live::Packet::decode(&bytes).unwrap().head;
        if head.get("kind").is_none() {
            return head;
        }
    }
}

#[test]
fn the_page_is_for_this_machine_and_for_those_who_know_the_secret() {
    let served = serve(&["soft-ball"]);
    let host = format!("Host: {}\r\n", served.host);
    let right = format!("/?secret={}", served.secret);
    let (first, page) = get(&served, &right, &host);
    assert!(
        first.contains("200") && page.contains("<title>Snakes"),
        "{first}"
    );
    let policy = page.to_lowercase();
    assert!(
        policy.contains("content-security-policy: default-src 'none'"),
        "{page}"
    );
    for (path, headers) in [
        ("/", host.clone()),
        ("/?secret=0123", host.clone()),
        (right.as_str(), "Host: evil.example\r\n".to_owned()),
        (right.as_str(), String::new()),
        (
            right.as_str(),
            format!("{host}Origin: http://evil.example\r\n"),
        ),
        ("/main.js", "Host: evil.example\r\n".to_owned()),
    ] {
        let (first, _) = get(&served, path, &headers);
        assert!(
            first.contains("403") || first.contains("400"),
            "{path} {headers:?}: {first}"
        );
    }
    let (first, _) = get(&served, "/../../etc/passwd", &host);
    assert!(first.contains("404"), "{first}");
}

#[test]
fn a_socket_needs_the_secret_and_a_page_of_this_machine() {
    let served = serve(&["soft-ball"]);
    let origin = format!("http://{}", served.host);
    assert!(window(&served, &served.secret, Some(&origin), "a").is_ok());
    for (secret, from) in [
        ("", Some(origin.as_str())),
        ("0123456789", Some(origin.as_str())),
        (served.secret.as_str(), Some("http://evil.example")),
        (served.secret.as_str(), Some("null")),
        (served.secret.as_str(), None),
    ] {
        let refused = window(&served, secret, from, "a");
        assert!(refused.is_err(), "{secret:?} {from:?}");
    }
}

#[test]
fn messages_that_are_none_are_answered_and_the_engine_goes_on() {
    let served = serve(&["soft-ball"]);
    let mut socket = own(&served, "a");
    for bytes in [
        &b""[..],
        b"{}",
        &[0xff; 40],
        b"\x10\0\0\0\0\0\0\0{\"id\":1}",
    ] {
        socket.send(Message::Binary(bytes.to_vec().into())).unwrap();
    }
    let said = answer(&mut socket, &json!({"id": 9, "ask": {"kind": "about"}}));
    // the answers to what was no message come first
    assert!(said["error"].is_string() || said["id"] == 9, "{said}");
    let mut other = own(&served, "b");
    let said = answer(&mut other, &json!({"id": 1, "ask": {"kind": "about"}}));
    assert_eq!(said["ok"]["name"], "soft-ball");
    // text is no message: the socket closes, the engine does not
    other.send(Message::Text("hello".into())).unwrap();
    let mut third = own(&served, "c");
    let said = answer(
        &mut third,
        &json!({"id": 1, "do": {"kind": "step", "steps": 3}}),
    );
    assert!(said["error"].is_null(), "{said}");
}

#[test]
fn what_is_said_again_is_not_done_again() {
    let served = serve(&["soft-ball"]);
    let step = json!({"id": 5, "do": {"kind": "step", "steps": 3}});
    let first = answer(&mut own(&served, "me"), &step);
    // the same window, back after its connection was lost
    let mut again = own(&served, "me");
    assert_eq!(answer(&mut again, &step), first);
    socket_step(&mut again, 3);
    // another window's number 5 is another message
    let mut other = own(&served, "other");
    answer(&mut other, &step);
    socket_step(&mut other, 6);
}

/// The next frames say that so many steps were made.
fn socket_step(socket: &mut Socket, steps: u64) {
    for _ in 0..200 {
        let Message::Binary(bytes) = socket.read().unwrap() else {
            continue;
        };
        let head = live::Packet::decode(&bytes).unwrap().head;
        if head["frame"]["step"] == steps {
            return;
        }
        let beyond = head["frame"]["step"]
            .as_u64()
            .is_some_and(|now| now > steps);
        assert!(!beyond, "{head}");
    }
    unreachable!("no frame of {steps} steps");
}

#[test]
fn an_end_that_is_asked_for_keeps_what_was_not_saved() {
    let mut served = serve(&["soft-ball"]);
    let gravity = json!({"id": 1, "do": {"kind": "body", "do": "gravity", "g": [1, 0]}});
    answer(&mut own(&served, "a"), &gravity);
    let id = served.child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    assert!(served.child.wait().unwrap().success());
    let kept = served.folder.path().join("soft-ball.snakes.json");
    let session = std::fs::read_to_string(kept).unwrap();
    assert!(session.contains("gravity"), "{session}");
}

#[test]
fn what_cannot_be_opened_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.png");
    std::fs::write(&broken, b"\x89PNG\r\n\x1a\nno").unwrap();
    let session = folder.path().join("a.snakes.json");
    std::fs::write(&session, "{\"snakes-session\": 7}").unwrap();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    for (args, wanted) in [
        (vec![broken.to_str().unwrap()], "broken.png"),
        (vec![session.to_str().unwrap()], "session"),
        (vec!["soft-bal"], "soft-ball"),
        (vec!["nowhere.png"], "nowhere.png"),
        (vec!["soft-ball", "--port", &port], "--port"),
    ] {
        let out = command(&args).output().unwrap();
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
        assert!(
            said.lines().count() == 1 && said.contains(wanted),
            "{args:?}: {said}"
        );
    }
}
