#include "asset_lift/priors/training_shapes.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/priors/shape_parts.h"

namespace simwright::asset_lift {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Eigen::Vector4f RandomColor(core::Rng* rng) {
  // Half of household objects are grey, white, black or brown.
  const double value = core::Uniform(*rng, 0.05, 1.0), tint = core::Uniform(*rng);
  Eigen::Vector4f color(0, 0, 0, 1);
  for (int c = 0; c < 3; ++c) {
    const double own = core::Uniform(*rng);
    color[c] =
        static_cast<float>(std::clamp(value + (tint < 0.5 ? 0.15 : 0.7) * (own - 0.5), 0.0, 1.0));
  }
  return color;
}

// Returns stripes, checks, dots or grain in two colours.
core::Image RandomTexture(core::Rng* rng) {
  constexpr int kSide = 64;
  const Eigen::Vector4f a = RandomColor(rng), b = RandomColor(rng);
  const int kind = static_cast<int>(core::UniformIndex(*rng, 4));
  const int period = 4 << core::UniformIndex(*rng, 3);
  core::Image image(kSide, kSide, 3);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      double share = 0.0;
      if (kind == 0) share = x / period % 2;
      if (kind == 1) share = (x / period + y / period) % 2;
      if (kind == 2) {
        const double dx = x % period - 0.5 * period, dy = y % period - 0.5 * period;
        share = dx * dx + dy * dy < 0.09 * period * period ? 1.0 : 0.0;
      }
      if (kind == 3) share = core::Uniform(*rng);
      for (int c = 0; c < 3; ++c) {
        image.At(x, y)[c] =
            static_cast<std::uint8_t>(std::lround(255.0 * (a[c] + share * (b[c] - a[c]))));
      }
    }
  }
  return image;
}

// Assembles parts and paints them.
class Assembly {
 public:
  explicit Assembly(core::Rng* rng) : rng_(rng) {
    const int kinds = 1 + static_cast<int>(core::UniformIndex(*rng, 3));
    for (int i = 0; i < kinds; ++i) {
      core::Material material;
      material.name = "m" + std::to_string(i);
      material.base_color = RandomColor(rng);
      if (core::Uniform(*rng) < 0.35) {
        material.base_color = {1, 1, 1, 1};
        material.texture = static_cast<int>(shape_.textures.size());
        shape_.textures.push_back(RandomTexture(rng));
      }
      shape_.materials.push_back(material);
    }
  }

  double Draw(double low, double high) { return core::Uniform(*rng_, low, high); }
  int Pick(int count) { return static_cast<int>(core::UniformIndex(*rng_, count)); }
  bool Bernoulli(double share) { return core::Uniform(*rng_) < share; }

  void Add(core::TriangleMesh part, const Vector3d& at = Vector3d::Zero(),
           const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity(), int material = -1) {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    place.linear() = turn;
    place.translation() = at;
    const int chosen = material >= 0 ? material % static_cast<int>(shape_.materials.size())
                                     : Pick(static_cast<int>(shape_.materials.size()));
    // UVs follow the position before placing: the texture wraps around the part.
    const double scale = 1.5;
    for (const Eigen::Vector3i& t : part.triangles) {
      const Vector3d n = (part.vertices[t[1]] - part.vertices[t[0]])
                             .cross(part.vertices[t[2]] - part.vertices[t[0]])
                             .cwiseAbs();
      const int axis = n.x() > n.y() ? (n.x() > n.z() ? 0 : 2) : (n.y() > n.z() ? 1 : 2);
      for (int k = 0; k < 3; ++k) {
        const Vector3d& p = part.vertices[t[k]];
        shape_.corner_uvs.push_back(
            Eigen::Vector2d(scale * p[(axis + 1) % 3], scale * p[(axis + 2) % 3]).cast<float>());
      }
      shape_.triangle_material.push_back(chosen);
    }
    core::Transform(place, &part);
    core::Append(part, &shape_.mesh);
  }

  // Adds four legs at (+-x, +-y), from the floor up.
  void AddLegs(double x, double y, double height, double thick, int material) {
    const bool round = Bernoulli(0.4);
    const double taper = Draw(0.5, 1.0);
    for (int i = 0; i < 4; ++i) {
      const Vector3d at((i & 1 ? 1 : -1) * x, (i & 2 ? 1 : -1) * y, 0.5 * height);
      if (round) {
        Add(RevolvedPart({{0.5 * thick * taper, -0.5 * height}, {0.5 * thick, 0.5 * height}}, 12),
            at, Eigen::Matrix3d::Identity(), material);
      } else {
        Add(BoxPart({thick, thick, height}), at, Eigen::Matrix3d::Identity(), material);
      }
    }
  }

  core::TexturedMesh Take() { return std::move(shape_); }

