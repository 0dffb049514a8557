// The repair of specks, voids, holes, fins and absurd sizes. The truth is a sound mesh's.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "assets/primitive_meshes.h"
#include "core/files.h"
#include "geometry/hole_filling.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"
#include "importers/file_scale.h"
#include "importers/hole_closing.h"
#include "importers/loose_faces.h"
#include "importers/surface_noise.h"
#include "importers/t_junctions.h"
#include "importers/torn_bottom.h"
#include "tests/importers/damaged/damaged_corpus.h"
#include "tests/importers/damaged/specimen_file.h"
#include "tests/workflows/program.h"

namespace simwright::importers {
namespace {
namespace fs = std::filesystem;

const physics_params::Category& CategoryNamed(const char* name) {
  return *physics_params::KnowledgeBase::Shipped().FindCategory(name);
}

core::TexturedMesh Box(const Eigen::Vector3d& sides) {
  core::TexturedMesh mesh;
  mesh.mesh = damaged::Subdivided(assets::BoxMesh(sides), 0.03);
  return mesh;
}

core::TriangleMesh MovedBox(const Eigen::Vector3d& sides, const Eigen::Vector3d& by) {
  core::TriangleMesh box = assets::BoxMesh(sides);
  for (Eigen::Vector3d& v : box.vertices) v += by;
  return box;
}

int FigureOf(const core::Findings& findings, const std::string& code) {
  for (const core::Finding& finding : findings) {
    if (finding.code == code) return static_cast<int>(finding.figure);
  }
  return 0;
}

double VolumeOf(const core::TexturedMesh& mesh) {
  return geometry::SignedVolume(geometry::Weld(mesh.mesh, 0.0));
}

// Removes the faces whose middle is chosen.
template <typename Chosen>
void Open(const Chosen& chosen, core::TexturedMesh* mesh) {
  std::vector<Eigen::Vector3i> kept;
  for (const Eigen::Vector3i& t : mesh->mesh.triangles) {
    const Eigen::Vector3d middle =
        (mesh->mesh.vertices[t[0]] + mesh->mesh.vertices[t[1]] + mesh->mesh.vertices[t[2]]) / 3.0;
    if (!chosen(middle)) kept.push_back(t);
  }
  ASSERT_LT(kept.size(), mesh->mesh.triangles.size());
  mesh->mesh.triangles.swap(kept);
}

TEST(LooseFaces, SpecksAndVoidsAreRemovedAndLargePartsKept) {
  core::TexturedMesh mesh = Box({0.2, 0.1, 0.1});
  const std::size_t faces = mesh.mesh.triangles.size();
  for (int i = 0; i < 5; ++i) {
    core::Append(MovedBox({0.002, 0.002, 0.002}, {0.2 + 0.01 * i, 0, 0}), &mesh.mesh);
  }
  core::TriangleMesh inner = assets::BoxMesh({0.18, 0.08, 0.08});
  for (Eigen::Vector3i& t : inner.triangles) std::swap(t[0], t[1]);
  core::Append(inner, &mesh.mesh);
  core::Append(MovedBox({0.04, 0.04, 0.04}, {0, 0, 0.3}), &mesh.mesh);
  core::Findings findings;
  RemoveLooseFaces("a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-specks"), 5);
  EXPECT_EQ(FigureOf(findings, "mesh-inner-shells"), 1);
  EXPECT_EQ(FigureOf(findings, "mesh-floating-parts"), 1);
  EXPECT_EQ(mesh.mesh.triangles.size(), faces + 12);
  EXPECT_NEAR(VolumeOf(mesh), 0.2 * 0.1 * 0.1 + 0.04 * 0.04 * 0.04, 1e-9);
}

// Contents behind glass stay, and so do labels, which have a material of their own.
TEST(LooseFaces, ContentsOfGlassAndLabelsStay) {
  core::TexturedMesh mesh = Box({0.2, 0.1, 0.1});
  core::Append(assets::BoxMesh({0.1, 0.05, 0.05}), &mesh.mesh);
  mesh.materials = {{"glass", {1, 1, 1, 0.3f}, -1}};
  mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  const std::size_t faces = mesh.mesh.triangles.size();
  core::Findings findings;
  RemoveLooseFaces("a.glb", &mesh, &findings);
  EXPECT_EQ(mesh.mesh.triangles.size(), faces);

  for (const int label_material : {0, 1}) {
    core::TexturedMesh box = Box({0.2, 0.1, 0.1});
    box.materials = {{"card", {1, 1, 1, 1}, -1}, {"label", {1, 0, 0, 1}, -1}};
    box.triangle_material.assign(box.mesh.triangles.size(), 0);
    const int first = static_cast<int>(box.mesh.vertices.size());
    for (const auto& [x, y] : {std::pair{-0.02, -0.02}, {0.02, -0.02}, {0.0, 0.02}}) {
      box.mesh.vertices.emplace_back(x, y, 0.05 + 1e-5);
    }
    box.mesh.triangles.emplace_back(first, first + 1, first + 2);
    box.triangle_material.push_back(label_material);
    const std::size_t with_label = box.mesh.triangles.size();
    findings.clear();
    RemoveLooseFaces("a.glb", &box, &findings);
    EXPECT_EQ(FigureOf(findings, "mesh-coplanar-faces"), label_material == 0 ? 1 : 0);
    EXPECT_EQ(box.mesh.triangles.size(), with_label - (label_material == 0 ? 1 : 0));
  }
}

TEST(HoleClosing, SmallHolesAndTheBottomAreClosed) {
  core::TexturedMesh mesh = Box({0.2, 0.2, 0.2});
  Open([](const Eigen::Vector3d& m) { return m.z() < -0.0999 || m.norm() < 0.102; }, &mesh);
  core::Findings findings;
  CloseHoles(CategoryNamed("box"), "a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-open"), 0);
  EXPECT_TRUE(geometry::Examine(geometry::Weld(mesh.mesh, 0.0)).IsSolid());
  EXPECT_NEAR(VolumeOf(mesh), 0.008, 1e-9);
}

