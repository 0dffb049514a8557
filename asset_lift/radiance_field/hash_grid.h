#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/radiance_field/field_fit_options.h"

namespace simwright::asset_lift {

// A level of the grid: cells^3 cells, whose corners are rows of the table.
struct HashGridLevel {
  int cells = 0;             // per side
  std::uint32_t offset = 0;  // first entry
  std::uint32_t size = 0;    // entries
  std::uint32_t row = 0;     // dense: index stride along y
  std::uint32_t slice = 0;   // ... along z; 0: the level is hashed
  std::uint32_t mask = 0;    // hashed: size - 1
  bool hashed() const { return slice == 0; }
};

// The table indices of the corners of a multi-resolution hash grid. Mueller et al., "Instant neural
// graphics primitives with a multiresolution hash encoding", 2022: level l has floor(base *
// scale^l) cells per side; a level with no more than T corners is dense, otherwise corner (i, j, k)
// has the entry (i ^ 2654435761 j ^ 805459861 k) mod T (their equation 4).
class HashGridLayout {
 public:
  // Throws core::Error for invalid options.
  explicit HashGridLayout(const HashGridOptions& options);

  const std::vector<HashGridLevel>& levels() const { return levels_; }
  int features() const { return features_; }
  // Returns the number of features of a point: levels * features.
  int outputs() const { return features_ * static_cast<int>(levels_.size()); }
  // Returns the number of entries of all levels together, each of features() values.
  std::uint32_t entries() const { return entries_; }

 private:
  std::vector<HashGridLevel> levels_;
  int features_ = 0;
  std::uint32_t entries_ = 0;
};

}  // namespace simwright::asset_lift
