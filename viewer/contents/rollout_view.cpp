#include "viewer/contents/rollout_view.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_motion.h"

namespace simwright::viewer {
namespace fs = std::filesystem;
namespace {

using core::OrderedJson;

constexpr std::uint64_t kMaxPoseLines = 512ull << 20;  // bytes
constexpr int kFingertips = 2;

// Appends the columns of objects: the pose and the joints of each.
void AddObjectTrack(int body, const std::vector<std::string>& joints, Timeline* timeline) {
  timeline->tracks.push_back({body, timeline->width, joints, timeline->width + 7});
  timeline->width += 7 + static_cast<int>(joints.size());
}

void AppendMoment(const core::JsonField& line, std::size_t joints,
                  const std::vector<std::size_t>& object_joints, std::vector<float>* rows) {
  for (const double q : line["q"].Numbers(joints)) rows->push_back(static_cast<float>(q));
  const std::vector<core::JsonField> objects = line["things"].Elements(object_joints.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::vector<double> numbers = objects[i].Numbers(7 + object_joints[i]);
    Eigen::Quaterniond turn(numbers[3], numbers[4], numbers[5], numbers[6]);
    if (!(turn.norm() > 0.5 && turn.norm() < 2.0)) objects[i].Fail("has no unit quaternion");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << numbers[0], numbers[1], numbers[2];
    pose.linear() = turn.normalized().toRotationMatrix();
    AppendPose(pose, rows);
    for (std::size_t k = 7; k < numbers.size(); ++k) {
      rows->push_back(static_cast<float>(numbers[k]));
    }
  }
}

const tasks::Task& TaskNamed(const tasks::TaskSet& set, const std::string& name) {
  const auto found = std::find_if(set.tasks.begin(), set.tasks.end(),
                                  [&](const tasks::Task& task) { return task.name == name; });
  if (found == set.tasks.end() || found->subtasks.empty()) {
    throw core::Error("the tasks have no task " + name, "", "view a rollout beside its tasks.json");
  }
  return *found;
}

// Appends the fingertips with the strength of their contact.
void AppendContacts(const tasks::WorldState& state, std::vector<float>* rows) {
  const float strength = state.grasped ? 2.0f : state.touched >= 0 ? 1.0f : 0.0f;
  for (const double side : {-0.5, 0.5}) {
    const Eigen::Vector3d tip = state.gripper * Eigen::Vector3d(0.0, side * state.opening, 0.0);
    for (int i = 0; i < 3; ++i) rows->push_back(static_cast<float>(tip[i]));
    rows->push_back(strength);
  }
}

// Returns the reward of the decision that led to a moment.
float RewardAt(const workflows::RecordedSubtask& subtask, std::size_t moment) {
  if (subtask.decisions.empty()) return 0.0f;
  const std::size_t steps = std::max<std::size_t>(1, subtask.moments.size() - 1);
  const std::size_t before = moment > 0 ? moment - 1 : 0;
  const std::size_t decision =
      std::min(subtask.decisions.size() - 1, before * subtask.decisions.size() / steps);
  return subtask.decisions[decision].reward;
}

void AppendRecorded(const workflows::RecordedSubtask& subtask, std::size_t moment,
                    const skills::SkillVariant& variant, std::vector<float>* rows) {
  const workflows::RecordedMoment& now = subtask.moments[moment];
  for (const double q : now.arm) rows->push_back(static_cast<float>(q));
  rows->push_back(static_cast<float>(now.leader));
  for (const int object : variant.placed) {
    const auto i = static_cast<std::size_t>(object);
    AppendPose(now.state.roots[i], rows);
    for (const double q : now.state.joints[i]) rows->push_back(static_cast<float>(q));
  }
  rows->push_back(RewardAt(subtask, moment));
  rows->push_back(static_cast<float>(1000.0 * now.state.opening));
  AppendContacts(now.state, rows);
}

}  // namespace

RolloutPoseFile ReadRolloutPoses(const fs::path& file) {
  std::istringstream lines(core::ReadFile(file, kMaxPoseLines));
  std::string text;
  if (!std::getline(lines, text)) throw core::Error("the file is empty", file.string());
  const core::JsonDocument header(text, file.string() + ":1");
  const core::JsonField head = header.root();
  if (!head.Has("things") || !head.Has("rate")) {
    throw core::Error("has no poses of a rollout", file.string(), "see rollout --poses");
  }
  RolloutPoseFile poses;
  poses.robot = head["robot"].Text();
  poses.task = head["task"].Text();
  Timeline& timeline = poses.timeline;
  timeline.name = "rollout";
  timeline.rate = head["rate"].PositiveNumber();
  const std::vector<std::string> joints = head["joints"].Names();
  timeline.width = static_cast<int>(joints.size());
  timeline.tracks.push_back({0, -1, joints, 0});
  std::vector<std::size_t> object_joints;
  for (const core::JsonField& object : head["things"].Elements()) {
    poses.objects.push_back(object["name"].Name());
    const std::vector<std::string> names = object["joints"].Names();
    object_joints.push_back(names.size());
    AddObjectTrack(static_cast<int>(poses.objects.size()), names, &timeline);
  }
  int begin = 0;
  for (const core::JsonField& subtask : head["subtasks"].Elements()) {
    timeline.marks.push_back({subtask["name"].Name(), begin});
    begin += subtask["lines"].Int(0);
  }
  for (int number = 2; std::getline(lines, text); ++number) {
    const core::JsonDocument line(text, file.string() + ":" + std::to_string(number));
    AppendMoment(line.root(), joints.size(), object_joints, &timeline.rows);
  }
  if (timeline.frames() == 0) throw core::Error("has no moments", file.string());
  timeline.facts = {{"task", poses.task},
                    {"episode", std::to_string(head["episode"].Integer())},
                    {"success", head["success"].Flag() ? "yes" : "no"}};
  return poses;
}

OrderedJson RolloutWorld(const RolloutPoseFile& poses, const tasks::TaskSet& set,
                         TaskModels* models, DocumentBuilder* builder) {
  const tasks::Task& task = TaskNamed(set, poses.task);
  OrderedJson world = SubtaskWorld(task, task.subtasks.front(), models);
  std::vector<WorldBody> bodies = models->BodiesAtStart(task.subtasks.front().start);
  bodies.resize(1);
  for (const std::string& name : poses.objects) {
    bodies.push_back({name, models->Asset(name), Eigen::Isometry3d::Identity(), false});
  }
  world["name"] = "rollout of " + task.name;
  world["bodies"] = BodiesJson(bodies);
  world["timelines"] = OrderedJson::array();
  OrderedJson timeline = AddTimeline(poses.timeline, builder);
  timeline["shown"] = true;
  world["timelines"].push_back(std::move(timeline));
  return world;
}

std::unique_ptr<Content> ReadRolloutView(const fs::path& file) {
  const RolloutPoseFile poses = ReadRolloutPoses(file);
  const fs::path tasks_file = fs::absolute(file).parent_path() / "tasks.json";
  if (!fs::exists(tasks_file)) {
    throw core::Error("the tasks.json of the rollout is not beside it", file.string(),
                      "let rollout --poses write into the training's folder");
  }
  const tasks::TaskSet set = tasks::ReadTaskFile(tasks_file);
  DocumentBuilder builder("rollout", "rollout of " + poses.task);
  TaskModels models(set, workflows::RobotOf(poses.robot), &builder);
  builder.AddWorld(RolloutWorld(poses, set, &models, &builder));
  return std::make_unique<Content>(builder.Take());
}

Timeline EpisodeTimeline(const workflows::TrainedTask& task,
                         const workflows::ChainRecording& recording) {
  const workflows::RunSkill& first = task.skills().front();
  const workflows::RecordedSubtask& begin = recording.subtasks.front();
  const skills::SkillVariant& variant =
      first.evaluated->variants[static_cast<std::size_t>(begin.start.variant)];
  Timeline timeline;
  timeline.name = "episode";
  timeline.rate = first.evaluated->options.control_rate;
  const std::vector<std::string> joints = workflows::MotionJointsOf(*first.evaluated->robot).names;
  timeline.tracks.push_back({0, -1, joints, 0});
  timeline.width = static_cast<int>(joints.size());
  int body = 0;
  for (const int object : variant.placed) {
    std::vector<std::string> names;
    for (const tasks::ObjectJoint& joint :
         variant.model.objects[static_cast<std::size_t>(object)].joints) {
      names.push_back(joint.name);
    }
    AddObjectTrack(++body, names, &timeline);
  }
  timeline.signals = {{"reward", "", timeline.width}, {"gripper", "mm", timeline.width + 1}};
  timeline.contact_columns = timeline.width + 2;
  timeline.contacts = kFingertips;
  timeline.width += 2 + 4 * kFingertips;
  double total = 0.0;
  for (std::size_t k = 0; k < recording.subtasks.size(); ++k) {
    const workflows::RecordedSubtask& subtask = recording.subtasks[k];
    timeline.marks.push_back({task.skills()[k].name, timeline.frames()});
    for (std::size_t i = 0; i < subtask.moments.size(); ++i) {
      AppendRecorded(subtask, i, variant, &timeline.rows);
    }
    for (const workflows::RecordedDecision& decision : subtask.decisions) total += decision.reward;
  }
  timeline.facts = {{"episode", std::to_string(recording.episode)},
                    {"success", recording.success ? "yes" : "no"},
                    {"return", Quantity(total, "")}};
  return timeline;
}

}  // namespace simwright::viewer
