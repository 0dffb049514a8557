#pragma once

#include <memory>
#include <string>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/category_size.h"
#include "scene/prompt/prompt.h"
#include "steering/rewards/count_expression.h"
#include "steering/rewards/scene_reward.h"

namespace simwright::steering {

// Returns the number of objects of a scene, furniture included, as Pfaff et al. count.
std::unique_ptr<SceneReward> ObjectCountReward(const scene::Vocabulary& vocabulary);

// Returns the number of feasible objects of a scene, furniture included, as Pfaff et al. count.
std::unique_ptr<SceneReward> FeasibleCountReward(const scene::Vocabulary& vocabulary);

// Returns the number of feasible objects of one name ("apple", as in prompts). Throws core::Error,
// naming the names that exist, for another name.
std::unique_ptr<SceneReward> NamedCountReward(const scene::Vocabulary& vocabulary,
                                              const std::string& name);

// Returns the agreement of the feasible objects with a prompt, 0 to 1: the mean of the published
// agreement of counts and names (APF) and, where the prompt has statements, of the share of those
// that hold. Throws core::Error for an invalid prompt.
std::unique_ptr<SceneReward> PromptReward(const scene::Prompt& prompt, scene::CategorySizes sizes);

// Returns the value of an expression of counts.
std::unique_ptr<SceneReward> ExpressionReward(const scene::Vocabulary& vocabulary,
                                              CountExpression expression);

// Returns the reward of a text: "objects", "feasible", or an expression of counts. Throws
// core::Error as CountExpression does.
std::unique_ptr<SceneReward> RewardNamed(const std::string& text,
                                         const scene::Vocabulary& vocabulary);

}  // namespace simwright::steering
