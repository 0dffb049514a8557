#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

enum class Dimension { kNone, kMass, kLength };

struct Unit {
  Dimension dimension = Dimension::kNone;
  double factor = 1.0;  // kg or m in one of it
};

// Returns the unit that `word` (lower case, singular or plural, long or short) names; unset if
// none.
std::optional<Unit> FindUnit(std::string_view word);

// The meaning of a comma between two digits; people and models use all three.
enum class Comma {
  kThousands,  // 1,200 is one number, 10,5 are two
  kSeparator,  // always two
  kDecimal     // 10,5 is ten and a half
};

// A number or range in a text, such as "200-300 g", "1.5 to 2", "300 +/- 20 g", "12 cm".
struct TextRange {
  std::size_t begin = 0, end = 0;  // position in the text, its unit included
  Interval value;                  // as written, in the text's order: min may exceed max
  std::optional<Unit> unit;        // unset: no unit is written
};

// Finds all ranges in `text`, the output of PlainText. Numbers inside words ("A4") are ignored.
std::vector<TextRange> ReadRanges(std::string_view text, Comma comma);

// Converts `text` to lower case; every dash to '-', the cross to 'x', plus-minus to "+/-", other
// blanks to ' ', and Markdown's asterisks and backticks to blanks.
std::string PlainText(std::string_view text);

}  // namespace simwright::physics_params
