#include "tasks/scene_signals.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::tasks {
namespace {

// Returns the angular velocity of a frame between two times, as the API defines it.
Eigen::Vector3d TurnRate(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to, double time_step) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to * from.transpose()));
  return turn.axis() * turn.angle() / time_step;
}

struct SlotPlace {
  std::size_t thing = 0;
  int link = -1;   // -1: the asset as a whole
  int joint = -1;  // -1: none
};

SlotPlace PlaceOf(const SceneModel& model, const RewardSlot& slot) {
  SlotPlace place;
  if (slot.asset.empty()) return place;
  const int thing = model.Find(slot.asset);
  if (thing < 0) throw core::Error("there is no asset '" + slot.asset + "'", "reward program");
  place.thing = static_cast<std::size_t>(thing);
  if (slot.part.empty()) return place;
  const bool of_joint =
      slot.input == RewardInput::kJointState || slot.input == RewardInput::kJointVelocity ||
      slot.input == RewardInput::kJointLower || slot.input == RewardInput::kJointUpper;
  const Thing& known = model.things[place.thing];
  (of_joint ? place.joint : place.link) =
      of_joint ? known.FindJoint(slot.part) : known.FindLink(slot.part);
  if (!of_joint && place.link < 0) {
    throw core::Error("'" + slot.asset + "' has no link '" + slot.part + "'", "reward program");
  }
  return place;  // a fixed joint has no index; its state is 0
}

void Put(const Eigen::Vector3d& vector, std::vector<float>* row) {
  for (int i = 0; i < 3; ++i) (*row)[static_cast<std::size_t>(i)] = static_cast<float>(vector[i]);
}

void Put(const Eigen::Matrix3d& rotation, std::vector<float>* row) {
  const Eigen::Quaterniond q(rotation);
  for (int i = 0; i < 4; ++i) {
    (*row)[static_cast<std::size_t>(i)] = static_cast<float>(q.coeffs()[i]);  // xyzw
  }
}

void Put(const Eigen::AlignedBox3d& box, std::vector<float>* row) {
  for (int i = 0; i < 3; ++i) {
    (*row)[static_cast<std::size_t>(i)] = static_cast<float>(box.min()[i]);
    (*row)[static_cast<std::size_t>(i) + 3] = static_cast<float>(box.max()[i]);
  }
}

bool Touches(const SceneState& state, const RewardSlot& slot, const SlotPlace& place) {
  if (state.touched < 0) return false;
  if (slot.asset.empty()) return true;
  return state.touched == static_cast<int>(place.thing) &&
         (place.link < 0 || place.link == state.touched_link);
}

}  // namespace

// The poses of one state; link poses are computed once per object.
class SignalReader::Moment {
 public:
  explicit Moment(const SceneModel& model)
      : model_(model), poses_(model.things.size()), known_(model.things.size()) {}

  void Take(const SceneState* state) {
    state_ = state;
    std::fill(known_.begin(), known_.end(), false);
  }
  bool given() const { return state_ != nullptr; }
  const SceneState& state() const { return *state_; }

  Eigen::Isometry3d LinkPose(std::size_t thing, std::size_t link) {
    if (!known_[thing]) {
      LinkPosesOf(model_.things[thing], state_->joints[thing], &poses_[thing]);
      known_[thing] = true;
    }
    return state_->roots[thing] * poses_[thing][link];
  }
  Eigen::Vector3d LinkMiddle(std::size_t thing, std::size_t link) {
    return LinkPose(thing, link) * model_.things[thing].links[link].middle;
  }
  Eigen::AlignedBox3d Box(std::size_t thing, int link) {
    Eigen::AlignedBox3d box;
    const std::vector<ThingLink>& links = model_.things[thing].links;
    for (std::size_t l = 0; l < links.size(); ++l) {
      if (link >= 0 && l != static_cast<std::size_t>(link)) continue;
      const Eigen::Isometry3d pose = LinkPose(thing, l);
      for (const Eigen::Vector3d& point : links[l].outline) box.extend(pose * point);
    }
    if (box.isEmpty()) box.extend(state_->roots[thing].translation());
    return box;
  }

 private:
  const SceneModel& model_;
  const SceneState* state_ = nullptr;
  std::vector<std::vector<Eigen::Isometry3d>> poses_;
  std::vector<bool> known_;
};

struct SignalReader::Place : SlotPlace {};

SignalReader::SignalReader(const SceneModel& model, const std::vector<RewardSlot>& slots)
    : model_(model),
      slots_(slots),
      now_(std::make_unique<Moment>(model)),
      before_(std::make_unique<Moment>(model)) {
  for (const RewardSlot& slot : slots_) places_.push_back({PlaceOf(model, slot)});
}

