#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace simwright::rl {

// Serializes one message in the wire format of Protocol Buffers: fields in the order of the calls.
// A repeated field is added once per element.
class ProtobufWriter {
 public:
  void Integer(int field, std::uint64_t value);          // int64, int32, enum: not negative
  void Float(int field, float value);                    // fixed 32 bits
  void Bytes(int field, std::string_view value);         // string, bytes
  void Message(int field, const ProtobufWriter& value);  // an embedded message

  const std::string& bytes() const { return bytes_; }

 private:
  void Varint(std::uint64_t value);
  void Key(int field, int wire_type);

  std::string bytes_;
};

}  // namespace simwright::rl
