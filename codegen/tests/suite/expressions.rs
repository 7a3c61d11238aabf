//! Attacks expressions: random ones with roots, powers of 2, decimals of all sizes, exact angles and nearly equal
//! values are compared with their value in numbers of 200 bits.
//!
//! The error of an output is bounded by several dozen roundings of the expression as written, according to a propagated
//! bound. A hundred expressions by default, five hundred with `HAMEL_ATTACK=more`, ten thousand with
//! `HAMEL_ATTACK=full`.

use crate::common::{Random, attack, value};
use crate::precise::Precise;
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;

/// Number of outputs of a system.
const OUTPUTS_PER_SYSTEM: usize = 12;
/// Factor for the rounding of the same operations in another order.
const REORDERING_ROUNDINGS: f64 = 64.0;

#[derive(Clone, Debug)]
enum Expr {
    /// Text and value.
    Number(String, Precise),
    /// One of the parameters a, b or coordinates x, y.
    Symbol(usize),
    Add(Box<Expr>, Box<Expr>),
    Sub(Box<Expr>, Box<Expr>),
    Mul(Box<Expr>, Box<Expr>),
    Div(Box<Expr>, Box<Expr>),
    Square(Box<Expr>),
    Sqrt(Box<Expr>),
    Sin(Box<Expr>),
    Cos(Box<Expr>),
}

const SYMBOLS: [&str; 4] = ["a", "b", "x", "y"];
const PARAMETERS: [f64; 2] = [2.0, 3.0];

impl Expr {
    fn text(&self) -> String {
        match self {
            Expr::Number(text, _) => text.clone(),
            Expr::Symbol(index) => SYMBOLS[*index].into(),
            Expr::Add(a, b) => format!("({} + {})", a.text(), b.text()),
            Expr::Sub(a, b) => format!("({} - {})", a.text(), b.text()),
            Expr::Mul(a, b) => format!("({} * {})", a.text(), b.text()),
            Expr::Div(a, b) => format!("({} / {})", a.text(), b.text()),
            Expr::Square(a) => format!("({})^2", a.text()),
            Expr::Sqrt(a) => format!("sqrt({})", a.text()),
            Expr::Sin(a) => format!("sin({})", a.text()),
            Expr::Cos(a) => format!("cos({})", a.text()),
        }
    }

    /// Returns the value and a bound of its error from roundings to 2⁻⁵³; `None` if it is undefined, or rounding may
    /// make it so.
    fn at(&self, symbols: &[Precise; 4]) -> Option<(Precise, Precise)> {
        let unit = Precise::power_of_two(-53);
        let rounded = |value: Precise, error: Precise| {
            let error = &error + &(&value.abs() * &unit);
            value.is_finite().then_some((value, error))
        };
        match self {
            Expr::Number(_, value) => rounded(value.clone(), Precise::of(0.0)),
            Expr::Symbol(index) => Some((symbols[*index].clone(), Precise::of(0.0))),
            Expr::Add(a, b) => {
                let ((a, e), (b, f)) = (a.at(symbols)?, b.at(symbols)?);
                rounded(&a + &b, &e + &f)
            }
            Expr::Sub(a, b) => {
                let ((a, e), (b, f)) = (a.at(symbols)?, b.at(symbols)?);
                rounded(&a - &b, &e + &f)
            }
            Expr::Mul(a, b) => {
                let ((a, e), (b, f)) = (a.at(symbols)?, b.at(symbols)?);
                let error = &(&a.abs() * &f) + &(&e * &(&b.abs() + &f));
                rounded(&a * &b, error)
            }
            Expr::Div(a, b) => {
                let ((a, e), (b, f)) = (a.at(symbols)?, b.at(symbols)?);
                // The divisor must keep at least three digits.
                let least = &b.abs() - &(&f * &Precise::of(1e3));
                if least.is_negative() || b.abs().to_f64() < 1e-200 {
                    return None;
                }
                let quotient = &a / &b;
                let error = &(&e + &(&quotient.abs() * &f)) / &(&b.abs() - &f);
                rounded(quotient, error)
            }
            Expr::Square(a) => {
                let (a, e) = a.at(symbols)?;
                let error = &e * &(&(&a.abs() + &a.abs()) + &e);
                rounded(&a * &a, error)
            }
            Expr::Sqrt(a) => {
                let (a, e) = a.at(symbols)?;
                // The sign of the radicand must be certain.
                let least = &a - &(&e * &Precise::of(1e3));
                if least.is_negative() {
                    return None;
                }
                let root = a.sqrt();
                let error = match e.is_finite() && root.to_f64() > 0.0 {
                    true => &e / &root,
                    false => Precise::of(0.0),
                };
                rounded(root, error)
            }
            Expr::Sin(a) | Expr::Cos(a) => {
                let (a, e) = a.at(symbols)?;
                let value = if matches!(self, Expr::Sin(_)) {
                    a.sin()
                } else {
                    a.cos()
                };
                // A program may reduce an exact angle differently.
                let error = &e + &(&a.abs() * &unit);
                rounded(value, error)
            }
        }
    }
}

