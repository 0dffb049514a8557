#include "tasks/task_names.h"

#include <gtest/gtest.h>

namespace simwright::tasks {
namespace {

TEST(TaskNames, AreSafeForFilesAndCommandLines) {
  EXPECT_EQ(SafeName("OpenMicrowaveDoor"), "OpenMicrowaveDoor");
  EXPECT_EQ(SafeName("Open the Microwave's door!"), "Open_the_Microwave_s_door");
  EXPECT_EQ(SafeName("../../etc/passwd"), "etc_passwd");
  EXPECT_EQ(SafeName("--force -rf"), "force-rf");
  EXPECT_EQ(SafeName("a\nb\t\x01"), "a_b");
  EXPECT_EQ(SafeName("a _ b"), "a_b");
  EXPECT_EQ(SafeName("..."), "");
  EXPECT_EQ(SafeName("T\u00FCr \u00F6ffnen \u2013 \u201Esanft\u201C"),
            "T\u00FCr_\u00F6ffnen_sanft");
  EXPECT_EQ(SafeName("\u6253\u5F00\uFF0C\u95E8"), "\u6253\u5F00_\u95E8");
  EXPECT_EQ(SafeName("a\u202Eb\uFEFFc\u00A0d"), "a_b_c_d");  // marks of direction, odd blanks
  EXPECT_EQ(SafeName("\xFFx\xC3"), "x");
}

TEST(TaskNames, AreBoundedAtWholeCharacters) {
  EXPECT_EQ(SafeName(std::string(1000, 'a')).size(), 64u);
  std::string umlauts = "a";
  for (int i = 0; i < 100; ++i) umlauts += "\u00FC";
  EXPECT_EQ(SafeName(umlauts).size(), 63u);  // 1 + 31 * 2
}

TEST(TaskNames, AreMadeUnique) {
  std::set<std::string> taken;
  EXPECT_EQ(UniqueName("open", &taken), "open");
  EXPECT_EQ(UniqueName("Open", &taken), "Open_2");
  EXPECT_EQ(UniqueName("open", &taken), "open_3");
  EXPECT_EQ(UniqueName("open_2", &taken), "open_2_2");
  const std::string longest(64, 'a');
  EXPECT_EQ(UniqueName(longest, &taken), longest);
  EXPECT_EQ(UniqueName(longest, &taken), std::string(62, 'a') + "_2");
}

TEST(TaskNames, OfAssets) {
  EXPECT_TRUE(IsAssetName("mug-2_b"));
  for (const char* name : {"", "2mug", "_mug", "mug cup", "m\u00FCg", "a/b", "a\"b"}) {
    EXPECT_FALSE(IsAssetName(name)) << name;
  }
  EXPECT_FALSE(IsAssetName(std::string(65, 'a')));
}

}  // namespace
}  // namespace simwright::tasks
