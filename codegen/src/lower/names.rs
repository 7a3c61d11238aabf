//! Named expressions and frames.
//!
//! Expressions are read in the order of the text. Frames form a graph, whose nodes are the frames
//! and the world, and whose edges are the `frame` statements: `frame f on g = P` relates two frames,
//! and either may be the one that is known, g = f P⁻¹ as well as f = g P. The graph has to be a tree
//! that hangs together with the world; the order of its statements does not matter. What is about
//! velocities of frames waits until the rates of the coordinates are known.

use super::applied;
use super::frames::{Relation, define_let, parent_pose, relative_pose};
use super::scope::{NameKind, Scope};
use super::{frames, motion};
use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::Frame;
use crate::model::value::Value;
use crate::syntax::ast::{Declaration, Expr, ExprKind, ItemKind, System};
use std::collections::{BTreeMap, BTreeSet};

/// What the `let` and `frame` statements say, and which of them wait for the rates.
#[derive(Default)]
pub struct Names<'a> {
    /// Named expressions, in the order in which they became known.
    pub lets: Vec<(String, Value)>,
    /// Frames, in the order in which they became known.
    pub frames: Vec<Frame>,
    tasks: Vec<Task<'a>>,
    /// The relations that placed a frame: the edges of the tree.
    placed: Vec<Relation<'a>>,
    /// Names that a `frame` statement mentions on its left side or after `on`.
    nodes: BTreeSet<&'a str>,
    /// Names on the left side of a `frame` statement.
    named: BTreeSet<&'a str>,
    /// What the values of functions mention, but for their parameters.
    functions: BTreeMap<&'a str, BTreeSet<&'a str>>,
}

/// A statement that is still to be read.
#[derive(Clone, Copy)]
enum Task<'a> {
    Let(&'a Declaration),
    Frame(Relation<'a>),
}

/// Stands among the names of an expression for the rates of the coordinates.
const RATES: &str = "d/dt";

impl<'a> Task<'a> {
    /// Names in its expression, and [`RATES`] where it needs them.
    fn mentions(&self) -> BTreeSet<&'a str> {
        let mut names = BTreeSet::new();
        match self {
            Task::Let(declaration) => {
                if let Some(value) = &declaration.value {
                    mentioned(value, &mut names);
                }
            }
            Task::Frame(relation) => mentioned(relation.pose, &mut names),
        }
        names
    }
}

fn mentioned<'a>(expr: &'a Expr, names: &mut BTreeSet<&'a str>) {
    match &expr.kind {
        ExprKind::Name(name) => _ = names.insert(name),
        ExprKind::Call(function, _) => {
            // Where it is a function of the description, what that mentions follows.
            names.insert(&function.name);
            if motion::needs_rates(&function.name) {
                names.insert(RATES);
            }
        }
        _ => {}
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| mentioned(part, names));
}

impl<'a> Names<'a> {
    /// Reads all that can be known before the rates.
    pub fn read(
        system: &'a System,
        graph: &mut Graph,
        scope: &mut Scope,
        report: &mut Report,
    ) -> Self {
        let mut names = Names::default();
        for (name, function) in applied::functions(system) {
            let mut mentions = BTreeSet::new();
            mentioned(&function.value, &mut mentions);
            for (parameter, _) in &function.parameters {
                mentions.remove(parameter.name.as_str());
            }
            names.functions.insert(name, mentions);
        }
        for item in &system.items {
            match &item.kind {
                ItemKind::Let(list) => names.tasks.extend(list.iter().map(Task::Let)),
                ItemKind::Frame { name, on, pose } => {
                    let on = on.as_ref();
                    names.named.insert(&name.name);
                    let ends = [Some(name), on].into_iter().flatten();
                    let frames = ends.map(|end| end.name.as_str());
                    names.nodes.extend(frames.filter(|name| *name != "world"));
                    let span = item.span;
                    let relation = Relation {
                        name,
                        on,
                        pose,
                        span,
                    };
                    names.tasks.push(Task::Frame(relation));
                }
                _ => {}
            }
        }
        names.go_on(graph, scope, report);
        names
    }

    /// Reads on, as far as what is known now allows.
    pub fn go_on(&mut self, graph: &mut Graph, scope: &mut Scope, report: &mut Report) {
        loop {
            let (mut waiting, mut progress) = (Vec::new(), false);
            for task in std::mem::take(&mut self.tasks) {
                if self.waits(&task, &waiting, scope) {
                    waiting.push(task);
                } else {
                    self.define(task, graph, scope, report);
                    progress = true;
                }
            }
            self.tasks = waiting;
            if progress {
                continue;
            }
            let later = self.later(scope);
            let stuck: Vec<bool> = self
                .tasks
                .iter()
                .map(|task| later.is_disjoint(&self.mentions(task)))
                .collect();
            if !stuck.contains(&true) {
                return;
            }
            self.give_up(&stuck, graph, scope, report);
        }
    }

