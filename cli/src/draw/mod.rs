//! `hamel draw`: draws a mechanism at a state, or a motion.

mod shapes;

use crate::failure::{self, Failure, print};
use crate::outputs;
use crate::parse::{Expected, positive};
use crate::robot::RobotOptions;
use crate::simulate::InputArguments;
use crate::source;
use clap::Args;
use hamel_codegen::generate::Generated;
use hamel_engine::{InputSource, Samples, Scene, Session, Simulation, Source, State, Stepping};
use hamel_files::number::short;
use hamel_report::plot::Figure;
use hamel_report::plot::space::{ISOMETRIC, Space, Vector, base, space};
use shapes::Shapes;
use std::path::PathBuf;

/// Number of points of a path.
const PATH_POINTS: usize = 600;
/// Name of the default view.
const DEFAULT_VIEW: &str = "isometric";

/// Draws the mechanism at a state, or in motion, as SVG.
///
/// Bodies are drawn as the solid ellipsoids that have their masses and inertias; a body without an inertia is a ball,
/// and so is a particle. Frames show their axes: the first in red, the second in green, the third in blue. Short thick
/// lines are the axes of joints, rings are joints without an axis and points that a loop brings together. The direction
/// opposite to gravity points up; with gravity, a floor with a grid is drawn below.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel draw arm.urdf --out arm.svg
  hamel draw heavy_top.eom --at state.json --out top.svg
  hamel draw furuta.eom --time 0.8 --out furuta.svg
  hamel draw furuta.eom --motion 2 --poses 8 --trace rod --out furuta.svg
  hamel draw four_bar.eom --view -80,15 > four_bar.svg")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// State, by coordinates or by joints, instead of the start; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Draw the state after a run of this length, in the description's unit of time (s).
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    time: Option<f64>,
    /// Draw a motion of this length (s) from there on: its end, with earlier poses faintly behind it.
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    motion: Option<f64>,
    /// Number of earlier poses of a motion.
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u16).range(..=200), requires = "motion")]
    poses: u16,
    /// Draw the path of this frame's origin in the motion; once for each frame.
    #[arg(long, value_name = "FRAME", requires = "motion")]
    trace: Vec<String>,
    /// Direction of view: `isometric`, or azimuth and elevation in degrees. The azimuth is counted about the vertical
    /// from the first axis of the world; -90 looks along the second axis.
    #[arg(long, value_name = "AZIMUTH,ELEVATION", default_value = DEFAULT_VIEW, value_parser = view, allow_hyphen_values = true)]
    view: (f64, f64),
    /// Output file; default: standard output.
    #[arg(long, value_name = "F.svg")]
    out: Option<PathBuf>,
    #[command(flatten)]
    inputs: InputArguments,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Runs the motion, if any, and writes the picture.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (out, at) = (arguments.out.as_deref(), arguments.at.as_deref());
    let given = &arguments.inputs;
    let until = arguments.time.unwrap_or(0.0) + arguments.motion.unwrap_or(0.0);
    if until == 0.0 && (given.inputs.is_some() || !given.input.is_empty()) {
        return Err(Failure::usage(
            "--inputs and --input act on a motion: give its length by --time or --motion as well",
        ));
    }
    outputs::svg("--out", out)?;
    outputs::apart(
        [("--out", out)],
        [Some(arguments.file.as_path()), at, given.inputs.as_deref()],
    )?;
    let source = source::open(&arguments.file, &arguments.robot)?.showing_frames();
    let session = match until > 0.0 {
        true => Session::with_default_functions(source)?,
        false => Session::for_drawing(source)?,
    };
    let state = session.read_state(at)?;
    let traced_frames = traced_frames(session.generated(), &arguments.trace)?;
    let drawing = session.drawing()?;
    let moments = match until > 0.0 {
        true => moments(arguments, &session, &state, until)?,
        false => Moments {
            poses: vec![state.x.clone()],
            path: Vec::new(),
        },
    };
    let drawn = drawing.with_parameters(&state.params);
    let scenes: Vec<Scene> = moments.poses.iter().map(|x| drawn.scene(x)).collect();
    let Some((last, before)) = scenes.split_last() else {
        return Ok(());
    };
    if last.is_empty() {
        return Err(Failure::failed(format!(
            "nothing of {} can be drawn: it has no frames, bodies or particles, only energies. Place a part of it by a statement such as `frame f = pose(R, r);`{}",
            session.name(),
            drawing
                .unplaced_parts()
                .iter()
                .map(|part| format!("\n  {part}"))
                .collect::<String>()
        )));
    }
    for part in drawing.unplaced_parts() {
        failure::warn(&format!("not drawn: {part}\n"));
    }
    let path = |frame: usize| -> Vec<Vector> {
        let scenes = moments.path.iter().map(|x| drawn.scene(x));
        scenes.map(|scene| scene.frames[frame].position).collect()
    };
    let picture = Space {
        subtitle: caption(arguments),
        eye: arguments.view,
        poses: before
            .iter()
            .map(|scene| Shapes::new(last).faint(scene))
            .collect(),
        paths: traced_frames.into_iter().map(path).collect(),
        ..still(session.name(), last)
    };
    let text = space(&picture).standalone();
    match &arguments.out {
        Some(out) => {
            failure::write(out, &text)?;
            print(&format!("wrote {}\n", out.display()))
        }
        None => print(&text),
    }
}

