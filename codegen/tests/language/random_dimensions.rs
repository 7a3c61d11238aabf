//! Random expressions whose dimensions are known: right ones are accepted, wrong ones refused, and unknown dimensions
//! follow. The test computes with exponents of its own.

#[path = "../suite/common/size.rs"]
mod size;

use hamel_language::algebra::residue_pair::Random;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::lower::build;
use hamel_language::model::Model;
use hamel_language::syntax::parse_text;
use size::size;

/// Exponents of kg, m and s, in twelfths.
type Exponents = [i64; 3];

/// Names of parameters with their units and exponents.
const NAMES: &[(&str, &str, Exponents)] = &[
    ("m", "kg", [12, 0, 0]),
    ("l", "m", [0, 12, 0]),
    ("T", "s", [0, 0, 12]),
    ("q", "rad", [0, 0, 0]),
    ("F", "N", [12, 12, -24]),
    ("f", "kHz", [0, 0, -12]),
    ("A", "mm^2", [0, 24, 0]),
    ("w", "kg^(1/2)*m/s", [6, 12, -12]),
];

fn plus(a: Exponents, b: Exponents, times: i64) -> Exponents {
    [0, 1, 2].map(|i| a[i] + times * b[i])
}

/// Returns the unit of exponents as text.
fn unit(of: Exponents) -> String {
    let power = |(name, power): (&str, i64)| format!("{name}^({power}/12)");
    let factors = ["kg", "m", "s"]
        .into_iter()
        .zip(of)
        .filter(|(_, power)| *power != 0);
    let factors: Vec<String> = factors.map(power).collect();
    match factors.is_empty() {
        true => "1".into(),
        false => factors.join("*"),
    }
}

/// Writes expressions of given dimensions.
struct Writer {
    random: Random,
    /// Number of places where dimensions have to agree, so far.
    places: usize,
    /// The place at which they do not.
    wrong: Option<usize>,
}

impl Writer {
    fn below(&mut self, n: u64) -> u64 {
        self.random.bits() % n
    }

    fn exponents(&mut self) -> Exponents {
        [0; 3].map(|_: i64| 12 * (self.below(5) as i64 - 2))
    }

    /// Returns the dimension for an operand that should have the given one: at the wrong place, another.
    fn agreeing(&mut self, of: Exponents) -> Exponents {
        self.places += 1;
        if self.wrong != Some(self.places) {
            return of;
        }
        let mut other = [0; 3];
        while other == [0; 3] {
            other = self.exponents();
        }
        plus(of, other, 1)
    }

    /// Writes an expression of a dimension as a product of powers of names.
    fn leaf(&mut self, of: Exponents) -> String {
        let mut rest = of;
        let mut factors = vec![];
        for _ in 0..self.below(3) {
            let (name, _, own) = NAMES[self.below(NAMES.len() as u64) as usize];
            factors.push(name.to_string());
            rest = plus(rest, own, -1);
        }
        for ((name, _, _), power) in NAMES.iter().zip(rest) {
            if power != 0 {
                factors.push(format!("{name}^({power} / 12)"));
            }
        }
        if factors.is_empty() {
            factors.push("q".into());
        }
        match self.below(4) {
            0 => format!("2.5 * {}", factors.join(" * ")),
            1 => format!("-{} / 3", factors.join(" * ")),
            _ => factors.join(" * "),
        }
    }

