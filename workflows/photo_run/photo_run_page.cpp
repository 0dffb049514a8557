#include "workflows/photo_run/photo_run_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/files.h"
#include "rl/training.h"
#include "tasks/world_state.h"
#include "workflows/tasks/page_markup.h"
#include "workflows/tasks/task_drawing.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPhotoRunStyle =
    ":root{color-scheme:light dark;--ink:#1d2327;--soft:#5b666d;--line:#d9dee1;--paper:#fff;"
    "--panel:#f3f5f6;--accent:#1f5fa8;--good:#2f7a45;--bad:#b5443a}"
    "@media(prefers-color-scheme:dark){:root{--ink:#e6e9eb;--soft:#9aa5ab;--line:#343b40;"
    "--paper:#14181b;--panel:#1d2327;--accent:#7db4ee;--good:#7cc792;--bad:#ee8f86}}"
    "body{font:16px/1.55 system-ui,sans-serif;margin:0 auto;max-width:60rem;padding:1.5rem 1rem "
    "4rem;background:var(--paper);color:var(--ink)}h1{line-height:1.2;margin:.5em 0 0}"
    "h2{margin:2.5em 0 .4em;border-top:1px solid var(--line);padding-top:1em}"
    ".soft,figcaption{color:var(--soft)}figcaption,.soft{font-size:.88rem}figure{margin:1rem 0}"
    "img{display:block;max-width:100%;height:auto;border-radius:6px;background:#fff}"
    ".wide{overflow-x:auto}.wide img,.wide table{min-width:44rem}.full img,.wide img{width:100%}"
    "table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}"
    "td,th{overflow-wrap:anywhere;padding:.3rem .8rem .3rem 0;text-align:left;border-bottom:1px "
    "solid "
    "var(--line);vertical-align:top}th{font-weight:600;font-size:.88rem;color:var(--soft)}"
    ".n{text-align:right;white-space:nowrap}.tiles{display:grid;grid-template-columns:repeat(auto-"
    "fit,minmax(9.5rem,"
    "1fr));gap:.75rem;margin:1.5rem 0}.tile{background:var(--panel);padding:.8rem "
    "1rem;border-radius:8px;font-size:.88rem}.tile b{display:block;font-size:1.55rem;"
    "line-height:1.3}.bar{display:block;min-width:6rem;height:.7rem;margin-top:.45rem;"
    "background:var(--panel);border-radius:3px}.bar i{display:block;height:100%;"
    "background:var(--accent);border-radius:3px}.good{color:var(--good)}.bad{color:var(--bad)}"
    "pre{background:var(--panel);padding:.8rem 1rem;border-radius:8px;white-space:pre-wrap;"
    "overflow-wrap:anywhere}summary{cursor:pointer}li{margin:.4em 0}";

std::string PageNumber(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof(text), format, a, b, c);
  return text;
}

