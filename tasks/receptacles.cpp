#include "tasks/receptacles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace simwright::tasks {
namespace {

constexpr int kResolution = 40;
constexpr int kShieldedSides = 5;
constexpr double kMinSideDepth = 0.08;  // m; a shallower niche, as of a window, holds no object
constexpr double kReachFactor = 1.01;   // of a cell's radius: allows for rounding
constexpr double kMaxSize = 1000.0;     // m; a larger link has no receptacles for the gripper

using Cell = Eigen::Vector3i;

// A convex part as half-spaces, for point containment tests.
struct HalfSpaces {
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector4d> planes;  // outward normal, offset

  bool Contains(const Eigen::Vector3d& point) const {
    if (!box.contains(point)) return false;
    for (const Eigen::Vector4d& plane : planes) {
      if (plane.head<3>().dot(point) > plane[3]) return false;
    }
    return true;
  }

  // Returns false where no point of a box can be inside, as far as one plane tells.
  bool Reaches(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    const Eigen::Vector3d center = 0.5 * (low + high);
    const double radius = 0.5 * (high - low).norm();
    for (const Eigen::Vector4d& plane : planes) {
      if (plane.head<3>().dot(center) > plane[3] + kReachFactor * radius) return false;
    }
    return true;
  }
};

HalfSpaces SpacesOf(const core::TriangleMesh& part) {
  HalfSpaces spaces;
  spaces.box = core::Bounds(part);
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    const Eigen::Vector3d normal = core::TriangleAreaVector(part, static_cast<int>(t)).normalized();
    if (!normal.allFinite()) continue;
    Eigen::Vector4d plane;
    plane << normal, normal.dot(part.vertices[static_cast<std::size_t>(part.triangles[t][0])]);
    const bool known = std::any_of(
        spaces.planes.begin(), spaces.planes.end(),
        [&](const Eigen::Vector4d& other) { return (other - plane).cwiseAbs().maxCoeff() < 1e-9; });
    if (!known) spaces.planes.push_back(plane);
  }
  return spaces;
}

// The cells that the parts occupy, on a grid with an empty border.
class Grid {
 public:
  explicit Grid(const std::vector<core::TriangleMesh>& parts) {
    Eigen::AlignedBox3d box;
    for (const core::TriangleMesh& part : parts) box.extend(core::Bounds(part));
    cell_ = std::max(box.sizes().maxCoeff() / kResolution, 1e-4);
    size_ = (box.sizes() / cell_).array().ceil().cast<int>() + 2;
    origin_ = box.center() - 0.5 * cell_ * size_.cast<double>();
    full_.assign(static_cast<std::size_t>(size_.prod()), 0);
    for (const core::TriangleMesh& part : parts) Fill(part);
  }

  const Cell& size() const { return size_; }
  double cell() const { return cell_; }
  bool Inside(const Cell& c) const {
    return (c.array() >= 0).all() && (c.array() < size_.array()).all();
  }
  std::size_t Index(const Cell& c) const {
    return static_cast<std::size_t>((c.z() * size_.y() + c.y()) * size_.x() + c.x());
  }
  bool Full(const Cell& c) const { return full_[Index(c)] != 0; }
  Eigen::Vector3d Corner(const Cell& c) const { return origin_ + cell_ * c.cast<double>(); }

 private:
  // Marks the cells that `part` occupies. Samples points a third of a cell apart within the part's
  // bounds, so a wall thinner than a cell fills the cells it crosses.
  void Fill(const core::TriangleMesh& part) {
    const HalfSpaces spaces = SpacesOf(part);
    std::array<std::vector<double>, 3> samples;  // coordinates, by axis
    for (int axis = 0; axis < 3; ++axis) {
      const double low = spaces.box.min()[axis], extent = spaces.box.sizes()[axis];
      const int count = std::max(1, static_cast<int>(std::ceil(extent / (cell_ / 3.0))));
      const double step = extent / count;
      for (int i = 0; i < count; ++i) samples[axis].push_back(low + (i + 0.5) * step);
    }
    const std::array<std::vector<Span>, 3> spans = {SpansOf(samples[0], 0), SpansOf(samples[1], 1),
                                                    SpansOf(samples[2], 2)};
    for (const Span& z : spans[2]) {
      for (const Span& y : spans[1]) {
        for (const Span& x : spans[0]) {
          const Cell c(x.cell, y.cell, z.cell);
          if (!Inside(c) || Full(c) || !spaces.Reaches(Corner(c), Corner(c + Cell::Ones()))) {
            continue;
          }
          full_[Index(c)] = AnyInside(spaces, samples, x, y, z);
        }
      }
    }
  }

  // Samples `begin` to `end` - 1 along an axis, which lie in one layer of cells.
  struct Span {
    int cell, begin, end;
  };
  std::vector<Span> SpansOf(const std::vector<double>& samples, int axis) const {
    std::vector<Span> spans;
    for (int i = 0; i < static_cast<int>(samples.size()); ++i) {
      const auto at = static_cast<size_t>(i);
      const int cell = static_cast<int>(std::floor((samples[at] - origin_[axis]) / cell_));
      if (spans.empty() || spans.back().cell != cell) spans.push_back({cell, i, i});
      spans.back().end = i + 1;
    }
    return spans;
  }

