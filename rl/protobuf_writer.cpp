#include "rl/protobuf_writer.h"

#include <bit>

namespace simwright::rl {
namespace {

constexpr int kWireVarint = 0, kWireLengthDelimited = 2, kWireFixed32 = 5;

}  // namespace

void ProtobufWriter::Varint(std::uint64_t value) {
  while (value >= 0x80) {
    bytes_ += static_cast<char>((value & 0x7f) | 0x80);
    value >>= 7;
  }
  bytes_ += static_cast<char>(value);
}

void ProtobufWriter::Key(int field, int wire_type) {
  Varint(static_cast<std::uint64_t>(field) << 3 | static_cast<std::uint64_t>(wire_type));
}

void ProtobufWriter::Integer(int field, std::uint64_t value) {
  Key(field, kWireVarint);
  Varint(value);
}

void ProtobufWriter::Float(int field, float value) {
  Key(field, kWireFixed32);
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int byte = 0; byte < 4; ++byte) bytes_ += static_cast<char>(bits >> (8 * byte) & 0xff);
}

void ProtobufWriter::Bytes(int field, std::string_view value) {
  Key(field, kWireLengthDelimited);
  Varint(value.size());
  bytes_ += value;
}

void ProtobufWriter::Message(int field, const ProtobufWriter& value) {
  Bytes(field, value.bytes());
}

}  // namespace simwright::rl
