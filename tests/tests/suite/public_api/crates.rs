//! The modules of a crate, and their items that can be named from outside.

use super::signature::{self, cfg};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use syn::{Item, ItemImpl, Type, UseTree, Visibility};

/// A module with its items; modules inside it are in `modules`.
struct Module {
    name: String,
    public: bool,
    /// Whether it is left out of the documentation: open to the tests of this repository, but not part of the
    /// interface.
    hidden: bool,
    condition: String,
    items: Vec<Item>,
    modules: Vec<Module>,
}

/// A crate, parsed from its sources.
pub struct Crate {
    root: Module,
}

/// The results of the traversal of a crate.
#[derive(Default)]
struct Found {
    lines: BTreeSet<String>,
    /// Names of public types and traits; methods of public types are public as well.
    types: BTreeSet<String>,
    /// Names of all traits of the crate.
    traits: BTreeSet<String>,
}

impl Crate {
    /// Reads the crate whose `lib.rs` is in this folder.
    pub fn read(sources: &Path) -> Self {
        let items = parse(&sources.join("lib.rs"));
        Crate {
            root: Module::new("crate".into(), (true, false), String::new(), items, sources),
        }
    }

    /// Returns a line for every public item, sorted.
    pub fn public(&self) -> Vec<String> {
        let mut found = Found::default();
        self.list(&self.root, &[], &mut found);
        self.root.traits(&mut found.traits);
        self.root.methods(&mut found);
        found.lines.into_iter().collect()
    }

    fn list(&self, module: &Module, path: &[String], found: &mut Found) {
        for item in &module.items {
            match item {
                Item::Use(item) if is_public(&item.vis) => {
                    for (target, name) in imports(&item.tree) {
                        self.exported(path, &target, &name, &cfg(&item.attrs), found);
                    }
                }
                item => found.item(&path.join("::"), item),
            }
        }
        for inner in module.modules.iter().filter(|inner| inner.public) {
            let mut path = path.to_vec();
            path.push(inner.name.clone());
            let name = path.join("::");
            let hidden = if inner.hidden { "hidden " } else { "" };
            found
                .lines
                .insert(format!("{}{hidden}mod {name}", inner.condition));
            if !inner.hidden {
                self.list(inner, &path, found);
            }
        }
    }

    /// Handles `pub use target as name` in the module at `path`: an item of a private module of the crate is listed as
    /// if it were here, all others by their paths.
    fn exported(
        &self,
        path: &[String],
        target: &[String],
        name: &str,
        condition: &str,
        found: &mut Found,
    ) {
        let (last, inside) = target.split_last().expect("a path");
        let absolute = match inside.first().map(String::as_str) {
            Some("crate") => inside[1..].to_vec(),
            Some("self") => [path, &inside[1..]].concat(),
            Some("super") => [&path[..path.len() - 1], &inside[1..]].concat(),
            _ => [path, inside].concat(),
        };
        let here = path.join("::");
        if let Some((module, false)) = self.module(&absolute) {
            let mut items = module.items.iter().filter(|item| named(item, last));
            if last == "*" {
                items.for_each(|item| found.item(&here, item));
                return;
            }
            if let Some(item) = items.next() {
                found.item(&here, item);
                return;
            }
            // A type written by a macro of that module.
            found.types.insert(name.into());
        }
        let renamed = match name == last {
            true => String::new(),
            false => format!(" as {name}"),
        };
        let line = format!("pub use {}{renamed}", target.join("::"));
        found.lines.insert(at(&here, condition, &line));
    }

    /// Returns the module of a path from the root, and whether it can be named from outside.
    fn module(&self, path: &[String]) -> Option<(&Module, bool)> {
        let mut module = &self.root;
        let mut public = true;
        for name in path {
            module = module.modules.iter().find(|inner| inner.name == *name)?;
            public &= module.public;
        }
        Some((module, public))
    }
}

