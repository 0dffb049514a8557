#include "sim/bodies_mjcf.h"

#include <iomanip>
#include <sstream>

namespace simwright::sim {
namespace {

// N m/rad and N m s/rad (N/m and N s/m): the Panda's heaviest joint, 1 to 2 kg m^2, then follows
// within a tenth of a second without overshoot. The damping is implicit, so light joints only lag.
constexpr double kStiffness = 1500.0, kMotorDamping = 80.0;

// The floor has bit 1; the lesser friction coefficient leaves that of the bodies.
constexpr const char* kFloorGeom =
    "<geom name=\"floor\" type=\"plane\" size=\"0 0 1\" friction=\"0.01 1e-5 1e-5\" "
    "contype=\"1\" conaffinity=\"0\"/>";

// Writes the bodies as MJCF.
class BodiesFile {
 public:
  BodiesFile(const std::vector<MujocoPlacement>& placements, const BodiesMjcfOptions& options)
      : placements_(placements) {
    for (std::ostringstream* part : {&assets_, &world_, &equalities_, &motors_}) {
      *part << std::setprecision(17);
    }
    for (size_t b = 0; b < placements.size(); ++b) {
      AddLink(b, 0);
      for (size_t j = 0; j < placements[b].body->joints().size(); ++j) AddDrive(b, j);
    }
    std::ostringstream all;
    all << "<mujoco><compiler angle=\"radian\" balanceinertia=\"true\"/><option timestep=\""
        << std::setprecision(17) << options.time_step << "\"/><size "
        << "nconmax=\"" << options.contacts << "\" njmax=\"" << options.rows << "\"/><asset>"
        << assets_.str() << "</asset><worldbody>" << (options.floor ? kFloorGeom : "")
        << world_.str() << "</worldbody><equality>" << equalities_.str() << "</equality><actuator>"
        << motors_.str() << "</actuator></mujoco>\n";
    text_ = all.str();
  }
  const std::string& text() const { return text_; }

 private:
  static std::string Pose(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q(pose.linear());
    std::ostringstream out;
    out << std::setprecision(17) << " pos=\"" << pose.translation().transpose() << "\" quat=\""
        << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << "\"";
    return out.str();
  }

  // Returns the contact bits: bodies collide with each other and with the floor (bit 1), but not
  // with themselves.
  std::string Bits(size_t b, bool floor) const {
    const unsigned own = 2u << b;
    const unsigned others = (((2u << placements_.size()) - 1u) & ~own & ~1u) | (floor ? 1u : 0u);
    return " contype=\"" + std::to_string(own) + "\" conaffinity=\"" + std::to_string(others) +
           "\"";
  }

  void AddLink(size_t b, size_t link) {
    const MujocoPlacement& placement = placements_[b];
    const ArticulatedBody& body = *placement.body;
    const bool root = link == 0;
    world_ << "<body name=\"" << MjcfName("link", b, link) << '"'
           << Pose(root ? placement.world_from_root : body.joints()[link - 1].parent_from_joint)
           << '>';
    if (root && !placement.fixed) world_ << "<freejoint/>";
    if (!root) AddJoint(b, link - 1);
    const assets::Inertial& inertial = body.links[link].inertial;
    if (inertial.mass > 0.0) {
      const Eigen::Matrix3d& i = inertial.inertia;
      world_ << "<inertial pos=\"" << inertial.center_of_mass.transpose() << "\" mass=\""
             << inertial.mass << "\" fullinertia=\"" << i(0, 0) << ' ' << i(1, 1) << ' ' << i(2, 2)
             << ' ' << i(0, 1) << ' ' << i(0, 2) << ' ' << i(1, 2) << "\"/>";
    }
    AddShapes(b, link);
    for (size_t j = 0; j < body.joints().size(); ++j) {
      if (body.kinematics->parents()[j] == static_cast<int>(link)) AddLink(b, j + 1);
    }
    world_ << "</body>";
  }

