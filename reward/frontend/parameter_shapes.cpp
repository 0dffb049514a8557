#include "reward/frontend/parameter_shapes.h"

#include <algorithm>
#include <map>

#include "reward/frontend/parameter_usage.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

bool ContainsName(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

// Returns true for names of tensors with one number per joint or action, a width that no name
// determines.
bool OfJoints(const std::string& name) {
  return ContainsName(name, {"dof", "joint", "action", "torque"});
}

std::vector<int> GuessByName(const std::string& name) {
  if (ContainsName(name, {"cart_", "pole_", "height", "dist", "speed", "angle_"})) return {};
  if (ContainsName(name, {"quat", "_rot", "orient", "rotation"})) return {4};
  if (ContainsName(name, {"root_state"})) return {13};
  if (OfJoints(name)) return {8};
  if (ContainsName(name,
                   {"pos", "vel", "vec", "axis", "up", "heading", "target", "point", "goal"})) {
    return {3};
  }
  return {};
}

// Returns true for names of positions and rotations, which are not single numbers even if that
// would compile; cart_pos and dof_pos are, or may be.
bool IsVector(const std::string& name) {
  if (ContainsName(name,
                   {"cart", "pole", "dof", "joint", "slider", "door", "drawer", "lever", "hinge"}))
    return false;
  if (name.starts_with("x_") || name.starts_with("y_") || name.starts_with("z_")) return false;
  return ContainsName(name, {"quat", "orient", "_pos", "position"}) || name == "pos";
}

std::vector<int> InitialShape(const std::string& name, const Usage& usage) {
  std::vector<int> guess = GuessByName(name);
  if (usage.rank > 0 && guess.empty()) guess = {3};
  if (usage.rank > 1) guess = {4, 3};
  if (!guess.empty() && usage.width > guess.back()) guess.back() = usage.width;
  return guess;
}

bool Before(Position a, Position b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

// The extent to which the program compiles with these shapes: whole, or up to the position of the
// first error.
struct Reach {
  bool whole = false;
  bool by_shape = false;  // another shape may fix the error
  bool by_type = false;   // a flag type may fix it
  Position position;
  bool operator>(const Reach& other) const {
    if (whole != other.whole) return whole;
    if (position.line != other.position.line) return position.line > other.position.line;
    return position.column > other.position.column;
  }
};

constexpr std::string_view kShapeFaults[] = {
    "shape", "dimension",  "index",       "two-batches", "unpack",        "einsum",
    "loop",  "bad-reward", "bad-success", "condition",   "shared-reward", "too-large"};

// The maximum number of compilation attempts for one program.
constexpr int kMostAttempts = 200;

// A greedy search for parameter shapes.
class Search {
 public:
  Search(const Module& module, const Function& entry, const RewardScene* scene,
         const RewardOptions& start)
      : module_(module), entry_(entry), scene_(scene), options_(start), best_(Try(start)) {}

  const RewardOptions& options() const { return options_; }
  bool Done() const {
    return best_.whole || !(best_.by_shape || best_.by_type) || attempts_ >= kMostAttempts;
  }
  bool by_shape() const { return best_.by_shape; }
  bool by_type() const { return best_.by_type; }
  bool whole() const { return best_.whole; }

  Reach Try(const RewardOptions& options) {
    ++attempts_;
    RewardOptions until_first = options;
    until_first.max_findings = 1;
    Elaborator elaborator(module_, scene_, until_first);
    elaborator.Run(entry_);
    const std::string& code = elaborator.first_code();
    Reach reach;
    reach.position = elaborator.first_error();
    reach.whole = code.empty();
    const Position collapse = elaborator.first_collapse();
    const bool collapses = collapse.line > 0 && (reach.whole || Before(collapse, reach.position));
    if (collapses) {
      reach.whole = false;
      reach.position = collapse;
      reach.by_shape = true;
      return reach;
    }
    reach.by_shape =
        std::find(std::begin(kShapeFaults), std::end(kShapeFaults), code) != std::end(kShapeFaults);
    reach.by_type = code == "type" || code == "index";
    return reach;
  }

  // Keeps `changed` if the program compiles further with it.
  bool Improve(const RewardOptions& changed) {
    if (Done()) return false;
    const Reach reach = Try(changed);
    if (!(reach > best_)) return false;
    best_ = reach;
    options_ = changed;
    return true;
  }

 private:
  const Module& module_;
  const Function& entry_;
  const RewardScene* scene_;
  RewardOptions options_;
  int attempts_ = 0;
  Reach best_;
};

bool TryFlags(const std::vector<std::string>& open, Search* search) {
  bool better = false;
  for (const std::string& name : open) {
    RewardOptions changed = search->options();
    if (!search->by_type() || !changed.flag_parameters.insert(name).second) continue;
    if (search->Improve(changed)) {
      better = true;
      continue;
    }
    changed.parameter_shapes[name] = {};
    better = search->Improve(changed) || better;
  }
  return better;
}

bool TryShapes(const std::vector<std::string>& open,
               const std::vector<std::vector<int>>& candidates,
               std::map<std::string, Usage>* usages, Search* search) {
  bool better = false;
  for (const std::string& name : open) {
    std::vector<std::vector<int>> own = candidates;
    if ((*usages)[name].width > 0) own.push_back({(*usages)[name].width});
    for (const std::vector<int>& candidate : own) {
      if (!search->by_shape()) return better;
      // Actions and joints are vectors, unless they are indexed otherwise.
      if (OfJoints(name) && candidate.size() > 1 && (*usages)[name].rank < 2) continue;
      if (IsVector(name) && (candidate.empty() || candidate == std::vector<int>{1})) continue;
      RewardOptions changed = search->options();
      changed.parameter_shapes[name] = candidate;
      better = search->Improve(changed) || better;
    }
  }
  return better;
}

// Tries widths for all joint-related parameters together, since they share one width.
bool TryWidthOfJoints(const std::vector<std::string>& open, const std::set<int>& widths,
                      Search* search) {
  bool better = false;
  for (const int width : widths) {
    RewardOptions changed = search->options();
    for (const std::string& name : open) {
      std::vector<int>& shape = changed.parameter_shapes[name];
      if (OfJoints(name) && shape.size() == 1) shape = {width};
    }
    better = (search->by_shape() && search->Improve(changed)) || better;
  }
  return better;
}

// Tries one number per environment for all parameters of a common shape together: cart_pos,
// cart_vel.
bool TryNumbers(const std::vector<std::string>& open, Search* search) {
  bool better = false;
  std::set<std::vector<int>> shapes;
  for (const std::string& name : open) shapes.insert(search->options().parameter_shapes.at(name));
  for (const std::vector<int>& shape : shapes) {
    RewardOptions changed = search->options();
    for (const std::string& name : open) {
      if (changed.parameter_shapes[name] == shape && !IsVector(name)) {
        changed.parameter_shapes[name] = {};
      }
    }
    better = (!shape.empty() && search->by_shape() && search->Improve(changed)) || better;
  }
  return better;
}

// Returns the parameters with a guessed joint width that compile as well with one more, alone or
// together.
std::vector<std::string> Assumed(const std::vector<std::string>& open, Search* search) {
  std::vector<std::string> assumed;
  RewardOptions together = search->options();
  for (const std::string& name : open) {
    std::vector<int>& shape = together.parameter_shapes[name];
    if (!OfJoints(name) || shape.size() != 1) continue;
    ++shape[0];
    RewardOptions changed = search->options();
    ++changed.parameter_shapes[name][0];
    if (search->Try(changed).whole) assumed.push_back(name);
  }
  if (!search->Try(together).whole) return assumed;
  assumed.clear();
  for (const std::string& name : open) {
    if (together.parameter_shapes[name] != search->options().parameter_shapes.at(name)) {
      assumed.push_back(name);
    }
  }
  return assumed;
}

std::vector<std::string> OpenParameters(const Function& entry, const RewardOptions& options) {
  std::vector<std::string> open;
  for (const Parameter& parameter : entry.parameters) {
    const std::string& name = parameter.name;
    if (name == "env" || name == "self" || name == "envs" || name == "simulator") continue;
    const bool tensor = parameter.initial == nullptr && IsTensorType(AnnotatedType(parameter));
    if (tensor && !options.parameter_shapes.contains(name)) open.push_back(name);
  }
  return open;
}

}  // namespace

std::vector<const Parameter*> InferParameterShapes(const Module& module, const Function& entry,
                                                   const RewardScene* scene,
                                                   RewardOptions* options) {
  std::vector<std::string> open = OpenParameters(entry, *options);
  if (open.empty()) return {};
  std::map<std::string, Usage> usages;
  for (const std::string& name : open) usages[name];
  CollectUsages(entry.body, &usages);
  for (const std::string& name : open) {
    options->parameter_shapes[name] = InitialShape(name, usages[name]);
  }
  // Parameters whose names determine no shape come first.
  const auto named = std::stable_partition(
      open.begin(), open.end(), [](const std::string& name) { return GuessByName(name).empty(); });
  const std::vector<std::string> unnamed(open.begin(), named);
  const std::set<int> lengths = ListLengths(module);
  std::vector<std::vector<int>> candidates = {{3}, {4}, {}, {1}, {7}, {13}, {8}, {6}, {4, 3}};
  for (const int length : lengths) candidates.push_back({length});
  Search search(module, entry, scene, *options);
  // Changes one parameter at a time, as long as the program compiles further.
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds && !search.Done(); ++round) {
    bool better = TryFlags(open, &search);
    better = TryWidthOfJoints(open, lengths, &search) || better;
    better = TryShapes(unnamed, candidates, &usages, &search) || better;
    if (!better) break;
  }
  *options = search.options();
  // A shape that a name suggests is given up only if the program then compiles: otherwise a shape
  // error would be reported elsewhere, or not at all.
  for (int round = 0; round < kRounds && !search.Done(); ++round) {
    bool better = TryNumbers(open, &search);
    better = TryFlags(open, &search) || better;
    better = TryShapes(open, candidates, &usages, &search) || better;
    if (!better) break;
  }
  if (search.whole()) *options = search.options();
  std::vector<const Parameter*> assumed;
  if (!search.whole()) return assumed;
  const std::vector<std::string> names = Assumed(open, &search);
  for (const Parameter& parameter : entry.parameters) {
    if (std::find(names.begin(), names.end(), parameter.name) != names.end()) {
      assumed.push_back(&parameter);
    }
  }
  return assumed;
}

}  // namespace simwright::reward