 private:
  core::Rng* rng_;
  core::TexturedMesh shape_;
};

Eigen::Matrix3d RotationAbout(const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

// Returns smooth radii between the heights 0 and `height`, for bottles, vases and turned legs.
std::vector<Vector2d> SmoothProfile(Assembly* a, double height, double wide) {
  const int knots = 3 + a->Pick(4);
  std::vector<double> radius;
  for (int i = 0; i < knots; ++i) radius.push_back(wide * a->Draw(0.25, 1.0));
  std::vector<Vector2d> profile;
  constexpr int kLevels = 24;
  for (int i = 0; i <= kLevels; ++i) {
    const double t = static_cast<double>(i) / kLevels * (knots - 1);
    const int k = std::min(knots - 2, static_cast<int>(t));
    const double u = t - k, eased = u * u * (3.0 - 2.0 * u);
    const size_t at = static_cast<size_t>(k);
    profile.emplace_back(radius[at] + eased * (radius[at + 1] - radius[at]), height * i / kLevels);
  }
  return profile;
}

void AddHandle(Assembly* a, double radius, double low, double high, double angle) {
  std::vector<Vector3d> path;
  const double reach = a->Draw(0.5, 1.4) * (high - low), square = a->Draw(0.5, 1.0);
  for (int i = 0; i <= 14; ++i) {
    const double t = M_PI * i / 14;
    const double out = std::pow(std::sin(t), square) * 0.6 * reach;
    path.emplace_back((0.93 * radius + out), 0.0,
                      0.5 * (low + high) - 0.5 * (high - low) * std::cos(t));
  }
  a->Add(TubePart(path, a->Draw(0.06, 0.13) * (high - low), 10), Vector3d::Zero(),
         RotationAbout(Vector3d::UnitZ(), angle), 0);
}

void Vessel(Assembly* a) {
  const double height = a->Draw(0.25, 1.2), wide = a->Draw(0.25, 0.6), wall = a->Draw(0.02, 0.06);
  std::vector<Vector2d> outside;
  if (a->Bernoulli(0.5)) {
    const double foot = wide * a->Draw(0.45, 1.05), bulge = a->Draw(-0.1, 0.25) * wide;
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0;
      outside.emplace_back(foot + (wide - foot) * t + bulge * std::sin(M_PI * t), height * t);
    }
  } else {
    outside = SmoothProfile(a, height, wide);
  }
  std::vector<Vector2d> profile = outside;
  for (size_t i = outside.size(); i-- > 0;) {
    const double z = std::max(outside[i].y(), 1.5 * wall);
    profile.emplace_back(std::max(0.01, outside[i].x() - wall), z);
  }
  a->Add(RevolvedPart(profile, 32), Vector3d::Zero(), Eigen::Matrix3d::Identity(), 0);
  if (a->Bernoulli(0.6)) {
    const double turn = a->Draw(0, 2 * M_PI), low = height * a->Draw(0.1, 0.35),
                 high = height * a->Draw(0.65, 0.92);
    AddHandle(a, outside[outside.size() / 2].x(), low, high, turn);
    if (a->Bernoulli(0.25)) AddHandle(a, outside[outside.size() / 2].x(), low, high, turn + M_PI);
  }
  if (a->Bernoulli(0.15)) {  // a saucer or a tray
    a->Add(
        RevolvedPart({{0.6 * wide, -0.03}, {1.6 * wide, 0.02}, {1.6 * wide, 0.04}, {0.0, 0.0}}, 32),
        {0, 0, -0.01});
  }
}

void SolidOfRevolution(Assembly* a) {
  const double height = a->Draw(0.3, 1.4);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (a->Bernoulli(0.2)) turn = RotationAbout(Vector3d::UnitX(), 0.5 * M_PI);
  a->Add(RevolvedPart(SmoothProfile(a, height, a->Draw(0.12, 0.6)), 28), Vector3d::Zero(), turn);
  if (a->Bernoulli(0.3)) {
    a->Add(SuperquadricPart(Vector3d::Constant(a->Draw(0.08, 0.3)), 1, 1, 20),
           turn * Vector3d(0, 0, height));
  }
}

void Bunch(Assembly* a) {
  const int count = 1 + a->Pick(5);
  Vector3d at = Vector3d::Zero(), half = Vector3d::Zero();
  const bool mirrored = a->Bernoulli(0.5);
  for (int i = 0; i < count; ++i) {
    const Vector3d size{a->Draw(0.08, 0.5), a->Draw(0.08, 0.5), a->Draw(0.08, 0.5)};
    if (i > 0) {
      Vector3d direction{a->Draw(-1, 1), a->Draw(-1, 1), a->Draw(-0.6, 1)};
      direction.normalize();
      at += 0.8 * direction.cwiseProduct(half + 0.7 * size);
    }
    half = size;
    const Eigen::Matrix3d turn = a->Bernoulli(0.3)
                                     ? RotationAbout(Vector3d::UnitZ(), a->Draw(0, M_PI))
                                     : Eigen::Matrix3d::Identity();
    const core::TriangleMesh part =
        SuperquadricPart(size, a->Draw(0.15, 1.3), a->Draw(0.15, 1.3), 24);
    a->Add(part, at, turn, i);
    if (mirrored && i > 0) a->Add(part, {-at.x(), at.y(), at.z()}, turn.transpose(), i);
  }
}