  static bool AnyInside(const HalfSpaces& spaces, const std::array<std::vector<double>, 3>& samples,
                        const Span& x, const Span& y, const Span& z) {
    for (int k = z.begin; k < z.end; ++k) {
      for (int j = y.begin; j < y.end; ++j) {
        for (int i = x.begin; i < x.end; ++i) {
          const auto at = [](int index) { return static_cast<std::size_t>(index); };
          if (spaces.Contains({samples[0][at(i)], samples[1][at(j)], samples[2][at(k)]}))
            return true;
        }
      }
    }
    return false;
  }

  double cell_ = 0.0;
  Cell size_;
  Eigen::Vector3d origin_;
  std::vector<char> full_;
};

constexpr std::array<std::array<int, 3>, 6> kSides = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

Cell Side(int side) {
  return Cell(kSides[static_cast<std::size_t>(side)].data());
}

// Returns for each free cell the sides on which the link shields it, as bits.
std::vector<unsigned char> Shields(const Grid& grid) {
  const Cell size = grid.size();
  std::vector<unsigned char> shields(static_cast<std::size_t>(size.prod()), 0);
  for (int side = 0; side < 6; ++side) {
    const Cell step = Side(side);
    // The scan runs from the side inwards: the first occupied cell shields all cells behind it.
    const int axis = side / 2;
    const int across = (axis + 1) % 3, along = (axis + 2) % 3;
    for (int u = 0; u < size[across]; ++u) {
      for (int v = 0; v < size[along]; ++v) {
        Cell c;
        c[across] = u;
        c[along] = v;
        c[axis] = step[axis] < 0 ? 0 : size[axis] - 1;
        bool met = false;
        for (; grid.Inside(c); c -= step) {
          if (grid.Full(c)) met = true;
          if (met) shields[grid.Index(c)] |= static_cast<unsigned char>(1 << side);
        }
      }
    }
  }
  return shields;
}

// Returns the side that is open for most of the cells.
int OpenSide(const std::vector<Cell>& cells, const Grid& grid,
             const std::vector<unsigned char>& shields) {
  std::array<int, 6> open{};
  for (const Cell& c : cells) {
    for (int side = 0; side < 6; ++side) open[side] += !((shields[grid.Index(c)] >> side) & 1);
  }
  return static_cast<int>(std::max_element(open.begin(), open.end()) - open.begin());
}

// Grows a box from the centre of the cells, side by side, while every cell it covers is one of
// them.
Eigen::AlignedBox3d FreeBox(const std::vector<Cell>& cells, const Grid& grid) {
  std::vector<char> is_member(static_cast<std::size_t>(grid.size().prod()), 0);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Cell& c : cells) {
    is_member[grid.Index(c)] = 1;
    mean += c.cast<double>();
  }
  mean /= static_cast<double>(cells.size());
  const Cell start =
      *std::min_element(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
        return (a.cast<double>() - mean).squaredNorm() < (b.cast<double>() - mean).squaredNorm();
      });
  Cell low = start, high = start;
  const auto layer_is_free = [&](int side) {
    Cell from = low, to = high;
    const int axis = side / 2;
    from[axis] = to[axis] = side % 2 == 0 ? low[axis] - 1 : high[axis] + 1;
    if (!grid.Inside(from) || !grid.Inside(to)) return false;
    for (int k = from.z(); k <= to.z(); ++k) {
      for (int j = from.y(); j <= to.y(); ++j) {
        for (int i = from.x(); i <= to.x(); ++i) {
          if (!is_member[grid.Index({i, j, k})]) return false;
        }
      }
    }
    return true;
  };
  for (bool grown = true; grown;) {
    grown = false;
    for (int side = 0; side < 6; ++side) {
      if (!layer_is_free(side)) continue;
      (side % 2 == 0 ? low[side / 2] : high[side / 2]) += side % 2 == 0 ? -1 : 1;
      grown = true;
    }
  }
  return {grid.Corner(low), grid.Corner(high + Cell::Ones())};
}

}  // namespace

