#include "asset_lift/radiance_field/hash_grid.h"

#include <cmath>

#include "core/error.h"

namespace simwright::asset_lift {

bool HashGridOptions::IsValid(std::string* error) const {
  const char* fault = nullptr;
  if (levels < 1 || levels > 16) fault = "a hash grid must have 1 to 16 levels";
  if (features != 1 && features != 2 && features != 4) {
    fault = "a hash grid's entry must have 1, 2 or 4 features";
  }
  if (log2_table_size < 4 || log2_table_size > 22) {
    fault = "a hash grid's table must have 2^4 to 2^22 entries per level";
  }
  if (base_resolution < 1 || base_resolution > 1024) {
    fault = "a hash grid's coarsest level must have 1 to 1024 cells per side";
  }
  // Single precision cannot resolve more than 2^20 cells per side.
  if (!(scale >= 1.0) || !(base_resolution * std::pow(scale, levels - 1) <= 0x1p20)) {
    fault = "a hash grid must grow by a factor >= 1 per level, to at most 2^20 cells per side";
  }
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

HashGridLayout::HashGridLayout(const HashGridOptions& options) : features_(options.features) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "hash grid");
  const std::uint64_t limit = std::uint64_t{1} << options.log2_table_size;
  for (int l = 0; l < options.levels; ++l) {
    HashGridLevel level;
    level.cells = static_cast<int>(options.base_resolution * std::pow(options.scale, l));
    level.offset = entries_;
    const std::uint64_t side = static_cast<std::uint64_t>(level.cells) + 1;
    if (side * side * side <= limit) {
      level.size = static_cast<std::uint32_t>(side * side * side);
      level.row = static_cast<std::uint32_t>(side);
      level.slice = static_cast<std::uint32_t>(side * side);
    } else {
      level.size = static_cast<std::uint32_t>(limit);
      level.mask = level.size - 1;
    }
    entries_ += level.size;
    levels_.push_back(level);
  }
}

}  // namespace simwright::asset_lift