fn number(random: &mut Random) -> Expr {
    let exact = |text: String, value: Precise| Expr::Number(text, value);
    match random.below(9) {
        0 => {
            let power = 1 + random.below(70);
            exact(format!("2^{power}"), Precise::power_of_two(power as i32))
        }
        1 => {
            // One less than a power of 2.
            let power = 20 + random.below(50);
            let value = &Precise::power_of_two(power as i32) - &Precise::of(1.0);
            exact(format!("(2^{power} - 1)"), value)
        }
        2 => {
            let text = format!(
                "{:.3}e{}",
                1.0 + 8.0 * random.number().abs(),
                random.below(61) as i64 - 30
            );
            exact(text.clone(), Precise::parse(&text))
        }
        3 => {
            let n = 2 + random.below(40);
            exact(format!("sqrt({n})"), Precise::of(n as f64).sqrt())
        }
        4 => {
            let k = 1 + random.below(23);
            let angle = &(&Precise::of(k as f64) * &Precise::pi()) / &Precise::of(12.0);
            // Right angles are exact, whereas π of 200 bits is not.
            let cosine = random.below(2);
            match cosine {
                0 if k % 12 == 6 => exact(format!("cos({k} * pi / 12)"), Precise::of(0.0)),
                1 if k == 12 => exact(format!("sin({k} * pi / 12)"), Precise::of(0.0)),
                0 => exact(format!("cos({k} * pi / 12)"), angle.cos()),
                _ => exact(format!("sin({k} * pi / 12)"), angle.sin()),
            }
        }
        6 => {
            let n = 2 + random.below(8);
            let value = Precise::of(n as f64);
            match random.below(4) {
                0 => exact(format!("log({n})"), value.log()),
                1 => exact(
                    format!("atan2({n}, 3)"),
                    (&value / &Precise::of(3.0)).atan(),
                ),
                2 => exact(
                    format!("acos({n} / 10)"),
                    (&value / &Precise::of(10.0)).acos(),
                ),
                _ => exact(
                    format!("asin({n} / 10)"),
                    (&value / &Precise::of(10.0)).asin(),
                ),
            }
        }
        5 => exact(
            "sqrt(5 - 2 * sqrt(6))".into(),
            &Precise::of(3.0).sqrt() - &Precise::of(2.0).sqrt(),
        ),
        _ => {
            let n = 1 + random.below(9);
            exact(format!("{n}"), Precise::of(n as f64))
        }
    }
}

