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

// The shared helpers of the URDF, MJCF and SDF writers. Numbers have 17 digits, so that each reader
// recovers the same doubles.
std::string Number(double value);
std::string Numbers(std::initializer_list<double> values);
std::string Numbers(const Eigen::Vector3d& v);

// A nested element with attributes; closes itself.
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
// know Drake ignore its elements.
constexpr char kDrakeNamespace[] = "http://drake.mit.edu";

void UrdfVisual(tinyxml2::XMLPrinter* printer, const std::string& file);
// Writes a convex collision part. URDF has no friction of its own: Drake's is in its properties.
void UrdfCollision(tinyxml2::XMLPrinter* printer, const std::string& file,
                   const HydroelasticContact& contact);
void UrdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);
// Writes the extension of Bullet and Gazebo that stores friction and restitution per link.
void UrdfContact(tinyxml2::XMLPrinter* printer, double friction, double rolling_friction,
                 double restitution);

void SdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);
// `color` (RGBA, sRGB; may be null) becomes the material of a visual of one plain colour.
void SdfVisual(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file,
               const Eigen::Vector4f* color = nullptr);
// Writes a convex collision part. Restitution is omitted: Drake, which has none, warns about it,
// and ODE uses it only above a threshold.
void SdfCollision(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file,
                  const HydroelasticContact& contact);
// Writes <surface> with the friction that all readers of SDF support.
void SdfSurface(tinyxml2::XMLPrinter* printer, double friction);

// Writes the ground of a world, a static model whose top is z = 0 (world_writer.cpp).
void SdfGround(tinyxml2::XMLPrinter* printer);

// Writes <option>: the solver's settings, `multiccd` on. `time_step` in s.
void MjcfOption(tinyxml2::XMLPrinter* printer, double time_step = 0.002);
// Writes <inertial> on principal axes.
void MjcfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial);

// Returns the damping ratio that reproduces `restitution`. MuJoCo's spring-damper contact has no
// coefficient of restitution; a damping ratio gives one: e = exp(-pi d / sqrt(1 - d^2)) for a
// linear spring and damper. The ratio is at least 0.4, below which stacks oscillate, and 1 for
// objects that hardly bounce.
double DampingRatio(double restitution);

}  // namespace simwright::assets
