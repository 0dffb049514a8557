#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/image.h"
#include "core/json.h"
#include "core/mesh.h"

namespace simwright::viewer {

// A binary part of a document, such as a mesh or an encoded image.
struct Buffer {
  std::string bytes;
  std::string type;  // media type: "application/octet-stream", "image/png", "image/jpeg"
};

// All that the page shows: a manifest (docs/viewer.md) that refers to meshes by index, and the
// buffers that these refer to by index.
struct Document {
  core::OrderedJson manifest;
  std::vector<Buffer> buffers;
};

// A document under construction. Equal meshes and equal textures are stored once.
class DocumentBuilder {
 public:
  // `kind`: "asset", "assets", "scenes", "tasks", "rollout" or "run". `title` is shown as text.
  DocumentBuilder(const std::string& kind, const std::string& title);

  // Return the index of the mesh in the manifest. `color`: RGB of a mesh without a look, sRGB.
  // Throw core::Error, naming `where`, for a mesh with an index out of range or a coordinate that
  // is not finite.
  int AddMesh(const core::TexturedMesh& mesh, const std::string& where);
  int AddMesh(const core::TriangleMesh& mesh, const std::string& where);

  // Returns the index of a model (model_document.h).
  int AddModel(core::OrderedJson model);
  // Returns the index of a world (world_document.h).
  int AddWorld(core::OrderedJson world);
  int AddBuffer(Buffer buffer);

  core::OrderedJson& manifest() { return document_.manifest; }
  Document Take() { return std::move(document_); }

 private:
  int AddTexture(const core::Image& image);
  int AddPacked(core::OrderedJson mesh, std::string bytes);

  Document document_;
  std::map<std::string, int> textures_;  // by content hash
  std::map<std::string, int> meshes_;    // by content hash
};

// Returns the upper three rows of the pose's matrix, row by row. (12)
core::OrderedJson PoseNumbers(const Eigen::Isometry3d& pose);
core::OrderedJson VectorNumbers(const Eigen::Vector3d& vector);

// A table of facts: names with their values, as shown.
using Facts = std::vector<std::pair<std::string, std::string>>;
core::OrderedJson FactsJson(const Facts& facts);
// Formats a number with a unit: "0.152 kg".
std::string Quantity(double value, const std::string& unit, int digits = 4);

}  // namespace simwright::viewer
