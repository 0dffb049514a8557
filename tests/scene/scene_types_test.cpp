// The list of scene types, against samples of their grammars.
#include "scene/scene_types/scene_types.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {
namespace {

// The published lengths of scenes, by name.
TEST(SceneTypes, AreThePublishedOnesWithTheirLengths) {
  const std::map<std::string, int> published = {{"breakfast_high", 46}, {"breakfast_low", 35},
                                                {"dimsum", 34},         {"living_room_shelf", 23},
                                                {"pantry_shelf", 61},   {"restaurant_high", 125},
                                                {"restaurant_low", 107}};
  std::map<std::string, int> listed;
  for (const SceneType& type : SceneTypes()) listed[type.name] = type.entries;
  EXPECT_EQ(listed, published);
  EXPECT_TRUE(std::is_sorted(SceneTypes().begin(), SceneTypes().end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST(SceneTypes, DrawNothingThatIsNotAmongTheirSlots) {
  for (const SceneType& type : SceneTypes()) {
    const Grammar grammar = type.make(DefaultCategorySizes());
    EXPECT_EQ(grammar.name(), type.name);
    EXPECT_TRUE(std::is_sorted(type.categories.begin(), type.categories.end()));
    std::set<std::string> seen;
    core::Rng rng = core::StreamRng(11, 0);
    for (int i = 0; i < 60; ++i) {
      const SceneSample sample = SampleGrammar(grammar, rng);
      EXPECT_LE(sample.objects.size(), static_cast<size_t>(type.entries)) << type.name;
      for (const SceneObject& object : sample.objects) seen.insert(object.category);
      EXPECT_EQ(std::count_if(sample.objects.begin(), sample.objects.end(),
                              [&](const SceneObject& object) {
                                return object.category == type.main_furniture && object.welded;
                              }),
                1)
          << type.name;
    }
    const std::set<std::string> known(type.categories.begin(), type.categories.end());
    EXPECT_TRUE(std::includes(known.begin(), known.end(), seen.begin(), seen.end())) << type.name;
    // All categories were sampled, except those on one shelf in twenty.
    EXPECT_GE(seen.size() + 2, known.size()) << type.name;
  }
}

TEST(SceneTypes, AnUnknownNameIsToldWhichThereAre) {
  EXPECT_EQ(SceneTypeNamed("dimsum").name, "dimsum");
  try {
    SceneTypeNamed("kitchen");
    FAIL() << "an unknown type was found";
  } catch (const core::Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("kitchen"), std::string::npos) << text;
    EXPECT_NE(text.find("breakfast_low, dimsum"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace simwright::scene
