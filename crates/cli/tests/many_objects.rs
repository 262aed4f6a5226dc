//! `snake fit --seeds`: where many objects are looked for.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;

/// Three discs of radius 9, bright on dark, in a picture of 120 × 60.
fn discs() -> Vec<u8> {
    let mut bytes = b"P5 120 60 255\n".to_vec();
    for at in 0..120 * 60 {
        let (x, y) = (f64::from(at % 120), f64::from(at / 120));
        let within = |cx: f64| (x - cx).hypot(y - 30.0) <= 9.0;
        let inside = [20.0, 58.0, 99.0].into_iter().any(within);
        bytes.push(if inside { 190 } else { 50 });
    }
    bytes
}

#[test]
fn the_rows_of_a_table_are_points() {
    let folder = Folder::new();
    folder.write("d.pgm", discs());
    for (name, table) in [
        ("xy.csv", "x,y\n21,29\n57,31\n100,30\n"),
        ("two.csv", "x,y\n21,29\n57,31\n"),
        ("id.csv", "id,x,y\n7,21,29\n8,57,31\n9,100,30\n"),
    ] {
        folder.write(name, table);
        let rows = table.lines().count() - 1;
        let answer = folder.snake(&["fit", "d.pgm", "--seeds", name, "-o", "o.geojson"]);
        assert_eq!(answer.code, Some(0), "{name}: {}", answer.err);
        let found = std::fs::read_to_string(folder.path("o.geojson")).unwrap();
        assert_eq!(
            found.matches("\"Polygon\"").count(),
            rows,
            "{name}: {found}"
        );
    }
}
