#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace simwright::asset_lift {

struct HashGridOptions {
  // 8 levels from 16 to 429 cells a side: a third of the time of the published 16 levels, and
  // pictures of 128 pixels hold no finer detail.
  int levels = 8;
  int features = 2;          // numbers an entry: 1, 2 or 4
  int log2_table_size = 15;  // entries of a level at most: the whole grid stays in a core's cache
  int base_resolution = 16;  // cells a side of the coarsest level
  double scale = 1.6;        // cells a side from a level to the next

  // Whether a grid can be built; else `error`, where it is not null, says why not.
  bool IsValid(std::string* error) const;
};

// A level of the grid: cells^3 cells, whose corners are rows of the table.
struct HashGridLevel {
  int cells = 0;             // a side
  std::uint32_t offset = 0;  // first entry
  std::uint32_t size = 0;    // entries
  std::uint32_t row = 0;     // dense: entries from a corner to the next along y
  std::uint32_t slice = 0;   // ... along z; 0: the corner is hashed
  std::uint32_t mask = 0;    // hashed: size - 1
  bool hashed() const { return slice == 0; }
};

// Where the corners of a multi-resolution hash grid lie in one table of features. Mueller et al.,
// "Instant neural graphics primitives with a multiresolution hash encoding", 2022: level l has
// floor(base * scale^l) cells a side; a level with no more than T corners is dense, else corner
// (i, j, k) is entry (i ^ 2654435761 j ^ 805459861 k) mod T (their equation 4).
class HashGridLayout {
 public:
  // Throws core::Error for options that are not valid.
  explicit HashGridLayout(const HashGridOptions& options);

  const std::vector<HashGridLevel>& levels() const { return levels_; }
  int features() const { return features_; }
  // Numbers that a point is turned into: levels * features.
  int outputs() const { return features_ * static_cast<int>(levels_.size()); }
  // Entries of all levels together, each of features() numbers.
  std::uint32_t entries() const { return entries_; }

 private:
  std::vector<HashGridLevel> levels_;
  int features_ = 0;
  std::uint32_t entries_ = 0;
};

}  // namespace simwright::asset_lift
