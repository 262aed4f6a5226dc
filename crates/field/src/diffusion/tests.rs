use super::*;
use glam::DVec2;

const PLAIN: VectorFlow = VectorFlow {
    rule: FlowRule::Plain { smoothness: 0.2 },
    residual: 1e-9,
};
const GENERAL: VectorFlow = VectorFlow {
    rule: FlowRule::Generalised { spread: 0.05 },
    residual: 1e-9,
};

/// A map of two edges and some texture.
fn map(height: usize, width: usize) -> Grid {
    Grid::from_shape_fn((height, width), |(y, x)| {
        let edge = |d: f64| (-d * d / 4.0).exp();
        edge(x as f64 - 0.3 * width as f64)
            + 0.6 * edge(y as f64 - 0.8 * height as f64)
            + 0.01 * ((x * 7 + y * 13) % 5) as f64
    })
}

/// The slow obvious solver: plain sweeps of the flow's own equation until nothing moves.
fn slow(map: &Grid, rule: FlowRule) -> (Grid, Grid) {
    let (height, width) = map.dim();
    let (low, high) = map
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let (fx, fy) = gradient(&map.mapv(|v| (v - low) / (high - low)));
    let solve = |f: &Grid| {
        let mut v = f.clone();
        for _ in 0..20_000 {
            for y in 0..height {
                for x in 0..width {
                    let s = fx[[y, x]].powi(2) + fy[[y, x]].powi(2);
                    let (g, h) = match rule {
                        FlowRule::Plain { smoothness } => (smoothness, s),
                        FlowRule::Generalised { spread } => {
                            let g = (-s.sqrt() / spread).exp();
                            (g, 1.0 - g)
                        }
                    };
                    let (mut sum, mut n) = (0.0, 0.0);
                    for (dy, dx) in [(0, 1), (0, -1), (1, 0), (-1, 0)] {
                        let at = (y.checked_add_signed(dy), x.checked_add_signed(dx));
                        if let (Some(y), Some(x)) = at
                            && let Some(v) = v.get([y, x])
                        {
                            (sum, n) = (sum + v, n + 1.0);
                        }
                    }
                    v[[y, x]] = (g * sum + h * f[[y, x]]) / (g * n + h);
                }
            }
        }
        v
    };
    (solve(&fx), solve(&fy))
}

#[test]
fn the_flow_is_the_slow_solvers() {
    for flow in [PLAIN, GENERAL] {
        for (height, width) in [(17, 23), (16, 16), (1, 19), (9, 1), (2, 3)] {
            let map = map(height, width);
            let fast = vector_flow(&map, &flow).unwrap();
            let (x, y) = slow(&map, flow.rule);
            let (fx, fy) = fast.field.components();
            let difference = |a: &Grid, b: &Grid| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f64::max)
            };
            let worst = difference(&fx, &x).max(difference(&fy, &y));
            assert!(
                worst < 1e-5,
                "{height} × {width}: {worst:e}, {} cycles",
                fast.cycles
            );
        }
    }
}

#[test]
fn the_residual_asked_for_is_reached_in_few_cycles_whatever_the_size() {
    for flow in [PLAIN, GENERAL] {
        for side in [32, 64, 128, 200] {
            let got = vector_flow(&map(side, side), &flow).unwrap();
            assert!(
                got.residual <= 1e-9 && got.cycles <= 40,
                "{side}: {} cycles",
                got.cycles
            );
        }
    }
}

#[test]
fn the_flow_reaches_across_the_picture() {
    // one edge at the left of a wide, empty picture
    let map = Grid::from_shape_fn((40, 160), |(_, x)| (-(x as f64 - 10.0).powi(2) / 4.0).exp());
    let plain = gradient(&map).0;
    let flow = vector_flow(&map, &PLAIN).unwrap().field;
    assert!(plain[[20, 100]].abs() < 1e-100);
    let force = flow.at(DVec2::new(100.0, 20.0));
    assert!(
        force.x < -1e-4 && force.y.abs() < 1e-3 * force.x.abs(),
        "{force}"
    );
}

#[test]
fn a_constant_map_flows_nowhere_and_bad_numbers_are_refused() {
    let flat = Grid::from_elem((5, 6), 3.0);
    let flow = vector_flow(&flat, &PLAIN).unwrap();
    assert!(flow.field.largest() <= 0.0 && flow.cycles == 0);
    let bad = |rule, residual| vector_flow(&map(5, 5), &VectorFlow { rule, residual }).is_err();
    assert!(bad(FlowRule::Plain { smoothness: 0.0 }, 1e-6));
    assert!(bad(FlowRule::Generalised { spread: f64::NAN }, 1e-6));
    assert!(bad(PLAIN.rule, 0.0));
    assert!(vector_flow(&Grid::zeros((0, 0)), &PLAIN).is_err());
}

#[test]
fn the_unit_of_the_map_does_not_matter() {
    let map = map(20, 30);
    let (a, b) = (
        vector_flow(&map, &GENERAL).unwrap(),
        vector_flow(&(map * 64.0), &GENERAL).unwrap(),
    );
    let ((ax, ay), (bx, by)) = (a.field.components(), b.field.components());
    for (a, b) in ax.iter().chain(&ay).zip(bx.iter().chain(&by)) {
        assert!((a - b).abs() < 1e-8);
    }
}