std::string PageText(const Json& json) {
  return MarkupSafe(json.get<std::string>());
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

std::string Head(const std::string& name, const std::vector<std::string>& figures) {
  std::string row = "<tr><th>" + name + "</th>";
  for (const std::string& figure : figures) row += "<th class=\"n\">" + figure + "</th>";
  return row + "</tr>\n";
}

// Returns a bar; `begin` and `end` are fractions of its width.
std::string Bar(double begin, double end) {
  return "<span class=\"bar\"><i style=\"margin-left:" + PageNumber("%.1f", 100.0 * begin) +
         "%;width:" + PageNumber("%.1f", 100.0 * std::max(0.004, end - begin)) + "%\"></i></span>";
}

std::string Section(const std::string& title) {
  return "<h2>" + title + "</h2>\n";
}

// Returns a figure. `fit`: "full", as wide as the page; "wide", scrolled sideways so that it stays
// legible.
std::string PageFigure(const fs::path& file, const std::string& description,
                       const std::string& caption, const std::string& fit = "full") {
  const std::string type = file.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return "<figure><div class=\"" + fit + "\">" +
         InlinePicture(core::ReadFile(file, 1 << 28), type, description) + "</div><figcaption>" +
         caption + "</figcaption></figure>\n";
}

std::string Tile(const std::string& figure, const std::string& what) {
  return "<div class=\"tile\"><b>" + figure + "</b>" + what + "</div>\n";
}

double Rate(const Json& counts, const char* successes, const char* tries) {
  return counts.at(successes).get<double>() / std::max(1.0, counts.at(tries).get<double>());
}

std::string Summary(const Json& report) {
  const Json& success = report.at("success");
  const Json& trajectory = report.at("trajectory");
  std::string html =
      "<p>" + PageText(report.at("task").at("description")) +
      " From one photo to joint trajectories of a Franka Panda.</p>\n"
      "<div class=\"tiles\">\n" +
      Tile(PagePercent(Rate(success, "successes", "episodes")),
           PageNumber("success in %.0f episodes; 95 %%: ", success.at("episodes").get<double>()) +
               PageNumber("%.1f to %.1f %%", 100.0 * success.at("low").get<double>(),
                          100.0 * success.at("high").get<double>()));
  if (success.at("successes").get<int>() > 0) {
    html += Tile(Duration(success.at("mean_seconds")), "a success, on average");
  }
  if (trajectory.contains("mean_seconds")) {
    html += Tile(Duration(trajectory.at("mean_seconds")),
                 std::string("the trajectory; its replay ") +
                     (trajectory.at("replayed").get<bool>() ? "succeeds" : "fails"));
  }
  return html + Tile(Duration(report.at("seconds")), "for everything on this page") + "</div>\n";
}

std::string EstimateRow(const std::string& name, const Json& estimate, double factor,
                        const std::string& unit, double actual) {
  return Row(name, {PageNumber("%.3g ", factor * actual) + unit,
                    PageNumber("%.3g to %.3g ", factor * estimate.at("min").get<double>(),
                               factor * estimate.at("max").get<double>()) +
                        unit});
}

std::string AssetTable(const Json& asset) {
  std::set<std::string> sources;
  const auto row = [&](const std::string& name, const Json& estimate, double factor,
                       const std::string& unit) {
    sources.insert(estimate.value("source", ""));
    return EstimateRow(name, estimate, factor, unit, estimate.at("sample").get<double>());
  };
  std::string html = "<table>\n" + Head("", {"this one", "of its kind"});
  for (const char* side : {"length", "width", "height"}) {
    html += row(side, asset.at("size_m").at(side), 100.0, "cm");
  }
  sources.insert(asset.at("mass_kg").value("source", ""));
  html += EstimateRow("mass", asset.at("mass_kg"), 1000.0, "g", asset.at("mass").get<double>());
  html += row("friction", asset.at("friction"), 1.0, "") +
          row("restitution", asset.at("restitution"), 1.0, "") + "</table>\n<p class=\"soft\">" +
          "Material: " + PageText(asset.at("material").at("name")) + ". Ranges from ";
  std::string joined;
  for (const std::string& source : sources) {
    if (!source.empty()) joined += (joined.empty() ? "" : "; ") + source;
  }
  return html + MarkupSafe(joined) + ".</p>\n";
}

std::string CheckTable(const Json& check) {
  const Json& rows = check.at("rows");
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const Json& row) {
    return row.at("verdict").get<std::string>() == "FAIL";
  });
  std::string html =
      "<details><summary><span class=\"" + std::string(failed ? "bad" : "good") + "\">" +
      PageNumber("%.0f of %.0f", static_cast<double>(rows.size()) - failed,
                 static_cast<double>(rows.size())) +
      " properties pass</span>: geometry, inertia, three readers, a drop test in two "
      "engines</summary><table>\n" +
      Head("property", {"figure"});
  for (const Json& row : rows) {
    html += "<tr><td>" + PageText(row.at("property")) + "<br/><span class=\"soft\">" +
            PageText(row.at("sentence")) + "</span></td><td class=\"n\">" +
            PageNumber("%.4g", row.at("figure").get<double>()) + "</td></tr>\n";
  }
  return html + "</table></details>\n";
}

