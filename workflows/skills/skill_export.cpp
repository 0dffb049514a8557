#include "workflows/skills/skill_export.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "workflows/skills/file_replay.h"
#include "workflows/skills/motion_files.h"
#include "workflows/skills/skill_demonstrations.h"
#include "workflows/skills/skill_rollout.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kCloser = 0.25;  // of the default deviation
// The largest speed-ups over the recording: unbounded (the limits apply), twice, and as recorded.
constexpr double kPaces[] = {100.0, 2.0, 1.0};

std::vector<std::string> EndingsOf(ExportFormat format) {
  switch (format) {
    case ExportFormat::kRos2:
      return {".yaml", ".yml", ".json"};
    case ExportFormat::kCsv:
      return {".csv"};
    default:
      return {".hdf5", ".h5"};
  }
}

bool WritesFolder(const ExportRequest& request) {
  return request.format != ExportFormat::kRobomimic && request.episodes > 1;
}

void RequireEnding(const ExportRequest& request) {
  const std::string ending = request.output.extension();
  const std::vector<std::string> endings = EndingsOf(request.format);
  const bool named = std::find(endings.begin(), endings.end(), ending) != endings.end();
  if (WritesFolder(request) && named) {
    throw core::Error("several trajectories need a folder", request.output.string(),
                      "give a name without " + ending + ", or --episodes 1");
  }
  if (WritesFolder(request) || named) return;
  throw core::Error("is not a file name of this format", request.output.string(),
                    "use the extension " + endings.front());
}

void WriteMotions(const std::vector<SkillMotion>& motions, const ExportRequest& request,
                  const robot::JointNames& names) {
  if (!WritesFolder(request)) {
    WriteMotion(motions.front().retimed.trajectory, request.output, names);
    return;
  }
  core::StagedFolder folder(request.output, request.force);
  for (size_t i = 0; i < motions.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "episode_%04zu", i + 1);
    WriteMotion(motions[i].retimed.trajectory,
                folder.staging() / (name + EndingsOf(request.format).front()), names);
  }
  folder.Commit();
}

void Worsen(const robot::WorstValue& value, robot::WorstValue* worst) {
  if (value.ratio > worst->ratio) *worst = value;
}

void AddMargins(const SkillMotion& motion, const skills::Skill& skill, ExportReport* report) {
  const std::vector<bool> sliding = MotionJointsOf(*skill.robot).sliding;
  report->joints.resize(sliding.size());
  for (size_t j = 0; j < sliding.size(); ++j) {
    const robot::JointLimitReport& joint = motion.limits.joints[j];
    JointMargins& margins = report->joints[j];
    margins.worst.joint = joint.joint;
    margins.slides = sliding[j];
    Worsen(joint.position, &margins.worst.position);
    Worsen(joint.velocity, &margins.worst.velocity);
    Worsen(joint.acceleration, &margins.worst.acceleration);
    Worsen(joint.jerk, &margins.worst.jerk);
    margins.deviation =
        std::max(margins.deviation, motion.retimed.deviations[static_cast<Eigen::Index>(j)]);
  }
  const double stretch = motion.retimed.stretch;
  report->least_stretch =
      report->stretch > 0.0 ? std::min(report->least_stretch, stretch) : stretch;
  report->stretch = std::max(report->stretch, stretch);
  report->tool_deviation = std::max(report->tool_deviation, motion.retimed.tool_deviation);
  report->seconds += motion.retimed.trajectory.times.back() / report->episodes;
}

// Computes the motions of recordings, verifies by replay that they reproduce their task, and keeps
// them.
class MotionVerifier {
 public:
  MotionVerifier(const TrainedTask& task, const ExportRequest& request)
      : task_(task),
        request_(request),
        ending_(WritesFolder(request) ? EndingsOf(request.format).front()
                                      : request.output.extension().string()),
        replay_(task.run(), task.skills()) {
    const MotionJoints joints = MotionJointsOf(*task.skills().front().evaluated->robot);
    if (!request.joint_names.empty()) {
      names_ = robot::JointNamesFor(request.joint_names, joints.names);
    }
  }