fn expression(random: &mut Random, depth: usize, pool: &[Expr]) -> Expr {
    if depth == 0 || random.below(8) == 0 {
        return match random.below(3) {
            0 => number(random),
            1 if !pool.is_empty() => pool[random.below(pool.len())].clone(),
            _ => Expr::Symbol(random.below(4)),
        };
    }
    let next = |random: &mut Random| Box::new(expression(random, depth - 1, pool));
    match random.below(12) {
        0 | 1 => Expr::Add(next(random), next(random)),
        2 | 3 => Expr::Sub(next(random), next(random)),
        4 | 5 => Expr::Mul(next(random), next(random)),
        6 => Expr::Div(next(random), next(random)),
        7 => Expr::Square(next(random)),
        8 | 9 => Expr::Sqrt(next(random)),
        10 => {
            // |e| as a root.
            Expr::Sqrt(Box::new(Expr::Square(next(random))))
        }
        _ => {
            let angle = Box::new(Expr::Symbol(random.below(4)));
            if random.below(2) == 0 {
                Expr::Sin(angle)
            } else {
                Expr::Cos(angle)
            }
        }
    }
}

/// Returns the faults of the outputs of a random system.
fn faults(seed: u64) -> Vec<String> {
    let random = &mut Random::new(seed);
    let mut pool: Vec<Expr> = Vec::new();
    for _ in 0..OUTPUTS_PER_SYSTEM {
        let depth = 2 + random.below(3);
        let found = expression(random, depth, &pool);
        pool.push(found);
    }
    let lines = pool.iter().enumerate();
    let lines: String = lines
        .map(|(k, e)| format!("    output o{k} = {};\n", e.text()))
        .collect();
    let text = format!(
        "system Roots {{\n    coord x, y; velocity v, w; rate x = v; rate y = w;\n    param a = 2, b = 3;\n    kinetic v^2 / 2 + w^2 / 2;\n{lines}    start x = 1.25; start y = 0.75;\n}}\n"
    );
    let of = match from_text(&text) {
        Ok(of) => of,
        Err(errors) => {
            let said = render(&errors, "test", &text, false);
            // Correct if an output is undefined everywhere.
            let reasons = [
                "an expression that is identically zero",
                "root of a negative number",
            ];
            let points =
                || (0..20).map(|k| [2.0, 3.0, 0.3 * f64::from(k) - 3.0, 2.7 - 0.4 * f64::from(k)]);
            let never =
                |e: &Expr| points().all(|symbols| e.at(&symbols.map(Precise::of)).is_none());
            if reasons.iter().any(|reason| said.contains(reason)) && pool.iter().any(never) {
                return Vec::new();
            }
            return vec![format!("seed {seed}: refused: {said}\n{text}")];
        }
    };
    let mut faults = Vec::new();
    for _ in 0..4 {
        let x = [3.0 * random.number(), 3.0 * random.number()];
        let symbols = [PARAMETERS[0], PARAMETERS[1], x[0], x[1]].map(Precise::of);
        for (k, e) in pool.iter().enumerate() {
            let Some((expected, bound)) = e.at(&symbols) else {
                continue;
            };
            // Values out of the range of f64 are not faults of the program.
            let size = expected.abs().to_f64();
            let is_zero = !(-&expected.abs()).is_negative();
            if !is_zero && !(1e-250..1e250).contains(&size) {
                continue;
            }
            let found = value(&of, &format!("o{k}"), [&x, &[0.0, 0.0], &[], &[]])[0];
            let error = (&Precise::of(found) - &expected).abs();
            let allowed = &bound * &Precise::of(REORDERING_ROUNDINGS);
            if found.is_nan() || (&allowed - &error).is_negative() {
                faults.push(format!(
                    "seed {seed}: o{k} = {} at {x:?} is {:e}, not {found:e} (bound {:e})\n{text}",
                    e.text(),
                    expected.to_f64(),
                    bound.to_f64()
                ));
            }
        }
    }
    faults
}

#[test]
fn roots_powers_and_decimals() {
    attack(10, 840, faults);
}
