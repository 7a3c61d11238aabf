//! The line of a public item: its signature without documentation, bodies and private fields.

use super::crates::is_public;
use syn::{
    Attribute, Block, Fields, File, FnModifiers, ImplItem, Item, ItemFn, ItemImpl, ItemStruct,
    ItemTrait, Signature, TraitItem, Visibility, parse_str,
};

/// Returns the lines of an item, each with the type that it belongs to, if any; none if the item is not public.
pub fn of(item: &Item) -> Vec<(String, String)> {
    let own = |vis: &Visibility, attrs: &[Attribute], line: String| match is_public(vis) {
        true => vec![(String::new(), format!("{}{line}", marks(attrs)))],
        false => Vec::new(),
    };
    match item {
        Item::Const(c) => own(&c.vis, &c.attrs, constant(&c.ident.to_string(), &c.ty)),
        Item::Static(s) => own(&s.vis, &s.attrs, constant(&s.ident.to_string(), &s.ty)),
        Item::Fn(f) => own(&f.vis, &f.attrs, function(&f.vis, &f.sig)),
        Item::Struct(s) => own(&s.vis, &s.attrs, structure(s)),
        Item::Enum(e) => {
            let mut e = e.clone();
            let attrs = std::mem::take(&mut e.attrs);
            for variant in &mut e.variants {
                variant.attrs.clear();
                clear(&mut variant.fields);
            }
            own(&e.vis.clone(), &attrs, printed(Item::Enum(e)))
        }
        Item::Type(t) => {
            let mut t = t.clone();
            let attrs = std::mem::take(&mut t.attrs);
            own(&t.vis.clone(), &attrs, printed(Item::Type(t)))
        }
        Item::Trait(t) if is_public(&t.vis) => interface(t),
        Item::Macro(m) => written(m),
        _ => Vec::new(),
    }
}

/// Returns the lines of an `impl` block of a public type: its public methods, or the trait.
pub fn of_block(block: &ItemImpl) -> Vec<String> {
    if block.trait_.is_some() {
        let mut head = block.clone();
        head.attrs.clear();
        head.items.clear();
        let line = printed(Item::Impl(head));
        return vec![line.trim_end_matches("{}").trim_end().into()];
    }
    let lines = block.items.iter().filter_map(|item| match item {
        ImplItem::Fn(f) if is_public(&f.vis) => {
            Some(format!("{}{}", cfg(&f.attrs), function(&f.vis, &f.sig)))
        }
        ImplItem::Const(c) if is_public(&c.vis) => Some(constant(&c.ident.to_string(), &c.ty)),
        _ => None,
    });
    lines.collect()
}

/// Returns the condition of an item, followed by a space.
pub fn cfg(attrs: &[Attribute]) -> String {
    shown(attrs, &["cfg"])
}

/// Returns the attributes that matter to a user of a type.
fn marks(attrs: &[Attribute]) -> String {
    shown(attrs, &["cfg", "derive", "non_exhaustive"])
}

fn shown(attrs: &[Attribute], names: &[&str]) -> String {
    let kept = attrs
        .iter()
        .filter(|attr| names.iter().any(|name| attr.path().is_ident(name)));
    let mut carrier: ItemStruct = parse_str("struct S;").expect("Rust");
    carrier.attrs = kept.cloned().collect();
    printed(Item::Struct(carrier))
        .trim_end_matches("struct S;")
        .into()
}

fn interface(item: &ItemTrait) -> Vec<(String, String)> {
    let mut head = item.clone();
    head.attrs.clear();
    head.items.clear();
    let line = printed(Item::Trait(head));
    let line = line.trim_end_matches("{}").trim_end();
    let mut lines = vec![(String::new(), format!("{}{line}", marks(&item.attrs)))];
    let name = item.ident.to_string();
    for inner in &item.items {
        let line = match inner {
            TraitItem::Fn(f) => {
                let end = match f.default {
                    Some(_) => " { .. }",
                    None => ";",
                };
                function(&Visibility::Inherited, &f.sig) + end
            }
            TraitItem::Const(c) => constant(&c.ident.to_string(), &c.ty),
            TraitItem::Type(_) => {
                let mut carrier = item.clone();
                carrier.attrs.clear();
                let mut inner = inner.clone();
                if let TraitItem::Type(ty) = &mut inner {
                    ty.attrs.clear();
                }
                carrier.items = vec![inner];
                let line = printed(Item::Trait(carrier));
                let start = line.find("{ type ").map_or(0, |start| start + 2);
                line[start..].trim_end_matches('}').trim_end().into()
            }
            _ => continue,
        };
        lines.push((name.clone(), line));
    }
    lines
}

