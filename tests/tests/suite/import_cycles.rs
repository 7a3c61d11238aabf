//! Files that import one another in a cycle can only be understood together: no cycle has more than three.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Largest number of files in a cycle.
const MAX_CYCLE_FILES: usize = 3;

/// Returns the modules of a crate by their paths, each with its file.
fn modules(source: &Path) -> BTreeMap<Vec<String>, PathBuf> {
    let mut found = BTreeMap::new();
    let mut open = vec![(source.to_path_buf(), Vec::new())];
    while let Some((folder, path)) = open.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let file = entry.expect("an entry").path();
            let name = file.file_stem().expect("a name").to_string_lossy();
            let below = || path.iter().cloned().chain([name.to_string()]).collect();
            if file.is_dir() {
                open.push((file.clone(), below()));
            } else if matches!(&*name, "lib" | "main" | "tests") {
                // The root uses all modules; tests may use everything that they test.
            } else if name == "mod" {
                found.insert(path.clone(), file);
            } else {
                found.insert(below(), file);
            }
        }
    }
    found.retain(|path, _| path.iter().all(|part| part != "tests"));
    found
}

/// Collects the paths at the leaves of a `use` tree.
fn leaves(tree: &syn::UseTree, before: Vec<String>, all: &mut Vec<Vec<String>>) {
    let with = |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect();
    match tree {
        syn::UseTree::Path(path) => leaves(&path.tree, with(&path.ident), all),
        syn::UseTree::Name(name) => all.push(with(&name.ident)),
        syn::UseTree::Rename(name) => all.push(with(&name.ident)),
        syn::UseTree::Glob(_) => all.push(before),
        syn::UseTree::Group(group) => {
            let trees = group.items.iter();
            trees.for_each(|tree| leaves(tree, before.clone(), all));
        }
    }
}

/// Returns the modules from which a file imports.
fn imports(
    own: &[String],
    text: &str,
    modules: &BTreeMap<Vec<String>, PathBuf>,
) -> BTreeSet<Vec<String>> {
    let file = syn::parse_file(text).expect("Rust");
    let mut all = Vec::new();
    for item in &file.items {
        if let syn::Item::Use(item) = item {
            let before = all.len();
            leaves(&item.tree, Vec::new(), &mut all);
            // A folder's reexports of its modules do not count as imports.
            if !matches!(item.vis, syn::Visibility::Inherited) {
                let child = |path: &Vec<String>| modules.contains_key(&[own, &path[..1]].concat());
                let shown = all.split_off(before);
                all.extend(shown.into_iter().filter(|path| !child(path)));
            }
        }
    }
    let mut found = BTreeSet::new();
    for path in all {
        let outer = path.iter().take_while(|part| *part == "super").count();
        let absolute: Vec<String> = match path.first().map(String::as_str) {
            Some("crate") => path[1..].to_vec(),
            Some("super") => [&own[..own.len() - outer], &path[outer..]].concat(),
            Some("self") => [own, &path[1..]].concat(),
            _ => [own, &path].concat(),
        };
        let ends = (1..=absolute.len()).rev();
        let module = ends
            .map(|end| &absolute[..end])
            .find(|path| modules.contains_key(*path));
        found.extend(module.filter(|module| *module != own).map(<[_]>::to_vec));
    }
    found
}

/// Returns the modules that can be reached from a module.
fn reached<'a>(
    from: &'a Vec<String>,
    imports: &'a BTreeMap<Vec<String>, BTreeSet<Vec<String>>>,
) -> BTreeSet<&'a Vec<String>> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(module) = open.pop() {
        for next in &imports[module] {
            if reached.insert(next) {
                open.push(next);
            }
        }
    }
    reached
}

/// Returns the cycles of files that import one another.
fn circles(source: &Path) -> BTreeSet<Vec<String>> {
    let modules = modules(source);
    assert!(!modules.is_empty(), "{} has no modules", source.display());
    let of = |(path, file): (&Vec<String>, &PathBuf)| {
        let text = fs::read_to_string(file).expect("readable");
        (path.clone(), imports(path, &text, &modules))
    };
    let imports: BTreeMap<_, _> = modules.iter().map(of).collect();
    let reach: BTreeMap<_, _> = imports
        .keys()
        .map(|path| (path, reached(path, &imports)))
        .collect();
    let mut circles = BTreeSet::new();
    for (path, onward) in &reach {
        let back = onward.iter().filter(|next| reach[**next].contains(path));
        circles.insert(back.map(|path| path.join("::")).collect());
    }
    circles
}

#[test]
fn circles_of_imports_are_small() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for source in [
        "codegen",
        "codegen/algebra",
        "codegen/language",
        "codegen/import",
        "codegen/program",
        "codegen/dynamics",
        "codegen/verify",
        "codegen/emit",
        "codegen/tables",
        "codegen/files",
        "runtime",
        "cli/report",
        "cli",
    ] {
        for circle in circles(&root.join(source).join("src")) {
            let files = circle.join(", ");
            assert!(
                circle.len() <= MAX_CYCLE_FILES,
                "{source}: {files} import one another"
            );
        }
    }
}

/// Detects a cycle of four files in a temporary folder.
#[test]
fn a_larger_circle_is_found() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("circle");
    fs::create_dir_all(folder.join("d")).expect("a folder");
    for (file, text) in [
        ("a.rs", "use crate::b::B;"),
        ("b.rs", "use super::{c::{self, C}, e};"),
        ("c.rs", "use crate::d::D;"),
        ("d/mod.rs", "use super::a::A;"),
        ("e.rs", "use crate::a::A as Other;"),
    ] {
        fs::write(folder.join(file), text).expect("written");
    }
    let found = circles(&folder);
    let names = ["a", "b", "c", "d", "e"].map(String::from).to_vec();
    assert_eq!(found, BTreeSet::from([names]));
}
