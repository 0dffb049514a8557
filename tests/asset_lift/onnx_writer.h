#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace simwright::asset_lift {

// Encodes the few messages of onnx.proto that a small network needs. Field numbers are those of
// onnx.proto.
class OnnxMessage {
 public:
  OnnxMessage& Number(int field, std::uint64_t value) {
    bytes_ += Varint(static_cast<std::uint64_t>(field) << 3) + Varint(value);
    return *this;
  }
  OnnxMessage& Bytes(int field, const std::string& value) {
    bytes_ += Varint(static_cast<std::uint64_t>(field) << 3 | 2) + Varint(value.size()) + value;
    return *this;
  }
  OnnxMessage& Message(int field, const OnnxMessage& value) { return Bytes(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string Varint(std::uint64_t value) {
    std::string bytes;
    for (; value >= 0x80; value >>= 7) bytes += static_cast<char>((value & 0x7f) | 0x80);
    return bytes + static_cast<char>(value);
  }
  std::string bytes_;
};

inline OnnxMessage OnnxTensor(const std::string& name, const std::vector<std::uint64_t>& sizes,
                              const std::vector<float>& values) {
  OnnxMessage tensor;
  for (const std::uint64_t size : sizes) tensor.Number(1, size);
  std::string raw(values.size() * sizeof(float), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return tensor.Number(2, 1).Bytes(8, name).Bytes(9, raw);
}

inline OnnxMessage OnnxValue(const std::string& name, const std::vector<std::uint64_t>& sizes,
                             int element = 1) {
  OnnxMessage shape;
  for (const std::uint64_t size : sizes) {
    shape.Message(1, size == 0 ? OnnxMessage().Bytes(2, "free") : OnnxMessage().Number(1, size));
  }
  const OnnxMessage tensor = OnnxMessage().Number(1, static_cast<std::uint64_t>(element));
  OnnxMessage with_shape = tensor;
  with_shape.Message(2, shape);
  return OnnxMessage().Bytes(1, name).Message(2, OnnxMessage().Message(1, with_shape));
}

inline OnnxMessage OnnxNode(const std::string& operation, const std::vector<std::string>& inputs,
                            const std::string& output) {
  OnnxMessage node;
  for (const std::string& input : inputs) node.Bytes(1, input);
  return node.Bytes(2, output).Bytes(3, output).Bytes(4, operation);
}

// A model with a 1 x 1 convolution from 3 to `bias.size()` channels and a sigmoid, for images of
// `side` pixels; 0: any size. `element`: the type of the input, 1 is fp32.
inline std::string OnnxConvolution(const std::vector<float>& weights,
                                   const std::vector<float>& bias, std::uint64_t side,
                                   int element = 1) {
  OnnxMessage graph;
  OnnxMessage convolution = OnnxNode("Conv", {"image", "weights", "bias"}, "logit");
  convolution.Message(
      5, OnnxMessage().Bytes(1, "kernel_shape").Number(8, 1).Number(8, 1).Number(20, 7));
  graph.Message(1, convolution);
  graph.Message(1, OnnxNode("Sigmoid", {"logit"}, "saliency"));
  graph.Bytes(2, "saliency");
  graph.Message(5, OnnxTensor("weights", {bias.size(), 3, 1, 1}, weights));
  graph.Message(5, OnnxTensor("bias", {bias.size()}, bias));
  graph.Message(11, OnnxValue("weights", {bias.size(), 3, 1, 1}));  // listed by some exporters
  graph.Message(11, OnnxValue("image", {1, 3, side, side}, element));
  graph.Message(12, OnnxValue("saliency", {1, bias.size(), side, side}));
  OnnxMessage model;
  model.Number(1, 7).Message(7, graph);
  model.Message(8, OnnxMessage().Bytes(1, "").Number(2, 11));
  return model.bytes();
}

}  // namespace simwright::asset_lift
