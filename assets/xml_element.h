#pragma once

#include <initializer_list>
#include <string>

#include <Eigen/Core>

#include "assets/asset.h"
#include "assets/hydroelastic.h"

namespace tinyxml2 {
class XMLPrinter;
}

namespace simwright::assets {

// What the writers of URDF, MJCF and SDF share. Numbers carry 17 digits, so that each reader gets
// back the same doubles.
std::string Number(double value);
std::string Numbers(std::initializer_list<double> values);
std::string Numbers(const Eigen::Vector3d& v);

// Nested elements with attributes; closes itself.
class Element {
 public:
  Element(tinyxml2::XMLPrinter* printer, const char* name);
  ~Element();
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;
  Element& Set(const char* name, const std::string& value);
  void Text(const std::string& text);

 private:
  tinyxml2::XMLPrinter* printer_;
};

void Leaf(tinyxml2::XMLPrinter* printer, const char* name, const std::string& text);

// The namespace of Drake's elements, an attribute of the root of URDF and SDF: readers that do not
// know Drake pass its elements over.
constexpr char kDrakeNamespace[] = "http://drake.mit.edu";

void UrdfVisual(tinyxml2::XMLPrinter* printer, const std::string& file);
// A convex part. URDF has no friction of its own: Drake's stands in its properties.
void UrdfCollision(tinyxml2::XMLPrinter* printer, const std::string& file,
                   const HydroelasticContact& contact);
void UrdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);
// Bullet's and Gazebo's extension: friction and bounce travel with the link.
void UrdfContact(tinyxml2::XMLPrinter* printer, double friction, double rolling_friction,
                 double restitution);

void SdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);
void SdfVisual(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file);
// A convex part. Restitution is left out: Drake, which has none, warns of it, and ODE heeds it only
// above a threshold.
void SdfCollision(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file,
                  const HydroelasticContact& contact);
// <surface> with the friction that all readers of SDF take.
void SdfSurface(tinyxml2::XMLPrinter* printer, double friction);

// <option>: the solver's settings, `multiccd` on. `time_step` in s.
void MjcfOption(tinyxml2::XMLPrinter* printer, double time_step = 0.002);
// <inertial> on principal axes.
void MjcfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);

// MuJoCo's spring-damper contact has no coefficient of restitution. A damping ratio gives one:
// e = exp(-pi d / sqrt(1 - d^2)) for a linear spring and damper; never under 0.4, where stacks
// ring, and 1 for what hardly bounces.
double DampingRatio(double restitution);

}  // namespace simwright::assets
