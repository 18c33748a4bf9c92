//! Letters as strokes, like those of a plotter: enough for the legends of pictures.

/// Strokes and width of a character on a grid whose unit is a twelfth of a capital's height; the base
/// line is at height 4, so that descenders reach 0.
pub(crate) struct Glyph {
    /// Polylines; a single point is a dot.
    pub(crate) strokes: Vec<Vec<[f64; 2]>>,
    /// Width without the space to the next character.
    pub(crate) width: f64,
}

/// Height of a capital on the grid.
pub(crate) const CAPITAL: f64 = 12.0;
/// Height of the base line on the grid.
pub(crate) const BASE: f64 = 4.0;
/// Space between characters.
const SPACING: f64 = 4.0;
/// Width of a blank.
const BLANK: f64 = 4.0;

/// Points are pairs of a digit x (0 to 8) and a base-17 digit y (0 to g); strokes are parted by bars.
const GLYPHS: [(char, &str); 44] = [
    ('0', "24 64 86 8e 6g 2g 0e 06 24"),
    ('1', "0d 4g 44"),
    ('2', "0e 2g 6g 8e 8b 04 84"),
    ('3', "0e 2g 6g 8e 8c 6a 3a|6a 88 86 64 24 06"),
    ('4', "64 6g 07 87"),
    ('5', "7g 1g 0a 2b 6b 89 86 64 24 06"),
    ('6', "7g 4g 0b 06 24 64 86 89 6b 2b 0a"),
    ('7', "0g 8g 34"),
    ('8', "2a 0c 0e 2g 6g 8e 8c 6a 2a 08 06 24 64 86 88 6a"),
    ('9', "14 44 89 8e 6g 2g 0e 0b 29 69 8a"),
    ('.', "04"),
    (',', "14 02"),
    ('-', "0a 6a"),
    ('+', "0a 6a|37 3d"),
    ('=', "08 68|0c 6c"),
    ('>', "0e 7a 06"),
    ('(', "3g 1d 07 14 31"),
    (')', "0g 2d 37 24 01"),
    ('a', "8c 84|8a 6c 2c 0a 06 24 64 86"),
    ('b', "0g 04|0a 2c 6c 8a 86 64 24 06"),
    ('c', "8a 6c 2c 0a 06 24 64 86"),
    ('d', "8g 84|8a 6c 2c 0a 06 24 64 86"),
    ('e', "08 88 8a 6c 2c 0a 06 24 64 75"),
    ('f', "6g 4g 3e 34|0c 6c"),
    ('g', "8c 82 60 20 01|8a 6c 2c 0a 06 24 64 86"),
    ('h', "0g 04|0a 2c 6c 8a 84"),
    ('i', "0c 04|0f"),
    ('j', "3c 32 10 00|3f"),
    ('k', "0g 04|7c 07|39 84"),
    ('l', "0g 06 24"),
    ('m', "0c 04|0a 1c 3c 4a 44|4a 5c 7c 8a 84"),
    ('n', "0c 04|0a 2c 6c 8a 84"),
    ('o', "24 64 86 8a 6c 2c 0a 06 24"),
    ('p', "0c 00|0a 2c 6c 8a 86 64 24 06"),
    ('q', "8c 80|8a 6c 2c 0a 06 24 64 86"),
    ('r', "0c 04|0a 2c 5c"),
    ('s', "7b 6c 2c 0a 28 68 86 64 24 05"),
    ('t', "3g 36 44 64|0c 6c"),
    ('u', "0c 06 24 64 86|8c 84"),
    ('v', "0c 44 8c"),
    ('w', "0c 24 4a 64 8c"),
    ('x', "0c 84|04 8c"),
    ('y', "0c 44|8c 30 10"),
    ('z', "0c 8c 04 84"),
];

/// The strokes of a character; a blank for those it does not have.
pub(crate) fn glyph(character: char) -> Glyph {
    let character = character.to_ascii_lowercase();
    let Some((_, code)) = GLYPHS.iter().find(|(c, _)| *c == character) else {
        return Glyph { strokes: Vec::new(), width: BLANK };
    };
    let point = |pair: &str| {
        let mut digits = pair.chars().filter_map(|c| c.to_digit(17)).map(f64::from);
        [digits.next().unwrap_or(0.0), digits.next().unwrap_or(0.0)]
    };
    let strokes: Vec<Vec<_>> =
        code.split('|').map(|stroke| stroke.split(' ').map(point).collect()).collect();
    let width = strokes.iter().flatten().fold(0.0f64, |w, p| w.max(p[0]));
    Glyph { strokes, width }
}

/// Width of a text on the grid.
pub(crate) fn text_width(text: &str) -> f64 {
    let widths = text.chars().map(|c| glyph(c).width + SPACING);
    (widths.sum::<f64>() - SPACING).max(0.0)
}

/// The segments of a text that starts at the origin, on the grid.
pub(crate) fn text_segments(text: &str) -> Vec<[[f64; 2]; 2]> {
    let mut segments = Vec::new();
    let mut x = 0.0;
    for Glyph { strokes, width } in text.chars().map(glyph) {
        for stroke in strokes {
            let at = |p: [f64; 2]| [p[0] + x, p[1]];
            match stroke[..] {
                [dot] => segments.push([at(dot), at(dot)]),
                _ => segments.extend(stroke.windows(2).map(|w| [at(w[0]), at(w[1])])),
            }
        }
        x += width + SPACING;
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_can_be_read_and_keeps_to_the_grid() {
        for (character, code) in GLYPHS {
            let pairs = code.split([' ', '|']).filter(|pair| !pair.is_empty());
            assert!(pairs.clone().all(|pair| pair.len() == 2), "{character}");
            let points: Vec<_> = glyph(character).strokes.into_iter().flatten().collect();
            assert_eq!(points.len(), pairs.count(), "{character}");
            assert!(points.iter().all(|p| p[0] <= 8.0 && p[1] <= 16.0), "{character}");
        }
    }

    #[test]
    fn texts_are_as_wide_as_their_characters() {
        assert_eq!(text_width("0"), 8.0);
        assert_eq!(text_width("00"), 20.0);
        assert_eq!(text_width(""), 0.0);
        assert_eq!(text_segments("-").len(), 1);
        assert!(text_segments(" ").is_empty());
    }
}
