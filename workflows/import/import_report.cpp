#include "workflows/import/import_report.h"

#include <cstdio>
#include <functional>
#include <string>

#include "asset_build/preview.h"
#include "core/files.h"
#include "core/finding_text.h"
#include "core/text_template.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"
#include "physics_params/size_plausibility.h"
#include "render/turntable.h"
#include "workflows/tasks/page_markup.h"

namespace simwright::workflows {
namespace {

constexpr int kCountedIntersections = 1000;

// The numbers of a mesh.
struct MeshNumbers {
  std::size_t faces = 0, vertices = 0;
  Eigen::Vector3d sides{0, 0, 0};  // m
  geometry::MeshValidity validity;
};

MeshNumbers NumbersOf(const core::TriangleMesh& mesh) {
  return {mesh.triangles.size(), mesh.vertices.size(), core::Bounds(mesh).sizes(),
          geometry::Examine(geometry::Weld(mesh, 0.0), kCountedIntersections)};
}

std::string CountText(int count) {
  return count >= kCountedIntersections ? std::to_string(count) + " or more"
                                        : std::to_string(count);
}

std::string VolumeText(const MeshNumbers& numbers) {
  if (!numbers.validity.closed) return "open";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g l", 1000.0 * numbers.validity.signed_volume);
  return text;
}

std::string TableRow(const std::string& name, const std::vector<MeshNumbers>& meshes,
                     const std::function<std::string(const MeshNumbers&)>& value) {
  std::string row = "<tr><td>" + core::EscapedMarkup(name) + "</td>";
  for (const MeshNumbers& numbers : meshes) {
    row += "<td class=\"n\">" + core::EscapedMarkup(value(numbers)) + "</td>";
  }
  return row + "</tr>\n";
}

std::string TableOf(const std::vector<MeshNumbers>& meshes) {
  using Numbers = const MeshNumbers&;
  return TableRow("faces", meshes, [](Numbers n) { return std::to_string(n.faces); }) +
         TableRow("vertices", meshes, [](Numbers n) { return std::to_string(n.vertices); }) +
         TableRow("connected pieces", meshes,
                  [](Numbers n) { return std::to_string(n.validity.components); }) +
         TableRow("open edges", meshes,
                  [](Numbers n) { return std::to_string(n.validity.open_edges); }) +
         TableRow("edges with three faces or more", meshes,
                  [](Numbers n) { return std::to_string(n.validity.non_manifold_edges); }) +
         TableRow("degenerate faces", meshes,
                  [](Numbers n) { return std::to_string(n.validity.degenerate_triangles); }) +
         TableRow("pairs of faces that intersect", meshes,
                  [](Numbers n) { return CountText(n.validity.self_intersections); }) +
         TableRow("faces outward", meshes,
                  [](Numbers n) { return n.validity.oriented ? "yes" : "no"; }) +
         TableRow("bounds a solid", meshes,
                  [](Numbers n) { return n.validity.IsSolid() ? "yes" : "no"; }) +
         TableRow("volume", meshes, VolumeText) +
         TableRow("size", meshes, [](Numbers n) { return physics_params::SizeText(n.sides); });
}

}  // namespace

void WriteImportReport(const ImportReport& report, const std::filesystem::path& folder) {
  const assets::Asset& asset = report.asset;
  core::TexturedMesh solid;
  solid.mesh = asset.solid;
  const std::string rows = TableOf(
      {NumbersOf(report.as_read.mesh), NumbersOf(asset.visual.mesh), NumbersOf(asset.solid)});
  core::WritePng(folder / "before.png", render::Preview(report.as_read));
  std::vector<core::Image> after = render::Turntable(asset.visual);
  for (const core::Image& view : render::Turntable(solid)) after.push_back(view);
  core::WritePng(folder / "after.png", core::ContactSheet(after, render::TurntableOptions().views));
  double seconds = 0.0;
  for (const auto& [stage, taken] : report.seconds) seconds += taken;
  char text[160];
  std::snprintf(text, sizeof text, "%.3g kg, %zu collision parts, made in %.1f s",
                asset.inertial.mass, asset.parts.size(), seconds);
  const std::string body = core::FillTemplate(
      data::import_page_html(), {{"source", asset.source},
                                 {"category", asset.parameters.category},
                                 {"summary", text},
                                 {"method", asset.solid_method},
                                 {"findings", core::Markup{FindingsList(asset.findings)}},
                                 {"rows", core::Markup{rows}}});
  core::WriteFile(folder / "import.html", Page(asset.name, data::photo_run_css(), body));
}

}  // namespace simwright::workflows
