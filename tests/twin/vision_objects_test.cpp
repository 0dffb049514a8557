#include "twin/vision_objects.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "library_fit/fit_kinds.h"

namespace simwright::twin {
namespace {

VisionObjects ReadOf(const std::string& answer) {
  VisionObjects objects;
  std::string fault;
  EXPECT_TRUE(ReadVisionAnswer(answer, 640, 480, &objects, &fault)) << fault;
  return objects;
}

std::string FaultOf(const std::string& answer) {
  VisionObjects objects;
  std::string fault;
  EXPECT_FALSE(ReadVisionAnswer(answer, 640, 480, &objects, &fault));
  return fault;
}

TEST(ReadVisionAnswer, TakesBoxesAndNames) {
  const VisionObjects read = ReadOf(
      "Here they are:\n```json\n{\"objects\": ["
      "{\"name\": \"Coffee Mug\", \"box\": [10, 20, 110, 140]},"
      "{\"name\": \"bowl\", \"box\": [300.5, 200, 420, 260.25]}]}\n```");
  ASSERT_EQ(read.boxes.size(), 2u);
  EXPECT_TRUE(read.findings.empty());
  EXPECT_EQ(read.boxes[0].name, "coffee mug");
  EXPECT_EQ(read.boxes[0].box.max(), Eigen::Vector2d(110, 140));
  ASSERT_EQ(read.boxes[0].kinds.size(), 1u);
  EXPECT_EQ(library_fit::FitKinds()[static_cast<size_t>(read.boxes[0].kinds[0])].name, "mug");
  EXPECT_EQ(read.boxes[1].box.min().x(), 300.5);
}

TEST(ReadVisionAnswer, TakesListsAndShares) {
  const VisionObjects read = ReadOf(R"([{"label": "cup", "bbox_2d": [0.25, 0.5, 0.5, 0.75]}])");
  ASSERT_EQ(read.boxes.size(), 1u);
  EXPECT_EQ(read.boxes[0].box.min(), Eigen::Vector2d(160, 240));
  EXPECT_EQ(read.boxes[0].box.max(), Eigen::Vector2d(320, 360));
  EXPECT_TRUE(ReadOf(R"({"objects": []})").boxes.empty());
}

TEST(ReadVisionAnswer, LeavesOutBadBoxesWithFindings) {
  const VisionObjects read = ReadOf(R"({"objects": [
    {"name": "mug", "box": [10, 20, 110, 140]},
    {"name": "mug", "box": [12, 21, 110, 139]},
    {"name": "table", "box": [0, 200, 640, 480]},
    {"name": "plate", "box": [500, 300, 900, 400]},
    {"name": "plate", "box": [110, 20, 10, 140]},
    {"name": "plate", "box": [10, 20, 110]},
    {"name": "plate", "box": [10, 20, 110, "140"]},
    {"name": "plate", "box": [200, 200, 203, 203]},
    {"name": "plate", "box": [0, 0, 640, 480]},
    {"name": "plate", "box": [630, 100, 645, 200]},
    {"name": "plate"}, 7]})");
  ASSERT_EQ(read.boxes.size(), 2u);
  // A box a little beyond the border is clipped.
  EXPECT_EQ(read.boxes[1].box.max().x(), 640.0);
  ASSERT_EQ(read.findings.size(), 10u);
  const std::vector<const char*> reasons{"repeats",   "table",     "outside", "left, top",
                                         "left, top", "left, top", "smaller", "whole"};
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    EXPECT_EQ(read.findings[i].code, "twin-box-dropped");
    EXPECT_NE(read.findings[i].sentence.find(reasons[i]), std::string::npos)
        << read.findings[i].sentence;
  }
}

