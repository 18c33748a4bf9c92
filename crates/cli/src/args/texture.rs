//! How pictures lay their texture over a map.

/// A similarity of the texture, and the size of its checks.
#[derive(Debug, Clone, Copy, clap::Args)]
#[command(next_help_heading = "Texture of the pictures")]
pub(crate) struct TextureArgs {
    /// Turn the texture by so many degrees; seams fit all the same
    #[arg(
        long = "texture-angle",
        value_name = "DEGREES",
        requires = "pictures",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_parser = finite
    )]
    angle: f64,

    /// Shift the texture by U,V, in units of the map
    #[arg(
        long = "texture-shift",
        value_name = "U,V",
        requires = "pictures",
        default_value = "0,0",
        allow_negative_numbers = true,
        value_parser = pair
    )]
    shift: [f64; 2],

    /// Side of a check of the texture, in units of the map [default: suits the size of the surface]
    #[arg(long = "texture-period", value_name = "X", requires = "pictures", value_parser = positive)]
    pub(crate) period: Option<f64>,
}

impl TextureArgs {
    /// With checks of this size unless another was given.
    pub(crate) fn or_period(self, period: f64) -> Self {
        Self { period: self.period.or(Some(period)), ..self }
    }

    /// Where the texture has a point of the map.
    pub(crate) fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = match self.angle {
            0.0 => (0.0, 1.0),
            degrees => degrees.to_radians().sin_cos(),
        };
        [cos * u - sin * v + self.shift[0], sin * u + cos * v + self.shift[1]]
    }
}

fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| "expected a number".into())
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    match finite(text) {
        Ok(x) if x > 0.0 => Ok(x),
        _ => Err("expected a number larger than 0".into()),
    }
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    match text.split_once(',').map(|(u, v)| (finite(u), finite(v))) {
        Some((Ok(u), Ok(v))) => Ok([u, v]),
        _ => Err("expected two numbers, as in 0.5,0".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_and_a_shift() {
        let texture = TextureArgs { angle: 90.0, shift: [1.0, -2.0], period: None };
        let [u, v] = texture.apply([3.0, 5.0]);
        assert!((u + 4.0).abs() < 1e-12 && (v - 1.0).abs() < 1e-12);
        let none = TextureArgs { angle: 0.0, shift: [0.0; 2], period: None };
        assert_eq!(none.apply([0.1, 0.7]), [0.1, 0.7]);
    }

    #[test]
    fn numbers_and_pairs() {
        assert_eq!(pair("0.5,-2"), Ok([0.5, -2.0]));
        assert!(pair("1").is_err() && pair("a,b").is_err() && pair("1,inf").is_err());
        assert!(positive("0").is_err() && finite("nan").is_err());
    }
}
