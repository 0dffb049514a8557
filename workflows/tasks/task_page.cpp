#include "workflows/tasks/task_page.h"

#include <algorithm>

#include "reward/reward_program.h"
#include "workflows/tasks/page_markup.h"
#include "workflows/tasks/task_drawing.h"

namespace simwright::workflows {
namespace {

constexpr const char* kTaskPageStyle =
    "body{font-family:sans-serif;margin:2em auto;max-width:1000px;color:#222}"
    "table{border-collapse:collapse}td,th{padding:3px 10px;text-align:left;border-bottom:1px solid "
    "#ddd}pre{background:#f5f5f2;padding:8px;overflow-x:auto;font-size:12px}.bad{color:#b5443a}"
    ".good{color:#3d7a3c}h2{margin-top:2em;border-top:1px solid #ccc;padding-top:.6em}"
    "summary{cursor:pointer}";

std::string Verdict(bool valid) {
  return valid ? "<span class=\"good\">valid</span>" : "<span class=\"bad\">not valid</span>";
}

std::string FindingsText(const core::Findings& findings, const std::string& program) {
  std::string html;
  for (const core::Finding& finding : findings) {
    html += "<pre class=\"bad\">" + MarkupSafe(reward::RenderFinding(finding, program)) + "</pre>";
  }
  return html;
}

std::string SubtaskText(const tasks::Subtask& subtask) {
  std::string html = "<details><summary>" + MarkupSafe(subtask.name) + ": " +
                     Verdict(subtask.valid()) + "</summary><p>" + MarkupSafe(subtask.description) +
                     "</p><pre>" + MarkupSafe(subtask.program) + "</pre>" +
                     FindingsText(subtask.findings, subtask.program);
  for (std::size_t i = 0; i < subtask.attempts.size(); ++i) {
    const tasks::Attempt& attempt = subtask.attempts[i];
    html += "<details><summary>attempt " + std::to_string(i + 1) + "</summary><pre>" +
            MarkupSafe(attempt.program) + "</pre>" +
            FindingsText(attempt.findings, attempt.program) + "</details>";
  }
  return html + "</details>\n";
}

}  // namespace

std::string TaskPage(const tasks::TaskSet& set, const tasks::WorldModel& model) {
  std::string html =
      PageStart("Tasks", kTaskPageStyle) + "<p>" + std::to_string(set.tasks.size()) + " tasks on " +
      std::to_string(set.assets.size()) +
      " assets.</p>\n<table><tr><th>task</th><th>subtasks</th><th>from</th><th></th></tr>\n";
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    const tasks::Task& task = set.tasks[i];
    html += "<tr><td><a href=\"#task" + std::to_string(i) + "\">" + MarkupSafe(task.name) +
            "</a></td><td>" + std::to_string(task.subtasks.size()) + "</td><td>" +
            MarkupSafe(task.source) + "</td><td>" + Verdict(task.valid()) + "</td></tr>\n";
  }
  html += "</table>\n";
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    const tasks::Task& task = set.tasks[i];
    html += "<h2 id=\"task" + std::to_string(i) + "\">" + MarkupSafe(task.name) + "</h2>\n<p>" +
            MarkupSafe(task.description) + "</p>\n" + TaskDrawing(task, model) +
            FindingsText(task.findings, "");
    for (const tasks::Subtask& subtask : task.subtasks) html += SubtaskText(subtask);
  }
  return html + PageEnd();
}

}  // namespace simwright::workflows
