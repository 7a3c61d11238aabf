//! `hamel-book build` writes the pages for mdBook below `target`; `hamel-book check FOLDER` checks the pages that
//! mdBook has made; `hamel-book gallery` writes only the page of the gallery, with its pictures, below
//! `target/gallery`. Under the name `hamel`, the program is the command line, which the commands of the pages run.

use std::io::Result;
use std::path::Path;
use std::process::ExitCode;

use hamel_book::gallery::sections;
use hamel_book::shell::Shell;

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args_os().collect();
    let name = words.first().map(Path::new).and_then(Path::file_name);
    if name.is_some_and(|name| name == "hamel") {
        return ExitCode::from(hamel_cli::command(words));
    }
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let done = match &*asked.iter().map(String::as_str).collect::<Vec<_>>() {
        ["build"] => build(),
        ["check", folder] => check(Path::new(folder)),
        ["gallery"] => gallery(),
        _ => {
            eprintln!("hamel-book build, hamel-book gallery, or hamel-book check FOLDER");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<bool> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let program = std::env::current_exe()?;
    hamel_book::build::build(&root, &root.join("target/book-pages"), &program)?;
    Ok(true)
}

fn gallery() -> Result<bool> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = root.join("target/gallery");
    let program = std::env::current_exe()?;
    let shell = Shell::new(&root, &folder.join("run"), &program)?;
    let text = sections(&root, &shell, &folder.join("gallery"))?;
    std::fs::write(folder.join("gallery.md"), text)?;
    println!("wrote target/gallery/gallery.md");
    Ok(true)
}

fn check(folder: &Path) -> Result<bool> {
    let (wrong, links) = hamel_book::html::broken(folder)?;
    for line in &wrong {
        eprintln!("{line}");
    }
    println!("{links} links, {} of them broken", wrong.len());
    Ok(wrong.is_empty() && links > 0)
}
