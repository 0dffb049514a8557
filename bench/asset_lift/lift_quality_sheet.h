#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace simwright::bench {

// An image sheet that grows by one object at a time: one strip of images each, kept as a file in
// FILE.strips/ so that an interrupted run can resume.
class QualitySheet {
 public:
  // `file` empty: writes nothing. Without `resume`, removes older strips.
  QualitySheet(const std::filesystem::path& file, bool resume);

  bool wanted() const { return !file_.empty(); }
  bool Has(size_t object) const;
  // Adds the strip of object `object` (its index in the list): the input, the novel views of the
  // reconstruction, and those of the ground truth.
  void Add(size_t object, const core::Image& input, const std::vector<core::Image>& ours,
           const std::vector<core::Image>& truth) const;
  // Writes at most `limit` strips, spread over the available ones, one below the other.
  void Write(size_t limit = 12) const;

 private:
  std::filesystem::path StripFile(size_t object) const;

  std::filesystem::path file_, strips_;
};

}  // namespace simwright::bench
