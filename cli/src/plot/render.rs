//! A drawing as a picture of pixels, with letters that come along.
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
    use super::*;

    #[test]
    fn letters_appear_without_any_font_of_the_system() {
        let blank =
            png("<svg xmlns='http://www.w3.org/2000/svg' width='80' height='20'/>").unwrap();
        let lettered = png(
            "<svg xmlns='http://www.w3.org/2000/svg' width='80' height='20' font-family='Nowhere'>\
             <text x='2' y='15'>mm/s²</text></svg>",
        )
        .unwrap();
        assert!(
            lettered.len() > blank.len() + 100,
            "{} bytes",
            lettered.len()
        );
    }
}
