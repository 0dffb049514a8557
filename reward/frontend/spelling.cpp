#include "reward/frontend/spelling.h"

#include <algorithm>
#include <cctype>

namespace simwright::reward {
namespace {

constexpr std::size_t kLongestCompared = 64;

std::string Lower(std::string_view text) {
  std::string lower(text.substr(0, kLongestCompared));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Returns the number of edits between two words; a swap of neighbours counts as one edit.
int EditDistance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> table((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      int& cell = table[i * columns + j];
      if (i == 0 || j == 0) {
        cell = static_cast<int>(i + j);
        continue;
      }
      const int* above = &table[(i - 1) * columns + j];
      cell = std::min({above[0] + 1, table[i * columns + j - 1] + 1,
                       above[-1] + (a[i - 1] != b[j - 1] ? 1 : 0)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cell = std::min(cell, table[(i - 2) * columns + j - 2] + 1);
      }
    }
  }
  return table.back();
}

}  // namespace

std::string NearestName(std::string_view name, const std::vector<std::string>& known) {
  const std::string wanted = Lower(name);
  std::string nearest;
  // At most a third of the letters may differ.
  int best = std::max<int>(1, static_cast<int>(wanted.size()) / 3) + 1;
  for (const std::string& candidate : known) {
    const std::string other = Lower(candidate);
    const bool begins = std::min(wanted.size(), other.size()) >= 3 &&
                        (wanted.starts_with(other) || other.starts_with(wanted));
    const int distance = begins ? 1 : EditDistance(wanted, other);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string Suggestion(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = NearestName(name, known);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  if (known.empty() || known.size() > 8) return "";
  std::string listed;
  for (const std::string& one : known) listed += (listed.empty() ? "" : ", ") + one;
  return "; known are: " + listed;
}

}  // namespace simwright::reward
