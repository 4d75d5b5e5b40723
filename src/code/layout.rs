//! Where lines are broken: as rustfmt does, by its own settings, as far as solids need it.
//!
//! Arguments and lists go on one line of up to 60 columns, else each on its own; chains of two
//! methods and more likewise; fields of a record stay on the line up to 18 columns. What is in
//! arguments is always short: `function` gives names to the rest.

use super::syntax::{Code, Link, field, joined};

const MAX_WIDTH: usize = 100;
const SHORT: usize = 60;
const SHORT_RECORD: usize = 18;
const SHORT_ITEM: usize = 10;
const TAB: usize = 4;

/// Whether it is on one line where there is room.
pub(super) fn is_short(code: &Code) -> bool {
    match code {
        Code::Word(text) => !text.contains('\n'),
        Code::Call(_, items) | Code::List(_, items) | Code::Tuple(items) => are_short(items),
        Code::Chain(root, links) => {
            let fits = links.len() < 2 || code.width() <= SHORT;
            fits && is_short(root) && links.iter().all(|link| are_short(&link.arguments))
        }
        Code::Record(_, fields) => {
            let lines: Vec<String> = fields.iter().map(field).collect();
            lines.join(", ").chars().count() <= SHORT_RECORD && fields.iter().all(|(_, value)| is_short(value))
        }
        Code::Reference(code) | Code::Try(code) => is_short(code),
        Code::Binary(a, _, b) => is_short(a) && is_short(b),
    }
}

/// Whether items are on one line where there is room; one alone always is.
fn are_short(items: &[Code]) -> bool {
    (items.len() < 2 || joined(items).chars().count() <= SHORT) && items.iter().all(is_short)
}

/// `let name = code;` within a function.
pub(super) fn binding(name: &str, code: &Code) -> String {
    let start = format!("{}let {name} =", spaces(TAB));
    let column = start.chars().count() + 1;
    let same = shaped(code, TAB, column, 1);
    if !same.contains('\n') && column + same.chars().count() < MAX_WIDTH {
        return format!("{start} {same};\n");
    }
    let next = shaped(code, 2 * TAB, 2 * TAB, 1);
    let fits = |column: usize, text: &str| {
        let widths = text.lines().map(|line| line.chars().count());
        widths.zip([column].into_iter().chain(std::iter::repeat(0))).all(|(width, before)| before + width <= MAX_WIDTH)
    };
    if fits(2 * TAB, &next) && (!fits(column, &same) || is_next_better(&same, &next)) {
        return format!("{start}\n{}{next};\n", spaces(2 * TAB));
    }
    format!("{start} {same};\n")
}

/// What a function gives.
pub(super) fn tail(code: &Code) -> String {
    format!("{}{}\n", spaces(TAB), shaped(code, TAB, TAB, 0))
}

/// Whether what is assigned goes on a line of its own.
fn is_next_better(same: &str, next: &str) -> bool {
    let breaks = |text: &str| text.matches('\n').count();
    let ends = |text: &str, mark: char| text.lines().next().is_some_and(|line| line.ends_with(mark));
    let opens = |mark| ends(same, mark) && !ends(next, mark);
    breaks(next) == 0 || breaks(same) > breaks(next) + 1 || ['(', '{', '['].into_iter().any(opens)
}

/// The lines of an expression that begins at `column`, of a block indented by `indent`; `after` it
/// there are so many characters.
fn shaped(code: &Code, indent: usize, column: usize, after: usize) -> String {
    let line = code.line();
    if is_short(code) && column + line.chars().count() + after <= MAX_WIDTH {
        return line;
    }
    match code {
        Code::Word(_) | Code::Binary(..) => line,
        Code::Call(path, arguments) => format!("{path}{}", block(['(', ')'], arguments, indent)),
        Code::Tuple(items) => block(['(', ')'], items, indent),
        Code::List(prefix, items) => format!("{prefix}{}", block(['[', ']'], items, indent)),
        Code::Record(path, fields) => {
            let inner = spaces(indent + TAB);
            let lines = fields.iter().map(|pair| format!("{inner}{},\n", field(pair)));
            format!("{path} {{\n{}{}}}", lines.collect::<String>(), spaces(indent))
        }
        Code::Reference(code) => format!("&{}", shaped(code, indent, column + 1, after)),
        Code::Try(code) => format!("{}?", shaped(code, indent, column, after + 1)),
        Code::Chain(root, links) => chain(root, links, indent, column, after),
    }
}

fn chain(root: &Code, links: &[Link], indent: usize, column: usize, after: usize) -> String {
    let Some((last, before)) = links.split_last() else { return root.line() };
    let start = before.iter().fold(root.root_line(), |line, link| line + &link.line());
    let room = (MAX_WIDTH - column.min(MAX_WIDTH)).saturating_sub(after);
    let room = if links.len() > 1 { room.min(SHORT) } else { room };
    let opened = start.chars().count() + last.name.chars().count() + 2;
    // The arguments of the last call are broken rather than the chain, if they are broken anyway.
    if !are_short(&last.arguments) && opened <= room {
        return format!("{start}.{}{}", last.name, block(['(', ')'], &last.arguments, indent));
    }
    let inner = indent + TAB;
    let mut text = root.root_line();
    let mut links = links.iter();
    // What is as short as the indentation takes a call beside it, but not behind `let`.
    while column == indent && text.chars().count() <= TAB {
        let Some(link) = links.next() else { return text };
        text += &link.line();
    }
    for (i, link) in links.clone().enumerate() {
        let after = if i + 1 == links.len() { after } else { 0 };
        let line = link.line();
        let fits = inner + line.chars().count() + after <= MAX_WIDTH;
        text += &format!("\n{}", spaces(inner));
        if fits && are_short(&link.arguments) {
            text += &line;
        } else {
            text += &format!(".{}{}", link.name, block(['(', ')'], &link.arguments, inner));
        }
    }
    text
}

/// Each item on its own line; short words as many as there is room for.
fn block([open, close]: [char; 2], items: &[Code], indent: usize) -> String {
    let inner = indent + TAB;
    let is_plain = |item: &Code| match item {
        Code::Word(text) => text.chars().count() <= SHORT_ITEM && !text.contains("::"),
        _ => false,
    };
    let lines = if items.len() > 1 && items.iter().all(is_plain) {
        filled(items, inner)
    } else {
        let line = |item| format!("{}{},\n", spaces(inner), shaped(item, inner, inner, 1));
        items.iter().map(line).collect()
    };
    format!("{open}\n{lines}{}{close}", spaces(indent))
}

/// As many items on a line as there is room for.
pub(super) fn filled(items: &[Code], indent: usize) -> String {
    let mut text = String::new();
    let mut line = spaces(indent);
    for item in items {
        let word = format!("{},", item.line());
        let is_first = line.chars().count() == indent;
        if !is_first && line.chars().count() + 1 + word.chars().count() >= MAX_WIDTH {
            text += &format!("{line}\n");
            line = spaces(indent);
        } else if !is_first {
            line.push(' ');
        }
        line += &word;
    }
    format!("{text}{line}\n")
}

fn spaces(count: usize) -> String {
    " ".repeat(count)
}
