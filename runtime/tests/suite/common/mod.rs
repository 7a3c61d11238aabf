//! Systems written by hand, and the reference solutions, for the tests of the runtime.

pub mod points;

#[cfg(feature = "std")]
use hamel::s1;
use hamel::{Block, Energies, Scalar, Singular, State, System, s3, so3};
use serde_json::Value;
use so3::{Matrix, Vector};

mod split;
#[allow(unused_imports)]
pub use split::Spin;

/// Solves M a = b by M = L D Lᵀ; without roots, so that a diagonal M is divided by exactly.
pub fn solve<S: Scalar, const N: usize>(
    mut m: [[S; N]; N],
    mut b: [S; N],
) -> Result<[S; N], Singular> {
    for i in 0..N {
        for j in 0..=i {
            for k in 0..j {
                let product = m[i][k] * m[j][k] * m[k][k];
                m[i][j] -= product;
            }
            if i != j {
                let pivot = m[j][j];
                m[i][j] /= pivot;
            } else if !m[i][i].is_positive() {
                return Err(Singular::Mass);
            }
        }
    }
    for i in 0..N {
        for k in 0..i {
            let product = m[i][k] * b[k];
            b[i] -= product;
        }
    }
    for i in 0..N {
        b[i] /= m[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            let product = m[k][i] * b[k];
            b[i] -= product;
        }
    }
    Ok(b)
}

pub fn add<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    add(a, b.map(|b| -b))
}

pub fn rows<S: Copy>(m: Matrix<S>) -> [[S; 3]; 3] {
    [[m[0], m[1], m[2]], [m[3], m[4], m[5]], [m[6], m[7], m[8]]]
}

/// Inertia, gravity and start of a body with a fixed point; `m = 0` for a free body.
#[derive(Clone, Debug)]
pub struct Body<S> {
    pub inertia: Matrix<S>,
    pub m: S,
    pub s: Vector<S>,
    pub g: Vector<S>,
    pub r0: Matrix<S>,
    pub w0: Vector<S>,
}

impl<S: Scalar> Body<S> {
    /// J ω̇ = (J ω) × ω + s × (m Rᵀ g)
    pub fn accel(&self, r: Matrix<S>, w: Vector<S>) -> Result<Vector<S>, Singular> {
        let momentum = so3::apply(self.inertia, w);
        let weight = so3::apply_transpose(r, self.g).map(|g| self.m * g);
        let torque = add(so3::cross(momentum, w), so3::cross(self.s, weight));
        solve(rows(self.inertia), torque)
    }

    pub fn kinetic(&self, w: Vector<S>) -> S {
        S::from_f64(0.5) * so3::dot(w, so3::apply(self.inertia, w))
    }

    pub fn potential(&self, r: Matrix<S>) -> S {
        -(self.m * so3::dot(self.g, so3::apply(r, self.s)))
    }
}

/// Heavy top, x = R, ξ = ω (body axes), no input.
#[derive(Clone, Debug)]
pub struct Top<S>(pub Body<S>);

impl<S: Scalar> System for Top<S> {
    type Scalar = S;
    type Coordinates = [S; 9];
    type Velocities = [S; 3];
    type Chart = [S; 3];
    type Inputs = [S; 0];

    fn blocks(&self) -> &[Block] {
        &[Block::Rotation]
    }
    fn start(&self) -> ([S; 9], [S; 3]) {
        (self.0.r0, self.0.w0)
    }
    fn chart_rate(&self, _: &[S; 9], xi: &[S; 3]) -> [S; 3] {
        *xi
    }
    fn forward_dynamics(&self, x: &[S; 9], xi: &[S; 3], _: &[S; 0]) -> Result<[S; 3], Singular> {
        self.0.accel(*x, *xi)
    }
}

impl<S: Scalar> Energies for Top<S> {
    fn kinetic_energy(&self, _: &[S; 9], xi: &[S; 3]) -> S {
        self.0.kinetic(*xi)
    }
    fn potential_energy(&self, x: &[S; 9]) -> S {
        self.0.potential(*x)
    }
}

/// Heavy top, x = q (unit quaternion), ξ = ω (body axes), no input.
#[derive(Clone, Debug)]
pub struct QuaternionTop<S>(pub Body<S>);

impl<S: Scalar> System for QuaternionTop<S> {
    type Scalar = S;
    type Coordinates = [S; 4];
    type Velocities = [S; 3];
    type Chart = [S; 3];
    type Inputs = [S; 0];

    fn blocks(&self) -> &[Block] {
        &[Block::Quaternion]
    }
    fn start(&self) -> ([S; 4], [S; 3]) {
        (s3::from_matrix(self.0.r0), self.0.w0)
    }
    fn chart_rate(&self, _: &[S; 4], xi: &[S; 3]) -> [S; 3] {
        *xi
    }
    fn forward_dynamics(&self, x: &[S; 4], xi: &[S; 3], _: &[S; 0]) -> Result<[S; 3], Singular> {
        self.0.accel(s3::to_matrix(*x), *xi)
    }
}

