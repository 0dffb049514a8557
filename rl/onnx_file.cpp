#include "rl/onnx_file.h"

#include <bit>
#include <vector>

#include "core/files.h"
#include "rl/protobuf_writer.h"

namespace simwright::rl {
namespace {

// The field numbers and values are those of onnx.proto. Operator set 10 is the last whose Clip has
// its limits as attributes, which older readers such as OpenCV 4.6 need.
constexpr int kIrVersion = 5, kOperatorSet = 10;
constexpr int kTensorFloat = 1;                            // TensorProto.DataType
constexpr int kAttributeFloat = 1, kAttributeInteger = 2;  // AttributeProto.AttributeType
constexpr const char* kInputName = "observation";
constexpr const char* kOutputName = "action";

static_assert(std::endian::native == std::endian::little, "raw_data is little-endian");

ProtobufWriter TensorMessage(const std::string& name, const std::vector<int>& dimensions,
                             const float* values, size_t count) {
  ProtobufWriter tensor;
  for (const int dimension : dimensions) {
    tensor.Integer(1, static_cast<std::uint64_t>(dimension));  // dims
  }
  tensor.Integer(2, kTensorFloat);                                                  // data_type
  tensor.Bytes(8, name);                                                            // name
  tensor.Bytes(9, {reinterpret_cast<const char*>(values), count * sizeof(float)});  // raw_data
  return tensor;
}

// Returns a tensor (batch x size) as an input or output of the graph.
ProtobufWriter ValueMessage(const std::string& name, int size) {
  ProtobufWriter batch, columns, shape, tensor, type, value;
  batch.Bytes(2, "batch");                               // dim_param
  columns.Integer(1, static_cast<std::uint64_t>(size));  // dim_value
  shape.Message(1, batch);                               // dim
  shape.Message(1, columns);
  tensor.Integer(1, kTensorFloat);  // elem_type
  tensor.Message(2, shape);         // shape
  type.Message(1, tensor);          // tensor_type
  value.Bytes(1, name);             // name
  value.Message(2, type);           // type
  return value;
}

// A graph of a chain of operators, each of which takes the previous output first.
class OnnxGraph {
 public:
  OnnxGraph() : last_(kInputName) {}

  void AddTensor(const std::string& name, const std::vector<int>& dimensions, const float* values,
                 size_t count) {
    graph_.Message(5, TensorMessage(name, dimensions, values, count));  // initializer
  }

  void AddOperator(const std::string& type, const std::string& output,
                   const std::vector<std::string>& other_inputs = {},
                   const std::vector<ProtobufWriter>& attributes = {}) {
    ProtobufWriter node;
    node.Bytes(1, last_);                                                           // input
    for (const std::string& input : other_inputs) node.Bytes(1, input);             // input
    node.Bytes(2, output);                                                          // output
    node.Bytes(3, output + "_node");                                                // name
    node.Bytes(4, type);                                                            // op_type
    for (const ProtobufWriter& attribute : attributes) node.Message(5, attribute);  // attribute
    graph_.Message(1, node);
    last_ = output;
  }

  ProtobufWriter Finish(const Policy& policy) {
    graph_.Bytes(2, "policy");                                                // name
    graph_.Message(11, ValueMessage(kInputName, policy.observation_size()));  // input
    graph_.Message(12, ValueMessage(kOutputName, policy.action_size()));      // output
    return graph_;
  }

 private:
  ProtobufWriter graph_;
  std::string last_;
};

ProtobufWriter FloatAttribute(const std::string& name, float value) {
  ProtobufWriter attribute;
  attribute.Bytes(1, name);                // name
  attribute.Float(2, value);               // f
  attribute.Integer(20, kAttributeFloat);  // type
  return attribute;
}

void AddClip(float limit, const std::string& output, OnnxGraph* graph) {
  graph->AddOperator("Clip", output, {},
                     {FloatAttribute("min", -limit), FloatAttribute("max", limit)});
}

void AddScaling(const ObservationScale& scale, OnnxGraph* graph) {
  const int size = static_cast<int>(scale.mean().size());
  graph->AddTensor("mean", {1, size}, scale.mean().data(), static_cast<size_t>(size));
  graph->AddTensor("factor", {1, size}, scale.factor().data(), static_cast<size_t>(size));
  graph->AddOperator("Sub", "centred", {"mean"});
  graph->AddOperator("Mul", "scaled", {"factor"});
  AddClip(ObservationScale::kLimit, "clipped", graph);
}

void AddNetwork(const Mlp& network, OnnxGraph* graph) {
  ProtobufWriter transpose;
  transpose.Bytes(1, "transB");              // name
  transpose.Integer(3, 1);                   // i
  transpose.Integer(20, kAttributeInteger);  // type
  for (size_t i = 0; i < network.layers().size(); ++i) {
    const Mlp::Layer& layer = network.layers()[i];
    const std::string number = std::to_string(i);
    const Rows weights = layer.weights.transpose();  // (outputs x inputs), as PyTorch exports it
    graph->AddTensor("weights_" + number,
                     {static_cast<int>(weights.rows()), static_cast<int>(weights.cols())},
                     weights.data(), static_cast<size_t>(weights.size()));
    graph->AddTensor("bias_" + number, {static_cast<int>(layer.bias.size())}, layer.bias.data(),
                     static_cast<size_t>(layer.bias.size()));
    graph->AddOperator("Gemm", "layer_" + number, {"weights_" + number, "bias_" + number},
                       {transpose});
    if (i + 1 == network.layers().size()) break;
    if (network.activation() == Activation::kTanh) {
      graph->AddOperator("Tanh", "active_" + number);
    } else {
      graph->AddOperator("Elu", "active_" + number, {}, {FloatAttribute("alpha", 1.0f)});
    }
  }
}

}  // namespace

std::string OnnxModel(const Policy& policy, const Metadata& metadata) {
  OnnxGraph graph;
  AddScaling(policy.scale(), &graph);
  AddNetwork(policy.actor(), &graph);
  AddClip(1.0f, kOutputName, &graph);

  ProtobufWriter model, operators;
  model.Integer(1, kIrVersion);            // ir_version
  model.Bytes(2, "simwright");             // producer_name
  model.Message(7, graph.Finish(policy));  // graph
  operators.Bytes(1, "");                  // domain
  operators.Integer(2, kOperatorSet);      // version
  model.Message(8, operators);             // opset_import
  for (const auto& [key, value] : metadata) {
    ProtobufWriter entry;
    entry.Bytes(1, key);
    entry.Bytes(2, value);
    model.Message(14, entry);  // metadata_props
  }
  return model.bytes();
}

void WriteOnnx(const Policy& policy, const Metadata& metadata, const std::filesystem::path& path) {
  core::WriteFile(path, OnnxModel(policy, metadata));
}

}  // namespace simwright::rl
