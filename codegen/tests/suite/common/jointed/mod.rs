//! Trees of joints that are free, follow others or are functions of time, with loops and constraints, and their
//! accelerations by Lagrange's equations in numbers: every body is a cloud of points, whose positions are
//! differentiated twice.

mod parts;

pub use parts::{Joint, Law, Load, Loop, Motion, Name, short};

use crate::dense::{kernel, least_pivot, shortest, solution};
use crate::jet::{Jet, constant, sum, turned};

/// Largest number of Newton steps to close the loops.
const MAX_NEWTON_STEPS: usize = 40;

#[derive(Clone)]
pub struct System {
    /// The joints, each mounted on an earlier one.
    pub joints: Vec<Joint>,
    /// Closed loops, and the constants that close them at the guesses.
    pub loops: Vec<(Loop, f64)>,
    /// Initial values of the joints, where nothing else determines them.
    pub guess: Vec<f64>,
    /// The acceleration of gravity.
    pub gravity: [f64; 3],
    /// Whether the time is declared.
    pub timed: bool,
    /// Rows Σ c_k v_k = 0 over joints k.
    pub rows: Vec<Vec<(usize, Law)>>,
    /// A joint with a force F − d v, and the values of F and d.
    pub acted: Option<(usize, [f64; 2])>,
}

/// The positions in a configuration: the values of joints, and the frames as maps of points.
pub struct Placed<'a> {
    /// The system.
    pub system: &'a System,
    /// The values of the joints.
    pub values: Vec<Jet>,
    /// The time.
    pub time: Jet,
}

impl Placed<'_> {
    /// Returns the value of a name.
    pub fn of(&self, name: Name) -> Jet {
        match name {
            Name::Joint(i) => self.values[i],
            Name::Time => self.time,
        }
    }

    /// Returns a point of the frame that a joint moves, or of the world.
    pub fn point(&self, frame: Option<usize>, place: [f64; 3]) -> [Jet; 3] {
        let mut point = constant(place);
        let mut frame = frame;
        while let Some(i) = frame {
            let joint = &self.system.joints[i];
            let length = joint.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
            let axis = joint.axis.map(|a| a / length);
            point = match joint.kind {
                "prismatic" => sum(point, axis.map(|a| self.values[i] * a)),
                _ => turned(point, axis, self.values[i]),
            };
            point = sum(point, constant(joint.at));
            frame = joint.on;
        }
        point
    }

    /// Returns the function that a loop holds constant.
    pub fn closed(&self, of: &Loop) -> Jet {
        match of {
            Loop::Tie(i, law) => self.values[*i] + law.value(|name| self.of(name)),
            Loop::Point([(f, p), (g, q)], axis) => {
                self.point(*f, *p)[*axis] - self.point(*g, *q)[*axis]
            }
        }
    }
}

impl System {
    /// Returns whether there is a spring on a joint whose value never changes, such as one that follows q − q.
    pub fn has_idle_spring(&self) -> bool {
        let start = self.start();
        let elsewhere: Vec<f64> = start.iter().map(|q| 0.7 * q + 0.3).collect();
        let rests = |i: usize| {
            [&start, &elsewhere].iter().all(|q| {
                let slopes = self.placed(q).values[i].slopes;
                slopes.iter().all(|slope| slope.abs() < 1e-12)
            })
        };
        let mut joints = self.joints.iter().enumerate();
        joints.any(|(i, joint)| joint.stiffness > 0.0 && rests(i))
    }

    /// Returns the joints with a coordinate, in the order of the variables; the time follows them.
    pub fn own(&self) -> Vec<usize> {
        let all = 0..self.joints.len();
        all.filter(|&i| self.joints[i].has_coordinate()).collect()
    }

    /// Returns the guesses, with prescribed coordinates at t = 0.
    pub fn start(&self) -> Vec<f64> {
        let own = self.own();
        let mut q: Vec<f64> = own.iter().map(|&i| self.guess[i]).collect();
        q.push(0.0);
        self.prescribe(&mut q);
        q
    }

    /// Sets coordinates that are functions of time to their values.
    pub fn prescribe(&self, q: &mut [f64]) {
        let own = self.own();
        let t = q[own.len()];
        for (place, &i) in own.iter().enumerate() {
            if let Motion::Placed(law) = &self.joints[i].motion {
                q[place] = law.value(|_| Jet::number(t)).value;
            }
        }
    }

