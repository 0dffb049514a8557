#pragma once

#include <string>
#include <vector>

namespace simwright::proposals {

// A noun whose hyponyms belong to a theme, and how typical they are of it, in (0, 1].
struct ThemeNoun {
  std::string noun;
  double weight;
};

struct Theme {
  std::string name;
  std::vector<ThemeNoun> nouns;
};

// Returns the themes that ship with the program. Nouns and weights are estimates of ours.
const std::vector<Theme>& ShippedThemes();

}  // namespace simwright::proposals
