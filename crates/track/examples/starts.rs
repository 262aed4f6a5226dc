use glam::DVec2;
use io::Picture;
fn parse(s: &str) -> Vec<DVec2> {
    s.trim_matches('"')
        .split(';')
        .map(|p| {
            let mut it = p.trim().split(' ').map(|v| v.parse::<f64>().unwrap());
            DVec2::new(it.next().unwrap(), it.next().unwrap())
        })
        .collect()
}
fn main() {
    let root = "../../shared/data";
    let mut jobs: Vec<(String, String, Vec<(String, Vec<DVec2>)>)> = vec![];
    let objs = std::fs::read_to_string(format!("{root}/objects/inits.csv")).unwrap();
    let more = std::fs::read_to_string(format!("{root}/objects/inits_more.csv")).unwrap();
    let trk = std::fs::read_to_string(format!("{root}/tracking/inits.csv")).unwrap();
    let mut stems: Vec<String> = objs
        .lines()
        .skip(1)
        .map(|l| l.split(',').next().unwrap().to_owned())
        .collect();
    stems.dedup();
    for stem in stems {
        let file = ["png", "jpg"]
            .iter()
            .map(|e| format!("{root}/objects/{stem}.{e}"))
            .find(|f| std::path::Path::new(f).exists())
            .unwrap();
        let mut s = vec![];
        for text in [&objs, &more] {
            for l in text.lines() {
                let mut it = l.split(',');
                if it.next() == Some(&stem[..]) {
                    let q = it.next().unwrap();
                    if q.starts_with("near") {
                        s.push((q.to_owned(), parse(l.rsplit(',').next().unwrap())));
                    }
                }
            }
        }
        jobs.push((file, format!("{root}/objects/{stem}_mask.png"), s));
    }
    for name in ["phase_cell_50", "davis_blackswan", "ball_bounce"] {
        let e = if name == "phase_cell_50" {
            "png"
        } else {
            "jpg"
        };
        let near = trk
            .lines()
            .find(|l| l.starts_with(&format!("{name},near")))
            .unwrap();
        jobs.push((
            format!("{root}/tracking/{name}/000.{e}"),
            format!("{root}/tracking/{name}/000_mask.png"),
            vec![("near".into(), parse(near.rsplit(',').next().unwrap()))],
        ));
        for k in [10, 20, 30] {
            jobs.push((
                format!("{root}/tracking/{name}/{k:03}.{e}"),
                format!("{root}/tracking/{name}/{k:03}_mask.png"),
                vec![],
            ));
        }
    }
    for (file, mask, mut starts) in jobs {
        let truth = io::shapes::load(std::path::Path::new(&mask)).unwrap();
        let truth = truth
            .iter()
            .map(|s| s.first().to_vec())
            .max_by_key(|p| p.len())
            .unwrap();
        starts.push(("true".into(), truth.clone()));
        let image = fit::Image::of(std::sync::Arc::new(
            Picture::load(std::path::Path::new(&file)).unwrap(),
        ));
        for (kind, start) in starts {
            let prepared = fit::Prepared::of(&image, &fit::Options::default()).unwrap();
            let found = prepared.fit(&fit::Contour::closed(start.clone())).unwrap();
            let poly = search::along::Polygon {
                points: start.clone(),
                closed: true,
            };
            let s = search::find(image.pixels(), &poly, &search::Rules::default()).unwrap();
            let own = s.support(&poly.clone().outwards());
            let f = s.support(
                &search::along::Polygon {
                    points: found.contour.points.clone(),
                    closed: true,
                }
                .outwards(),
            );
            let start = poly.clone().outwards().evenly(200);
            let r = (start.area() / 3.14159).sqrt();
            let normals = start.normals(4.0);
            let off = |d: f64| {
                s.support(&search::along::Polygon {
                    points: start
                        .points
                        .iter()
                        .zip(&normals)
                        .map(|(p, n)| *p + d * r * *n)
                        .collect(),
                    closed: true,
                })
                .edge
            };
            let v: Vec<f64> = [-0.1, -0.075, -0.05, 0.0, 0.05, 0.075]
                .iter()
                .map(|d| off(*d))
                .collect();
            println!(
                "{:26} {kind:6} over {:.3} start {:.3} fit {:.3} ratio {:.2} | own {:.2} in {:.2} {:.2} {:.2} out {:.2} {:.2} peak {:.2}",
                file.rsplit('/').next().unwrap(),
                track::overlap(&start.points, &found.contour.points),
                track::overlap(&start.points, &truth),
                track::overlap(&found.contour.points, &truth),
                own.edge / f.edge,
                v[3],
                v[0],
                v[1],
                v[2],
                v[4],
                v[5],
                v[3] / v[2].max(v[4])
            );
        }
    }
}
