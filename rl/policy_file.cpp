#include "rl/policy_file.h"

#include "core/error.h"
#include "rl/metadata_tensor.h"

namespace simwright::rl {
namespace {

constexpr char kPolicyKind[] = "simwright policy 1";  // includes the format's version
constexpr int kMostLayers = 64;

torch::Tensor TensorOf(const Rows& rows, torch::ScalarType type) {
  return torch::from_blob(const_cast<float*>(rows.data()), {rows.rows(), rows.cols()})
      .to(type, false, true);
}

Rows RowsOf(const nn::NamedTensors& tensors, const std::string& name) {
  const auto found = tensors.find(name);
  if (found == tensors.end() || found->second.dim() != 2 || !found->second.is_floating_point() ||
      found->second.numel() > 1 << 28) {
    throw core::Error("has no '" + name + "' of a policy");
  }
  const torch::Tensor values = found->second.to(torch::kFloat).contiguous();
  const Rows rows =
      Eigen::Map<const Rows>(values.data_ptr<float>(), values.size(0), values.size(1));
  if (!rows.allFinite()) throw core::Error("has a '" + name + "' that is not finite");
  return rows;
}

Policy PolicyFrom(const nn::NamedTensors& tensors) {
  const auto kind = tensors.find("kind");
  if (kind == tensors.end()) throw core::Error("is not a policy");
  if (UnpackBytes(kind->second) != kPolicyKind) {
    throw core::Error("is '" + UnpackBytes(kind->second).substr(0, 40) + "', expected '" +
                      kPolicyKind + "'");
  }
  const bool tanh = UnpackBytes(TakeTensor(tensors, "activation", torch::kUInt8, 1)) == "tanh";
  std::vector<Mlp::Layer> layers;
  for (int i = 0; i < kMostLayers && tensors.contains("weights." + std::to_string(i)); ++i) {
    layers.push_back({RowsOf(tensors, "weights." + std::to_string(i)).transpose(),
                      RowsOf(tensors, "bias." + std::to_string(i))});
  }
  const ObservationScale scale(RowsOf(tensors, "observation_mean"),
                               RowsOf(tensors, "observation_factor"));
  return Policy(scale, Mlp(std::move(layers), tanh ? Activation::kTanh : Activation::kElu),
                RowsOf(tensors, "std"),
                UnpackMetadata(TakeTensor(tensors, "facts", torch::kUInt8, 1)));
}

}  // namespace

void WritePolicy(const Policy& policy, const std::filesystem::path& path, Precision precision) {
  const auto type = precision == Precision::kHalf ? torch::kHalf : torch::kFloat;
  nn::NamedTensors tensors;
  tensors["kind"] = PackBytes(kPolicyKind);
  tensors["activation"] =
      PackBytes(policy.actor().activation() == Activation::kTanh ? "tanh" : "elu");
  const std::vector<Mlp::Layer>& layers = policy.actor().layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    tensors["weights." + std::to_string(i)] = TensorOf(layers[i].weights.transpose(), type);
    tensors["bias." + std::to_string(i)] = TensorOf(layers[i].bias, type);
  }
  tensors["observation_mean"] = TensorOf(policy.scale().mean(), torch::kFloat);
  tensors["observation_factor"] = TensorOf(policy.scale().factor(), torch::kFloat);
  tensors["std"] = TensorOf(policy.std(), torch::kFloat);
  tensors["facts"] = PackMetadata(policy.metadata());
  nn::WriteTensors(tensors, path);
}

Policy ReadPolicy(const std::filesystem::path& path) {
  const nn::NamedTensors tensors = nn::ReadTensors(path);
  try {
    return PolicyFrom(tensors);
  } catch (const core::Error& error) {
    throw core::Error(error.what(), path.string(), "train the policy again");
  }
}

}  // namespace simwright::rl