// Crumbs of a torn bottom that lie in the hole are not closed as sheets of their own.
TEST(HoleClosing, FragmentsInAClosedHoleAreRemoved) {
  core::TexturedMesh mesh = Box({0.2, 0.2, 0.2});
  Open(
      [](const Eigen::Vector3d& m) {
        return m.z() < -0.0999 && (m.head<2>().norm() > 0.03 || m.x() < 0.0);
      },
      &mesh);
  core::Findings findings;
  CloseHoles(CategoryNamed("box"), "a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-open"), 0);
  EXPECT_GE(FigureOf(findings, "mesh-specks"), 1);
  EXPECT_TRUE(geometry::Examine(geometry::Weld(mesh.mesh, 0.0)).IsSolid());
  EXPECT_NEAR(VolumeOf(mesh), 0.008, 1e-9);
}

TEST(HoleClosing, ATornBottomIsReplaced) {
  core::TexturedMesh mesh;
  mesh.mesh = damaged::Subdivided(assets::BoxMesh({0.2, 0.2, 0.2}), 0.012);
  int face = 0;
  Open([&](const Eigen::Vector3d& m) { return m.z() < -0.0999 && ++face % 3 != 0; }, &mesh);
  core::Findings findings;
  RemoveTornBottom("a.glb", &mesh, &findings);
  EXPECT_GE(FigureOf(findings, "mesh-torn-bottom"), 12);
  CloseHoles(CategoryNamed("box"), "a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-holes-closed"), 0);  // its figure is a share under 1
  EXPECT_TRUE(geometry::Examine(geometry::Weld(mesh.mesh, 0.0)).IsSolid());
  EXPECT_NEAR(VolumeOf(mesh), 0.008, 1e-9);
  // A sound bottom with two holes stays.
  core::TexturedMesh sound = Box({0.2, 0.2, 0.2});
  const std::size_t faces = sound.mesh.triangles.size();
  findings.clear();
  RemoveTornBottom("a.glb", &sound, &findings);
  EXPECT_TRUE(findings.empty());
  EXPECT_EQ(sound.mesh.triangles.size(), faces);
}

// A void with a hole is found once the hole is closed.
TEST(LooseFaces, ShellsThatWereOpenAreRemovedOnceTheyAreClosed) {
  core::TexturedMesh mesh = Box({0.2, 0.2, 0.2});
  core::TriangleMesh inner = damaged::Subdivided(assets::BoxMesh({0.15, 0.15, 0.15}), 0.03);
  for (Eigen::Vector3i& t : inner.triangles) std::swap(t[0], t[1]);
  inner.triangles.pop_back();
  const std::size_t faces = mesh.mesh.triangles.size();
  core::Append(inner, &mesh.mesh);
  core::Findings findings;
  RemoveLooseFaces("a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-inner-shells"), 0);
  CloseHoles(CategoryNamed("box"), "a.glb", &mesh, &findings);
  RemoveInnerShells("a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-inner-shells"), 1);
  EXPECT_EQ(mesh.mesh.triangles.size(), faces);
}

