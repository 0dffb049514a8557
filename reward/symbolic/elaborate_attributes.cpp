#include <cmath>
#include <limits>
#include <map>

#include "reward/frontend/foreign_names.h"
#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

const std::map<std::string, DataType>& NumberTypes() {
  static const auto* types = new std::map<std::string, DataType>{
      {"float", DataType::kFloat},       {"float16", DataType::kFloat},
      {"float32", DataType::kFloat},     {"float64", DataType::kFloat},
      {"double", DataType::kFloat},      {"half", DataType::kFloat},
      {"int", DataType::kInteger},       {"int8", DataType::kInteger},
      {"int16", DataType::kInteger},     {"int32", DataType::kInteger},
      {"int64", DataType::kInteger},     {"long", DataType::kInteger},
      {"bool", DataType::kBool},         {"bool_", DataType::kBool},
      {"FloatTensor", DataType::kFloat}, {"LongTensor", DataType::kInteger},
      {"BoolTensor", DataType::kBool}};
  return *types;
}

Value LibraryValue(const LibraryFunction& function, const std::string& called) {
  Value value = PlainValue(ValueKind::kLibrary, called);
  value.library = &function;
  return value;
}

Value TypeValue(DataType type, const std::string& name) {
  Value value = PlainValue(ValueKind::kType, name);
  value.integer = static_cast<int>(type);
  return value;
}

// Names that torch and numpy have and rewards do not, with their replacements.
struct Missing {
  std::string_view names;  // each surrounded by blanks
  const char* sentence;
};

constexpr Missing kMissing[] = {
    {" nonzero argwhere masked_select unique take ",
     "how many there are differs from state to state; use torch.where(mask, a, b), or reduce "
     "x[mask] with .mean(), .sum(), .max()"},
    {" quantile nanquantile percentile ",
     "order the row with torch.sort(x, dim=-1) and take the element wanted"},
    {" gelu erf erfc ", "a smooth step of the same shape is x * torch.sigmoid(1.702 * x)"},
    {" argsort lexsort searchsorted ", "the sorted numbers are: torch.sort(x, dim=-1).values"},
    {" vmap map_ apply_ vectorize ", "every operation works on all environments at once"},
    {" no_grad inference_mode ", "write it as 'with torch.no_grad():', it changes nothing"},
};

std::string Instead(const std::string& name) {
  for (const Missing& missing : kMissing) {
    if (missing.names.find(" " + name + " ") != std::string_view::npos) {
      return std::string("; ") + missing.sentence;
    }
  }
  return "";
}

std::string AttributeTypeName(DataType type) {
  return type == DataType::kFloat ? "float32" : type == DataType::kBool ? "bool" : "int64";
}

}  // namespace

Value Elaborator::ModuleAttribute(const std::string& module, const std::string& name,
                                  Position position) {
  const std::string full = module + "." + name;
  if (name == "pi") return FloatValue(3.14159265358979323846);
  if (name == "inf" || name == "Inf" || name == "infty") {
    return FloatValue(std::numeric_limits<double>::infinity());
  }
  if (name == "nan" || name == "NaN") return FloatValue(std::numeric_limits<double>::quiet_NaN());
  if (name == "e" && module != "torch") return FloatValue(2.71828182845904523536);
  if (name == "tau" && module == "math") return FloatValue(2.0 * 3.14159265358979323846);
  if (name == "newaxis") return Value{};
  if (IsLibraryModule(full)) return PlainValue(ValueKind::kModule, full);
  if (const LibraryFunction* function = FindLibraryFunction(full)) {
    return LibraryValue(*function, full);
  }
  if (name == "Tensor" || name == "ndarray" || name == "device") {
    return PlainValue(ValueKind::kOpaque, name);
  }
  const auto type = NumberTypes().find(name);
  if (type != NumberTypes().end() && (module == "torch" || module == "np")) {
    return TypeValue(type->second, full);
  }
  if (name.find("rand") != std::string::npos) {
    Fail("random", position, "a reward has no chance in it: '" + full + "' is not offered");
  }
  const std::string instead = Instead(name);
  Fail("undefined", position,
       "'" + full + "' is not offered" +
           (instead.empty() ? Suggestion(name, LibraryNames(module + ".")) : instead));
}

Value Elaborator::EnvironmentAttribute(const Value& environment, const std::string& name,
                                       Position position) {
  if (name == "device" || name == "rl_device" || name == "sim_device") {
    return PlainValue(ValueKind::kOpaque, "device");
  }
  if (name == "num_envs" || name == "env_num") return PlainValue(ValueKind::kBatchSize);
  if (name == "env") return environment;
  const auto function = functions_.find(name);
  if (function != functions_.end()) {
    Value value = PlainValue(ValueKind::kFunction, name);
    value.function = function->second;
    if (!value.function->parameters.empty() && (value.function->parameters[0].name == "self" ||
                                                value.function->parameters[0].name == "env")) {
      value.items = std::make_shared<const std::vector<Value>>(1, environment);
    }
    return value;
  }
  if (FindApiFunction(name) != nullptr) {
    Value value = PlainValue(ValueKind::kApi, name);
    value.integer = 1;
    return value;
  }
  if (IsForeignHandle(name) || !ForeignRemedy(name).empty()) {
    return ForeignAttribute(name, position);
  }
  std::vector<std::string> known = ApiNames();
  for (const char* attribute : {"device", "num_envs", "env_num"}) known.emplace_back(attribute);
  Fail("undefined", position, "the environment has no '" + name + "'" + Suggestion(name, known));
}

