//! Mutations of all fixtures: no text makes the generator panic, overflow or hang.
//!
//! Every case has a separate seed, `HAMEL_FUZZ_SEED` plus its number, and can be reproduced alone. `HAMEL_FUZZ_CASES`
//! is the number of cases that pass through the whole pipeline instead of only the parser; a failing text is printed in
//! its smallest form.

mod mutator;

use crate::size::size;
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;
use hamel_codegen::reuse::expand;
use hamel_codegen::syntax::ast::{Item, ItemKind};
use hamel_codegen::syntax::parse_text;
use mutator::{Corpus, Random};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Number of cases for the parser, by default and at full size.
const PARSED_CASES: [u64; 2] = [10_000, 1_000_000];
/// Number of cases for all stages, by default and at full size, unless `HAMEL_FUZZ_CASES` is set.
const GENERATED_CASES: [u64; 2] = [500, 100_000];
/// Generous time limit of one case: the machine may be busy with other tests.
const CASE_TIMEOUT: Duration = Duration::from_secs(10);
/// Stack size of threads, as that of a program's main thread.
const STACK_BYTES: usize = 8 << 20;

fn number(variable: &str, otherwise: usize) -> usize {
    let text = std::env::var(variable).ok();
    text.and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// The current text of a worker, and its start time.
type Work = Mutex<Option<(String, Instant)>>;

/// Runs all cases; returns the smallest text for the first panic. Prints the slowest case.
fn run(
    count: usize,
    make: impl Fn(usize) -> String + Sync,
    check: impl Fn(&str) + Sync,
) -> Option<String> {
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get().min(8));
    let work: Vec<Work> = (0..workers).map(|_| Mutex::new(None)).collect();
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let failure: Mutex<Option<String>> = Mutex::new(None);
    let slowest: Mutex<(Duration, String)> = Mutex::default();
    let set = |text: &str| *failure.lock().expect("unpoisoned") = Some(text.to_string());
    std::thread::scope(|scope| {
        for work in &work {
            let worker = || {
                loop {
                    let case = next.fetch_add(1, Ordering::Relaxed);
                    if case >= count || failure.lock().expect("unpoisoned").is_some() {
                        break;
                    }
                    let text = make(case);
                    *work.lock().expect("unpoisoned") = Some((text.clone(), Instant::now()));
                    let start = Instant::now();
                    let panicked = panics(&text, &check);
                    let mut slow = slowest.lock().expect("unpoisoned");
                    if start.elapsed() > slow.0 {
                        *slow = (start.elapsed(), text.clone());
                    }
                    drop(slow);
                    if panicked {
                        set(&smallest(&text, |text| panics(text, &check)));
                    }
                }
                *work.lock().expect("unpoisoned") = None;
                done.fetch_add(1, Ordering::Relaxed);
            };
            let thread = std::thread::Builder::new().stack_size(STACK_BYTES);
            thread.spawn_scoped(scope, worker).expect("a thread");
        }
        while done.load(Ordering::Relaxed) < workers {
            std::thread::sleep(Duration::from_millis(20));
            for work in &work {
                let work = work.lock().expect("unpoisoned");
                if let Some((text, since)) = work.as_ref()
                    && since.elapsed() > CASE_TIMEOUT
                    && failure.lock().expect("unpoisoned").is_none()
                {
                    // The thread cannot be stopped, so the process ends.
                    eprintln!("more than {CASE_TIMEOUT:?} for:\n{text}");
                    std::process::exit(1);
                }
            }
        }
    });
    let (time, text) = slowest.into_inner().expect("unpoisoned");
    println!("{count} cases, the slowest in {time:?}:\n{text}");
    failure.into_inner().expect("unpoisoned")
}

fn panics(text: &str, check: &(impl Fn(&str) + Sync)) -> bool {
    catch_unwind(AssertUnwindSafe(|| check(text))).is_err()
}

/// Minimises a failing text by leaving out tokens.
fn smallest(text: &str, fails: impl Fn(&str) -> bool) -> String {
    let mut tokens = mutator::tokens(text);
    if !fails(&tokens.join(" ")) {
        return text.to_string();
    }
    let mut width = tokens.len().max(1);
    while width > 0 {
        let mut at = 0;
        while at < tokens.len() {
            let end = (at + width).min(tokens.len());
            let rest: Vec<String> = tokens[..at].iter().chain(&tokens[end..]).cloned().collect();
            if fails(&rest.join(" ")) {
                tokens = rest;
            } else {
                at = end;
            }
        }
        width /= 2;
    }
    tokens.join(" ")
}

/// Number of joints and coordinates above which a description is expected to be slow.
const LONG_DESCRIPTION_JOINTS: usize = 24;

/// Returns whether a description repeats so much that its equations of motion are long.
fn is_long(text: &str) -> bool {
    let Ok(system) = parse_text(text) else {
        return false;
    };
    let moves = |item: &&Item| matches!(item.kind, ItemKind::Joint(_) | ItemKind::Coord(_));
    expand(&system).is_ok_and(|written| {
        written.system.items.iter().filter(moves).count() > LONG_DESCRIPTION_JOINTS
    })
}

/// Runs all stages and renders the errors; returns whether the text is correct.
fn generate(text: &str) -> bool {
    if is_long(text) {
        return true;
    }
    let generated = from_text(text);
    if let Err(errors) = &generated {
        assert!(!errors.is_empty(), "refused without a reason");
        let text = render(errors, "mutated.eom", text, false);
        assert!(!text.contains("internal check failed"), "{text}");
    }
    generated.is_ok()
}

#[test]
fn no_text_panics() {
    let corpus = Corpus::read();
    let seed = number("HAMEL_FUZZ_SEED", 0x4a6d) as u64;
    let [parsed, generated] =
        [PARSED_CASES, GENERATED_CASES].map(|[few, many]| size(few, many) as usize);
    let cases = number("HAMEL_FUZZ_CASES", generated);
    println!("seed {seed}, {parsed} parsed, {cases} generated");
    let mutate = |case: usize| corpus.mutate(&mut Random::new(seed + case as u64), false);
    let failure = run(parsed, mutate, |text| drop(parse_text(text)));
    assert!(
        failure.is_none(),
        "the parser panics on:\n{}",
        failure.unwrap_or_default()
    );
    let mutate = |case: usize| corpus.mutate(&mut Random::new(seed + case as u64), true);
    let right = AtomicUsize::new(0);
    let failure = run(cases, mutate, |text| {
        right.fetch_add(usize::from(generate(text)), Ordering::Relaxed);
    });
    println!("{} of them are right", right.into_inner());
    assert!(
        failure.is_none(),
        "the generator fails on:\n{}",
        failure.unwrap_or_default()
    );
}
