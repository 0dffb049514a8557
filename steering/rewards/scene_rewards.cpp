#include "steering/rewards/scene_rewards.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_agreement.h"

namespace simwright::steering {
namespace {

void RequireJudged(const JudgedScene& scene) {
  if (!scene.IsJudged()) throw core::Error("this reward needs a judged scene");
}

class ObjectCount : public SceneReward {
 public:
  explicit ObjectCount(int entries) : entries_(entries) {}
  bool NeedsPhysics() const override { return false; }
  double Evaluate(const JudgedScene& scene) const override {
    return static_cast<double>(scene.objects.size());
  }
  double Goal() const override { return entries_; }
  std::string Name() const override { return "objects"; }

 private:
  int entries_;
};

class FeasibleCount : public SceneReward {
 public:
  explicit FeasibleCount(int entries) : entries_(entries) {}
  bool NeedsPhysics() const override { return true; }
  double Evaluate(const JudgedScene& scene) const override {
    RequireJudged(scene);
    return scene.FeasibleCount(true);
  }
  double Goal() const override { return entries_; }
  std::string Name() const override { return "feasible objects"; }

 private:
  int entries_;
};

class Agreement : public SceneReward {
 public:
  Agreement(scene::Prompt prompt, scene::CategorySizes sizes)
      : prompt_(std::move(prompt)), sizes_(std::move(sizes)) {}
  bool NeedsPhysics() const override { return true; }
  double Evaluate(const JudgedScene& scene) const override {
    RequireJudged(scene);
    std::vector<scene::SceneObject> feasible;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.IsFeasible(i)) feasible.push_back(scene.objects[i]);
    }
    const scene::PromptAgreement agreement = scene::AgreementWith(prompt_, feasible, sizes_);
    if (agreement.statements == 0) return agreement.apf;
    return 0.5 * (agreement.apf + agreement.StatementShare());
  }
  double Goal() const override { return 1.0; }
  std::string Name() const override { return "agreement with the prompt"; }

 private:
  scene::Prompt prompt_;
  scene::CategorySizes sizes_;
};

class Expression : public SceneReward {
 public:
  Expression(CountExpression expression, double most)
      : expression_(std::move(expression)), most_(most) {}
  bool NeedsPhysics() const override { return expression_.UsesFeasible(); }
  double Evaluate(const JudgedScene& scene) const override {
    if (NeedsPhysics()) RequireJudged(scene);
    const std::vector<std::string>& names = expression_.names();
    CountExpression::Counts counts;
    counts.there.assign(names.size(), 0.0);
    counts.feasible.assign(names.size(), 0.0);
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      const scene::SceneObject& object = scene.objects[i];
      if (object.welded) continue;
      const double feasible = scene.IsJudged() && scene.IsFeasible(i) ? 1.0 : 0.0;
      counts.all += 1.0;
      counts.all_feasible += feasible;
      const auto name =
          std::find(names.begin(), names.end(), scene::NameOfCategory(object.category));
      if (name == names.end()) continue;
      const auto index = static_cast<size_t>(name - names.begin());
      counts.there[index] += 1.0;
      counts.feasible[index] += feasible;
    }
    return expression_.Evaluate(counts);
  }
  double Goal() const override { return expression_.UpperBound(most_); }
  std::string Name() const override { return expression_.text(); }

 private:
  CountExpression expression_;
  double most_;
};

}  // namespace

std::unique_ptr<SceneReward> ObjectCountReward(const scene::Vocabulary& vocabulary) {
  return std::make_unique<ObjectCount>(vocabulary.entries);
}

std::unique_ptr<SceneReward> FeasibleCountReward(const scene::Vocabulary& vocabulary) {
  return std::make_unique<FeasibleCount>(vocabulary.entries);
}

std::unique_ptr<SceneReward> NamedCountReward(const scene::Vocabulary& vocabulary,
                                              const std::string& name) {
  return ExpressionReward(vocabulary, CountExpression::Parse("feasible(" + name + ")",
                                                             scene::NamesOfVocabulary(vocabulary)));
}

std::unique_ptr<SceneReward> PromptReward(const scene::Prompt& prompt, scene::CategorySizes sizes) {
  std::string error;
  if (!prompt.IsValid(&error)) throw core::Error("the prompt of a reward: " + error);
  return std::make_unique<Agreement>(prompt, std::move(sizes));
}

std::unique_ptr<SceneReward> ExpressionReward(const scene::Vocabulary& vocabulary,
                                              CountExpression expression) {
  return std::make_unique<Expression>(std::move(expression), vocabulary.entries);
}

std::unique_ptr<SceneReward> RewardNamed(const std::string& text,
                                         const scene::Vocabulary& vocabulary) {
  if (text == "objects") return ObjectCountReward(vocabulary);
  if (text == "feasible") return FeasibleCountReward(vocabulary);
  CountExpression expression = CountExpression::Parse(text, scene::NamesOfVocabulary(vocabulary));
  if (expression.UpperBound(vocabulary.entries) >= std::numeric_limits<double>::max()) {
    throw core::Error("the expression has no largest value, because a divisor can be 0",
                      "\"" + text + "\"", "as in count(apple) / (1 + count(can))");
  }
  return ExpressionReward(vocabulary, std::move(expression));
}

}  // namespace simwright::steering
