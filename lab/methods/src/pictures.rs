//! Pictures of the report that show motions: the flip of a free body, and Poinsot's construction.

use crate::runner::BenchError;
use hamel::methods::Rkmk4;
use hamel::{State, integrate};
use hamel_cases::models::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use hamel_report::page::Picture;
use hamel_report::plot::{self, Panel, Path, PlotError, Poinsot};

/// Moments of inertia of a plate, and its start near the middle axis.
const INERTIA: [f64; 3] = [1.0, 2.0, 3.0];
const START_VELOCITY: [f64; 3] = [1e-3, 1.0, 0.0];
const DURATION: f64 = 100.0;
const STEP_LENGTH: f64 = 0.01;
/// Number of steps between two points.
const STEPS_PER_POINT: u32 = 10;

/// Draws both pictures, and returns them with the names of their files.
///
/// # Errors
/// If the motion or the drawing fails.
pub fn motions() -> Result<Vec<(&'static str, Picture)>, BenchError> {
    let [j1, j2, j3] = INERTIA;
    let body = PrincipalAxes::new(PrincipalAxesParameters { j1, j2, j3 })
        .map_err(|error| BenchError(error.to_string()))?;
    let mut state: State<PrincipalAxes<f64>> = State::start(&body);
    state.xi = START_VELOCITY;
    let mut track = Vec::new();
    let mut count = 0;
    integrate(
        &body,
        Rkmk4,
        &mut state,
        STEP_LENGTH,
        DURATION,
        |_, _: &_, _: &_| [],
        |state| {
            if count % STEPS_PER_POINT == 0 {
                track.push(state.clone());
            }
            count += 1;
        },
    )
    .map_err(|error| BenchError(error.to_string()))?;

    let mut panel = Panel::new("angular velocity, body axes");
    for axis in 0..3 {
        let values = track.iter().map(|state| state.xi[axis]).collect();
        panel
            .lines
            .push((format!("ω{}", ["₁", "₂", "₃"][axis]), values));
    }
    let momentum = |w: &[f64; 3]| std::array::from_fn(|i| INERTIA[i] * w[i]);
    let poinsot = Poinsot {
        momenta: track.iter().map(|state| momentum(&state.xi)).collect(),
        inertia: [[j1, 0.0, 0.0], [0.0, j2, 0.0], [0.0, 0.0, j3]],
    };
    let flip = plot::Picture {
        title: "The Dzhanibekov flip".into(),
        subtitle: "A plate with J = (1, 2, 3) spins about its middle axis, 10⁻³ beside it.".into(),
        time: track.iter().map(|state| state.t).collect(),
        panels: vec![panel],
        path: Some(Path {
            title: "body axis 2 in the world".into(),
            points: track
                .iter()
                .map(|state| [state.x[1], state.x[4], state.x[7]])
                .collect(),
        }),
        poinsot: None,
    };
    let said = |error: PlotError| BenchError(error.to_string());
    let construction = plot::construction(
        "Poinsot's construction",
        "The same motion: P stays where sphere and ellipsoid meet.",
        &poinsot,
        DURATION,
    );
    Ok(vec![
        (
            "flip",
            Picture {
                title: flip.title.clone(),
                figure: plot::run(&flip).map_err(said)?,
            },
        ),
        (
            "poinsot",
            Picture {
                title: "Poinsot's construction".into(),
                figure: construction.map_err(said)?,
            },
        ),
    ])
}
