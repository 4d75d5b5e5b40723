//! Numbers in text files.

use std::fmt;

/// A number as text: the shortest that is read back as the same f32, with an exponent where
/// the digits would otherwise drown in zeros.
pub(super) struct Number(pub f32);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Number(x) = *self;
        if x == 0.0 || (1e-5..1e10).contains(&x.abs()) { write!(f, "{x}") } else { write!(f, "{x:e}") }
    }
}

/// Three numbers with a blank between them.
pub(super) struct Numbers(pub [f32; 3]);

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.map(Number);
        write!(f, "{x} {y} {z}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_were() {
        for x in [0.0, 1.0, -2.5, 0.1, 1.0 / 3.0, 1e-5, 1e-30, -3.4e38, f32::MIN_POSITIVE, 16777217.0, 123456.79_f32] {
            let text = Number(x).to_string();
            assert_eq!(text.parse::<f32>().unwrap(), x, "{text}");
            assert!(text.len() <= 16, "{text}");
        }
        assert_eq!(Numbers([1.0, -0.5, 1e-7]).to_string(), "1 -0.5 1e-7");
    }
}