    /// Writes an expression of a dimension.
    fn expression(&mut self, of: Exponents, depth: u32) -> String {
        if depth == 0 {
            return self.leaf(of);
        }
        let deeper = depth - 1;
        let number = of == [0; 3];
        match self.below(if number { 17 } else { 13 }) {
            0 => self.leaf(of),
            1 | 2 => {
                let a = self.expression(of, deeper);
                let other = self.agreeing(of);
                let b = self.expression(other, deeper);
                let sign = ["+", "-"][self.below(2) as usize];
                format!("({a} {sign} ({b}))")
            }
            3 => format!("({} + 0.5)", self.expression(of, deeper)),
            4 => {
                let a = self.exponents();
                let (left, right) = (
                    self.expression(a, deeper),
                    self.expression(plus(of, a, -1), deeper),
                );
                format!("({left}) * ({right})")
            }
            5 => {
                let a = self.exponents();
                let (left, right) = (
                    self.expression(plus(of, a, 1), deeper),
                    self.expression(a, deeper),
                );
                format!("({left}) / ({right})")
            }
            6 => format!("sqrt(abs({}))", self.expression(plus(of, of, 1), deeper)),
            7 if of.iter().all(|power| power % 2 == 0) => {
                format!("({})^2", self.expression(of.map(|power| power / 2), deeper))
            }
            8 => {
                let name = ["min", "max", "hypot"][self.below(3) as usize];
                let a = self.expression(of, deeper);
                let other = self.agreeing(of);
                format!("{name}({a}, {})", self.expression(other, deeper))
            }
            9 => {
                let free = self.exponents();
                let (a, same) = (self.expression(free, deeper), self.agreeing(free));
                let b = self.expression(same, deeper);
                let then = self.expression(of, deeper);
                let other = self.agreeing(of);
                format!(
                    "(if {a} < {b} {{ {then} }} else {{ {} }})",
                    self.expression(other, deeper)
                )
            }
            10 => {
                let a = self.expression(of, deeper);
                let other = self.agreeing(of);
                format!("norm([{a}, {}, 0])", self.expression(other, deeper))
            }
            11 => {
                let a = self.exponents();
                let vector = |writer: &mut Writer, of| {
                    let (x, y) = (writer.expression(of, deeper), writer.expression(of, deeper));
                    format!("[{x}, 0, {y}]")
                };
                let (left, right) = (vector(self, a), vector(self, plus(of, a, -1)));
                match self.below(2) {
                    0 => format!("dot({left}, {right})"),
                    _ => format!("cross({left}, {right})[2]"),
                }
            }
            12 => format!("twice({})", self.expression(of, deeper)),
            7 | 13 | 14 => {
                let name = ["sin", "cos", "tanh", "exp", "log1p"][self.below(5) as usize];
                let other = self.agreeing([0; 3]);
                let argument = self.expression(other, deeper);
                match number {
                    true => format!("{name}({argument})"),
                    false => format!("{name}({argument}) * ({})", self.leaf(of)),
                }
            }
            _ => {
                let free = self.exponents();
                let (a, same) = (self.expression(free, deeper), self.agreeing(free));
                format!("atan2({a}, {})", self.expression(same, deeper))
            }
        }
    }
}

/// Returns the description of a particle with further statements.
fn description(statements: &str) -> String {
    let params: Vec<String> = NAMES
        .iter()
        .map(|(name, unit, _)| format!("{name}: [{unit}] = 1.7"))
        .collect();
    format!(
        "system S {{ param {}; fn twice(a) = a + a; coord x; velocity v; rate x = v; particle mass m at [x, 0, 0];\n{statements} }}",
        params.join(", ")
    )
}

/// Returns the model, and the errors about dimensions. Others, such as that a root has no value at some point, do not
/// count.
fn checked(text: &str) -> (Option<Model>, Vec<Diagnostic>) {
    let system = parse_text(text).unwrap_or_else(|errors| panic!("{errors:#?}\n{text}"));
    match build(&system) {
        Ok(model) => (Some(model), vec![]),
        Err(mut errors) => {
            assert!(
                errors
                    .iter()
                    .all(|error| !error.site.file().contains("shapes")),
                "{errors:#?}\n{text}"
            );
            errors.retain(|error| error.site.file().contains("dimensions"));
            (None, errors)
        }
    }
}

#[test]
fn right_expressions_are_accepted_and_wrong_ones_refused() {
    let mut refused = 0;
    let mut built = 0;
    for seed in 0..size(300, 20_000) {
        let mut writer = Writer {
            random: Random::new(seed),
            places: 0,
            wrong: None,
        };
        let of = writer.exponents();
        let text = writer.expression(of, 3);
        let output = |text: &str| description(&format!("output y: [{}] = {text};", unit(of)));
        let (model, errors) = checked(&output(&text));
        assert!(errors.is_empty(), "{errors:#?}\n{text}");
        built += usize::from(model.is_some());
        let places = writer.places;
        if places == 0 {
            continue;
        }
        // The same expression again, up to the wrong place.
        let wrong = 1 + (seed as usize) % places;
        let mut writer = Writer {
            random: Random::new(seed),
            places: 0,
            wrong: Some(wrong),
        };
        let of = writer.exponents();
        let text = writer.expression(of, 3);
        let (_, errors) = checked(&output(&text));
        assert!(!errors.is_empty(), "place {wrong}: {text} was accepted");
        assert!(
            errors
                .iter()
                .all(|error| error.span.range().is_some() && !error.notes.is_empty()),
            "{errors:#?}"
        );
        refused += 1;
    }
    assert!(
        refused > 150 && built > 150,
        "{refused} refused, {built} built"
    );
}

