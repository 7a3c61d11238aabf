//! The procedural macro of hamel, a thin wrapper around [`hamel_codegen::expand`].
//!
#![doc = include_str!("../README.md")]

use proc_macro::TokenStream;

/// Derives the equations of motion of a mechanical system, and expands to a Rust type that evaluates them.
///
/// A description declares coordinates x, velocities ξ, their relation ẋ = A(x) ξ, and the bodies and loads of the
/// system. The macro derives ξ̇ = M⁻¹(f − Γ ξ ξ − ∂V), proves the result at exact points of the configuration manifold,
/// and writes it as straight-line code:
///
/// ```
/// use hamel::methods::Rkmk4;
/// use hamel::{State, integrate};
///
/// hamel::rigid_eom! {
///     /// A pole on a cart; the angle is measured from the upright.
///     pub system CartPole {
///         param mc = 1, mp = 0.1, l = 0.5, g = 9.81;
///         coord p, th;
///         velocity v, w;
///         rate p = v;
///         rate th = w;
///         particle mass mc at [p, 0, 0];
///         particle mass mp at [p + l * sin(th), 0, l * cos(th)];
///         gravity [0, 0, -g];
///         input F;
///         generalized force v = F;
///         output tip = [p + l * sin(th), l * cos(th)];
///         start th = 0.1;
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let cart = CartPole::<f64>::new(CartPoleParameters { mp: 0.2, ..Default::default() })?;
/// let mut state = State::from(CartPoleState { th: 0.3, ..Default::default() });
/// let push = CartPoleInputs { f: 1.5 }.to_array();
/// integrate(&cart, Rkmk4, &mut state, 1e-3, 1.0, |_, _, _| push, |_| {})?;
/// println!("{:?} rad, tip at {:?} m", CartPoleState::from(&state).th, cart.tip(&state.x));
/// # let tip = cart.tip(&state.x);
/// # assert!(((tip[0] - state.x[0]).hypot(tip[1]) - 0.5).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
///
/// The crate that calls the macro has to depend on `hamel`, since the expansion refers to `::hamel`. Numbers have no
/// units: any consistent system of units works, and the examples use SI.
///
/// # The language in short
///
/// | statement | meaning |
/// |---|---|
/// | `param m = 1, s: vec3 = [0, 0, 1], J: sym3 = …;` | a parameter that can be changed at run time, with its default |
/// | `const k = 3/2;` `let e = m * s;` | an exact constant, fixed at build time; a named expression |
/// | `coord q, r: R3, a: S1, Q: S3, R: SO3, X: SE3;` | coordinates: numbers, vectors, an angle as (cos, sin), a unit quaternion, a rotation matrix, a pose |
/// | `velocity v, w: vec3;` `rate R = R * hat(w);` | quasi-velocities ξ, and the rates of the coordinates in terms of them |
/// | `joint hinge: revolute [0, 1, 0] moves arm;` | coordinate, velocity and frame of a joint in one statement |
/// | `frame f on g = pose(R, p);` | a frame f with the attitude R and the origin p, as seen from g |
/// | `body on f { mass m; com s; inertia J about com; }` | a rigid body; `particle mass m at p;` is a point mass |
/// | `gravity [0, 0, -g];` `spring …;` `damper …;` | weight, springs and dampers |
/// | `input F;` `force F at p on f;` `generalized force v = F;` | inputs, and loads from outside |
/// | `constraint x^2 + y^2 = 1;` `loop p = q;` `nonholonomic v - r * w = 0;` | geometric constraints, closed loops, constraints of velocities |
/// | `output y = …;` `invariant energy;` | further functions; claims of constancy, which are proved or refused |
/// | `start th = 0.1;` `generate all, linearize;` | the initial state; the functions to generate |
///
/// Decimal numbers are exact: `0.1` is 1/10 in every proof. The chapter on the language in the book of the
/// repository explains each statement.
///
/// A bead that a constraint holds on a circle, for instance, keeps two redundant coordinates:
///
/// ```
/// hamel::rigid_eom! {
///     pub system Bead {
///         param m = 0.1, r = 0.5, g = 9.81;
///         coord c, s;
///         constraint c^2 + s^2 = 1;
///         velocity w;
///         rate c = -s * w;
///         rate s = c * w;
///         particle mass m at [r * s, 0, -r * c];
///         gravity [0, 0, -g];
///         invariant energy;
///         start c = 1;
///     }
/// }
///
/// # fn main() -> Result<(), hamel::Singular> {
/// // At a quarter turn the whole weight accelerates it: dw/dt = −g/r.
/// let rate = Bead::<f64>::default().accel(&[0.0, 1.0], &[0.0], &[])?;
/// assert!((rate[0] + 9.81 / 0.5).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
///
/// # Generated items
///
/// For `pub system CartPole { … }`, with ν coordinates, n velocities and any scalar type `S`:
///
/// | item | contents |
/// |---|---|
/// | `CartPole<S>` | the system; `new(parameters)`, `default()`, and for each parameter `mc()` and `set_mc(value)` |
/// | `CartPoleParameters<S>`, `CartPoleState<S>`, `CartPoleInputs<S>` | parameters, states and inputs by their names, with conversions from and to the arrays below |
/// | `rate(x, xi)` | ẋ = A(x) ξ, ν numbers |
/// | `accel(x, xi, u)` | ξ̇, n numbers, or [`Singular`] |
/// | `inverse_dynamics(x, xi, xi_dot)` | the generalised force that ξ̇ needs, n numbers |
/// | `mass_matrix(x)`, `bias(x, xi)` | M(x), n × n, and Γ ξ ξ, n numbers |
/// | `potential_force(x)`, `generalized_force(x, xi, u)` | ∂V and f, n numbers each |
/// | `momentum`, `kinetic_energy`, `potential_energy`, `energy` | ∂T/∂ξ, T, V, T + V |
/// | `constraint(x)`, `correction(x)` | φ(x), and the step back onto φ = 0 |
/// | one function for each `output` | it takes only the arguments on which the output depends |
/// | `linearize` and others | on request, see `generate` |
///
/// The documentation of each function states its arguments in order, its operation count and its errors. The type also
/// implements [`System`] and, where the equations allow it, [`Split`] and [`Tangent`], so that the integrators of
/// `hamel` accept it.
///
/// [`Singular`]: https://docs.rs/hamel/latest/hamel/enum.Singular.html
/// [`System`]: https://docs.rs/hamel/latest/hamel/trait.System.html
/// [`Split`]: https://docs.rs/hamel/latest/hamel/trait.Split.html
/// [`Tangent`]: https://docs.rs/hamel/latest/hamel/trait.Tangent.html
///
/// # Errors
///
/// Mistakes are compile errors, each underlined at its place in the description; all independent ones are reported at
/// once. This error reports that `mas` is not defined, and suggests `mass`:
///
/// ```compile_fail
/// hamel::rigid_eom! {
///     pub system Block {
///         param mass = 2;
///         coord x;
///         velocity v;
///         rate x = v;
///         particle mass mas at [x, 0, 0];
///     }
/// }
/// ```
///
/// A description is also refused if its mass matrix is not positive definite at the start, if a claimed `invariant` is
/// not constant, or if a proof fails. Warnings, such as that for an unused parameter, appear as uses of a deprecated
/// item, the only kind of warning that macros can emit on stable Rust.
///
/// Paths of `table` and `include` statements are relative to the folder of the package. Programs of more than 10,000
/// statements belong in a build script, which writes a file that rustc compiles better:
/// `hamel_codegen::Builder`.
#[proc_macro]
pub fn rigid_eom(input: TokenStream) -> TokenStream {
    let description = proc_macro2::TokenStream::from(input);
    hamel_codegen::expand(description).into()
}
