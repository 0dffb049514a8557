#include "transfer/motion_choice.h"

#include <cstdio>

#include "core/error.h"
#include "core/json.h"
#include "transfer/twin_ranges.h"
#include "workflows/skills/motion_files.h"

namespace simwright::transfer {

MotionChoice ExportChosenMotion(const MotionChoiceRequest& request, core::Progress* progress) {
  const std::string ending = request.output.extension();
  if (ending != ".yaml" && ending != ".yml" && ending != ".json" && ending != ".csv") {
    throw core::Error("is not the name of a file of a motion", request.output.string(),
                      "use the extension .yaml, .json or .csv");
  }
  const workflows::TwinRecord record = workflows::ReadTwin(request.twin);
  const TransferTask task(workflows::ReadRun(request.run));
  const PerturbedTwin twin = PerturbedTwinOf(task, record, request.twin);
  const std::vector<rl::Policy> policies = PoliciesOf(task);
  if (policies.empty()) {
    throw core::Error("a subtask has no policy yet", request.run.string(),
                      "continue with `simwright train ... --resume`");
  }
  const MotionRecorder recorder(task, policies, PlacementRanges(request.twin, request.sigmas));
  const ChosenMotion chosen =
      ChooseMotion(recorder, task, twin, request.episodes, request.worlds, request.seed, progress);
  workflows::WriteMotion(chosen.motion.trajectory, request.output);
  MotionChoice choice;
  choice.file = request.output;
  choice.episodes = chosen.episodes;
  choice.recorded = chosen.recorded;
  choice.rate = chosen.rate;
  choice.first = chosen.first;
  choice.seconds = chosen.motion.trajectory.times.back();
  return choice;
}

std::string MotionChoiceTable(const MotionChoice& choice) {
  char text[320];
  std::snprintf(text, sizeof text,
                "%d of %d episodes give motions that succeed in the twin itself\n"
                "the chosen one succeeds in %d of %d perturbed twins, the first in %d; it takes "
                "%.1f s\n",
                choice.recorded, choice.episodes, choice.rate.successes, choice.rate.worlds,
                choice.first.successes, choice.seconds);
  return text;
}

std::string MotionChoiceJson(const MotionChoice& choice) {
  const core::Json json = {
      {"output", choice.file.string()},     {"episodes", choice.episodes},
      {"recorded", choice.recorded},        {"worlds", choice.rate.worlds},
      {"successes", choice.rate.successes}, {"successes_of_the_first", choice.first.successes},
      {"seconds", choice.seconds}};
  return core::JsonText(json);
}

}  // namespace simwright::transfer
