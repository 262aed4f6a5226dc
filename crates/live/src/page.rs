//! The files of the page.

/// A file of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Its name in a URL.
    pub name: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// What is in it.
    pub text: &'static str,
}

macro_rules! page {
    ($($name:literal: $kind:literal),* $(,)?) => {
        /// The files of the page, `index.html` first.
        pub const PAGE: &[Part] = &[$(Part {
            name: $name,
            kind: $kind,
            text: include_str!(concat!("../page/", $name)),
        }),*];
    };
}

page![
    "index.html": "text/html; charset=utf-8",
    "style.css": "text/css; charset=utf-8",
    "camera.js": "text/javascript; charset=utf-8",
    "colors.js": "text/javascript; charset=utf-8",
    "draw.js": "text/javascript; charset=utf-8",
    "keys.js": "text/javascript; charset=utf-8",
    "main.js": "text/javascript; charset=utf-8",
    "menu.js": "text/javascript; charset=utf-8",
    "packet.js": "text/javascript; charset=utf-8",
    "parts.js": "text/javascript; charset=utf-8",
    "picture_panel.js": "text/javascript; charset=utf-8",
    "plots.js": "text/javascript; charset=utf-8",
    "scene_panel.js": "text/javascript; charset=utf-8",
    "socket.js": "text/javascript; charset=utf-8",
    "tiles.js": "text/javascript; charset=utf-8",
    "tools.js": "text/javascript; charset=utf-8",
    "unpack.js": "text/javascript; charset=utf-8",
    "wasm.js": "text/javascript; charset=utf-8",
];
