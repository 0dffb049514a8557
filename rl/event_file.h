#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simwright::rl {

// TensorBoard's event file: TFRecords (length, masked CRC32C of the length, an Event, masked CRC32C
// of the Event; tensorflow/core/lib/io/record_writer.cc), each Event a protocol buffer with the
// fields wall_time 1, step 2, file_version 3, summary 5 (tensorflow/core/util/event.proto).

// Returns the first record of a file.
std::string EventFileStart(double wall_time);

// Returns a record with a scalar for each name. `wall_time` in s since 1970.
std::string EventRecord(double wall_time, std::int64_t step,
                        const std::vector<std::pair<std::string, float>>& scalars);

// Returns the length in bytes of the leading valid records whose steps are not above `last_step`:
// the offset at which a resumed training appends. Returns 0 if the first record is not valid.
std::size_t EventsUpTo(std::string_view file, std::int64_t last_step);

}  // namespace simwright::rl
