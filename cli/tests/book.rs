//! README and book: their commands run as they stand, one after the other on each page, in a folder that has nothing but what the
//! page has made and the repository's descriptions; links lead somewhere; every chapter is in the list of chapters.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines of a README at most.
const SHORT: usize = 150;

/// Files that pages speak of and do not make: a robot with a gripper, one without a fixed base, a state.
const GIVEN: [(&str, &str); 3] = [
    (
        "arm.urdf",
        r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><mass value="2"/><origin xyz="0 0 0.2"/><inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="finger"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="9" velocity="9"/></joint>
<joint name="finger_joint" type="prismatic"><parent link="upper"/><child link="finger"/><axis xyz="1 0 0"/><origin xyz="0 0 0.4"/><limit lower="0" upper="0.04" effort="9" velocity="9"/></joint>
</robot>"#,
    ),
    (
        "quadruped.urdf",
        r#"<robot name="quadruped"><link name="trunk"><inertial><mass value="5"/><inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="leg"><inertial><mass value="0.5"/><origin xyz="0 0 -0.1"/><inertia ixx="2e-3" iyy="2e-3" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hip" type="revolute"><parent link="trunk"/><child link="leg"/><axis xyz="0 1 0"/><origin xyz="0.2 0 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
</robot>"#,
    ),
    (
        "state.json",
        r#"{"configuration": {"hip": 0.3}, "velocity": {"hip": 1}}"#,
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// README and chapters, with their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let chapters = fs::read_dir(root().join("docs/book/src")).expect("the book");
    let chapters = chapters.map(|entry| entry.expect("an entry").path());
    let chapters = chapters.filter(|path| path.extension().is_some_and(|end| end == "md"));
    let others = ["README.md", "python/README.md"].map(|name| root().join(name));
    let mut pages: Vec<PathBuf> = chapters.chain(others).collect();
    pages.sort();
    let text = |path: PathBuf| (path.clone(), fs::read_to_string(path).expect("a page"));
    pages.into_iter().map(text).collect()
}

/// The blocks of a page that are for a shell.
fn shown(page: &str) -> impl Iterator<Item = &str> {
    let blocks = page.split("```sh\n").skip(1);
    blocks.filter_map(|rest| rest.split_once("```").map(|(block, _)| block))
}

/// What is run of a block: the command line, and files that are written for it. Other programs have tests of their own.
fn own(block: &str) -> String {
    let mut script = String::new();
    let (mut file, mut goes_on) = (false, false);
    for line in block.lines() {
        let line = line.replace("cargo run --release -- ", "hamel ");
        let begins = line.starts_with("hamel ") || line.starts_with("cat > ");
        if begins || file || goes_on {
            script.push_str(&line);
            script.push('\n');
            goes_on = line.ends_with('\\');
        }
        file = line.ends_with("<<'END'") || (file && line != "END");
    }
    script
}

#[test]
fn commands_run_as_they_stand() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book");
    let _ = fs::remove_dir_all(&folder);
    let program = Path::new(env!("CARGO_BIN_EXE_hamel"));
    let path = format!(
        "{}:{}",
        program.parent().expect("a folder").display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let mut commands = 0;
    for (page, text) in pages() {
        let name = page.file_stem().expect("a name").to_string_lossy();
        let place = folder.join(&*name).join(commands.to_string());
        fs::create_dir_all(&place).expect("a folder");
        for (name, text) in GIVEN {
            fs::write(place.join(name), text).expect("written");
        }
        for shared in ["examples", "tests"] {
            copy(&root().join(shared), &place.join(shared));
        }
        let script: String = shown(&text).map(own).collect();
        commands += script.matches("hamel ").count();
        let shell = Command::new("sh")
            .args(["-e", "-c", &script])
            .current_dir(&place)
            .env("PATH", &path)
            .output()
            .expect("a shell");
        assert!(
            shell.status.success(),
            "{}:\n{script}\n{}",
            page.display(),
            String::from_utf8_lossy(&shell.stderr)
        );
    }
    assert!(commands > 25, "{commands}");
}

/// The descriptions below a folder.
fn copy(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let place = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &place);
        } else if path
            .extension()
            .is_some_and(|end| end == "eom" || end == "csv")
        {
            fs::create_dir_all(to).expect("a folder");
            fs::copy(&path, &place).expect("copied");
        }
    }
}

#[test]
fn links_lead_somewhere() {
    let mut links = 0;
    for (page, text) in pages() {
        for rest in text.split("](").skip(1) {
            let target = rest.split([')', '#']).next().unwrap_or_default();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            let folder = page.parent().expect("a folder");
            assert!(folder.join(target).exists(), "{}: {target}", page.display());
            links += 1;
        }
    }
    assert!(links > 20, "{links}");
}

#[test]
fn every_chapter_is_listed() {
    let folder = root().join("docs/book/src");
    let list = fs::read_to_string(folder.join("SUMMARY.md")).expect("a list");
    for (page, _) in pages() {
        let name = page.file_name().expect("a name").to_string_lossy();
        let chapter = page.starts_with(&folder) && name != "SUMMARY.md";
        assert!(!chapter || list.contains(&format!("({name})")), "{name}");
    }
}

#[test]
fn the_readme_is_short() {
    let text = fs::read_to_string(root().join("README.md")).expect("a README");
    assert!(text.lines().count() <= SHORT);
}