    /// Names that a statement mentions, itself and by the functions that it calls.
    fn mentions(&self, task: &Task<'a>) -> BTreeSet<&'a str> {
        let mut all = BTreeSet::new();
        let mut open: Vec<&'a str> = task.mentions().into_iter().collect();
        while let Some(name) = open.pop() {
            if all.insert(name) {
                open.extend(self.functions.get(name).into_iter().flatten());
            }
        }
        all
    }

    /// Whether a statement needs what is not known yet.
    fn waits(&self, task: &Task<'a>, before: &[Task<'a>], scope: &Scope) -> bool {
        if let Task::Frame(relation) = task
            && !self.is_known(Some(relation.name), scope)
            && !self.is_known(relation.on, scope)
        {
            return true;
        }
        let earlier = |name: &str| {
            before
                .iter()
                .any(|task| matches!(task, Task::Let(other) if other.name.name == name))
        };
        self.mentions(task).into_iter().any(|name| {
            let rates = scope.motion.is_some() || scope.unmoved;
            (name == RATES && !rates)
                || scope.get(name).is_none() && (self.nodes.contains(name) || earlier(name))
        })
    }

    fn is_known(&self, end: Option<&crate::syntax::ast::Ident>, scope: &Scope) -> bool {
        end.is_none_or(|end| end.name == "world" || scope.get(&end.name).is_some())
    }

