//! Renders a drawing to pixels, with bundled fonts.
//!
//! A clean machine has no fonts, and one with fonts has its own; so the letters of a PNG are those
//! of Noto Sans (SIL Open Font License) from within the program.

use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Name of the fonts that come along.
const FAMILY: &str = "Noto Sans";

/// Draws SVG text as PNG.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>, String> {
    let mut options = usvg::Options {
        font_family: FAMILY.to_owned(),
        ..usvg::Options::default()
    };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(notosans::REGULAR_TTF.to_vec());
    fonts.load_font_data(notosans::BOLD_TTF.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let tree = usvg::Tree::from_str(svg, &options).map_err(|refused| refused.to_string())?;
    let size = tree.size().to_int_size();
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height())
        .ok_or_else(|| "the picture has no size".to_owned())?;
    resvg::render(
        &tree,
        tiny_skia::Transform::identity(),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().map_err(|refused| refused.to_string())
}

#[cfg(test)]
mod tests {
    use super::super::canvas::{Anchor, Canvas};
    use super::*;

    #[test]
    fn letters_appear_without_any_font_of_the_system() {
        let drawn = |text: &str| {
            let mut canvas = Canvas::new(80.0, 20.0);
            canvas.text((2.0, 15.0), Anchor::Start, 13.0, "", text);
            png(&canvas.finish()).unwrap().len()
        };
        let blank = drawn("");
        for text in ["mm/s²", "µ", "·", "±", "°", "\u{2212}"] {
            assert!(drawn(text) > blank + 20, "{text} is drawn");
        }
    }
}
