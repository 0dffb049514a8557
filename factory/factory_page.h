#pragma once

#include <string>
#include <vector>

#include "factory/factory_folder.h"
#include "factory/factory_plan.h"
#include "factory/factory_record.h"

namespace simwright::factory {

// The state of a factory, from the records in its folder.
struct FactoryState {
  std::vector<AssetRecord> assets;    // made or failed, in the order of the plan
  std::vector<TaskPartRecord> parts;  // by number
  int made() const;
  int failed() const;
  int variants() const;
  int tasks() const;
};

FactoryState ReadFactoryState(const FactoryPlan& plan, const FactoryFolder& folder);

enum class WorkerStage { kRunning, kStopped, kFinished };

// The worker that writes the page.
struct WorkerState {
  WorkerStage stage = WorkerStage::kRunning;
  double seconds = 0.0;  // since it started
  double busy = 0.0;     // share of its processors' time, [0, 1]
  int threads = 1;
};

// Returns the dashboard, which a browser loads again every few seconds while a worker runs.
std::string FactoryPage(const FactoryPlan& plan, const FactoryState& state,
                        const WorkerState& worker);

}  // namespace simwright::factory