  const robot::JointNames& names() const { return names_; }

  // Returns true if a motion of `recording` is accepted and its file reproduces the task. Tries the
  // fastest motion, then slower ones, and finally one that is closer to the recording.
  bool Accept(const ChainRecording& recording) {
    for (const double pace : kPaces) {
      if (request_.at_recorded_speed && pace != 1.0) continue;
      robot::RetimingOptions options;
      options.max_speed_up = pace;
      try {
        if (!Try(recording, options)) continue;
      } catch (const core::Error&) {  // the retimer found no motion at this speed
        if (pace == 1.0) throw;
        continue;
      }
      const std::lock_guard lock(mutex_);
      if (pace != kPaces[0]) slowed_.insert(recording.episode);
      return true;
    }
    try {
      if (!Try(recording, Closer())) return false;
    } catch (const core::Error&) {  // no motion within the limits is that close
      return false;
    }
    const std::lock_guard lock(mutex_);
    closer_.insert(recording.episode);
    slowed_.insert(recording.episode);
    return true;
  }

  // Returns how many of `recordings`, all accepted, needed the closer motion.
  int CountCloser(const std::vector<ChainRecording>& recordings) const {
    return static_cast<int>(
        std::count_if(recordings.begin(), recordings.end(),
                      [&](const ChainRecording& one) { return closer_.contains(one.episode); }));
  }

  // Returns how many of the accepted recordings are slower than the limits allow.
  int CountSlowed(const std::vector<ChainRecording>& recordings) const {
    return static_cast<int>(
        std::count_if(recordings.begin(), recordings.end(),
                      [&](const ChainRecording& one) { return slowed_.contains(one.episode); }));
  }

  // Returns the motions of accepted recordings.
  std::vector<SkillMotion> MotionsOf(const std::vector<ChainRecording>& recordings) {
    std::vector<SkillMotion> motions;
    for (const ChainRecording& recording : recordings) {
      motions.push_back(std::move(motions_.at(recording.episode)));
    }
    return motions;
  }

 private:
  static robot::RetimingOptions Closer() {
    robot::RetimingOptions options;
    for (double* deviation :
         {&options.revolute_deviation, &options.prismatic_deviation, &options.tool_deviation}) {
      *deviation *= kCloser;
    }
    return options;
  }

  bool Try(const ChainRecording& recording, const robot::RetimingOptions& options) {
    SkillMotion motion =
        MotionOf(recording, *task_.skills().front().evaluated, options, names_.limits);
    SkillMetadata metadata = MetadataOf(task_.run(), task_.skills(), recording, request_.seed);
    metadata.times = motion.subtasks;
    motion.retimed.trajectory.metadata = MetadataLines(metadata);
    const fs::path file =
        folder_.path() / ("episode_" + std::to_string(recording.episode) + ending_);
    WriteMotion(motion.retimed.trajectory, file, names_);
    const bool reproduced = replay_.Trajectories({file}).front().success;
    fs::remove(file);
    fs::remove(MetadataFileBeside(file));
    fs::remove(GripperBeside(file));
    if (!reproduced) return false;
    const std::lock_guard lock(mutex_);
    motions_.emplace(recording.episode, std::move(motion));
    return true;
  }

  const TrainedTask& task_;
  const ExportRequest& request_;
  std::string ending_;
  robot::JointNames names_;
  FileReplay replay_;
  core::TemporaryFolder folder_;
  std::mutex mutex_;
  std::map<std::uint64_t, SkillMotion> motions_;  // by episode
  std::set<std::uint64_t> slowed_, closer_;       // episodes
};

