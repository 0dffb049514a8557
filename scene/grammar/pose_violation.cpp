#include "scene/grammar/pose_violation.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

bool Names(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the keep-out radius of a symbol; less than 0 if the keep-out does not name it.
double RadiusIn(const KeepOut& keep_out, const std::string& symbol) {
  for (const KeepOutBody& body : keep_out.bodies) {
    if (body.symbol == symbol) return body.radius;
  }
  return -1.0;
}

// Returns the nearest node of that symbol at or above `index`; -1 if there is none.
int Above(const Grammar& grammar, const Derivation& derivation, int index,
          const std::string& symbol) {
  for (int i = index; i >= 0; i = derivation[static_cast<std::size_t>(i)].parent) {
    if (SymbolOf(grammar, derivation[static_cast<std::size_t>(i)]).name == symbol) return i;
  }
  return -1;
}

// A body of a keep-out in a derivation.
struct Body {
  int node = -1;
  double radius = 0.0;  // m
  int surface = -1;
  bool against = false;  // true if a pair needs this or another such body
  int group = -1;        // the node within which pairs are exempt; -1: none
};

std::vector<Body> ViolationBodies(const Grammar& grammar, const Derivation& derivation,
                                  const KeepOut& keep_out) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < derivation.size(); ++i) {
    const std::string& symbol = SymbolOf(grammar, derivation[i]).name;
    Body body;
    body.node = static_cast<int>(i);
    body.radius = RadiusIn(keep_out, symbol);
    if (body.radius < 0.0 || derivation[i].carrier >= 0) continue;
    body.surface = derivation[i].surface;
    body.against = Names(keep_out.against, symbol);
    if (!keep_out.exempt_within.empty()) {
      body.group = Above(grammar, derivation, body.node, keep_out.exempt_within);
    }
    bodies.push_back(body);
  }
  return bodies;
}

// Returns the position of a node in the frame of a surface.
Vector3d OnSurface(const Derivation& derivation, int surface, int node) {
  const Vector3d& point = derivation[static_cast<std::size_t>(node)].world_from_node.translation();
  if (surface < 0) return point;
  return derivation[static_cast<std::size_t>(surface)].world_from_node.inverse() * point;
}

}  // namespace

PoseViolation::PoseViolation(const Grammar& grammar, const Derivation& derivation,
                             Decision decision)
    : grammar_(grammar) {
  for (std::size_t k = 0; k < grammar.keep_outs().size(); ++k) {
    if (grammar.keep_outs()[k].decision == decision) FindPairs(derivation, static_cast<int>(k));
  }
  for (std::size_t k = 0; k < grammar.rims().size(); ++k) {
    if (grammar.rims()[k].decision == decision) FindInside(derivation, static_cast<int>(k));
  }
}

void PoseViolation::FindPairs(const Derivation& derivation, int index) {
  const KeepOut& keep_out = grammar_.keep_outs()[static_cast<std::size_t>(index)];
  const std::vector<Body> bodies = ViolationBodies(grammar_, derivation, keep_out);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const Body &one = bodies[i], &other = bodies[j];
      if (one.surface != other.surface) continue;
      if (!keep_out.against.empty() && !one.against && !other.against) continue;
      if (one.group >= 0 && one.group == other.group) continue;
      pairs_.push_back({one.node, other.node, one.radius + other.radius, index});
    }
  }
}

void PoseViolation::FindInside(const Derivation& derivation, int index) {
  const InsideRim& rim = grammar_.rims()[static_cast<std::size_t>(index)];
  for (std::size_t i = 0; i < derivation.size(); ++i) {
    const DerivedNode& node = derivation[i];
    const Symbol& symbol = SymbolOf(grammar_, node);
    if (!symbol.IsObject() || symbol.welded || node.carrier >= 0 || node.surface < 0) continue;
    if (!rim.symbols.empty() && !Names(rim.symbols, symbol.name)) continue;
    const DerivedNode& surface = derivation[static_cast<std::size_t>(node.surface)];
    if (SymbolOf(grammar_, surface).name != rim.surface) continue;
    insides_.push_back({static_cast<int>(i), index});
  }
}

double PoseViolation::Violation(const Derivation& derivation, const Pair& pair) const {
  const int surface = derivation[static_cast<std::size_t>(pair.a)].surface;
  const Vector3d displacement =
      derivation[static_cast<std::size_t>(pair.b)].world_from_node.translation() -
      derivation[static_cast<std::size_t>(pair.a)].world_from_node.translation();
  const double across = surface < 0 ? displacement.head<2>().norm()
                                    : (derivation[static_cast<std::size_t>(surface)]
                                           .world_from_node.linear()
                                           .leftCols<2>()
                                           .transpose() *
                                       displacement)
                                          .norm();
  return std::max(0.0, pair.apart - across);
}

double PoseViolation::Violation(const Derivation& derivation, const Inside& inside) const {
  const InsideRim& rim = grammar_.rims()[static_cast<std::size_t>(inside.rim)];
  const int surface = derivation[static_cast<std::size_t>(inside.node)].surface;
  const Vector3d place = OnSurface(derivation, surface, inside.node);
  if (rim.round) return std::max(0.0, place.head<2>().norm() - (rim.half_x - rim.margin));
  const double x = std::abs(place.x()) - (rim.half_x - rim.margin);
  const double y = std::abs(place.y()) - (rim.half_y - rim.margin);
  return std::max({0.0, x, y});
}

double PoseViolation::Sum(const Derivation& derivation) const {
  double sum = 0.0;
  for (const Pair& pair : pairs_) sum += Violation(derivation, pair);
  for (const Inside& inside : insides_) sum += Violation(derivation, inside);
  return sum;
}

double PoseViolation::SumOf(const Derivation& derivation, int first, int last) const {
  const auto within = [&](int node) { return node >= first && node < last; };
  double sum = 0.0;
  for (const Pair& pair : pairs_) {
    if (within(pair.a) || within(pair.b)) sum += Violation(derivation, pair);
  }
  for (const Inside& inside : insides_) {
    if (within(inside.node)) sum += Violation(derivation, inside);
  }
  return sum;
}

std::vector<int> PoseViolation::ViolatingObjects(const Derivation& derivation) const {
  std::set<int> offenders;
  for (const Pair& pair : pairs_) {
    if (Violation(derivation, pair) > 0.0) offenders.insert({pair.a, pair.b});
  }
  for (const Inside& inside : insides_) {
    if (Violation(derivation, inside) > 0.0) offenders.insert(inside.node);
  }
  return {offenders.begin(), offenders.end()};
}

std::string PoseViolation::Worst(const Derivation& derivation) const {
  double most = 0.0;
  std::string what;
  for (const Pair& pair : pairs_) {
    const double missing = Violation(derivation, pair);
    if (missing <= most) continue;
    most = missing;
    what = "keep-out " + grammar_.keep_outs()[static_cast<std::size_t>(pair.keep_out)].name;
  }
  for (const Inside& inside : insides_) {
    const double missing = Violation(derivation, inside);
    if (missing <= most) continue;
    most = missing;
    what = grammar_.rims()[static_cast<std::size_t>(inside.rim)].Describe();
  }
  return what;
}

}  // namespace simwright::scene
