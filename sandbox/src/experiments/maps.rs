//! Report §3.4.1: parameters that the image under a node sets.

use crate::prelude::*;
use ndarray::Array2;
use scene::Scene;

const SCENE: &str = "gap-and-corners";
/// What the scene says of its tension and rigidity after their values.
const MAP: &str =
    ", map = { edge = { sigma = 2.0 } }, low = 1.0, high = 0.005, range = [0.3, 0.8] }";
/// Constant stiffness as a share of the scene's largest.
const SHARES: [f64; 9] = [0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 1.0];
/// The room: where its inner walls stand, and the door in the upper one.
const WALLS: [f64; 2] = [23.0, 73.0];
const DOOR: [f64; 2] = [38.0, 58.0];

const DOOR_OFF: &str = "map: off at the door";

/// A map that softens the curve at edges.
pub(crate) const MAPS: Experiment = Experiment {
    id: "sec-3-4-1-maps",
    title: "Parameters from the image",
    place: "§3.4.1",
    question: "A room with sharp corners has an open door, and pressure drives the curve outwards. A soft curve follows the corners and leaves by the \
               door, a stiff one does neither. Tension and rigidity are multiplied by a map: 1 where there is no edge, a two-hundredth \
               on a clear one. Is that better than every constant?",
    claims: &[
        claim("with constant stiffness, closing the gap costs accuracy at the corners [exact walls]")
            .when(&[
                more("constant 0.02: off at the door", 4.0, "constant 1: off at the door"),
                more("constant 1: off at the corners", 2.5, "constant 0.02: off at the corners"),
            ]),
        claim("with the map the curve leaves the door less than any constant that follows the corners \
               as well [exact walls]")
            .judged(|r| {
                let map = off(r, "map")?;
                let like = constant(r, map.1, |(door, corner)| (corner, door))?;
                let words = format!("{:.2} px against {like:.2} at {:.2} px from the corners", map.0, map.1);
                Ok(Finding::new(map.0 < 0.7 * like, words))
            }),
        claim("and follows the corners better than any constant that holds the door as well [exact walls]")
            .judged(|r| {
                let map = off(r, "map")?;
                let like = constant(r, map.0, |pair| pair)?;
                let words = format!("{:.2} px against {like:.2} at {:.2} px out of the door", map.1, map.0);
                Ok(Finding::new(map.1 < 0.85 * like, words))
            }),
        claim("noise of a fifth of the step instead of an eighth changes little [exact walls]").when(&[
            less("map, noise 20: off at the door", 1.3, DOOR_OFF),
            less("map, noise 20: off at the corners", 1.3, "map: off at the corners"),
        ]),
        claim("of a quarter, it is taken for edges in the door, and the door is left [exact walls]")
            .when(&[more("map, noise 25: off at the door", 2.0, DOOR_OFF)]),
        claim("a map from a fiftieth of an edge on is soft at any noise: the door is left [exact walls]")
            .when(&[more("map from 0.02 on: off at the door", 2.0, DOOR_OFF)]),
        claim("what the map puts in and takes out is booked: the sum of all energies stays [theory §15]")
            .when(&[below("sum of energies: strays by", 1e-10), below("put in by the map", -0.01)]),
    ],
    run,
    draw,
};

/// How far a curve is off at the door.
fn door(r: &Record, case: &str) -> Result<f64> {
    r.number(&format!("{case}: off at the door"))
}

/// How far a curve is off at the door and at the corners.
fn off(r: &Record, case: &str) -> Result<(f64, f64)> {
    Ok((
        door(r, case)?,
        r.number(&format!("{case}: off at the corners"))?,
    ))
}

