#include "workflows/tasks/task_page.h"

#include <algorithm>

#include "reward/reward_program.h"
#include "workflows/tasks/page_markup.h"
#include "workflows/tasks/task_drawing.h"

namespace simwright::workflows {
namespace {

std::string Verdict(bool valid) {
  return valid ? "<span class=\"good\">valid</span>" : "<span class=\"bad\">not valid</span>";
}

std::string FindingsText(const core::Findings& findings, const std::string& program) {
  std::string html;
  for (const core::Finding& finding : findings) {
    html += "<pre class=\"bad\">" + core::EscapedMarkup(reward::RenderFinding(finding, program)) +
            "</pre>";
  }
  return html;
}

std::string SubtaskText(const tasks::Subtask& subtask) {
  std::string html = "<details><summary>" + core::EscapedMarkup(subtask.name) + ": " +
                     Verdict(subtask.valid()) + "</summary><p>" +
                     core::EscapedMarkup(subtask.description) + "</p><pre>" +
                     core::EscapedMarkup(subtask.program) + "</pre>" +
                     FindingsText(subtask.findings, subtask.program);
  for (std::size_t i = 0; i < subtask.attempts.size(); ++i) {
    const tasks::Attempt& attempt = subtask.attempts[i];
    html += "<details><summary>attempt " + std::to_string(i + 1) + "</summary><pre>" +
            core::EscapedMarkup(attempt.program) + "</pre>" +
            FindingsText(attempt.findings, attempt.program) + "</details>";
  }
  return html + "</details>\n";
}

std::string TaskRow(const tasks::Task& task, std::size_t number) {
  return "<tr><td><a href=\"#task" + std::to_string(number) + "\">" +
         core::EscapedMarkup(task.name) + "</a></td><td>" + std::to_string(task.subtasks.size()) +
         "</td><td>" + core::EscapedMarkup(task.source) + "</td><td>" + Verdict(task.valid()) +
         "</td></tr>\n";
}

std::string TaskSection(const tasks::Task& task, std::size_t number,
                        const tasks::WorldModel& model) {
  std::string subtasks;
  for (const tasks::Subtask& subtask : task.subtasks) subtasks += SubtaskText(subtask);
  return core::FillTemplate(data::task_section_html(),
                            {{"number", std::to_string(number)},
                             {"name", task.name},
                             {"description", task.description},
                             {"drawing", core::Markup{TaskDrawing(task, model)}},
                             {"findings", core::Markup{FindingsText(task.findings, "")}},
                             {"subtasks", core::Markup{subtasks}}});
}

}  // namespace

std::string TaskPage(const tasks::TaskSet& set, const tasks::WorldModel& model) {
  std::string rows, sections;
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    rows += TaskRow(set.tasks[i], i);
    sections += TaskSection(set.tasks[i], i, model);
  }
  return Page("Tasks", data::task_page_css(),
              core::FillTemplate(data::task_page_html(),
                                 {{"task_count", std::to_string(set.tasks.size())},
                                  {"asset_count", std::to_string(set.assets.size())},
                                  {"rows", core::Markup{rows}},
                                  {"sections", core::Markup{sections}}}));
}

}  // namespace simwright::workflows