TEST(SurfaceNoise, IsMeasuredAndCurvatureIsNot) {
  damaged::Specimen ball = damaged::SoundSpecimen("ball", 1);
  ball.mesh = damaged::Subdivided(ball.mesh, 0.03 * ball.sides.x());
  const double smooth = SurfaceNoise(ball.mesh);
  EXPECT_LT(smooth, 2e-4 * ball.sides.x());
  EXPECT_EQ(SurfaceNoise(Box({0.2, 0.1, 0.05}).mesh), 0.0);
  const double sigma = 0.003 * ball.sides.x();
  core::Rng rng = core::StreamRng(1, 1);
  for (Eigen::Vector3d& v : ball.mesh.vertices) {
    for (int k = 0; k < 3; ++k) v[k] += sigma * core::Normal(rng);
  }
  EXPECT_NEAR(SurfaceNoise(ball.mesh) / sigma, 1.0, 0.35);
  core::Findings findings;
  WarnOfNoise("a.glb", ball.mesh, &findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "mesh-noise");
}

// The ring on which a bowl stands is closed as a ring: the recess within it stays.
TEST(HoleClosing, LoopsOfOnePlaneAreClosedTogether) {
  core::TriangleMesh outer = assets::BoxMesh({0.2, 0.2, 0.1});
  core::TriangleMesh inner = assets::BoxMesh({0.1, 0.1, 0.1});
  const auto loop_of = [](core::TriangleMesh* box) {
    std::erase_if(box->triangles, [&](const Eigen::Vector3i& t) {
      return (box->vertices[t[0]] + box->vertices[t[1]] + box->vertices[t[2]]).z() < -0.1499;
    });
    return geometry::BoundaryLoops(*box);
  };
  std::vector<geometry::BoundaryLoop> loops = loop_of(&outer);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].size(), 4u);
  EXPECT_NEAR(geometry::ShapeOf(outer.vertices, loops[0]).area, 0.04, 1e-12);
  std::vector<geometry::BoundaryLoop> nested = loop_of(&inner);
  ASSERT_EQ(nested.size(), 1u);
  for (int& v : nested[0]) v += static_cast<int>(outer.vertices.size());
  loops.push_back(nested[0]);
  core::TriangleMesh ring;
  ring.vertices = outer.vertices;
  ring.vertices.insert(ring.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  ring.triangles = geometry::FillFlatLoops(ring.vertices, loops, -Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(core::SurfaceArea(ring), 0.04 - 0.01, 1e-12);
  for (int t = 0; t < static_cast<int>(ring.triangles.size()); ++t) {
    EXPECT_LT(core::TriangleAreaVector(ring, t).z(), 0.0);
  }
}

TEST(TJunctions, FacesAreSplitAndTheSurfaceCloses) {
  damaged::Specimen specimen;
  specimen.mesh = damaged::Subdivided(assets::BoxMesh({0.2, 0.1, 0.1}), 0.04);
  core::Rng rng(3);
  damaged::SplitOneSide(&specimen, &rng);
  core::TexturedMesh mesh;
  mesh.mesh = specimen.mesh;
  EXPECT_GT(geometry::Examine(geometry::Weld(mesh.mesh, 0.0), 0).open_edges, 0);
  core::Findings findings;
  JoinTJunctions("a.obj", &mesh, &findings);
  EXPECT_GT(FigureOf(findings, "mesh-cracks-joined"), 0);
  EXPECT_TRUE(geometry::Examine(geometry::Weld(mesh.mesh, 0.0)).IsSolid());
  EXPECT_NEAR(VolumeOf(mesh), 0.002, 1e-12);
}

// A cup of one wall is a sheet: its mouth stays open, and so do its holes.
TEST(HoleClosing, AnOpenVesselStaysOpen) {
  core::TexturedMesh cup = Box({0.08, 0.08, 0.1});
  Open([](const Eigen::Vector3d& m) { return m.z() > 0.0499; }, &cup);
  const std::size_t faces = cup.mesh.triangles.size();
  core::Findings findings;
  CloseHoles(CategoryNamed("mug"), "cup.glb", &cup, &findings);
  EXPECT_EQ(cup.mesh.triangles.size(), faces);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "mesh-open");
  EXPECT_EQ(findings[0].severity, core::Severity::kWarning);
}

TEST(HoleClosing, FacesOfAClosedSurfaceAreTurnedOutward) {
  core::TexturedMesh mesh = Box({0.1, 0.1, 0.1});
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); t += 3) {
    std::swap(mesh.mesh.triangles[t][0], mesh.mesh.triangles[t][1]);
  }
  core::Findings findings;
  CloseHoles(CategoryNamed("box"), "a.glb", &mesh, &findings);
  EXPECT_EQ(FigureOf(findings, "mesh-faces-turned"),
            static_cast<int>((mesh.mesh.triangles.size() + 2) / 3));
  EXPECT_NEAR(VolumeOf(mesh), 0.001, 1e-12);
}