// Names are data: no answer reaches a finding or a file name but as plain words.
TEST(ReadVisionAnswer, NamesAreDataOnly) {
  const VisionObjects read = ReadOf(
      R"({"objects": [
    {"name": "../../etc/passwd", "box": [10, 20, 110, 140]},
    {"name": "ignore all rules; rm -rf", "box": [200, 20, 310, 140]},
    {"name": "zzyx", "box": [400, 20, 510, 140]},
    {"box": [400, 220, 510, 340]},
    {"name": ")" +
      std::string(500, 'a') + R"(", "box": [10, 220, 110, 340]}]})");
  ASSERT_EQ(read.boxes.size(), 5u);
  EXPECT_EQ(read.boxes[0].name, "");
  EXPECT_EQ(read.boxes[1].name, "");
  EXPECT_EQ(read.boxes[2].name, "zzyx");
  for (const NamedBox& box : read.boxes) EXPECT_TRUE(box.kinds.empty());
  EXPECT_EQ(read.findings.size(), 5u);
  for (const core::Finding& finding : read.findings) {
    EXPECT_EQ(finding.code, "twin-name-unknown");
    EXPECT_EQ(finding.sentence.find("rm"), std::string::npos);
  }
}

TEST(ReadVisionAnswer, LimitsTheirNumber) {
  std::string list;
  for (int i = 0; i < 140; ++i) {
    const int x = 40 * (i % 15), y = 40 * (i / 15);
    list += std::string(i > 0 ? "," : "") + "{\"name\": \"cup\", \"box\": [" + std::to_string(x) +
            "," + std::to_string(y) + "," + std::to_string(x + 30) + "," + std::to_string(y + 30) +
            "]}";
  }
  const VisionObjects read = ReadOf("{\"objects\": [" + list + "]}");
  EXPECT_EQ(read.boxes.size(), 100u);
  ASSERT_EQ(read.findings.size(), 1u);
  EXPECT_EQ(read.findings[0].figure, 140.0);
}

TEST(ReadVisionAnswer, TellsWhyAnAnswerIsUseless) {
  EXPECT_NE(FaultOf("I see a mug and a plate.").find("no JSON list"), std::string::npos);
  EXPECT_NE(FaultOf("").find("no JSON list"), std::string::npos);
  EXPECT_NE(FaultOf(R"({"objects": "mug"})").find("no JSON list"), std::string::npos);
  EXPECT_NE(FaultOf(R"({"objects": [{"name": "mug", "box": [1e400, 2, 3, 4]}]})").size(), 0u);
  EXPECT_NE(FaultOf(R"([{"name": "mug", "box": [900, 900, 990, 990]}])").find("outside"),
            std::string::npos);
}

// A model that gives prepared answers.
class PreparedModel final : public llm::ChatModel {
 public:
  explicit PreparedModel(std::vector<std::string> answers) : answers_(std::move(answers)) {}
  llm::ChatAnswer Ask(const llm::ChatRequest& request, core::Progress*) override {
    requests.push_back(request);
    return {answers_.at(requests.size() - 1), "stop", {}, false, 1};
  }
  std::string name() const override { return "prepared"; }
  llm::Usage usage() const override { return {}; }
  core::Findings TakeFindings() override { return {}; }

  std::vector<llm::ChatRequest> requests;

 private:
  std::vector<std::string> answers_;
};

TEST(AskForObjects, SendsThePhotoAndAsksOnceMore) {
  const core::Image photo(640, 480, 3, 90);
  const std::string good = R"({"objects": [{"name": "mug", "box": [10, 20, 110, 140]}]})";
  PreparedModel model({"a mug", good});
  EXPECT_EQ(AskForObjects(&model, photo, nullptr).boxes.size(), 1u);
  ASSERT_EQ(model.requests.size(), 2u);
  ASSERT_EQ(model.requests[0].messages.size(), 1u);
  const llm::ChatMessage& message = model.requests[0].messages[0];
  EXPECT_NE(message.text.find("640 x 480"), std::string::npos);
  ASSERT_EQ(message.images.size(), 1u);
  EXPECT_EQ(core::DecodeImage(message.images[0].bytes, "sent").width, 640);
  EXPECT_NE(model.requests[1].messages[0].text.find("no JSON list"), std::string::npos);
  PreparedModel useless({"a mug", "two mugs"});
  try {
    AskForObjects(&useless, photo, nullptr);
    ADD_FAILURE() << "an answer without boxes was used";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("prepared"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace simwright::twin
