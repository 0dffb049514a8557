#pragma once

#include <vector>

#include <Eigen/Core>

class btMultiBody;

namespace simwright::sim {

// A part of a padded generalized vector; both numbers are multiples of kLanes (sim/lanes.h).
struct Span {
  int first = 0, count = 0;
};

// The dynamics of a tree of rigid links in generalized coordinates, in the world frame. The n
// generalized velocities are Bullet's: for a free root its angular velocity and the velocity of its
// centre of mass, then one for each revolute or prismatic joint. The joint-space inertia matrix and
// its inverse are formed once per pose, so that the response to any impulse is one small product;
// Bullet runs a pass through the whole tree for each. Positions and velocities stay in the
// btMultiBody between steps.
class TreeDynamics {
 public:
  // `body` must outlive the dynamics and be finalized.
  explicit TreeDynamics(btMultiBody* body);

  int size() const { return size_; }      // n
  int stride() const { return stride_; }  // n padded

  // Computes the links' poses if a position differs by more than 1e-12 from that of the last call;
  // returns true if so.
  bool UpdatePoses();
  // Computes the inverse inertia matrix, unless it is that of the current poses.
  void UpdateInverseInertia();
  // Sets the velocities to those after a step `dt` (s) without constraints, under `gravity`
  // (m/s^2), the forces of the body's root and the torques of its joints.
  void StepFreely(const Eigen::Vector3d& gravity, double dt);
  // Clamps the velocities to Bullet's bound, and writes them and the positions after `dt` (s) to
  // the body.
  void Integrate(double dt);

  // Returns the number of last steps in which no position moved by more than 10 um or 10 urad.
  int still_steps() const { return still_steps_; }
  // Starts that count again.
  void Disturb() { still_steps_ = 0; }
  // Sets the velocities to zero.
  void Stop();

  // `link` is Bullet's index; the root is -1.
  const Eigen::Matrix3d& Rotation(int link) const { return At(link).rotation; }  // world_from_link
  const Eigen::Vector3d& Center(int link) const { return At(link).center; }      // m, world

  // Writes the Jacobian J of the velocity force . v + torque . w into `row` (stride), v of the
  // link's material point at `point` (m, world), w of the link; returns where it may differ from
  // zero.
  Span Jacobian(int link, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                const Eigen::Vector3d& torque, double* row) const;
  // Writes the response M^-1 J^T into `response` (stride); returns where it may differ from zero.
  Span Respond(int link, const double* row, Span nonzero, double* response) const;
  // Returns where the response to an impulse on `link` may differ from zero.
  Span Reach(int link) const { return At(link).reach; }
  // Returns true if some coordinate moves the link.
  bool Moves(int link) const { return At(link).last >= 0; }
  // Returns the index of the joint's generalized velocity; -1: a fixed joint.
  int Coordinate(int link) const { return At(link).coordinate; }
  double JointPosition(int link) const;

  // Returns row i of the inverse inertia matrix (stride).
  const double* InverseInertia(int i) const { return &inverse_[Offset(i)]; }
  double* velocity() { return velocity_.data(); }  // (stride)

 private:
  // Mass (kg), first moment (kg m) and rotational inertia (kg m^2) about the origin.
  struct SpatialInertia {
    double mass = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rotational = Eigen::Matrix3d::Zero();
  };
  // A spatial motion or force about the origin.
  struct Spatial {
    Eigen::Vector3d angular = Eigen::Vector3d::Zero(), linear = Eigen::Vector3d::Zero();
    double Dot(const Spatial& other) const {
      return angular.dot(other.angular) + linear.dot(other.linear);
    }
  };
  struct Link {
    int parent = -1;      // in links_
    int coordinate = -1;  // of its joint; -1: fixed, or the root
    int last = -1;        // the highest coordinate that moves it; -1: none
    bool revolute = false;
    Eigen::Vector3d axis = Eigen::Vector3d::Zero(), to_pivot = Eigen::Vector3d::Zero(),
                    to_center = Eigen::Vector3d::Zero();
    // The rotation from the link to its parent at angle q is still + cos q cosine + sin q sine.
    Eigen::Matrix3d still, cosine, sine;
    double mass = 0.0;
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();
    Span reach;
    // The current pose and what follows from it:
    double position = 0.0;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Spatial motion;  // of a unit joint velocity
    SpatialInertia inertia;
  };

  static Eigen::Map<Eigen::Vector3d> Vector(double* three) {
    return Eigen::Map<Eigen::Vector3d>(three);
  }
  size_t Offset(int i) const { return static_cast<size_t>(i) * static_cast<size_t>(stride_); }
  const Link& At(int link) const { return links_[static_cast<size_t>(link + 1)]; }
  void AddLink(int index);
  void SetReaches();
  bool HasMoved() const;
  void PoseLink(Link* link) const;
  void SetInertia(Link* link) const;
  void FillInertiaMatrix();
  void Factorize();
  void Invert();
  void InvertFreeBody();
  void Bias(const Eigen::Vector3d& gravity, double* forces);
  void IntegrateRoot(double dt);
  void CountStillSteps();
  static Spatial Momentum(const SpatialInertia& inertia, const Spatial& motion);

  btMultiBody& body_;
  bool free_;
  int size_, stride_;
  std::vector<Link> links_;  // the root first
  std::vector<int> above_;   // by coordinate: the next one towards the root; -1: none
  Eigen::Vector3d root_position_ = Eigen::Vector3d::Zero();  // at the last UpdatePoses
  Eigen::Vector4d root_turn_ = Eigen::Vector4d::Zero();
  bool posed_ = false, inverted_ = false;
  // The positions that the tree keeps to: of the root, its turn and the joints by link.
  Eigen::Vector3d still_position_ = Eigen::Vector3d::Zero();
  Eigen::Vector4d still_turn_ = Eigen::Vector4d::Zero();
  std::vector<double> still_joints_;
  int still_steps_ = 0;
  std::vector<SpatialInertia> composite_;                     // by link: with all that it carries
  std::vector<Spatial> velocities_, accelerations_, forces_;  // by link
  std::vector<double> factor_;                                // (n x stride) L of M = L^T L
  std::vector<double> factor_inverse_;                        // (n x stride)
  std::vector<double> inverse_;                               // (n x stride)
  std::vector<double> velocity_, load_;                       // (stride)
};

}  // namespace simwright::sim