impl Module {
    /// Separates the modules from the items; modules in separate files are below `folder`.
    fn new(
        name: String,
        (public, hidden): (bool, bool),
        condition: String,
        items: Vec<Item>,
        folder: &Path,
    ) -> Self {
        let (mut rest, mut modules) = (Vec::new(), Vec::new());
        for item in items {
            let Item::Mod(item) = item else {
                rest.push(item);
                continue;
            };
            let condition = cfg(&item.attrs);
            if condition == "#[cfg(test)] " {
                continue;
            }
            let name = item.ident.to_string();
            let inside = folder.join(&name);
            let items = match item.content {
                Some((_, items)) => items,
                None => {
                    let file = folder.join(format!("{name}.rs"));
                    match file.exists() {
                        true => parse(&file),
                        false => parse(&inside.join("mod.rs")),
                    }
                }
            };
            let public = is_public(&item.vis);
            let hidden = item
                .attrs
                .iter()
                .any(|attr| attr == &syn::parse_quote!(#[doc(hidden)]));
            modules.push(Module::new(
                name,
                (public, hidden),
                condition,
                items,
                &inside,
            ));
        }
        Module {
            name,
            public,
            hidden,
            condition,
            items: rest,
            modules,
        }
    }

    fn traits(&self, traits: &mut BTreeSet<String>) {
        traits.extend(self.items.iter().filter_map(|item| match item {
            Item::Trait(item) => Some(item.ident.to_string()),
            _ => None,
        }));
        self.modules.iter().for_each(|inner| inner.traits(traits));
    }

    /// Lists methods of public types and the traits that they implement, in any module.
    fn methods(&self, found: &mut Found) {
        for item in &self.items {
            if let Item::Impl(item) = item {
                found.block(item);
            }
        }
        let shown = self.modules.iter().filter(|inner| !inner.hidden);
        shown.for_each(|inner| inner.methods(found));
    }
}

impl Found {
    /// Lists an item of a public module.
    fn item(&mut self, path: &str, item: &Item) {
        if let Item::Struct(syn::ItemStruct { vis, ident, .. })
        | Item::Enum(syn::ItemEnum { vis, ident, .. })
        | Item::Trait(syn::ItemTrait { vis, ident, .. })
        | Item::Type(syn::ItemType { vis, ident, .. }) = item
            && is_public(vis)
        {
            self.types.insert(ident.to_string());
        }
        if let Item::Macro(item) = item {
            // Types written by a macro of the module.
            let text = item.mac.tokens.to_string();
            for start in ["pub enum ", "pub struct "] {
                let names = text.split(start).skip(1);
                let names = names.filter_map(|rest| rest.split(' ').next());
                self.types.extend(names.map(String::from));
            }
        }
        for (owner, line) in signature::of(item) {
            let place = match (path, owner.as_str()) {
                (path, "") => path.into(),
                ("", owner) => owner.into(),
                (path, owner) => format!("{path}::{owner}"),
            };
            self.lines.insert(at(&place, "", &line));
        }
    }

    fn block(&mut self, block: &ItemImpl) {
        let Some(name) = type_name(&block.self_ty) else {
            return;
        };
        let interface = block
            .trait_
            .as_ref()
            .and_then(|(path, _)| path.segments.last());
        let interface = interface.map(|segment| segment.ident.to_string());
        let private = |name: &String| self.traits.contains(name) && !self.types.contains(name);
        if !self.types.contains(&name) || interface.as_ref().is_some_and(private) {
            return;
        }
        for line in signature::of_block(block) {
            self.lines.insert(at(&name, &cfg(&block.attrs), &line));
        }
    }
}

fn at(place: &str, condition: &str, line: &str) -> String {
    match place {
        "" => format!("{condition}{line}"),
        place => format!("{place}: {condition}{line}"),
    }
}

fn parse(file: &Path) -> Vec<Item> {
    let text = fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let file = syn::parse_file(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    file.items
}

pub fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn named(item: &Item, name: &str) -> bool {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        _ => return false,
    };
    name == "*" || ident == name
}

fn type_name(ty: &Type) -> Option<String> {
    match ty {
        Type::Path(path) => path.path.segments.last().map(|s| s.ident.to_string()),
        Type::Reference(reference) => type_name(&reference.elem),
        _ => None,
    }
}

/// Returns the paths of a `use`, each with the name that it introduces.
fn imports(tree: &UseTree) -> Vec<(Vec<String>, String)> {
    match tree {
        UseTree::Path(path) => {
            let mut inner = imports(&path.tree);
            for (target, _) in &mut inner {
                target.insert(0, path.ident.to_string());
            }
            inner
        }
        UseTree::Name(name) => vec![(vec![name.ident.to_string()], name.ident.to_string())],
        UseTree::Rename(name) => vec![(vec![name.ident.to_string()], name.rename.to_string())],
        UseTree::Glob(_) => vec![(vec!["*".into()], "*".into())],
        UseTree::Group(group) => group.items.iter().flat_map(imports).collect(),
    }
}
