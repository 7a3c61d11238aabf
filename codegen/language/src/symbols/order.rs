//! Order in which named expressions and frames become known.
//!
//! Named expressions are processed in the order of the text. Frames form a graph, whose nodes are the frames and the
//! world, and whose edges are the `frame` statements. `frame f on g = P` relates two frames, and either of them may be
//! the known one: f = g P, or g = f P⁻¹. The graph has to be a tree connected to the world; the order of its statements
//! does not matter. Statements that need velocities of frames wait until the rates of the coordinates are known.

use super::check::Checker;
use super::table::Kind;
use super::words::needs_rates;
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Declaration, Expr, ExprKind, Ident, ItemKind, Span, System};
use std::collections::{BTreeMap, BTreeSet};

/// Definition of one named expression or frame.
#[derive(Clone, Copy, Debug)]
pub enum Step<'a> {
    /// A named expression.
    Let(&'a Declaration),
    /// The pose of one frame in another. If the flag is set, the second frame follows from the first.
    Frame(Relation<'a>, bool),
}

/// `frame f on g = P`: the pose of f in g is P.
#[derive(Clone, Copy, Debug)]
pub struct Relation<'a> {
    /// The frame f.
    pub name: &'a Ident,
    /// The frame g, or the world if absent.
    pub on: Option<&'a Ident>,
    /// The pose P.
    pub pose: &'a Expr,
    /// Span of the statement.
    pub span: Span,
}

impl<'a> Relation<'a> {
    /// Returns the name of g.
    pub fn parent(&self) -> &'a str {
        self.on.map_or("world", |on| on.name.as_str())
    }

    fn ends(&self) -> impl Iterator<Item = &'a Ident> {
        [Some(self.name), self.on].into_iter().flatten()
    }
}

/// Named expressions and frames, in the order in which they become known.
#[derive(Clone, Debug, Default)]
pub struct Order<'a> {
    /// Steps that do not need the rates of the coordinates.
    pub before: Vec<Step<'a>>,
    /// Steps that need them.
    pub after: Vec<Step<'a>>,
}

/// Finds the order in which named expressions and frames become known.
#[derive(Default)]
pub struct Planner<'a> {
    /// Steps found so far, in order.
    pub steps: Vec<Step<'a>>,
    /// Steps that have not been processed.
    tasks: Vec<Step<'a>>,
    /// Whether the rates of the coordinates are known.
    rates: bool,
    /// Relations that placed a frame: the edges of the tree.
    placed: Vec<Relation<'a>>,
    /// Names that a `frame` statement mentions on its left side or after `on`.
    nodes: BTreeSet<&'a str>,
    /// Names on the left side of a `frame` statement.
    named: BTreeSet<&'a str>,
    /// Names that the bodies of functions mention, other than their parameters.
    functions: BTreeMap<&'a str, BTreeSet<&'a str>>,
}

/// Pseudo-name that represents the rates of the coordinates among the names in an expression.
const RATES: &str = "d/dt";

impl<'a> Step<'a> {
    /// Returns the names in the expression of the step, and [`RATES`] if it needs the rates of the coordinates.
    fn mentions(&self) -> BTreeSet<&'a str> {
        let mut names = BTreeSet::new();
        match self {
            Step::Let(declaration) => {
                if let Some(value) = &declaration.value {
                    mentioned(value, &mut names);
                }
            }
            Step::Frame(relation, _) => mentioned(relation.pose, &mut names),
        }
        names
    }
}

fn mentioned<'a>(expr: &'a Expr, names: &mut BTreeSet<&'a str>) {
    match &expr.kind {
        ExprKind::Name(name) => _ = names.insert(name),
        ExprKind::Call(function, _) => {
            // If this is a function of the description, the names that it mentions are added later.
            names.insert(&function.name);
            if needs_rates(&function.name) {
                names.insert(RATES);
            }
        }
        _ => {}
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| mentioned(part, names));
}

