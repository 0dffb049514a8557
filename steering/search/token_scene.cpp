#include "steering/search/token_scene.h"

#include <algorithm>

#include "scene/dataset/tokens.h"

namespace simwright::steering {

TokenScene TokenScene::Empty(const scene::Vocabulary& vocabulary) {
  TokenScene scene;
  scene.tokens.resize(static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()));
  EncodeScene({}, vocabulary, scene.tokens.data());
  scene.penetrating.assign(static_cast<size_t>(vocabulary.entries), 0);
  scene.unstable = scene.penetrating;
  return scene;
}

bool TokenScene::IsEmpty(int entry, const scene::Vocabulary& vocabulary) const {
  const float* const first =
      &tokens[static_cast<size_t>(entry * vocabulary.TokenWidth())] + scene::kPoseWidth;
  return std::max_element(first, first + vocabulary.ClassCount()) - first ==
         vocabulary.EmptyClass();
}

std::vector<int> TokenScene::ObjectEntries(const scene::Vocabulary& vocabulary) const {
  std::vector<int> entries;
  for (int i = 0; i < vocabulary.entries; ++i) {
    if (!IsEmpty(i, vocabulary)) entries.push_back(i);
  }
  return entries;
}

JudgedScene TokenScene::Judged(const scene::Vocabulary& vocabulary) const {
  JudgedScene judged;
  judged.objects = DecodeScene(tokens.data(), vocabulary);
  for (const int entry : ObjectEntries(vocabulary)) {
    judged.penetrating.push_back(penetrating[static_cast<size_t>(entry)]);
    judged.unstable.push_back(unstable[static_cast<size_t>(entry)]);
  }
  return judged;
}

void TokenScene::Set(int entry, const scene::SceneObject* object,
                     const scene::Vocabulary& vocabulary) {
  scene::Vocabulary single = vocabulary;  // encodes one token
  single.entries = 1;
  std::vector<scene::SceneObject> objects;
  if (object != nullptr) objects.push_back(*object);
  EncodeScene(objects, single, &tokens[static_cast<size_t>(entry * vocabulary.TokenWidth())]);
  penetrating[static_cast<size_t>(entry)] = unstable[static_cast<size_t>(entry)] = 0;
}

}  // namespace simwright::steering
