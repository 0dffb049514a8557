#include "scene/prompt/prompt_drawing.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/error.h"
#include "core/shuffle.h"
#include "scene/dataset/tokens.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

constexpr int kTierKind = kRelationCount;  // the kind of tier statements, after the relations

// The free objects of a scene: their boxes and the indices of their names.
struct NamedScene {
  const std::vector<std::string>* names = nullptr;
  std::vector<PlacedBox> boxes;
  std::vector<int> name_of;
  Shelves shelves;
};

// A statement that may be drawn; `object` is -1 for tiers.
struct StatementCandidate {
  int subject = 0, object = -1;
  ShelfTier tier = ShelfTier::kTop;
};
using StatementCandidates = std::array<std::vector<StatementCandidate>, kRelationCount + 1>;

void AddPair(const PlacedBox& a, const PlacedBox& b, int i, int j, StatementCandidates* found) {
  for (int k = 0; k < kRelationCount; ++k) {
    const auto relation = static_cast<Relation>(k);
    if (relation == Relation::kFacing || !Holds(relation, a, b)) continue;
    if (relation == Relation::kOn && Holds(Relation::kInside, a, b)) continue;
    (*found)[static_cast<size_t>(k)].push_back({i, j});
  }
}

// Adds the relations of level pairs, most of all, at the cost of one of them: the reverse pair is
// in the mirrored relation.
bool AddLevelPair(const PlacedBox& a, const PlacedBox& b, int i, int j,
                  StatementCandidates* found) {
  static constexpr std::array<std::pair<Relation, Relation>, 2> kMirrored = {
      {{Relation::kLeftOf, Relation::kRightOf}, {Relation::kInFrontOf, Relation::kBehind}}};
  if (!Holds(Relation::kNextTo, a, b)) return false;
  (*found)[static_cast<size_t>(Relation::kNextTo)].push_back({i, j});
  (*found)[static_cast<size_t>(Relation::kNextTo)].push_back({j, i});
  const Eigen::Vector3d offset = a.center - b.center;
  const bool sideways = std::abs(offset.y()) >= std::abs(offset.x());
  const auto [first, second] = kMirrored[sideways ? 0 : 1];
  const bool is_first = sideways ? offset.y() > 0.0 : offset.x() < 0.0;
  (*found)[static_cast<size_t>(first)].push_back(is_first ? StatementCandidate{i, j}
                                                          : StatementCandidate{j, i});
  (*found)[static_cast<size_t>(second)].push_back(is_first ? StatementCandidate{j, i}
                                                           : StatementCandidate{i, j});
  return true;
}

StatementCandidates FindStatements(const NamedScene& scene, const std::vector<char>& named) {
  StatementCandidates found;
  const auto count = static_cast<int>(scene.boxes.size());
  const auto is_named = [&](int i) {
    return named[static_cast<size_t>(scene.name_of[static_cast<size_t>(i)])] != 0;
  };
  for (int i = 0; i < count; ++i) {
    if (!is_named(i)) continue;
    const PlacedBox& a = scene.boxes[static_cast<size_t>(i)];
    for (int j = i + 1; j < count; ++j) {
      const PlacedBox& b = scene.boxes[static_cast<size_t>(j)];
      if (!is_named(j) || BoxDistance(a, b) >= kNearDistance) continue;
      if (AddLevelPair(a, b, i, j, &found)) continue;
      AddPair(a, b, i, j, &found);
      AddPair(b, a, j, i, &found);
    }
    const std::optional<ShelfTier> tier = scene.shelves.TierOf(a);
    if (tier) found[kTierKind].push_back({i, -1, *tier});
  }
  return found;
}

// Returns the references to all objects: with ordinals where a name occurs more than once.
std::vector<ObjectReference> ReferencesOf(const NamedScene& scene) {
  std::vector<ObjectReference> references(scene.boxes.size());
  std::vector<std::vector<int>> objects(scene.names->size());
  for (size_t i = 0; i < scene.boxes.size(); ++i) {
    objects[static_cast<size_t>(scene.name_of[i])].push_back(static_cast<int>(i));
  }
  for (size_t n = 0; n < objects.size(); ++n) {
    std::vector<const PlacedBox*> boxes;
    for (const int i : objects[n]) boxes.push_back(&scene.boxes[static_cast<size_t>(i)]);
    const std::vector<int> order = OrdinalOrder(boxes);
    for (size_t k = 0; k < order.size(); ++k) {
      ObjectReference& reference =
          references[static_cast<size_t>(objects[n][static_cast<size_t>(order[k])])];
      reference = {(*scene.names)[n], order.size() > 1 ? static_cast<int>(k) + 1 : 0};
    }
  }
  return references;
}

