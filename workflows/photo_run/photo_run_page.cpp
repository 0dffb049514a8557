#include "workflows/photo_run/photo_run_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <set>
#include <vector>

#include "assets/semantic_model.h"
#include "core/files.h"
#include "rl/training.h"
#include "tasks/world_state.h"
#include "workflows/tasks/page_markup.h"
#include "workflows/tasks/task_drawing.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using core::Markup;
using Values = std::map<std::string, core::TemplateValue>;

std::string PageNumber(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof(text), format, a, b, c);
  return text;
}

std::string Escaped(const core::JsonField& field) {
  return core::EscapedMarkup(field.Text());
}

std::string PagePercent(double share) {
  return PageNumber("%.1f %%", 100.0 * share);
}

std::string Duration(double seconds) {
  if (seconds < 60.0) return PageNumber("%.1f s", seconds);
  const double whole = std::round(seconds);
  return PageNumber("%.0f min %.0f s", std::floor(whole / 60.0), std::fmod(whole, 60.0));
}

// Returns a table row with its figures right-aligned.
std::string Row(const std::string& name, const std::vector<std::string>& figures) {
  std::string row = "<tr><td>" + name + "</td>";
  for (const std::string& figure : figures) row += "<td class=\"n\">" + figure + "</td>";
  return row + "</tr>\n";
}

// Returns a bar; `begin` and `end` are fractions of its width.
std::string Bar(double begin, double end) {
  return "<span class=\"bar\"><i style=\"margin-left:" + PageNumber("%.1f", 100.0 * begin) +
         "%;width:" + PageNumber("%.1f", 100.0 * std::max(0.004, end - begin)) + "%\"></i></span>";
}

// Returns a figure. `fit`: "full", as wide as the page; "wide", scrolled sideways so that it stays
// legible.
Markup Figure(const std::string& picture, const std::string& caption, const std::string& fit) {
  return {"<figure><div class=\"" + fit + "\">" + picture + "</div><figcaption>" +
          core::EscapedMarkup(caption) + "</figcaption></figure>\n"};
}

Markup PageFigure(const fs::path& file, const std::string& description, const std::string& caption,
                  const std::string& fit = "full") {
  const std::string type = file.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return Figure(InlinePicture(core::ReadFile(file, 1 << 28), type, description), caption, fit);
}

std::string Tile(const std::string& figure, const std::string& what) {
  return "<div class=\"tile\"><b>" + figure + "</b>" + what + "</div>\n";
}

double Rate(const core::JsonField& counts, const char* successes, const char* tries) {
  return counts[successes].Number() / std::max(1.0, counts[tries].Number());
}

std::string Tiles(const core::JsonField& report) {
  const core::JsonField success = report["success"];
  const core::JsonField trajectory = report["trajectory"];
  std::string html =
      Tile(PagePercent(Rate(success, "successes", "episodes")),
           PageNumber("success in %.0f episodes; 95 %%: ", success["episodes"].Number()) +
               PageNumber("%.1f to %.1f %%", 100.0 * success["low"].Number(),
                          100.0 * success["high"].Number()));
  if (success["successes"].Int() > 0) {
    html += Tile(Duration(success["mean_seconds"].Number()), "a success, on average");
  }
  if (trajectory.Has("mean_seconds")) {
    html += Tile(Duration(trajectory["mean_seconds"].Number()),
                 std::string("the trajectory; its replay ") +
                     (trajectory["replayed"].Flag() ? "succeeds" : "fails"));
  }
  return html + Tile(Duration(report["seconds"].Number()), "for everything on this page");
}

std::string EstimateRow(const std::string& name, const core::JsonField& estimate, double factor,
                        const std::string& unit, double actual) {
  return Row(name, {PageNumber("%.3g ", factor * actual) + unit,
                    PageNumber("%.3g to %.3g ", factor * estimate["min"].Number(),
                               factor * estimate["max"].Number()) +
                        unit});
}

std::string AssetRows(const core::JsonField& asset) {
  const auto row = [&](const std::string& name, const core::JsonField& estimate, double factor,
                       const std::string& unit) {
    return EstimateRow(name, estimate, factor, unit, estimate["sample"].Number());
  };
  std::string html;
  for (const char* side : {"length", "width", "height"}) {
    html += row(side, asset["size_m"][side], 100.0, "cm");
  }
  html += EstimateRow("mass", asset["mass_kg"], 1000.0, "g", asset["mass"].Number());
  return html + row("friction", asset["friction"], 1.0, "") +
         row("restitution", asset["restitution"], 1.0, "");
}

