#include "reward/frontend/local_names.h"

namespace simwright::reward {
namespace {

void AddTarget(const Expression& target, std::set<std::string>* names) {
  if (target.kind == ExpressionKind::kName) names->insert(target.text);
  const bool several = target.kind == ExpressionKind::kTuple ||
                       target.kind == ExpressionKind::kList ||
                       target.kind == ExpressionKind::kStarred;
  if (!several) return;
  for (const ExpressionPtr& child : target.children) AddTarget(*child, names);
}

void AddBoundNames(const Block& block, std::set<std::string>* names) {
  for (const auto& statement : block) {
    const bool sets = statement->kind == StatementKind::kAssign ||
                      statement->kind == StatementKind::kAugmented ||
                      statement->kind == StatementKind::kFor;
    if (sets) {
      for (const ExpressionPtr& target : statement->targets) AddTarget(*target, names);
    }
    if (statement->function != nullptr) names->insert(statement->function->name);
    for (const Block& inner : statement->blocks) AddBoundNames(inner, names);
  }
}

}  // namespace

std::set<std::string> LocalNames(const Block& body) {
  std::set<std::string> names;
  AddBoundNames(body, &names);
  return names;
}

}  // namespace simwright::reward