/// Returns the line of an exported macro, or of an invocation whose items cannot be parsed.
fn written(item: &syn::ItemMacro) -> Vec<(String, String)> {
    let line = match &item.ident {
        Some(name) if item.attrs.iter().any(|a| a.path().is_ident("macro_export")) => {
            format!("macro_rules! {name}")
        }
        Some(_) => return Vec::new(),
        None => {
            let name = item.mac.path.segments.last();
            let name = name.map_or(String::new(), |segment| segment.ident.to_string());
            if name == "thread_local" {
                return Vec::new();
            }
            format!("{name}! {{ .. }}")
        }
    };
    vec![(String::new(), line)]
}

fn structure(item: &ItemStruct) -> String {
    let mut shown = item.clone();
    shown.attrs.clear();
    clear(&mut shown.fields);
    let mut hidden = false;
    match &mut shown.fields {
        Fields::Named(fields) => {
            let all = std::mem::take(&mut fields.named);
            let count = all.len();
            fields.named = all.into_iter().filter(|f| is_public(&f.vis)).collect();
            hidden = fields.named.len() < count;
        }
        Fields::Unnamed(fields) => {
            for field in &mut fields.unnamed {
                if !is_public(&field.vis) {
                    field.vis = Visibility::Inherited;
                    field.ty = parse_str("_").expect("a type");
                }
            }
        }
        Fields::Unit => {}
    }
    let line = printed(Item::Struct(shown));
    match (hidden, line.strip_suffix(" }"), line.strip_suffix("{}")) {
        (true, Some(open), _) => format!("{open}, .. }}"),
        (true, _, Some(open)) => format!("{open}{{ .. }}"),
        _ => line,
    }
}

fn clear(fields: &mut Fields) {
    for field in fields.iter_mut() {
        field.attrs.clear();
    }
}

fn constant(name: &str, ty: &syn::Type) -> String {
    let mut carrier: syn::ItemType = parse_str("type T = ();").expect("Rust");
    carrier.ty = Box::new(ty.clone());
    let line = printed(Item::Type(carrier));
    let ty = line.trim_start_matches("type T = ").trim_end_matches(';');
    format!("const {name}: {ty}")
}

fn function(vis: &Visibility, sig: &Signature) -> String {
    let mut sig = sig.clone();
    for input in &mut sig.inputs {
        match input {
            syn::FnArg::Receiver(receiver) => receiver.attrs.clear(),
            syn::FnArg::Typed(typed) => typed.attrs.clear(),
        }
    }
    let line = printed(Item::Fn(ItemFn {
        attrs: Vec::new(),
        vis: vis.clone(),
        modifiers: FnModifiers::default(),
        sig,
        block: Box::new(parse_str::<Block>("{}").expect("Rust")),
    }));
    // Whether a function modifies its arguments locally is not part of the interface.
    let line = line.replace("(mut ", "(").replace(", mut ", ", ");
    line.trim_end_matches("{}").trim_end().into()
}

/// Prints an item on one line.
fn printed(item: Item) -> String {
    let file = File {
        shebang: None,
        frontmatter: None,
        attrs: Vec::new(),
        items: vec![item],
    };
    let text = prettyplease::unparse(&file);
    let words: Vec<&str> = text.split_whitespace().collect();
    let line = words.join(" ");
    [
        ("( ", "("),
        (", )", ")"),
        (" )", ")"),
        ("< ", "<"),
        (", >", ">"),
        (", }", " }"),
        (", {", " {"),
    ]
    .iter()
    .fold(line, |line, (from, to)| line.replace(from, to))
}
