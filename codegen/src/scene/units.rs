//! Units of the declarations of a scene.

use super::{SceneBuilder, SceneError};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Item, ItemKind};
use crate::syntax::{parse_text, print};
use hamel_language::units::Unit;

impl SceneBuilder {
    /// Gives a declared name its unit: `arm.unit("m", "kg")` for `arm.param("m", 1.3)`, as in `param m: [kg] = 1.3;`. If
    /// it is not a unit of SI, the value of a parameter or constant is converted to SI.
    ///
    /// ```
    /// use hamel_codegen::scene::Scene;
    /// # fn main() -> Result<(), hamel_codegen::scene::SceneError> {
    /// let mut arm = Scene::builder("Arm");
    /// arm.param("l", 250.0);
    /// arm.unit("l", "mm")?;
    /// assert!(arm.build()?.to_string().contains("param l: [mm] = 250;"));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// If the name is not declared, the unit is unknown, or the declaration cannot have it; the text of the error is
    /// that of the statement.
    pub fn unit(&mut self, name: &str, unit: &str) -> Result<(), SceneError> {
        let mut unit = Some(Unit {
            // A bracket would end the unit; the parser refuses what stands for it.
            text: unit.replace(['[', ']'], "?"),
            ..Unit::one()
        });
        let declares = |item: &Item| place(&mut item.clone(), name).is_some();
        let found = self.system.items.iter().rposition(declares);
        let mut item = match found {
            Some(index) => self.system.items[index].clone(),
            None => {
                let text = format!("unit of {name}");
                let whole = hamel_language::diagnostics::Span::new(0..text.len());
                let error = Diagnostic::new(whole, format!("`{name}` is not declared"))
                    .help("declare it before its unit is set");
                return Err(SceneError::new(vec![error], &text));
            }
        };
        if let Some(place) = place(&mut item, name) {
            std::mem::swap(place, &mut unit);
        }
        let text = format!("system S {{ {}\n}}", print::statement(&item));
        let mut read = parse_text(&text).map_err(|errors| SceneError::new(errors, &text))?;
        if let (Some(index), Some(item)) = (found, read.items.pop()) {
            self.system.items[index] = item;
        }
        Ok(())
    }
}

/// Returns the place for the unit of a name that a statement declares.
fn place<'a>(item: &'a mut Item, name: &str) -> Option<&'a mut Option<Unit>> {
    match &mut item.kind {
        ItemKind::Param(list)
        | ItemKind::Const(list)
        | ItemKind::Let(list)
        | ItemKind::Velocity(list)
        | ItemKind::Input(list)
        | ItemKind::State(list) => {
            let mut list = list.iter_mut();
            Some(&mut list.find(|one| one.name.name == name)?.unit)
        }
        ItemKind::Coord(list) => Some(&mut list.iter_mut().find(|one| one.0.name == name)?.2),
        ItemKind::Output {
            name: own, unit, ..
        } if own.name == name => Some(unit),
        _ => None,
    }
}
