#include "transfer/twin_ranges.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "workflows/twin/twin_record.h"

namespace simwright::transfer {

std::map<std::string, skills::PlacementRange> PlacementRanges(const std::filesystem::path& twin,
                                                              double sigmas) {
  const workflows::TwinRecord record = workflows::ReadTwin(twin);
  if (record.objects.empty()) throw core::Error("the twin has no objects", twin.string());
  std::map<std::string, skills::PlacementRange> ranges;
  for (const workflows::TwinObject& object : record.objects) {
    ranges[object.name] = {sigmas * object.position_error,
                           std::min(M_PI, sigmas * object.yaw_error)};
  }
  return ranges;
}

}  // namespace simwright::transfer