    /// Returns the positions at coordinates, followed by the time.
    pub fn placed(&self, q: &[f64]) -> Placed<'_> {
        let time = Jet::variable(self.own().len(), q[self.own().len()]);
        let mut at = Placed {
            system: self,
            values: Vec::new(),
            time,
        };
        let mut place = 0;
        for joint in &self.joints {
            let value = match &joint.motion {
                Motion::Follows(law) => law.value(|name| at.of(name)),
                _ => {
                    place += 1;
                    Jet::variable(place - 1, q[place - 1])
                }
            };
            at.values.push(value);
        }
        at
    }

    /// Returns the residuals of loops and of prescribed motions; those of prescribed velocities have only slopes.
    pub fn residuals(&self, at: &Placed) -> Vec<Jet> {
        let loops = self.loops.iter();
        let mut all: Vec<Jet> = loops
            .map(|(tie, constant)| at.closed(tie) - Jet::number(*constant))
            .collect();
        for (i, joint) in self.joints.iter().enumerate() {
            match &joint.motion {
                Motion::Placed(law) => all.push(at.values[i] - law.value(|name| at.of(name))),
                Motion::Driven(law) => {
                    // v − w: its slope by the time is −w, whose rate is the acceleration.
                    let rate = law.value(|name| at.of(name));
                    let time = self.own().len();
                    let mut row = at.values[i] - Jet::number(at.values[i].value);
                    row.slopes[time] = -rate.value;
                    row.bends[time][time] = -rate.slopes[time];
                    all.push(row);
                }
                _ => {}
            }
        }
        all.extend(self.rows.iter().map(|row| self.residual(at, row)));
        all
    }

    /// Returns Σ c_k v_k as slopes, with the second derivatives from those of the coefficients.
    fn residual(&self, at: &Placed, row: &[(usize, Law)]) -> Jet {
        let own = self.own();
        let mut residual = Jet::number(0.0);
        for (joint, law) in row {
            let place = own.iter().position(|i| i == joint).expect("it has one");
            let factor = law.value(|name| at.of(name));
            residual.slopes[place] += factor.value;
            for (bend, slope) in residual.bends[place].iter_mut().zip(factor.slopes) {
                *bend += slope;
            }
        }
        residual
    }

    /// Returns the slopes of the residuals by the coordinates.
    pub fn rows_of(&self, at: &Placed) -> Vec<Vec<f64>> {
        let n = self.own().len();
        let all = self.residuals(at);
        all.iter().map(|jet| jet.slopes[..n].to_vec()).collect()
    }

    /// Returns a configuration near another one in which all residuals are 0, at the same time.
    pub fn assembled(&self, mut q: Vec<f64>) -> Option<Vec<f64>> {
        let n = self.own().len();
        self.prescribe(&mut q);
        for _ in 0..MAX_NEWTON_STEPS {
            let at = self.placed(&q);
            let residuals = self.residuals(&at);
            let size = residuals
                .iter()
                .fold(0.0, |most: f64, r| most.max(r.value.abs()));
            if size < 1e-14 {
                return Some(q);
            }
            let right: Vec<f64> = residuals.iter().map(|r| -r.value).collect();
            let step = shortest(&self.rows_of(&at), &right, n);
            let longest = step.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
            if longest.is_nan() || longest > 1e3 {
                return None;
            }
            (0..n).for_each(|i| q[i] += step[i]);
        }
        None
    }

    /// Returns velocities near others that satisfy the residuals, followed by that of the time.
    pub fn moving(&self, q: &[f64], mut v: Vec<f64>) -> Vec<f64> {
        let n = self.own().len();
        v.push(1.0);
        let at = self.placed(q);
        let right: Vec<f64> = self.residuals(&at).iter().map(|r| -r.along(&v)).collect();
        let step = shortest(&self.rows_of(&at), &right, n);
        (0..n).for_each(|i| v[i] += step[i]);
        v
    }

    /// Returns M and f − h − ∂V, for velocities followed by that of the time.
    pub fn inertia_and_force(&self, q: &[f64], v: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let own = self.own();
        let n = own.len();
        let at = self.placed(q);
        let mut mass = vec![vec![0.0; n]; n];
        let mut force = vec![0.0; n];
        for (i, joint) in self.joints.iter().enumerate() {
            let value = &at.values[i];
            (0..n).for_each(|k| force[k] -= joint.stiffness * value.value * value.slopes[k]);
            for (m, place) in joint.load.points() {
                let point = at.point(Some(i), place);
                for (axis, entry) in point.iter().enumerate() {
                    let push = m * (entry.curvature(v) - self.gravity[axis]);
                    for a in 0..n {
                        force[a] -= push * entry.slopes[a];
                        for b in 0..n {
                            mass[a][b] += m * entry.slopes[a] * entry.slopes[b];
                        }
                    }
                }
            }
        }
        for (place, &i) in own.iter().enumerate() {
            mass[place][place] += self.joints[i].armature;
        }
        if let Some((joint, [push, damping])) = self.acted {
            let place = own.iter().position(|&i| i == joint).expect("it has one");
            force[place] += push - damping * v[place];
        }
        (mass, force)
    }

    /// Returns the rates of the velocities, by elimination.
    pub fn acceleration(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let (mass, force) = self.inertia_and_force(q, v);
        let residuals = self.residuals(&self.placed(q));
        let right = residuals.iter().map(|r| -r.curvature(v)).collect();
        let rows = self.rows_of(&self.placed(q));
        solution((mass, force), (rows, right))
    }

    /// Measures how far the constrained system is from a singularity at a configuration: the smallest pivot of M on the
    /// tangent space of the constraints, the dimension of that space, and the independence of the constraint rows.
    pub fn regularity(&self, q: &[f64]) -> (f64, usize, f64) {
        let still = vec![0.0; q.len()];
        let (mass, _) = self.inertia_and_force(q, &still);
        let rows = self.rows_of(&self.placed(q));
        let (columns, independent) = kernel(&rows, q.len() - 1);
        (least_pivot(&mass, &columns), columns.len(), independent)
    }

    /// Returns the description, with further statements.
    pub fn text(&self, more: &[String]) -> String {
        let mut lines = Vec::new();
        if self.timed {
            lines.push("time t;".to_owned());
        }
        // Without loops, starts are not guesses.
        let sign = if self.loops.is_empty() { "=" } else { "~" };
        let mut starts = Vec::new();
        for (i, joint) in self.joints.iter().enumerate() {
            lines.push(joint.text(i));
            lines.extend(joint.load.text(i));
            if joint.stiffness > 0.0 {
                lines.push(format!("spring stiffness {} on j{i};", joint.stiffness));
            }
            match &joint.motion {
                Motion::Placed(law) => lines.push(format!("prescribe j{i} = {};", law.text())),
                Motion::Driven(law) => lines.push(format!("prescribe j{i}_dot = {};", law.text())),
                _ => {}
            }
            if matches!(joint.motion, Motion::Free | Motion::Driven(_))
                && joint.kind != "continuous"
            {
                starts.push(format!("j{i} {sign} {}", self.guess[i]));
            }
        }
        for (tie, constant) in &self.loops {
            lines.push(match tie {
                Loop::Tie(own, law) => format!("loop j{own} + {} = {constant};", law.text()),
                Loop::Point(ends, axis) => {
                    let [first, second] = ends.map(|(frame, place)| match frame {
                        Some(frame) => format!("position(f{frame}, {place:?})[{}]", axis + 1),
                        None => format!("{:?}", place[*axis]),
                    });
                    format!("loop {first} - {second} = {constant};")
                }
            });
        }
        for row in &self.rows {
            let terms = row
                .iter()
                .map(|(joint, law)| format!("({}) * j{joint}_dot", law.text()));
            lines.push(format!(
                "nonholonomic {} = 0;",
                terms.collect::<Vec<_>>().join(" + ")
            ));
        }
        if let Some((joint, [_, damping])) = self.acted {
            lines.push("input F;".to_owned());
            lines.push(format!("param d = {damping};"));
            lines.push(format!(
                "generalized force j{joint}_dot = F - d * j{joint}_dot;"
            ));
        }
        lines.push(format!("gravity {:?};", self.gravity));
        lines.push(format!("start {};", starts.join(", ")));
        lines.extend_from_slice(more);
        format!("system S {{\n    {}\n}}\n", lines.join("\n    "))
    }
}
