#include "factory/factory_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "core/text_template.h"
#include "factory/factory_tasks.h"
#include "workflows/tasks/page_markup.h"

namespace simwright::factory {
namespace data {

// The file templates/factory_page.html, embedded.
std::string_view factory_page_html();

}  // namespace data

namespace {

constexpr size_t kMostPictures = 400, kMostFailures = 200;

std::string Bar(const std::string& label, int done, int failed, int total) {
  const double all = std::max(1, total);
  char text[420];
  std::snprintf(text, sizeof text,
                "<p>%s: %d of %d%s</p><div class=\"bar\"><div class=\"done\" "
                "style=\"width:%.1f%%\"></div><div class=\"failed\" style=\"width:%.1f%%\"></div>"
                "</div>\n",
                core::EscapedMarkup(label).c_str(), done, total,
                failed > 0 ? (", " + std::to_string(failed) + " failed").c_str() : "",
                std::min(100.0, 100.0 * done / all), std::min(100.0, 100.0 * failed / all));
  return text;
}

std::string TimeText(double seconds) {
  char text[40];
  if (seconds < 90.0) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60.0);
  }
  return text;
}

const char* StageText(WorkerStage stage) {
  switch (stage) {
    case WorkerStage::kRunning:
      return "Running";
    case WorkerStage::kStopped:
      return "Stopped (resume with --resume)";
    case WorkerStage::kFinished:
      break;
  }
  return "Finished";
}

std::string FailureRows(const FactoryState& state) {
  std::string rows;
  size_t count = 0;
  for (const AssetRecord& asset : state.assets) {
    for (size_t k = 0; k < asset.failures.size() && count < kMostFailures; ++k, ++count) {
      const FactoryFailure& failure = asset.failures[k];
      const bool last = k + 1 == asset.failures.size();
      const std::string then = !failure.changed.empty() ? "tried again with " + failure.changed
                               : asset.made()           ? "kept without"
                                                        : "given up";
      rows += "<tr><td>" + core::EscapedMarkup(asset.name) + "</td><td>" +
              core::EscapedMarkup(failure.reason) + "</td><td>" + core::EscapedMarkup(then) +
              (last && asset.made() && !failure.changed.empty() ? ", which was made" : "") +
              "</td></tr>\n";
    }
  }
  for (const TaskPartRecord& part : state.parts) {
    if (part.reason.empty()) continue;
    rows += "<tr><td>tasks, part " + std::to_string(part.part) + "</td><td>" +
            core::EscapedMarkup(part.reason) + "</td><td>" + std::to_string(part.made) + " of " +
            std::to_string(part.asked) + " made</td></tr>\n";
  }
  return rows;
}

std::string Pictures(const FactoryState& state) {
  std::string pictures;
  size_t count = 0;
  const auto add = [&](const std::string& folder) {
    if (++count > kMostPictures) return;
    const std::string escaped = core::EscapedMarkup(folder);
    const std::string name = core::EscapedMarkup(folder.substr(folder.find('/') + 1));
    pictures += "<figure><img loading=\"lazy\" src=\"" + escaped + "/preview.png\" alt=\"" + name +
                "\"/><figcaption>" + name + "</figcaption></figure>\n";
  };
  for (const AssetRecord& asset : state.assets) {
    if (!asset.made()) continue;
    add(asset.folder);
    for (const std::string& variant : asset.variants) add(variant);
  }
  return pictures;
}

std::string TasksText(const FactoryState& state) {
  int asked = 0;
  for (const TaskPartRecord& part : state.parts) asked += part.asked;
  return std::to_string(state.tasks()) + " verified tasks in " +
         std::to_string(state.parts.size()) + " parts (" + std::to_string(asked) + " asked for)";
}

}  // namespace

int FactoryState::made() const {
  return static_cast<int>(std::count_if(assets.begin(), assets.end(),
                                        [](const AssetRecord& asset) { return asset.made(); }));
}

int FactoryState::failed() const {
  return static_cast<int>(assets.size()) - made();
}

int FactoryState::variants() const {
  size_t sum = 0;
  for (const AssetRecord& asset : assets) sum += asset.variants.size();
  return static_cast<int>(sum);
}

int FactoryState::tasks() const {
  int sum = 0;
  for (const TaskPartRecord& part : parts) sum += part.made;
  return sum;
}

FactoryState ReadFactoryState(const FactoryPlan& plan, const FactoryFolder& folder) {
  FactoryState state;
  for (const FactoryItem& item : plan.items) {
    if (auto record = ReadAssetRecord(folder.asset_record(item.name))) {
      state.assets.push_back(std::move(*record));
    }
  }
  for (int part = 0; part < 2 * PartCount(plan) + 1; ++part) {
    if (auto record = ReadTaskPart(folder.task_record(part))) {
      state.parts.push_back(std::move(*record));
    }
  }
  return state;
}

std::string FactoryPage(const FactoryPlan& plan, const FactoryState& state,
                        const WorkerState& worker) {
  const int total = static_cast<int>(plan.items.size());
  double cpu = 0.0;
  for (const AssetRecord& asset : state.assets) cpu += asset.cpu_seconds;
  const int recorded = static_cast<int>(state.assets.size());
  const double mean = recorded > 0 ? cpu / recorded : 0.0;
  const double left = (total - recorded) * mean / std::max(1, worker.threads);
  const bool running = worker.stage == WorkerStage::kRunning;
  char line[300];
  std::snprintf(line, sizeof line,
                "%s after %s; processors %.0f %% busy; %.1f s of processor time "
                "an asset%s",
                StageText(worker.stage), TimeText(worker.seconds).c_str(), 100.0 * worker.busy,
                mean,
                running && recorded > 0 && recorded < total
                    ? ("; about " + TimeText(left) + " left for the assets").c_str()
                    : "");
  const std::string bars = Bar("Assets", state.made(), state.failed(), total) +
                           Bar("Verified tasks", state.tasks(), 0, plan.tasks);
  const std::string failures = FailureRows(state);
  const std::string title = plan.theme.empty() ? "Factory" : "Factory: " + plan.theme;
  const std::string body = core::FillTemplate(
      data::factory_page_html(),
      {{"state", line},
       {"bars", core::Markup{bars}},
       {"refresh", core::Markup{worker.stage != WorkerStage::kFinished
                                    ? "<meta http-equiv=\"refresh\" content=\"4\"/>"
                                    : ""}},
       {"variants",
        state.variants() > 0 ? std::to_string(state.variants()) + " texture variants. " : ""},
       {"tasks", TasksText(state)},
       {"failures",
        core::Markup{failures.empty() ? "<tr><td colspan=\"3\">none</td></tr>" : failures}},
       {"pictures", core::Markup{Pictures(state)}}});
  return workflows::Page(title, workflows::data::photo_run_css(), body);
}

}  // namespace simwright::factory
