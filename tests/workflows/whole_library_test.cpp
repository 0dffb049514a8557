// Three assets of every kind in the library pass all of their checks.
#include <gtest/gtest.h>

#include "core/files.h"
#include "library/articulated/articulated_kinds.h"
#include "workflows/library/library.h"

namespace simwright::workflows {
namespace {

class WholeLibrary : public ::testing::TestWithParam<std::string> {};

TEST_P(WholeLibrary, ThreeSeedsPass) {
  const core::TemporaryFolder folder;
  LibraryOptions options;
  options.kind = GetParam();
  options.count = 3;
  options.seed = 1;
  core::Progress silent;
  for (const LibraryOutcome& outcome : MakeLibrary(options, folder.path(), &silent)) {
    EXPECT_EQ(outcome.refusal, "") << outcome.name;
    ASSERT_TRUE(outcome.check.has_value());
    EXPECT_TRUE(outcome.check->passed());
    EXPECT_GT(outcome.check->results.size(), 10u);
  }
}

INSTANTIATE_TEST_SUITE_P(Pipeline, WholeLibrary, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const library::Kind& kind : library::Kinds()) {
                             names.push_back(kind.name);
                           }
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace simwright::workflows