  void AddJoint(size_t b, size_t j) {
    const assets::Joint& joint = placements_[b].body->joints()[j];
    if (!joint.Moves()) return;
    const bool slides = joint.type == assets::JointType::kPrismatic;
    world_ << "<joint name=\"" << MjcfName("joint", b, j) << "\" type=\""
           << (slides ? "slide" : "hinge") << "\" axis=\"" << joint.axis.transpose()
           << "\" frictionloss=\"" << joint.friction << "\" damping=\""
           << joint.damping + (Motor(b, j) > 0.0 ? kMotorDamping : 0.0) << '"';
    if (joint.type != assets::JointType::kContinuous) {
      world_ << " limited=\"true\" range=\"" << joint.lower << ' ' << joint.upper << '"';
    }
    world_ << "/>";
  }

  void AddShapes(size_t b, size_t link) {
    const RigidBody& body = placements_[b].body->links[link];
    const std::string bits = Bits(b, link > 0 || !placements_[b].fixed);
    for (size_t p = 0; p < body.parts.size(); ++p) {
      world_ << "<geom friction=\"" << body.friction << " 1e-4 1e-4\"" << bits;
      if (p < body.capsules.size() && body.capsules[p]) {
        const Capsule& capsule = *body.capsules[p];
        if ((capsule.a - capsule.b).norm() > 1e-9) {
          world_ << " type=\"capsule\" fromto=\"" << capsule.a.transpose() << ' '
                 << capsule.b.transpose() << "\" size=\"" << capsule.radius << "\"/>";
        } else {
          world_ << " type=\"sphere\" pos=\"" << capsule.a.transpose() << "\" size=\""
                 << capsule.radius << "\"/>";
        }
        continue;
      }
      const std::string mesh = MjcfName("mesh", b, link) + "_" + std::to_string(p);
      assets_ << "<mesh name=\"" << mesh << "\" vertex=\"";
      for (const Eigen::Vector3d& vertex : body.parts[p].vertices) {
        assets_ << vertex.transpose() << ' ';
      }
      assets_ << "\"/>";
      world_ << " type=\"mesh\" mesh=\"" << mesh << "\"/>";
    }
  }

  void AddDrive(size_t b, size_t j) {
    const ArticulatedBody& body = *placements_[b].body;
    const assets::Joint& joint = body.joints()[j];
    if (!joint.Moves()) return;
    if (Motor(b, j) > 0.0) {
      motors_ << "<position name=\"" << MjcfName("joint", b, j) << "\" joint=\""
              << MjcfName("joint", b, j) << "\" kp=\"" << kStiffness
              << "\" forcelimited=\"true\" forcerange=\"" << -Motor(b, j) << ' ' << Motor(b, j)
              << "\"/>";
    }
    if (joint.mimic) {
      const auto leader = static_cast<size_t>(body.kinematics->JointIndex(joint.mimic->joint));
      equalities_ << "<joint joint1=\"" << MjcfName("joint", b, j) << "\" joint2=\""
                  << MjcfName("joint", b, leader) << "\" polycoef=\"" << joint.mimic->offset << ' '
                  << joint.mimic->multiplier << " 0 0 0\"/>";
    }
  }

  double Motor(size_t b, size_t j) const {
    const std::vector<double>& forces = placements_[b].motor_forces;
    return j < forces.size() ? forces[j] : 0.0;
  }

  const std::vector<MujocoPlacement>& placements_;
  std::ostringstream assets_, world_, equalities_, motors_;
  std::string text_;
};

}  // namespace

std::string MjcfName(const char* kind, size_t body, size_t index) {
  return std::string(kind) + "_" + std::to_string(body) + "_" + std::to_string(index);
}

std::string BodiesMjcf(const std::vector<MujocoPlacement>& placements,
                       const BodiesMjcfOptions& options) {
  return BodiesFile(placements, options).text();
}

}  // namespace simwright::sim