bool ReproducesTask(const TrainedTask& task, const ChainRecording& recording, std::uint64_t seed) {
  const robot::DemonstrationSet set =
      DemonstrationsOf(task.run(), task.skills(), {recording}, seed);
  const std::vector<bool> successes = ReplayDemonstration(
      task.skills(), set.demonstrations.front(), PlansOf(set, "").front(), "a demonstration");
  return successes.size() == task.skills().size() && successes.back();
}

void AddTally(const RecordingTally& tally, ExportReport* report) {
  report->tried = tally.tried;
  report->succeeded = tally.succeeded;
  const int left_out = tally.succeeded - report->episodes;
  if (left_out == 0) return;
  core::Finding& finding = report->findings.emplace_back();
  finding.code = "export-not-reproduced";
  finding.severity = core::Severity::kWarning;
  finding.sentence =
      std::to_string(left_out) + " of " + std::to_string(tally.succeeded) +
      " successful episodes were omitted: driven by the file alone, without the policy's "
      "corrections, the robot did not reproduce the task";
  finding.remedy = "other episodes replace them; no action is needed";
  finding.figure = left_out;
}

void AddSlowed(ExportReport* report) {
  if (report->slowed == 0) return;
  core::Finding& finding = report->findings.emplace_back();
  finding.code = "export-slowed";
  finding.severity = core::Severity::kInfo;
  finding.sentence = std::to_string(report->slowed) + " of " + std::to_string(report->episodes) +
                     " motions are slower than the limits allow: at full speed the robot did not "
                     "reproduce the task";
  finding.figure = report->slowed;
}

// States by how much the motions are faster than their recordings.
void AddFaster(ExportReport* report) {
  if (report->least_stretch >= 1.0) return;
  char shares[64];
  if (report->episodes > 1) {
    std::snprintf(shares, sizeof(shares), "the motions take %.2f to %.2f", report->least_stretch,
                  report->stretch);
  } else {
    std::snprintf(shares, sizeof(shares), "the motion takes %.2f", report->stretch);
  }
  core::Finding& finding = report->findings.emplace_back();
  finding.code = "export-faster";
  finding.severity = core::Severity::kInfo;
  finding.sentence = std::string(shares) +
                     " times as long as recorded: grasps and other contacts were recorded at the "
                     "slower pace, and their replay at this one succeeded in simulation";
  finding.remedy = "use --pace recorded if a real contact needs the recorded pace";
  finding.figure = report->least_stretch;
}

// Warns if "valid" is smaller than a batch, which robomimic's loader drops.
void AddValidSteps(const robot::DemonstrationSet& set, ExportReport* report) {
  const size_t steps = ValidSteps(set);
  if (steps >= kRobomimicBatch) return;
  core::Finding& finding = report->findings.emplace_back();
  finding.code = "robomimic-valid";
  finding.severity = core::Severity::kWarning;
  finding.sentence = "the mask 'valid' has " + std::to_string(steps) +
                     " steps, less than a batch of robomimic's defaults, " +
                     std::to_string(kRobomimicBatch) + ": its loader would yield none";
  finding.remedy = "export more --episodes, or set train.batch_size to at most that";
  finding.figure = static_cast<double>(steps);
}

std::string Deviation(const JointMargins& joint) {
  char text[32];
  std::snprintf(text, sizeof(text), "%6.2f %s", 1000.0 * joint.deviation,
                joint.slides ? "mm" : "mrad");
  return text;
}

core::Json WorstJson(const robot::WorstValue& worst) {
  return {
      {"value", worst.value}, {"limit", worst.limit}, {"share", worst.ratio}, {"time", worst.time}};
}

}  // namespace

