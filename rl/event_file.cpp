#include "rl/event_file.h"

#include <bit>

#include "rl/crc32c.h"

namespace simwright::rl {
namespace {

// Protocol buffer wire types.
constexpr int kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5;

std::string LittleEndian(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
  return out;
}

std::uint64_t ReadLittleEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  }
  return value;
}

std::string Varint(std::uint64_t value) {
  std::string out;
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<char>(value | 0x80));
  out.push_back(static_cast<char>(value));
  return out;
}

std::string Key(int field, int type) {
  return Varint(static_cast<std::uint64_t>(field << 3 | type));
}

std::string BytesField(int field, const std::string& bytes) {
  return Key(field, kBytes) + Varint(bytes.size()) + bytes;
}

std::string EventHead(double wall_time, std::int64_t step) {
  return Key(1, kFixed64) + LittleEndian(std::bit_cast<std::uint64_t>(wall_time), 8) +
         Key(2, kVarint) + Varint(static_cast<std::uint64_t>(step));
}

std::uint32_t MaskedCrc(std::string_view bytes) {
  const std::uint32_t crc = Crc32c(bytes);
  return ((crc >> 15) | (crc << 17)) + 0xA282EAD8u;
}

std::string Record(const std::string& event) {
  const std::string length = LittleEndian(event.size(), 8);
  return length + LittleEndian(MaskedCrc(length), 4) + event + LittleEndian(MaskedCrc(event), 4);
}

// Returns the step of an event as EventHead writes it; -1 for other events.
std::int64_t StepOf(std::string_view event) {
  std::uint64_t step = 0;
  if (event.size() < 11 || event[9] != static_cast<char>(2 << 3 | kVarint)) return -1;
  for (std::size_t i = 10, shift = 0; i < event.size() && shift < 64; ++i, shift += 7) {
    const auto byte = static_cast<unsigned char>(event[i]);
    step |= std::uint64_t{byte & 0x7Fu} << shift;
    if (byte < 0x80) return static_cast<std::int64_t>(step);
  }
  return -1;
}

}  // namespace

std::string EventFileStart(double wall_time) {
  return Record(EventHead(wall_time, 0) + BytesField(3, "brain.Event:2"));
}

std::string EventRecord(double wall_time, std::int64_t step,
                        const std::vector<std::pair<std::string, float>>& scalars) {
  std::string summary;
  for (const auto& [name, value] : scalars) {
    // Summary.value 1: tag 1, simple_value 2.
    summary += BytesField(1, BytesField(1, name) + Key(2, kFixed32) +
                                 LittleEndian(std::bit_cast<std::uint32_t>(value), 4));
  }
  return Record(EventHead(wall_time, step) + BytesField(5, summary));
}

std::size_t EventsUpTo(std::string_view file, std::int64_t last_step) {
  std::size_t end = 0;
  while (file.size() - end >= 16) {
    const std::string_view record = file.substr(end);
    const std::uint64_t length = ReadLittleEndian(record.substr(0, 8));
    if (ReadLittleEndian(record.substr(8, 4)) != MaskedCrc(record.substr(0, 8))) break;
    if (length > record.size() - 16) break;
    const std::string_view event = record.substr(12, length);
    if (ReadLittleEndian(record.substr(12 + length, 4)) != MaskedCrc(event)) break;
    const std::int64_t step = StepOf(event);
    if (step < 0 || step > last_step) break;
    end += 16 + length;
  }
  return end;
}

}  // namespace simwright::rl