// Removes one of the candidates and returns it. Requires one.
StatementCandidate TakeCandidate(std::vector<StatementCandidate>* candidates, core::Rng& rng) {
  const auto index =
      static_cast<size_t>(core::UniformIndex(rng, static_cast<std::int64_t>(candidates->size())));
  std::swap((*candidates)[index], candidates->back());
  const StatementCandidate one = candidates->back();
  candidates->pop_back();
  return one;
}

// Draws a statement about a pair that is not among `drawn`: its kind, then one of that kind.
// Returns false if there is none.
bool DrawStatement(const std::vector<ObjectReference>& references, StatementCandidates* found,
                   std::vector<StatementCandidate>* drawn, core::Rng& rng, Prompt* prompt) {
  const auto is_drawn = [&](const StatementCandidate& one) {
    return std::any_of(drawn->begin(), drawn->end(), [&](const StatementCandidate& other) {
      return (other.subject == one.subject && other.object == one.object) ||
             (other.subject == one.object && other.object == one.subject);
    });
  };
  while (true) {
    std::array<size_t, kRelationCount + 1> kinds;
    std::int64_t kind_count = 0;
    for (size_t k = 0; k < found->size(); ++k) {
      if (!(*found)[k].empty()) kinds[static_cast<size_t>(kind_count++)] = k;
    }
    if (kind_count == 0) return false;
    const size_t kind = kinds[static_cast<size_t>(core::UniformIndex(rng, kind_count))];
    while (!(*found)[kind].empty()) {
      const StatementCandidate one = TakeCandidate(&(*found)[kind], rng);
      if (is_drawn(one)) continue;
      drawn->push_back(one);
      const ObjectReference& subject = references[static_cast<size_t>(one.subject)];
      if (kind == kTierKind) {
        prompt->tiers.push_back({subject, one.tier});
      } else {
        prompt->relations.push_back(
            {subject, static_cast<Relation>(kind), references[static_cast<size_t>(one.object)]});
      }
      return true;
    }
  }
}

void DrawStatements(const NamedScene& scene, const PromptDrawingOptions& options,
                    const std::vector<char>& named, core::Rng& rng, Prompt* prompt) {
  StatementCandidates found = FindStatements(scene, named);
  if (std::all_of(found.begin(), found.end(), [](const auto& some) { return some.empty(); })) {
    return;
  }
  const std::vector<ObjectReference> references = ReferencesOf(scene);
  std::vector<StatementCandidate> drawn;
  const auto count = 1 + core::UniformIndex(rng, options.most_relations);
  for (std::int64_t i = 0; i < count; ++i) {
    if (!DrawStatement(references, &found, &drawn, rng, prompt)) break;
  }
  prompt->kind = PromptKind::kRelations;
}

PromptKind DrawKind(const PromptDrawingOptions& options, core::Rng& rng) {
  const double sum = options.count_weight + options.names_weight + options.relations_weight;
  const double at = core::Uniform(rng) * sum;
  if (at < options.count_weight) return PromptKind::kCount;
  return at < options.count_weight + options.names_weight ? PromptKind::kNames
                                                          : PromptKind::kRelations;
}

Prompt DrawNamedPrompt(const NamedScene& scene, const PromptDrawingOptions& options,
                       core::Rng& rng) {
  const PromptKind kind = DrawKind(options, rng);
  Prompt prompt;
  if (kind == PromptKind::kCount || scene.boxes.empty()) {
    prompt.kind = PromptKind::kCount;
    prompt.count = static_cast<int>(scene.boxes.size());
    return prompt;
  }
  prompt.kind = PromptKind::kNames;
  std::vector<int> counts(scene.names->size(), 0), order;
  for (const int name : scene.name_of) {
    if (counts[static_cast<size_t>(name)]++ == 0) order.push_back(name);
  }
  std::sort(order.begin(), order.end());
  core::Shuffle(&order, rng);
  if (core::Uniform(rng) < options.subset && order.size() > 1) {
    order.resize(static_cast<size_t>(
        1 + core::UniformIndex(rng, static_cast<std::int64_t>(order.size()) - 1)));
    prompt.and_others = true;
  }
  std::vector<char> named(scene.names->size(), 0);
  for (const int name : order) {
    const auto index = static_cast<size_t>(name);
    prompt.names.push_back({(*scene.names)[index], counts[index]});
    named[index] = 1;
  }
  if (kind == PromptKind::kRelations) DrawStatements(scene, options, named, rng, &prompt);
  return prompt;
}

