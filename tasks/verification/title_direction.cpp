#include "tasks/verification/title_direction.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace simwright::tasks {
namespace {

// Splits a title into lower-case words: "OpenDoor_now" gives open, door, now.
std::vector<std::string> Words(std::string_view text) {
  std::vector<std::string> words;
  bool inside = false, was_lower = false;
  for (char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (!std::isalpha(u)) {
      inside = was_lower = false;
      continue;
    }
    if (!inside || (was_lower && std::isupper(u))) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(u));
    inside = true;
    was_lower = std::islower(u) != 0;
  }
  return words;
}

template <std::size_t N>
bool OneOf(const std::string& word, const std::array<const char*, N>& known) {
  return std::any_of(known.begin(), known.end(), [&](const char* one) { return word == one; });
}

constexpr std::array kAwayVerbs = {"open",    "opens", "opening", "unlock",
                                   "unlatch", "press", "presses", "pressing"};
constexpr std::array kBackVerbs = {"close",    "closes", "closing",   "shut",
                                   "shutting", "shuts",  "unpressed", "release"};
// These verbs need a particle: turn on, pull it out.
constexpr std::array kOpenVerbs = {"turn",  "turning", "switch", "switching", "pull", "pulling",
                                   "slide", "sliding", "push",   "pushing",   "flip", "swing"};
constexpr std::array kAwayParticles = {"on", "out", "open"};
constexpr std::array kBackParticles = {"off", "in", "closed", "shut", "back"};
constexpr std::size_t kParticleReach = 4;  // words between verb and particle

}  // namespace

TitleDirection DirectionOfTitle(std::string_view title) {
  const std::vector<std::string> words = Words(title);
  for (std::size_t i = 0; i < words.size(); ++i) {
    // "the open door" is a state.
    const bool adjective = i > 0 && (words[i - 1] == "the" || words[i - 1] == "an");
    if (OneOf(words[i], kAwayVerbs) && !adjective) return TitleDirection::kAway;
    if (OneOf(words[i], kBackVerbs) && !adjective) return TitleDirection::kBack;
    if (!OneOf(words[i], kOpenVerbs)) continue;
    for (std::size_t k = i + 1; k < words.size() && k <= i + kParticleReach; ++k) {
      // In "slide the cup in the box" the particle names a place, not a direction.
      const bool last = k + 1 == words.size() || k == i + 1;
      if (OneOf(words[k], kAwayParticles) && (last || words[k] != "on")) {
        return TitleDirection::kAway;
      }
      if (OneOf(words[k], kBackParticles) && (last || words[k] != "in")) {
        return TitleDirection::kBack;
      }
    }
  }
  return TitleDirection::kNone;
}

}  // namespace simwright::tasks