impl<S: Scalar> Energies for QuaternionTop<S> {
    fn kinetic_energy(&self, _: &[S; 4], xi: &[S; 3]) -> S {
        self.0.kinetic(*xi)
    }
    fn potential_energy(&self, x: &[S; 4]) -> S {
        self.0.potential(s3::to_matrix(*x))
    }
}

/// Free body, x = (r, R), ξ = (v, ω), u = (F, τ), all but r in body axes; KR18 (50).
#[derive(Clone, Debug)]
pub struct FreeBody {
    pub body: Body<f64>,
    pub r0: Vector<f64>,
    pub v0: Vector<f64>,
}

fn position(x: &[f64; 12]) -> Vector<f64> {
    [x[0], x[1], x[2]]
}

fn rotation(x: &[f64; 12]) -> Matrix<f64> {
    std::array::from_fn(|k| x[3 + k])
}

fn twist(xi: &[f64; 6]) -> (Vector<f64>, Vector<f64>) {
    ([xi[0], xi[1], xi[2]], [xi[3], xi[4], xi[5]])
}

fn pose(r: Vector<f64>, rotation: Matrix<f64>) -> [f64; 12] {
    std::array::from_fn(|k| if k < 3 { r[k] } else { rotation[k - 3] })
}

impl FreeBody {
    /// [m I, −m ŝ; m ŝ, Θ]
    fn mass(&self) -> [[f64; 6]; 6] {
        let Body { m, s, inertia, .. } = self.body;
        let coupling = rows(so3::hat(s.map(|s| m * s)));
        let inertia = rows(inertia);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < 3, j < 3) {
                (true, true) => {
                    if i == j {
                        m
                    } else {
                        0.0
                    }
                }
                (true, false) => -coupling[i][j - 3],
                (false, true) => coupling[i - 3][j],
                (false, false) => inertia[i - 3][j - 3],
            })
        })
    }

    /// p = m (v + ω × s), L = m s × v + Θ ω
    fn momentum(&self, v: Vector<f64>, w: Vector<f64>) -> (Vector<f64>, Vector<f64>) {
        let Body { m, s, inertia, .. } = self.body;
        let p = add(v, so3::cross(w, s)).map(|p| m * p);
        let l = add(so3::cross(s, v).map(|l| m * l), so3::apply(inertia, w));
        (p, l)
    }
}

impl System for FreeBody {
    type Scalar = f64;
    type Coordinates = [f64; 12];
    type Velocities = [f64; 6];
    type Chart = [f64; 6];
    type Inputs = [f64; 6];

    fn blocks(&self) -> &[Block] {
        &[Block::Flat(3), Block::Rotation]
    }
    fn start(&self) -> ([f64; 12], [f64; 6]) {
        let ([a, b, c], [d, e, f]) = (self.v0, self.body.w0);
        (pose(self.r0, self.body.r0), [a, b, c, d, e, f])
    }
    fn chart_rate(&self, x: &[f64; 12], xi: &[f64; 6]) -> [f64; 6] {
        let (v, [d, e, f]) = twist(xi);
        let [a, b, c] = so3::apply(rotation(x), v);
        [a, b, c, d, e, f]
    }
    fn forward_dynamics(
        &self,
        x: &[f64; 12],
        xi: &[f64; 6],
        u: &[f64; 6],
    ) -> Result<[f64; 6], Singular> {
        let Body { m, s, g, .. } = self.body;
        let (v, w) = twist(xi);
        let (force, torque) = twist(u);
        let (p, l) = self.momentum(v, w);
        let weight = so3::apply_transpose(rotation(x), g).map(|g| m * g);
        let linear = add(sub(weight, so3::cross(w, p)), force);
        let gyroscopic = add(so3::cross(w, l), so3::cross(v, p));
        let angular = add(sub(so3::cross(s, weight), gyroscopic), torque);

        let ([a, b, c], [d, e, f]) = (linear, angular);
        solve(self.mass(), [a, b, c, d, e, f])
    }
}

impl Energies for FreeBody {
    fn kinetic_energy(&self, _: &[f64; 12], xi: &[f64; 6]) -> f64 {
        let (v, w) = twist(xi);
        let (p, l) = self.momentum(v, w);
        0.5 * (so3::dot(v, p) + so3::dot(w, l))
    }
    fn potential_energy(&self, x: &[f64; 12]) -> f64 {
        let com = add(position(x), so3::apply(rotation(x), self.body.s));
        -self.body.m * so3::dot(self.body.g, com)
    }
}

/// Pendulum θ̈ = −(g/l) sin θ, x = (c, s), ξ = θ̇, in lists of run-time length. Its inertia l² is
/// factored, so that l = 0 is singular.
#[cfg(feature = "std")]
#[derive(Clone, Debug)]
pub struct Pendulum {
    pub g: f64,
    pub l: f64,
    pub theta0: f64,
    pub rate0: f64,
}