impl<'a> Planner<'a> {
    /// Creates a planner with all steps of a description.
    pub fn new(system: &'a System) -> Self {
        let mut planner = Planner::default();
        for item in &system.items {
            match &item.kind {
                ItemKind::Let(list) => planner.tasks.extend(list.iter().map(Step::Let)),
                ItemKind::Function(function) => {
                    let mut mentions = BTreeSet::new();
                    mentioned(&function.value, &mut mentions);
                    for (parameter, _) in &function.parameters {
                        mentions.remove(parameter.name.as_str());
                    }
                    planner.functions.insert(&function.name.name, mentions);
                }
                ItemKind::Frame { name, on, pose } => {
                    let relation = Relation {
                        name,
                        on: on.as_ref(),
                        pose,
                        span: item.span,
                    };
                    planner.named.insert(&name.name);
                    let frames = relation.ends().map(|end| end.name.as_str());
                    let frames = frames.filter(|name| *name != "world");
                    planner.nodes.extend(frames);
                    planner.tasks.push(Step::Frame(relation, false));
                }
                _ => {}
            }
        }
        planner
    }

    /// Marks the rates of the coordinates as known.
    pub fn rates_are_known(&mut self) {
        self.rates = true;
    }

    /// Appends to the order all steps whose names are known now. The remaining ones need the rates of the coordinates.
    pub fn go_on(&mut self, checker: &mut Checker<'a>) {
        loop {
            let (mut waiting, mut progress) = (Vec::new(), false);
            for task in std::mem::take(&mut self.tasks) {
                if self.waits(&task, &waiting, checker) {
                    waiting.push(task);
                } else {
                    self.define(task, checker);
                    progress = true;
                }
            }
            self.tasks = waiting;
            if progress {
                continue;
            }
            let later = self.later(checker);
            let stuck: Vec<bool> = self
                .tasks
                .iter()
                .map(|task| later.is_disjoint(&self.mentions(task)))
                .collect();
            if !stuck.contains(&true) {
                return;
            }
            self.give_up(&stuck, checker);
        }
    }

    /// Returns the names that a step mentions, directly and through the functions that it calls.
    fn mentions(&self, task: &Step<'a>) -> BTreeSet<&'a str> {
        let mut all = BTreeSet::new();
        let mut open: Vec<&'a str> = task.mentions().into_iter().collect();
        while let Some(name) = open.pop() {
            if all.insert(name) {
                open.extend(self.functions.get(name).into_iter().flatten());
            }
        }
        all
    }

    /// Returns whether a step needs a name that is not known yet. `before` holds the waiting steps that precede it.
    fn waits(&self, task: &Step<'a>, before: &[Step<'a>], checker: &Checker) -> bool {
        if let Step::Frame(relation, _) = task
            && unplaced(relation, checker)
        {
            return true;
        }
        let earlier = |name: &str| {
            before
                .iter()
                .any(|task| matches!(task, Step::Let(other) if other.name.name == name))
        };
        self.mentions(task).into_iter().any(|name| {
            (name == RATES && !self.rates)
                || checker.known(name).is_none() && (self.nodes.contains(name) || earlier(name))
        })
    }

