// Tasks of `scene certify` in words: verbs, synonyms, ordinals, and what is not understood.
#include "workflows/scenes/certify_task.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace simwright::workflows {
namespace {

const std::vector<std::string> kNames = {"apple", "bowl", "can", "tea bottle"};

std::string Read(const std::string& text) {
  core::Findings findings;
  return ReadCertifyTask(text, kNames, &findings).Text();
}

TEST(SceneCertifyTask, ReadsWordingsOfOneTask) {
  for (const char* text :
       {"bring the apple to the front", "Bring an apple to the front.", "move apple forward",
        "please take the apples out", "BRING  the\tapple   to the front!!"}) {
    EXPECT_EQ(Read(text), "bring the apple to the front") << text;
  }
  EXPECT_EQ(Read("lift the tea bottle"), "lift the tea bottle");
  EXPECT_EQ(Read("pick up the third can"), "lift the third can");
  EXPECT_EQ(Read("Can you lift the 3rd can?"), "lift the third can");
  EXPECT_EQ(Read("put the second apple next to the bowl"),
            "bring the second apple next to the bowl");
  EXPECT_EQ(Read("bring the can to the first tea bottle"),
            "bring the can next to the first tea bottle");
  // Its own wording is read back.
  EXPECT_EQ(Read(Read("put the second apple beside the bowl")),
            "bring the second apple next to the bowl");
}

TEST(SceneCertifyTask, RefusesOtherTexts) {
  for (const char* text : {"", " ", "apple", "bring", "bring the apple", "to the front", "lift",
                           "bring to the bowl", "lift the zorbelflux",
                           "bring the apple to the zorbelflux", "lift the apple and the bowl"}) {
    core::Findings findings;
    EXPECT_THROW(ReadCertifyTask(text, kNames, &findings), core::Error) << text;
  }
  std::string endless;
  for (int i = 0; i < 1000; ++i) endless += "lift the apple ";
  EXPECT_THROW(Read(endless), core::Error);
  EXPECT_THROW(Read("lift the \xff\xfe"), core::Error);
}

}  // namespace
}  // namespace simwright::workflows
