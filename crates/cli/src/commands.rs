//! What each command does with its flags: a scene, a run, files.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressStyle};
use scene::integrator::Scheme;
use scene::snake::Outcome;
use scene::{Contour, Picture, Record, Scene, SceneError, paint};

use crate::args;

type Answer = Result<ExitCode, SceneError>;

/// Colours of the start and of the result over a picture.
const START: [u8; 3] = [86, 180, 233];
const FOUND: [u8; 3] = [230, 97, 1];

pub(crate) fn run(args: &args::Run) -> Answer {
    let path = Path::new(&args.scene);
    let mut scene = if path.extension().is_some() || path.components().count() > 1 {
        Scene::load(path)?
    } else {
        Scene::named(&args.scene)?
    };
    let plan = &mut scene.plan;
    if let Some(name) = &args.scheme {
        plan.scheme = name.parse::<Scheme>().map_err(|e| key("--scheme", e))?;
    }
    plan.dt = args.dt.unwrap_or(plan.dt);
    plan.until.steps = args.steps.unwrap_or(plan.until.steps);
    plan.force |= args.force;
    plan.recording.every = args
        .every
        .or(plan.recording.every)
        .map(|every| every.max(1));
    plan.recording.velocities |= args.velocities;
    plan.recording.energies |= args.energies;
    if args.record.is_none() {
        // nobody will see them
        plan.recording.every = None;
        plan.recording.steps.clear();
    }
    if args.overlay.is_some() && scene.picture.is_none() {
        return Err(key("--overlay", "this scene has no picture to draw on"));
    }
    let record = watched(&mut scene)?;
    if let Some(file) = &args.record {
        if file.as_os_str() == "-" {
            print!("{}", record.to_json_lines()?);
        } else {
            record.save(file)?;
        }
    }
    leave(
        &scene,
        &record,
        args.out.as_deref(),
        args.overlay.as_deref(),
    )
}

pub(crate) fn fit(args: &args::Fit) -> Answer {
    let fit = scene::Fit {
        nodes: args.nodes,
        closed: match (args.open, args.closed) {
            (true, _) => Some(false),
            (_, true) => Some(true),
            _ => None,
        },
        tether: args.tether,
        tension: args.tension,
        rigidity: args.rigidity,
        damping: args.damping,
        sigma: args.sigma,
        strength: args.strength,
        dt: args.dt,
        steps: args.steps,
    };
    let picture = Picture::load(&args.image)?;
    let contour = Contour::load(&args.from)?;
    let mut scene = fit.scene(picture, &contour)?;
    let record = watched(&mut scene)?;
    let out = args.out.as_deref().unwrap_or_else(|| Path::new("-"));
    leave(&scene, &record, Some(out), args.overlay.as_deref())
}

pub(crate) fn field(args: &args::Field) -> Answer {
    let picture = Picture::load(&args.image)?;
    let smoothing = match (args.sigma, args.passes) {
        (Some(sigma), _) => scene::field::Smoothing::Gaussian(sigma),
        (None, Some(passes)) => scene::field::Smoothing::Binomial(passes),
        (None, None) => scene::field::Smoothing::Binomial(scene::field::REPORT_PASSES),
    };
    for file in scene::write_stages(&picture, smoothing, &args.out)? {
        println!("{}", file.display());
    }
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn list(args: &args::List) -> Answer {
    match args.what {
        args::What::Scenes => {
            for (name, _) in scene::SCENES {
                let scene = Scene::named(name)?;
                let report = scene.report.map_or_else(String::new, |r| format!(" ({r})"));
                println!("{name:26} {}{report}", scene.title);
            }
        }
        args::What::Schemes => {
            for scheme in Scheme::ALL {
                println!("{:18} {}", scheme.name(), scheme.summary());
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Run a scene with a progress bar on standard error, when a person is there to see it.
fn watched(scene: &mut Scene) -> Result<Record, SceneError> {
    let bar = ProgressBar::new(scene.plan.until.steps);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps {eta}") {
        bar.set_style(style);
    }
    let record = scene.run(&mut |state| {
        if state.step % 256 == 0 {
            bar.set_position(state.step);
        }
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    record
}

/// Write what was asked for, say how it ended, and turn that into a code.
fn leave(scene: &Scene, record: &Record, out: Option<&Path>, overlay: Option<&Path>) -> Answer {
    let (Some(first), Some(last)) = (record.frames.first(), record.last()) else {
        return Err(key("run", "nothing was kept"));
    };
    eprintln!("{}: {}, t = {:.6}", scene.title, record.outcome, last.t);
    let contour = Contour {
        closed: Some(record.closed),
        points: last.nodes.clone(),
    };
    match out {
        Some(path) if path.as_os_str() == "-" => print!("{}", contour.to_text()),
        Some(path) => contour.save(path)?,
        None => {}
    }
    if let (Some(path), Some(picture)) = (overlay, &scene.picture) {
        let curves: [(&[_], bool, [u8; 3]); 2] = [
            (&first.nodes, record.closed, START),
            (&last.nodes, record.closed, FOUND),
        ];
        paint::save_png(&paint::overlay(picture, &curves), path)?;
    }
    let short =
        matches!(record.outcome, Outcome::Finished { .. }) && scene.plan.until.rest.is_some();
    Ok(if record.outcome.is_good() && !short {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    })
}

fn key(key: &str, message: impl ToString) -> SceneError {
    SceneError::Key {
        key: key.to_owned(),
        message: message.to_string(),
    }
}
