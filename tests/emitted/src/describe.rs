//! Random descriptions: names that Rust or the generated code may use, parameters, inputs and outputs of all shapes,
//! lists that end in an index, and all kinds of joints.

use super::common::Random;
use std::fmt::Write;

/// Names that are legal in a description, and that generated Rust has to escape or avoid.
const NAMES: &str = "
    bool char str u8 i64 usize f16 f32 f64 f128 isize u128 Some None Ok Err Option Result Vec Box
    String Clone Copy Debug Default Drop Iterator From Into Send Sized Fn drop panic println vec
    assert core std hamel alloc derive inline test union auto raw safe macro_rules default generate_
    async_ type_ S System Scalar Split Canonical Singular Rotor Block Rotors FREE Coordinates
    Velocities Chart Inputs COORDINATES VELOCITIES STATES INPUTS PARAMETERS Parameters State from_arrays to_array new clone clone_from into try_into fmt blocks
    zero_coordinates zero_velocities zero_chart zero_inputs constraint_norm rotors constants update
    free system next value norm pivot kinematics from_f64 sin_cos mul_add is_positive max abs x xi u
    xi_dot momentum_ k k_2 slots out j y p q t1 t2 c1 sin1 cos1 sin_q minus_t1 zero one two three
    four half third quarter set_k set_set_k accel_part1 rate_part1 hamel_line_0 self_ Self_ v _a
    a__b θ Θ theta theta_2 ω̇ omega_dot é ue9 Δθ 名 ünit camelCase SHOUT
    a_name_that_is_so_long_that_every_list_with_it_has_to_be_broken_by_the_printer_wherever_it_stands
";

/// Returns all of these names.
pub fn names() -> impl Iterator<Item = &'static str> {
    NAMES.split_whitespace()
}

/// A description under construction.
struct Draft<'a> {
    random: &'a mut Random,
    text: String,
    names: Vec<&'static str>,
    taken: Vec<&'static str>,
    /// Scalars for expressions: constants, functions of coordinates, any.
    constants: Vec<String>,
    positions: Vec<String>,
    all: Vec<String>,
}

/// Returns a description; `system` is the name of its type, random by default.
pub fn description(random: &mut Random, system: Option<&str>) -> String {
    let mut draft = Draft {
        random,
        text: String::new(),
        names: names().collect(),
        taken: Vec::new(),
        constants: vec!["2.5".into(), "1e-3".into(), "pi".into()],
        positions: Vec::new(),
        all: Vec::new(),
    };
    let name = system.map_or_else(|| draft.name(), str::to_string);
    draft.taken.clear();
    draft.line("/// Turned \u{202e} around, `[a]` */ \"# {}");
    draft.line(&format!("pub system {name} {{"));
    draft.params();
    match draft.random.below(3) {
        0 => draft.coordinates(),
        _ => draft.joints(),
    }
    draft.inputs();
    draft.lets();
    draft.outputs();
    draft.text + "}\n"
}

