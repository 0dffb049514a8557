#pragma once

#include <string>

#include "core/image.h"
#include "core/random.h"

namespace simwright::texture {

struct PrintDesign {
  std::string title;              // "TEA"
  std::string subtitle;           // "500 ml"; may be empty
  int width = 768, height = 512;  // pixels
};

// Draws the face of a package: fields of two to three colours that go together, the title, an
// emblem, small print and a bar code. The generator draws the layout and the colours.
//
// The font has the printable characters of ASCII; it draws "?" for each other one.
core::Image DrawPrint(const PrintDesign& design, core::Rng* rng);

// Returns the number of characters of a text (UTF-8) that DrawPrint draws as "?".
int CharactersWithoutGlyph(const std::string& text);

}  // namespace simwright::texture
