#include "tasks/language/api_listing.h"

#include <sstream>

namespace simwright::tasks {
namespace {

constexpr const char* kTensorExpressions[] = {"torch.norm(x, dim=-1)",
                                              "torch.abs(a)",
                                              "torch.exp(-a)",
                                              "torch.tanh(a)",
                                              "torch.clamp(a, min=0.0, max=1.0)",
                                              "torch.minimum(a, b)",
                                              "torch.maximum(a, b)",
                                              "torch.where(a > b, a, b)",
                                              "torch.logical_and(a > 0, b > 0)",
                                              "torch.logical_or(a > 0, b > 0)",
                                              "torch.logical_not(a > 0)",
                                              "(a > b).float()",
                                              "torch.zeros_like(a)",
                                              "torch.stack([a, b], dim=-1)",
                                              "torch.sum(x * x, dim=-1)",
                                              "x[:, 2]"};

std::string ResultText(const reward::ApiFunction& function) {
  switch (function.result) {
    case reward::ApiResult::kVector:
      return function.width == 1 ? "[N]" : "[N, " + std::to_string(function.width) + "]";
    case reward::ApiResult::kFlag:
    case reward::ApiResult::kInsideBox:
      return "[N], true or false";
    case reward::ApiResult::kLimits:
      return "{\"lower\": number, \"upper\": number}";
    case reward::ApiResult::kLimitPair:
      return "(lower, upper), two numbers";
    case reward::ApiResult::kLower:
      return "a number, the lower limit";
    case reward::ApiResult::kUpper:
      return "a number, the upper limit";
    case reward::ApiResult::kBox:
      return "(low [N, 3], high [N, 3])";
    case reward::ApiResult::kPose:
      return "(position [N, 3], orientation [N, 4])";
    case reward::ApiResult::kDistance:
      return "[N]";
  }
  return "";
}

std::string ArgumentName(const std::string& kind) {
  return kind == "point" || kind == "low" || kind == "high" ? kind : kind + "_name";
}

}  // namespace

std::string ApiCall(const reward::ApiFunction& function) {
  std::string call = "env." + std::string(function.names.substr(0, function.names.find(' '))) + "(";
  std::istringstream arguments{std::string(function.arguments)};
  std::string kind, before, closing;
  for (bool first = true; arguments >> kind; first = false) {
    std::string name = kind;
    if (name.ends_with("?")) {
      name.pop_back();
      call += "[";
      closing += "]";
    }
    call += (first ? "" : ", ") + ArgumentName(name) + (kind == before ? "_2" : "");
    before = kind;
  }
  return call + closing + ")";
}

std::string ApiListing() {
  std::string listing;
  for (const reward::ApiFunction& function : reward::EnvironmentApi()) {
    listing += ApiCall(function) + "  # " + ResultText(function);
    listing += ": " + std::string(function.document) + "\n";
  }
  return listing;
}

std::span<const char* const> TensorExpressions() {
  return kTensorExpressions;
}

}  // namespace simwright::tasks
