#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "assets/joint_poses.h"
#include "core/error.h"
#include "core/random.h"
#include "geometry/distance.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "library/articulated/articulated_kinds.h"

namespace simwright::library {
namespace {

using assets::ArticulatedAsset;
using assets::ArticulatedLink;

class EveryKind : public ::testing::TestWithParam<std::string> {
 protected:
  ArticulatedAsset Make(std::uint64_t seed) const { return KindNamed(GetParam()).make({seed, ""}); }
};

// Links that a joint moves relative to each other do not interpenetrate, by GJK on the parts at
// random positions of all joints at once.
TEST_P(EveryKind, LinksStayApartAtRandomPositions) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ArticulatedAsset asset = Make(seed);
    const assets::UrdfModel model = assets::ModelOf(asset);
    core::Rng rng = core::StreamRng(seed, 7);
    for (int sample = 0; sample < 6; ++sample) {
      assets::JointPositions positions;
      for (const assets::Joint& joint : asset.joints) {
        positions[joint.name] = core::Uniform(rng, joint.lower, joint.upper);
      }
      const auto poses = assets::LinkPoses(model, positions);
      for (size_t i = 0; i < asset.joints.size(); ++i) {
        if (!asset.joints[i].Moves()) continue;
        // The joint's own two links; other pairs are tested by the asset check.
        const size_t parent = static_cast<size_t>(assets::ParentLinks(model)[i]);
        for (const core::TriangleMesh& a : asset.links[i + 1].parts) {
          for (const core::TriangleMesh& b : asset.links[parent].parts) {
            EXPECT_GT(
                geometry::SignedDistance({a.vertices}, poses[i + 1], {b.vertices}, poses[parent])
                    .distance,
                2e-4)
                << asset.links[i + 1].name << ", seed " << seed;
          }
        }
      }
    }
  }
}

// Mass by another formula than the divergence theorem's inertia code: tetrahedra from a corner.
double LibraryVolume(const core::TriangleMesh& mesh) {
  double volume = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d o = mesh.vertices[0];
    volume +=
        (mesh.vertices[t[0]] - o).dot((mesh.vertices[t[1]] - o).cross(mesh.vertices[t[2]] - o)) /
        6.0;
  }
  return volume;
}

TEST_P(EveryKind, WeighsItsVolumesTimesTheirDensities) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ArticulatedAsset asset = Make(seed);
    double whole = 0.0;
    for (const ArticulatedLink& link : asset.links) {
      ASSERT_EQ(link.parts.size(), link.densities.size()) << link.name;
      double mass = 0.0, volume = 0.0;
      for (size_t i = 0; i < link.parts.size(); ++i) {
        EXPECT_GT(link.densities[i], 10.0) << link.name;
        volume += LibraryVolume(link.parts[i]);
        mass += LibraryVolume(link.parts[i]) * link.densities[i];
      }
      EXPECT_NEAR(link.inertial.mass, mass, 1e-9 * mass) << link.name;
      EXPECT_NEAR(link.volume, volume, 1e-9 * volume) << link.name;
      const Eigen::Vector3d m = geometry::PrincipalInertiaOf(link.inertial.inertia).moments;
      EXPECT_LT(m[2], m[0] + m[1]) << link.name;
      EXPECT_GT(m[0], 0.0) << link.name;
      whole += mass;
    }
    EXPECT_NEAR(asset.parameters.mass.sample, whole, 1e-9 * whole);
  }
}

TEST_P(EveryKind, PartsAreClosedConvexAndSmall) {
  const ArticulatedAsset asset = Make(4);
  for (const ArticulatedLink& link : asset.links) {
    for (const core::TriangleMesh& part : link.parts) {
      const geometry::MeshValidity s = geometry::Examine(part);
      EXPECT_TRUE(s.IsSolid()) << link.name << ": " << geometry::Describe(s);
      EXPECT_LE(part.vertices.size(), 64u) << link.name;
      const double size = core::Bounds(part).diagonal().norm();
      for (size_t t = 0; t < part.triangles.size(); ++t) {
        const Eigen::Vector3d normal =
            core::TriangleAreaVector(part, static_cast<int>(t)).normalized();
        const Eigen::Vector3d& corner = part.vertices[part.triangles[t][0]];
        for (const Eigen::Vector3d& v : part.vertices) {
          ASSERT_LT(normal.dot(v - corner), 1e-6 * size) << link.name << " is not convex";
        }
      }
    }
  }
}

TEST_P(EveryKind, SpeaksOfItsLinksAndStandsOnTheOrigin) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const ArticulatedAsset asset = Make(seed);
    std::set<std::string> names;
    int moving = 0;
    for (size_t i = 0; i < asset.links.size(); ++i) {
      EXPECT_FALSE(asset.links[i].label.empty());
      EXPECT_TRUE(names.insert(asset.links[i].name).second) << asset.links[i].name;
      if (i == 0) continue;
      const assets::Joint& joint = asset.joints[i - 1];
      EXPECT_EQ(joint.name, asset.links[i].name + "_joint");
      if (!joint.Moves()) continue;
      ++moving;
      EXPECT_LE(joint.lower, 0.0);
      EXPECT_GT(joint.upper, 0.0);
      EXPECT_GT(joint.friction, 0.0);
      EXPECT_GT(joint.damping, 0.0);
    }
    EXPECT_GE(moving, 1);
    EXPECT_NEAR(assets::BoundsAtZero(asset).min().z(), 0.0, 1e-6) << "seed " << seed;
    EXPECT_LE(asset.parameters.mass.min, asset.parameters.mass.sample);
    EXPECT_GE(asset.parameters.mass.max, asset.parameters.mass.sample);
  }
}

TEST_P(EveryKind, SameSeedSameThingAnotherSeedAnother) {
  const ArticulatedAsset a = Make(9), b = Make(9), c = Make(10);
  ASSERT_EQ(a.links.size(), b.links.size());
  for (size_t i = 0; i < a.links.size(); ++i) {
    EXPECT_EQ(a.links[i].inertial.mass, b.links[i].inertial.mass);
    EXPECT_EQ(a.links[i].visual.mesh.vertices, b.links[i].visual.mesh.vertices);
  }
  EXPECT_NE(a.links[0].inertial.mass, c.links[0].inertial.mass);
}

INSTANTIATE_TEST_SUITE_P(Library, EveryKind, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Kind& kind : Kinds()) names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

TEST(Kinds, UnknownOnesAreRefusedWithTheKnown) {
  try {
    KindNamed("sofa");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("microwave"), std::string::npos);
  }
}

}  // namespace
}  // namespace simwright::library
