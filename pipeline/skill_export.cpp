#include "pipeline/skill_export.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "pipeline/skill_demonstrations.h"
#include "pipeline/skill_rollout.h"
#include "robot/trajectory_file.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

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
    throw core::Error("several trajectories go into a folder", request.output.string(),
                      "give a name without " + ending + ", or --episodes 1");
  }
  if (WritesFolder(request) || named) return;
  throw core::Error("is no name for this format", request.output.string(),
                    "let it end in " + endings.front());
}

void WriteMotion(const robot::JointTrajectory& trajectory, const fs::path& file) {
  robot::WriteTrajectory(file, trajectory);
  if (file.extension() != ".json") return;
  core::WriteFile(NotesBeside(file), json(trajectory.notes).dump(2) + "\n");
}

void WriteMotions(const std::vector<SkillMotion>& motions, const ExportRequest& request) {
  if (!WritesFolder(request)) {
    WriteMotion(motions.front().retimed.trajectory, request.output);
    return;
  }
  core::StagedFolder folder(request.output, request.force);
  for (size_t i = 0; i < motions.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "episode_%04zu", i + 1);
    WriteMotion(motions[i].retimed.trajectory,
                folder.staging() / (name + EndingsOf(request.format).front()));
  }
  folder.Commit();
}

void Worsen(const robot::WorstValue& value, robot::WorstValue* worst) {
  if (value.ratio > worst->ratio) *worst = value;
}

void AddMargins(const SkillMotion& motion, const rl::Skill& skill, ExportReport* report) {
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
  report->stretch = std::max(report->stretch, motion.retimed.stretch);
  report->tool_deviation = std::max(report->tool_deviation, motion.retimed.tool_deviation);
  report->seconds += motion.retimed.trajectory.times.back() / report->episodes;
}

std::vector<SkillMotion> MotionsOf(const TrainedTask& task,
                                   const std::vector<ChainRecording>& recordings,
                                   std::uint64_t seed, core::Progress* progress) {
  std::vector<SkillMotion> motions(recordings.size());
  progress->Stage("retime", static_cast<int>(recordings.size()));
  core::ParallelFor(static_cast<int>(recordings.size()), [&](int i) {
    const ChainRecording& recording = recordings[static_cast<size_t>(i)];
    SkillMotion& motion = motions[static_cast<size_t>(i)];
    motion = MotionOf(recording, *task.skills().front().evaluated);
    SkillNotes notes = NotesOf(task.run(), task.skills(), recording, seed);
    notes.times = motion.subtasks;
    motion.retimed.trajectory.notes = NoteLines(notes);
    progress->Advance();
  });
  return motions;
}

std::string Deviation(const JointMargins& joint) {
  char text[32];
  std::snprintf(text, sizeof(text), "%6.2f %s", 1000.0 * joint.deviation,
                joint.slides ? "mm" : "mrad");
  return text;
}

json WorstJson(const robot::WorstValue& worst) {
  return {
      {"value", worst.value}, {"limit", worst.limit}, {"share", worst.ratio}, {"time", worst.time}};
}

}  // namespace

fs::path NotesBeside(const fs::path& trajectory) {
  return fs::path(trajectory).replace_extension(".notes.json");
}

ExportReport Export(const ExportRequest& request, core::Progress* progress) {
  RequireEnding(request);
  if (WritesFolder(request) && fs::exists(request.output) && !request.force) {
    throw core::Error("the output exists already", request.output.string(),
                      "choose another folder, or use --force");
  }
  const TrainedTask task(request.run);
  ExportReport report;
  report.output = request.output;
  progress->Stage("roll out");
  const std::vector<ChainRecording> recordings =
      RecordSuccesses(task.links(), request.episodes, request.seed, &report.tried);
  report.episodes = static_cast<int>(recordings.size());
  if (request.format == ExportFormat::kRobomimic) {
    robot::WriteDemonstrations(
        request.output, DemonstrationsOf(task.run(), task.skills(), recordings, request.seed));
    return report;
  }
  const std::vector<SkillMotion> motions = MotionsOf(task, recordings, request.seed, progress);
  for (const SkillMotion& motion : motions) {
    AddMargins(motion, *task.skills().front().evaluated, &report);
  }
  WriteMotions(motions, request);
  return report;
}

std::string ExportTable(const ExportReport& report) {
  std::string table;
  char line[192];
  if (!report.joints.empty()) {
    table =
        "joint                  share of its limit, at most                     off the\n"
        "                       position  velocity  acceleration      jerk    recording\n";
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
                  "%.1f s on average, at most %.2f times as long as recorded; the tool at most "
                  "%.2f mm off\n",
                  report.seconds, report.stretch, 1000.0 * report.tool_deviation);
    table += line;
  }
  std::snprintf(line, sizeof(line), "%d of %d episodes succeeded\n", report.episodes, report.tried);
  return table + line;
}

std::string ExportJson(const ExportReport& report) {
  json text = {
      {"output", report.output.string()}, {"episodes", report.episodes}, {"tried", report.tried}};
  if (report.joints.empty()) return text.dump(2) + "\n";
  text["mean_seconds"] = report.seconds;
  text["stretch"] = report.stretch;
  text["tool_deviation"] = report.tool_deviation;
  for (const JointMargins& joint : report.joints) {
    text["joints"].push_back({{"name", joint.worst.joint},
                              {"position", WorstJson(joint.worst.position)},
                              {"velocity", WorstJson(joint.worst.velocity)},
                              {"acceleration", WorstJson(joint.worst.acceleration)},
                              {"jerk", WorstJson(joint.worst.jerk)},
                              {"deviation", joint.deviation}});
  }
  return text.dump(2) + "\n";
}

}  // namespace simwright::pipeline