// Returns the distinct sources of the asset's estimates.
std::string AssetSources(const core::JsonField& asset) {
  const core::JsonField size = asset["size_m"];
  std::set<std::string> sources;
  for (const core::JsonField& estimate :
       {size["length"], size["width"], size["height"], asset["mass_kg"], asset["friction"],
        asset["restitution"]}) {
    sources.insert(estimate.TextOr("source", ""));
  }
  std::string joined;
  for (const std::string& source : sources) {
    if (!source.empty()) joined += (joined.empty() ? "" : "; ") + source;
  }
  return joined;
}

std::string CheckTableRows(const std::vector<core::JsonField>& rows) {
  std::string html;
  for (const core::JsonField& row : rows) {
    html += "<tr><td>" + Escaped(row["property"]) + "<br/><span class=\"soft\">" +
            Escaped(row["sentence"]) + "</span></td><td class=\"n\">" +
            PageNumber("%.4g", row["figure"].Number()) + "</td></tr>\n";
  }
  return html;
}

void AddAssetPart(const PhotoRunFolder& folder, const core::JsonField& report, Values* values) {
  const core::JsonField asset = report["asset"];
  std::string findings;
  for (const core::JsonField& finding : asset["findings"].Elements()) {
    findings += "<li>" + Escaped(finding["sentence"]) + "</li>";
  }
  const std::vector<core::JsonField> rows = report["check"]["rows"].Elements();
  const auto passed = std::count_if(rows.begin(), rows.end(), [](const core::JsonField& row) {
    return row["verdict"].Text() != "FAIL";
  });
  values->insert(
      {{"photo",
        PageFigure(folder.Asset() / "lift.png", "The photo, the matte and the reconstructed mesh",
                   "The photo, its matte, and the reconstructed mesh from the photo's camera.")},
       {"lift_findings", Markup{findings}},
       {"asset", PageFigure(folder.Asset() / "preview.png", "The asset from four sides",
                            "From four sides; below, the convex collision parts.")},
       {"asset_rows", Markup{AssetRows(asset)}},
       {"material", asset["material"]["name"].Text()},
       {"sources", AssetSources(asset)},
       {"check_class", passed == std::ssize(rows) ? "good" : "bad"},
       {"check_count", std::to_string(passed) + " of " + std::to_string(rows.size())},
       {"check_rows", Markup{CheckTableRows(rows)}}});
}

// Returns the drawing of the task with the objects of its scene.
std::string TaskSvg(const PhotoRunFolder& folder, const tasks::Task& task,
                    const core::JsonField& scene) {
  std::vector<assets::SemanticModel> models = {
      assets::ReadSemanticModel(folder.Asset()),
      assets::ReadSemanticModel(folder.Furniture() / scene["furniture"].Text())};
  return TaskDrawing(task, tasks::MakeWorldModel(models));
}

void AddTaskPart(const PhotoRunFolder& folder, const tasks::Task& task,
                 const core::JsonField& report, Values* values) {
  const core::JsonField scene = report["scene"];
  const std::string name = scene["furniture"].Text();
  std::string subtasks;
  for (const core::JsonField& subtask : report["task"]["subtasks"].Elements()) {
    subtasks += "<li>" + Escaped(subtask["description"]) +
                "<br/><span class=\"soft\">Done: " + Escaped(subtask["success"]) + ".</span></li>";
  }
  const bool beside = std::find(task.assets.begin(), task.assets.end(), name) != task.assets.end();
  values->insert(
      {{"task",
        Figure(InlinePicture(TaskSvg(folder, task, scene), "image/svg+xml",
                             "The scene from above, and the subtasks"),
               report["task"]["name"].Text() + ": the start seen from above, and the subtasks.",
               "")},
       {"subtasks", Markup{subtasks}},
       {"furniture",
        PageFigure(folder.Furniture() / name / "preview.png", "The furniture, closed and open",
                   "Tasks were generated for the asset and " + name + ", which is " +
                       (scene["holds_it"].Flag() ? "big enough" : "too small") + " to hold it" +
                       (beside ? "." : "; this task needs the asset alone."))}});
}

