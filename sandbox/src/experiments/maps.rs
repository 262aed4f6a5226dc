//! Report §3.4.1: parameters that the image under a node sets.

use super::pixels::grey;
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel, Picture};
use crate::experiments::motion::{changed_scene, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use ndarray::Array2;
use scene::Scene;

const ID: &str = "sec-3-4-1-maps";
const SCENE: &str = "gap-and-corners";
/// What the scene says of its tension and rigidity after their values.
const MAP: &str =
    ", map = { edge = { sigma = 2.0 } }, low = 1.0, high = 0.005, range = [0.3, 0.8] }";
/// Constant stiffness as a share of the scene's largest.
const SHARES: [f64; 9] = [0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 1.0];
/// The room: where its inner walls stand, and the door in the upper one.
const WALLS: [f64; 2] = [23.0, 73.0];
const DOOR: [f64; 2] = [38.0, 58.0];

/// A map that softens the curve at edges.
pub(crate) const MAPS: Experiment = Experiment {
    id: ID,
    title: "Parameters from the image",
    place: "§3.4.1",
    question: "A room with sharp corners has an open door, and pressure drives the curve outwards. A soft curve follows the corners and leaves by the \
               door, a stiff one does neither. Tension and rigidity are multiplied by a map: 1 where there is no edge, a two-hundredth \
               on a clear one. Is that better than every constant?",
    claims: &[
        Claim {
            says: "with a constant stiffness, closing the gap costs accuracy at the corners",
            source: "exact walls",
            judge: |r| {
                let (soft, stiff) = (off(r, "constant 0.02")?, off(r, "constant 1")?);
                Ok(Finding::new(
                    soft.0 > 4.0 * stiff.0 && stiff.1 > 2.5 * soft.1,
                    format!(
                        "soft: {:.1} px out of the door, {:.1} from the corners; stiff: {:.1} and {:.1}",
                        soft.0, soft.1, stiff.0, stiff.1
                    ),
                ))
            },
        },
        Claim {
            says: "with the map the curve leaves the door less than any constant that follows the corners as well",
            source: "exact walls",
            judge: |r| {
                let map = off(r, "map")?;
                let like = constant(r, map.1, |(door, corner)| (corner, door))?;
                Ok(Finding::new(
                    map.0 < 0.7 * like,
                    format!(
                        "{:.2} px against {like:.2} at {:.2} px from the corners",
                        map.0, map.1
                    ),
                ))
            },
        },
        Claim {
            says: "and follows the corners better than any constant that holds the door as well",
            source: "exact walls",
            judge: |r| {
                let map = off(r, "map")?;
                let like = constant(r, map.0, |pair| pair)?;
                Ok(Finding::new(
                    map.1 < 0.85 * like,
                    format!(
                        "{:.2} px against {like:.2} at {:.2} px out of the door",
                        map.1, map.0
                    ),
                ))
            },
        },
        Claim {
            says: "noise of a fifth of the step instead of an eighth changes little",
            source: "exact walls",
            judge: |r| {
                let (map, noisy) = (off(r, "map")?, off(r, "map, noise 20")?);
                Ok(Finding::new(
                    noisy.0 < 1.3 * map.0 && noisy.1 < 1.3 * map.1,
                    format!(
                        "{:.2} px out of the door, {:.2} from the corners",
                        noisy.0, noisy.1
                    ),
                ))
            },
        },
        Claim {
            says: "of a quarter, it is taken for edges in the door, and the door is left",
            source: "exact walls",
            judge: |r| {
                let (map, noisy) = (door(r, "map")?, door(r, "map, noise 25")?);
                Ok(Finding::new(
                    noisy > 2.0 * map,
                    format!("{noisy:.2} px out of the door instead of {map:.2}"),
                ))
            },
        },
        Claim {
            says: "a map that begins at a fiftieth of an edge is soft at any noise: the door is left again",
            source: "exact walls",
            judge: |r| {
                let (map, low) = (door(r, "map")?, door(r, "map from 0.02 on")?);
                Ok(Finding::new(
                    low > 2.0 * map,
                    format!("{low:.2} px out of the door instead of {map:.2}"),
                ))
            },
        },
        Claim {
            says: "what the map puts in and takes out is booked: the sum of all energies stays",
            source: "theory §15",
            judge: |r| {
                let (gap, put_in) = (
                    r.number("sum of energies: strays by")?,
                    r.number("put in by the map")?,
                );
                Ok(Finding::new(
                    gap < 1e-10 && put_in.abs() > 0.01,
                    format!(
                        "to {gap:.0e} of its largest term; the map has put in {put_in:.2} of that"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// How far a curve is off at the door.
fn door(r: &Record, case: &str) -> Result<f64, SandboxError> {
    r.number(&format!("{case}: off at the door"))
}

/// How far a curve is off at the door and at the corners.
fn off(r: &Record, case: &str) -> Result<(f64, f64), SandboxError> {
    Ok((
        door(r, case)?,
        r.number(&format!("{case}: off at the corners"))?,
    ))
}

/// The second of two errors of a constant stiffness whose first is `at`, straight between those tried; the nearer end beyond.
fn constant(
    r: &Record,
    at: f64,
    order: impl Fn((f64, f64)) -> (f64, f64),
) -> Result<f64, SandboxError> {
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

fn distance(p: DVec2, curve: &[DVec2]) -> f64 {
    let last = curve.last().copied().into_iter();
    let from = last.chain(curve.iter().copied());
    from.zip(curve)
        .map(|(a, &b)| {
            let along = b - a;
            let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            p.distance(a + along * share.clamp(0.0, 1.0))
        })
        .fold(f64::INFINITY, f64::min)
}

/// Root mean square distance of the curve from the line of the door, and mean distance from the four corners.
fn measure(curve: &[DVec2]) -> (f64, f64) {
    let [low, high] = WALLS;
    let sill = (0..=20).map(|i| DVec2::new(DOOR[0] + real(i), low));
    let squares: Vec<f64> = sill.map(|p| distance(p, curve).powi(2)).collect();
    let corners = [(low, low), (high, low), (high, high), (low, high)];
    let apart: f64 = corners
        .iter()
        .map(|&c| distance(DVec2::from(c), curve))
        .sum();
    (
        (squares.iter().sum::<f64>() / real(squares.len())).sqrt(),
        apart / 4.0,
    )
}

/// The scene with a constant stiffness.
fn without(share: f64) -> Result<Scene, SandboxError> {
    let (tension, rigidity) = (
        format!("{:?}", 200.0 * share),
        format!("{:?}", 4000.0 * share),
    );
    changed_scene(
        ID,
        SCENE,
        &[
            (&format!("{{ value = 200.0{MAP}"), &tension),
            (&format!("{{ value = 4000.0{MAP}"), &rigidity),
        ],
    )
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let mut cases: Vec<(String, Scene)> = vec![("map".to_owned(), changed_scene(ID, SCENE, &[])?)];
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
        cases.push((name.to_owned(), changed_scene(ID, SCENE, &[change])?));
    }
    let close = Tolerance::Absolute(1e-5);
    for (name, mut scene) in cases {
        let run = to_the_end(ID, &mut scene)?;
        let curve = run
            .last()
            .map(|frame| frame.nodes().to_vec())
            .unwrap_or_default();
        let (door, corners) = measure(&curve);
        record.note(format!("{name}: off at the door"), door, "px", close);
        record.note(format!("{name}: off at the corners"), corners, "px", close);
        let table = match name.as_str() {
            "map" => {
                keep_account(&mut record, &run);
                keep_pictures(&mut record, &scene)?;
                "curve-map"
            }
            "constant 0.03" => "curve-soft",
            "constant 1" => "curve-stiff",
            _ => continue,
        };
        record.keep(
            Table::raw(table)
                .with("x", "px", close, curve.iter().map(|p| p.x).collect())
                .with("y", "px", close, curve.iter().map(|p| p.y).collect()),
        );
    }
    Ok(record)
}

/// How far the sum of all energies strays, and what the map has put in.
fn keep_account(record: &mut Record, run: &scene::Record) {
    let energies = || {
        run.frames
            .iter()
            .filter_map(|frame| frame.energies.as_ref())
    };
    let values = energies().flat_map(snake::Energies::values);
    let largest = values.fold(0.0_f64, |a, b| a.max(b.abs()));
    let first = energies().next().map_or(0.0, snake::Energies::total);
    let strays = energies()
        .map(|e| (e.total() - first).abs())
        .fold(0.0, f64::max);
    let put_in = energies().next_back().map_or(0.0, |e| -e.parameters);
    record.note(
        "sum of energies: strays by",
        strays / largest,
        "",
        Tolerance::Absolute(1e-10),
    );
    record.note(
        "put in by the map",
        put_in / largest,
        "",
        Tolerance::Absolute(1e-5),
    );
}

/// The picture, and the factor at each of its pixels.
fn keep_pictures(record: &mut Record, scene: &Scene) -> Result<(), SandboxError> {
    let refused = SandboxError::refused(ID);
    let picture = scene
        .picture
        .as_ref()
        .map(|picture| picture.levels().clone());
    let levels = picture.ok_or_else(|| refused("a picture is needed".to_owned()))?;
    let rigidity = scene.snake.body().maps.rigidity.clone();
    let map = rigidity.ok_or_else(|| refused("a map is needed".to_owned()))?;
    let factor = Array2::from_shape_fn(levels.dim(), |(y, x)| map.at(DVec2::new(real(x), real(y))));
    record.keep_grid("picture", levels);
    record.keep_grid("factor", factor);
    Ok(())
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let shown = grey(record.grid("picture")?);
    let ring = |table: &str| -> Result<Vec<(f64, f64)>, SandboxError> {
        let mut points = record.points(table, "x", "y")?;
        points.extend(points.first().copied());
        Ok(points)
    };
    let mut panels = Vec::new();
    for (words, table, color) in [
        ("soft", "curve-soft", Color::SKY),
        ("stiff", "curve-stiff", Color::YELLOW),
        ("stiff, and soft at edges", "curve-map", Color::RED),
    ] {
        let panel = Panel::pixels(words, 96, 96).bare();
        let panel = panel.with(Picture::new(shown.clone()));
        panels.push(panel.with(Line::new(ring(table)?, color).weighing(1.6)));
    }
    let factor = record.grid("factor")?.mapv(|factor| 255.0 * factor);
    let ground = Panel::pixels("the factor: 1 white, 1/200 black", 96, 96).bare();
    let ground = ground.with(Picture::new(grey(&factor)));
    let ground = ground.with(Line::new(ring("curve-map")?, Color::RED));
    let mut constants = Vec::new();
    for share in SHARES {
        let (door, corners) = off(record, &named(share))?;
        constants.push((corners, door));
    }
    let dots = |case: &str, label: &str, color: Color| -> Result<Layer, SandboxError> {
        let (door, corners) = off(record, case)?;
        Ok(Layer::Dots {
            points: vec![(corners, door)],
            radius: 3.0,
            color,
            label: label.to_owned(),
        })
    };
    let plot = Panel::new(
        "errors",
        Axis::new("from the corners / px", 0.0, 6.0),
        Axis::new("out of the door / px", 0.0, 13.0),
    )
    .with(Line::new(constants.clone(), Color::GREY).named("constant, soft to stiff"))
    .with(Layer::Dots {
        points: constants,
        radius: 1.4,
        color: Color::GREY,
        label: String::new(),
    })
    .with(dots("map", "map", Color::RED)?)
    .with(dots(
        "map, noise 20",
        "map, noise 20 for 12",
        Color::ORANGE,
    )?)
    .with(dots("map, noise 25", "map, noise 25", Color::PURPLE)?)
    .with(dots("map from 0.02 on", "map from 0.02 on", Color::BLUE)?)
    .legend_at(Corner::TopRight);
    let figure = Figure::new(
        "§3.4.1  Tension and rigidity from the image: a door and four corners",
        900.0,
    )
    .with(290.0, panels)
    .with(290.0, vec![ground, plot]);
    Ok(vec![Artefact::figure(
        "Above: under the same pressure and in the same noise, soft (3 % of the stiffness), stiff, and stiff with the map. Below: \
         the map, and both errors of every run; the grey line is what constants can do.",
        figure,
    )])
}
