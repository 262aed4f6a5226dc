//! Scenes that make no sense: one line with the key and what is needed, code 2, nothing written.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{CIRCLE, Folder, changed, refused, scene};

#[test]
fn a_text_that_is_no_scene_is_refused_by_its_line() {
    refused("", &["missing", "title"]);
    refused("title = \"cut", &["line 1"]);
    refused("title = \"a\"\n[snake\n", &["line 2"]);
    refused([0x80, 0xFF, 0x00, 0x13], &["not text", "TOML"]);
    refused(vec![0; 100_000], &["line 1"]);
    refused("\u{1b}[31m", &["line 1"]);
    refused("[".repeat(100_000), &["line 1"]);
    refused("a = ".to_owned() + &"[".repeat(100_000), &["line 1"]);
    refused("a.".repeat(50_000) + "b = 1", &["line 1"]);
    refused(scene(&[("steps = 5\n", "")]), &["run", "steps", "time"]);
    refused(scene(&[("tension = 1.0\n", "")]), &["tension", "missing"]);
    refused(
        scene(&[("[densities]\nmass = 1.0\ndamping = 0.1\n", "")]),
        &["densities", "missing"],
    );
}

#[test]
fn a_key_given_twice_is_refused() {
    changed(
        "dt = 0.01",
        "dt = 0.01\ndt = 0.02",
        &["duplicate", "dt", "line"],
    );
    changed("[run]", "[snake]\n[run]", &["duplicate", "snake"]);
    let two = "start = { circle = { center = [0.0, 0.0], radius = 5.0 }, points = [[0.0, 0.0]] }";
    changed(CIRCLE, two, &["start", "line 6"]);
}

#[test]
fn a_typo_is_answered_with_the_nearest_key() {
    for (line, instead, nearest) in [
        ("title =", "titel =", "title"),
        ("nodes =", "node =", "nodes"),
        ("topology =", "topologie =", "topology"),
        ("radius =", "raduis =", "radius"),
        ("circle =", "cirlce =", "circle"),
        ("\"closed\"", "\"close\"", "closed"),
        (
            "\"closed\"",
            "{ head = \"free\", tail = \"pined\" }",
            "pinned",
        ),
        ("\"closed\"", "{ haed = \"free\", tail = \"free\" }", "head"),
        ("tether =", "thether =", "tether"),
        ("mass =", "masss =", "mass"),
        ("dt =", "dt2 =", "dt"),
        ("[run]", "[runn]", "run"),
        ("[run]", "[world]\ngravty = [0.0, 1.0]\n[run]", "gravity"),
        ("[run]", "[world]\nborder = \"stopp\"\n[run]", "stop"),
        (
            "[run]",
            "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\nlaw = \"clmp\"\n[run]",
            "clamp",
        ),
        (
            "[run]",
            "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\nlaw = { penalty = { stifness = 1.0 } }\n[run]",
            "stiffness",
        ),
        (
            "[run]",
            "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\nlaw = { impact = { frictoin = 1.0 } }\n[run]",
            "friction",
        ),
        ("[run]", "[view]\ny = \"upp\"\n[run]", "up"),
        ("[run]", "[schedule]\ntethr = [[0.0, 1.0]]\n[run]", "tether"),
        ("[run]", "[record]\nevry = 1\n[run]", "every"),
        ("[snake]", "rules = \"reprot\"\n[snake]", "report"),
        (
            "[snake]",
            "rules = { smapling = \"report\" }\n[snake]",
            "sampling",
        ),
        (
            "[snake]",
            "rules = { sampling = \"corected\" }\n[snake]",
            "corrected",
        ),
        ("[snake]", "[picture]\nfiel = \"a.png\"\n[snake]", "file"),
        (
            "[snake]",
            "[picture]\nshipped = \"appel\"\n[snake]",
            "apple",
        ),
        (
            "[snake]",
            "[picture.drawn]\nsise = [9, 9]\nregion = { right-of = 4.0 }\n[snake]",
            "size",
        ),
        (
            "[snake]",
            "[picture.drawn]\nsize = [9, 9]\nregion = { right-off = 4.0 }\n[snake]",
            "right-of",
        ),
        ("[snake]", "[field]\nsgma = 2.0\n[snake]", "sigma"),
        ("steps = 5", "steps = 5\nrest = { travl = 1.0 }", "travel"),
        ("steps = 5", "steps = 5\nscheme = \"leap-frog\"", "leapfrog"),
        (
            CIRCLE,
            "start = { shipped = \"apple-report-strt\" }",
            "apple-report-start",
        ),
        ("tether = 0.1", "tether = { alon = [[0.0, 1.0]] }", "along"),
    ] {
        changed(line, instead, &[nearest]);
    }
}

#[test]
fn a_name_that_nothing_has_is_answered_with_the_nearest() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    folder.refused(
        &["run", "soft-bal"],
        &["soft-bal", "did you mean \"soft-ball\"", "list"],
    );
    folder.refused(&["run", "no.toml"], &["no.toml", "No such file"]);
    folder.refused(&["run", "no/such"], &["no/such", "No such file"]);
    folder.refused(&["run", "."], &["directory"]);
    folder.refused(&["run", ""], &["a value is required"]);
    folder.refused(
        &["run", "nosuch"],
        &["no shipped scene is called \"nosuch\" (", "list"],
    );
    let args = ["run", "s.toml", "--scheme", "newmarc"];
    folder.refused(&args, &["--scheme", "newmarc", "nearest is newmark"]);
}

#[test]
fn a_start_outside_the_picture_is_refused_by_its_node() {
    let text = scene(&[
        (
            "[snake]",
            "[picture]\nshipped = \"disturbing-edge\"\n[snake]",
        ),
        ("[30.0, 30.0]", "[300.0, 30.0]"),
    ]);
    refused(
        text,
        &[
            "snake.start",
            "node 0 at (305.00, 30.00)",
            "112×96",
            "x from 0 to 111",
        ],
    );
}

#[test]
fn files_that_a_scene_names_are_refused_by_their_name() {
    changed(
        CIRCLE,
        "start = { file = \"no.csv\" }",
        &["no.csv", "No such file"],
    );
    changed(CIRCLE, "start = { file = \".\" }", &["directory"]);
}

#[cfg(unix)]
#[test]
fn a_file_without_end_is_not_read_to_its_end() {
    let folder = Folder::new();
    folder.write("c.csv", "10,30\n30,10\n50,30\n");
    folder.refused(&["run", "/dev/zero"], &["/dev/zero", "MiB"]);
    folder.refused(
        &["field", "/dev/zero", "--out", "out"],
        &["/dev/zero", "not a picture"],
    );
    folder.refused(
        &["fit", "/dev/zero", "--from", "c.csv"],
        &["/dev/zero", "not a picture"],
    );
}