Markup TrainingFigures(const PhotoRunFolder& folder, const core::JsonField& report) {
  Markup html;
  int number = 0;
  for (const core::JsonField& subtask : report["training"]["subtasks"].Elements()) {
    const std::string name = subtask["name"].Text();
    const fs::path trained = folder.Skill() / (std::to_string(++number) + "_" + name);
    html.text +=
        PageFigure(trained / rl::kCurvesFile, "Success and return over the training's samples",
                   name + PageNumber(": %.0f decisions in ", subtask["samples"].Number()) +
                       Duration(subtask["seconds"].Number()) + ", learnt by " +
                       subtask.TextOr("method", "training") +
                       ". With sampled actions and easier starts.")
            .text;
  }
  return html;
}

std::string SuccessRow(const std::string& name, const core::JsonField& counts,
                       const char* successes, const char* tries) {
  if (counts[tries].Int() == 0) return Row(name, {"not reached", "", ""});
  const double low = counts["low"].Number(), high = counts["high"].Number();
  return Row(name, {PageNumber("%.0f of %.0f", counts[successes].Number(), counts[tries].Number()),
                    PagePercent(Rate(counts, successes, tries)),
                    PageNumber("%.1f to %.1f %%", 100.0 * low, 100.0 * high) + Bar(low, high)});
}

Markup SuccessRows(const core::JsonField& success) {
  const std::vector<core::JsonField> subtasks = success["subtasks"].Elements();
  Markup html;
  for (const core::JsonField& subtask : subtasks) {
    html.text += SuccessRow(Escaped(subtask["name"]), subtask, "succeeded", "tried");
  }
  if (subtasks.size() > 1) {
    html.text += SuccessRow("<b>the whole task</b>", success, "successes", "episodes");
  }
  return html;
}

std::string JointRow(const core::JsonField& joint) {
  std::vector<std::string> figures;
  for (const char* quantity : {"position", "velocity", "acceleration", "jerk"}) {
    figures.push_back(PagePercent(joint[quantity]["share"].Number()));
  }
  figures.push_back(PageNumber("%.2f", 1000.0 * joint["deviation"].Number()));
  return Row(Escaped(joint["name"]), figures);
}

Markup TrajectoryPart(const core::JsonField& trajectory) {
  if (trajectory.Has("refusal")) {
    return {"<p class=\"bad\">There is none: " + Escaped(trajectory["refusal"]) + ".</p>\n"};
  }
  const bool replayed = trajectory["replayed"].Flag();
  std::string rows;
  for (const core::JsonField& joint : trajectory["joints"].Elements()) rows += JointRow(joint);
  return {core::FillTemplate(
      data::photo_run_trajectory_html(),
      {{"file", trajectory["file"].Text()},
       {"seconds", PageNumber("%.2f", trajectory["mean_seconds"].Number())},
       {"stretch", PageNumber("%.2f", trajectory["stretch"].Number())},
       {"deviation", PageNumber("%.2f", 1000.0 * trajectory["tool_deviation"].Number())},
       {"replay_class", replayed ? "good" : "bad"},
       {"replay", replayed ? "succeeds" : "fails"},
       {"joint_rows", Markup{rows}}})};
}

Markup TimeRows(const core::JsonField& report) {
  const double whole = std::max(1e-9, report["seconds"].Number());
  Markup html;
  for (const core::JsonField& stage : report["stages"].Elements()) {
    const double seconds = stage["seconds"].Number();
    html.text += "<tr><td>" + Escaped(stage["name"]) + "</td><td class=\"n\">" + Duration(seconds) +
                 "</td><td>" + Bar(0.0, seconds / whole) + "</td></tr>\n";
  }
  return html;
}

}  // namespace

std::string PhotoRunPage(const PhotoRunFolder& folder, const tasks::Task& task,
                         const core::JsonField& report) {
  Values values = {
      {"description", report["task"]["description"].Text()},
      {"tiles", Markup{Tiles(report)}},
      {"training", TrainingFigures(folder, report)},
      {"success_rows", SuccessRows(report["success"])},
      {"episode",
       PageFigure(folder.Strip(), "The robot in twelve moments of each subtask",
                  "One episode, from left to right: twelve moments of each subtask.", "wide")},
      {"trajectory", TrajectoryPart(report["trajectory"])},
      {"time_rows", TimeRows(report)},
      {"seconds", Duration(report["seconds"].Number())},
      {"command", report["command"].Text()}};
  AddAssetPart(folder, report, &values);
  AddTaskPart(folder, task, report, &values);
  return Page("From a photo to a skill: " + report["category"].Text(), data::photo_run_css(),
              core::FillTemplate(data::photo_run_html(), values));
}

}  // namespace simwright::workflows