std::string AssetPart(const PhotoRunFolder& folder, const Json& report) {
  std::string html =
      Section("The photo") +
      PageFigure(folder.Asset() / "lift.png", "The photo, the matte and the reconstructed mesh",
                 "The photo, its matte, and the reconstructed mesh from the photo's camera.") +
      "<ul class=\"soft\">";
  for (const Json& finding : report.at("asset").at("findings")) {
    html += "<li>" + PageText(finding.at("sentence")) + "</li>";
  }
  return html + "</ul>\n" + Section("The asset") +
         PageFigure(folder.Asset() / "preview.png", "The asset from four sides",
                    "From four sides; below, the convex collision parts.") +
         AssetTable(report.at("asset")) + CheckTable(report.at("check"));
}

// Returns the drawing of the task with the objects of its scene.
std::string TaskSvg(const PhotoRunFolder& folder, const tasks::Task& task, const Json& scene) {
  std::vector<assets::SemanticModel> models = {
      assets::ReadSemanticModel(folder.Asset()),
      assets::ReadSemanticModel(folder.Furniture() / scene.at("furniture").get<std::string>())};
  return TaskDrawing(task, tasks::MakeWorldModel(models));
}

std::string TaskPart(const PhotoRunFolder& folder, const tasks::Task& task, const Json& report) {
  const Json& scene = report.at("scene");
  const std::string name = scene.at("furniture");
  std::string html = Section("The task") + "<figure><div>" +
                     InlinePicture(TaskSvg(folder, task, scene), "image/svg+xml",
                                   "The scene from above, and the subtasks") +
                     "</div><figcaption>" + PageText(report.at("task").at("name")) +
                     ": the start seen from above, and the subtasks.</figcaption></figure>\n"
                     "<ol>";
  for (const Json& subtask : report.at("task").at("subtasks")) {
    html += "<li>" + PageText(subtask.at("description")) +
            "<br/><span class=\"soft\">Done: " + PageText(subtask.at("success")) + ".</span></li>";
  }
  const bool beside = std::find(task.assets.begin(), task.assets.end(), name) != task.assets.end();
  return html + "</ol>\n" +
         PageFigure(folder.Furniture() / name / "preview.png", "The furniture, closed and open",
                    "Tasks were generated for the asset and " + MarkupSafe(name) + ", which is " +
                        (scene.at("holds_it").get<bool>() ? "big enough" : "too small") +
                        " to hold it" + (beside ? "." : "; this task needs the asset alone."));
}

std::string TrainingPart(const PhotoRunFolder& folder, const Json& report) {
  const Json& subtasks = report.at("training").at("subtasks");
  std::string html =
      Section("Training") + "<p>One policy per subtask, trained in Bullet (docs/skills.md).</p>\n";
  int number = 0;
  for (const Json& subtask : subtasks) {
    const std::string name = subtask.at("name");
    const fs::path trained = folder.Skill() / (std::to_string(++number) + "_" + name);
    html += PageFigure(trained / rl::kCurvesFile, "Success and return over the training's samples",
                       MarkupSafe(name) +
                           PageNumber(": %.0f decisions in ", subtask.at("samples").get<double>()) +
                           Duration(subtask.at("seconds")) + ", learnt by " +
                           PageText(subtask.value("method", Json("training"))) +
                           ". With sampled actions and easier starts.");
  }
  return html;
}

std::string SuccessRow(const std::string& name, const Json& counts, const char* successes,
                       const char* tries) {
  if (counts.at(tries).get<int>() == 0) return Row(name, {"not reached", "", ""});
  const double low = counts.at("low"), high = counts.at("high");
  return Row(name, {PageNumber("%.0f of %.0f", counts.at(successes).get<double>(),
                               counts.at(tries).get<double>()),
                    PagePercent(Rate(counts, successes, tries)),
                    PageNumber("%.1f to %.1f %%", 100.0 * low, 100.0 * high) + Bar(low, high)});
}