#[cfg(feature = "std")]
impl System for Pendulum {
    type Scalar = f64;
    type Coordinates = Vec<f64>;
    type Velocities = Vec<f64>;
    type Chart = Vec<f64>;
    type Inputs = Vec<f64>;

    fn blocks(&self) -> &[Block] {
        &[Block::Circle]
    }
    fn zero_inputs(&self) -> Vec<f64> {
        vec![0.0]
    }
    fn start(&self) -> (Vec<f64>, Vec<f64>) {
        (s1::exp(self.theta0).to_vec(), vec![self.rate0])
    }
    fn chart_rate(&self, _: &Vec<f64>, xi: &Vec<f64>) -> Vec<f64> {
        xi.clone()
    }
    fn forward_dynamics(
        &self,
        x: &Vec<f64>,
        _: &Vec<f64>,
        u: &Vec<f64>,
    ) -> Result<Vec<f64>, Singular> {
        let torque = u[0] - self.g * self.l * x[1];
        solve([[self.l * self.l]], [torque]).map(|a| a.to_vec())
    }
}

#[cfg(feature = "std")]
impl Energies for Pendulum {
    fn kinetic_energy(&self, _: &Vec<f64>, xi: &Vec<f64>) -> f64 {
        0.5 * (self.l * xi[0]).powi(2)
    }
    fn potential_energy(&self, x: &Vec<f64>) -> f64 {
        -self.g * self.l * x[0]
    }
}

/// A reference solution: see `tests/reference/README.md` of the workspace.
pub struct Reference(Value);

impl Reference {
    pub fn read(name: &str) -> Self {
        // Beside the crates, or one of them.
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let folders = ["../tests/reference", "../reference"].map(|folder| root.join(folder));
        let folder = folders.iter().find(|folder| folder.is_dir());
        let path = folder
            .expect("the reference solutions")
            .join(format!("{name}.json"));
        let path = path.display();
        let text = std::fs::read_to_string(path.to_string())
            .unwrap_or_else(|error| panic!("{path}: {error}"));
        Self(serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}")))
    }

    pub fn parameter<const N: usize>(&self, name: &str) -> Option<[f64; N]> {
        numbers(&self.0["parameters"][name])
    }

    pub fn extra<const N: usize>(&self, name: &str) -> [f64; N] {
        numbers(&self.0["extra"][name]).expect(name)
    }

    pub fn initial<const N: usize>(&self, name: &str) -> [f64; N] {
        numbers(&self.0["initial"][name]).expect(name)
    }

    pub fn sample<const N: usize>(&self, t: f64, name: &str) -> [f64; N] {
        let samples = self.0["samples"].as_array().expect("samples");
        let sample = samples
            .iter()
            .find(|sample| numbers(&sample["t"]) == Some([t]))
            .expect("a sample at this time");
        numbers(&sample[name]).expect(name)
    }

    pub fn body(&self) -> Body<f64> {
        let inertia = self.parameter("J").or(self.parameter("Theta"));
        Body {
            inertia: inertia.expect("inertia"),
            m: self.parameter("m").map_or(0.0, |[m]| m),
            s: self.parameter("s").unwrap_or_default(),
            g: self.parameter("g").unwrap_or_default(),
            r0: self.initial("R"),
            w0: self.initial("omega"),
        }
    }

    pub fn free_body(&self) -> FreeBody {
        FreeBody {
            body: self.body(),
            r0: self.initial("r"),
            v0: self.initial("v"),
        }
    }
}

/// N decimal strings, however nested.
fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    fn collect(value: &Value, into: &mut Vec<f64>) {
        match value {
            Value::String(text) => into.extend(text.parse::<f64>()),
            Value::Array(items) => items.iter().for_each(|item| collect(item, into)),
            _ => {}
        }
    }
    let mut list = Vec::new();
    collect(value, &mut list);
    list.try_into().ok()
}

/// Frobenius norm of the difference.
pub fn distance<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Largest difference, over max(1, the largest entry of `b`).
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = b.iter().fold(1.0_f64, |m, b| m.max(b.abs()));
    let difference = a
        .iter()
        .zip(b)
        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    difference / largest
}

/// `n` steps from the start to `until`, without inputs.
pub fn run<Sys: System, M: hamel::Method<Sys>>(
    system: &Sys,
    method: M,
    until: f64,
    n: u32,
) -> Result<State<Sys>, hamel::StepError> {
    let mut state = State::start(system);
    let step = until / f64::from(n);
    let none = |_, _: &_, _: &_| system.zero_inputs();
    hamel::integrate(system, method, &mut state, step, until, none, |_| {})?;
    Ok(state)
}

/// The orders seen between neighbouring errors, each for half the step of the one before.
pub fn slopes(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}