    /// Returns [`RATES`], while the rates are not known, and the names of all expressions and frames that need them.
    fn later(&self, checker: &Checker) -> BTreeSet<&'a str> {
        let mut later = BTreeSet::new();
        if self.rates {
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
                    Step::Let(declaration) => later.extend([declaration.name.name.as_str()]),
                    Step::Frame(relation, _) => {
                        let ends = [relation.name.name.as_str(), relation.parent()];
                        let open = |end: &&str| *end != "world" && checker.known(end).is_none();
                        later.extend(ends.into_iter().filter(open));
                    }
                }
            }
            if later.len() == before {
                return later;
            }
        }
    }

    /// Processes a step that waits for nothing.
    fn define(&mut self, task: Step<'a>, checker: &mut Checker<'a>) {
        let relation = match task {
            Step::Let(declaration) => {
                if let Some(value) = &declaration.value {
                    checker.expr(value);
                }
                checker.open.remove(declaration.name.name.as_str());
                self.steps.push(Step::Let(declaration));
                return;
            }
            Step::Frame(relation, _) => relation,
        };
        let kind = checker.known(&relation.name.name).map(|symbol| symbol.kind);
        if kind.is_some_and(|kind| kind != Kind::Frame) {
            // It is defined twice, which has been reported.
            return;
        }
        let open = relation.on.filter(|on| !is_known(on, checker));
        checker.used.extend(relation.on.map(|on| on.name.clone()));
        if kind.is_some() && open.is_none() && self.closes(&relation, checker) {
            return;
        }
        checker.expr(relation.pose);
        let back = match open {
            Some(on) if kind.is_some() => {
                place(on, checker);
                true
            }
            _ => {
                if let Some(on) = relation.on {
                    checker.frame(on, true);
                }
                place(relation.name, checker);
                false
            }
        };
        self.placed.push(relation);
        self.steps.push(Step::Frame(relation, back));
    }

    /// Reports a statement that relates two frames which are both placed already. Returns whether it is one.
    fn closes(&self, relation: &Relation<'a>, checker: &mut Checker<'a>) -> bool {
        let path = self.path(relation.name.name.as_str(), relation.parent());
        let Some((first, _)) = path.first() else {
            return false;
        };
        if path.len() == 2 && first.name.name == relation.name.name {
            let name = &relation.name.name;
            let error = Diagnostic::new(relation.name.span, format!("`{name}` is defined twice"));
            let error = error.help("rename one of the two");
            checker.error(error.note(first.name.span, "first defined here, as a frame"));
            return true;
        }
        let names: Vec<String> = path.iter().map(|(_, name)| format!("`{name}`")).collect();
        let message = format!(
            "the frames {} form a cycle: the pose of `{}` is given twice",
            names.join(", "),
            relation.name.name
        );
        checker.error(
            Diagnostic::new(relation.span, message)
                .help("remove one of these statements; close a mechanism by a `loop` between coordinates")
                .note(first.span, "it already follows from this"),
        );
        true
    }

    /// Returns the statements that lead from one placed frame to another, each with the frame that it leads away from.
    /// The last name is the goal.
    fn path(&self, from: &'a str, to: &'a str) -> Vec<(Relation<'a>, &'a str)> {
        // The search starts at the goal, so that the steps back to it come out in order.
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

    /// Resolves a deadlock, in which no step can be processed. Processes the first step that does not wait for an
    /// unplaced frame, to report its errors; if there is none, reports the frames that are not connected to the world.
    fn give_up(&mut self, stuck: &[bool], checker: &mut Checker<'a>) {
        // A name that no statement defines is reported before the frames that it leaves unplaced.
        for task in self.tasks.clone() {
            if let Step::Frame(relation, _) = task
                && unplaced(&relation, checker)
                && let Some(on) = relation.on
                && !self.named.contains(on.name.as_str())
            {
                self.tasks.retain(|other| !same(other, &relation));
                checker.frame(on, true);
                place(relation.name, checker);
                return;
            }
        }
        let first = self.tasks.iter().zip(stuck).position(|(task, &stuck)| {
            stuck && matches!(task, Step::Frame(relation, _) if !unplaced(relation, checker))
        });
        if let Some(first) = first {
            let task = self.tasks.remove(first);
            return self.define(task, checker);
        }
        let relations: Vec<Relation> = self
            .tasks
            .iter()
            .filter_map(|task| match task {
                Step::Frame(relation, _) => Some(*relation),
                Step::Let(_) => None,
            })
            .collect();
        let Some(first) = relations.first() else {
            if let Some(first) = stuck.iter().position(|&stuck| stuck) {
                let task = self.tasks.remove(first);
                self.define(task, checker);
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
        checker.error(Diagnostic::new(first.name.span, message).help(format!(
            "place one of them: `frame {} = pose(R, p);`, or relative to a frame that is connected",
            first.parent()
        )));
        let ends = relations.iter().flat_map(Relation::ends);
        for end in ends.filter(|end| island.contains(&end.name.as_str())) {
            place(end, checker);
        }
        let inside = |task: &Step| matches!(task, Step::Frame(relation, _) if island.contains(&relation.name.name.as_str()));
        self.tasks.retain(|task| !inside(task));
    }
}

/// Marks a frame as known.
fn place<'a>(frame: &'a Ident, checker: &mut Checker<'a>) {
    if checker.symbols.get(&frame.name).is_none() && frame.name != "world" {
        checker
            .symbols
            .add(&frame.name, Kind::Frame, frame.span, false);
    }
    checker.open.remove(frame.name.as_str());
}

fn is_known(end: &Ident, checker: &Checker) -> bool {
    end.name == "world" || checker.known(&end.name).is_some()
}

/// Returns whether neither of the two frames of a relation is known.
fn unplaced(relation: &Relation, checker: &Checker) -> bool {
    !is_known(relation.name, checker) && relation.on.is_some_and(|on| !is_known(on, checker))
}

fn same(task: &Step, relation: &Relation) -> bool {
    matches!(task, Step::Frame(other, _) if std::ptr::eq(other.name, relation.name))
}

/// Returns the frames that are connected with those of a relation, in the order of the text.
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
