#include "importers/catalogue_meshes.h"

#include "assets/mesh_import.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"

namespace simwright::importers {
namespace {

void ScaleToSize(const Eigen::Vector3d& size, core::TriangleMesh* mesh) {
  const Eigen::Vector3d now = core::Bounds(*mesh).sizes();
  Eigen::Vector3d factors;
  // A flat sheet cannot be scaled in one direction: it uses the mean factor of the others.
  double sum = 0.0;
  int counted = 0;
  for (int k = 0; k < 3; ++k) {
    if (now[k] > 1e-9 * now.maxCoeff() && size[k] > 0.0) {
      factors[k] = size[k] / now[k];
      sum += factors[k];
      ++counted;
    } else {
      factors[k] = 0.0;
    }
  }
  if (counted == 0) return;
  for (int k = 0; k < 3; ++k) {
    if (factors[k] == 0.0) factors[k] = sum / counted;
  }
  core::Transform(Eigen::Affine3d(Eigen::Scaling(factors)), mesh);
}

}  // namespace

core::TexturedMesh ReadCataloguePiece(const assets::FurnitureCatalogue& catalogue,
                                      const assets::CataloguePiece& piece,
                                      core::Findings* findings) {
  const core::TemporaryFolder folder;
  assets::MeshFile file = assets::ReadMeshFile(catalogue.Extract(piece, folder.path()));
  core::TexturedMesh mesh = std::move(file.mesh);
  for (core::Finding& finding : file.findings) {
    if (findings == nullptr) break;
    finding.place = piece.id;
    findings->push_back(std::move(finding));
  }
  // The rotation acts in the model's own frame, where y is up (Sweet Home 3D).
  Eigen::Matrix3d z_up;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.linear() = z_up * piece.model_rotation;
  core::Transform(turn, &mesh.mesh);
  ScaleToSize(piece.size_m, &mesh.mesh);
  return mesh;
}

std::vector<core::TexturedMesh> ReadCatalogue(const std::filesystem::path& path,
                                              core::Progress* progress) {
  const assets::FurnitureCatalogue catalogue(path);
  const int count = static_cast<int>(catalogue.pieces().size());
  std::vector<core::TexturedMesh> read(static_cast<size_t>(count));
  progress->Stage("reading " + path.filename().string(), count);
  core::ParallelFor(count, [&](int i) {
    try {
      read[static_cast<size_t>(i)] =
          ReadCataloguePiece(catalogue, catalogue.pieces()[static_cast<size_t>(i)], nullptr);
    } catch (const core::Error&) {
      // Damaged pieces are skipped.
    }
    progress->Advance();
  });
  std::erase_if(read, [](const core::TexturedMesh& mesh) { return mesh.mesh.empty(); });
  if (read.empty()) throw core::Error("has no readable piece", path.string());
  return read;
}

}  // namespace simwright::importers
