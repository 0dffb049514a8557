#include "steering/search/mask_generator.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "scene/prompt/object_names.h"

namespace simwright::steering {
namespace {

class EmptyEntries : public MaskGenerator {
 public:
  explicit EmptyEntries(const scene::Vocabulary& vocabulary) : vocabulary_(vocabulary) {}
  std::vector<char> Mask(const TokenScene& scene) const override {
    std::vector<char> mask(static_cast<size_t>(vocabulary_.entries), 1);
    for (const int entry : scene.ObjectEntries(vocabulary_)) mask[static_cast<size_t>(entry)] = 0;
    return mask;
  }
  std::string Name() const override { return "empty"; }

 private:
  scene::Vocabulary vocabulary_;
};

class PenetratingObjects : public MaskGenerator {
 public:
  std::vector<char> Mask(const TokenScene& scene) const override { return scene.penetrating; }
  std::string Name() const override { return "penetrating"; }
};

class UnstableObjects : public MaskGenerator {
 public:
  std::vector<char> Mask(const TokenScene& scene) const override { return scene.unstable; }
  std::string Name() const override { return "unstable"; }
};

class SurplusObjects : public MaskGenerator {
 public:
  SurplusObjects(const scene::Vocabulary& vocabulary, const scene::Prompt& prompt)
      : vocabulary_(vocabulary), prompt_(prompt) {}
  std::vector<char> Mask(const TokenScene& scene) const override {
    std::vector<char> mask(static_cast<size_t>(vocabulary_.entries), 0);
    const std::vector<scene::SceneObject> objects = scene.Judged(vocabulary_).objects;
    const std::vector<int> entries = scene.ObjectEntries(vocabulary_);
    std::map<std::string, int> counts;
    int all = 0;
    for (size_t i = 0; i < objects.size(); ++i) {
      if (objects[i].welded) continue;
      const std::string name = scene::NameOfCategory(objects[i].category);
      ++all;
      const bool too_many = prompt_.count.has_value() && all > *prompt_.count;
      mask[static_cast<size_t>(entries[i])] = too_many || !IsAsked(name, ++counts[name]);
    }
    return mask;
  }
  std::string Name() const override { return "surplus"; }

 private:
  bool IsAsked(const std::string& name, int number) const {
    if (prompt_.names.empty()) return true;
    const bool named = std::any_of(prompt_.names.begin(), prompt_.names.end(),
                                   [&](const auto& one) { return one.name == name; });
    return named ? number <= prompt_.CountOf(name) : prompt_.and_others;
  }

  scene::Vocabulary vocabulary_;
  scene::Prompt prompt_;
};

class MaskUnion : public MaskGenerator {
 public:
  explicit MaskUnion(std::vector<std::unique_ptr<MaskGenerator>> parts)
      : parts_(std::move(parts)) {}
  std::vector<char> Mask(const TokenScene& scene) const override {
    std::vector<char> mask(scene.penetrating.size(), 0);
    for (const auto& part : parts_) {
      const std::vector<char> more = part->Mask(scene);
      for (size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] || more[i];
    }
    return mask;
  }
  std::string Name() const override {
    std::string name;
    for (const auto& part : parts_) name += (name.empty() ? "" : ",") + part->Name();
    return name;
  }

 private:
  std::vector<std::unique_ptr<MaskGenerator>> parts_;
};

}  // namespace

std::unique_ptr<MaskGenerator> EmptyMask(const scene::Vocabulary& vocabulary) {
  return std::make_unique<EmptyEntries>(vocabulary);
}

std::unique_ptr<MaskGenerator> PenetratingMask() {
  return std::make_unique<PenetratingObjects>();
}

std::unique_ptr<MaskGenerator> UnstableMask() {
  return std::make_unique<UnstableObjects>();
}

std::unique_ptr<MaskGenerator> SurplusMask(const scene::Vocabulary& vocabulary,
                                           const scene::Prompt& prompt) {
  return std::make_unique<SurplusObjects>(vocabulary, prompt);
}

std::unique_ptr<MaskGenerator> UnionMask(std::vector<std::unique_ptr<MaskGenerator>> parts) {
  return std::make_unique<MaskUnion>(std::move(parts));
}

const std::vector<std::string>& MaskNames() {
  static const std::vector<std::string> names = {"empty", "penetrating", "unstable"};
  return names;
}

std::unique_ptr<MaskGenerator> MaskNamed(const std::string& names,
                                         const scene::Vocabulary& vocabulary) {
  std::vector<std::unique_ptr<MaskGenerator>> parts;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    if (name == "empty") {
      parts.push_back(EmptyMask(vocabulary));
    } else if (name == "penetrating") {
      parts.push_back(PenetratingMask());
    } else if (name == "unstable") {
      parts.push_back(UnstableMask());
    } else {
      throw core::Error("there is no such mask", name,
                        "the masks are empty, penetrating and unstable");
    }
  }
  if (parts.empty()) {
    throw core::Error("no mask is given", "", "the masks are empty, penetrating and unstable");
  }
  return UnionMask(std::move(parts));
}

}  // namespace simwright::steering