SignalReader::~SignalReader() = default;

void SignalReader::Read(const SceneState& state, const SceneState* previous, double time_step,
                        std::vector<std::vector<float>>* values) {
  now_->Take(&state);
  before_->Take(previous);
  values->resize(slots_.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    (*values)[i].assign(static_cast<std::size_t>(slots_[i].width), 0.0f);
    Write(i, time_step, &(*values)[i]);
  }
}

void SignalReader::Write(std::size_t index, double time_step, std::vector<float>* row) {
  const RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const auto link = static_cast<std::size_t>(std::max(place.link, 0));
  switch (slot.input) {
    case RewardInput::kLinkPosition:
    case RewardInput::kAssetPosition:
      return Put(now_->LinkMiddle(place.thing, link), row);
    case RewardInput::kLinkOrientation:
    case RewardInput::kAssetOrientation:
      return Put(Eigen::Matrix3d(now_->LinkPose(place.thing, link).linear()), row);
    case RewardInput::kLinkLinearVelocity:
    case RewardInput::kAssetLinearVelocity:
      if (!before_->given()) return;
      return Put(Eigen::Vector3d((now_->LinkMiddle(place.thing, link) -
                                  before_->LinkMiddle(place.thing, link)) /
                                 time_step),
                 row);
    case RewardInput::kLinkAngularVelocity:
    case RewardInput::kAssetAngularVelocity:
      if (!before_->given()) return;
      return Put(TurnRate(before_->LinkPose(place.thing, link).linear(),
                          now_->LinkPose(place.thing, link).linear(), time_step),
                 row);
    case RewardInput::kLinkBoundingBox:
    case RewardInput::kAssetBoundingBox:
      return Put(now_->Box(place.thing, place.link), row);
    case RewardInput::kGoalPosition:
      return Put(now_->state().goal, row);
    case RewardInput::kParameter:
      return;
    default:
      return place.joint >= 0 ? WriteJoint(index, time_step, row)
                              : WriteGripper(index, time_step, row);
  }
}

void SignalReader::WriteGripper(std::size_t index, double time_step, std::vector<float>* row) {
  const RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const SceneState& state = now_->state();
  switch (slot.input) {
    case RewardInput::kGripperPosition:
      return Put(Eigen::Vector3d(state.gripper.translation()), row);
    case RewardInput::kGripperOrientation:
      return Put(Eigen::Matrix3d(state.gripper.linear()), row);
    case RewardInput::kGripperLinearVelocity:
      if (!before_->given()) return;
      return Put(
          Eigen::Vector3d((state.gripper.translation() - before_->state().gripper.translation()) /
                          time_step),
          row);
    case RewardInput::kGripperAngularVelocity:
      if (!before_->given()) return;
      return Put(TurnRate(before_->state().gripper.linear(), state.gripper.linear(), time_step),
                 row);
    case RewardInput::kGripperOpening:
      (*row)[0] = static_cast<float>(state.opening);
      return;
    case RewardInput::kGripperContact:
      (*row)[0] = Touches(state, slot, place) ? 1.0f : 0.0f;
      return;
    case RewardInput::kGrasped:
      (*row)[0] = state.grasped && Touches(state, slot, place) ? 1.0f : 0.0f;
      return;
    default:
      return;  // a fixed joint
  }
}

void SignalReader::WriteJoint(std::size_t index, double time_step, std::vector<float>* row) {
  const RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const auto j = static_cast<std::size_t>(place.joint);
  const ThingJoint& joint = model_.things[place.thing].joints[j];
  const Thing& thing = model_.things[place.thing];
  const double q = JointPosition(thing, now_->state().joints[place.thing], j);
  double value = q;
  if (slot.input == RewardInput::kJointLower) value = joint.lower;
  if (slot.input == RewardInput::kJointUpper) value = joint.upper;
  if (slot.input == RewardInput::kJointVelocity) {
    value = !before_->given()
                ? 0.0
                : (q - JointPosition(thing, before_->state().joints[place.thing], j)) / time_step;
  }
  (*row)[0] = static_cast<float>(value);
}

void SlotValues(const SceneModel& model, const SceneState& state, const SceneState* previous,
                double time_step, const std::vector<RewardSlot>& slots,
                std::vector<std::vector<float>>* values) {
  SignalReader(model, slots).Read(state, previous, time_step, values);
}

}  // namespace simwright::tasks
