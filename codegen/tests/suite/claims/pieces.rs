//! Terms of claims: their texts, and their rates along the motion of the reference.

use crate::jet::Jet;
use crate::jointed::{Load, Placed, System};
use std::cell::RefCell;
use std::rc::Rc;

/// A number and, as its slope, its rate of change.
pub type Rate = Jet<1>;

/// A state in motion.
pub struct View<'a> {
    at: Placed<'a>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Positions and velocities of points that were evaluated before.
    known: RefCell<Vec<(Point, [[Rate; 3]; 2])>>,
}

impl<'a> View<'a> {
    /// Returns the motion of a system at coordinates and velocities, followed by those of the time.
    pub fn new(system: &'a System, q: &[f64], v: &[f64]) -> Self {
        let mut a = system.acceleration(q, v);
        a.push(0.0);
        View {
            at: system.placed(q),
            v: v.to_vec(),
            a,
            known: RefCell::default(),
        }
    }

    /// Returns a function of coordinates and its derivative, each with its rate.
    fn moved(&self, jet: &Jet) -> [Rate; 2] {
        let rate = jet.along(&self.v);
        let change = jet.along(&self.a) + jet.curvature(&self.v);
        [[jet.value, rate], [rate, change]].map(|[value, slope]| Rate {
            value,
            slopes: [slope],
            bends: [[0.0]],
        })
    }

    /// Returns the position of a point and its velocity.
    fn point(&self, point: Point) -> [[Rate; 3]; 2] {
        let known = self
            .known
            .borrow()
            .iter()
            .find(|(p, _)| *p == point)
            .map(|(_, at)| *at);
        known.unwrap_or_else(|| {
            let entries = self.at.point(Some(point.0), point.1);
            let moved = entries.each_ref().map(|jet| self.moved(jet));
            let at = [moved.map(|[place, _]| place), moved.map(|[_, rate]| rate)];
            self.known.borrow_mut().push((point, at));
            at
        })
    }

    /// Returns the value of a joint.
    pub fn joint(&self, i: usize) -> Rate {
        self.moved(&self.at.values[i])[0]
    }

    /// Returns the rate of a joint.
    pub fn joint_rate(&self, i: usize) -> Rate {
        self.moved(&self.at.values[i])[1]
    }

    /// Returns the time.
    pub fn time(&self) -> Rate {
        self.moved(&self.at.time)[0]
    }

    /// Evaluates a function of coordinates.
    pub fn of(&self, function: impl Fn(&Placed) -> Jet) -> Rate {
        self.moved(&function(&self.at))[0]
    }

    fn position(&self, point: Point) -> [Rate; 3] {
        self.point(point)[0]
    }

    fn velocity(&self, point: Point) -> [Rate; 3] {
        self.point(point)[1]
    }

    /// Returns the angular velocity of a frame in its axes, from the rates of the axes.
    fn spin(&self, frame: usize) -> [Rate; 3] {
        let axis = |k: usize| {
            let mut end = [0.0; 3];
            end[k] = 1.0;
            let ends = [end, [0.0; 3]].map(|p| (frame, p));
            let [place, origin] = ends.map(|end| self.position(end));
            let [rate, drift] = ends.map(|end| self.velocity(end));
            let difference = |a: [Rate; 3], b: [Rate; 3]| std::array::from_fn(|i| a[i] - b[i]);
            [difference(place, origin), difference(rate, drift)]
        };
        let axes: [[[Rate; 3]; 2]; 3] = std::array::from_fn(axis);
        std::array::from_fn(|k| dot(axes[(k + 1) % 3][1], axes[(k + 2) % 3][0]))
    }
}

/// A frame and a point in it.
pub type Point = (usize, [f64; 3]);

fn dot(a: [Rate; 3], b: [Rate; 3]) -> Rate {
    (0..3).fold(Rate::number(0.0), |total, i| total + a[i] * b[i])
}

/// A product of numbers and a variable quantity.
#[derive(Clone)]
pub struct Piece {
    /// The numbers, all of them short decimals.
    pub factors: Vec<f64>,
    text: String,
    of: Rc<dyn Fn(&View) -> Rate>,
}

impl Piece {
    /// Creates a piece from its text and its value.
    pub fn new(factors: &[f64], text: String, of: impl Fn(&View) -> Rate + 'static) -> Self {
        Piece {
            factors: factors.to_vec(),
            text,
            of: Rc::new(of),
        }
    }

    /// Creates a number from its text and its value.
    pub fn constant(factor: f64, text: String, size: f64) -> Self {
        Piece::new(&[factor], text, move |_| Rate::number(size))
    }

    /// Creates a component of the velocity of a point.
    pub fn speed(point: Point, axis: usize) -> Self {
        let text = format!("velocity({})[{}]", written(point), axis + 1);
        Piece::new(&[], text, move |at| at.velocity(point)[axis])
    }

    /// Returns the text of the piece.
    pub fn text(&self) -> String {
        let factors = self.factors.iter().map(f64::to_string);
        let all: Vec<String> = factors.chain([self.text.clone()]).collect();
        all.join(" * ")
    }

