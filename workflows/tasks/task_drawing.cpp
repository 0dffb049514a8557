#include "workflows/tasks/task_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "geometry/convex_hull_2d.h"
#include "workflows/tasks/page_markup.h"

namespace simwright::workflows {
namespace {

constexpr double kPlan = 220.0;      // px, side of the view from above
constexpr double kSpan = 2.4;        // m, the side of the shown area
constexpr double kReach = 0.855;     // m, of a Panda's flange
constexpr double kBoxWidth = 190.0;  // px, of a subtask
constexpr double kBoxHeight = 92.0;  // px
constexpr double kGap = 34.0;        // px between subtasks
constexpr std::size_t kLineLength = 27;
constexpr std::size_t kMostLines = 3;

std::string SvgNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// Wraps `text` into lines of at most kLineLength characters; the rest becomes "...".
std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + word.size() >= kLineLength) {
      if (lines.size() == kMostLines) {
        lines.back() += " ...";
        return lines;
      }
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word.substr(0, kLineLength);
  }
  return lines;
}

// Converts world to picture coordinates: the robot looks up, and its left is left.
Eigen::Vector2d OnPlan(const Eigen::Vector2d& world) {
  const double scale = kPlan / kSpan;
  return {0.5 * kPlan - scale * world.y(), 0.68 * kPlan - scale * world.x()};
}

std::string Circle(const Eigen::Vector2d& center, double radius, const std::string& style) {
  return "<circle cx=\"" + SvgNumber(center.x()) + "\" cy=\"" + SvgNumber(center.y()) + "\" r=\"" +
         SvgNumber(radius) + "\" " + style + "/>";
}

std::string SvgText(double x, double y, const std::string& style, const std::string& text) {
  return "<text x=\"" + SvgNumber(x) + "\" y=\"" + SvgNumber(y) + "\" " + style + ">" +
         core::EscapedMarkup(text) + "</text>";
}

// Draws the outline of each link from above, in the object's colour.
std::string DrawObject(const tasks::WorldModel& model, const tasks::WorldState& state, int index) {
  static constexpr const char* kColours[] = {"#7fa7c9", "#d9a066", "#8fbf7f",
                                             "#c98fb4", "#b0a0d0", "#c9b458"};
  const auto t = static_cast<std::size_t>(index);
  const tasks::ArticulatedObject& object = model.objects[t];
  const std::vector<Eigen::Isometry3d> poses = tasks::LinkPosesOf(object, state.joints[t]);
  const std::string colour = kColours[t % std::size(kColours)];
  std::string svg;
  for (std::size_t l = 0; l < poses.size(); ++l) {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& point : object.links[l].extreme_points) {
      const Eigen::Vector3d world = state.roots[t] * poses[l] * point;
      points.push_back(OnPlan(world.head<2>()));
    }
    const std::vector<Eigen::Vector2d> hull = geometry::ConvexHull2d(points);
    if (hull.size() < 3) continue;
    svg += "<polygon points=\"";
    for (const Eigen::Vector2d& point : hull) {
      svg += SvgNumber(point.x()) + "," + SvgNumber(point.y()) + " ";
    }
    svg +=
        "\" fill=\"" + colour + "\" fill-opacity=\"0.55\" stroke=\"#444\" stroke-width=\"0.8\"/>";
  }
  const Eigen::Vector3d middle = tasks::WorldAabb(model, state, index).center();
  const Eigen::Vector2d at = OnPlan(middle.head<2>());
  return svg + SvgText(at.x(), at.y() + 3.0, "class=\"thing\"", object.name);
}

std::string DrawPlan(const tasks::Task& task, const tasks::WorldModel& model) {
  const std::string frame = SvgNumber(kPlan);
  std::string svg =
      "<rect width=\"" + frame + "\" height=\"" + frame + "\" fill=\"#f7f6f2\" stroke=\"#999\"/>";
  if (task.subtasks.empty() || task.subtasks[0].start.placements.empty()) return svg;
  const tasks::InitialState& start = task.subtasks[0].start;
  const double scale = kPlan / kSpan;
  const Eigen::Vector2d robot = OnPlan(start.world_from_robot.translation().head<2>());
  svg += Circle(robot, kReach * scale, "fill=\"none\" stroke=\"#bbb\" stroke-dasharray=\"4 3\"");
  svg += Circle(robot, 0.09 * scale, "fill=\"#666\"");
  const tasks::WorldState state = tasks::StateOf(model, start);
  for (const tasks::AssetPlacement& placement : start.placements) {
    svg += DrawObject(model, state, model.Find(placement.asset));
  }
  const double height = start.world_from_robot.translation().z();
  if (height > 0.01) {
    svg += SvgText(6.0, kPlan - 8.0, "class=\"small\"",
                   "robot on a pedestal of " + SvgNumber(height) + " m");
  }
  return svg;
}

std::string DrawSubtask(const tasks::Subtask& subtask, int number, double x, double y) {
  const bool valid = subtask.valid();
  std::string svg = "<rect x=\"" + SvgNumber(x) + "\" y=\"" + SvgNumber(y) + "\" width=\"" +
                    SvgNumber(kBoxWidth) + "\" height=\"" + SvgNumber(kBoxHeight) +
                    "\" rx=\"6\" fill=\"" + (valid ? "#eef6ee" : "#fbe9e7") + "\" stroke=\"" +
                    (valid ? "#5b8c5a" : "#b5443a") + "\"/>";
  double line_y = y + 17.0;
  for (const std::string& line : Lines(std::to_string(number) + ". " + subtask.description)) {
    svg += SvgText(x + 8.0, line_y, "class=\"title\"", line);
    line_y += 13.0;
  }
  line_y += 3.0;
  for (const std::string& line : Lines(subtask.success)) {
    if (line_y > y + kBoxHeight - 4.0) break;
    svg += SvgText(x + 8.0, line_y, "class=\"small\"", line);
    line_y += 12.0;
  }
  return svg;
}

}  // namespace

std::string TaskDrawing(const tasks::Task& task, const tasks::WorldModel& model) {
  constexpr int kInARow = 3;
  const int count = static_cast<int>(task.subtasks.size());
  const int columns = std::clamp(count, 1, kInARow), rows = std::max((count + 2) / kInARow, 1);
  const double width = kPlan + columns * (kBoxWidth + kGap) + 4.0;
  const double height = std::max(kPlan, rows * (kBoxHeight + 16.0)) + 4.0;
  std::string svg = DrawPlan(task, model);
  for (int i = 0; i < count; ++i) {
    const double x = kPlan + kGap + (i % kInARow) * (kBoxWidth + kGap);
    const double y = 2.0 + (i / kInARow) * (kBoxHeight + 16.0);
    const double middle = y + 0.5 * kBoxHeight;
    const bool wraps = i > 0 && i % kInARow == 0;
    const std::string arrow = "<path d=\"M" + SvgNumber(x - kGap + 4.0) + " " + SvgNumber(middle) +
                              " H" + SvgNumber(x - 3.0) +
                              " m-7 -4 l7 4 l-7 4\" fill=\"none\" stroke=\"#555\"/>";
    svg += wraps ? SvgText(x - 20.0, middle, "class=\"small\"", "...") : arrow;
    svg += DrawSubtask(task.subtasks[static_cast<std::size_t>(i)], i + 1, x, y);
  }
  return core::FillTemplate(
      data::task_drawing_svg(),
      {{"width", SvgNumber(width)}, {"height", SvgNumber(height)}, {"content", core::Markup{svg}}});
}

}  // namespace simwright::workflows
