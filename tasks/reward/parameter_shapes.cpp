#include "tasks/reward/parameter_shapes.h"

#include <algorithm>
#include <functional>
#include <map>

#include "tasks/reward/elaborator.h"

namespace simwright::tasks::reward {
namespace {

using Shapes = std::map<std::string, std::vector<int>>;

void EachExpression(const Expression& expression,
                    const std::function<void(const Expression&)>& visit) {
  visit(expression);
  for (const ExpressionPtr& child : expression.children) {
    if (child != nullptr) EachExpression(*child, visit);
  }
}

void EachExpression(const Block& block, const std::function<void(const Expression&)>& visit) {
  for (const auto& statement : block) {
    for (const ExpressionPtr& target : statement->targets) EachExpression(*target, visit);
    if (statement->value != nullptr) EachExpression(*statement->value, visit);
    for (const Block& inner : statement->blocks) EachExpression(inner, visit);
  }
}

// What the indices of x[...] say: the least width that the last dimension has to have.
struct Usage {
  int width = 0;  // 0: unknown
  bool exact = false;
  int rank = 0;  // trailing dimensions seen in an index
};

void NoteIndex(const Expression& index, Usage* usage) {
  std::vector<const Expression*> parts;
  if (index.kind == ExpressionKind::kTuple) {
    for (const ExpressionPtr& child : index.children) parts.push_back(child.get());
  } else {
    parts.push_back(&index);
  }
  if (parts.size() < 2) return;
  const bool ellipsis = parts[0]->kind == ExpressionKind::kEllipsis;
  int named = 0;
  for (const Expression* part : parts) {
    if (part->kind != ExpressionKind::kNone && part->kind != ExpressionKind::kEllipsis) ++named;
  }
  usage->rank = std::max(usage->rank, ellipsis ? 1 : named - 1);
  const Expression& last = *parts.back();
  int width = 0;
  if (last.kind == ExpressionKind::kInteger) {
    width = static_cast<int>(std::min<std::int64_t>(last.integer, 1024)) + 1;
  }
  if (last.kind == ExpressionKind::kSlice && last.children[1] != nullptr &&
      last.children[1]->kind == ExpressionKind::kInteger) {
    width = static_cast<int>(std::min<std::int64_t>(last.children[1]->integer, 1024));
  }
  if (last.kind == ExpressionKind::kList) {
    for (const ExpressionPtr& child : last.children) {
      if (child->kind != ExpressionKind::kInteger) continue;
      width = std::max(width, static_cast<int>(std::min<std::int64_t>(child->integer, 1024)) + 1);
    }
  }
  if (width > 0 && width < 1024) usage->width = std::max(usage->width, width);
}

bool Contains(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

std::vector<int> GuessByName(const std::string& name) {
  if (Contains(name, {"quat", "_rot", "orient", "rotation"})) return {4};
  if (Contains(name, {"root_state"})) return {13};
  if (Contains(name, {"dof", "joint", "action", "torque"})) return {8};
  if (Contains(name, {"pos", "vel", "vec", "axis", "up", "heading", "target", "point", "goal"})) {
    return {3};
  }
  return {};
}

std::vector<int> FirstGuess(const std::string& name, const Usage& usage) {
  std::vector<int> guess = GuessByName(name);
  if (usage.rank > 0 && guess.empty()) guess = {3};
  if (usage.rank > 1) guess = {4, 3};
  if (!guess.empty() && usage.width > guess.back()) guess.back() = usage.width;
  return guess;
}

// How far the program comes with these shapes: no error, or the place of the first one.
struct Reach {
  bool whole = false;
  bool by_shape = false;  // another shape may mend what is wrong
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

// What a program may cost to guess at, in attempts.
constexpr int kMostAttempts = 150;

Reach Try(const Module& module, const Function& entry, const RewardScene* scene,
          const RewardOptions& options) {
  RewardOptions until_first = options;
  until_first.max_findings = 1;
  Elaborator elaborator(module, scene, until_first);
  elaborator.Run(entry);
  Reach reach;
  reach.position = elaborator.first_error();
  reach.whole = elaborator.first_code().empty();
  reach.by_shape = std::find(std::begin(kShapeFaults), std::end(kShapeFaults),
                             elaborator.first_code()) != std::end(kShapeFaults);
  return reach;
}

bool IsTensor(const Parameter& parameter) {
  if (parameter.annotation == nullptr) return true;
  const std::string& type = parameter.annotation->text;
  return type == "Tensor" || type == "ndarray" || type == "FloatTensor" || type.empty();
}

}  // namespace

std::set<std::string> CalledNames(const Module& module) {
  std::set<std::string> names;
  for (const auto& function : module.functions) {
    EachExpression(function->body, [&](const Expression& expression) {
      if (expression.kind == ExpressionKind::kCall && !expression.children[0]->text.empty() &&
          expression.children[0]->text != function->name) {
        names.insert(expression.children[0]->text);
      }
    });
  }
  return names;
}

void InferParameterShapes(const Module& module, const Function& entry, const RewardScene* scene,
                          RewardOptions* options) {
  std::vector<std::string> open;
  std::map<std::string, Usage> usages;
  for (const Parameter& parameter : entry.parameters) {
    const std::string& name = parameter.name;
    if (name == "env" || name == "self" || name == "envs" || name == "simulator") continue;
    if (!IsTensor(parameter) || options->parameter_shapes.contains(name)) continue;
    open.push_back(name);
    usages[name];
  }
  if (open.empty()) return;
  EachExpression(entry.body, [&](const Expression& expression) {
    if (expression.kind != ExpressionKind::kSubscript ||
        expression.children[0]->kind != ExpressionKind::kName) {
      return;
    }
    const auto found = usages.find(expression.children[0]->text);
    if (found != usages.end()) NoteIndex(*expression.children[1], &found->second);
  });
  for (const std::string& name : open) {
    options->parameter_shapes[name] = FirstGuess(name, usages[name]);
  }
  // First those of which the name says nothing.
  std::stable_partition(open.begin(), open.end(),
                        [](const std::string& name) { return GuessByName(name).empty(); });
  Reach best = Try(module, entry, scene, *options);
  int attempts = 0;
  // One parameter at a time, as long as something gets further.
  for (int round = 0; round < 4 && !best.whole && best.by_shape; ++round) {
    bool better = false;
    for (const std::string& name : open) {
      const std::vector<std::vector<int>> candidates = {
          {3}, {4}, {}, {1}, {7}, {13}, {8}, {6}, {4, 3}, {usages[name].width}};
      for (const std::vector<int>& candidate : candidates) {
        if (candidate == std::vector<int>{0}) continue;
        if (!best.by_shape || ++attempts > kMostAttempts) return;
        RewardOptions changed = *options;
        changed.parameter_shapes[name] = candidate;
        const Reach reach = Try(module, entry, scene, changed);
        if (!(reach > best)) continue;
        best = reach;
        options->parameter_shapes = changed.parameter_shapes;
        better = true;
        if (best.whole) return;
      }
    }
    if (!better) return;
  }
}

}  // namespace simwright::tasks::reward
