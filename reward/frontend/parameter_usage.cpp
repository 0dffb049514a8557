#include "reward/frontend/parameter_usage.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace simwright::reward {
namespace {

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
    if (statement->function != nullptr) EachExpression(statement->function->body, visit);
  }
}

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

std::string UsageTypeName(const Expression& annotation) {
  if (annotation.kind == ExpressionKind::kBinary) {
    const std::string left = UsageTypeName(*annotation.children[0]);
    return left == "None" ? UsageTypeName(*annotation.children[1]) : left;
  }
  if (annotation.kind == ExpressionKind::kNone) return "None";
  if (annotation.kind != ExpressionKind::kSubscript) return annotation.text;
  const std::string outer = UsageTypeName(*annotation.children[0]);
  if (outer != "Optional" && outer != "Union") return outer;
  const Expression& inner = *annotation.children[1];
  return inner.kind == ExpressionKind::kTuple && !inner.children.empty()
             ? UsageTypeName(*inner.children[0])
             : UsageTypeName(inner);
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

void CollectUsages(const Block& body, std::map<std::string, Usage>* usages) {
  EachExpression(body, [&](const Expression& expression) {
    if (expression.kind != ExpressionKind::kSubscript ||
        expression.children[0]->kind != ExpressionKind::kName) {
      return;
    }
    const auto found = usages->find(expression.children[0]->text);
    if (found != usages->end()) NoteIndex(*expression.children[1], &found->second);
  });
}

std::set<int> ListLengths(const Module& module) {
  constexpr std::size_t kLongest = 64;
  std::set<int> lengths;
  const auto visit = [&](const Expression& expression) {
    const bool list = expression.kind == ExpressionKind::kList;
    if (!list || expression.children.size() < 2 || expression.children.size() > kLongest) return;
    const bool numbers = std::all_of(
        expression.children.begin(), expression.children.end(), [](const ExpressionPtr& child) {
          return child->kind == ExpressionKind::kInteger || child->kind == ExpressionKind::kFloat ||
                 child->kind == ExpressionKind::kUnary;
        });
    if (numbers) lengths.insert(static_cast<int>(expression.children.size()));
  };
  EachExpression(module.statements, visit);
  for (const auto& function : module.functions) EachExpression(function->body, visit);
  return lengths;
}

std::string AnnotatedType(const Parameter& parameter) {
  const std::string type =
      parameter.annotation == nullptr ? "" : UsageTypeName(*parameter.annotation);
  return type.empty() ? "Tensor" : type;
}

bool IsTensorType(const std::string& type) {
  return type == "ndarray" || type == "array" || type.ends_with("Tensor");
}

}  // namespace simwright::reward
