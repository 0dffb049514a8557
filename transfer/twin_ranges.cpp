#include "transfer/twin_ranges.h"

#include <algorithm>
#include <cmath>

#include "workflows/twin/twin_record.h"

namespace simwright::transfer {

std::map<std::string, skills::PlacementRange> PlacementRanges(const std::filesystem::path& twin,
                                                              double sigmas) {
  std::map<std::string, skills::PlacementRange> ranges;
  for (const workflows::TwinObject& object : workflows::ReadTwin(twin).objects) {
    ranges[object.name] = {sigmas * object.position_error,
                           std::min(M_PI, sigmas * object.yaw_error)};
  }
  return ranges;
}

}  // namespace simwright::transfer