impl Draft<'_> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn pick(&mut self, list: &[&'static str]) -> &'static str {
        list[self.random.below(list.len())]
    }

    fn coin(&mut self) -> bool {
        self.random.below(2) == 0
    }

    /// Returns a name that the description has not used.
    fn name(&mut self) -> String {
        loop {
            let name = self.names[self.random.below(self.names.len())];
            if !self.taken.contains(&name) {
                self.taken.push(name);
                return name.into();
            }
        }
    }

    /// Returns a positive number, round or not.
    fn positive(&mut self) -> String {
        let sizes = ["1", "2", "0.5", "1/3", "1.2345678901234567", "3e1"];
        self.pick(&sizes).into()
    }

    fn params(&mut self) {
        for _ in 0..self.random.below(5) {
            let name = self.name();
            match self.random.below(4) {
                0 => {
                    self.line(&format!("    param {name} = 1.25;"));
                    self.constants.push(name);
                }
                1 => {
                    let n = 1 + self.random.below(17);
                    let entries: Vec<String> = (0..n)
                        .map(|i| format!("{}", 1.0 + 0.125 * i as f64))
                        .collect();
                    self.line(&format!(
                        "    param {name}: vec{n} = [{}];",
                        entries.join(", ")
                    ));
                    self.constants
                        .extend((1..=n).map(|i| format!("{name}[{i}]")));
                }
                shape => {
                    let n = 1 + self.random.below(4);
                    let entry = |i: usize, j: usize| if i == j { "2" } else { "0.25" };
                    let row = |i: usize| (0..n).map(|j| entry(i, j)).collect::<Vec<_>>().join(", ");
                    let rows: Vec<String> = (0..n).map(|i| format!("[{}]", row(i))).collect();
                    let of = if shape == 2 { "mat" } else { "sym" };
                    self.line(&format!(
                        "    param {name}: {of}{n} = [{}];",
                        rows.join(", ")
                    ));
                    self.constants
                        .extend((1..=n).map(|i| format!("{name}[{i}, {n}]")));
                }
            }
        }
        self.all.extend(self.constants.clone());
    }

    /// Adds coordinates with rates, and a kinetic energy that couples the velocities of real ones.
    fn coordinates(&mut self) {
        let (mut kinetic, mut plain) = (Vec::new(), Vec::new());
        for _ in 0..1 + self.random.below(3) {
            let (q, v) = (self.name(), self.name());
            match self.random.below(5) {
                0 | 1 => {
                    self.line(&format!("    coord {q}; velocity {v}; rate {q} = {v};"));
                    self.positions.push(q);
                    plain.push(v.clone());
                    self.all.push(v);
                }
                2 => {
                    self.line(&format!("    coord {q}: S1; velocity {v}; rate {q} = {v};"));
                    self.positions.extend([format!("{q}.c"), format!("{q}.s")]);
                    plain.push(v.clone());
                    self.all.push(v);
                }
                3 => {
                    let n = 2 + self.random.below(2);
                    self.line(&format!(
                        "    coord {q}: R{n}; velocity {v}: vec{n}; rate {q} = {v};"
                    ));
                    self.positions.extend((1..=n).map(|i| format!("{q}[{i}]")));
                    let mass = self.positive();
                    kinetic.extend((1..=n).map(|i| format!("{mass} * {v}[{i}]^2")));
                    self.all.extend((1..=n).map(|i| format!("{v}[{i}]")));
                }
                _ => {
                    self.line(&format!(
                        "    coord {q}: SO3; velocity {v}: vec3; rate {q} = {q} * hat({v});"
                    ));
                    self.positions
                        .extend([format!("{q}[1, 3]"), format!("{q}[2, 2]")]);
                    kinetic.extend((1..=3).map(|i| format!("{i} * {v}[{i}]^2")));
                    self.all.extend((1..=3).map(|i| format!("{v}[{i}]")));
                }
            }
        }
        for (index, v) in plain.iter().enumerate() {
            let mass = self.positive();
            kinetic.push(format!("{mass} * {v}^2"));
            if index > 0 && self.coin() {
                kinetic.push(format!("({v} + {})^2", plain[0]));
            }
        }
        self.all.extend(self.positions.clone());
        self.line(&format!("    kinetic ({}) / 2;", kinetic.join(" + ")));
        let (a, b) = (self.position(), self.constant());
        self.line(&format!("    potential {b} * {a}^2 + sin({a} / 2);"));
        for v in plain {
            let input = self.input();
            self.line(&format!("    generalized force {v} = {input};"));
        }
    }

    /// Adds a tree or a chain of joints with a body on each.
    fn joints(&mut self) {
        let mut frames: Vec<String> = Vec::new();
        for _ in 0..1 + self.random.below(3) {
            let (joint, frame) = (self.name(), self.name());
            let axis = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]", "[1, 2, 2]"];
            let axis = self.pick(&axis);
            let kind = match self.random.below(10) {
                0 if frames.is_empty() => "free".to_string(),
                0 | 1 => "spherical".into(),
                2 => format!("planar {axis}"),
                3 => "universal [1, 0, 0], [0, 1, 0]".into(),
                4 => format!("prismatic {axis}"),
                5 => format!("continuous {axis}"),
                _ => format!("revolute {axis}"),
            };
            let on = match frames.len() {
                0 => String::new(),
                n => format!(" on {}", frames[self.random.below(n)]),
            };
            let poses = [
                "",
                " at pose(rotx(1), [0, 0, 0])",
                " at pose(rotz(pi / 2), [0.5, 0, 0.25])",
                " at pose(rpy(0.1, -0.2, 3), [1, 2, 3])",
                " at pose(identity(3), [0, 0.4, 0])",
            ];
            let at = self.pick(&poses);
            let single = ["prismatic", "revolute", "continuous"]
                .iter()
                .any(|k| kind.starts_with(k));
            let mut braces = String::new();
            if single {
                if self.coin() {
                    write!(braces, " damping 0.1;").expect("a text");
                }
                if self.coin() {
                    let input = self.input();
                    write!(braces, " force {input};").expect("a text");
                }
                if self.coin() && !kind.starts_with("continuous") {
                    write!(braces, " limit -2 to 1e3; max_speed 1e-7;").expect("a text");
                }
                if !kind.starts_with("continuous") {
                    self.positions.push(joint.clone());
                }
            }
            let end = if braces.is_empty() {
                ";".into()
            } else {
                format!(" {{{braces} }}")
            };
            self.line(&format!(
                "    joint {joint}: {kind}{on}{at} moves {frame}{end}"
            ));
            let mass = self.positive();
            let com = self.pick(&["[0, 0, 0]", "[0.1, 0, 0]", "[0.1, -0.2, 0.3]"]);
            let inertia = self.pick(&[
                "diag(1, 2, 2.5)",
                "diag(1, 1, 1)",
                "[[2, 0.1, 0], [0.1, 1.5, 0], [0, 0, 1.75]]",
            ]);
            self.line(&format!(
                "    body on {frame} {{ mass {mass}; com {com}; inertia {inertia} about com; }}"
            ));
            frames.push(frame);
        }
        self.all.extend(self.positions.clone());
        if self.coin() {
            self.line("    gravity [0, 0, -9.81];");
        }
        if let (true, Some(frame)) = (self.coin(), frames.first()) {
            let (name, frame) = (self.name(), frame.clone());
            self.line(&format!(
                "    input {name}: vec3;\n    torque {name} on {frame} in body;"
            ));
        }
    }

    /// Returns a new input, or an entry of one; or a first-order state.
    fn input(&mut self) -> String {
        let name = self.name();
        match self.random.below(4) {
            1 => {
                let (start, slope) = (self.constant(), self.constant());
                let (moved, other) = (self.all.clone(), self.constants.clone());
                let driven = match moved.is_empty() {
                    true => self.one_of(&other),
                    false => self.one_of(&moved),
                };
                self.line(&format!("    state {name} = {start};"));
                self.line(&format!("    rate {name} = {driven} - {slope} * {name};"));
                name
            }
            0 => {
                let n = 1 + self.random.below(3);
                self.line(&format!("    input {name}: vec{n};"));
                format!("{name}[{}]", 1 + self.random.below(n))
            }
            _ => {
                self.line(&format!("    input {name};"));
                name
            }
        }
    }

    /// Adds inputs that nothing reads.
    fn inputs(&mut self) {
        for _ in 0..self.random.below(2) {
            self.input();
        }
    }

    fn one_of(&mut self, list: &[String]) -> String {
        list[self.random.below(list.len())].clone()
    }

    fn constant(&mut self) -> String {
        let list = self.constants.clone();
        self.one_of(&list)
    }

    /// Returns a coordinate, or a constant if there is none.
    fn position(&mut self) -> String {
        let list = self.positions.clone();
        match list.is_empty() {
            true => self.constant(),
            false => self.one_of(&list),
        }
    }

    /// Returns an expression that is defined everywhere.
    fn expression(&mut self, depth: usize) -> String {
        if depth == 0 || self.random.below(4) == 0 {
            let list = self.all.clone();
            return self.one_of(&list);
        }
        let a = self.expression(depth - 1);
        match self.random.below(9) {
            0 => format!("sin({a})"),
            1 => format!("cos({a} / 3)"),
            2 => format!("sqrt(2 + ({a})^2)"),
            3 => format!("-abs({a})"),
            4 => format!("({a}) * {}", self.constant()),
            n => {
                let b = self.expression(depth - 1);
                match n {
                    5 => format!("({a}) * ({b})"),
                    6 => format!("({a} - ({b}))"),
                    7 => format!("({a}) / (1 + ({b})^2)"),
                    _ => format!("({a} + ({b}))"),
                }
            }
        }
    }

    fn lets(&mut self) {
        for _ in 0..self.random.below(4) {
            let (name, value) = (self.name(), self.expression(2));
            self.line(&format!("    let {name} = {value};"));
            self.all.push(name);
        }
    }

    /// Returns a list whose last entry is often a hoisted constant: `k[15]` at the end of a row.
    fn row(&mut self, length: usize) -> String {
        let entries: Vec<String> = (0..length)
            .map(|index| match (index + 1 == length, self.random.below(3)) {
                (true, 0 | 1) => format!("({} + 1) * 3 * {}", self.constant(), self.constant()),
                (_, 0) => self.constant(),
                _ => self.expression(1),
            })
            .collect();
        format!("[{}]", entries.join(", "))
    }

    fn outputs(&mut self) {
        for _ in 0..1 + self.random.below(4) {
            let name = self.name();
            let value = match self.random.below(3) {
                0 => self.expression(3),
                1 => {
                    let length = 1 + self.random.below(20);
                    self.row(length)
                }
                _ => {
                    let (rows, columns) = (1 + self.random.below(4), 1 + self.random.below(14));
                    let rows: Vec<String> = (0..rows).map(|_| self.row(columns)).collect();
                    format!("[{}]", rows.join(", "))
                }
            };
            // The select is continuous, so that a different branch in single precision gives a close value.
            let value = match self.random.below(3) {
                0 => {
                    let (a, b, c) = (self.expression(1), self.expression(1), self.expression(1));
                    format!(
                        "[max({a}, {b}), clamp({c}, -0.5, 1), hypot({a}, {c}) + (if {a} < {b} {{ {b} - ({a}) }} else {{ 0 }})]"
                    )
                }
                _ => value,
            };
            self.line(&format!("    output {name} = {value};"));
        }
    }
}