/// The second of two errors of a constant stiffness whose first is `at`, straight between those tried; the nearer end beyond.
fn constant(r: &Record, at: f64, order: impl Fn((f64, f64)) -> (f64, f64)) -> Result<f64> {
    let mut tried = Vec::new();
    for share in SHARES {
        tried.push(order(off(r, &named(share))?));
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let between = tried.windows(2).find(|pair| at <= pair[1].0);
    let Some(&[(x0, y0), (x1, y1)]) = between.and_then(|pair| pair.first_chunk::<2>()) else {
        return Ok(tried.last().map_or(f64::NAN, |last| last.1));
    };
    let share = ((at - x0) / (x1 - x0)).clamp(0.0, 1.0);
    Ok(y0 + share * (y1 - y0))
}

fn named(share: f64) -> String {
    format!("constant {share}")
}

/// Root mean square distance of the curve from the line of the door, and mean distance from the four corners.
fn measure(curve: &[DVec2]) -> (f64, f64) {
    let [low, high] = WALLS;
    let sill = (0..=20).map(|i| DVec2::new(DOOR[0] + real(i), low));
    let squares = sill.map(|p| outline::distance(curve, true, p).powi(2));
    let corners = [(low, low), (high, low), (high, high), (low, high)];
    let apart = corners.map(|corner| outline::distance(curve, true, corner.into()));
    (mean(squares).sqrt(), mean(apart))
}

/// The scene with a constant stiffness.
fn without(share: f64) -> Result<Scene> {
    let tension = format!("{:?}", 200.0 * share);
    let rigidity = format!("{:?}", 4000.0 * share);
    let changes = [
        (&*format!("{{ value = 200.0{MAP}"), &*tension),
        (&*format!("{{ value = 4000.0{MAP}"), &*rigidity),
    ];
    scene_with(SCENE, &changes)
}

fn run() -> Result {
    let mut record = Record::default();
    let mut cases: Vec<(String, Scene)> = vec![("map".to_owned(), scene_with(SCENE, &[])?)];
    for share in SHARES {
        cases.push((named(share), without(share)?));
    }
    for (name, change) in [
        ("map, noise 20", ("noise = 12.0", "noise = 20.0")),
        ("map, noise 25", ("noise = 12.0", "noise = 25.0")),
        (
            "map from 0.02 on",
            ("range = [0.3, 0.8]", "range = [0.02, 0.1]"),
        ),
    ] {
        cases.push((name.to_owned(), scene_with(SCENE, &[change])?));
    }
    for (name, scene) in cases {
        let run = to_the_end(&scene)?;
        let (door, corners) = measure(last(&run));
        let mut own = record.under(&name);
        own.note("off at the door [px]", door, 1e-5);
        own.note("off at the corners [px]", corners, 1e-5);
        if name == "map" {
            keep_account(&mut record, &run);
            keep_pictures(&mut record, &scene)?;
        }
        if let Some((table, _)) = DRAWN.iter().find(|drawn| drawn.0 == name) {
            record.keep_points(table, last(&run));
        }
    }
    Ok(record)
}

/// How far the sum of all energies strays, and what the map has put in.
fn keep_account(record: &mut Record, run: &scene::Record) {
    let rows = run
        .frames
        .iter()
        .filter_map(|frame| Some((frame.t, frame.energies.as_ref()?.values())));
    let rows: Vec<(f64, Vec<f64>)> = rows.collect();
    let largest = most(rows.iter().flat_map(|row| &row.1).map(|value| value.abs()));
    record.note("sum of energies: strays by", stray(&rows) / largest, 1e-10);
    let end = run.last().and_then(|frame| frame.energies.as_ref());
    let put_in = end.map_or(0.0, |energies| -energies.parameters);
    record.note("put in by the map", put_in / largest, 1e-5);
}

/// The runs that are drawn, and what they are called there.
const DRAWN: [(&str, &str); 3] = [
    ("constant 0.03", "soft"),
    ("constant 1", "stiff"),
    ("map", "stiff, and soft at edges"),
];

/// The picture, and the factor at each of its pixels.
fn keep_pictures(record: &mut Record, scene: &Scene) -> Result<()> {
    let (Some(picture), Some(map)) = (&scene.picture, &scene.snake.body().maps.rigidity) else {
        return Err(refused("a picture and a map are needed"));
    };
    let at = |(y, x): (usize, usize)| map.at(DVec2::new(real(x), real(y)));
    let factor = Array2::from_shape_fn(picture.levels().dim(), at);
    record.keep_grid("picture", picture.levels().clone());
    record.keep_grid("factor", factor);
    Ok(())
}

fn draw(record: &Record) -> Drawn {
    let shown = grey(record.grid("picture")?);
    let mut panels = Vec::new();
    for ((case, words), color) in DRAWN
        .into_iter()
        .zip([Color::SKY, Color::YELLOW, Color::RED])
    {
        let panel = Panel::pixels(words, 96, 96)
            .bare()
            .with(Picture::new(shown.clone()));
        panels.push(panel.with(line(record.xy(case)?, color).closed().weighing(1.6)));
    }
    let factor = record.grid("factor")?.mapv(|factor| 255.0 * factor);
    let ground = Panel::pixels("the factor: 1 white, 1/200 black", 96, 96).bare();
    let ground = ground
        .with(Picture::new(grey(&factor)))
        .with(line(record.xy("map")?, Color::RED).closed());
    let at = |case: &str| off(record, case).map(|(door, corners)| (corners, door));
    let constants = SHARES.iter().map(|&share| at(&named(share)));
    let constants = constants.collect::<Result<Vec<_>>>()?;
    let (x, y) = (
        ("from the corners / px", 0.0, 6.0),
        ("out of the door / px", 0.0, 13.0),
    );
    let mut errors = plot("errors", x, y)
        .with(line(constants.clone(), Color::GREY).named("constant, soft to stiff"))
        .with(dots(constants, 1.4, Color::GREY));
    for (case, words, color) in [
        ("map", "map", Color::RED),
        ("map, noise 20", "map, noise 20 for 12", Color::ORANGE),
        ("map, noise 25", "map, noise 25", Color::PURPLE),
        ("map from 0.02 on", "map from 0.02 on", Color::BLUE),
    ] {
        errors = errors.with(dots([at(case)?], 3.0, color).named(words));
    }
    let title = "§3.4.1  Tension and rigidity from the image: a door and four corners";
    Artefact::only(
        "Above: under the same pressure and in the same noise, soft (3 % of the stiffness), stiff, and stiff with the map. Below: \
         the map, and both errors of every run; the grey line is what constants can do.",
        Figure::new(title, 900.0)
            .with(290.0, panels)
            .with(290.0, vec![ground, errors]),
    )
}
