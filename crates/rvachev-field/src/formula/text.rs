//! The `.vm` format: an operation a line, `name operation operands…`; the last is the root.
//!
//! ```text
//!     # a circle
//!     x   var-x
//!     y   var-y
//!     x2  square x
//!     y2  square y
//!     r2  add x2 y2
//!     one const 1
//!     out sub r2 one
//! ```
//!
//! Empty lines and lines that begin with `#` are comments. Names are any words; a name that is
//! given again means the later line from there on.

use std::collections::HashMap;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::code::{Builder, Code};

/// What is wrong with the text of a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FormulaError {
    /// A line that is not understood.
    #[error("line {line}, `{text}`: expected {expected}, found {found}")]
    Line {
        /// The number of the line, from 1.
        line: usize,
        /// The line, its end left out if it is long.
        text: String,
        /// What ought to be there.
        expected: String,
        /// What is.
        found: String,
    },
    /// A text without operations.
    #[error("no operation in {lines} lines, expected at least one line `name operation operands…`")]
    Empty {
        /// How many lines it has.
        lines: usize,
    },
}

/// What a line does.
enum Operation {
    Axis(u8),
    Const,
    Unary(UnaryOpcode),
    Binary(BinaryOpcode),
}

fn operation(word: &str) -> Option<Operation> {
    use BinaryOpcode as B;
    use Operation::{Axis, Binary, Const, Unary};
    use UnaryOpcode as U;
    Some(match word {
        "var-x" => Axis(0),
        "var-y" => Axis(1),
        "var-z" => Axis(2),
        "const" => Const,
        "abs" => Unary(U::Abs),
        "acos" => Unary(U::Acos),
        "asin" => Unary(U::Asin),
        "atan" => Unary(U::Atan),
        "ceil" => Unary(U::Ceil),
        "cos" => Unary(U::Cos),
        "exp" => Unary(U::Exp),
        "floor" => Unary(U::Floor),
        "ln" => Unary(U::Ln),
        "neg" => Unary(U::Neg),
        "not" => Unary(U::Not),
        "rand" => Unary(U::Rand),
        "recip" => Unary(U::Recip),
        "round" => Unary(U::Round),
        "sin" => Unary(U::Sin),
        "sqrt" => Unary(U::Sqrt),
        "square" => Unary(U::Square),
        "tan" => Unary(U::Tan),
        "add" => Binary(B::Add),
        "and" => Binary(B::And),
        "atan2" => Binary(B::Atan),
        "compare" => Binary(B::Compare),
        "div" => Binary(B::Div),
        "max" => Binary(B::Max),
        "min" => Binary(B::Min),
        "mix" => Binary(B::Mix),
        "mod" => Binary(B::Mod),
        "mul" => Binary(B::Mul),
        "or" => Binary(B::Or),
        "sub" => Binary(B::Sub),
        _ => return None,
    })
}

/// Constants beyond this are none in single precision.
const LARGEST_CONSTANT: f64 = f32::MAX as f64;

pub(super) fn parse(text: &str) -> Result<Code, FormulaError> {
    let mut builder = Builder::default();
    let mut named: HashMap<&str, u32> = HashMap::new();
    let mut root = None;
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.first().is_none_or(|word| word.starts_with('#')) {
            continue;
        }
        let at = parse_line(&words, &named, &mut builder).map_err(|(expected, found)| FormulaError::Line {
            line: number + 1,
            text: shortened(line.trim()),
            expected,
            found,
        })?;
        named.insert(words[0], at);
        root = Some(at);
    }
    match root {
        Some(root) => Ok(builder.finish(root)),
        None => Err(FormulaError::Empty { lines: text.lines().count() }),
    }
}

fn shortened(line: &str) -> String {
    const SHOWN: usize = 60;
    match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.to_string(),
    }
}

/// What is expected, and what was found in its place.
type Mistake = (String, String);

fn parse_line(words: &[&str], named: &HashMap<&str, u32>, builder: &mut Builder) -> Result<u32, Mistake> {
    let [name, rest @ ..] = words else {
        return Err(("a name".into(), "nothing".into()));
    };
    let [word, operands @ ..] = rest else {
        return Err((format!("an operation after the name {name}"), "the end of the line".into()));
    };
    let Some(operation) = operation(word) else {
        return Err(("an operation such as var-x, const, add, min or sqrt".into(), quoted(word)));
    };
    let wanted = match operation {
        Operation::Axis(_) => 0,
        Operation::Const | Operation::Unary(_) => 1,
        Operation::Binary(_) => 2,
    };
    if operands.len() != wanted {
        let plural = if wanted == 1 { "" } else { "s" };
        return Err((format!("{wanted} operand{plural} after {word}"), operands.len().to_string()));
    }
    let known = |i: usize| {
        let name = operands[i];
        let unknown = || ("the name of an earlier line".to_string(), quoted(name));
        named.get(name).copied().ok_or_else(unknown)
    };
    Ok(match operation {
        Operation::Axis(axis) => builder.axis(axis),
        Operation::Const => {
            let constant = operands[0].parse().ok().filter(|c: &f64| c.abs() <= LARGEST_CONSTANT);
            let expected = || "a number of at most 3.4e38 in absolute value".to_string();
            builder.constant(constant.ok_or_else(|| (expected(), quoted(operands[0])))?)
        }
        Operation::Unary(op) => builder.unary(op, known(0)?),
        Operation::Binary(op) => builder.binary(op, known(0)?, known(1)?),
    })
}

fn quoted(word: &str) -> String {
    format!("`{}`", shortened(word))
}
