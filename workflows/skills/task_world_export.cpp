#include "workflows/skills/task_world_export.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>

#include "assets/obj_file.h"
#include "assets/usd_tree.h"
#include "assets/usd_tree_world.h"
#include "assets/world_writer.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "scene/export/scene_files.h"
#include "skills/task_interface.h"
#include "skills/task_world.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// Returns the run, or the tasks of the file as one, with only the requested task and subtask.
SkillRun SourceOf(const TaskWorldExportRequest& request) {
  SkillRun run;
  if (fs::is_directory(request.source)) {
    run = ReadRun(request.source);
  } else {
    if (request.task.empty()) {
      throw core::Error("no task is given", request.source.string(), "name one with --task");
    }
    run.robot = request.robot;
    run.set = tasks::ReadTaskFile(request.source);
    if (run.set.tasks.empty()) throw core::Error("has no task", request.source.string());
  }
  const std::string name = request.task.empty() ? run.set.tasks.front().name : request.task;
  run.set = ChooseTasks(run.set, {name}, request.source.string());
  run.set.tasks.resize(1);
  tasks::Task& task = run.set.tasks.front();
  std::string names;
  std::vector<tasks::Subtask> chosen;
  for (const tasks::Subtask& subtask : task.subtasks) {
    names += (names.empty() ? "" : ", ") + subtask.name;
    const bool wanted = request.subtask.empty() || subtask.name == request.subtask;
    if (wanted && chosen.empty()) chosen.push_back(subtask);
  }
  if (chosen.empty()) {
    throw core::Error("there is no subtask '" + request.subtask + "'", task.name,
                      "it has " + names);
  }
  task.subtasks = chosen;
  return run;
}

std::string YamlPose(const Eigen::Isometry3d& pose, const std::string& indent) {
  const Eigen::AngleAxisd turn(pose.linear());
  char text[512];
  std::snprintf(text, sizeof(text),
                "%stranslation: [%.17g, %.17g, %.17g]\n"
                "%srotation: !AngleAxis\n%s  angle_deg: %.17g\n%s  axis: [%.17g, %.17g, %.17g]\n",
                indent.c_str(), pose.translation().x(), pose.translation().y(),
                pose.translation().z(), indent.c_str(), indent.c_str(), turn.angle() * 180.0 / M_PI,
                indent.c_str(), turn.axis().x(), turn.axis().y(), turn.axis().z());
  return text;
}

// Returns the world as Drake's model directives; `package` is the name of the output folder.
std::string TaskDirectives(const skills::TaskWorld& world, const std::string& package) {
  std::ostringstream text;
  text.precision(17);
  text << "# " << world.task << ": model directives of Drake\ndirectives:\n"
       << "- add_model:\n    name: ground\n    file: package://" << package << "/ground.sdf\n";
  for (const assets::TreeBody& body : world.bodies) {
    const std::string& root = body.kinematics->links().front().name;
    text << "- add_model:\n    name: \"" << body.name << "\"\n    file: package://" << package
         << "/" << body.name << ".sdf\n";
    if (!body.kinematics->moving_joints().empty()) text << "    default_joint_positions:\n";
    for (const int joint : body.kinematics->moving_joints()) {
      const auto j = static_cast<size_t>(joint);
      text << "      \"" << body.kinematics->joints()[j].name << "\": [" << body.positions[j]
           << "]\n";
    }
    if (body.fixed) {
      text << "- add_weld:\n    parent: world\n    child: \"" << body.name << "::" << root
           << "\"\n    X_PC:\n"
           << YamlPose(body.world_from_root, "      ");
    } else {
      text << "    default_free_body_pose:\n      \"" << root << "\":\n"
           << YamlPose(body.world_from_root, "        ");
    }
  }
  return text.str();
}

// Returns the output folder's name as a package name.
std::string TaskPackage(const fs::path& output) {
  const fs::path whole = fs::absolute(output).lexically_normal();
  return assets::FileSafeName((whole.has_filename() ? whole : whole.parent_path()).filename());
}

// Says what the layer of a world leaves out.
void CheckUsdWorld(const skills::TaskWorld& world, core::Findings* findings) {
  for (const assets::TreeBody& body : world.bodies) {
    for (core::Finding& finding : assets::UsdTreeFindings(*body.kinematics, body.fixed)) {
      finding.place = body.name + ": " + finding.place;
      findings->push_back(std::move(finding));
    }
    for (size_t i = 0; i < body.links.size(); ++i) {
      if (!body.links[i].friction_prevails) continue;
      findings->push_back(
          {"usd-friction-of-reader", core::Severity::kInfo,
           body.name + ": " + body.kinematics->links()[i].name,
           "decides the friction of its contacts in training; readers of USD combine "
           "the frictions of both surfaces"});
    }
  }
}