void Table(Assembly* a) {
  const double x = a->Draw(0.25, 0.8), y = a->Draw(0.25, 0.6), height = a->Draw(0.25, 1.0),
               thick = a->Draw(0.03, 0.12);
  const bool round = a->Bernoulli(0.35);
  const double radius = 0.5 * (x + y);
  if (round) {
    a->Add(RevolvedPart({{radius, -0.5 * thick}, {radius, 0.5 * thick}}, 32), {0, 0, height});
  } else {
    a->Add(BoxPart({2 * x, 2 * y, thick}), {0, 0, height});
  }
  if (round && a->Bernoulli(0.6)) {
    const double stem = a->Draw(0.04, 0.15), foot = a->Draw(0.3, 0.8) * radius;
    a->Add(RevolvedPart({{foot, 0.0}, {foot, 0.04}, {stem, 0.1}, {stem, height}}, 24));
  } else {
    const double inside = round ? 0.65 : a->Draw(0.8, 0.95);
    a->AddLegs(inside * (round ? radius : x), inside * (round ? radius : y), height,
               a->Draw(0.04, 0.12), 1);
    if (a->Bernoulli(0.3))
      a->Add(BoxPart({2 * x * inside, 2 * y * inside, 0.04}), {0, 0, 0.3 * height});
  }
}

void Chair(Assembly* a) {
  const double x = a->Draw(0.22, 0.5), y = a->Draw(0.22, 0.4), seat = a->Draw(0.25, 0.55),
               back = a->Draw(0.2, 0.8), thick = a->Draw(0.04, 0.2);
  a->Add(a->Bernoulli(0.6) ? BoxPart({2 * x, 2 * y, thick})
                           : SuperquadricPart({x, y, 0.6 * thick}, 0.4, a->Draw(0.3, 1.0), 24),
         {0, 0, seat}, Eigen::Matrix3d::Identity(), 0);
  const double lean = a->Draw(0.0, 0.3), back_thick = a->Draw(0.03, 0.18);
  const Eigen::Matrix3d turn = RotationAbout(Vector3d::UnitX(), -lean);
  const int bars = a->Bernoulli(0.4) ? 2 + a->Pick(4) : 0;
  const Vector3d foot(0, y - 0.5 * back_thick, seat);
  if (bars == 0) {
    a->Add(BoxPart({2 * x, back_thick, back}), foot + turn * Vector3d(0, 0, 0.5 * back), turn, 0);
  } else {
    for (int i = 0; i < bars; ++i) {
      const double at = -x + 2 * x * (i + 0.5) / bars;
      a->Add(BoxPart({0.05, 0.05, back}), foot + turn * Vector3d(at, 0, 0.5 * back), turn, 1);
    }
    a->Add(BoxPart({2 * x, 0.06, 0.1}), foot + turn * Vector3d(0, 0, back), turn, 1);
  }
  if (a->Bernoulli(0.35)) {
    const double high = seat + a->Draw(0.12, 0.3), wide = a->Draw(0.05, 0.2);
    const bool panel = a->Bernoulli(0.5);  // a panel down to the floor, or a raised rail
    for (const int side : {-1, 1}) {
      a->Add(BoxPart({wide, 2 * y, panel ? high : 0.06}), {side * x, 0, panel ? 0.5 * high : high},
             Eigen::Matrix3d::Identity(), 1);
    }
  }
  if (a->Bernoulli(0.75)) {
    a->AddLegs(0.88 * x, 0.88 * y, seat, a->Draw(0.04, 0.1), 1);
  } else {
    a->Add(BoxPart({1.9 * x, 1.9 * y, seat}), {0, 0, 0.5 * seat});
  }
}

