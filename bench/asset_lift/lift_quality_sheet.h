#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace simwright::bench {

// A picture sheet that grows an object at a time: a strip of pictures each, kept as a file of its
// own in FILE.strips/ so that a run that was cut off goes on.
class QualitySheet {
 public:
  // `file` empty: nothing is drawn. Not resumed, older strips are removed.
  QualitySheet(const std::filesystem::path& file, bool resume);

  bool wanted() const { return !file_.empty(); }
  bool Has(size_t object) const;
  // The strip of object `object` (its place in the list): the input, the lift's novel views, the
  // truth's.
  void Add(size_t object, const core::Image& input, const std::vector<core::Image>& ours,
           const std::vector<core::Image>& truth) const;
  // At most `limit` strips, spread over those there are, one below the other.
  void Write(size_t limit = 12) const;

 private:
  std::filesystem::path StripFile(size_t object) const;

  std::filesystem::path file_, strips_;
};

}  // namespace simwright::bench