    /// Returns the rate of change.
    pub fn rate(&self, at: &View) -> f64 {
        self.factors.iter().product::<f64>() * (self.of)(at).slopes[0]
    }

    /// Returns the product with another piece.
    pub fn times(&self, other: &Piece) -> Self {
        let (first, second) = (self.of.clone(), other.of.clone());
        Piece {
            factors: [self.factors.clone(), other.factors.clone()].concat(),
            text: format!("{} * {}", self.text, other.text),
            of: Rc::new(move |at| first(at) * second(at)),
        }
    }
}

/// Rounds to two decimals.
fn tidy(place: [f64; 3]) -> [f64; 3] {
    place.map(|entry| (entry * 100.0).round() / 100.0)
}

/// Returns all masses with their positions.
pub fn masses(system: &System) -> Vec<(f64, Point)> {
    let mut all = Vec::new();
    for (i, joint) in system.joints.iter().enumerate() {
        let points = joint.load.points().into_iter();
        all.extend(points.map(|(mass, place)| (mass, (i, tidy(place)))));
    }
    all
}

fn written((frame, place): Point) -> String {
    format!("f{frame}, {place:?}")
}

/// Returns the kinetic energies of all masses; those of bodies by their inertia, or by their points.
pub fn kinetic(system: &System, by_points: bool) -> Vec<Piece> {
    let mut all = Vec::new();
    for (i, joint) in system.joints.iter().enumerate() {
        match joint.load {
            Load::Body(mass, centre, spread) if !by_points => {
                all.push(square(mass, (i, centre)));
                let squares = spread.map(|s| (mass / 3.0 * s * s * 1e4).round() / 1e4);
                for k in 0..3 {
                    let inertia = squares[(k + 1) % 3] + squares[(k + 2) % 3];
                    let inertia = (inertia * 1e4).round() / 1e4;
                    let spin = format!("(angular_velocity(f{i}) in body)[{}]^2", k + 1);
                    let of = move |at: &View| {
                        let spin = at.spin(i)[k];
                        spin * spin
                    };
                    all.push(Piece::new(&[0.5, inertia], spin, of));
                }
            }
            _ => {
                let points = joint.load.points().into_iter();
                all.extend(points.map(|(mass, place)| square(mass, (i, tidy(place)))));
            }
        }
        if joint.armature != 0.0 {
            let of = move |at: &View| at.joint_rate(i) * at.joint_rate(i);
            all.push(Piece::new(
                &[0.5, joint.armature],
                format!("j{i}_dot^2"),
                of,
            ));
        }
    }
    all
}

/// ½ m v²
fn square(mass: f64, point: Point) -> Piece {
    let at = written(point);
    let text = format!("dot(velocity({at}), velocity({at}))");
    let of = move |at: &View| dot(at.velocity(point), at.velocity(point));
    Piece::new(&[0.5, mass], text, of)
}

/// Returns the potentials of gravity and springs.
pub fn potential(system: &System) -> Vec<Piece> {
    let mut all = Vec::new();
    for (mass, point) in masses(system) {
        for k in (0..3).filter(|&k| system.gravity[k] != 0.0) {
            let text = format!("position({})[{}]", written(point), k + 1);
            let factors = [-1.0, mass, system.gravity[k]];
            all.push(Piece::new(&factors, text, move |at| at.position(point)[k]));
        }
    }
    for (i, joint) in system.joints.iter().enumerate() {
        if joint.stiffness != 0.0 {
            let of = move |at: &View| at.joint(i) * at.joint(i);
            all.push(Piece::new(&[0.5, joint.stiffness], format!("j{i}^2"), of));
        }
    }
    all
}

/// Returns the momentum along an axis; with the time, also the contribution of gravity.
pub fn momentum(system: &System, along: [f64; 3]) -> Vec<Piece> {
    let mut all = Vec::new();
    for (mass, point) in masses(system) {
        let text = format!("dot({along:?}, velocity({}))", written(point));
        let of = move |at: &View| dot(along.map(Rate::number), at.velocity(point));
        all.push(Piece::new(&[mass], text, of));
    }
    let weight = (0..3).map(|k| along[k] * system.gravity[k]).sum::<f64>();
    if weight != 0.0 {
        let mass = masses(system).iter().map(|(mass, _)| mass).sum();
        all.push(Piece::new(&[-1.0, mass, weight], "t".into(), |at| {
            at.time()
        }));
    }
    all
}

/// Returns the angular momentum about a point along an axis.
pub fn moment(system: &System, about: [f64; 3], along: [f64; 3]) -> Vec<Piece> {
    let one = |(mass, point): (f64, Point)| {
        let at = written(point);
        let text = format!("dot({along:?}, cross(position({at}) - {about:?}, velocity({at})))");
        let of = move |at: &View| {
            let (place, rate) = (at.position(point), at.velocity(point));
            let arm: [Rate; 3] = std::array::from_fn(|i| place[i] - Rate::number(about[i]));
            let entry = |i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                (arm[j] * rate[k] - arm[k] * rate[j]) * along[i]
            };
            entry(0) + entry(1) + entry(2)
        };
        Piece::new(&[mass], text, of)
    };
    masses(system).into_iter().map(one).collect()
}
