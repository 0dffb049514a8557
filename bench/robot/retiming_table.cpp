// Retimes motions recorded at 60 Hz for a controller at 1 kHz: the increase in duration, the
// deviation from the recording, the utilization of the limits, and the time it takes. Given a
// Python with toppra, compares durations and computing times with TOPP-RA's
// (bench/peers/toppra_retiming.py), which has no jerk limit, on the same motions.
//   bench_retiming_table [--motions N=10] [--python PYTHON] [--folder DIR] [--only KIND]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "robot/limit_check.h"
#include "robot/panda_model.h"
#include "robot/retiming.h"
#include "tests/robot/path_optimum.h"
#include "tests/robot/recorded_motions.h"

namespace simwright::robot {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 10.0;      // of each motion
constexpr double kAnySpeedUp = 100.0;  // the limits alone bound the speed
constexpr int kRepeats = 3;            // the least time counts, as for TOPP-RA
constexpr int kPathPoints = 3000;      // of our path, for TOPP-RA

struct Kind {
  const char* name;
  MotionKind kind;
};
constexpr Kind kKinds[] = {{"smooth", MotionKind::kSmooth},
                           {"fast", MotionKind::kFast},
                           {"policy", MotionKind::kPolicy},
                           {"noisy", MotionKind::kNoisy},
                           {"corners", MotionKind::kCorners}};

struct Options {
  int motions = 10;
  std::string python, only;
  fs::path folder = fs::temp_directory_path() / "simwright_retiming";
};

struct Timed {
  Retimed retimed;
  double seconds = 0.0;  // of the processor, to compute it
};

Timed TimedRetiming(const RobotModel& model, const RecordedPath& path, double speed_up,
                    int repeats) {
  const RetimedJoints joints = JointsToRetime(model);
  RetimingOptions options;
  options.max_speed_up = speed_up;
  Timed timed;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t start = std::clock();
    timed.retimed = Retime(path, joints.limits, joints.sliding, &model.arm, options);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    timed.seconds = i == 0 ? seconds : std::min(timed.seconds, seconds);
  }
  return timed;
}

void PrintRow(const RobotModel& model, const Kind& kind, int motions) {
  const RetimedJoints joints = JointsToRetime(model);
  double stretch = 0.0, least = 0.0, longest = 0.0, turn = 0.0, tool = 0.0, seconds = 0.0,
         fastest = 0.0, ratio = 0.0;
  int accepted = 0;
  for (int i = 0; i < motions; ++i) {
    const RecordedPath path = MakeMotion(model, kind.kind, kSeconds, static_cast<std::uint64_t>(i));
    const Timed timed = TimedRetiming(model, path, 1.0, 1);
    const Retimed& retimed = timed.retimed;
    seconds += timed.seconds;
    fastest += TimedRetiming(model, path, kAnySpeedUp, 1).retimed.stretch / motions;
    const LimitReport report = CheckLimits(retimed.trajectory, joints.limits);
    accepted += report.accepted();
    for (const JointLimitReport& joint : report.joints) {
      ratio = std::max({ratio, joint.velocity.ratio, joint.acceleration.ratio, joint.jerk.ratio});
    }
    stretch += retimed.stretch / motions;
    least += LeastStretch(path, joints.limits) / motions;
    longest = std::max(longest, retimed.stretch);
    turn = std::max(turn, retimed.deviations.maxCoeff());
    tool = std::max(tool, retimed.tool_deviation);
  }
  std::printf("%-8s %-14s %3d/%-3d %6.2f %6.2f %6.2f %8.3f %8.2f %7.2f %7.3f %8.3f\n", kind.name,
              model.name.c_str(), accepted, motions, least, stretch, longest, fastest, 1e3 * turn,
              1e3 * tool, ratio, seconds / motions);
}