std::vector<Receptacle> FindReceptacles(int link, const std::vector<core::TriangleMesh>& parts,
                                        double least) {
  std::vector<Receptacle> receptacles;
  if (parts.empty()) return receptacles;
  Eigen::AlignedBox3d whole;
  for (const core::TriangleMesh& part : parts) whole.extend(core::Bounds(part));
  const double longest = whole.sizes().maxCoeff();
  if (!(longest >= least && longest <= kMaxSize)) return receptacles;
  const Grid grid(parts);
  const std::vector<unsigned char> shields = Shields(grid);
  std::vector<char> seen(shields.size(), 0);
  const auto shielded = [&](const Cell& c) {
    return !grid.Full(c) && __builtin_popcount(shields[grid.Index(c)]) >= kShieldedSides;
  };
  const Cell size = grid.size();
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) {
        const Cell seed(i, j, k);
        if (seen[grid.Index(seed)] || !shielded(seed)) continue;
        std::vector<Cell> cells{seed};
        seen[grid.Index(seed)] = 1;
        for (std::size_t at = 0; at < cells.size(); ++at) {
          for (int side = 0; side < 6; ++side) {
            const Cell next = cells[at] + Side(side);
            if (!grid.Inside(next) || seen[grid.Index(next)] || !shielded(next)) continue;
            seen[grid.Index(next)] = 1;
            cells.push_back(next);
          }
        }
        Receptacle receptacle;
        receptacle.link = link;
        receptacle.box = FreeBox(cells, grid);
        receptacle.opening = Side(OpenSide(cells, grid, shields)).cast<double>();
        const double depth = std::abs(receptacle.box.sizes().dot(receptacle.opening));
        const bool niche = std::abs(receptacle.opening.z()) < 0.5 && depth < kMinSideDepth;
        if (niche || receptacle.box.sizes().minCoeff() < least) continue;
        receptacles.push_back(receptacle);
      }
    }
  }
  std::sort(receptacles.begin(), receptacles.end(), [](const Receptacle& a, const Receptacle& b) {
    return a.box.volume() > b.box.volume();
  });
  return receptacles;
}

namespace {

constexpr double kDoorShare = 0.2;    // of an opening's area; a link that covers more is its door
constexpr double kFilledShare = 0.3;  // of the volume; a receptacle filled more is removed

// Returns the AABB of the extreme points of link `other` in the frame of link `link`.
Eigen::AlignedBox3d BoxInFrameOf(const ArticulatedObject& object,
                                 const std::vector<Eigen::Isometry3d>& poses, int link, int other) {
  const Eigen::Isometry3d link_from_other =
      poses[static_cast<std::size_t>(link)].inverse() * poses[static_cast<std::size_t>(other)];
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point :
       object.links[static_cast<std::size_t>(other)].extreme_points) {
    box.extend(link_from_other * point);
  }
  return box;
}

// Returns the nearest joint above a link, which moves it; -1: none.
int MovedBy(const ArticulatedObject& object, int link) {
  for (int at = link; at >= 0; at = object.kinematics->ParentLink(at)) {
    const int joint = object.links[static_cast<std::size_t>(at)].joint;
    if (joint >= 0) return joint;
  }
  return -1;
}

// Returns the share of the slab in front of the opening that a box covers, seen along the opening.
double CoveredShare(const Eigen::AlignedBox3d& cover, const Eigen::AlignedBox3d& slab,
                    const Eigen::Vector3d& opening) {
  if (cover.isEmpty() || !cover.intersects(slab)) return 0.0;
  const Eigen::Vector3d shared = cover.intersection(slab).sizes();
  double share = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(opening[axis]) < 0.5) share *= shared[axis] / slab.sizes()[axis];
  }
  return share;
}

}  // namespace

void AssignDoors(ArticulatedObject* object) {
  const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(*object, RestPositions(*object));
  const int links = static_cast<int>(object->links.size());
  const auto is_filled = [&](const Receptacle& receptacle) {
    double filled = 0.0;
    for (int other = 0; other < links; ++other) {
      if (other == receptacle.link || MovedBy(*object, other) == MovedBy(*object, receptacle.link))
        continue;
      if (MovedBy(*object, other) < 0) continue;  // the body around a drawer is not inside it
      const Eigen::AlignedBox3d box = BoxInFrameOf(*object, poses, receptacle.link, other);
      if (box.isEmpty() || !box.intersects(receptacle.box)) continue;
      filled += box.intersection(receptacle.box).volume();
    }
    return filled > kFilledShare * receptacle.box.volume();
  };
  std::erase_if(object->receptacles, is_filled);
  for (Receptacle& receptacle : object->receptacles) {
    // The slab is a thin volume in front of the opening.
    Eigen::AlignedBox3d slab = receptacle.box;
    const Eigen::Vector3d beyond = 0.25 * receptacle.box.sizes().cwiseProduct(receptacle.opening);
    slab.extend(Eigen::Vector3d(receptacle.box.max() + beyond.cwiseMax(0.0)));
    slab.extend(Eigen::Vector3d(receptacle.box.min() + beyond.cwiseMin(0.0)));
    const int own = MovedBy(*object, receptacle.link);
    double most = kDoorShare;
    for (int other = 0; other < links; ++other) {
      const int moved_by = MovedBy(*object, other);
      if (other == receptacle.link || (moved_by < 0 && own < 0)) continue;
      const double share = CoveredShare(BoxInFrameOf(*object, poses, receptacle.link, other), slab,
                                        receptacle.opening);
      if (share <= most) continue;
      most = share;
      // A drawer is closed by the body it slides under, such as another drawer: its own joint opens
      // it.
      const bool slides = own >= 0 && object->joints[static_cast<std::size_t>(own)].type ==
                                          reward::RewardJointType::kPrismatic;
      receptacle.door = slides || moved_by < 0 || moved_by == own ? own : moved_by;
    }
  }
}

}  // namespace simwright::tasks
