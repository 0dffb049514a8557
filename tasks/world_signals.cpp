#include "tasks/world_signals.h"

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
  std::size_t object = 0;
  int link = -1;   // -1: the asset as a whole
  int joint = -1;  // -1: none
};

SlotPlace PlaceOf(const WorldModel& model, const reward::RewardSlot& slot) {
  SlotPlace place;
  if (slot.asset.empty()) return place;
  const int object = model.Find(slot.asset);
  if (object < 0) throw core::Error("there is no asset '" + slot.asset + "'", "reward program");
  place.object = static_cast<std::size_t>(object);
  if (slot.part.empty()) return place;
  const bool of_joint = slot.input == reward::RewardInput::kJointState ||
                        slot.input == reward::RewardInput::kJointVelocity ||
                        slot.input == reward::RewardInput::kJointLower ||
                        slot.input == reward::RewardInput::kJointUpper;
  const ArticulatedObject& known = model.objects[place.object];
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

bool Touches(const WorldState& state, const reward::RewardSlot& slot, const SlotPlace& place) {
  if (state.touched < 0) return false;
  if (slot.asset.empty()) return true;
  return state.touched == static_cast<int>(place.object) &&
         (place.link < 0 || place.link == state.touched_link);
}

}  // namespace

// The poses of one state; link poses are computed once per object.
class SignalReader::StatePoses {
 public:
  explicit StatePoses(const WorldModel& model)
      : model_(model), poses_(model.objects.size()), known_(model.objects.size()) {}

  void Take(const WorldState* state) {
    state_ = state;
    std::fill(known_.begin(), known_.end(), false);
  }
  bool given() const { return state_ != nullptr; }
  const WorldState& state() const { return *state_; }

  Eigen::Isometry3d LinkPose(std::size_t object, std::size_t link) {
    if (!known_[object]) {
      LinkPosesOf(model_.objects[object], state_->joints[object], &poses_[object]);
      known_[object] = true;
    }
    return state_->roots[object] * poses_[object][link];
  }
  Eigen::Vector3d LinkMiddle(std::size_t object, std::size_t link) {
    return LinkPose(object, link) * model_.objects[object].links[link].middle;
  }
  Eigen::AlignedBox3d Box(std::size_t object, int link) {
    Eigen::AlignedBox3d box;
    const std::vector<ObjectLink>& links = model_.objects[object].links;
    for (std::size_t l = 0; l < links.size(); ++l) {
      if (link >= 0 && l != static_cast<std::size_t>(link)) continue;
      const Eigen::Isometry3d pose = LinkPose(object, l);
      for (const Eigen::Vector3d& point : links[l].extreme_points) box.extend(pose * point);
    }
    if (box.isEmpty()) box.extend(state_->roots[object].translation());
    return box;
  }

 private:
  const WorldModel& model_;
  const WorldState* state_ = nullptr;
  std::vector<std::vector<Eigen::Isometry3d>> poses_;
  std::vector<bool> known_;
};

struct SignalReader::Place : SlotPlace {};

SignalReader::SignalReader(const WorldModel& model, const std::vector<reward::RewardSlot>& slots)
    : model_(model),
      slots_(slots),
      now_(std::make_unique<StatePoses>(model)),
      before_(std::make_unique<StatePoses>(model)) {
  for (const reward::RewardSlot& slot : slots_) places_.push_back({PlaceOf(model, slot)});
}

SignalReader::~SignalReader() = default;

void SignalReader::Read(const WorldState& state, const WorldState* previous, double time_step,
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
  const reward::RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const auto link = static_cast<std::size_t>(std::max(place.link, 0));
  switch (slot.input) {
    case reward::RewardInput::kLinkPosition:
    case reward::RewardInput::kAssetPosition:
      return Put(now_->LinkMiddle(place.object, link), row);
    case reward::RewardInput::kLinkOrientation:
    case reward::RewardInput::kAssetOrientation:
      return Put(Eigen::Matrix3d(now_->LinkPose(place.object, link).linear()), row);
    case reward::RewardInput::kLinkLinearVelocity:
    case reward::RewardInput::kAssetLinearVelocity:
      if (!before_->given()) return;
      return Put(Eigen::Vector3d((now_->LinkMiddle(place.object, link) -
                                  before_->LinkMiddle(place.object, link)) /
                                 time_step),
                 row);
    case reward::RewardInput::kLinkAngularVelocity:
    case reward::RewardInput::kAssetAngularVelocity:
      if (!before_->given()) return;
      return Put(TurnRate(before_->LinkPose(place.object, link).linear(),
                          now_->LinkPose(place.object, link).linear(), time_step),
                 row);
    case reward::RewardInput::kLinkBoundingBox:
    case reward::RewardInput::kAssetBoundingBox:
      return Put(now_->Box(place.object, place.link), row);
    case reward::RewardInput::kGoalPosition:
      return Put(now_->state().goal, row);
    case reward::RewardInput::kParameter:
      return;
    default:
      return place.joint >= 0 ? WriteJoint(index, time_step, row)
                              : WriteGripper(index, time_step, row);
  }
}

void SignalReader::WriteGripper(std::size_t index, double time_step, std::vector<float>* row) {
  const reward::RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const WorldState& state = now_->state();
  switch (slot.input) {
    case reward::RewardInput::kGripperPosition:
      return Put(Eigen::Vector3d(state.gripper.translation()), row);
    case reward::RewardInput::kGripperOrientation:
      return Put(Eigen::Matrix3d(state.gripper.linear()), row);
    case reward::RewardInput::kGripperLinearVelocity:
      if (!before_->given()) return;
      return Put(
          Eigen::Vector3d((state.gripper.translation() - before_->state().gripper.translation()) /
                          time_step),
          row);
    case reward::RewardInput::kGripperAngularVelocity:
      if (!before_->given()) return;
      return Put(TurnRate(before_->state().gripper.linear(), state.gripper.linear(), time_step),
                 row);
    case reward::RewardInput::kGripperOpening:
      (*row)[0] = static_cast<float>(state.opening);
      return;
    case reward::RewardInput::kGripperContact:
      (*row)[0] = Touches(state, slot, place) ? 1.0f : 0.0f;
      return;
    case reward::RewardInput::kGrasped:
      (*row)[0] = state.grasped && Touches(state, slot, place) ? 1.0f : 0.0f;
      return;
    default:
      return;  // a fixed joint
  }
}

void SignalReader::WriteJoint(std::size_t index, double time_step, std::vector<float>* row) {
  const reward::RewardSlot& slot = slots_[index];
  const Place& place = places_[index];
  const auto j = static_cast<std::size_t>(place.joint);
  const ObjectJoint& joint = model_.objects[place.object].joints[j];
  const ArticulatedObject& object = model_.objects[place.object];
  const double q = JointPosition(object, now_->state().joints[place.object], j);
  double value = q;
  if (slot.input == reward::RewardInput::kJointLower) value = joint.lower;
  if (slot.input == reward::RewardInput::kJointUpper) value = joint.upper;
  if (slot.input == reward::RewardInput::kJointVelocity) {
    value = !before_->given()
                ? 0.0
                : (q - JointPosition(object, before_->state().joints[place.object], j)) / time_step;
  }
  (*row)[0] = static_cast<float>(value);
}

void SlotValues(const WorldModel& model, const WorldState& state, const WorldState* previous,
                double time_step, const std::vector<reward::RewardSlot>& slots,
                std::vector<std::vector<float>>* values) {
  SignalReader(model, slots).Read(state, previous, time_step, values);
}

}  // namespace simwright::tasks
