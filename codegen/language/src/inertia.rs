//! Systems without inertia: they have kinematics, and what needs more is refused by its name.

use crate::diagnostics::Diagnostic;
use crate::functions::{Asked, FunctionId, Needs};
use crate::syntax::ast::Span;

/// Names in a message.
const MOST_NAMED: usize = 4;

/// What is wrong where functions are wanted, or something is claimed of the motion, that need inertia, and there is
/// none.
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