/// Draws the mechanism at the start; `None` if nothing of it has a place in space.
pub fn at_start(source: Source) -> Result<Option<Figure>, Failure> {
    let session = Session::for_drawing(source.showing_frames())?;
    let state = session.read_state(None)?;
    let scene = session
        .drawing()?
        .with_parameters(&state.params)
        .scene(&state.x);
    Ok((!scene.is_empty()).then(|| space(&still(session.name(), &scene))))
}

/// Returns the picture of a single pose, from the default direction.
fn still(name: &str, scene: &Scene) -> Space {
    let vertical = scene.gravity.map(|entry| -entry);
    Space {
        title: name.into(),
        subtitle: "at the start".into(),
        base: base(vertical),
        eye: ISOMETRIC,
        floor: vertical.iter().any(|entry| *entry != 0.0),
        parts: Shapes::new(scene).of(scene),
        poses: Vec::new(),
        paths: Vec::new(),
    }
}

/// Coordinates at the drawn times.
struct Moments {
    /// Earlier poses, then the pose that is drawn in full.
    poses: Vec<Vec<f64>>,
    /// Points of the paths.
    path: Vec<Vec<f64>>,
}

/// Runs the motion and samples it.
fn moments(
    arguments: &Arguments,
    session: &Session,
    state: &State,
    until: f64,
) -> Result<Moments, Failure> {
    let begin = arguments.time.unwrap_or(0.0);
    let length = until - begin;
    let parts = if arguments.motion.is_some() {
        usize::from(arguments.poses)
    } else {
        0
    };
    let equal = |parts: usize| -> Vec<f64> {
        let times = (0..=parts).map(|part| match parts - part {
            0 => until,
            _ => begin + length * part as f64 / parts as f64,
        });
        times.collect()
    };
    let poses = equal(parts);
    let path = match arguments.trace.is_empty() {
        true => Vec::new(),
        false => equal(PATH_POINTS),
    };
    let mut times: Vec<f64> = poses.iter().chain(&path).copied().collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let simulation = Simulation {
        samples: Samples::At(times),
        inputs: InputSource::Options(arguments.inputs.read()?),
        ..Simulation::new(Stepping::until(until))
    };
    let run = session.simulate(state, &simulation)?;
    if let Some(why) = run.failure {
        return Err(Failure::failed(why.to_string()));
    }
    let at = |time: &f64| {
        let away = |place: usize| (run.samples[place].t - time).abs();
        let nearest = (0..run.samples.len()).min_by(|a, b| away(*a).total_cmp(&away(*b)));
        nearest.map(|place| run.samples[place].x.clone())
    };
    Ok(Moments {
        poses: poses.iter().filter_map(at).collect(),
        path: path.iter().filter_map(at).collect(),
    })
}

/// Returns the indices of the frames whose paths are drawn.
fn traced_frames(generated: &Generated, names: &[String]) -> Result<Vec<usize>, Failure> {
    let frames = &generated.active.frames;
    let mut unknown = Vec::new();
    let mut found = Vec::new();
    for name in names {
        match frames.iter().position(|frame| frame.name == *name) {
            Some(place) => found.push(place),
            None => unknown.push(name.as_str()),
        }
    }
    if unknown.is_empty() {
        return Ok(found);
    }
    let known: Vec<&str> = frames.iter().map(|frame| frame.name.as_str()).collect();
    let known = match known.as_slice() {
        [] => "the description has no frames".into(),
        known => format!("the frames are {}", known.join(", ")),
    };
    Err(Failure::usage(format!(
        "--trace: no frame is called {}; {known}",
        unknown.join(", ")
    )))
}

/// Describes the drawn time for the caption.
fn caption(arguments: &Arguments) -> String {
    match (arguments.time, arguments.motion) {
        (None, None) if arguments.at.is_some() => "at the state given".into(),
        (None, None) => "at the start".into(),
        (Some(time), None) => format!("at t = {}", short(time)),
        (begin, Some(length)) => {
            let begin = begin.unwrap_or(0.0);
            format!("from t = {} to {}", short(begin), short(begin + length))
        }
    }
}

fn view(text: &str) -> Result<(f64, f64), Expected> {
    if text == DEFAULT_VIEW {
        return Ok(ISOMETRIC);
    }
    let number = |text: &str| {
        let number = text.trim().parse::<f64>().ok();
        number.filter(|number| number.is_finite() && number.abs() <= 360.0)
    };
    let angles = text
        .split_once(',')
        .and_then(|(azimuth, elevation)| Some((number(azimuth)?, number(elevation)?)));
    angles.ok_or(Expected::View(DEFAULT_VIEW))
}
