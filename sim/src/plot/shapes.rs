//! Reads back the SVG that plotters writes.
//!
//! It is a flat list of seven elements, an element a line, with attributes in double quotes: nothing is inherited and nothing
//! nested, so no general SVG reader is needed.

use anyhow::{Context, Result, bail};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape<'a> {
    /// What it is: `rect`, `line`, `polyline`, `polygon`, `circle`, `text`, or `svg`, which is the first and has the size.
    pub name: &'a str,
    attributes: Vec<(&'a str, &'a str)>,
    /// The words of a `text`, still with entities.
    words: &'a str,
}

impl<'a> Shape<'a> {
    /// Every element, from back to front. Fails if it is not such an SVG.
    pub fn all(svg: &'a str) -> Result<Vec<Self>> {
        let mut shapes = Vec::new();
        let mut rest = svg;
        while let Some(begin) = rest.find('<') {
            let (tag, after) = rest[begin + 1..].split_once('>').context("an element without end")?;
            rest = after;
            if tag.starts_with('/') {
                continue;
            }
            let words =
                if tag.starts_with("text ") { after.split('<').next().unwrap_or("").trim() } else { "" };
            shapes.push(Self::of_tag(tag.trim_end_matches('/'), words)?);
        }
        Ok(shapes)
    }

    fn of_tag(tag: &'a str, words: &'a str) -> Result<Self> {
        let (name, mut rest) = tag.split_once(' ').unwrap_or((tag, ""));
        let mut attributes = Vec::new();
        while let Some((key, after)) = rest.trim_start().split_once("=\"") {
            let (value, after) =
                after.split_once('"').with_context(|| format!("{name}: {key} without end"))?;
            attributes.push((key, value));
            rest = after;
        }
        Ok(Self { name, attributes, words })
    }

    /// An attribute's text. Fails if it is missing.
    pub fn text(&self, key: &str) -> Result<&'a str> {
        let found = self.attributes.iter().find(|(own, _)| *own == key);
        found.map(|(_, value)| *value).with_context(|| format!("{} without {key}", self.name))
    }

    /// An attribute's number. Fails if it is missing or not a number.
    pub fn number(&self, key: &str) -> Result<f32> {
        let text = self.text(key)?;
        text.parse().with_context(|| format!("{}: {key} is {text}, not a number", self.name))
    }

    /// The corners of a `polyline` or a `polygon`: `x,y` pairs with spaces between them. Fails if they are missing or not numbers.
    pub fn points(&self) -> Result<Vec<(f32, f32)>> {
        let pairs = self.text("points")?.split_whitespace();
        pairs
            .map(|pair| {
                let (x, y) = pair.split_once(',').context("a point without comma")?;
                Ok((x.parse()?, y.parse()?))
            })
            .collect()
    }

    /// A colour, `#RRGGBB`; nothing where the attribute is `none` or missing. Fails if it is another kind of colour.
    pub fn colour(&self, key: &str) -> Result<Option<[u8; 3]>> {
        let hex = match self.text(key) {
            Err(_) | Ok("none") => return Ok(None),
            Ok(text) => text.strip_prefix('#').filter(|hex| hex.len() == 6),
        };
        let rgb = hex.and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match rgb.map(u32::to_be_bytes) {
            Some([_, red, green, blue]) => Ok(Some([red, green, blue])),
            None => bail!("{}: {key} is no #RRGGBB", self.name),
        }
    }

    /// The words of a `text`, as a person reads them.
    pub fn words(&self) -> String {
        let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
        entities.iter().fold(self.words.to_owned(), |words, (entity, sign)| words.replace(entity, sign))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SVG: &str = "<svg width=\"12\" height=\"8\" viewBox=\"0 0 12 8\" xmlns=\"http://www.w3.org/2000/svg\">\n\
        <polyline fill=\"none\" stroke=\"#0072B2\" points=\"1,2 -3,4 \"/>\n\
        <text x=\"1\" y=\"2\" fill=\"#282828\">\nFt/Fn &lt; S2 &amp;amp;\n</text>\n</svg>\n";

    #[test]
    fn elements_are_read_in_their_order() {
        let shapes = Shape::all(SVG).unwrap();
        assert_eq!(shapes.iter().map(|shape| shape.name).collect::<Vec<_>>(), ["svg", "polyline", "text"]);
        assert_eq!(shapes[0].number("width").unwrap(), 12.0);
        assert_eq!(shapes[1].points().unwrap(), [(1.0, 2.0), (-3.0, 4.0)]);
        assert_eq!(shapes[1].colour("stroke").unwrap(), Some([0, 0x72, 0xB2]));
        assert_eq!(shapes[1].colour("fill").unwrap(), None);
        assert_eq!(shapes[2].words(), "Ft/Fn < S2 &amp;");
    }

    #[test]
    fn what_plotters_does_not_write_is_an_error() {
        let shape = |svg| Shape::all(svg).map(|shapes| shapes[0].clone());
        assert!(shape("<rect x=\"1").is_err());
        let rect = shape("<rect x=\"a\" fill=\"red\"/>").unwrap();
        assert!(rect.number("x").is_err());
        assert!(rect.number("y").is_err());
        assert!(rect.colour("fill").is_err());
    }
}