#[test]
fn unknown_dimensions_follow() {
    for seed in 0..size(60, 4_000) {
        let mut writer = Writer {
            random: Random::new(seed),
            places: 0,
            wrong: None,
        };
        // k1 … k4 of random dimensions, in equations that are triangular in an order that is not that of the text.
        let of: Vec<Exponents> = (0..4).map(|_| writer.exponents()).collect();
        let mut statements = vec!["param k1 = 1.2, k2 = 1.3, k3 = 1.4, k4 = 1.5;".to_string()];
        let mut equations = Vec::new();
        for i in 0..4 {
            let (power, result) = (1 + writer.below(3) as i64, writer.exponents());
            let known = writer.below(i as u64 + 1) as usize;
            let mut factor = plus(result, of[i], -power);
            let mut text = format!("k{}^{power}", i + 1);
            if known < i {
                factor = plus(factor, of[known], 2);
                text += &format!(" / k{}^2", known + 1);
            }
            let factor = writer.expression(factor, 1);
            equations.push(format!(
                "output y{i}: [{}] = ({factor}) * {text};",
                unit(result)
            ));
        }
        let turn = writer.below(4) as usize;
        equations.rotate_left(turn);
        if writer.below(2) == 0 {
            equations.reverse();
        }
        statements.extend(equations);
        let text = description(&statements.join("\n"));
        let (model, errors) = checked(&text);
        assert!(errors.is_empty(), "{errors:#?}\n{text}");
        let Some(model) = model else { continue };
        let dimensions = model.dimensions.expect("has units");
        assert!(dimensions.open.is_empty(), "{dimensions:?}\n{text}");
        for (i, of) in of.iter().enumerate() {
            let found = &dimensions.units[&format!("k{}", i + 1)];
            let same = format!(
                "param a: [{found}] = 1, b: [{}] = 1; output z = a + b;",
                unit(*of)
            );
            let (_, errors) = checked(&description(&same));
            assert!(
                errors.is_empty(),
                "k{} is in [{found}], not {of:?}\n{text}",
                i + 1
            );
        }
    }
}

/// Units whose values in SI are defined, from the SI brochure (9th edition, 2019) and NIST SP 811, and their symbols.
#[test]
fn numbers_are_converted_exactly() {
    for (text, numerator, denominator, pi) in [
        ("250 [mm]", 1_i64, 4_i64, false),
        ("1 [in]", 254, 10_000, false),
        ("3 [ft]", 9_144, 10_000, false),
        ("36 [km/h]", 10, 1, false),
        ("1 [lb]", 45_359_237, 100_000_000, false),
        ("1 [lbf]", 44_482_216_152_605, 10_000_000_000_000, false),
        ("2 [t]", 2_000, 1, false),
        ("9.81e-3 [km/s^2]", 981, 100, false),
        ("1 [L/min]", 1, 60_000, false),
        ("5 [mA*h]", 18, 1, false),
        ("1 [kW*h]", 3_600_000, 1, false),
        ("2 [bar]", 200_000, 1, false),
        ("7 [MPa]", 7_000_000, 1, false),
        ("3 [N/mm]", 3_000, 1, false),
        ("4 [g*cm^2]", 4, 10_000_000, false),
        ("1 [day]", 86_400, 1, false),
        ("30 [deg]", 1, 6, true),
        ("2 [rev]", 4, 1, true),
        ("60 [rpm]", 2, 1, true),
        ("1 [mrad]", 1, 1000, false),
        ("2 [um^-1]", 2_000_000, 1, false),
        ("5 [fs]", 5, 1_000_000_000_000_000, false),
    ] {
        let pi = if pi { " * pi" } else { "" };
        let with = description(&format!("param a = {text};"));
        let without = description(&format!("param a = {numerator} / {denominator}{pi};"));
        let value = |text: &str| checked(text).0.map(|model| model.defaults);
        assert_eq!(value(&with), value(&without), "{text}");
        assert!(value(&with).is_some(), "{text}");
    }
}