// Returns true for an attribute of ManiSkill's own members, such as `self.cube.pose`.
bool Elaborator::IsForeignAttribute(const Expression& expression) const {
  const Expression& member = *expression.children[0];
  if (member.kind != ExpressionKind::kAttribute ||
      member.children[0]->kind != ExpressionKind::kName ||
      !IsEnvironmentName(member.children[0]->text)) {
    return false;
  }
  const bool known = functions_.contains(member.text) || FindApiFunction(member.text) != nullptr ||
                     member.text == "env" || IsForeignHandle(member.text);
  return !known && (IsForeignHandle(expression.text) ||
                    !ForeignRemedy(member.text + "." + expression.text).empty());
}

Value Elaborator::ForeignAttribute(const std::string& path, Position position) {
  const std::string remedy = ForeignRemedy(path);
  if (!remedy.empty()) {
    Fail("foreign-name", position, "the environment has no '" + path + "': " + remedy);
  }
  return PlainValue(ValueKind::kOpaque, std::string(kForeignPrefix) + path);
}

Value Elaborator::SizeValue(int size) {
  if (size == kBatch) return PlainValue(ValueKind::kBatchSize);
  if (!IsSelected(size)) return IntegerValue(size);
  const NodeId count = graph_.Apply(ScalarOperation::kBatchSum, SelectionFlag(size));
  return TensorValue(math_.Scalar(DataType::kInteger, count));
}

Value Elaborator::TensorAttribute(const Value& value, const std::string& name, Position position) {
  const Tensor& tensor = *value.tensor;
  if (name == "shape") {
    std::vector<Value> sizes;
    for (const int size : tensor.shape) sizes.push_back(SizeValue(size));
    return TupleValue(std::move(sizes));
  }
  if (name == "ndim") return IntegerValue(static_cast<std::int64_t>(tensor.shape.size()));
  if (name == "device") return PlainValue(ValueKind::kOpaque, "device");
  if (name == "dtype") return TypeValue(tensor.type, AttributeTypeName(tensor.type));
  if (name == "data") return value;
  if (name == "T" || name == "mT") {
    std::vector<int> order;
    for (std::size_t d = tensor.shape.size(); d-- > 0;) order.push_back(static_cast<int>(d));
    return TensorValue(math_.Permute(tensor, order));
  }
  const LibraryFunction* function = FindLibraryFunction("Tensor." + name);
  if (function == nullptr && name.size() > 1 && name.back() == '_') {  // x.add_(y)
    function = FindLibraryFunction("Tensor." + name.substr(0, name.size() - 1));
  }
  if (function == nullptr) {
    if (name == "backward" || name == "grad") {
      Fail("undefined", position, "a reward has no gradients: '." + name + "' is not offered");
    }
    const std::string instead = Instead(name);
    Fail("undefined", position,
         instead.empty()
             ? "a tensor has no '." + name + "'" + Suggestion(name, LibraryNames("Tensor."))
             : "'." + name + "' is not offered" + instead);
  }
  Value method = LibraryValue(*function, "." + name);
  method.items = std::make_shared<const std::vector<Value>>(1, value);
  return method;
}

Value Elaborator::EvaluateAttribute(const Expression& expression) {
  const std::string& name = expression.text;
  const Position position = expression.position;
  if (IsForeignAttribute(expression)) {
    return ForeignAttribute(expression.children[0]->text + "." + name, position);
  }
  const Value base = Evaluate(*expression.children[0]);
  switch (base.kind) {
    case ValueKind::kModule:
      return ModuleAttribute(base.text, name, position);
    case ValueKind::kEnvironment:
      return EnvironmentAttribute(base, name, position);
    case ValueKind::kTensor:
      return TensorAttribute(base, name, position);
    case ValueKind::kTuple:
      if (base.field_names != nullptr) {
        for (std::size_t i = 0; i < base.field_names->size(); ++i) {
          if ((*base.field_names)[i] == name) return (*base.items)[i];
        }
        Fail("undefined", position, "this has .values and .indices, but no '." + name + "'");
      }
      break;
    case ValueKind::kOpaque:
      if (base.text == "device") return base;
      if (base.text.starts_with(kEntityPrefix)) {  // SceneEntityCfg("cube").name
        return name == "name" ? StringValue(base.text.substr(kEntityPrefix.size()))
                              : PlainValue(ValueKind::kOpaque, "device");
      }
      if (base.text.starts_with(kForeignPrefix)) {
        const std::string path = base.text.substr(kForeignPrefix.size()) + "." + name;
        if (!IsForeignHandle(name) && ForeignRemedy(path).empty()) {
          Fail("foreign-name", position,
               "the environment has no '" + path +
                   "'; what can be read is env.get_position(ASSET), "
                   "env.get_state_by_joint_name(ASSET, JOINT) and others (docs/rewards.md)");
        }
        return ForeignAttribute(path, position);
      }
      Fail("undefined", position, "'" + base.text + "' is not known here");
    case ValueKind::kUndefined:
      Fail(base.text.empty() ? "" : "undefined", position, base.text);
    default:
      break;
  }
  const char* prefix = base.Is(ValueKind::kList)     ? "List."
                       : base.Is(ValueKind::kDict)   ? "Dict."
                       : base.IsNumber()             ? "Number."
                       : base.Is(ValueKind::kString) ? "String."
                                                     : "Tuple.";
  if (const LibraryFunction* function = FindLibraryFunction(prefix + name)) {
    Value method = LibraryValue(*function, "." + name);
    method.items = std::make_shared<const std::vector<Value>>(1, base);
    return method;
  }
  Fail("undefined", position,
       "'." + name + "' is not offered by " + Describe(base) +
           (base.IsNumber() ? ", which is a plain number and no tensor" : ""));
}

}  // namespace simwright::reward
