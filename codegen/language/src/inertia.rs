//! Systems without inertia: these have kinematics only, and everything that needs inertia is refused by name.

use crate::diagnostics::Diagnostic;
use crate::functions::{Asked, FunctionId, Needs};
use crate::syntax::ast::Span;

/// Largest number of names listed in the message.
const MOST_NAMED: usize = 4;

/// Returns the error for a system without inertia if a requested function, or a claim about the motion, needs inertia.
/// Returns `None` if the system has inertia or nothing needs it.
pub fn lacking<'a>(
    span: Span,
    has_inertia: bool,
    asked: &'a Asked,
    claims: impl Iterator<Item = &'a str>,
) -> Option<Diagnostic> {
    if has_inertia {
        return None;
    }
    let needs = |id: &&FunctionId| id.row().needs > Needs::Nothing;
    let named: Vec<&FunctionId> = asked.functions.iter().filter(needs).collect();
    let all = FunctionId::ALL.iter().filter(needs);
    let wanted: Vec<&FunctionId> = match named.is_empty() {
        true => all.filter(|&&id| asked.wants(id)).collect(),
        false => named,
    };
    let functions = wanted.iter().map(|id| id.name());
    let slopes = asked.slopes.iter().map(String::as_str);
    let names: Vec<&str> = functions.chain(slopes).chain(claims).collect();
    let (shown, rest) = names.split_at(names.len().min(MOST_NAMED));
    let (last, before) = shown.split_last()?;
    let mut listed: Vec<String> = before.iter().map(|name| format!("`{name}`")).collect();
    let end = match rest.len() {
        0 => format!("`{last}`"),
        _ => "others".into(),
    };
    let verb = if listed.is_empty() { "needs" } else { "need" };
    let list = match listed.as_slice() {
        [] => end,
        _ => {
            let list = listed.join(", ");
            listed.clear();
            format!("{list} and {end}")
        }
    };
    let message = format!("the system has no inertia, which {list} {verb}");
    Some(Diagnostic::new(span, message)
        .help("write `body on f { mass m; … }`, `particle mass m at p;` or `kinetic …;`; kinematics needs none: `generate rate, jacobian f;`")
        .lacking(Needs::Inertia))
}
