// The words of docs/glossary.md: former names stay out of production code, and comments are
// sentences with a subject.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace simwright {
namespace {
namespace fs = std::filesystem;

const std::vector<std::string> kModules = {
    "core",        "geometry",    "nn",          "render",
    "llm",         "reward",      "texture",     "physics_params",
    "rl",          "asset_lift",  "assets",      "library",
    "robot",       "sim",         "asset_build", "tasks",
    "scene",       "validation",  "importers",   "manipulation",
    "skills",      "workflows",   "cli",         "capture",
    "library_fit", "certificate", "viewer",      "asset_looks",
    "python",      "proposals",   "twin",        "factory",
    "transfer"};

struct Line {
  std::string place, text;
  bool begins_comment;  // the first line of a comment of its own
};

std::vector<Line> ProductionLines() {
  std::vector<Line> lines;
  const std::regex comment("^\\s*//");
  for (const std::string& module : kModules) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(SIMWRIGHT_SOURCE_DIR) / module)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream in(entry.path());
      bool in_comment = false;
      int number = 0;
      for (std::string text; std::getline(in, text);) {
        const bool is_comment = std::regex_search(text, comment);
        lines.push_back({entry.path().string() + ":" + std::to_string(++number), text,
                         is_comment && !in_comment});
        in_comment = is_comment;
      }
    }
  }
  return lines;
}

TEST(Vocabulary, FormerNamesStayOut) {
  // Names that no other library's term can be taken for.
  const std::regex former(
      "\\b(Thing|ThingLink|ThingJoint|WorldThing|RigidThing|Posture|Detour|ArmClearance|"
      "SideRoom|FocusFrame|ToolAtFocus|BeforeWork|WayWanted|LaterWork|Palette|SlotSizes|"
      "DrawnObject|"
      "SceneDraw|ScenePart|LeastShift|SeparationPlanes|NearParts|ProjectApart|TakeByHull|"
      "TurnOneAcross|TakeAsHull|WatchInMujoco|KeepFoot|CheckRows|SkillNotes|ThinkOfTasks|"
      "Soundness|HiddenSights|IsWayClear|WorkEnd)\\b|\\banew\\b|\\btold apart\\b|"
      "\\blet be\\b");
  const std::vector<Line> lines = ProductionLines();
  EXPECT_GT(lines.size(), 50000u);
  for (const Line& line : lines) {
    EXPECT_FALSE(std::regex_search(line.text, former)) << line.place << ": " << line.text;
  }
}

TEST(Vocabulary, CommentsBeginWithTheirSubjectOrVerb) {
  const std::regex riddle("^\\s*//\\s*(What|Whether|Of|As)\\b");
  for (const Line& line : ProductionLines()) {
    EXPECT_FALSE(line.begins_comment && std::regex_search(line.text, riddle))
        << line.place << ": " << line.text;
  }
}

}  // namespace
}  // namespace simwright