void Cabinet(Assembly* a) {
  const double x = a->Draw(0.15, 0.7), y = a->Draw(0.12, 0.5), height = a->Draw(0.2, 1.4),
               wall = a->Draw(0.03, 0.06), lift = a->Bernoulli(0.3) ? a->Draw(0.08, 0.3) : 0.0;
  const double middle = lift + 0.5 * height;
  if (lift > 0.0) a->AddLegs(0.85 * x, 0.85 * y, lift, a->Draw(0.04, 0.1), 1);
  if (a->Bernoulli(0.55)) {  // closed, with doors or drawers
    a->Add(BoxPart({2 * x, 2 * y, height}), {0, 0, middle}, Eigen::Matrix3d::Identity(), 0);
    const int rows = 1 + a->Pick(4), columns = 1 + a->Pick(2);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        const Vector3d at(-x + 2 * x * (c + 0.5) / columns, -y, lift + height * (r + 0.5) / rows);
        a->Add(BoxPart({1.8 * x / columns, 0.03, 0.88 * height / rows}), at,
               Eigen::Matrix3d::Identity(), 1);
        a->Add(SuperquadricPart({0.03, 0.03, 0.03}, 1, 1, 12), at - Vector3d(0, 0.04, 0),
               Eigen::Matrix3d::Identity(), 2);
      }
    }
    return;
  }
  for (const int side : {-1, 1}) {
    a->Add(BoxPart({wall, 2 * y, height}), {side * x, 0, middle}, Eigen::Matrix3d::Identity(), 0);
  }
  if (a->Bernoulli(0.7)) {
    a->Add(BoxPart({2 * x, wall, height}), {0, y, middle}, Eigen::Matrix3d::Identity(), 0);
  }
  const int boards = 2 + a->Pick(4);
  for (int i = 0; i < boards; ++i) {
    a->Add(BoxPart({2 * x, 2 * y, wall}), {0, 0, lift + height * i / (boards - 1.0)},
           Eigen::Matrix3d::Identity(), 0);
  }
}

void Appliance(Assembly* a) {
  const Vector3d half{a->Draw(0.15, 0.6), a->Draw(0.05, 0.5), a->Draw(0.1, 0.7)};
  a->Add(a->Bernoulli(0.6) ? BoxPart(2 * half)
                           : SuperquadricPart(half, a->Draw(0.1, 0.4), a->Draw(0.1, 0.4), 32),
         {0, 0, half.z()}, Eigen::Matrix3d::Identity(), 0);
  if (a->Bernoulli(0.7)) {
    a->Add(BoxPart({1.7 * half.x(), 0.04, 1.5 * half.z()}), {0, -half.y(), half.z()},
           Eigen::Matrix3d::Identity(), 1);
  }
  if (a->Bernoulli(0.3)) {
    const double stand = a->Draw(0.05, 0.3);
    a->Add(BoxPart({0.15, 0.1, stand}), {0, 0, -0.5 * stand});
    a->Add(BoxPart({0.9 * half.x(), a->Draw(0.2, 0.5), 0.04}), {0, 0, -stand});
  }
  if (a->Bernoulli(0.3)) {
    a->Add(RevolvedPart({{0.08, 0.0}, {0.1, 0.15}}, 16), {0, 0, 2 * half.z()});
  }
}

void Lamp(Assembly* a) {
  const double height = a->Draw(0.5, 1.6), foot = a->Draw(0.12, 0.35), pole = a->Draw(0.015, 0.07),
               low = a->Draw(0.15, 0.5), high = a->Draw(0.05, 0.4), shade = a->Draw(0.15, 0.5);
  a->Add(RevolvedPart({{foot, 0.0}, {foot, 0.05}, {pole, 0.09}, {pole, height}}, 24),
         Vector3d::Zero(), Eigen::Matrix3d::Identity(), 0);
  a->Add(RevolvedPart({{low, height - 0.5 * shade},
                       {high, height + 0.5 * shade},
                       {std::max(0.01, high - 0.03), height + 0.5 * shade},
                       {low - 0.03, height - 0.5 * shade + 0.001}},
                      28),
         Vector3d::Zero(), Eigen::Matrix3d::Identity(), 1);
}

void Stack(Assembly* a) {
  const int count = 2 + a->Pick(5);
  for (int i = 0; i < count; ++i) {
    a->Add(BoxPart({a->Draw(0.08, 0.8), a->Draw(0.08, 0.8), a->Draw(0.05, 0.8)}),
           {a->Draw(-0.4, 0.4), a->Draw(-0.4, 0.4), a->Draw(0.0, 0.7)},
           a->Bernoulli(0.3) ? RotationAbout(Vector3d::UnitZ(), a->Draw(0, M_PI))
                             : Eigen::Matrix3d::Identity());
  }
}

}  // namespace

core::TexturedMesh MakeTrainingShape(core::Rng* rng) {
  Assembly assembly(rng);
  using Kind = void (*)(Assembly*);
  // Vessels and bunches are listed twice: most objects photographed for a robot are of these kinds.
  constexpr Kind kKinds[] = {Vessel, Vessel,  SolidOfRevolution, Bunch, Bunch, Table,
                             Chair,  Cabinet, Appliance,         Lamp,  Stack};
  kKinds[core::UniformIndex(*rng, std::size(kKinds))](&assembly);
  return assembly.Take();
}

}  // namespace simwright::asset_lift
