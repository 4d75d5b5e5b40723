//! Expressions of Rust, as far as solids need them.

/// An expression.
#[derive(Clone, Debug)]
pub(super) enum Code {
    /// A name, a number, a text.
    Word(String),
    /// `path(arguments)`
    Call(String, Vec<Code>),
    /// `root.link(arguments).link(arguments)`
    Chain(Box<Code>, Vec<Link>),
    /// `[a, b]`, after a macro's name or none.
    List(&'static str, Vec<Code>),
    /// `(a, b)`
    Tuple(Vec<Code>),
    /// `Path { field: value }`
    Record(&'static str, Vec<(&'static str, Code)>),
    /// `&a`
    Reference(Box<Code>),
    /// `a?`
    Try(Box<Code>),
    /// `a - b`
    Binary(Box<Code>, char, Box<Code>),
}

/// A call of a method.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) name: &'static str,
    pub(super) arguments: Vec<Code>,
}

impl Code {
    pub(super) fn word(text: impl Into<String>) -> Code {
        Code::Word(text.into())
    }

    pub(super) fn call(path: impl Into<String>, arguments: Vec<Code>) -> Code {
        Code::Call(path.into(), arguments)
    }

    pub(super) fn list(items: Vec<Code>) -> Code {
        Code::List("", items)
    }

    /// This with a method called.
    pub(super) fn then(self, name: &'static str, arguments: Vec<Code>) -> Code {
        let link = Link { name, arguments };
        match self {
            Code::Chain(root, mut links) => {
                links.push(link);
                Code::Chain(root, links)
            }
            root => Code::Chain(Box::new(root), vec![link]),
        }
    }

    /// All of it on one line.
    pub(super) fn line(&self) -> String {
        match self {
            Code::Word(text) => text.clone(),
            Code::Call(path, arguments) => format!("{path}({})", joined(arguments)),
            Code::Chain(root, links) => {
                let root = root.root_line();
                links.iter().fold(root, |line, link| line + &link.line())
            }
            Code::List(prefix, items) => format!("{prefix}[{}]", joined(items)),
            Code::Tuple(items) => format!("({})", joined(items)),
            Code::Record(path, fields) => {
                let fields: Vec<String> = fields.iter().map(field).collect();
                format!("{path} {{ {} }}", fields.join(", "))
            }
            Code::Reference(code) => format!("&{}", code.line()),
            Code::Try(code) => format!("{}?", code.line()),
            Code::Binary(a, operator, b) => format!("{} {operator} {}", a.line(), b.line()),
        }
    }

    /// As what methods are called of.
    pub(super) fn root_line(&self) -> String {
        match self {
            Code::Binary(..) => format!("({})", self.line()),
            _ => self.line(),
        }
    }

    /// How wide it is on one line.
    pub(super) fn width(&self) -> usize {
        self.line().chars().count()
    }

    /// Every path, method and name in it.
    pub(super) fn visit(&self, see: &mut impl FnMut(&str)) {
        match self {
            Code::Word(text) => see(text),
            Code::Call(path, arguments) => {
                see(path);
                arguments.iter().for_each(|argument| argument.visit(see));
            }
            Code::Chain(root, links) => {
                root.visit(see);
                links.iter().flat_map(|link| &link.arguments).for_each(|argument| argument.visit(see));
            }
            Code::List(_, items) | Code::Tuple(items) => items.iter().for_each(|item| item.visit(see)),
            Code::Record(path, fields) => {
                see(path);
                fields.iter().for_each(|(_, value)| value.visit(see));
            }
            Code::Reference(code) | Code::Try(code) => code.visit(see),
            Code::Binary(a, _, b) => {
                a.visit(see);
                b.visit(see);
            }
        }
    }
}

impl Link {
    pub(super) fn line(&self) -> String {
        format!(".{}({})", self.name, joined(&self.arguments))
    }
}

/// A field of a record: its name alone where that is its value.
pub(super) fn field((name, value): &(&'static str, Code)) -> String {
    let value = value.line();
    if value == *name { value } else { format!("{name}: {value}") }
}

pub(super) fn joined(items: &[Code]) -> String {
    items.iter().map(Code::line).collect::<Vec<_>>().join(", ")
}

/// A number that is read back to the bit.
pub(super) fn number(value: f64) -> Code {
    Code::word(match value {
        _ if value.is_nan() => "f64::NAN".to_string(),
        f64::INFINITY => "f64::INFINITY".to_string(),
        f64::NEG_INFINITY => "f64::NEG_INFINITY".to_string(),
        _ => format!("{value:?}"),
    })
}
