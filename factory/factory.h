#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/finding.h"
#include "core/progress.h"
#include "core/ranks.h"
#include "factory/factory_page.h"
#include "factory/factory_plan.h"
#include "texture/image_generator.h"

namespace simwright::factory {

struct FactoryRequest {
  std::filesystem::path plan;                          // the user's plan; empty: `theme`
  FactoryThemeRequest theme;                           // used if its theme is not empty
  std::filesystem::path output;                        // the factory's folder
  bool resume = false;                                 // resumes, or joins, the work in the folder
  std::shared_ptr<texture::ImageGenerator> generator;  // for texture variants by words
  core::RankPlace place;  // among the processes that one command line started
};

struct FactoryReport {
  FactoryPlan plan;
  FactoryState state;
  WorkerState worker;
  std::filesystem::path folder, page, tasks;  // tasks: empty if there are none
  int kept = 0;                               // assets that earlier or other workers had made
  core::Findings findings;
};

// Makes the assets and the tasks of a plan. Each asset and each part of the tasks is a unit of
// work, claimed by a lock file in the folder: any number of workers, on any machines that share the
// folder, take the next free one, and a worker that is killed loses only what it was making. A
// record in done/ tells what became of each; index.html, the dashboard, is written again while the
// work goes on, by the first rank of a launcher. Ranks and the tasks of a Slurm array, which all
// have the same command line, join a folder with their plan without `resume`. Throws core::Error
// for a wrong plan, a folder with another plan, one with a plan but without `resume`, and a full
// disk; core::Cancelled after Ctrl-C.
FactoryReport RunFactory(const FactoryRequest& request, core::Progress* progress);

std::string FactoryTable(const FactoryReport& report);
std::string FactoryJson(const FactoryReport& report);

}  // namespace simwright::factory
