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

// The record that a file begins with.
std::string EventFileStart(double wall_time);

// A record with a scalar for each name. `wall_time` in s since 1970.
std::string EventRecord(double wall_time, std::int64_t step,
                        const std::vector<std::pair<std::string, float>>& scalars);

// Length in bytes of the sound records at the file's beginning whose steps are not above
// `last_step`: where a training that goes on from there appends. 0 where the first is not sound.
std::size_t EventsUpTo(std::string_view file, std::int64_t last_step);

}  // namespace simwright::rl
