#include <algorithm>

#include "reward/frontend/parameter_usage.h"
#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

// Returns true if published programs use the keyword for this argument.
bool KeywordMeans(std::string_view argument, const std::string& keyword) {
  if (keyword == argument) return true;
  if (argument == "asset") {
    return keyword == "asset_name" || keyword == "object_name" || keyword == "name";
  }
  if (argument == "link") return keyword == "link_name" || keyword == "custom_link_name";
  if (argument == "joint") return keyword == "joint_name" || keyword == "custom_joint_name";
  if (argument == "low") return keyword == "bbox_min" || keyword == "min_aabb";
  if (argument == "high") return keyword == "bbox_max" || keyword == "max_aabb";
  return argument == "point" && (keyword == "pos" || keyword == "position");
}

struct ApiParameter {
  std::string_view name;
  bool optional;
};

std::vector<ApiParameter> SplitApi(std::string_view text) {
  std::vector<ApiParameter> parameters;
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    std::string_view word = text.substr(0, blank);
    text = blank == std::string_view::npos ? "" : text.substr(blank + 1);
    const bool optional = word.ends_with('?');
    if (optional) word.remove_suffix(1);
    parameters.push_back({word, optional});
  }
  return parameters;
}

bool SameIgnoringCase(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

// Returns the name as the scene spells it; empty if the scene does not have it.
std::string SceneName(const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  const auto found = std::find_if(known.begin(), known.end(), [&](const std::string& other) {
    return SameIgnoringCase(name, other);
  });
  return found == known.end() ? "" : *found;
}

}  // namespace

struct Elaborator::ApiArguments {
  bool batched = true;
  std::string asset, link, joint;
  Position asset_at, link_at, joint_at;
  std::vector<std::pair<Value, Position>> tensors;  // point, low, high
  const RewardJoint* scene_joint = nullptr;
};

Elaborator::ApiArguments Elaborator::BindApi(const ApiFunction& function, const Value& callee,
                                             const std::vector<Value>& values,
                                             const std::vector<std::string>& keywords,
                                             const std::vector<Position>& places,
                                             Position position) {
  const std::vector<ApiParameter> parameters = SplitApi(function.arguments);
  ApiArguments bound;
  bound.batched = callee.integer == 1;
  std::vector<bool> given(parameters.size(), false);
  std::size_t next = 0;
  std::size_t first = 0;
  if (!bound.batched) {
    if (values.empty() || !values[0].Is(ValueKind::kEnvironment)) {
      Fail("arguments", position,
           "'" + callee.text + "' is handed the environment first: " + callee.text +
               "(env, ...), or call it on it: env." + callee.text + "(...)");
    }
    first = 1;
  }
  for (std::size_t i = first; i < values.size(); ++i) {
    std::size_t at = next;
    if (!keywords[i].empty()) {
      at = 0;
      while (at < parameters.size() && !KeywordMeans(parameters[at].name, keywords[i])) ++at;
    } else {
      ++next;
    }
    if (at >= parameters.size()) {
      Fail("arguments", places[i],
           "'" + callee.text + "' takes " +
               (parameters.empty() ? "no arguments" : "(" + std::string(function.arguments) + ")"));
    }
    given[at] = true;
    const std::string_view name = parameters[at].name;
    if (name == "point" || name == "low" || name == "high") {
      bound.tensors.emplace_back(values[i], places[i]);
      continue;
    }
    if (!values[i].Is(ValueKind::kString)) {
      if (values[i].Is(ValueKind::kUndefined)) math_.FromValue(values[i], places[i]);
      Fail("arguments", places[i],
           "the " + std::string(name) + " is named by a string, this is " + Describe(values[i]));
    }
    (name == "asset" ? bound.asset : name == "link" ? bound.link : bound.joint) = values[i].text;
    (name == "asset"  ? bound.asset_at
     : name == "link" ? bound.link_at
                      : bound.joint_at) = places[i];
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (given[i] || parameters[i].optional) continue;
    Fail("arguments", position,
         "'" + callee.text + "' lacks its argument '" + std::string(parameters[i].name) + "'");
  }
  return bound;
}