ExportReport Export(const ExportRequest& request, core::Progress* progress) {
  RequireEnding(request);
  if (WritesFolder(request) && fs::exists(request.output) && !request.force) {
    throw core::Error("the output exists already", request.output.string(),
                      "choose another folder, or use --force");
  }
  const TrainedTask task(request.run);
  ExportReport report;
  report.output = request.output;
  report.episodes = request.episodes;
  progress->Stage("roll out and replay", request.episodes);
  RecordingTally tally;
  if (request.format == ExportFormat::kRobomimic) {
    const std::vector<ChainRecording> recordings = RecordSuccesses(
        task.links(), request.episodes, request.seed, &tally,
        [&](const ChainRecording& one) { return ReproducesTask(task, one, request.seed); },
        progress);
    AddTally(tally, &report);
    const robot::DemonstrationSet set =
        DemonstrationsOf(task.run(), task.skills(), recordings, request.seed);
    AddValidSteps(set, &report);
    robot::WriteDemonstrations(request.output, set);
    return report;
  }
  MotionVerifier verifier(task, request);
  const std::vector<ChainRecording> recordings = RecordSuccesses(
      task.links(), request.episodes, request.seed, &tally,
      [&](const ChainRecording& one) { return verifier.Accept(one); }, progress);
  AddTally(tally, &report);
  report.closer = verifier.CountCloser(recordings);
  report.slowed = request.at_recorded_speed ? 0 : verifier.CountSlowed(recordings);
  AddSlowed(&report);
  const std::vector<SkillMotion> motions = verifier.MotionsOf(recordings);
  for (const SkillMotion& motion : motions) {
    AddMargins(motion, *task.skills().front().evaluated, &report);
  }
  AddFaster(&report);
  WriteMotions(motions, request, verifier.names());
  return report;
}

std::string ExportTable(const ExportReport& report) {
  std::string table;
  char line[192];
  if (!report.joints.empty()) {
    table =
        "joint                  largest share of its limit                      deviation,\n"
        "                       position  velocity  acceleration      jerk    mrad or mm\n";
  }
  for (const JointMargins& joint : report.joints) {
    std::snprintf(line, sizeof(line), "%-22.22s %6.1f %%  %6.1f %%      %6.1f %%  %6.1f %%  %s\n",
                  joint.worst.joint.c_str(), 100.0 * joint.worst.position.ratio,
                  100.0 * joint.worst.velocity.ratio, 100.0 * joint.worst.acceleration.ratio,
                  100.0 * joint.worst.jerk.ratio, Deviation(joint).c_str());
    table += line;
  }
  if (!report.joints.empty()) {
    std::snprintf(line, sizeof(line),
                  "mean duration %.1f s, at most %.2f times the recorded one; the tool deviates by "
                  "at most %.2f mm\n",
                  report.seconds, report.stretch, 1000.0 * report.tool_deviation);
    table += line;
  }
  std::snprintf(line, sizeof(line),
                "%d of %d episodes succeeded; %d are written, each reproduced its task\n",
                report.succeeded, report.tried, report.episodes);
  return table + line;
}

std::string ExportJson(const ExportReport& report) {
  core::Json text = {{"output", report.output.string()},
                     {"episodes", report.episodes},
                     {"tried", report.tried},
                     {"succeeded", report.succeeded},
                     {"left_out", report.succeeded - report.episodes},
                     {"closer", report.closer},
                     {"slowed", report.slowed}};
  text["findings"] = core::FindingsJson(report.findings);
  if (report.joints.empty()) return core::JsonText(text);
  text["mean_seconds"] = report.seconds;
  text["stretch"] = report.stretch;
  text["least_stretch"] = report.least_stretch;
  text["tool_deviation"] = report.tool_deviation;
  for (const JointMargins& joint : report.joints) {
    text["joints"].push_back({{"name", joint.worst.joint},
                              {"position", WorstJson(joint.worst.position)},
                              {"velocity", WorstJson(joint.worst.velocity)},
                              {"acceleration", WorstJson(joint.worst.acceleration)},
                              {"jerk", WorstJson(joint.worst.jerk)},
                              {"deviation", joint.deviation}});
  }
  return core::JsonText(text);
}

}  // namespace simwright::workflows