TEST(FileScale, AbsurdSizesGetAUnitOrTheSizeOfTheCategory) {
  const auto scaled = [](const Eigen::Vector3d& sides, core::Findings* findings) {
    core::TriangleMesh mesh = assets::BoxMesh(sides);
    ScaleAbsurdMesh(CategoryNamed("mug"), {"mug.obj"}, &mesh, findings);
    return core::Bounds(mesh).sizes().eval();
  };
  core::Findings findings;
  EXPECT_TRUE(scaled({12, 8, 10}, &findings).isApprox(Eigen::Vector3d(0.12, 0.08, 0.1), 1e-12));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "unit-guessed");
  EXPECT_EQ(findings[0].severity, core::Severity::kWarning);
  findings.clear();
  const Eigen::Vector3d drawn = scaled({1.0, 0.667, 0.833}, &findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "size-drawn");
  EXPECT_EQ(findings[0].severity, core::Severity::kWarning);
  EXPECT_NEAR(drawn.x() / drawn.y(), 1.0 / 0.667, 1e-9);
  EXPECT_LT(drawn.maxCoeff(), 0.25);
  EXPECT_GT(drawn.maxCoeff(), 0.05);
  findings.clear();
  EXPECT_TRUE(scaled({0.12, 0.08, 0.1}, &findings).isApprox(Eigen::Vector3d(0.12, 0.08, 0.1)));
  EXPECT_TRUE(findings.empty());
}

class ImportReport : public ::testing::Test {
 protected:
  std::string Import(const fs::path& file, const std::string& options, int code) const {
    const Outcome outcome = RunProgram("import " + file.string() + " " + options + " -o " +
                                       (folder_.path() / "out").string());
    EXPECT_EQ(outcome.code, code) << outcome.text;
    return outcome.text;
  }
  const core::TemporaryFolder folder_;
};

TEST_F(ImportReport, ThePageStatesNumbersBeforeAndAfter) {
  damaged::Specimen specimen = damaged::SoundSpecimen("die", 3);
  core::Rng rng(7);
  specimen.format = "glb";
  damaged::OpenHoles(&specimen, &rng);
  damaged::AddSpecks(&specimen, &rng);
  const fs::path file = damaged::WriteSpecimen(specimen, "generated", folder_.path());
  const std::string text = Import(file, "--category die --report", 0);
  EXPECT_NE(text.find("import.html"), std::string::npos) << text;
  const fs::path asset = folder_.path() / "out/generated";
  const std::string page = core::ReadFile(asset / "import.html", 1 << 20);
  for (const char* code : {"[mesh-specks]", "[mesh-holes-closed]"}) {
    EXPECT_NE(page.find(code), std::string::npos) << code;
  }
  // Open edges: those of the file, none of the visual mesh, none of the solid.
  const auto validity = geometry::Examine(geometry::Weld(specimen.mesh, 0.0), 0);
  EXPECT_GT(validity.open_edges, 0);
  EXPECT_NE(
      page.find("<tr><td>open edges</td><td class=\"n\">" + std::to_string(validity.open_edges) +
                "</td><td class=\"n\">0</td><td class=\"n\">0</td></tr>"),
      std::string::npos)
      << page;
  EXPECT_NE(page.find("<tr><td>connected pieces</td><td class=\"n\">" +
                      std::to_string(validity.components) +
                      "</td><td class=\"n\">1</td><td class=\"n\">1</td></tr>"),
            std::string::npos)
      << page;
  EXPECT_GT(core::ReadImage(asset / "before.png").width, 1000);
  EXPECT_GT(core::ReadImage(asset / "after.png").height, 600);
}

// Each ends with one line, and leaves no folder.
TEST_F(ImportReport, BrokenFilesAreRefused) {
  damaged::Specimen specimen = damaged::SoundSpecimen("brick", 3);
  specimen.format = "glb";
  specimen.pbr_textures = true;
  const fs::path file = damaged::WriteSpecimen(specimen, "whole", folder_.path());
  const std::string bytes = core::ReadFile(file, 64 << 20);
  for (const double share : {0.0, 0.0001, 0.02, 0.3, 0.6, 0.99}) {
    const fs::path cut = folder_.path() / "cut.glb";
    core::WriteFile(cut, bytes.substr(0, static_cast<std::size_t>(share * bytes.size())));
    const std::string text = Import(cut, "--category brick", 1);
    EXPECT_EQ(text.rfind("error: ", 0), 0u) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_FALSE(fs::exists(folder_.path() / "out/cut"));
  }
  // An index beyond the vertices.
  core::WriteFile(folder_.path() / "index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  EXPECT_NE(Import(folder_.path() / "index.obj", "--category brick", 1).find("error: "),
            std::string::npos);
  // Two gigabytes, all of them zero.
  const fs::path huge = folder_.path() / "huge.glb";
  std::ofstream(huge) << "glTF";
  fs::resize_file(huge, 2ull << 30);
  EXPECT_NE(Import(huge, "--category brick", 1).find("error: "), std::string::npos);
}

}  // namespace
}  // namespace simwright::importers