void PrintAtRecordedSpeed(const Options& options) {
  std::printf(
      "10 s of motion at 60 Hz to 1 kHz, at most at the recording's speed; longer: times the\n"
      "recording; least: required by the velocity limits alone; fastest: longer, at any speed\n");
  std::printf("%-8s %-14s %-7s %6s %6s %6s %8s %8s %7s %7s %8s\n", "motion", "robot", "passed",
              "least", "longer", "most", "fastest", "mrad", "mm", "limits", "seconds");
  for (const Kind& kind : kKinds) {
    if (!options.only.empty() && options.only != kind.name) continue;
    for (const bool on_base : {false, true}) PrintRow(Panda(on_base), kind, options.motions);
  }
}

core::Json Rows(const Eigen::MatrixXd& matrix) {
  core::Json rows = core::Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::VectorXd row = matrix.row(i);
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

// One motion of ours at the limits, and its input for TOPP-RA.
struct Contest {
  std::string kind, robot;
  double duration = 0.0, seconds = 0.0;  // of the motion, to compute it
  bool accepted = false;
  core::Json input;
};

Contest RunOurs(const RobotModel& model, const Kind& kind, int motion) {
  const RetimedJoints joints = JointsToRetime(model);
  const RecordedPath path =
      MakeMotion(model, kind.kind, kSeconds, static_cast<std::uint64_t>(motion));
  const Timed timed = TimedRetiming(model, path, kAnySpeedUp, kRepeats);
  const JointTrajectory& trajectory = timed.retimed.trajectory;
  Contest contest{kind.name,
                  model.name,
                  trajectory.times.back(),
                  timed.seconds,
                  CheckLimits(trajectory, joints.limits).accepted(),
                  {}};
  double step = 0.0;
  const Eigen::MatrixXd way = AlongTheWay(trajectory, joints.sliding, kPathPoints, &step);
  core::Json& input = contest.input;
  input = {{"name", contest.kind + " " + model.name + " " + std::to_string(motion)},
           {"rate", RetimingOptions().rate},
           {"times", path.times},
           {"positions", Rows(path.positions)},
           {"path_step", step},
           {"path", Rows(way)}};
  for (const JointLimits& limit : joints.limits) {
    input["velocity"].push_back(limit.velocity);
    input["acceleration"].push_back(limit.acceleration);
  }
  const Eigen::VectorXd& deviations = timed.retimed.deviations;
  input["deviations"] = std::vector<double>(deviations.begin(), deviations.end());
  return contest;
}

core::Json RunPeer(const std::vector<Contest>& contests, const Options& options) {
  fs::create_directories(options.folder);
  const fs::path in = options.folder / "motions.json", out = options.folder / "toppra.json";
  core::Json motions;
  for (const Contest& contest : contests) motions["motions"].push_back(contest.input);
  core::WriteFile(in, core::JsonLine(motions));
  const std::string command = options.python +
                              " " SIMWRIGHT_SOURCE_DIR "/bench/peers/toppra_retiming.py " +
                              in.string() + " " + out.string();
  if (std::system(command.c_str()) != 0) throw core::Error("TOPP-RA failed", options.python);
  return core::JsonDocument::Read(out, 1 << 28).json().at("motions");
}

// The means of one kind of motion of one robot.
struct Comparison {
  int motions = 0, accepted = 0, failed = 0;
  double duration = 0.0, seconds = 0.0;
  std::map<std::string, double> durations, path_seconds, law_seconds, sample_seconds, most_share;
};

constexpr const char* kVariants[] = {"points", "points_fine", "tolerance_fine", "ours_fine"};

void Add(const Contest& contest, const core::Json& peer, Comparison* sum) {
  for (const char* variant : kVariants) {
    if (!peer.at(variant).is_object()) {  // TOPP-RA found none: the motion does not count
      ++sum->failed;
      return;
    }
  }
  ++sum->motions;
  sum->accepted += contest.accepted;
  sum->duration += contest.duration;
  sum->seconds += contest.seconds;
  for (const char* variant : kVariants) {
    const core::Json& row = peer.at(variant);
    sum->durations[variant] += row.at("duration").get<double>();
    sum->path_seconds[variant] += row.at("path_seconds").get<double>();
    sum->law_seconds[variant] += row.at("law_seconds").get<double>();
    sum->sample_seconds[variant] += row.at("sample_seconds").get<double>();
    double& share = sum->most_share[variant];
    share = std::max({share, row.at("velocity_share").get<double>(),
                      row.at("acceleration_share").get<double>()});
  }
}

void PrintDurations(const std::string& name, Comparison& sum) {
  const double count = sum.motions;
  double best = 1e9;
  std::printf("%-23s %3d/%-3d %7.3f", name.c_str(), sum.accepted, sum.motions,
              sum.duration / count);
  for (const char* variant : kVariants) {
    best = std::min(best, sum.durations[variant]);
    std::printf(" %7.3f (%4.2f)", sum.durations[variant] / count, sum.most_share[variant]);
  }
  std::printf(" %8.2f %8.2f %6d\n", sum.duration / sum.durations["ours_fine"], sum.duration / best,
              sum.failed);
}

void PrintSeconds(const std::string& name, Comparison& sum) {
  const double path = sum.path_seconds["points"], law = sum.law_seconds["points"],
               samples = sum.sample_seconds["points"], count = sum.motions;
  std::printf("%-23s %8.4f   %6.4f + %6.4f + %6.4f %8.2f\n", name.c_str(), sum.seconds / count,
              path / count, law / count, samples / count, sum.seconds / (path + law + samples));
}

void CompareWithToppra(const Options& options) {
  std::vector<Contest> contests;
  for (const Kind& kind : kKinds) {
    if (!options.only.empty() && options.only != kind.name) continue;
    for (const bool on_base : {false, true}) {
      for (int i = 0; i < options.motions; ++i) {
        contests.push_back(RunOurs(Panda(on_base), kind, i));
      }
    }
  }
  const core::Json peers = RunPeer(contests, options);
  std::vector<std::pair<std::string, Comparison>> rows;
  for (std::size_t i = 0; i < contests.size(); ++i) {
    const std::string name = contests[i].kind + " " + contests[i].robot;
    if (rows.empty() || rows.back().first != name) rows.emplace_back(name, Comparison());
    Add(contests[i], peers.at(i), &rows.back().second);
  }
  std::printf(
      "\nAt the limits, mean durations in s; TOPP-RA, without a jerk limit: on the spline through\n"
      "the recorded points, with its own grid and with a fine one; fine, on a smoothing spline "
      "that\n"
      "deviates as far as ours and on our path; in brackets its largest share of a limit of\n"
      "velocity or acceleration. Ours / theirs: on our path, and with its best.\n");
  std::printf("%-23s %-7s %7s %14s %14s %14s %14s %8s %8s %6s\n", "motion", "passed", "ours",
              "points", "fine", "tolerance", "our path", "path", "best", "failed");
  for (auto& [name, sum] : rows) PrintDurations(name, sum);
  std::printf(
      "\nSeconds of the processor, ours with the check; TOPP-RA's for points with its own grid:\n"
      "path + time law + samples at 1 kHz.\n");
  std::printf("%-23s %8s   %24s %8s\n", "motion", "ours", "TOPP-RA", "ratio");
  for (auto& [name, sum] : rows) PrintSeconds(name, sum);
}

int Run(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i];
    if (flag == "--motions") options.motions = std::max(1, std::atoi(argv[i + 1]));
    if (flag == "--python") options.python = argv[i + 1];
    if (flag == "--folder") options.folder = argv[i + 1];
    if (flag == "--only") options.only = argv[i + 1];
  }
  PrintAtRecordedSpeed(options);
  std::fflush(stdout);
  if (!options.python.empty()) CompareWithToppra(options);
  return 0;
}

}  // namespace
}  // namespace simwright::robot

int main(int argc, char** argv) {
  try {
    return simwright::robot::Run(argc, argv);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
