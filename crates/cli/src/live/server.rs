//! The server: the page and its socket, on the loopback address alone.
//!
//! A page of another site can reach any port of this machine. So the socket and the page ask for a secret that stands
//! in the address, and whatever says that it comes from another host or origin is refused.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Request, State};
use axum::http::{HeaderMap, StatusCode, Uri, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::Response;
use axum::routing::get;
use axum::serve::ListenerExt as _;
use live::PAGE;
use scene::SceneError;
use tokio::sync::mpsc::unbounded_channel;

use super::hub::Hub;
use crate::commands::key;
use crate::stop::Stop;

/// Bytes of a message at most: a file of the largest size, and words.
const MOST_MESSAGE: usize = (1 << 29) + (1 << 24);

/// How often it looks whether the end was asked for.
const LOOK: Duration = Duration::from_millis(50);

/// What is served.
#[derive(Debug, Clone)]
struct Served {
    hub: Hub,
    secret: Arc<str>,
    port: u16,
}

/// Serve until the end is asked for; `begun` is told the address once it can be reached.
pub(super) fn serve(
    port: u16,
    hub: &Hub,
    stop: &Stop,
    begun: impl FnOnce(&str) -> Result<(), SceneError>,
) -> Result<(), SceneError> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_io()
        .enable_time()
        .build();
    let runtime = runtime.map_err(|error| key("live", format!("cannot begin: {error}")))?;
    runtime.block_on(async {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let listener = tokio::net::TcpListener::bind(address).await;
        let listener = listener.map_err(|error| {
            let message = format!(
                "{port} cannot be used: {error}; needed: a free port, or none, for any that is free"
            );
            key("--port", message)
        })?;
        let at = listener.local_addr();
        let at = at.map_err(|error| key("live", format!("cannot begin: {error}")))?;
        let served = Served {
            hub: hub.clone(),
            secret: secret()?.into(),
            port: at.port(),
        };
        begun(&format!("http://{at}/?secret={}", served.secret))?;
        let routes = Router::new()
            .route("/socket", get(socket))
            .fallback(page)
            .layer(from_fn_with_state(served.clone(), guard))
            .with_state(served);
        // small messages are not held back to be sent together
        let listener = listener.tap_io(|stream| {
            let _ = stream.set_nodelay(true);
        });
        let server = axum::serve(listener, routes);
        tokio::select! {
            ended = async { server.await } => ended.map_err(|error| key("live", error)),
            () = asked(stop) => Ok(()),
        }
    })
}

async fn asked(stop: &Stop) {
    while !stop.asked() {
        tokio::time::sleep(LOOK).await;
    }
}

/// A word that nobody guesses.
fn secret() -> Result<String, SceneError> {
    let mut bytes = [0; 18];
    getrandom::fill(&mut bytes)
        .map_err(|error| key("live", format!("no random numbers are to be had: {error}")))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Refuse what comes from elsewhere, and forbid browsers what the page does not need.
async fn guard(State(served): State<Served>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    let port = served.port;
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let text = |name| {
        headers
            .get(name)
            .map(|value| value.to_str().unwrap_or("?").to_owned())
    };
    let host = text(header::HOST).is_some_and(|host| hosts.contains(&host));
    let origin = text(header::ORIGIN).is_none_or(|origin| {
        let own = origin.strip_prefix("http://");
        own.is_some_and(|own| hosts.iter().any(|host| host == own))
    });
    if !host || !origin {
        return refused("this address is for pages of this machine alone");
    }
    let mut response = next.run(request).await;
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; \
         connect-src ws://127.0.0.1:{port} ws://localhost:{port}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, policy.as_str()),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        if let Ok(value) = value.parse() {
            response.headers_mut().insert(name, value);
        }
    }
    response
}

fn refused(words: &'static str) -> Response {
    answer(
        StatusCode::FORBIDDEN,
        "text/plain; charset=utf-8",
        words.into(),
    )
}

fn answer(status: StatusCode, kind: &'static str, body: Body) -> Response {
    let mut response = Response::new(body);
    *response.status_mut() = status;
    if let Ok(kind) = kind.parse() {
        response.headers_mut().insert(header::CONTENT_TYPE, kind);
    }
    response
}

/// The value of a name in the question part of an address.
fn asked_for<'a>(uri: &'a Uri, name: &str) -> Option<&'a str> {
    let pairs = uri.query().unwrap_or_default().split('&');
    pairs
        .filter_map(|pair| pair.split_once('='))
        .find(|(known, _)| *known == name)
        .map(|(_, value)| value)
}

impl Served {
    /// Whether an address has the secret; as long whether the first letter is wrong or the last.
    fn knows(&self, uri: &Uri) -> bool {
        let given = asked_for(uri, "secret").unwrap_or_default().as_bytes();
        let own = self.secret.as_bytes();
        let differs = given.iter().zip(own).fold(0, |all, (a, b)| all | (a ^ b));
        given.len() == own.len() && differs == 0
    }
}

/// The page and its parts.
async fn page(State(served): State<Served>, uri: Uri) -> Response {
    let name = match uri.path() {
        "/" if !served.knows(&uri) => {
            return refused("the address needs its secret: open it as the program has printed it");
        }
        "/" => "index.html",
        path => path.trim_start_matches('/'),
    };
    match PAGE.iter().find(|part| part.name == name) {
        Some(part) => answer(StatusCode::OK, part.kind, part.text.into()),
        None => answer(
            StatusCode::NOT_FOUND,
            "text/plain; charset=utf-8",
            "there is nothing here".into(),
        ),
    }
}

/// A window's socket.
async fn socket(
    State(served): State<Served>,
    uri: Uri,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    // browsers always say where a socket is opened from
    if !served.knows(&uri) || headers.get(header::ORIGIN).is_none() {
        return refused("the socket needs the secret of the address, and a page that opens it");
    }
    let window: String = asked_for(&uri, "me")
        .unwrap_or_default()
        .chars()
        .take(64)
        .collect();
    upgrade
        .max_message_size(MOST_MESSAGE)
        .max_frame_size(MOST_MESSAGE)
        .on_upgrade(move |socket| talk(socket, served.hub, window))
}

/// Hand messages to the engine, and answers and frames to the window.
async fn talk(mut socket: WebSocket, hub: Hub, window: String) {
    let (answer, mut answers) = unbounded_channel::<Vec<u8>>();
    let mut frames = hub.frames();
    loop {
        tokio::select! {
            heard = socket.recv() => match heard {
                Some(Ok(Message::Binary(bytes))) => {
                    if !hub.hear(&window, bytes.into(), &answer) {
                        return;
                    }
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                // text is no message of ours; a closed or broken socket has no more of them
                _ => return,
            },
            Some(reply) = answers.recv() => {
                if socket.send(Message::Binary(reply.into())).await.is_err() {
                    return;
                }
            }
            new = frames.changed() => {
                if new.is_err() {
                    return;
                }
                let frame = frames.borrow_and_update().as_ref().clone();
                if !frame.is_empty() && socket.send(Message::Binary(frame.into())).await.is_err() {
                    return;
                }
            }
        }
    }
}