void ThrowUnlessValid(const PromptDrawingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "drawing of prompts");
}

}  // namespace

bool PromptDrawingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  for (const double weight : {count_weight, names_weight, relations_weight}) {
    if (!(weight >= 0.0 && weight <= 1e6)) return fails("weights must be 0 to 1e6");
  }
  if (count_weight + names_weight + relations_weight <= 0.0) return fails("all weights are 0");
  if (!(subset >= 0.0 && subset <= 1.0)) return fails("the subset probability must be 0 to 1");
  if (most_relations < 1 || most_relations > 1000) return fails("most_relations must be 1 to 1000");
  return true;
}

Prompt DrawPrompt(const std::vector<SceneObject>& objects, const CategorySizes& sizes,
                  const PromptDrawingOptions& options, core::Rng& rng) {
  ThrowUnlessValid(options);
  std::vector<std::string> names;
  for (const SceneObject& object : objects) {
    if (!object.welded) names.push_back(NameOfCategory(object.category));
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  NamedScene scene;
  scene.names = &names;
  scene.shelves = Shelves(objects, sizes);
  for (const SceneObject& object : objects) {
    if (object.welded) continue;
    const std::string name = NameOfCategory(object.category);
    scene.boxes.push_back(BoxOf(SizeOf(sizes, object.category), object.world_from_object));
    scene.name_of.push_back(
        static_cast<int>(std::lower_bound(names.begin(), names.end(), name) - names.begin()));
  }
  return DrawNamedPrompt(scene, options, rng);
}

struct PromptDrawing::Categories {
  Vocabulary vocabulary;
  PromptDrawingOptions options;
  std::vector<std::string> names;
  std::vector<int> name_of;         // by class; -1: welded
  std::vector<CategorySize> sizes;  // by class
};

PromptDrawing::PromptDrawing(const Vocabulary& vocabulary, const CategorySizes& sizes,
                             const PromptDrawingOptions& options) {
  ThrowUnlessValid(options);
  auto categories = std::make_unique<Categories>();
  categories->vocabulary = vocabulary;
  categories->options = options;
  categories->names = NamesOfVocabulary(vocabulary);
  const std::vector<std::string>& names = categories->names;
  for (size_t c = 0; c < vocabulary.categories.size(); ++c) {
    const std::string& category = vocabulary.categories[c];
    const bool is_shelf = vocabulary.welded[c] && category.starts_with("shelf");
    const bool used = !vocabulary.welded[c] || is_shelf;
    categories->sizes.push_back(used ? SizeOf(sizes, category) : CategorySize());
    const auto name = std::lower_bound(names.begin(), names.end(), NameOfCategory(category));
    categories->name_of.push_back(vocabulary.welded[c] ? -1
                                                       : static_cast<int>(name - names.begin()));
  }
  categories_ = std::move(categories);
}

PromptDrawing::~PromptDrawing() = default;
PromptDrawing::PromptDrawing(PromptDrawing&&) noexcept = default;
PromptDrawing& PromptDrawing::operator=(PromptDrawing&&) noexcept = default;

Prompt PromptDrawing::Draw(const float* tokens, core::Rng& rng) const {
  using RowMajorMatrix = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
  const Vocabulary& vocabulary = categories_->vocabulary;
  NamedScene scene;
  scene.names = &categories_->names;
  const int classes = vocabulary.ClassCount();
  for (int i = 0; i < vocabulary.entries; ++i) {
    const float* const token = tokens + i * vocabulary.TokenWidth();
    const float* const first = token + kPoseWidth;
    const auto c = static_cast<size_t>(std::max_element(first, first + classes) - first);
    if (static_cast<int>(c) == vocabulary.EmptyClass()) continue;
    const bool is_shelf = vocabulary.welded[c] && categories_->sizes[c].height > 0.0;
    if (vocabulary.welded[c] && !is_shelf) continue;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Map<const Eigen::Vector3f>(token).cast<double>();
    pose.linear() = Eigen::Map<const RowMajorMatrix>(token + 3).cast<double>();
    if (is_shelf) {
      scene.shelves.Add(categories_->sizes[c], pose);
    } else {
      scene.boxes.push_back(BoxOf(categories_->sizes[c], pose));
      scene.name_of.push_back(categories_->name_of[c]);
    }
  }
  return DrawNamedPrompt(scene, categories_->options, rng);
}

}  // namespace simwright::scene