    /// The rates while they are not known, and the names of expressions and frames that need them.
    fn later(&self, scope: &Scope) -> BTreeSet<&'a str> {
        let mut later = BTreeSet::new();
        if scope.motion.is_some() || scope.unmoved {
            return later;
        }
        later.insert(RATES);
        loop {
            let before = later.len();
            for task in &self.tasks {
                if !self.mentions(task).iter().any(|name| later.contains(name)) {
                    continue;
                }
                match task {
                    Task::Let(declaration) => later.extend([declaration.name.name.as_str()]),
                    Task::Frame(relation) => {
                        let ends = [relation.name.name.as_str(), relation.parent()];
                        let open = |end: &&str| *end != "world" && scope.get(end).is_none();
                        later.extend(ends.into_iter().filter(open));
                    }
                }
            }
            if later.len() == before {
                return later;
            }
        }
    }

    /// Reads one statement that waits for nothing.
    fn define(
        &mut self,
        task: Task<'a>,
        graph: &mut Graph,
        scope: &mut Scope,
        report: &mut Report,
    ) {
        let relation = match task {
            Task::Let(declaration) => {
                if let Some(value) = define_let(declaration, graph, scope, report) {
                    self.lets.push((declaration.name.name.clone(), value));
                }
                return;
            }
            Task::Frame(relation) => relation,
        };
        let kind = scope.get(&relation.name.name).map(|entry| entry.kind);
        if kind.is_some_and(|kind| kind != NameKind::Frame) {
            scope.define(relation.name, NameKind::Frame, None, report);
            return;
        }
        let known = kind.is_some();
        let open = relation.on.filter(|on| !self.is_known(Some(on), scope));
        let (name, on, relative) = match open {
            Some(on) if known => {
                let pose = relative_pose(&relation, graph, scope, report);
                let back = pose.map(|pose| frames::inverse(graph, &pose));
                (on, Some(relation.name), back)
            }
            _ if known && self.closes(&relation, scope, report) => return,
            _ => {
                let pose = relative_pose(&relation, graph, scope, report);
                (relation.name, relation.on, pose)
            }
        };
        let parent = on.map(|on| parent_pose(on, graph, scope, report));
        let value = match parent {
            Some(parent) => parent
                .zip(relative.clone())
                .map(|(parent, pose)| frames::ahead(graph, &parent, &pose)),
            None => relative.clone(),
        };
        let free = scope.define(name, NameKind::Frame, value.clone(), report);
        self.placed.push(relation);
        let poses = value.zip(relative);
        if let (Some((Value::Pose(rotation, position), Value::Pose(turn, shift))), true) =
            (poses, free)
        {
            let parent = on.and_then(|on| self.frames.iter().position(|f| f.name == on.name));
            self.frames.push(Frame {
                name: name.name.clone(),
                parent,
                relative: (turn, shift),
                rotation,
                position,
            });
        }
    }

    /// Reports a statement between two frames that are placed already; whether it is one, and no
    /// second definition of the same.
    fn closes(&self, relation: &Relation, scope: &Scope, report: &mut Report) -> bool {
        let entry = |name: &str| scope.get(name).is_some_and(|e| e.kind == NameKind::Frame);
        if relation
            .on
            .is_some_and(|on| on.name != "world" && !entry(&on.name))
        {
            return false;
        }
        let path = self.path(relation.name.name.as_str(), relation.parent());
        let twice = |first: &Relation| path.len() == 2 && first.name.name == relation.name.name;
        let Some((first, _)) = path.first().filter(|(first, _)| !twice(first)) else {
            return false;
        };
        let names: Vec<String> = path.iter().map(|(_, name)| format!("`{name}`")).collect();
        let message = format!(
            "the frames {} form a cycle: the pose of `{}` is given twice",
            names.join(", "),
            relation.name.name
        );
        report.push(
            Diagnostic::new(relation.span, message)
                .help("remove one of these statements; what closes a mechanism is a `loop` between coordinates")
                .note(first.span, "it follows from here already"),
        );
        true
    }

    /// The statements that lead from a frame to another, each with the frame that it leads away
    /// from; the last name is the goal. Both are placed.
    fn path(&self, from: &'a str, to: &'a str) -> Vec<(Relation<'a>, &'a str)> {
        // The tree is searched from the goal, so that the steps back to it come out in order.
        let mut reached: Vec<(&str, Option<(Relation<'a>, &str)>)> = vec![(to, None)];
        let mut next = 0;
        while let Some(&(node, _)) = reached.get(next) {
            next += 1;
            for relation in &self.placed {
                let (a, b) = (relation.name.name.as_str(), relation.parent());
                for (here, there) in [(a, b), (b, a)] {
                    if here == node && reached.iter().all(|(known, _)| *known != there) {
                        reached.push((there, Some((*relation, here))));
                    }
                }
            }
        }
        let mut path = Vec::new();
        let mut node = from;
        while let Some((_, Some((relation, toward)))) =
            reached.iter().find(|(known, _)| *known == node)
        {
            path.push((*relation, node));
            node = toward;
        }
        if let Some(&(last, _)) = path.last() {
            path.push((last, to));
        }
        path
    }

    /// Nothing can be read any more: reads the first statement that is not about unplaced frames
    /// for its errors, or else reports the frames that nothing places.
    fn give_up(
        &mut self,
        stuck: &[bool],
        graph: &mut Graph,
        scope: &mut Scope,
        report: &mut Report,
    ) {
        let unplaced = |names: &Self, task: &Task, scope: &Scope| match task {
            Task::Frame(relation) => {
                !names.is_known(Some(relation.name), scope) && !names.is_known(relation.on, scope)
            }
            Task::Let(_) => false,
        };
        // A name that no statement defines is the error, before what it leaves unplaced.
        for task in self.tasks.clone() {
            if let Task::Frame(relation) = task
                && unplaced(self, &task, scope)
                && let Some(on) = relation.on
                && !self.named.contains(on.name.as_str())
            {
                self.tasks.retain(|other| !same(other, &relation));
                let is_frame = |kind| kind == NameKind::Frame;
                report.push(scope.unknown(on.span, &on.name, Some("frame"), is_frame));
                scope.define(relation.name, NameKind::Frame, None, report);
                return;
            }
        }
        let first = self.tasks.iter().zip(stuck).position(|(task, &stuck)| {
            let placed = matches!(task, Task::Frame(_)) && !unplaced(self, task, scope);
            placed && stuck
        });
        if let Some(first) = first {
            let task = self.tasks.remove(first);
            return self.define(task, graph, scope, report);
        }
        let relations: Vec<Relation> = self
            .tasks
            .iter()
            .filter_map(|task| match task {
                Task::Frame(relation) => Some(*relation),
                Task::Let(_) => None,
            })
            .collect();
        let Some(first) = relations.first() else {
            if let Some(first) = stuck.iter().position(|&stuck| stuck) {
                let task = self.tasks.remove(first);
                self.define(task, graph, scope, report);
            }
            return;
        };
        let island = island(first, &relations);
        let list: Vec<String> = island.iter().map(|name| format!("`{name}`")).collect();
        let message = match list.as_slice() {
            [one] => format!("frame {one} is not connected to the world"),
            list => format!(
                "the frames {} are not connected to the world",
                list.join(", ")
            ),
        };
        report.push(Diagnostic::new(first.name.span, message).help(format!(
            "place one of them: `frame {} = pose(R, p);`, or relative to a frame that is connected",
            first.parent()
        )));
        for relation in &relations {
            for end in [Some(relation.name), relation.on].into_iter().flatten() {
                if island.contains(&end.name.as_str()) && scope.get(&end.name).is_none() {
                    scope.define(end, NameKind::Frame, None, report);
                }
            }
        }
        let inside = |task: &Task| matches!(task, Task::Frame(relation) if island.contains(&relation.name.name.as_str()));
        self.tasks.retain(|task| !inside(task));
    }
}

fn same(task: &Task, relation: &Relation) -> bool {
    matches!(task, Task::Frame(other) if std::ptr::eq(other.name, relation.name))
}

/// The frames that hang together with those of a relation, in the order of the text.
fn island<'a>(first: &Relation<'a>, relations: &[Relation<'a>]) -> Vec<&'a str> {
    let mut island = vec![first.name.name.as_str(), first.parent()];
    loop {
        let before = island.len();
        for relation in relations {
            let ends = [relation.name.name.as_str(), relation.parent()];
            if ends.iter().any(|end| island.contains(end)) {
                for end in ends {
                    if !island.contains(&end) {
                        island.push(end);
                    }
                }
            }
        }
        if island.len() == before {
            island.dedup();
            return island;
        }
    }
}
