//! Development: the open sequences.
use glam::DVec2;
use io::Picture;
use std::path::Path;
fn main() {
    let root = std::env::args().nth(1).unwrap();
    let only = std::env::args().nth(2);
    let verbose = std::env::args().nth(3).is_some();
    let text = std::fs::read_to_string(format!("{root}/inits.csv")).unwrap();
    for name in ["phase_cell_50", "davis_blackswan", "ball_bounce"] {
        if only
            .as_ref()
            .is_some_and(|o| !o.is_empty() && !name.contains(o.as_str()))
        {
            continue;
        }
        let mut files: Vec<_> = std::fs::read_dir(format!("{root}/{name}"))
            .unwrap()
            .map(|e| e.unwrap().path())
            .collect();
        files.sort();
        let frames: Vec<_> = files
            .iter()
            .filter(|p| !p.to_str().unwrap().contains("mask"))
            .collect();
        let masks: Vec<_> = files
            .iter()
            .filter(|p| p.to_str().unwrap().contains("mask"))
            .collect();
        let load = |p: &Path| Picture::load(p).unwrap();
        let mask = |p: &Path| {
            let m = load(p);
            m.levels().mapv(|v| v > 127.0)
        };
        let near: Vec<DVec2> = text
            .lines()
            .find(|l| l.starts_with(&format!("{name},near")))
            .unwrap()
            .rsplit(',')
            .next()
            .unwrap()
            .split(';')
            .map(|p| {
                let mut it = p.split(' ').map(|v| v.parse::<f64>().unwrap());
                DVec2::new(it.next().unwrap(), it.next().unwrap())
            })
            .collect();
        let truth = io::shapes::load(masks[0]).unwrap();
        let truth: Vec<DVec2> = truth[0].first().to_vec();
        for (kind, start) in [("near", near), ("true", truth)] {
            let first = fit::Image::of(std::sync::Arc::new(load(frames[0])));
            let rule = if std::env::var("NOFIT").is_ok() {
                track::Start::Exact
            } else {
                track::Start::Chosen
            };
            let options = track::Options {
                start: rule,
                ..Default::default()
            };
            let mut dev =
                track::Tracker::new(&first, &[fit::Contour::closed(start.clone())], &options)
                    .unwrap();
            let used = dev.first().outlines[0].points.clone();
            let mut ious = vec![];
            let mut ratios: Vec<f64> = vec![];
            let t = std::time::Instant::now();
            let mut loadtime = 0.0;
            let m0 = mask(masks[0]);
            let i0 = score::iou(&score::filled(&[&used[..]], m0.dim()), &m0).unwrap();
            for (f, m) in frames.iter().zip(&masks).skip(1).filter({
                let mut k = 0;
                let stride: usize = std::env::var("STRIDE")
                    .ok()
                    .and_then(|v| v.parse().ok())
                    .unwrap_or(1);
                move |_| {
                    k += 1;
                    k % stride == 0
                }
            }) {
                let t0 = std::time::Instant::now();
                let pic = load(f);
                let truth = mask(m);
                loadtime += t0.elapsed().as_secs_f64();
                let pic = fit::Image::of(std::sync::Arc::new(pic));
                let tracked = dev.next(&pic).unwrap();
                if tracked.outlines.is_empty() {
                    ious.push(0.0);
                    continue;
                }
                let o = &tracked.outlines[0];
                let (outline, seen, conf, pred) = (&o.points, o.state, o.confidence, o.prediction);
                if let Ok(dump) = std::env::var("DUMP") {
                    use std::io::Write;
                    let mut f = std::fs::OpenOptions::new()
                        .create(true)
                        .append(true)
                        .open(format!("{dump}_{name}_{kind}.csv"))
                        .unwrap();
                    for p in outline {
                        writeln!(f, "{},{},{}", ious.len() + 1, p.x, p.y).unwrap();
                    }
                }
                let found = score::filled(&[&outline[..]], truth.dim());
                let i = score::iou(&found, &truth).unwrap();
                if verbose {
                    println!(
                        "   {:?} {i:.3} {seen:?} conf {conf:.2} {pred:?}",
                        f.file_name().unwrap()
                    );
                }
                let area = |m: &ndarray::Array2<bool>| m.iter().filter(|v| **v).count() as f64;
                ratios.push(area(&found) / area(&truth));
                ious.push(i);
            }
            let mean = ious.iter().sum::<f64>() / ious.len() as f64;
            let min = ious.iter().copied().fold(1.0, f64::min);
            println!(
                "{name:18} {kind} start {i0:.3} mean {mean:.3} last {:.3} min {min:.3} area {:.3} {:.3} {:.3}  {:.1} ms/frame",
                ious.last().unwrap(),
                ratios[4],
                ratios[ratios.len() / 2],
                ratios.last().unwrap(),
                1e3 * (t.elapsed().as_secs_f64() - loadtime) / ious.len() as f64
            );
        }
    }
}