// Writes the world into `folder`; returns the name of its file.
std::string WriteTaskWorld(const skills::TaskWorld& world, const std::string& format,
                           const std::string& package, const fs::path& folder) {
  if (format == "usd") {
    std::map<std::string, const core::TriangleMesh*> meshes;
    for (const skills::WorldMesh& mesh : world.meshes) meshes[mesh.file] = &mesh.mesh;
    core::WriteFile(folder / "world.usda", TreeWorldUsd(world.task, world.bodies, meshes));
    return "world.usda";
  }
  fs::create_directories(folder / "meshes");
  for (const skills::WorldMesh& mesh : world.meshes) {
    core::WriteFile(folder / mesh.file, assets::ObjText(mesh.mesh, true));
  }
  if (format == "mjcf") {
    core::WriteFile(folder / "world.xml", TreeWorldMjcf(world.task, world.bodies));
    return "world.xml";
  }
  if (format == "sdf") {
    core::WriteFile(folder / "world.sdf", TreeWorldSdf(world.task, world.bodies));
    return "world.sdf";
  }
  for (const assets::TreeBody& body : world.bodies) {
    core::WriteFile(folder / (body.name + ".sdf"), TreeModelSdf(body));
  }
  core::WriteFile(folder / "ground.sdf", assets::GroundSdf());
  core::WriteFile(folder / "package.xml", scene::PackageXml(package));
  core::WriteFile(folder / "world.dmd.yaml", TaskDirectives(world, package));
  return "world.dmd.yaml";
}

}  // namespace

TaskWorldExportReport ExportTaskWorld(const TaskWorldExportRequest& request) {
  const std::set<std::string> formats = {"mjcf", "sdf", "drake", "usd"};
  if (!formats.contains(request.format)) {
    throw core::Error("there is no such world format", request.format, "mjcf, sdf, drake, usd");
  }
  const SkillRun run = SourceOf(request);
  const std::vector<RunSkill> prepared = PrepareSkills(run);
  const RunSkill& subtask = prepared.front();
  const skills::Skill& skill = *subtask.evaluated;
  const skills::StartState start = skills::TaskStart(skill, request.start_seed);
  const skills::TaskWorld world = MakeTaskWorld(subtask.name, skill, run.set.assets, start);
  TaskWorldExportReport report;
  report.output = request.output;
  report.task = run.set.tasks.front().name;
  report.subtask = subtask.name;
  for (const assets::TreeBody& body : world.bodies) {
    report.bodies.push_back(body.name);
    report.joints += static_cast<int>(body.kinematics->moving_joints().size());
    for (const assets::KinematicLink& link : body.kinematics->links()) {
      report.mass += link.inertial.mass;
    }
  }
  if (skill.variants.front().starts_held) {
    report.findings.push_back({"world-not-held", core::Severity::kWarning, report.subtask,
                               "the task starts with an object in the gripper, but in the exported "
                               "world the object is where the task describes it and the gripper is "
                               "open",
                               0.0, "export the subtask before it"});
  }
  if (request.format == "usd") CheckUsdWorld(world, &report.findings);
  core::StagedFolder staged(request.output, request.force);
  report.file =
      WriteTaskWorld(world, request.format, TaskPackage(request.output), staged.staging());
  core::WriteFile(staged.staging() / "task.json",
                  TaskInterfaceJson(subtask.name, skill, world, start));
  staged.Commit();
  return report;
}

std::string TaskWorldTable(const TaskWorldExportReport& report) {
  std::string bodies;
  for (const std::string& body : report.bodies) bodies += (bodies.empty() ? "" : ", ") + body;
  char line[128];
  std::snprintf(line, sizeof(line), ": %zu bodies, %d joints, %.6g kg: ", report.bodies.size(),
                report.joints, report.mass);
  return report.subtask + line + bodies + "\n";
}

std::string TaskWorldJson(const TaskWorldExportReport& report) {
  return core::JsonText(core::OrderedJson{{"output", report.output.string()},
                                          {"file", report.file},
                                          {"task", report.task},
                                          {"subtask", report.subtask},
                                          {"bodies", report.bodies},
                                          {"joints", report.joints},
                                          {"mass_kg", report.mass}});
}

}  // namespace simwright::workflows
