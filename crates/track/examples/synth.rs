//! Development: the drawn sequences.
use glam::DVec2;
fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let verbose = std::env::args().nth(2).is_some();
    let mut all = vec![];
    for mut case in score::sequences::sequences() {
        if let Ok(noise) = std::env::var("NOISE") {
            case.noise = noise.parse().unwrap();
        }
        if !only.is_empty() && !case.name.contains(&only) {
            continue;
        }
        let image = |t: usize| fit::Image::grey(case.frame(t));
        let starts: Vec<(u32, Vec<DVec2>)> = case.start();
        let options = track::Options {
            start: track::Start::Exact,
            births: starts.len() > 2 || case.name == "divide" || std::env::var("BIRTHS").is_ok(),
            ..Default::default()
        };
        let contours: Vec<fit::Contour> = starts
            .iter()
            .map(|(_, p)| fit::Contour::closed(p.clone()))
            .collect();
        let mut tracker = track::Tracker::new(&image(0), &contours, &options).unwrap();
        let ids: Vec<u32> = starts.iter().map(|s| s.0).collect();
        let (mut sum, mut count, mut worst, mut hidden) = (0.0, 0.0, 1.0_f64, vec![]);
        let mut time = 0.0;
        let [w, h] = case.size;
        let mut tracks = score::tracking::Tracks::default();
        let mut lives: [std::collections::BTreeMap<u32, (usize, usize)>; 2] = Default::default();
        let mut parents = std::collections::BTreeMap::new();
        let mut add = |t: usize, tracked: &track::Tracked| {
            let outlines: Vec<(u32, Vec<DVec2>)> = tracked
                .outlines
                .iter()
                .map(|o| (o.id, o.points.clone()))
                .collect();
            for o in &tracked.outlines {
                parents.extend(o.parent.map(|parent| (o.id, parent)));
            }
            let found = score::tracking::labelled(&outlines, (h, w));
            let truth = case.labels(t);
            tracks.add(&found, &truth).unwrap();
            for (lives, labels) in lives.iter_mut().zip([&found, &truth]) {
                for &label in labels.iter().filter(|label| **label > 0) {
                    lives.entry(label).or_insert((t, t)).1 = t;
                }
            }
        };
        add(0, tracker.first());
        for t in 1..case.frames() {
            let frame = image(t);
            let clock = std::time::Instant::now();
            let tracked = tracker.next(&frame).unwrap();
            time += clock.elapsed().as_secs_f64();
            add(t, &tracked);
            for e in &tracked.events {
                if verbose {
                    println!("   {t}: {e:?}");
                }
            }
            for (id, truth) in case.truth(t) {
                if truth.is_empty() {
                    continue;
                }
                let at = ids.iter().position(|i| *i == id);
                let found =
                    at.and_then(|at| tracked.outlines.iter().find(|o| o.id as usize == at + 1));
                let iou = |o: &track::Outline| {
                    score::iou(
                        &score::filled(&[&o.points[..]], (h, w)),
                        &score::filled(&[&truth[..]], (h, w)),
                    )
                    .unwrap()
                };
                // objects that come later are those that overlap most
                let found = if at.is_some() {
                    found
                } else {
                    tracked
                        .outlines
                        .iter()
                        .max_by(|a, b| iou(a).total_cmp(&iou(b)))
                };
                let i = found.map_or(0.0, iou);
                if verbose {
                    println!(
                        "   {t} id {id} iou {i:.3} {:?}",
                        found.map(|o| {
                            let c = o.points.iter().sum::<DVec2>() / o.points.len() as f64;
                            let tc = truth.iter().sum::<DVec2>() / truth.len() as f64;
                            let r = |p: &[DVec2]| {
                                let n = p.len();
                                ((0..n)
                                    .map(|i| p[i].perp_dot(p[(i + 1) % n]))
                                    .sum::<f64>()
                                    .abs()
                                    / 6.2832)
                                    .sqrt()
                            };
                            (
                                ((c - tc) * 10.0).round() / 10.0,
                                (r(&o.points) / r(&truth) * 100.0).round() / 100.0,
                                o.state,
                                (o.confidence * 100.0).round() / 100.0,
                                o.prediction,
                            )
                        })
                    );
                }
                sum += i;
                count += 1.0;
                worst = worst.min(i);
            }
            for o in &tracked.outlines {
                if o.state == track::State::Coasting {
                    hidden.push(t);
                }
            }
        }
        println!(
            "{:14} objects {:2} mean {:.3} worst {worst:.3} hidden {hidden:?} {:.1} ms/frame",
            case.name,
            starts.len(),
            sum / count,
            1e3 * time / case.frames() as f64
        );
        if options.births || starts.len() > 1 {
            let table = |which: usize| -> Vec<score::tracking::Lineage> {
                lives[which]
                    .iter()
                    .map(|(&label, &(begin, end))| {
                        let parent = if which == 0 {
                            parents.get(&label).copied()
                        } else {
                            case.parents.iter().find(|p| p.0 == label).map(|p| p.1)
                        };
                        let parent =
                            parent.filter(|p| lives[which].get(p).is_some_and(|l| l.1 < begin));
                        score::tracking::Lineage {
                            label,
                            begin,
                            end,
                            parent: parent.unwrap_or(0),
                        }
                    })
                    .collect()
            };
            let (found, truth) = (table(0), table(1));
            let s = tracks.finish(&found, &truth).unwrap();
            let three = |v: Option<f64>| v.map(|v| (v * 1e3).round() / 1e3);
            println!(
                "   SEG {:?} DET {:?} TRA {:?} IDF1 {:?} switches {} divisions {:?} ids {} {:?}",
                three(s.seg),
                three(s.det),
                three(s.tra),
                three(s.idf1),
                s.switches,
                s.divisions,
                found.len(),
                s.errors
            );
        }
        all.push(sum / count);
    }
    println!(
        "mean {:.3} of the first 15: {:.3}",
        all.iter().sum::<f64>() / all.len() as f64,
        all.iter().take(15).sum::<f64>() / all.len().min(15) as f64
    );
}
