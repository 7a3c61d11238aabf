//! dev
use hamel_codegen::*;
fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).unwrap();
        let t0 = std::time::Instant::now();
        let sys = match syntax::parse_text(&text) {
            Ok(s) => s,
            Err(e) => {
                println!("{}", render::render(&e, &path, &text, false));
                continue;
            }
        };
        let model = match model::build(&sys) {
            Ok(m) => m,
            Err(e) => {
                println!("{}", render::render(&e, &path, &text, false));
                continue;
            }
        };
        let t1 = std::time::Instant::now();
        let p = match derive::assemble::assemble(&model) {
            Ok(m) => m,
            Err(e) => {
                println!("{}", render::render(&[e], &path, &text, false));
                continue;
            }
        };
        let t2 = std::time::Instant::now();
        let f = p.function("accel").unwrap();
        let mut roots = f.outputs.clone();
        roots.extend(&f.guards);
        let c = program::count::count(&p.graph, &roots);
        let t3 = std::time::Instant::now();
        let text = emit::file(&p, &emit::Options::default());
        println!(
            "emit {:?} {} bytes {} statements",
            t3.elapsed(),
            text.len(),
            emit::statements(&p)
        );
        if std::env::var("SHOW").is_ok() {
            println!("{text}");
        }
        println!(
            "{path}: {:?} flops {} w {} parse+model {:?} all {:?} {}",
            c,
            c.flops(),
            c.weight(),
            t1 - t0,
            t2 - t1,
            f.docs[1]
        );
    }
}
