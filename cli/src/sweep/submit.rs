//! `--submit`: submits the shards as an array of tasks of an engine; each task runs `hamel sweep … --shard i/N`.

use crate::failure::{self, Failure, print};
use clap::ValueEnum;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The script that each task runs, in the folder of the sweep.
const TASK_SCRIPT: &str = "_task.sh";
/// Options that are not passed to tasks, with whether they take a value.
const OWN_OPTIONS: [(&str, bool); 4] = [
    ("--submit", true),
    ("--tasks", true),
    ("--wait", false),
    ("--threads", true),
];

/// Engine that distributes tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// Job arrays, `sbatch --array`.
    Slurm,
    /// Task arrays, `hq submit --array`.
    Hyperqueue,
}

/// A submission.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// Engine.
    pub engine: Engine,
    /// Folder of the sweep.
    pub folder: &'a Path,
    /// Number of tasks.
    pub tasks: u64,
    /// Number of cores of each task.
    pub threads: usize,
    /// Whether to return only when all tasks have finished.
    pub wait: bool,
}

impl Job<'_> {
    /// Writes the script of a task and submits the array.
    pub fn submit(&self) -> Result<(), Failure> {
        let script = self.folder.join(TASK_SCRIPT);
        let own: Vec<OsString> = std::env::args_os().skip(1).collect();
        let program = std::env::current_exe().map_err(|error| {
            Failure::usage(format!("cannot find the path of this program: {error}"))
        })?;
        let mut words = vec![program.into_os_string()];
        words.extend(of_task(&own));
        let text = self.script(&words)?;
        failure::write(&script, &text)?;
        let mut command = self.command(&script)?;
        let name = command.get_program().to_string_lossy().into_owned();
        let status = command.status().map_err(|error| {
            Failure::usage(format!(
                "cannot run `{name}`: {error}; the script of a task is {}",
                script.display()
            ))
        })?;
        match (status.success(), self.wait) {
            (true, true) => Ok(()),
            (true, false) => print(&format!(
                "submitted {} tasks; `hamel sweep --status {}` shows their progress\n",
                self.tasks,
                self.folder.display()
            )),
            (false, _) => Err(Failure::failed(format!(
                "`{name}` has failed: {status}; submit again to compute what is missing"
            ))),
        }
    }

    /// Returns the shell script of a task.
    fn script(&self, words: &[OsString]) -> Result<String, Failure> {
        let mut text = String::from("#!/bin/sh\n# One part of a sweep: hamel sweep --submit\nexec");
        for word in words {
            let Some(word) = word.to_str() else {
                return Err(Failure::usage("--submit takes arguments in UTF-8"));
            };
            text.push(' ');
            text.push_str(&quote(word));
        }
        let variable = match self.engine {
            Engine::Slurm => "SLURM_ARRAY_TASK_ID",
            Engine::Hyperqueue => "HQ_TASK_ID",
        };
        let (threads, tasks) = (self.threads, self.tasks);
        text.push_str(&format!(
            " --threads {threads} --shard \"${variable}/{tasks}\"\n"
        ));
        Ok(text)
    }

    fn command(&self, script: &Path) -> Result<Command, Failure> {
        let here = std::env::current_dir();
        let here = here.map_err(|error| Failure::usage(format!("no folder to run in: {error}")))?;
        let folder = here.join(self.folder);
        let log = |name: &str| -> PathBuf { folder.join(name) };
        let array = format!("--array=1-{}", self.tasks);
        let mut command = match self.engine {
            Engine::Slurm => {
                let mut command = Command::new("sbatch");
                command.arg(array).arg("--job-name=hamel-sweep");
                command.arg(format!("--cpus-per-task={}", self.threads));
                command.arg("--chdir").arg(&here);
                command.arg("--output").arg(log("_task-%a.log"));
                if self.wait {
                    command.arg("--wait");
                }
                command
            }
            Engine::Hyperqueue => {
                let mut command = Command::new("hq");
                command.args(["submit", &array, "--name=hamel-sweep"]);
                command.arg(format!("--cpus={}", self.threads));
                command.arg("--cwd").arg(&here);
                command.arg("--stdout").arg(log("_task-%{TASK_ID}.log"));
                command.arg("--stderr").arg(log("_task-%{TASK_ID}.err"));
                if self.wait {
                    command.arg("--wait");
                }
                command.arg("sh");
                command
            }
        };
        command.arg(here.join(script));
        Ok(command)
    }
}

/// Returns the arguments without the options of the submission.
fn of_task(words: &[OsString]) -> Vec<OsString> {
    let mut task = Vec::new();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let text = word.to_string_lossy();
        let own = OWN_OPTIONS.iter().find(|(name, _)| {
            text.strip_prefix(name)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
        });
        match own {
            None => task.push(word.clone()),
            Some((name, true)) if text == *name => {
                words.next();
            }
            Some(_) => {}
        }
    }
    task
}

/// Returns a word, quoted for the shell.
fn quote(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::{Engine, Job, of_task};
    use std::ffi::OsString;
    use std::path::Path;

    fn words(text: &[&str]) -> Vec<OsString> {
        text.iter().map(OsString::from).collect()
    }

    #[test]
    fn tasks_get_all_but_what_is_about_the_submission() {
        let given = [
            "sweep",
            "a.eom",
            "--submit=slurm",
            "--tasks",
            "4",
            "--seed",
            "7",
            "--wait",
            "--threads=2",
        ];
        assert_eq!(
            of_task(&words(&given)),
            words(&["sweep", "a.eom", "--seed", "7"])
        );
    }

    #[test]
    fn a_task_is_a_part_of_the_sweep() {
        let job = Job {
            engine: Engine::Slurm,
            folder: Path::new("runs"),
            tasks: 16,
            threads: 2,
            wait: false,
        };
        let script = job
            .script(&words(&["hamel", "sweep", "it's"]))
            .expect("UTF-8");
        let last = script.lines().last();
        let wanted =
            "exec 'hamel' 'sweep' 'it'\\''s' --threads 2 --shard \"$SLURM_ARRAY_TASK_ID/16\"";
        assert_eq!(last, Some(wanted));
    }
}