void Elaborator::CheckNames(const ApiFunction& function, ApiArguments* arguments) {
  if (scene_ == nullptr || arguments->asset.empty()) return;
  std::vector<std::string> names;
  for (const RewardAsset& asset : scene_->assets) names.push_back(asset.name);
  const std::string asset_name = SceneName(arguments->asset, names);
  if (asset_name.empty()) {
    Fail("unknown-asset", arguments->asset_at,
         "there is no asset '" + arguments->asset + "'" + Suggestion(arguments->asset, names));
  }
  arguments->asset = asset_name;
  const auto asset = std::find_if(scene_->assets.begin(), scene_->assets.end(),
                                  [&](const RewardAsset& one) { return one.name == asset_name; });
  if (!arguments->link.empty()) {
    const std::string link = SceneName(arguments->link, asset->links);
    if (link.empty()) {
      Fail("unknown-link", arguments->link_at,
           "'" + asset_name + "' has no link '" + arguments->link + "'" +
               Suggestion(arguments->link, asset->links));
    }
    arguments->link = link;
  }
  if (arguments->joint.empty()) return;
  names.clear();
  for (const RewardJoint& joint : asset->joints) names.push_back(joint.name);
  const std::string joint = SceneName(arguments->joint, names);
  if (joint.empty()) {
    Fail("unknown-joint", arguments->joint_at,
         "'" + asset_name + "' has no joint '" + arguments->joint + "'" +
             Suggestion(arguments->joint, names));
  }
  arguments->joint = joint;
  arguments->scene_joint =
      &*std::find_if(asset->joints.begin(), asset->joints.end(),
                     [&](const RewardJoint& one) { return one.name == joint; });
  if (arguments->scene_joint->type == RewardJointType::kFixed &&
      (function.input == RewardInput::kJointState || function.input == RewardInput::kJointLower)) {
    Report("fixed-joint", core::Severity::kWarning, arguments->joint_at,
           "joint '" + joint + "' of '" + asset_name + "' is fixed: it never moves");
  }
}

int Elaborator::AddSlot(RewardSlot slot) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].input == slot.input && slots_[i].asset == slot.asset &&
        slots_[i].part == slot.part) {
      return static_cast<int>(i);
    }
  }
  slots_.push_back(std::move(slot));
  const int added = static_cast<int>(slots_.size()) - 1;
  slot_inputs_.push_back(static_cast<int>(inputs_.size()));
  for (int i = 0; i < slots_.back().width; ++i) inputs_.emplace_back(added, i);
  return added;
}

Value Elaborator::SlotValue(RewardInput input, const std::string& asset, const std::string& part,
                            const Shape& shape, DataType type, bool uniform, Position position) {
  if (LaneCount(shape) > options_.max_lanes) math_.Full(type, shape, -1, position);  // throws
  RewardSlot slot;
  slot.input = input;
  slot.asset = asset;
  slot.part = part;
  slot.width = static_cast<int>(LaneCount(shape));
  slot.shape = ShapeText(shape);
  slot.flags = input == RewardInput::kParameter && type == DataType::kBool;
  if (slot.flags && !uniform) slot.shape += " flags";
  slot.uniform = uniform;
  const int index = AddSlot(std::move(slot));
  std::vector<NodeId> nodes;
  for (int i = 0; i < slots_[index].width; ++i) {
    nodes.push_back(graph_.Input(slot_inputs_[index] + i, uniform));
  }
  return TensorValue(math_.Make(type, shape, std::move(nodes), position));
}

Value Elaborator::JointLimit(const ApiArguments& arguments, bool upper) {
  const RewardInput input = upper ? RewardInput::kJointUpper : RewardInput::kJointLower;
  if (scene_ == nullptr) {
    return SlotValue(input, arguments.asset, arguments.joint, {}, DataType::kFloat, true,
                     arguments.joint_at);
  }
  const RewardJoint& joint = *arguments.scene_joint;
  if (joint.type == RewardJointType::kContinuous) {
    Fail("no-limit", arguments.joint_at,
         "joint '" + joint.name + "' turns without end and has no limits; compare with an angle");
  }
  return TensorValue(
      math_.Scalar(DataType::kFloat, graph_.Constant(upper ? joint.upper : joint.lower)));
}

Value Elaborator::ApiGeometry(const ApiFunction& function, const ApiArguments& arguments,
                              Position position) {
  std::vector<Tensor> points;
  for (const auto& [value, place] : arguments.tensors) {
    const Tensor point = math_.FromValue(value, place);
    if (point.shape.empty() || RunsOverEnvironments(point.shape.back())) {
      Fail("shape", place, "a point [N, 3] is wanted here, this is " + Describe(value));
    }
    points.push_back(point);
  }
  std::vector<int> last;
  if (function.result == ApiResult::kDistance) {
    WarnAboutSelfDistance(points[0], points[1], position);
    const Tensor difference =
        math_.Map(ScalarOperation::kSubtract, points[0], points[1], DataType::kFloat, position);
    const Tensor squares =
        math_.Map(ScalarOperation::kMultiply, difference, difference, DataType::kFloat, position);
    last = {static_cast<int>(squares.shape.size()) - 1};
    const Tensor sum = math_.Reduce(Reduction::kSum, squares, last, false, position);
    return TensorValue(math_.Map(ScalarOperation::kSquareRoot, sum, DataType::kFloat, position));
  }
  const Tensor above =
      math_.Map(ScalarOperation::kLessEqual, points[1], points[0], DataType::kBool, position);
  const Tensor below =
      math_.Map(ScalarOperation::kLessEqual, points[0], points[2], DataType::kBool, position);
  const Tensor inside = math_.Map(ScalarOperation::kAnd, above, below, DataType::kBool, position);
  last = {static_cast<int>(inside.shape.size()) - 1};
  return TensorValue(math_.Reduce(Reduction::kAll, inside, last, false, position));
}

