//! The table of methods that can be compared: one line each.

use crate::failure::Failure;
use crate::interpreted::Interpreted;
use hamel::Method;
use hamel::methods::General;
use hamel_report::counted::Counted;
use hamel_report::data::Kind;

/// A method with its name.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// Name on the command line.
    pub name: &'static str,
    /// What it is in a comparison.
    pub kind: Kind,
    /// The method.
    pub method: General,
}

const fn named(name: &'static str, kind: Kind, method: General) -> Named {
    Named { name, kind, method }
}

/// All of them; the first of the highest order makes references.
const TABLE: [Named; 3] = [
    named("rkmk4", Kind::Method, General::Rkmk4),
    named("rk4", Kind::Baseline, General::Rk4 { lambda: 10.0 }),
    named("rk4-projected", Kind::Baseline, General::Rk4Projected),
];

/// The methods with these names, or all.
pub fn chosen(names: &[String]) -> Result<Vec<Named>, Failure> {
    if names.is_empty() {
        return Ok(TABLE.to_vec());
    }
    let find = |name: &String| {
        let found = TABLE.iter().find(|method| method.name == name.trim());
        found.copied().ok_or_else(|| {
            let known: Vec<&str> = TABLE.iter().map(|method| method.name).collect();
            Failure::usage(format!(
                "no method `{name}`; there are {}",
                known.join(", ")
            ))
        })
    };
    names.iter().map(find).collect()
}

/// The method of the highest order, baselines last.
pub fn best(methods: &[Named]) -> Named {
    let rank = |named: &&Named| {
        let order = Method::<Interpreted>::order(&named.method);
        (named.kind == Kind::Method, order)
    };
    let first = TABLE[0];
    methods
        .iter()
        .rev()
        .max_by_key(rank)
        .copied()
        .unwrap_or(first)
}

/// The order of a method.
pub fn order(named: Named, system: &Counted<Interpreted>) -> u32 {
    fn of<'a, M: Method<Counted<'a, Interpreted>>>(
        method: &M,
        _: &Counted<'a, Interpreted>,
    ) -> u32 {
        method.order()
    }
    of(&named.method, system)
}
