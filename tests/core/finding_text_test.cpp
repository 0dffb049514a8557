#include "core/finding_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/finding_json.h"

namespace simwright::core {
namespace {

const Finding kUnusual{"unusual-size", Severity::kWarning,          "chair", "it is 89.5 m tall",
                       89.5,           "--unit cm makes it 0.895 m"};

TEST(FindingText, SaysSeverityPlaceSentenceRemedyAndCode) {
  EXPECT_EQ(FindingText(kUnusual, 0),
            "warning: chair: it is 89.5 m tall (--unit cm makes it 0.895 m) [unusual-size]\n");
  EXPECT_EQ(FindingText({"rest-pose", Severity::kInfo, "", "it stands"}, 0),
            "note: it stands [rest-pose]\n");
}

TEST(FindingText, WrapsAtBlanksAndKeepsEveryWord) {
  const std::string text = FindingText(kUnusual, 40);
  std::string joined;
  size_t longest = 0, begin = 0;
  while (begin < text.size()) {
    const size_t end = text.find('\n', begin);
    longest = std::max(longest, end - begin);
    const std::string line = text.substr(begin, end - begin);
    joined += (joined.empty() ? "" : " ") + line.substr(begin == 0 ? 0 : 2);
    begin = end + 1;
  }
  EXPECT_LE(longest, 40u) << text;
  EXPECT_EQ(joined + "\n", FindingText(kUnusual, 0));
  EXPECT_EQ(Wrapped("a", 1), "a");
  EXPECT_EQ(Wrapped(std::string(90, 'x') + " y", 40), std::string(90, 'x') + "\n  y");
}

TEST(FindingText, IsBoundedAndOneLine) {
  const std::string listing(5000, 'x');
  const std::string text =
      FindingText({"c", Severity::kError, "a\nb", listing, 0.0, "do\tthis"}, 0);
  EXPECT_LE(text.size(), 700u);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.rfind("error: a b: xxx", 0), 0u);
  EXPECT_NE(text.find("... (do this) [c]"), std::string::npos) << text;
}

TEST(FindingText, CutsWholeCharactersOnly) {
  EXPECT_EQ(Truncated("abcdef", 6), "abcdef");
  EXPECT_EQ(Truncated("abcdefg", 6), "abc...");
  EXPECT_EQ(Truncated("ab\xc3\xa9"
                      "defg",
                      6),
            "ab...");
}

TEST(FindingText, AnErrorKeepsPlaceAndRemedy) {
  const Error error("it is 89.5 m (in all) tall", "a (1).glb", "--unit cm (or mm)");
  const Finding finding = FindingOf(error);
  EXPECT_EQ(finding.place, "a (1).glb");
  EXPECT_EQ(finding.sentence, "it is 89.5 m (in all) tall");
  EXPECT_EQ(finding.remedy, "--unit cm (or mm)");
  EXPECT_EQ(FindingText(finding, 0), std::string("error: ") + error.what() + "\n");
  EXPECT_EQ(FindingOf(Error("plain")).sentence, "plain");
  EXPECT_EQ(FindingOf(Error("f(x)", "place")).remedy, "");
}

TEST(FindingJson, HasEveryMember) {
  const nlohmann::ordered_json json = FindingsJson(
      {kUnusual, {"c", Severity::kError, "", "s", std::numeric_limits<double>::infinity()}});
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0].dump(),
            R"({"code":"unusual-size","severity":"warning","place":"chair",)"
            R"("sentence":"it is 89.5 m tall","remedy":"--unit cm makes it 0.895 m",)"
            R"("figure":89.5})");
  EXPECT_EQ(json[1]["severity"], "error");
  EXPECT_TRUE(json[1]["figure"].is_null());
}

}  // namespace
}  // namespace simwright::core
