#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "asset_lift/segmentation/network_formats.h"

namespace simwright::asset_lift {
namespace {

// A field of a protocol buffer message: a number, or the bytes of a text or of an inner message.
struct ProtoField {
  std::uint64_t number = 0;
  std::uint64_t value = 0;
  std::string_view bytes;
};

// Reads the fields of a message one after the other.
class ProtoReader {
 public:
  explicit ProtoReader(std::string_view message) : left_(message) {}

  // Returns false at the end of the message, or if it is malformed, which `valid()` tells.
  bool Next(ProtoField* field) {
    if (left_.empty()) return false;
    const std::uint64_t key = Varint();
    *field = {key >> 3, 0, {}};
    switch (key & 7) {
      case 0:
        field->value = Varint();
        break;
      case 1:
        field->bytes = Take(8);
        break;
      case 2:
        field->bytes = Take(Varint());
        break;
      case 5:
        field->bytes = Take(4);
        break;
      default:
        valid_ = false;
    }
    return valid_;
  }
  bool valid() const { return valid_; }

 private:
  std::uint64_t Varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !left_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(left_.front());
      left_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    valid_ = false;
    return 0;
  }
  std::string_view Take(std::uint64_t count) {
    if (count > left_.size()) {
      valid_ = false;
      return {};
    }
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }

  std::string_view left_;
  bool valid_ = true;
};

// Returns the inner messages, or texts, of the field `number`.
std::vector<std::string_view> Inner(std::string_view message, std::uint64_t number) {
  std::vector<std::string_view> found;
  ProtoReader reader(message);
  for (ProtoField field; reader.Next(&field);) {
    if (field.number == number) found.push_back(field.bytes);
  }
  return found;
}

std::string_view FirstInner(std::string_view message, std::uint64_t number) {
  const std::vector<std::string_view> found = Inner(message, number);
  return found.empty() ? std::string_view() : found.front();
}

std::uint64_t NumberOf(std::string_view message, std::uint64_t number) {
  ProtoReader reader(message);
  for (ProtoField field; reader.Next(&field);) {
    if (field.number == number) return field.value;
  }
  return 0;
}

int Dimension(std::string_view dimension) {
  constexpr std::uint64_t kMost = 1u << 20;
  const std::uint64_t size = NumberOf(dimension, 1);
  return size > kMost ? 0 : static_cast<int>(size);
}

}  // namespace

// The field numbers are those of onnx.proto: ModelProto.graph 7, GraphProto.initializer 5 and input
// 11, TensorProto.name 8, ValueInfoProto.name 1 and type 2, TypeProto.tensor_type 1 with elem_type
// 1 (1: float) and shape 2, TensorShapeProto.dim 1 with dim_value 1.
std::optional<OnnxInput> ReadOnnxInput(std::string_view bytes) {
  ProtoReader whole(bytes);
  std::string_view graph;
  for (ProtoField field; whole.Next(&field);) {
    if (field.number == 7) graph = field.bytes;
  }
  if (!whole.valid() || graph.empty()) return std::nullopt;
  std::set<std::string_view> weights;
  for (const std::string_view tensor : Inner(graph, 5)) weights.insert(FirstInner(tensor, 8));
  for (const std::string_view input : Inner(graph, 11)) {
    if (weights.contains(FirstInner(input, 1))) continue;
    const std::string_view tensor = FirstInner(FirstInner(input, 2), 1);
    const std::vector<std::string_view> dimensions = Inner(FirstInner(tensor, 2), 1);
    OnnxInput read;
    read.rank = static_cast<int>(dimensions.size());
    read.fp32 = NumberOf(tensor, 1) == 1;
    if (read.rank == 4) {
      read.channels = Dimension(dimensions[1]);
      read.height = Dimension(dimensions[2]);
      read.width = Dimension(dimensions[3]);
    }
    return read;
  }
  return std::nullopt;
}

}  // namespace simwright::asset_lift