std::string SuccessPart(const PhotoRunFolder& folder, const Json& report) {
  const Json& success = report.at("success");
  std::string html = Section("How often it succeeds") + "<table>\n" +
                     Head("", {"successes", "rate", "95 % interval"});
  for (const Json& subtask : success.at("subtasks")) {
    html += SuccessRow(PageText(subtask.at("name")), subtask, "succeeded", "tried");
  }
  if (success.at("subtasks").size() > 1) {
    html += SuccessRow("<b>the whole task</b>", success, "successes", "episodes");
  }
  return html +
         "</table>\n<p class=\"soft\">Starts are newly sampled: positions within 15 cm, masses "
         "and frictions. A subtask is tried if the previous ones succeeded. Success must hold at "
         "the episode's end.</p>\n" +
         Section("One episode") +
         PageFigure(folder.Strip(), "The robot in twelve moments of each subtask",
                    "One episode, from left to right: twelve moments of each subtask.", "wide");
}

std::string JointRow(const Json& joint) {
  std::vector<std::string> figures;
  for (const char* quantity : {"position", "velocity", "acceleration", "jerk"}) {
    figures.push_back(PagePercent(joint.at(quantity).at("share").get<double>()));
  }
  figures.push_back(PageNumber("%.2f", 1000.0 * joint.at("deviation").get<double>()));
  return Row(PageText(joint.at("name")), figures);
}

std::string TrajectoryPart(const Json& report) {
  const Json& trajectory = report.at("trajectory");
  std::string html = Section("The trajectory");
  if (trajectory.contains("refusal")) {
    return html + "<p class=\"bad\">There is none: " + PageText(trajectory.at("refusal")) +
           ".</p>\n";
  }
  const bool replayed = trajectory.at("replayed");
  html += "<p>" + PageText(trajectory.at("file")) +
          PageNumber(
              ", 1 kHz from rest to rest, %.2f s, %.2f times the recorded duration; the tool "
              "deviates by at most %.2f mm. ",
              trajectory.at("mean_seconds").get<double>(), trajectory.at("stretch").get<double>(),
              1000.0 * trajectory.at("tool_deviation").get<double>()) +
          "<span class=\"" +
          (replayed ? "good\">Its replay from the file alone succeeds."
                    : "bad\">Its replay from the file alone fails.") +
          "</span></p>\n<div class=\"wide\"><table>\n" +
          Head("largest share of each limit",
               {"position", "velocity", "acceleration", "jerk", "deviation, mrad or mm"});
  for (const Json& joint : trajectory.at("joints")) html += JointRow(joint);
  return html + "</table></div>\n";
}

std::string TimesPart(const Json& report) {
  const double whole = std::max(1e-9, report.at("seconds").get<double>());
  std::string html = Section("Time") + "<table>\n";
  for (const Json& stage : report.at("stages")) {
    const double seconds = stage.at("seconds");
    html += "<tr><td>" + PageText(stage.at("name")) + "</td><td class=\"n\">" + Duration(seconds) +
            "</td><td>" + Bar(0.0, seconds / whole) + "</td></tr>\n";
  }
  return html + "<tr><td><b>all</b></td><td class=\"n\">" + Duration(whole) +
         "</td><td></td></tr>\n</table>\n" + Section("To reproduce") + "<pre>" +
         PageText(report.at("command")) + "</pre>\n";
}

}  // namespace

std::string PhotoRunPage(const PhotoRunFolder& folder, const tasks::Task& task,
                         const Json& report) {
  return PageStart("From a photo to a skill: " + report.at("category").get<std::string>(),
                   kPhotoRunStyle) +
         Summary(report) + AssetPart(folder, report) + TaskPart(folder, task, report) +
         TrainingPart(folder, report) + SuccessPart(folder, report) + TrajectoryPart(report) +
         TimesPart(report) + PageEnd();
}

}  // namespace simwright::workflows
