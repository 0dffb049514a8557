#include "scene/model/inpainting_mask.h"

#include <algorithm>
#include <cmath>

namespace simwright::scene {
namespace {

// Returns the fault of one entry; empty if there is none. `forbidden`: its flags, or null.
std::string FaultOfEntry(const float* token, bool pose, bool classes, const char* forbidden,
                         const Vocabulary& vocabulary) {
  const int width = vocabulary.TokenWidth();
  if (!std::all_of(token, token + width, [](float x) { return std::isfinite(x); })) {
    return "a number is not finite";
  }
  const float* const first = token + kPoseWidth;
  const bool one_hot = std::count(first, token + width, 1.0f) == 1 &&
                       std::count(first, token + width, 0.0f) == vocabulary.ClassCount() - 1;
  if (!one_hot) return "its class is not one-hot";
  if (!classes) return "";
  if (!pose && first[vocabulary.EmptyClass()] == 1.0f) {
    return "it has no object whose class could be synthesized";
  }
  if (forbidden == nullptr) return "";
  const int usable = pose ? vocabulary.ClassCount() : vocabulary.EmptyClass();
  return std::count(forbidden, forbidden + usable, 0) > 0 ? "" : "all its classes are forbidden";
}

}  // namespace

InpaintingMask InpaintingMask::All(int count, int entries) {
  const auto size = static_cast<size_t>(count) * static_cast<size_t>(entries);
  return {std::vector<char>(size, 1), std::vector<char>(size, 1)};
}

void InpaintingMask::Forbid(const Vocabulary& vocabulary, int entry, int one_class) {
  const auto classes = static_cast<size_t>(vocabulary.ClassCount());
  forbidden.resize(pose.size() * classes, 0);
  forbidden[static_cast<size_t>(entry) * classes + static_cast<size_t>(one_class)] = 1;
}

bool InpaintingMask::IsValid(const std::vector<float>& tokens, const Vocabulary& vocabulary,
                             std::string* error) const {
  const auto entries = static_cast<size_t>(vocabulary.entries);
  const auto width = static_cast<size_t>(vocabulary.TokenWidth());
  const auto class_count = static_cast<size_t>(vocabulary.ClassCount());
  if (tokens.size() % (entries * width) != 0 || pose.size() * width != tokens.size() ||
      classes.size() != pose.size()) {
    *error = "mask and tokens have different sizes";
    return false;
  }
  if (!forbidden.empty() && forbidden.size() != pose.size() * class_count) {
    *error = "the forbidden classes have another size than the mask";
    return false;
  }
  for (size_t i = 0; i < pose.size(); ++i) {
    const char* const flags = forbidden.empty() ? nullptr : &forbidden[i * class_count];
    const std::string fault =
        FaultOfEntry(&tokens[i * width], pose[i] != 0, classes[i] != 0, flags, vocabulary);
    if (fault.empty()) continue;
    *error = "scene " + std::to_string(i / entries) + ", entry " + std::to_string(i % entries) +
             ": " + fault;
    return false;
  }
  return true;
}

}  // namespace simwright::scene