Value Elaborator::ApiValue(const ApiFunction& function, const ApiArguments& arguments,
                           Position position) {
  const auto shape = [&](int width) {
    Shape sizes;
    if (arguments.batched) sizes.push_back(kBatch);
    if (width > 1) sizes.push_back(width);
    return sizes;
  };
  const std::string& part = arguments.link.empty() ? arguments.joint : arguments.link;
  const auto read = [&](RewardInput input, int width, DataType type) {
    return SlotValue(input, arguments.asset, part, shape(width), type, false, position);
  };
  switch (function.result) {
    case ApiResult::kVector:
      if (function.input >= RewardInput::kGripperPosition &&
          function.input <= RewardInput::kGripperOpening) {
        return SlotValue(function.input, "", "", shape(function.width), DataType::kFloat, false,
                         position);
      }
      return read(function.input, function.width, DataType::kFloat);
    case ApiResult::kFlag:
      return read(function.input, function.width, DataType::kBool);
    case ApiResult::kLower:
      return JointLimit(arguments, false);
    case ApiResult::kUpper:
      return JointLimit(arguments, true);
    case ApiResult::kLimits:
    case ApiResult::kLimitPair: {
      Value pair = TupleValue({JointLimit(arguments, false), JointLimit(arguments, true)});
      pair.field_names = std::make_shared<const std::vector<std::string>>(
          std::vector<std::string>{"lower", "upper"});
      return pair;
    }
    case ApiResult::kPose:
      return TupleValue({SlotValue(RewardInput::kGripperPosition, "", "", shape(3),
                                   DataType::kFloat, false, position),
                         SlotValue(RewardInput::kGripperOrientation, "", "", shape(4),
                                   DataType::kFloat, false, position)});
    case ApiResult::kBox: {
      const Value box = read(function.input, function.width, DataType::kFloat);
      const int last = static_cast<int>(box.tensor->shape.size()) - 1;
      return TupleValue({TensorValue(math_.Slice(*box.tensor, last, 0, 3, 1)),
                         TensorValue(math_.Slice(*box.tensor, last, 3, 6, 1))});
    }
    case ApiResult::kInsideBox:
    case ApiResult::kDistance:
      return ApiGeometry(function, arguments, position);
  }
  return Value{};
}

Value Elaborator::CallApi(const Value& callee, const std::vector<Value>& values,
                          const std::vector<std::string>& keywords,
                          const std::vector<Position>& places, Position position) {
  const ApiFunction& function = *FindApiFunction(callee.text);
  ApiArguments arguments = BindApi(function, callee, values, keywords, places, position);
  CheckNames(function, &arguments);
  return ApiValue(function, arguments, position);
}

Value Elaborator::ParameterValue(const Parameter& parameter) {
  if (IsEnvironmentName(parameter.name)) {
    return PlainValue(ValueKind::kEnvironment, parameter.name);
  }
  if (parameter.initial != nullptr) return GlobalValue(*parameter.initial);
  const std::string type = AnnotatedType(parameter);
  if (type == "float" || type == "int" || type == "bool") {
    const DataType number = type == "float" ? DataType::kFloat
                            : type == "int" ? DataType::kInteger
                                            : DataType::kBool;
    return SlotValue(RewardInput::kParameter, "", parameter.name, {}, number, true,
                     parameter.position);
  }
  if (!IsTensorType(type)) {
    Fail("bad-parameter", parameter.position,
         "the parameter '" + parameter.name + "' is annotated '" + type +
             "'; a reward is handed the environment, tensors, and numbers (float, int, bool)");
  }
  Shape shape = {kBatch};
  const auto given = options_.parameter_shapes.find(parameter.name);
  if (given != options_.parameter_shapes.end()) {
    shape.insert(shape.end(), given->second.begin(), given->second.end());
  }
  const bool flags = type == "BoolTensor" || options_.flag_parameters.contains(parameter.name);
  const DataType held = flags                                         ? DataType::kBool
                        : type == "LongTensor" || type == "IntTensor" ? DataType::kInteger
                                                                      : DataType::kFloat;
  return SlotValue(RewardInput::kParameter, "", parameter.name, shape, held, false,
                   parameter.position);
}

}  // namespace simwright::reward
