//! A part as a function: which of its nodes become variables.

use std::collections::HashMap;

use super::RustSettings;
use super::calls::expression;
use super::graph::{COPIES, Item, Key, items};
use super::layout::{binding, is_short, tail};
use super::lengths::Lengths;
use super::names::{Names, identifier};
use super::syntax::{Code, number};
use crate::catalogue::Part;

/// Operands of joins up to this wide stand where they are used.
const SHORT_OPERAND: usize = 36;

/// Lists up to this wide stand where they are used.
const SHORT_LIST: usize = 40;

/// Chains of more methods are parted.
const MOST_LINKS: usize = 6;

/// A function that makes a part.
pub(super) struct Function {
    pub(super) text: String,
    /// What it speaks of: types, and paths that begin with them.
    pub(super) words: Vec<String>,
}

/// What has been written of a function.
pub(super) struct Body {
    pub(super) lengths: Lengths,
    names: Names,
    nodes: HashMap<Key, Node>,
    text: String,
    words: Vec<String>,
    /// Parameters of the function, with what they stand for.
    parameters: Vec<(String, &'static str, String)>,
    pub(super) can_fail: bool,
}

/// A node that has been written.
#[derive(Clone)]
struct Node {
    /// What it is where it is used.
    code: Code,
    /// What a variable of it is called.
    label: String,
    sort: Sort,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Sort {
    Inline,
    /// A variable that is used once.
    Once,
    /// A variable that is used several times.
    Shared,
    /// A parameter, which is a reference.
    Parameter,
}

impl Function {
    pub(super) fn of(name: &str, part: &Part, settings: &RustSettings) -> Function {
        let items = items(part);
        let mut names = Names::default();
        let lengths = if settings.lengths { Lengths::of(&items, &mut names) } else { Lengths::default() };
        let mut body = Body {
            lengths,
            names,
            nodes: HashMap::new(),
            text: String::new(),
            words: Vec::new(),
            parameters: Vec::new(),
            can_fail: false,
        };
        for (name, value) in body.lengths.variables.clone() {
            body.text += &binding(&name, &number(value));
        }
        let kind = if matches!(part, Part::Profile(_)) { "Profile" } else { "Solid" };
        let mut end = Code::word("");
        for (i, item) in items.iter().enumerate() {
            let comment = item.name.as_ref().and_then(|name| settings.comments.get(name));
            let (code, label) = body.code(item);
            if i + 1 == items.len() {
                end = if body.can_fail { body.argument(code, &label) } else { code };
                body.text += &comment.map(|text| commented(text)).unwrap_or_default();
            } else if item.call.is_some() {
                body.keep(item, code, label, comment);
            }
        }
        body.see(&end);
        let end = if body.can_fail { Code::call("Ok", vec![end]) } else { end };
        body.text += &tail(&end);
        body.finished(name, kind)
    }
}

impl Body {
    /// The code of a node, and what it is called without a name.
    fn code(&mut self, item: &Item) -> (Code, String) {
        let Some(call) = &item.call else {
            let (kind, label) = (if item.key.1 { "Profile" } else { "Solid" }, identifier(item.label, "leaf"));
            let name = self.names.take(&label);
            let what = match item.operands.is_empty() && !is_deformation(item.label) {
                true => format!("the leaf `{}`", item.label),
                false => format!("what is deformed by `{}`", item.label),
            };
            self.parameters.push((name.clone(), kind, what));
            let node = Node { code: Code::word(&name), label: label.clone(), sort: Sort::Parameter };
            self.nodes.insert(item.key, node);
            return (Code::word(name).then("clone", Vec::new()), label);
        };
        let of_operand = item.operands.first().and_then(|key| self.nodes.get(key)).map(|node| node.label.clone());
        let label = match (item.label, of_operand) {
            ("" | "part", Some(label)) => label,
            (COPIES, Some(label)) if label.ends_with(COPIES) => label,
            (COPIES, Some(label)) => label + COPIES,
            (label, _) => identifier(label, "part"),
        };
        let code = expression(self, call, item);
        (code, item.name.as_ref().map_or(label.clone(), |name| identifier(name, &label)))
    }

    /// Keeps a node for where it is used: as a variable if it has a name or is used several times.
    fn keep(&mut self, item: &Item, code: Code, label: String, comment: Option<&String>) {
        let is_long = matches!(&code, Code::Chain(_, links) if links.len() >= MOST_LINKS);
        let node = if item.uses > 1 || item.name.is_some() || is_long {
            self.text += &comment.map(|text| commented(text)).unwrap_or_default();
            let name = self.bound(&label, &code);
            let sort = if item.uses > 1 { Sort::Shared } else { Sort::Once };
            Node { code: Code::word(name), label, sort }
        } else {
            Node { code, label, sort: Sort::Inline }
        };
        self.nodes.insert(item.key, node);
    }

