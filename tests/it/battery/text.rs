//! Parts as text and back: entries of the catalogue around each other, operands before values.

use glam::{DAffine3, DVec2, DVec3};
use rvachev::{
    Bounds, catalogue,
    catalogue::{Call, Kind, Part, Value},
    rad,
};

/// The program of a part, such as `translate(sphere(1.0), [0.0, 0.0, 2.0])`.
pub fn written(part: &Part) -> String {
    let Some(call) = Call::of(part) else { return format!("{part:?}") };
    let parts: Vec<String> = call.operands.iter().map(written).chain(call.values.iter().map(value)).collect();
    format!("{}({})", call.entry.name(), parts.join(", "))
}

fn value(value: &Value) -> String {
    let pairs = |points: &[DVec2]| points.iter().map(DVec2::to_array).collect::<Vec<_>>();
    match value {
        Value::Number(v) => format!("{v:?}"),
        Value::Angle(angle) => format!("{:?}", angle.radians()),
        Value::Count(n) => n.to_string(),
        Value::Switch(on) => on.to_string(),
        Value::Choice(word) => (*word).to_owned(),
        Value::Vector(v) => format!("{:?}", v.to_array()),
        Value::PlaneVector(v) => format!("{:?}", v.to_array()),
        Value::Counts(counts) => format!("{counts:?}"),
        Value::Contours(contours) => format!("{:?}", contours.iter().map(|c| pairs(c)).collect::<Vec<_>>()),
        Value::Points(points) => format!("{:?}", pairs(points)),
        Value::Text(text) => format!("{text:?}"),
        Value::Bounds(b) => format!("{:?}", [b.min.to_array(), b.max.to_array()]),
        Value::Map(map) => format!("{:?}", map.to_cols_array()),
        Value::Color(color) => format!("{color:?}"),
        other => written(&Part::Value(other.clone())),
    }
}

/// What a text is made of.
#[derive(Debug)]
enum Term {
    Word(String),
    Quoted(String),
    List(Vec<Term>),
    Call(String, Vec<Term>),
}

struct Reader<'a>(&'a str);

impl Reader<'_> {
    fn skip(&mut self, mark: &str) -> bool {
        self.0 = self.0.trim_start();
        let rest = self.0.strip_prefix(mark);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn terms(&mut self, end: &str) -> Vec<Term> {
        let mut terms = Vec::new();
        while !self.skip(end) {
            terms.push(self.term());
            self.skip(",");
        }
        terms
    }

    fn term(&mut self) -> Term {
        if self.skip("[") {
            return Term::List(self.terms("]"));
        }
        if self.skip("\"") {
            let (text, rest) = self.0.split_once('"').expect("a closing quote");
            self.0 = rest;
            return Term::Quoted(text.replace("\\n", "\n"));
        }
        let end = self.0.find([',', '(', ')', ']']).unwrap_or(self.0.len());
        let (word, rest) = self.0.split_at(end);
        assert!(!word.is_empty(), "a word is missing before {rest:?}");
        self.0 = rest;
        if self.skip("(") { Term::Call(word.to_owned(), self.terms(")")) } else { Term::Word(word.trim().to_owned()) }
    }
}

/// The part that a text is the program of.
pub fn read(text: &str) -> Part {
    part(&Reader(text).term())
}

fn part(term: &Term) -> Part {
    let Term::Call(name, terms) = term else { panic!("{term:?} is no call") };
    let entry = catalogue().iter().find(|entry| entry.name() == name).unwrap_or_else(|| panic!("no entry {name}"));
    let (operands, values) = terms.split_at(terms.len() - entry.parameters().len());
    let operands: Vec<Part> = operands.iter().map(part).collect();
    let values = entry.parameters().iter().zip(values).map(|(parameter, term)| value_of(parameter.kind(), term));
    entry.make(&operands, &values.collect::<Vec<_>>()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn value_of(kind: Kind, term: &Term) -> Value {
    match (kind, term) {
        (Kind::Number, _) => Value::Number(number(term)),
        (Kind::Angle, _) => Value::Angle(rad(number(term))),
        (Kind::Count, _) => Value::Count(number(term) as u32),
        (Kind::Switch, Term::Word(word)) => Value::Switch(word == "true"),
        (Kind::Vector | Kind::Direction, _) => Value::Vector(DVec3::from_slice(&numbers(term))),
        (Kind::PlaneVector, _) => Value::PlaneVector(DVec2::from_slice(&numbers(term))),
        (Kind::Counts, _) => Value::Counts([0, 1, 2].map(|i| numbers(term)[i] as u32)),
        (Kind::Color, _) => Value::Color([0, 1, 2].map(|i| numbers(term)[i] as u8)),
        (Kind::Map, _) => Value::Map(DAffine3::from_cols_slice(&numbers(term))),
        (Kind::Points, _) => Value::Points(points(term)),
        (Kind::Contours, Term::List(lists)) => Value::Contours(lists.iter().map(points).collect()),
        (Kind::Bounds, Term::List(corners)) => {
            let [min, max] = [0, 1].map(|i| DVec3::from_slice(&numbers(&corners[i])));
            Value::Bounds(Bounds::new(min, max))
        }
        (_, Term::Word(text) | Term::Quoted(text)) => Value::Text(text.clone()),
        (_, term) => part(term).into_value().expect("a value"),
    }
}

fn number(term: &Term) -> f64 {
    let Term::Word(word) = term else { panic!("{term:?} is no number") };
    word.parse().unwrap_or_else(|_| panic!("{word} is no number"))
}

fn numbers(term: &Term) -> Vec<f64> {
    let Term::List(terms) = term else { panic!("{term:?} is no list") };
    terms.iter().map(number).collect()
}

fn points(term: &Term) -> Vec<DVec2> {
    let Term::List(terms) = term else { panic!("{term:?} is no list") };
    terms.iter().map(|pair| DVec2::from_slice(&numbers(pair))).collect()
}

#[test]
fn programs_are_read_as_they_are_written() {
    for entry in catalogue() {
        let part = entry.example();
        let text = written(&part);
        assert_eq!(read(&text), part, "{text}");
    }
}