    /// A new variable.
    fn bound(&mut self, label: &str, code: &Code) -> String {
        let name = self.names.take(label);
        self.see(code);
        self.text += &binding(&name, code);
        name
    }

    fn see(&mut self, code: &Code) {
        let words = &mut self.words;
        code.visit(&mut |word| words.push(word.to_string()));
    }

    /// What stands as an argument: a variable of this name, if it would not be short.
    pub(super) fn argument(&mut self, code: Code, name: &str) -> Code {
        let is_list = matches!(code, Code::List(..) | Code::Call(..));
        let is_wide = is_list && code.width() > SHORT_LIST || !is_short(&code);
        if is_wide { Code::word(self.bound(name, &code)) } else { code }
    }

    /// A node, which only variables are for a second time.
    fn taken(&mut self, key: Key) -> Node {
        let inline = |node: &Node| node.sort == Sort::Inline;
        let node = if self.nodes.get(&key).is_some_and(inline) {
            self.nodes.remove(&key)
        } else {
            self.nodes.get(&key).cloned()
        };
        // Operands come first.
        node.unwrap_or(Node { code: Code::word(""), label: String::new(), sort: Sort::Once })
    }

    /// A node that a method is called of.
    pub(super) fn receiver(&mut self, key: Key) -> Code {
        let Node { code, label, .. } = self.taken(key);
        let root = if let Code::Chain(root, _) = &code { root } else { &code };
        if is_short(root) { code } else { Code::word(self.bound(&label, &code)) }
    }

    /// A node as a variable.
    pub(super) fn variable(&mut self, key: Key) -> Code {
        let Node { code, label, .. } = self.taken(key);
        if matches!(code, Code::Word(_)) { code } else { Code::word(self.bound(&label, &code)) }
    }

    /// A node as an operand, and whether it is a reference.
    fn operand(&mut self, key: Key) -> (Code, bool) {
        match self.nodes.get(&key) {
            Some(Node { code, sort: Sort::Shared, .. }) => (Code::Reference(Box::new(code.clone())), true),
            Some(Node { code, sort: Sort::Parameter, .. }) => (code.clone(), true),
            _ => (self.first(key), false),
        }
    }

    /// A node that is joined with others by a method.
    pub(super) fn first(&mut self, key: Key) -> Code {
        let Node { code, label, .. } = self.taken(key);
        let is_inline = matches!(code, Code::Word(_)) || is_short(&code) && code.width() <= SHORT_OPERAND;
        if is_inline && !matches!(code, Code::Binary(..)) { code } else { Code::word(self.bound(&label, &code)) }
    }

    /// A node that is joined with another.
    pub(super) fn other(&mut self, key: Key) -> Code {
        self.operand(key).0
    }

    /// Nodes as a list: all by value, or all by reference. `kind` is what they are.
    pub(super) fn list(&mut self, keys: &[Key], kind: &str) -> Code {
        if keys.is_empty() {
            return Code::word(format!("Vec::<{kind}>::new()"));
        }
        let operands: Vec<(Code, bool)> = keys.iter().map(|key| self.operand(*key)).collect();
        let any = operands.iter().any(|(_, is_reference)| *is_reference);
        let item = |(code, is_reference): (Code, bool)| match any && !is_reference {
            true => Code::Reference(Box::new(code)),
            false => code,
        };
        let list = Code::list(operands.into_iter().map(item).collect());
        self.argument(list, "parts")
    }

    fn finished(self, name: &str, kind: &str) -> Function {
        let parameters: Vec<String> =
            self.parameters.iter().map(|(name, kind, _)| format!("{name}: &{kind}")).collect();
        let docs = self
            .parameters
            .iter()
            .map(|(name, kind, what)| format!("/// `{name}`: {what}, which has no code. Give it as a `{kind}`.\n"));
        let mut words = self.words;
        words.push(kind.to_string());
        words.extend(self.parameters.iter().map(|(_, kind, _)| (*kind).to_string()));
        let made = if self.can_fail {
            words.push("FormulaError".to_string());
            format!("Result<{kind}, FormulaError>")
        } else {
            kind.to_string()
        };
        let line = format!("pub fn {name}({}) -> {made} {{\n", parameters.join(", "));
        // As rustfmt parts parameters that are too wide.
        let head = if line.chars().count() <= 101 {
            line
        } else {
            format!("pub fn {name}(\n    {},\n) -> {made} {{\n", parameters.join(",\n    "))
        };
        Function { text: format!("{}{head}{}}}\n", docs.collect::<String>(), self.text), words }
    }
}

fn is_deformation(label: &str) -> bool {
    label == "taper_by" || label == "twist_by"
}

/// Lines of comment.
fn commented(text: &str) -> String {
    let plain = |line: &str| line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect::<String>();
    let line = |line: &str| format!("    {}\n", format!("// {}", plain(line).trim()).trim_end());
    text.lines().map(line).collect()
}
